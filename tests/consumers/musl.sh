#!/bin/sh
# usage: musl.sh SOURCE WORK_FOLDER
# Builds the core with musl's C library and without vector kernels, and with the system's, and
# compares the pictures of an example: the same bytes. Exit status 77: there is no musl-gcc.
set -eu
source=$1 work=$2
command -v musl-gcc >/dev/null || exit 77
mkdir -p "$work/pictures-musl" "$work/pictures-gcc"
printf "[binaries]\nc = 'musl-gcc'\n" >"$work/musl.ini"
for library in musl gcc; do
    [ -e "$work/$library/build.ninja" ] ||
        meson setup "$work/$library" "$source" -Dbuildtype=release -Dauto_features=disabled \
            $([ $library = gcc ] || echo --native-file "$work/musl.ini")
    ninja -C "$work/$library" examples/refocus_ppm
    "$work/$library/examples/refocus_ppm" "$work/pictures-$library"
done
grep -aq ld-musl "$work/musl/examples/refocus_ppm"
for picture in "$work"/pictures-gcc/*.ppm; do
    cmp "$picture" "$work/pictures-musl/${picture##*/}"
    echo "the same bytes by musl: ${picture##*/}"
done
