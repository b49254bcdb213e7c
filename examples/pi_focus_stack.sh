#!/bin/sh
# usage: pi_focus_stack.sh FOLDER [CAMERA]
#
# A Raspberry Pi's Camera Module 3, or another camera that moves its lens, photographs a still scene
# at nine focus distances. FOLDER is made. It receives the frames, depth.png, sharp.png, which is in
# focus everywhere, and that photo refocused: near.png and far.png. CAMERA is libcamera:0 unless it
# is given; STEPS and BLUR, pixels of radius, are taken from the environment.
[ $# -ge 1 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
set -e
refocus stack --camera "${2:-libcamera:0}" --steps "${STEPS:-9}" --keep "$1"
cd "$1"
refocus depth --focal-stack [0-9]*.png --positions stack.json -o depth.png --photo sharp.png
set -- sharp.png --depth depth.png --depth-edges as-given --blur "${BLUR:-20}"
refocus render "$@" --focus 1 -o near.png
refocus render "$@" --focus 0 -o far.png
