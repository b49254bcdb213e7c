#!/usr/bin/env bash
# Builds librefocus and refocuses a scene at three distances: the subject, the
# middle, the background. The pictures are written to ./out of the project.
set -eu -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scene=$top/examples/data/portrait
. "$top/tests/packages.sh"

need_packages meson ninja-build pkg-config gcc libc6-dev libpng-dev libjansson-dev \
    libturbojpeg0-dev libexpat1-dev
if [ ! -e "$top/build/build.ninja" ]; then
    log=$(meson setup --buildtype=release -Dtools=enabled -Dpng=enabled "$top/build" "$top" 2>&1) ||
        { echo "$log" >&2; exit 1; }
fi
ninja --quiet -C "$top/build" >&2

mkdir -p "$top/out"
for focus in 0.689 0.257 0.000; do
    "$top/build/platform/cli/refocus" render "$scene/allfocus.png" \
        --depth "$scene/disparity.png" --focus $focus --blur 20 \
        -o "$top/out/portrait_focus_$focus.png"
    echo "$top/out/portrait_focus_$focus.png"
done
