#!/bin/sh
# usage: grow.sh SOURCE WORK_FOLDER LIBRARY_FOLDER COMPILER...
# Runs a program compiled against the headers of the last release, and one against headers with a
# field more, with this library and with one that has that field: sized.h says what has to come out.
set -eu
source=$1 work=$2 library=$3
shift 3
here=$source/tests/symbols

rm -rf "$work"
mkdir -p "$work/newer"
cp -R "$source/include" "$work/newer/include"
for struct in refocus_look_params refocus_render_params refocus_renderer_params \
        refocus_renderer_info refocus_image refocus_disparity; do
    header=$(grep -lE "^struct $struct \{" "$work"/newer/include/refocus/*.h)
    sed -i "/^struct $struct {/,/^};/ s/^};/    uint64_t added_later;\n};/" "$header"
done

# compile NAME INCLUDE_FOLDER OPTIONS COMPILER...
compile() {
    name=$1 include=$2 options=$3
    shift 3
    # shellcheck disable=SC2086
    "$@" -std=c11 -D_POSIX_C_SOURCE=200809L $options -I"$include" -o "$work/$name" \
        "$here/grow.c" -L"$library" -lrefocus -lm
}
compile older "$here/abi-0.2" '' "$@"
compile present "$source/include" '' "$@"
compile newer-program "$work/newer/include" -DNEWER "$@"

# A library with the field: the tree's core, in C alone, as fast as it can be compiled.
cp -R "$source/src" "$source/meson_options.txt" "$work/newer"
sed '/^subdir(.platform.)/,$d' "$source/meson.build" >"$work/newer/meson.build"
CC="$*" meson setup --buildtype=plain -Dc_args=-O1 -Dsimd=disabled "$work/build" "$work/newer" \
    >"$work/setup.log" || { cat "$work/setup.log"; exit 1; }
ninja -C "$work/build" -j 2 >"$work/ninja.log" || { tail "$work/ninja.log"; exit 1; }

expected=$(LD_LIBRARY_PATH=$library "$work/present")
failed=0
# try LIBRARY_FOLDER WHAT COMMAND...
try() {
    folder=$1 what=$2
    shift 2
    if got=$(LD_LIBRARY_PATH=$folder "$@") && [ "$got" = "$expected" ]; then
        echo "ok     $what"
    else
        echo "FAILED $what: $got, not $expected"
        failed=1
    fi
}
try "$library" 'program of the last release, this library' "$work/older"
try "$library" 'newer program, this library, its field is 0' "$work/newer-program"
try "$library" 'newer program, this library, its field is refused' "$work/newer-program" refused
try "$work/build/src" 'program of the last release, newer library' "$work/older"
try "$work/build/src" 'this program, newer library' "$work/present"
try "$work/build/src" 'newer program, newer library' "$work/newer-program" taken
exit $failed
