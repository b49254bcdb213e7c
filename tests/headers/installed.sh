#!/bin/sh
# usage: installed.sh SOURCE BUILD WORK_FOLDER COMPILER...
# Installs into WORK_FOLDER, then builds and runs the program in README.md and the
# examples as a user would: by pkg-config, with nothing else from the source tree.
set -eu
source=$1 build=$2 work=$3
shift 3
rm -rf "$work"
mkdir -p "$work/src"
case $work in
    *' '*) # A sysroot of pkg-config has none.
        link=$(mktemp -d)
        trap 'rm -rf "$link"' EXIT
        ln -s "$work" "$link/work"
        work=$link/work
        ;;
esac
DESTDIR=$work/dest meson install -C "$build" --no-rebuild >"$work/install.log"

pc=$(find "$work/dest" -name refocus.pc)
PKG_CONFIG_LIBDIR=${pc%/*}:$(pkg-config --variable pc_path pkg-config)
export PKG_CONFIG_LIBDIR PKG_CONFIG_SYSROOT_DIR="$work/dest"
export PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
LD_LIBRARY_PATH=$(pkg-config --variable=libdir refocus)
case $LD_LIBRARY_PATH in "$work"/*) ;; *) LD_LIBRARY_PATH=$work/dest$LD_LIBRARY_PATH ;; esac
export LD_LIBRARY_PATH
[ -e "$LD_LIBRARY_PATH/librefocus.so" ] || { echo "no librefocus.so in $LD_LIBRARY_PATH"; exit 1; }

awk '/^```c$/ {on = 1; next} /^```$/ {on = 0} on' "$source/README.md" >"$work/src/readme.c"
[ -s "$work/src/readme.c" ] || { echo 'README.md shows no C program'; exit 1; }
cp "$source"/examples/*.c "$work/src"

cd "$work"
for program in src/*.c; do
    name=$(basename "$program" .c)
    packages=refocus
    ! grep -q '<refocus/platform/' "$program" || packages='refocus refocus-file refocus-capture'
    # shellcheck disable=SC2046,SC2086
    "$@" -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -pedantic -Werror -o "$name" \
        "$program" $(pkg-config --cflags --libs $packages) -lm -pthread
    wanted=0
    case $name in live_*) wanted=2 ;; esac # they take arguments, and say so
    status=0
    "./$name" || status=$?
    [ "$status" = "$wanted" ] || { echo "$name ends with $status, not $wanted"; exit 1; }
    echo "ok $name"
done

# The static library, with what its pkg-config file says it needs.
archive=$(find "$work/dest" -name librefocus.a)
# shellcheck disable=SC2046
"$@" -std=c11 -o static src/readme.c $(pkg-config --cflags refocus) "$archive" \
    $(pkg-config --static --libs-only-l refocus | sed 's/-lrefocus//') -lm -pthread
LD_LIBRARY_PATH='' ./static
echo 'ok readme, static'

# The one library in C++, from C.
archive=$(find "$work/dest" -name librefocus-opencv.a)
if [ -n "$archive" ]; then
    cat >src/network.c <<'END'
#include <refocus/platform/opencv.h>
int main(void) { return !refocus_cv_network_name(0); }
END
    # shellcheck disable=SC2046
    "$@" -std=c11 -o network src/network.c $(pkg-config --cflags refocus-opencv) "$archive" \
        $(pkg-config --static --libs-only-l refocus-opencv | sed 's/-lrefocus-opencv//') -lm -pthread
    ./network
    echo 'ok opencv, static'
fi

# By CMake, in C and C++.
if command -v cmake >/dev/null && command -v c++ >/dev/null; then
    flags=
    for word; do case $word in -fsanitize=*) flags=$word ;; esac done
    config=$(find "$work/dest" -name refocus-config.cmake)
    cmake -S "$source/tests/consumers/project" -B cmake -DCMAKE_PREFIX_PATH="${config%/lib*/cmake/*}" \
        -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="-Wall -Wextra -pedantic -Werror $flags" >cmake.log 2>&1 && cmake --build cmake >>cmake.log 2>&1 ||
        { cat cmake.log; exit 1; }
    ./cmake/consumer
    ./cmake/consumer_cpp
    echo 'ok find_package(refocus)'
    # Where libraries are static the core is found alone, and the error says what is there.
    find "$work/dest" -name '*.so*' -delete
    cmake -S "$source/tests/consumers/project" -B cmake-static -DCMAKE_PREFIX_PATH="${config%/lib*/cmake/*}" \
        >cmake.log 2>&1 && exit 1
    tr -s ' \n' ' ' <cmake.log | grep -o 'is there as a static library'
fi
