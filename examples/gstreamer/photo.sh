#!/bin/sh
# usage: photo.sh PHOTO.png MAP.png OUT.png
#
# One photo and its depth map through the same pipeline as a camera's frames.
[ $# -eq 3 ] || { sed -n '2,4s/^# \{0,1\}//p' "$0" >&2; exit 2; }
exec gst-launch-1.0 -q \
    filesrc location="$1" ! pngdec ! videoconvert ! video/x-raw,format=RGB ! \
    refocus name=lens focus=0.9 blur=20 quality=best ! pngenc ! filesink location="$3" \
    filesrc location="$2" ! pngdec ! videoconvert ! video/x-raw,format=GRAY16_LE ! lens.depth
