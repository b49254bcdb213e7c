#!/usr/bin/env bash
# usage: cmocka.sh arm64|armhf DEST
#
# Unpacks Debian's cmocka of another architecture into DEST and writes DEST/cmocka.ini,
# to be given to meson after aarch64.ini or armv7.ini. apt works in a root of its own,
# DEST/apt, with the host's package sources: a foreign architecture on the host itself
# would remove development packages. Needs no root.
set -euo pipefail
case ${1-} in
    arm64) triple=aarch64-linux-gnu qemu=qemu-aarch64 ;;
    armhf) triple=arm-linux-gnueabihf qemu=qemu-arm ;;
    *) echo "usage: cmocka.sh arm64|armhf DEST" >&2; exit 2 ;;
esac
arch=$1
mkdir -p "$2"
dest=$(cd "$2" && pwd)
apt=$dest/apt

if [ ! -e "$dest/usr/lib/$triple/libcmocka.so" ]; then
    rm -rf "$apt"
    mkdir -p "$apt"/etc/apt/{apt.conf.d,preferences.d,sources.list.d} \
             "$apt"/var/lib/apt/lists/partial "$apt"/var/cache/apt/archives/partial \
             "$apt"/var/lib/dpkg
    : > "$apt/var/lib/dpkg/status"
    [ ! -f /etc/apt/sources.list ] || cp /etc/apt/sources.list "$apt/etc/apt/"
    for f in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list.d/*.list; do
        [ ! -f "$f" ] || cp "$f" "$apt/etc/apt/sources.list.d/"
    done
    cat > "$apt/apt.conf" <<EOF
Dir "$apt";
Dir::State::status "$apt/var/lib/dpkg/status";
APT::Architecture "$arch";
APT::Architectures { "$arch"; };
APT::Sandbox::User "";
Acquire::Languages "none";
EOF
    export APT_CONFIG=$apt/apt.conf
    # One index out of step does not matter: cmocka is in the main one.
    apt-get -qq update >&2 || echo "cmocka.sh: not every package index was read" >&2
    (cd "$apt" && apt-get -qq download libcmocka0 libcmocka-dev >&2)
    for f in "$apt"/*.deb; do
        dpkg-deb -x "$f" "$dest"
    done
    rm -rf "$apt"
fi

cat > "$dest/cmocka.ini" <<EOF
[binaries]
exe_wrapper = ['$qemu', '-L', '/usr/$triple', '-E', 'LD_LIBRARY_PATH=$dest/usr/lib/$triple']

[properties]
sys_root = '$dest'
pkg_config_libdir = ['$dest/usr/lib/$triple/pkgconfig']
EOF
