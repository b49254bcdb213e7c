#!/bin/sh
# usage: debian.sh SOURCE WORK_FOLDER
# Builds the small set of Debian's packages, looks for errors of lintian, unpacks them into a folder of
# their own, and uses the command, the module for Python and the headers there.
set -eu
source=$1 work=$2
PATH=/usr/sbin:/usr/bin:/sbin:/bin
"$source/platform/packages/debian.sh" "$work" small
cd "$work"
lintian --fail-on error --no-tag-display-limit *.deb
rm -rf root
for package in *.deb; do
    case $package in *-dbgsym_*) ;; *) dpkg-deb -x "$package" root ;; esac
done
libraries=$(dirname "$(find root -name librefocus.so)")
export LD_LIBRARY_PATH="$work/$libraries"
root/usr/bin/refocus --version
PYTHONPATH=$work/root/usr/lib/python3/dist-packages
export PYTHONPATH
python3 "$source/tests/python/test_python.py" "$PYTHONPATH" "$work/root/usr/bin/refocus"
PKG_CONFIG_SYSROOT_DIR=$work/root PKG_CONFIG_LIBDIR=$work/$libraries/pkgconfig:$(pkg-config --variable pc_path pkg-config)
export PKG_CONFIG_SYSROOT_DIR PKG_CONFIG_LIBDIR
PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
export PKG_CONFIG_ALLOW_SYSTEM_CFLAGS PKG_CONFIG_ALLOW_SYSTEM_LIBS
# shellcheck disable=SC2046
cc -std=c11 -o consumer "$source/tests/consumers/project/consumer.c" \
    $(pkg-config --cflags --libs refocus refocus-papers refocus-file)
./consumer
