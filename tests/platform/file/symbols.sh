#!/bin/sh
# usage: symbols.sh STATIC_LIBRARY SHARED_LIBRARY STATIC_CORE
# Names of librefocus-file: its own prefixes, nothing exported but refocus_, nothing that
# would clash with the core where a program links both statically, nothing that prints,
# ends the program or reads the environment.
set -u
failed=0

# complain WHAT NAMES
complain() {
    [ -z "$2" ] && return
    printf '%s:\n%s\n' "$1" "$2"
    failed=1
}

globals() { nm -g --defined-only "$1" | awk 'NF == 3 {print $3}' | sort -u; }

names=$(globals "$1")
exports=$(nm -D --defined-only "$2" | awk '$2 != "A" && NF == 3 {print $3}' | sort -u)
[ -n "$names" ] && [ -n "$exports" ] || { echo 'nm found nothing'; exit 1; }
complain 'global names that are neither refocus_ nor rf_' \
    "$(echo "$names" | grep -v -E '^(refocus|rf)_')"
complain 'the shared library exports more than refocus_' \
    "$(echo "$exports" | grep -v '^refocus_')"
complain 'names that the core has too' \
    "$( (echo "$names"; globals "$3") | sort | uniq -d)"
complain 'it calls what a library must not call' \
    "$(nm -D --undefined-only "$2" | awk '{print $NF}' |
        grep -E '^(abort|exit|_exit|printf|puts|putchar|perror|fprintf|getenv|secure_getenv|system|setlocale)(@|$)')"
exit $failed
