#!/bin/sh
# usage: symbols.sh STATIC_LIBRARY SHARED_LIBRARY [STATIC_CORE]
# Holds the borders of a library: its names, what it exports, what it calls. The core and the papers
# need libc and libm alone; another library, of which the core is named, has no name of the core,
# with which it would clash where a program links both statically.
set -u
. "$(dirname "$0")/complain.sh"
static=$1 shared=$2 core=${3-}

globals() { nm -g --defined-only "$1" | awk 'NF == 3 {print $3}' | sort -u; }

names=$(globals "$static")
exports=$(nm -D --defined-only "$shared" | awk '$2 != "A" && NF == 3 {sub(/@.*/, "", $3); print $3}' | sort -u)
needs=$(readelf -d "$shared" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
[ -n "$names" ] && [ -n "$exports" ] && [ -n "$needs" ] || { echo 'nm or readelf found nothing'; exit 1; }

complain 'global names of the static library that are neither refocus_ nor rf_' \
    "$(echo "$names" | grep -v -E '^(refocus|rf)_')"
complain 'the shared library exports more than refocus_' \
    "$(echo "$exports" | grep -v '^refocus_')"
if [ -n "$core" ]; then
    complain 'names that the core has too' "$( (echo "$names"; globals "$core") | sort | uniq -d)"
else
    complain 'the shared library needs more than libc and libm' \
        "$(echo "$needs" | grep -v -E '^(libc\.so\.|libm\.so\.|ld-linux)')"
fi
# What would print, end the program, read the environment or call out.
complain 'it calls what a library must not call' \
    "$(nm -D --undefined-only "$shared" | awk '{print $NF}' |
        grep -E '^(abort|exit|_exit|printf|puts|putchar|perror|fprintf|getenv|secure_getenv|system|setlocale)(@|$)')"
echo "$(echo "$names" | wc -l) global names, $(echo "$exports" | wc -l) exported; needs:" $needs
exit $failed
