#!/bin/sh
# usage: alone.sh c11|c++11 INCLUDE_FOLDER COMPILER...
# Compiles each public header alone, twice in one file, as strictly as can be.
set -u
std=$1 include=$2
shift 2
case $std in c++*) language=c++ ;; *) language=c ;; esac
failed=0 count=0
for header in $(cd "$include" && find refocus -name '*.h' | sort); do
    count=$((count + 1))
    if printf '#include <%s>\n#include <%s>\n' "$header" "$header" |
        "$@" -x $language -std="$std" -pedantic -Wall -Wextra -Werror -I"$include" \
            -fsyntax-only -; then
        echo "ok $std $header"
    else
        echo "FAILED $std $header"
        failed=1
    fi
done
[ $count -gt 0 ] || failed=1
exit $failed
