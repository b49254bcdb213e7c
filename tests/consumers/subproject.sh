#!/bin/sh
# usage: subproject.sh SOURCE WORK_FOLDER [compile]
# A meson project of somebody else's that has the library as a subproject, by librefocus.wrap: it is set
# up and, with `compile`, built without vector kernels and run.
set -eu
source=$1 work=$2
rm -rf "$work"
mkdir -p "$work/project/subprojects"
cp "$source"/tests/consumers/project/* "$work/project"
cp "$source/platform/packages/librefocus.wrap" "$work/project/subprojects"
# Where the clone would be.
ln -s "$source" "$work/project/subprojects/librefocus"
meson setup "$work/build" "$work/project" -Dauto_features=disabled -Dlibrefocus:examples=false
[ "${3-}" != compile ] || meson test -C "$work/build" consumer
