#!/usr/bin/env bash
# usage: tests/pages.sh BUILD [PAGE...]           makes the pages of measurements anew, all or these
#        tests/pages.sh --check BUILD [PAGE...]   compares their scores with what BUILD renders
#
# Pages of scores: quality, depth, papers, stack. Pages of times, for an idle machine: performance, rivals,
# arm, view, strokes. readme is the table in the README, of quality and performance. BUILD is a release
# build. Scenes are those in examples/data, unless REFOCUS_SCENES names a folder. What a page needs and
# is not there costs its own sections, and is said; the exit status is 1 when a page failed.
set -u -o pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
check=
[ "${1-}" != --check ] || { check=--check; shift; }
if [ ! -x "${1-}/platform/cli/refocus" ]; then
    sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
build=$(cd "$1" && pwd)
shift
if [ $# = 0 ]; then
    set -- quality depth papers
    [ -n "$check" ] || set -- "$@" stack performance rivals arm view strokes
    set -- "$@" readme
fi
failed=0

# page SCRIPT ARGUMENTS...: a page that cannot be made does not keep others from it
page() {
    printf '== %s  (%s)\n' "$1" "$(date +%H:%M:%S)"
    python3 "$top/tests/$@"
    case $? in
        0) ;;
        77) echo "    SKIPPED $1" ;;
        *) echo "    FAILED  $1"; failed=1 ;;
    esac
}

for name; do
    case $name in
        quality) page quality/run.py "$build" $check ;;
        depth) page quality/depth.py "$build" $check ;;
        stack) page stack_scores.py "$build" $check ;;
        papers) page papers/papers.py "$build" $check ;;
        performance | rivals) page "$name.py" "$build" ;;
        arm) page arm/count.py ;;
        view | strokes) page "${name}_times.py" "$build" ;;
        readme) page readme_measured.py $check ;;
        *) echo "tests/pages.sh: no page '$name'" >&2; failed=1 ;;
    esac
done
exit $failed
