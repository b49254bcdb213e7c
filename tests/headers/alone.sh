#!/bin/sh
# usage: alone.sh c11|c++11 INCLUDE_FOLDER COMPILER...
# Compiles each public header alone, twice in one file, as strictly as can be. With pointers of 64
# bits no struct has padding, whose bytes a program that sets every field leaves unset: sized.h.
set -u
std=$1 include=$2
shift 2
case $std in c++*) language=c++ ;; *) language=c ;; esac
failed=0 count=0 padded=
if [ "$(echo __SIZEOF_POINTER__ | "$@" -E -P -x c -)" = 8 ]; then
    padded=-Wpadded
fi
names='*.h'
# Those of C++, but that of OpenCV, which the program of tests/consumers has.
[ $language = c ] || names='*.h*'
for header in $(cd "$include" && find refocus -name "$names" ! -name opencv.hpp | sort); do
    count=$((count + 1))
    # struct refocus_settings is the program's own.
    case $header in */settings.h | */refocus.h*) padding= ;; *) padding=$padded ;; esac
    if printf '#include <%s>\n#include <%s>\n' "$header" "$header" |
        "$@" -x $language -std="$std" -pedantic -Wall -Wextra -Wshadow -Wconversion -Werror $padding -I"$include" \
            -fsyntax-only -; then
        echo "ok $std $header"
    else
        echo "FAILED $std $header"
        failed=1
    fi
done
[ $count -gt 0 ] || failed=1
exit $failed
