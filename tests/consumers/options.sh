#!/bin/sh
# usage: options.sh SOURCE WORK_FOLDER
# What is asked of meson is built or refused in words; and parts can be left out one by one.
set -eu
source=$1 work=$2
rm -rf "$work"
mkdir -p "$work"

# refused WORDS OPTION...: a build of these parts alone is refused with these words.
refused() {
    words=$1
    shift
    if meson setup "$work/refused" "$source" -Dauto_features=disabled -Dexamples=false "$@" \
            >"$work/log" 2>&1; then
        echo "not refused: $*"
        exit 1
    fi
    grep "$words" "$work/log"
    rm -rf "$work/refused"
}
refused 'pictures go to the page as JPEG' -Dtools=enabled -Dweb=enabled
refused 'the page is served by the command' -Djpeg=enabled -Dweb=enabled
refused 'text is drawn in the window' -Dsdl2_ttf=enabled
refused 'by the library of option opencv' -Dximgproc=enabled
refused 'static ones are built beside' -Ddefault_library=static

# Without the command there are its tests neither, and no window of it.
if ! meson setup "$work/no-command" "$source" -Dtools=disabled >"$work/log" 2>&1; then
    tail "$work/log"
    exit 1
fi
grep 'refocus view *: NO' "$work/log"
! grep -q refocus-view.so "$work/no-command/build.ninja"
