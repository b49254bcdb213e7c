#!/bin/sh
# usage: small_stack.sh PROGRAM [ARGUMENTS]
# Runs a program whose main thread and threads without a size of their own have 64 KiB of stack, half
# of what musl gives.
ulimit -s 64 || exit 1
exec "$@"
