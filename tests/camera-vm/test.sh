#!/bin/bash
# usage: test.sh BUILD [--long]
# Boots the virtual machine with cameras and runs what is in inside.sh there. Prints a line a
# test; exit status 0, 1 when one failed, 77 when there can be no virtual machine. --long opens and
# closes a camera $REFOCUS_CYCLES times, default 10000.
set -u -o pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd)
export CAMERA_VM_TIMEOUT=${CAMERA_VM_TIMEOUT:-240}

if [ ! -x "$build/tests/camera-vm/vm-v4l2" ] || [ ! -x "$build/platform/cli/refocus" ]; then
    echo "SKIPPED camera-vm: this build has no v4l2 or no command"
    exit 77
fi
if ! "$here/run" true; then
    echo "SKIPPED camera-vm: the virtual machine does not boot, see above"
    exit 77
fi
failed=0
# part NAME WHAT...: how many tests must say ok
part() {
    local log ok
    log=$("$here/run" bash "$here/inside.sh" "$build" "$1")
    ok=$(grep -c '^ok ' <<<"$log")
    printf '%s\n' "$log"
    [ "$ok" = "$2" ] && ! grep -q '^FAILED ' <<<"$log" && return
    grep -q '^FAILED ' <<<"$log" || echo "FAILED camera-vm-$1: $ok tests of $2 ran"
    failed=1
}
part single 9
CAMERA_VM_VIVID="n_devs=1 multiplanar=2 node_types=0x1" CAMERA_VM_VIMC=none part multi 1
CAMERA_VM_LOOPBACK="devices=2 video_nr=0,1 max_buffers=4" CAMERA_VM_VIVID=none CAMERA_VM_VIMC=none \
    part loopback 3
if [ "${2-}" = --long ]; then
    CAMERA_VM_VIMC=none CAMERA_VM_TIMEOUT=3000 part cycles 1
fi
if "$build/platform/cli/refocus" --version | grep -q libcamera; then
    CAMERA_VM_VIVID=none part libcamera 4
fi
exit $failed
