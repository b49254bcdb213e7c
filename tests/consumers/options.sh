#!/bin/sh
# usage: options.sh SOURCE WORK_FOLDER
# Options of meson that cannot go together are refused in words.
set -eu
source=$1 work=$2
rm -rf "$work"
if meson setup "$work" "$source" -Dauto_features=disabled -Dexamples=false -Dtools=enabled \
        -Dweb=enabled >"$work.log" 2>&1; then
    echo 'a page without JPEG is built, which shows nothing'
    exit 1
fi
grep 'pictures go to the page as JPEG' "$work.log"
