#!/bin/bash
# usage: inside.sh BUILD PART    (in the virtual machine)
# Prints 'ok NAME' or 'FAILED NAME' a test. PART: single, multi, loopback, cycles,
# libcamera.
build=$1 part=$2
refocus=$build/platform/cli/refocus
export LIBCAMERA_LOG_LEVELS='*:ERROR'
cd /tmp || exit 1

# check NAME COMMAND...
check() {
    local name=$1
    shift
    if "$@" >"$name.log" 2>&1; then
        echo "ok $name"
    else
        echo "FAILED $name"
        tail -n 25 "$name.log"
    fi
}

# field NAME <JSON: a number of the report
field() { sed -n "s/^  *\"$1\": \([0-9.]*\),\{0,1\}$/\1/p" | head -n 1; }

live() { timeout 100 "$refocus" live --no-commands --rays 4 --blur 3 --json "$@"; }

# Colour of one node, depth of another, running freely: the frames find their partners.
pair() {
    local paired
    v4l2-ctl -d0 -i 0
    v4l2-ctl -d2 -v width=320,height=180,pixelformat='Y16 '
    # Slowly: an emulated processor takes a third of a second to fill the holes of a depth map.
    live --camera v4l2:0 --format NV12 --size 320x180 --fps 2 --depth v4l2:2 --frames 10 >pair.json
    paired=$(field paired <pair.json)
    echo "$paired frames of 10 are paired"
    [ "$paired" -ge 8 ]
}

# What is put out comes in again at the other end of the node, to the last byte.
output() {
    local capture
    v4l2-ctl -d0 -i 1 && v4l2-ctl -d0 --set-dv-bt-timings index=0 &&
        v4l2-ctl -d1 --set-dv-bt-timings index=0 &&
        v4l2-ctl -d0 -v width=640,height=480,pixelformat=RGB3 &&
        v4l2-ctl -d1 -x width=640,height=480,pixelformat=RGB3 &&
        v4l2-ctl -d0 -c osd_text_mode=2,loop_video=1 || return
    live --camera 'replay::format RGB24;size 640x480;frames 1' --fast --focus 0.3 \
        --depth 'replay::format Z16;size 160x120;frames 1' --frames-policy every \
        --out still-%d.ppm || return
    live --camera file:still-0.ppm --depth still-0-depth.pgm --fps 5 --blur 0 --out v4l2:1 \
        --frames 60 >output.json &
    for _ in $(seq 20); do
        sleep 1
        timeout 20 v4l2-ctl -d0 --stream-mmap --stream-skip=2 --stream-count=1 --stream-to=read-back.raw
        tail -c 921600 still-0.ppm | cmp - read-back.raw && break
    done
    capture=$?
    wait
    v4l2-ctl -d0 -i 0
    [ "$capture" = 0 ] && [ "$(field frames_out <output.json)" -gt 10 ]
}

# One line that says why, and what to do.
no_permission() {
    chmod 600 /dev/video0
    ! setpriv --reuid=65534 --clear-groups "$refocus" live --camera v4l2:0 \
        --depth still-0-depth.pgm --frames 1 2>refused.txt &&
        cat refused.txt && [ "$(wc -l <refused.txt)" = 1 ] && grep -q "group 'video'" refused.txt
}

# What the kernel's own checker says of a node is the same before and after we used it.
compliance() {
    v4l2-compliance -d0 >before.txt
    live --camera v4l2:0 --format YUYV --size 320x180 --depth still-0-depth.pgm --frames 3 \
        >compliance.json || return
    live --camera v4l2:0 --dmabuf --depth still-0-depth.pgm --frames 3 >compliance.json || return
    v4l2-compliance -d0 >after.txt
    grep '^Total' before.txt && diff <(grep -E 'test |^Total' before.txt) \
        <(grep -E 'test |^Total' after.txt)
}

# A virtual camera that goes while frames flow into it is opened again.
sink_replugged() {
    v4l2-ctl -d1 --set-dv-bt-timings index=0
    live --camera 'replay::format RGB24;size 640x480;fps 5' --depth still-0-depth.pgm \
        --out v4l2:1 --duration 8 >sink.json &
    sleep 4
    v4l2-ctl -d0 -c disconnect=1
    wait $! || return
    cat sink.json
    [ "$(field sink_recoveries <sink.json)" -ge 1 ] && [ "$(field frames_out <sink.json)" -gt 8 ]
}

# A camera that another program pulls the plug of, while all of the pipeline runs.
replug() {
    live --camera v4l2:0 --format NV12 --size 320x180 --fps 10 --depth still-0-depth.pgm \
        --duration 6 >replug.json &
    sleep 3
    v4l2-ctl -d0 -c disconnect=1
    wait $! || return
    cat replug.json
    [ "$(field recoveries <replug.json)" = 1 ] &&
        [ "$(field worst_recovery_ms <replug.json | cut -d. -f1)" -lt 1000 ] &&
        [ "$(field frames_out <replug.json)" -gt 5 ]
}

# A camera without a lens to focus says so.
no_lens() {
    ! live --camera "$1" --depth still-0-depth.pgm --autofocus once --frames 1 2>refused.txt &&
        cat refused.txt && grep -q 'its lens does not move; leave it out' refused.txt
}

# Pulled out so that the node is gone, and put in again.
rebind() {
    local driver=/sys/bus/platform/drivers/vivid
    live --camera v4l2:0 --format NV12 --size 320x180 --fps 10 --depth still-0-depth.pgm \
        --duration 8 >rebind.json &
    sleep 3
    echo vivid.0 >$driver/unbind
    [ ! -e /dev/video0 ] || return
    sleep 1
    echo vivid.0 >$driver/bind
    wait $! || return
    cat rebind.json
    [ "$(field recoveries <rebind.json)" -ge 1 ] &&
        [ "$(field worst_recovery_ms <rebind.json | cut -d. -f1)" -lt 3000 ] &&
        [ "$(field frames_out <rebind.json)" -gt 10 ]
}

# Formats with memories of their own for each plane, by the multi-planar API.
multiplanar() {
    local format
    for format in NM12 NM21 YM12 NV12 YUYV RGB3; do
        v4l2-ctl -d0 -v width=320,height=180,pixelformat=$format >/dev/null || return
        live --camera v4l2:0 --depth still-0-depth.pgm --frames 3 >multi.json || return
        grep '"format"' multi.json
        live --camera v4l2:0 --dmabuf --depth still-0-depth.pgm --frames 3 >multi.json || return
    done
}

# A JPEG camera and a depth camera side by side: MJPEG and Z16 find each other by their times.
loopback_pair() {
    local feed=$build/tests/camera-vm/vm-loopback paired
    live --camera 'replay::format RGB24;size 320x240;frames 1' --fast --focus 0.3 \
        --depth 'replay::format Z16;size 160x120;frames 1' --frames-policy every \
        --out feed-%d.jpg >/dev/null && head -c 38400 /dev/zero | tr '\0' '\11' >feed.z16 || return
    "$feed" feed 10 0 MJPEG 320x240 feed-0.jpg 1 Z16 160x120 feed.z16 &
    sleep 1
    live --camera v4l2:0 --depth v4l2:1 --frames 10 >loopback.json
    paired=$(field paired <loopback.json)
    kill %1
    grep -q '"format": "MJPEG"' loopback.json && echo "$paired frames of 10 are paired" &&
        [ "$paired" -ge 8 ]
}

# A node that keeps the format somebody gave it, YUYV: pictures of planes come out of it with their
# codes in other places.
loopback_foreign() {
    local feed=$build/tests/camera-vm/vm-loopback same
    live --camera 'replay::format YUV420;size 320x240;frames 1' --fast --focus 0.3 --blur 0 \
        --depth 'replay::format Z16;size 160x120;frames 1' --frames-policy every --out y4m:one.y4m &&
        head -n 1 one.y4m >still.y4m || return
    for _ in $(seq 80); do tail -n +2 one.y4m; done >>still.y4m
    v4l2-ctl -d1 -c keep_format=1 &&
        live --camera file:in-0.jpg --size 320x240 --depth still-0-depth.pgm --blur 0 \
            --frames 3 --out v4l2:1 &&
        v4l2-ctl -d1 --get-fmt-video-out | grep YUYV || return
    live --camera y4m:still.y4m --depth still-0-depth.pgm --fps 5 --blur 0 --out v4l2:1 \
        --frames 60 >foreign.json &
    sleep 2
    timeout 20 v4l2-ctl -d1 --stream-mmap --stream-skip=2 --stream-count=1 --stream-to=foreign.raw
    "$feed" same one.y4m foreign.raw 320 240
    same=$?
    wait
    cat foreign.json
    [ "$same" = 0 ] && [ "$(field frames_out <foreign.json)" -gt 10 ]
}

libcamera_formats() {
    local format
    live --list || return
    for format in RGB24 BGR24; do
        live --camera libcamera:0 --format $format --size 320x240 --depth still-0-depth.pgm \
            --frames 4 >libcamera.json || return
        grep "\"format\": \"$format\"" libcamera.json || return
    done
}

# The example: the library in another program's loop.
libcamera_loop() {
    local program=$build/examples/own_libcamera_loop
    [ -x "$program" ] || { echo 'it is not built'; return 1; }
    timeout 60 "$program" 4 >loop.txt && cat loop.txt &&
        [ "$(wc -l <loop.txt)" = 4 ] && ! grep -q '^0.00' loop.txt
}

libcamera_refuses() {
    ! live --camera libcamera:7 --depth still-0-depth.pgm --frames 1 2>refused.txt &&
        grep -q 'no such camera' refused.txt &&
        ! live --camera libcamera:0 --format NV12 --depth still-0-depth.pgm --frames 1 2>refused.txt &&
        grep -q 'NV12 was asked for' refused.txt
}

# Distances as a plain picture: near on the left.
{ printf 'P5\n32 18\n255\n'; for _ in $(seq 18); do printf '%016d%016d' 0 0 | tr 0 '\200'; done; } >still-0-depth.pgm
case $part in
    single)
        check vivid-compliance compliance # first: of nodes as the driver made them
        check vivid-formats-and-faults "$build/tests/camera-vm/vm-v4l2" 0
        grep -E '^(captured|recovered)' vivid-formats-and-faults.log
        check vivid-colour-and-depth pair
        check vivid-output-read-back output
        check vivid-replugged replug
        check vivid-sink-replugged sink_replugged
        check vivid-no-lens no_lens v4l2:0
        check vivid-no-permission no_permission
        check vivid-pulled-out rebind
        ;;
    loopback)
        live --camera 'replay::format RGB24;size 320x240;frames 1' --fast --frames-policy every \
            --depth 'replay::format Z16;size 160x120;frames 1' --out in-%d.jpg >/dev/null
        check loopback-mjpeg-and-z16 "$build/tests/camera-vm/vm-loopback" test 0 in-0.jpg
        grep '^captured' loopback-mjpeg-and-z16.log
        check loopback-colour-and-depth loopback_pair
        check loopback-foreign-format loopback_foreign
        ;;
    cycles) check vivid-cycles "$build/tests/camera-vm/vm-v4l2" 0 "${REFOCUS_CYCLES:-10000}"
        grep '^cycles' vivid-cycles.log
        ;;
    multi) check vivid-multiplanar multiplanar ;;
    libcamera)
        check vimc-formats libcamera_formats
        check vimc-refusals libcamera_refuses
        check vimc-own-loop libcamera_loop
        check vimc-no-lens no_lens libcamera:0
        ;;
esac
