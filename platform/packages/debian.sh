#!/usr/bin/env bash
# usage: debian.sh WORK_FOLDER [small]
#
# Makes Debian's packages of the sources that git has, in WORK_FOLDER. With `small` without OpenCV,
# libcamera, PipeWire, SDL2, vector kernels and optimisation, which is enough to try the packages out.
set -eu -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mkdir -p "$1" && cd "$1" && pwd)
version=$(sed -n "s/^ *version: '\([^']*\)'.*/\1/p" "$top/meson.build" | head -n 1)
tree=$work/librefocus-$version
profiles=()
if [ "${2-}" = small ]; then
    profiles=(--build-profiles=pkg.librefocus.small)
    export DEB_BUILD_OPTIONS='noopt noautodbgsym'
fi

rm -rf "$tree" "$work"/*.deb
mkdir -p "$tree"
git -C "$top" archive HEAD | tar -x -C "$tree"
cp -r "$top/platform/packages/debian" "$tree/debian"
cat >"$tree/debian/changelog" <<END
librefocus ($version) unstable; urgency=medium

  * See CHANGELOG.md.

 -- the librefocus authors <librefocus@example.org>  $(git -C "$top" log -1 --format=%cD)
END
cd "$tree"
dpkg-buildpackage -us -uc -b "${profiles[@]}"
ls -l "$work"/*.deb
