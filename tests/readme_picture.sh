#!/usr/bin/env bash
# usage: readme_picture.sh BUILD
# Makes examples/data/before_after.png, the picture in the README: the shipped scene as it is,
# focused on the subject, focused on the background. Needs ImageMagick to put them side by side.
set -eu -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
refocus=$1/platform/cli/refocus
scene=$top/examples/data/portrait
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cp "$scene/allfocus.png" "$work/0.png"
"$refocus" render "$scene/allfocus.png" --depth "$scene/disparity.png" --focus 0.689 --blur 20 \
    --quality best -o "$work/1.png"
"$refocus" render "$scene/allfocus.png" --depth "$scene/disparity.png" --focus 0 --blur 20 \
    --quality best -o "$work/2.png"
convert "$work/0.png" "$work/1.png" "$work/2.png" -filter Lanczos -resize 400x300 \
    -bordercolor white -border 2x0 +append -strip -define png:compression-level=9 \
    -define png:compression-filter=5 "$top/examples/data/before_after.png"
ls -l "$top/examples/data/before_after.png"
