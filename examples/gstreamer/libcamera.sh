#!/bin/sh
# usage: libcamera.sh MAP
#
# A camera by libcamera that looks at a scene which stands still, with the depth map of a file.
[ $# -eq 1 ] || { sed -n '2,4s/^# \{0,1\}//p' "$0" >&2; exit 2; }
exec gst-launch-1.0 \
    libcamerasrc ! video/x-raw,format=NV12,width=1280,height=720 ! queue ! \
    refocus depth-location="$1" focus=0.8 blur=24 aperture=polygon:7 ! \
    videoconvert ! autovideosink
