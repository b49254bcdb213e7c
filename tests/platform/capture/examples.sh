#!/bin/sh
# usage: examples.sh LIVE_CAMERA LIVE_FILE
# What one example writes the other reads: as many frames, of the same size, and other pixels.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
camera=$(realpath "$1") file=$(realpath "$2")
cd "$work"
"$camera" 'replay::size 64x48;fps 100' 'replay::format Z16;size 32x24;fps 100' y4m:in.y4m 4
printf 'P5\n2 1\n255\n\000\377' >depth.pgm
"$file" in.y4m depth.pgm out.y4m
[ "$(wc -c <in.y4m)" = "$(wc -c <out.y4m)" ]
[ "$(grep -a -c FRAME out.y4m)" = 4 ]
! cmp -s in.y4m out.y4m
for program in "$camera" "$file"; do
    status=0
    "$program" none 2>usage.txt || status=$?
    [ "$status" = 2 ]
    grep -q '^usage: live_' usage.txt
done
! "$file" none.y4m depth.pgm none-out.y4m 2>error.txt
[ "$(wc -l <error.txt)" = 1 ]
