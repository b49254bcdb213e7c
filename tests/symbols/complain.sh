# complain.sh: read by the tests beside it, which end with `exit $failed`.
failed=0

# complain WHAT NAMES
complain() {
    [ -z "$2" ] && return
    printf '%s:\n%s\n' "$1" "$2"
    failed=1
}
