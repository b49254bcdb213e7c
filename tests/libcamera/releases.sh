#!/bin/bash
# usage: releases.sh FOLDER [GIT]
# Compiles the libcamera source and the example of a loop of one's own against the public headers
# of each release of libcamera since 0.0.3, from its repository, with all warnings. A line a
# release; exit status 0, 1 when one failed, 77 when the repository or a tool is missing.
# Headers are kept in FOLDER. Needs git, meson, ninja, python3 with jinja2, ply and yaml.
set -u -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ $# -ge 1 ] || { sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2; }
mkdir -p "$1" && folder=$(cd "$1" && pwd) || exit 2
git=${2:-https://git.libcamera.org/libcamera/libcamera.git}
failed=0 passed=0
# Generators ask for python3 by name: Debian's has the modules that Debian's packages install.
PATH=/usr/bin:/bin:$PATH

skip() { echo "SKIPPED libcamera releases: $1"; exit 77; }

python3 -c 'import jinja2, ply, yaml' 2>/dev/null || skip 'python3 has no jinja2, ply and yaml'
if [ ! -d "$folder/git" ] && ! git clone -q --bare "$git" "$folder/git" 2>"$folder/clone.log"; then
    rm -rf "$folder/git"
    skip "$git cannot be cloned, see $folder/clone.log"
fi

# headers TAG: its public headers, the generated ones too, without building the rest
headers() {
    local source=$folder/$1 build=$folder/$1-headers
    [ ! -e "$build/done" ] || return 0
    rm -rf "$source" "$build"
    mkdir -p "$source"
    git -C "$folder/git" archive "$1" | tar -x -C "$source" || return
    meson setup "$build" "$source" --wrap-mode=nodownload -Dpipelines=vimc -Dipas=vimc \
        -Dauto_features=disabled >"$build.log" 2>&1 || return
    # shellcheck disable=SC2046 # names of targets, without blanks
    ninja -C "$build" $(ninja -C "$build" -t targets all |
        sed -n 's/^\(include\/libcamera\/[a-z_]*\.h\): CUSTOM.*/\1/p') >>"$build.log" 2>&1 || return
    touch "$build/done"
}

# compile TAG SOURCE
compile() {
    ${CXX:-g++} -std=c++17 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -I"$top/include" \
        -I"$top/platform/capture" -isystem "$folder/$1-headers/include" \
        -isystem "$folder/$1/include" "$2"
}

for tag in $(git -C "$folder/git" tag | sort -V); do
    case $tag in
        v0.0.[012]) continue ;;
    esac
    if ! headers "$tag"; then
        echo "FAILED $tag: no headers, see $folder/$tag-headers.log"
        failed=1
        continue
    fi
    for source in "$top"/platform/libcamera/*.cpp "$top/examples/own_libcamera_loop.cpp"; do
        if ! compile "$tag" "$source"; then
            echo "FAILED $tag: ${source##*/}"
            failed=1
            continue 2
        fi
    done
    echo "ok libcamera $tag"
    passed=$((passed + 1))
done
[ "$passed" -gt 0 ] || { echo 'FAILED: no release was found'; exit 1; }
exit $failed
