#!/bin/sh
# usage: wheel.sh SOURCE WORK_FOLDER PYTHON [OPTIONS_OF_MESON]
# Builds the wheel of the package, installs it alone, and runs the tests of the package with it.
set -eu
source=$1 work=$2 python=$3 options=${4-}
rm -rf "$work"
mkdir -p "$work"
"$python" -m pip wheel --no-build-isolation --no-deps --config-settings "setup-args=$options" \
    --wheel-dir "$work" "$source/platform/python"
"$python" -m pip install --no-deps --no-index --target "$work/installed" "$work"/*.whl
# The C library, and those of the picture files that the system has.
if readelf -d "$work/installed/refocus/_core.abi3.so" | grep NEEDED |
        grep -Ev '\[(libc|libm|libpthread|libpng16|libturbojpeg|libexpat|ld-linux[^]]*)\.so\.[0-9]+\]'; then
    echo 'the wheel needs more than the C library and those of picture files'
    exit 1
fi
for library in libpng:PNG libturbojpeg:JPEG; do
    ! pkg-config --exists "${library%:*}" || PYTHONPATH=$work/installed "$python" -c \
        'import sys, refocus; sys.exit(sys.argv[1] not in refocus.file_formats())' "${library#*:}" || {
        echo "the wheel does not read ${library#*:}"
        exit 1
    }
done
for test in test_python test_calls; do
    "$python" "$source/tests/python/$test.py" "$work/installed"
done
