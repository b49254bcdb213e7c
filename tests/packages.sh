# Sourced by scripts: installs Debian packages that are missing.

# What builds the library and a program that uses it; and what the README's commands use.
core_packages=(meson ninja-build gcc libc6-dev)
feature_packages=(pkg-config g++ libpng-dev libturbojpeg0-dev libexpat1-dev libheif-dev
    libjansson-dev libsdl2-dev libsdl2-ttf-dev fonts-dejavu-core libcamera-dev
    libopencv-core-dev libopencv-imgproc-dev
    libopencv-calib3d-dev libopencv-dnn-dev libtiff-dev libopenexr-dev libwebp-dev libjxl-dev
    libraw-dev libzip-dev libmicrohttpd-dev libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev
    libgegl-dev libpipewire-0.3-dev python3-dev python3-numpy)

# The page of `refocus serve` is tried in a browser: tests/run.sh --full.
page_packages=(chromium chromium-driver python3-selenium)

have_package() {
    # A program that came another way will do: meson, ninja, gcc, clang, ...
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ] ||
        command -v "${1%-build}" >/dev/null 2>&1
}

# need_packages PACKAGE...: 0 when all are there in the end; else says what to do, 1
need_packages() {
    local missing=() as=() package

    for package; do
        have_package "$package" || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "Missing, and there is no apt-get: install what Debian 12 calls ${missing[*]}" >&2
        return 1
    fi
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            echo "Missing, and neither root nor sudo: as root, run" >&2
            echo "    apt-get install ${missing[*]}" >&2
            return 1
        fi
        as=(sudo)
    fi
    echo "Installing: ${missing[*]}" >&2
    "${as[@]}" apt-get -qq update >&2 || echo "apt-get update failed; going on" >&2
    if ! "${as[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null; then
        echo "apt-get could not install: ${missing[*]} (is the network there?)" >&2
        return 1
    fi
}
