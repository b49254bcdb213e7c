#!/usr/bin/env bash
# usage: tests/run.sh [--full | --long]
#
# Builds with gcc on Debian 12, installing what is missing, and runs the tests of that build: five
# minutes on two cores. The last line is 'N passed, N failed, N skipped', the sum over all
# builds; the exit status is 1 when anything failed.
#   --full  also clang, clang-tidy, sanitizers, AArch64 and ARMv7 (emulated), builds with parts left out,
#           cameras in a virtual machine, the corpora of the fuzz targets, the quickstart
#   --long  also runs all tests under the thread sanitizer, lets each fuzz target search for
#           a minute, opens and closes a V4L2 camera 10,000 times, builds the module of
#           OpenCV's contrib filters, and compiles against each release of libcamera
# Builds are kept in $REFOCUS_BUILDS (build-tests in the source folder) and reused.
set -u -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
builds=${REFOCUS_BUILDS:-$top/build-tests}
fuzz_seconds=${REFOCUS_FUZZ_SECONDS:-60}
mode=one
for argument; do
    case $argument:$mode in
        --full:long) ;;
        --full:*) mode=full ;;
        --long:*) mode=long ;;
        *)
            sed -n '2,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
            [ "$argument" = --help ]
            exit $(($? * 2))
            ;;
    esac
done
. "$top/tests/packages.sh"
passed=0 failed=0 skipped=0
mkdir -p "$builds"

finish() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" = 0 ] && [ "$passed" -gt 0 ]
    exit
}

say() { printf '== %s  (%s)\n' "$1" "$(date +%H:%M:%S)"; }

# skip STAGE WHY
skip() {
    printf '    SKIPPED %s: %s\n' "$1" "$2"
    skipped=$((skipped + 1))
}

# fail WHAT [LOG]
fail() {
    printf '    FAILED  %s\n' "$1"
    [ -z "${2-}" ] || tail -n 40 "$2" | sed 's/^/            /'
    failed=$((failed + 1))
}

# build STAGE MESON_ARGUMENTS...: sets up anew or again, and compiles
build() {
    local dir=$builds/$1 log=$builds/$1.log again=()
    shift
    [ ! -e "$dir/build.ninja" ] || again=(--reconfigure)
    if ! meson setup "${again[@]}" "$dir" "$top" "$@" >"$log" 2>&1; then
        rm -rf "$dir"
        meson setup "$dir" "$top" "$@" >"$log" 2>&1 || { fail "${dir##*/}: meson setup" "$log"; return 1; }
    fi
    ninja -C "$dir" >>"$log" 2>&1 || { fail "${dir##*/}: compiling" "$log"; return 1; }
    if grep -q 'warning:' "$log"; then
        grep 'warning:' "$log" | sort -u | head -n 20 >"$log.warnings"
        fail "${dir##*/}: the compiler warns" "$log.warnings"
    fi
}

# run STAGE MESON_TEST_ARGUMENTS...: runs tests and adds up their results
run() {
    local dir=$builds/$1 p f s
    shift
    rm -f "$dir"/meson-logs/testlog*.json
    "${wrap[@]}" meson test -C "$dir" --no-rebuild --print-errorlogs "$@" \
        >"$dir/tests.log" 2>&1
    set -- "$dir"/meson-logs/testlog*.json
    if [ ! -s "$1" ] || ! read -r p f s < <(python3 "$top/tests/results.py" "$1" 2>"$dir/tests.txt")
    then
        fail "${dir##*/}: no test results" "$dir/tests.log"
        return
    fi
    cat "$dir/tests.txt"
    printf '    %d passed, %d failed, %d skipped in %s\n' "$p" "$f" "$s" "${dir##*/}"
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    python3 "$top/tests/results.py" "$1" --digest >"$dir/digest"
}
wrap=()

# same_bytes STAGE: its pictures against those of the gcc build
same_bytes() {
    if [ ! -s "$builds/$1/digest" ]; then
        fail "$1: no digest of its pictures"
    elif cmp -s "$builds/gcc/digest" "$builds/$1/digest"; then
        echo "    same pictures as gcc: $1"
        passed=$((passed + 1))
    else
        diff "$builds/gcc/digest" "$builds/$1/digest" >"$builds/$1/digest.diff"
        fail "$1: other pictures than gcc" "$builds/$1/digest.diff"
    fi
}

gcc_stage() {
    say 'gcc, release: all tests'
    CC=gcc CXX=g++ build gcc --buildtype=release && run gcc
}

tidy_stage() {
    local log=$builds/tidy.log
    say 'clang-tidy: bugprone and cert, without findings'
    need_packages clang-tidy || { skip clang-tidy 'it cannot be had'; return; }
    python3 "$top/tests/scripts/test_tidy.py" "$builds/gcc" >"$log" 2>&1
    case $? in
        0) tail -n 1 "$log" | sed 's/^/    /'; passed=$((passed + 1)) ;;
        77) skip clang-tidy 'it is not there' ;;
        *) fail 'clang-tidy' "$log" ;;
    esac
}

# As somebody meets it who has just cloned it.
quickstart_stage() {
    local log=$builds/quickstart.log kind
    say 'quickstart, the commands of the README, and the core alone'
    for kind in '' --core; do
        if REFOCUS_BUILD=$builds/quickstart$kind REFOCUS_OUT=$builds/quickstart-out \
                CC=gcc CXX=g++ "$top/examples/quickstart.sh" $kind >"$log" 2>&1; then
            passed=$((passed + 1))
        else
            fail "examples/quickstart.sh $kind" "$log"
        fi
    done
    if python3 "$top/tests/scripts/test_readme.py" "$builds/quickstart/platform/cli/refocus" \
            >"$log" 2>&1; then
        passed=$((passed + 1))
    else
        fail 'the commands of the README' "$log"
    fi
}

clang_stage() {
    say 'clang, release: all tests, the same pictures as gcc'
    need_packages clang || { skip clang 'no clang'; return; }
    CC=clang CXX=clang++ build clang --buildtype=release || return
    run clang
    same_bytes clang
}

minimal_stage() {
    say 'every optional feature off: the core alone'
    CC=gcc CXX=g++ build minimal --buildtype=release -Dauto_features=disabled \
        -Dtests=enabled || return
    run minimal
    same_bytes minimal
}

bare_stage() {
    say 'the command without cameras, windows and OpenCV: it works with what is left'
    CC=gcc CXX=g++ build bare --buildtype=release -Dv4l2=disabled -Dlibcamera=disabled \
        -Dsdl2=disabled -Dopencv=disabled -Dheic=disabled -Dtools=enabled || return
    run bare --suite cli --suite capture
}

# The filters of OpenCV's contrib modules: --long alone, as they pull in 144 libraries.
contrib_stage() {
    say "the filters of OpenCV's contrib modules"
    need_packages libopencv-contrib-dev || { skip contrib 'its libraries cannot be had'; return; }
    CC=gcc CXX=g++ build contrib --buildtype=release -Dximgproc=enabled || return
    run contrib --suite opencv --suite cli --suite quality
}

# A finding must end the program, and the reports name lines.
memory_stage() {
    say 'address and undefined behaviour sanitizers: all tests'
    CC=gcc CXX=g++ build asan --buildtype=debugoptimized -Db_sanitize=address,undefined \
        -Db_lundef=false -Dc_args=-fno-sanitize-recover=all || return
    ASAN_OPTIONS=allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 \
        LSAN_OPTIONS=suppressions=$top/tests/lsan.supp:print_suppressions=0 \
        run asan --timeout-multiplier 5
}

# The whole suite, most of which has one thread, takes a quarter of an hour of processor time.
thread_stage() {
    local which=(--suite threads --timeout-multiplier 10)

    [ "$mode" != long ] || which=(--timeout-multiplier 20)
    say "thread sanitizer: $([ "$mode" = long ] && echo all tests || echo the tests with threads)"
    CC=gcc CXX=g++ build tsan --buildtype=debugoptimized -Db_sanitize=thread -Db_lundef=false \
        || return
    # gcc 12's run time does not know kernels that place memory more randomly.
    if setarch -R true 2>/dev/null; then
        wrap=(setarch -R)
    fi
    TSAN_OPTIONS=halt_on_error=1:suppressions=$top/tests/tsan.supp run tsan "${which[@]}"
    wrap=()
}

# cross_stage STAGE ARCH PACKAGE
cross_stage() {
    say "$1 by cross compiler, emulated: the core's tests, the same pictures as gcc"
    need_packages qemu-user "$3" || { skip "$1" "no $3 or qemu-user"; return; }
    "$top/tests/cross/cmocka.sh" "$2" "$builds/cmocka-$2" >"$builds/cmocka-$2.log" 2>&1 ||
        { skip "$1" "no cmocka for $2, see $builds/cmocka-$2.log"; return; }
    build "$1" --buildtype=release --cross-file "$top/tests/cross/$1.ini" \
        --cross-file "$builds/cmocka-$2/cmocka.ini" -Dauto_features=disabled -Dsimd=enabled \
        -Dtests=enabled || return
    run "$1" --timeout-multiplier 10
    same_bytes "$1"
}

# Real drivers in a virtual machine: vivid and vimc.
camera_stage() {
    local log=$builds/camera-vm.log long= rc p f
    say 'cameras: V4L2 and libcamera drivers in a virtual machine'
    need_packages qemu-system-x86 busybox-static xz-utils gcc-12 make v4l-utils libcamera-ipa ||
        { skip camera-vm 'its packages cannot be had, see above'; return; }
    [ "$mode" != long ] || long=--long
    "$top/tests/camera-vm/test.sh" "$builds/gcc" $long >"$log" 2>&1
    rc=$?
    if [ $rc = 77 ]; then
        skip camera-vm "$(grep SKIPPED "$log" | head -n 1), see $log"
        return
    fi
    p=$(grep -c '^ok ' "$log") f=$(grep -c '^FAILED ' "$log")
    grep -E '^(ok|captured|recovered|cycles)' "$log" | sed 's/^/    /'
    passed=$((passed + p))
    [ "$rc" = 0 ] || fail 'cameras in the virtual machine' "$log"
    [ "$f" -le 1 ] || failed=$((failed + f - 1))
}

# The libcamera source against the headers of every release: --long alone, as it needs the network.
libcamera_stage() {
    local log=$builds/libcamera-releases.log
    say 'libcamera: compiled against each of its releases'
    need_packages git python3-jinja2 python3-ply python3-yaml ||
        { skip libcamera-releases 'its packages cannot be had, see above'; return; }
    CXX=g++ "$top/tests/libcamera/releases.sh" "$builds/libcamera" >"$log" 2>&1
    case $? in
        0) ;;
        77) skip libcamera-releases "$(tail -n 1 "$log")"; return ;;
        *) fail 'a release of libcamera' "$log" ;;
    esac
    grep '^ok' "$log" | sed 's/^/    /'
    passed=$((passed + $(grep -c '^ok' "$log")))
}

fuzz_stage() {
    local target name
    say 'fuzz targets: their corpora again'
    need_packages clang libclang-rt-dev || { skip fuzz 'no clang with libFuzzer'; return; }
    CC=clang CXX=clang++ build fuzz --buildtype=debugoptimized -Dfuzz=true \
        -Db_sanitize=address,undefined -Db_lundef=false -Dexamples=false \
        -Dc_args=-fno-sanitize-recover=all || return
    run fuzz --suite fuzz --timeout-multiplier 5
    [ "$mode" = long ] || return
    for target in $(find "$builds/fuzz/tests/fuzz" -name 'fuzz-*' -type f -perm -u+x | sort); do
        name=${target##*/fuzz-}
        say "fuzz target $name: $fuzz_seconds s"
        mkdir -p "$builds/fuzz/found/$name"
        if (cd "$builds/fuzz/found" && "$target" -max_total_time="$fuzz_seconds" -print_final_stats=1 \
                -rss_limit_mb=2048 -timeout=20 "$name" \
                "$top/tests/fuzz/${name%%-*}/corpus/${name#*-}" \
                >"$name.log" 2>&1); then
            passed=$((passed + 1))
        else
            fail "fuzz target $name" "$builds/fuzz/found/$name.log"
        fi
    done
}

need_packages meson ninja-build pkg-config gcc g++ libc6-dev python3 libcmocka-dev ||
    { fail 'tools to build with are missing'; finish; }
need_packages libopencv-core-dev libopencv-imgproc-dev libopencv-calib3d-dev libopencv-dnn-dev \
    libturbojpeg0-dev libpng-dev libexpat1-dev libheif-dev libjansson-dev ||
    skip 'picture files and the refocus command' 'their libraries are missing'
need_packages libcamera-dev || skip libcamera 'its library is missing'
need_packages libsdl2-dev xvfb xdotool || skip 'the window' 'SDL2, Xvfb or xdotool is missing'
need_packages abigail-tools || skip 'the ABI of the last release' 'no abidiff'
need_packages clang-format || skip 'the layout of the source' 'no clang-format'

gcc_stage
if [ "$mode" != one ]; then
    tidy_stage
    quickstart_stage
    clang_stage
    camera_stage
    minimal_stage
    bare_stage
    memory_stage
    thread_stage
    cross_stage aarch64 arm64 g++-aarch64-linux-gnu
    cross_stage armv7 armhf g++-arm-linux-gnueabihf
    fuzz_stage
fi
[ "$mode" != long ] || { contrib_stage; libcamera_stage; }
finish
