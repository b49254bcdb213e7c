#!/bin/sh
# usage: exports.sh LIBRARY_OR_MODULE...
# Shared libraries of the platform export refocus_ names alone, as of the release that they came
# with, and none of C++. They and modules read no words or numbers by the locale of the program that
# they are in.
set -u
. "$(dirname "$0")/complain.sh"

for file; do
    name=$(basename "$file")
    exports=$(nm -D --defined-only "$file" | awk '$2 != "A" {print $NF}')
    [ -n "$exports" ] || complain 'nm found nothing' "$name"
    case $name in lib*)
        complain "$name exports more than refocus_ names of a release" \
            "$(echo "$exports" | grep -v -E '^refocus_[a-z0-9_]+@@REFOCUS_[0-9.]+$')"
        ;;
    esac
    complain "$name calls what follows the locale" \
        "$(nm -D --undefined-only "$file" | awk '{print $NF}' |
            grep -E '^(setlocale|strn?casecmp|strto[df]|atof|tolower|toupper|__ctype_[a-z_]*)(@|$)')"
done
exit $failed
