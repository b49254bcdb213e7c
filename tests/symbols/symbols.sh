#!/bin/sh
# usage: symbols.sh STATIC_LIBRARY SHARED_LIBRARY
# Holds the borders of the core: its names, what it exports, what it needs.
set -u
static=$1 shared=$2
failed=0

# complain WHAT NAMES
complain() {
    [ -z "$2" ] && return
    printf '%s:\n%s\n' "$1" "$2"
    failed=1
}

names=$(nm -g --defined-only "$static" | awk 'NF == 3 {print $3}' | sort -u)
exports=$(nm -D --defined-only "$shared" | awk '$2 != "A" && NF == 3 {sub(/@.*/, "", $3); print $3}' | sort -u)
needs=$(readelf -d "$shared" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
[ -n "$names" ] && [ -n "$exports" ] && [ -n "$needs" ] || { echo 'nm or readelf found nothing'; exit 1; }

complain 'global names of the static library that are neither refocus_ nor rf_' \
    "$(echo "$names" | grep -v -E '^(refocus|rf)_')"
complain 'the shared library exports more than refocus_' \
    "$(echo "$exports" | grep -v '^refocus_')"
complain 'the shared library needs more than libc and libm' \
    "$(echo "$needs" | grep -v -E '^(libc\.so\.|libm\.so\.|ld-linux)')"
# What would print, end the program, read the environment or call out.
complain 'the core calls what a library must not call' \
    "$(nm -D --undefined-only "$shared" | awk '{print $NF}' |
        grep -E '^(abort|exit|_exit|printf|puts|putchar|perror|fprintf|getenv|secure_getenv|system)(@|$)')"
echo "$(echo "$names" | wc -l) global names, $(echo "$exports" | wc -l) exported; needs:" $needs
exit $failed
