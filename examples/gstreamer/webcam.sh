#!/bin/sh
# usage: webcam.sh COLOUR DEPTH [NEAR FAR]
#
# A V4L2 camera with a depth camera of millimetres beside it, such as /dev/video0 and /dev/video2,
# focused on the middle of the picture, in a window. NEAR and FAR are the metres of the scene.
[ $# -ge 2 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2; }
exec gst-launch-1.0 \
    v4l2src device="$1" ! videoconvert ! video/x-raw,format=NV12 ! queue ! \
    refocus name=lens depth-unit=mm near="${3:-0.5}" far="${4:-8}" focus-x=0.5 focus-y=0.5 \
        f-number=1.4 steady=0.8 latency=20000000 ! videoconvert ! autovideosink \
    v4l2src device="$2" ! video/x-raw,format=GRAY16_LE ! queue ! lens.depth
