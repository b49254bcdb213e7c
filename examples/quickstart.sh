#!/usr/bin/env bash
# usage: examples/quickstart.sh [--core]
#
# Installs what is missing on Debian 12, builds all that README.md shows in ./build (the refocus
# command with every picture format, camera, OpenCV, the window and the page; the plug-ins of
# GStreamer and GEGL; the Python package), and refocuses a scene at three distances: the subject,
# the middle, the background. The pictures are written to ./out. A build folder that is there
# already and lacks any of it is configured anew.
#   --core  installs a compiler and meson alone, builds the library and nothing else in
#           ./build-core, and lets a program of one page refocus a scene that it draws
# $REFOCUS_BUILD and $REFOCUS_OUT are other folders.
set -eu -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scene=$top/examples/data/portrait
out=${REFOCUS_OUT:-$top/out}
core=
case ${1-}:$# in
    :0) ;;
    --core:1) core=1 ;;
    *)
        sed -n '2,11s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
        [ "${1-}" = --help ] || exit 2
        exit 0
        ;;
esac
. "$top/tests/packages.sh"

# quiet COMMAND...: its words only when it fails
quiet() {
    local log
    log=$("$@" 2>&1) || { echo "$log" >&2; return 1; }
}

# has_all OPTION...: whether ./build is configured with these, -DNAME=VALUE each
has_all() {
    meson introspect --buildoptions "$build" 2>/dev/null | python3 -c '
import json, sys
there = {option["name"]: str(option["value"]) for option in json.load(sys.stdin)}
sys.exit(any(there.get(name) != value for name, value in
             (argument[2:].split("=") for argument in sys.argv[1:])))' "$@"
}

# configure OPTION...: what a folder remembers of libraries that were missing may be out of
# date, then it begins anew
configure() {
    if [ ! -e "$build/build.ninja" ]; then
        quiet meson setup --buildtype=release "$@" "$build" "$top"
    elif ! has_all "$@"; then
        echo "configuring $build anew" >&2
        meson setup --reconfigure "$@" "$build" "$top" >/dev/null 2>&1 ||
            quiet meson setup --wipe "$@" "$build" "$top"
    fi
}

mkdir -p "$out"
if [ -n "$core" ]; then
    build=${REFOCUS_BUILD:-$top/build-core}
    need_packages "${core_packages[@]}"
    configure -Dauto_features=disabled -Dsimd=enabled
    ninja --quiet -C "$build" examples/refocus_ppm >&2
    "$build/examples/refocus_ppm" "$out"
    printf '%s\n' "$out"/focus_{far,middle,near}.ppm
    exit
fi

build=${REFOCUS_BUILD:-$top/build}
need_packages "${core_packages[@]}" "${feature_packages[@]}"
configure -D{tools,jpeg,png,xmp,heic,tiff,openexr,webp,jxl,raw,npz,v4l2,libcamera,pipewire,sdl2,sdl2_ttf,web,opencv,gstreamer,gegl,python}=enabled
# Not the tests and the examples.
ninja --quiet -C "$build" command plugins python-package >&2
for focus in 0.689 0.257 0.000; do
    "$build/platform/cli/refocus" render "$scene/allfocus.png" \
        --depth "$scene/disparity.png" --focus $focus --blur 20 \
        -o "$out/portrait_focus_$focus.png"
    echo "$out/portrait_focus_$focus.png"
done
