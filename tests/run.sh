#!/usr/bin/env bash
# usage: tests/run.sh [--full | --long]
#
# Builds with gcc on Debian 12, installing what is missing, and runs the tests of that build: at
# most six minutes on two cores. The last line is 'N passed, N failed, N skipped', the sum over all
# builds; skipped cases of Python's tests count, too. The exit status is 1 when anything failed.
#   --full  also the pages of scores, clang, clang-tidy, sanitizers, AArch64 and ARMv7 (emulated),
#           builds with parts left out, cameras in a virtual machine, the quickstart
#   --long  also runs all tests under the sanitizers and emulated, those of the core and of our own
#           parsers under clang's memory and integer sanitizers, lets each fuzz target search for a
#           minute, opens and closes a V4L2 camera 10,000 times, builds the module of OpenCV's
#           contrib filters, compiles against each release of libcamera, and builds and tries the
#           packages (wheel, subproject of meson, musl, Debian)
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
            sed -n '2,14s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
            [ "$argument" = --help ]
            exit $(($? * 2))
            ;;
    esac
done
. "$top/tests/packages.sh"
passed=0 failed=0 skipped=0 suites=()
if ! mkdir -p "$builds" 2>/dev/null || [ ! -w "$builds" ]; then
    echo "$builds cannot be written: set REFOCUS_BUILDS to a folder that can" >&2
    exit 2
fi
trap 'exit 130' INT # meson ends by itself, and the next stage would begin

finish() {
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" = 0 ] && [ "$passed" -gt 0 ]
    exit
}

# say STAGE: begins one
say() {
    suites=()
    printf '== %s  (%s)\n' "$1" "$(date +%H:%M:%S)"
}

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

# build STAGE MESON_ARGUMENTS...: sets up anew or again, and compiles what the tests of the suites
# in `suites` need, all when there are none
build() {
    local dir=$builds/$1 log=$builds/$1.log again=() parts=()
    shift
    [ ! -e "$dir/build.ninja" ] || again=(--reconfigure)
    if ! meson setup "${again[@]}" "$dir" "$top" "$@" >"$log" 2>&1; then
        rm -rf "$dir"
        meson setup "$dir" "$top" "$@" >"$log" 2>&1 || { fail "${dir##*/}: meson setup" "$log"; return 1; }
    fi
    [ ${#suites[@]} = 0 ] || mapfile -t parts < <("$top/tests/needed.py" "$dir" "${suites[@]}")
    ninja -C "$dir" "${parts[@]}" >>"$log" 2>&1 ||
        { fail "${dir##*/}: compiling" "$log"; return 1; }
    if grep -q 'warning:' "$log"; then
        grep 'warning:' "$log" | sort -u | head -n 20 >"$log.warnings"
        fail "${dir##*/}: the compiler warns" "$log.warnings"
    fi
}

# run STAGE MESON_TEST_ARGUMENTS...: runs the tests, of `suites` if there are any, and adds up
# their results
run() {
    local dir=$builds/$1 p f s suite
    shift
    for suite in "${suites[@]}"; do
        set -- "$@" --suite "$suite"
    done
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

# run_brief ...: as run, but for --long with fewer tests of the command
run_brief() {
    if [ "$mode" = long ]; then run "$@"; else REFOCUS_BRIEF=1 run "$@"; fi
}

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

# Kernels take most of the time to compile with sanitizers: of the vector ones AVX2 alone, as the
# same source makes the others.
one_set=()
[ "$(uname -m)" != x86_64 ] || one_set=(-Dsimd_sets=avx2)

gcc_stage() {
    say 'gcc, release: all tests'
    CC=$gcc CXX=$gxx build gcc --buildtype=release && run gcc
}

# As on threads of callers, which may have little: 64 KiB for main() and all threads.
small_stack_stage() {
    say 'the core on stacks of 64 KiB'
    run gcc --suite render --suite papers --suite core --wrapper 'prlimit --stack=65536'
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

# A page that is older than what it measures fails with the rows that moved.
pages_stage() {
    local log=$builds/pages.log
    say 'pages of scores: as this tree renders'
    if "$top/tests/pages.sh" --check "$builds/gcc" >"$log" 2>&1; then
        passed=$((passed + 1))
    else
        fail 'a page of scores' "$log"
    fi
}

# As somebody meets it who has just cloned it.
quickstart_stage() {
    local log=$builds/quickstart.log kind
    say 'quickstart, the commands of the README, and the core alone'
    for kind in '' --core; do
        if REFOCUS_BUILD=$builds/quickstart$kind REFOCUS_OUT=$builds/quickstart-out \
                CC=$gcc CXX=$gxx "$top/examples/quickstart.sh" $kind >"$log" 2>&1; then
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
    say 'clang, release: all but the command, the same pictures as gcc'
    need_packages clang || { skip clang 'no clang'; return; }
    CC=clang CXX=clang++ build clang --buildtype=release || return
    run clang --no-suite cli --no-suite scripts --no-suite web
    same_bytes clang
}

minimal_stage() {
    say 'every optional feature off: the core alone'
    suites=(processors headers file capture strokes fuzz)
    CC=$gcc CXX=$gxx build minimal --buildtype=release -Dauto_features=disabled \
        -Dtests=enabled || return
    run minimal
    same_bytes minimal
}

bare_stage() {
    say 'the command without cameras, windows and OpenCV: it works with what is left'
    CC=$gcc CXX=$gxx build bare --buildtype=release -Dv4l2=disabled -Dlibcamera=disabled \
        -Dpipewire=disabled -Dsdl2=disabled -Dopencv=disabled -Dheic=disabled -Dtools=enabled || return
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
        -Db_lundef=false -Dc_args=-fno-sanitize-recover=all "${one_set[@]}" || return
    ASAN_OPTIONS=allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 \
        LSAN_OPTIONS="suppressions='$top/tests/lsan.supp':print_suppressions=0" \
        run_brief asan --timeout-multiplier 5
}

# The whole suite, most of which has one thread, takes a quarter of an hour of processor time.
# Threads of OpenCV, libcamera, PipeWire and GLib are not ours to judge.
thread_stage() {
    say "thread sanitizer: $([ "$mode" = long ] && echo all tests || echo the tests with threads)"
    [ "$mode" = long ] || suites=(threads)
    CC=gcc CXX=g++ build tsan --buildtype=debugoptimized -Db_sanitize=thread -Db_lundef=false \
        -Dopencv=disabled -Dlibcamera=disabled -Dpipewire=disabled -Dgstreamer=disabled \
        -Dgegl=disabled -Dexamples=false \
        "${one_set[@]}" || return
    # gcc 12's run time does not know kernels that place memory more randomly.
    if setarch -R true 2>/dev/null; then
        wrap=(setarch -R)
    fi
    TSAN_OPTIONS="halt_on_error=1:suppressions='$top/tests/tsan.supp'" run_brief tsan --timeout-multiplier 20
    wrap=()
}

# cross_stage STAGE ARCH PACKAGE: emulated, a test takes ten times as long, so that of the tests
# those run whose answer the processor could change; --long has the others.
cross_stage() {
    say "$1 by cross compiler, emulated: the same pictures as gcc"
    need_packages qemu-user "$3" || { skip "$1" "no $3 or qemu-user"; return; }
    "$top/tests/cross/cmocka.sh" "$2" "$builds/cmocka-$2" >"$builds/cmocka-$2.log" 2>&1 ||
        { skip "$1" "no cmocka for $2, see $builds/cmocka-$2.log"; return; }
    build "$1" --buildtype=release --cross-file "$top/tests/cross/$1.ini" \
        --cross-file "$builds/cmocka-$2/cmocka.ini" -Dauto_features=disabled -Dsimd=enabled \
        -Dtests=enabled || return
    # All is compiled, as on a machine of that kind; what is run is what processors may change.
    [ "$mode" = long ] || suites=(processors)
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

# try_package NAME PROGRAM ARGUMENTS...: as somebody who builds or installs the library
try_package() {
    local log=$builds/$1.log name=$1
    shift
    "$@" >"$log" 2>&1
    case $? in
        0) passed=$((passed + 1)) ;;
        77) skip "$name" "see $log" ;;
        *) fail "$name" "$log" ;;
    esac
}

# Without vector kernels, which take most of the time to compile: --long alone all the same.
packages_stage() {
    say 'packages: a wheel, a subproject of meson, musl'
    need_packages musl-tools python3-pip python3-wheel ||
        { skip packages 'what builds them cannot be had'; return; }
    try_package wheel "$top/tests/python/wheel.sh" "$top" "$builds/wheel" /usr/bin/python3 \
        -Dsimd=disabled
    try_package subproject "$top/tests/consumers/subproject.sh" "$top" "$builds/subproject" compile
    try_package musl "$top/tests/consumers/musl.sh" "$top" "$builds/musl"
    need_packages debhelper dh-python lintian || { skip debian 'no debhelper'; return; }
    try_package debian "$top/tests/consumers/debian.sh" "$top" "$builds/debian"
}

# 200,000 frames of which 1 % have a fault: memory and descriptors stay as they were.
soak_stage() {
    say 'soak: 200,000 frames, 1 % of them with a fault'
    try_package soak python3 "$top/tests/cli/soak.py" "$builds/gcc/platform/cli/refocus"
    head -n 4 "$builds/soak.log" | sed 's/^/    /'
}

lists=$top/tests/sanitizers # of what sanitizers pass over, and why

# Memory that nobody wrote. Libraries of others are not built for it, so that only what the core and
# our own parsers do is looked at. The suite render is not: the renderer leaves tiles out whose light
# nobody looks at, and computes with their rows as they are.
uninitialised_stage() {
    say 'memory sanitizer: the core and our own parsers'
    need_packages clang libclang-rt-dev || { skip msan 'no clang with sanitizers'; return; }
    suites=(core papers kernels file capture strokes fuzz)
    CC=clang CXX=clang++ build msan --buildtype=debugoptimized -Db_sanitize=memory -Db_lundef=false \
        -Dauto_features=disabled -Dtests=enabled -Dsimd=enabled -Dexamples=false "${one_set[@]}" \
        "-Dc_args=-fsanitize-ignorelist='$lists/memory.txt' -fsanitize-memory-track-origins" || return
    clang -shared -fPIC -o "$builds/msan/stat.so" "$lists/stat.c" ||
        { fail 'msan: tests/sanitizers/stat.c'; return; }
    run msan --timeout-multiplier 20 --wrapper "env 'LD_PRELOAD=$builds/msan/stat.so'"
}

# Sizes, counts and offsets that wrap or are cut to fewer bits unsaid.
integer_stage() {
    local checks=unsigned-integer-overflow,signed-integer-overflow,shift,integer-divide-by-zero
    checks+=,implicit-integer-truncation
    say 'integer sanitizer: the core and our own parsers'
    need_packages clang libclang-rt-dev libturbojpeg0-dev libpng-dev libexpat1-dev ||
        { skip integer 'no clang with sanitizers, or no libraries'; return; }
    suites=(core papers render file capture strokes fuzz)
    CC=clang CXX=clang++ build integer --buildtype=debugoptimized -Db_lundef=false \
        -Dauto_features=disabled -Dtests=enabled -Dsimd=disabled -Dexamples=false \
        -Djpeg=enabled -Dpng=enabled -Dxmp=enabled "-Dc_link_args=-fsanitize=$checks" \
        "-Dc_args=-fsanitize=$checks -fno-sanitize-recover=all -fsanitize-ignorelist='$lists/integer.txt'" ||
        return
    REFOCUS_BRIEF=1 run integer --timeout-multiplier 5
}

# The corpora, which every build's tests run, under clang's sanitizers, and a minute of searching each.
fuzz_stage() {
    local name log=$builds/fuzz_runs.log
    say 'fuzz targets'
    need_packages clang libclang-rt-dev || { skip fuzz 'no clang with libFuzzer'; return; }
    CC=clang CXX=clang++ build fuzz --buildtype=debugoptimized -Dfuzz=true \
        -Db_sanitize=address,undefined -Db_lundef=false -Dexamples=false \
        -Dc_args=-fno-sanitize-recover=all "${one_set[@]}" || return
    run fuzz --suite fuzz --timeout-multiplier 5
    say "fuzz targets: $fuzz_seconds s each"
    "$top/tests/fuzz_runs.py" "$builds/fuzz" "$builds/fuzz/found" --seconds "$fuzz_seconds" \
        2>&1 | tee "$log" | sed 's/^/    /'
    passed=$((passed + $(grep -c ' edges$' "$log")))
    while read -r name; do
        fail "fuzz target $name" "$builds/fuzz/found/$name.log"
    done < <(sed -n 's/: .*, FOUND SOMETHING$//p' "$log")
}

need_packages meson ninja-build pkg-config gcc g++ libc6-dev python3 libcmocka-dev ||
    { fail 'tools to build with are missing'; finish; }
need_packages libopencv-core-dev libopencv-imgproc-dev libopencv-calib3d-dev libopencv-dnn-dev \
    libturbojpeg0-dev libpng-dev libexpat1-dev libheif-dev libjansson-dev ||
    skip 'picture files and the refocus command' 'their libraries are missing'
need_packages libtiff-dev libopenexr-dev libwebp-dev libjxl-dev libraw-dev libzip-dev ||
    skip 'TIFF, OpenEXR, WebP, JPEG XL, camera raw and archives of NumPy' 'their libraries are missing'
need_packages libheif-examples libjxl-tools webp ||
    skip 'AVIF, JPEG XL and WebP in the corpus of photos' 'the programs that write them are missing'
need_packages libcamera-dev || skip libcamera 'its library is missing'
need_packages libmicrohttpd-dev || skip 'refocus serve' 'libmicrohttpd is missing'
need_packages libsdl2-dev libsdl2-ttf-dev fonts-dejavu-core xvfb xdotool ||
    skip 'the window' 'SDL2, SDL2_ttf, a font, Xvfb or xdotool is missing'
need_packages python3-dev python3-numpy python3-distributed ||
    skip 'the package for Python' 'Python.h, numpy or Dask is missing'
need_packages libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev gstreamer1.0-tools \
    gstreamer1.0-plugins-base gstreamer1.0-plugins-good || skip 'the element of GStreamer' 'GStreamer is missing'
need_packages libpipewire-0.3-dev pipewire pipewire-bin wireplumber dbus-daemon gstreamer1.0-pipewire ||
    skip PipeWire 'its library, daemon, session manager or elements of GStreamer are missing'
need_packages libgegl-dev gegl gimp || skip 'the operation of GEGL' 'GEGL or GIMP is missing'
need_packages cmake || skip 'a program built by CMake' 'no cmake'
need_packages abigail-tools || skip 'the ABI of the last release' 'no abidiff'
need_packages clang-format || skip 'the layout of the source' 'no clang-format'
[ "$mode" = one ] || need_packages "${page_packages[@]}" ||
    skip 'the page in a browser' 'Chromium, its driver or Selenium is missing'
# Rules of axe-core, besides the checks of tests/web/audit.py, where npm can fetch them.
axe=axe-core-4.10.3
if [ "$mode" != one ] && command -v npm >/dev/null && mkdir -p "$builds/axe" &&
    (cd "$builds/axe" && timeout 120 npm pack --silent "${axe%-*}@${axe##*-}" && tar xzf "$axe.tgz") >/dev/null 2>&1; then
    export REFOCUS_AXE=$builds/axe/package/axe.min.js
else
    echo '    axe-core is not there: the page is tested by its own checks alone'
fi

# Files that several of gcc's release builds compile alike are compiled once.
gcc=gcc gxx=g++
if [ "$mode" != one ] && need_packages ccache; then
    gcc='ccache gcc' gxx='ccache g++'
    export CCACHE_DIR=$builds/ccache CCACHE_NOHASHDIR=1
fi

gcc_stage
if [ "$mode" != one ]; then
    small_stack_stage
    tidy_stage
    pages_stage
    quickstart_stage
    clang_stage
    camera_stage
    minimal_stage
    bare_stage
    memory_stage
    thread_stage
    cross_stage aarch64 arm64 g++-aarch64-linux-gnu
    cross_stage armv7 armhf g++-arm-linux-gnueabihf
fi
if [ "$mode" = long ]; then
    uninitialised_stage
    integer_stage
    fuzz_stage
    packages_stage
    soak_stage
    contrib_stage
    libcamera_stage
fi
finish
