# A recipe for Yocto: the core, picture files and the command. Copy it to a layer of yours.
SUMMARY = "Refocus photos by their depth: shallow depth of field after the shot"
LICENSE = "MIT"
LIC_FILES_CHKSUM = "file://LICENSE;md5=15877e153dc20c0fdab7905b4adf3ae8"
# The address and revision are those of your copy of the repository.
SRC_URI = "git://example.org/librefocus.git;protocol=https;branch=main"
SRCREV = "${AUTOREV}"
PV = "0.2.0+git${SRCPV}"
S = "${WORKDIR}/git"

inherit meson pkgconfig

DEPENDS = "libpng libjpeg-turbo expat"
EXTRA_OEMESON = "-Dbuildtype=release -Dtests=disabled -Dexamples=false -Dpython=disabled \
    -Dximgproc=disabled"
PACKAGECONFIG ??= "command"
PACKAGECONFIG[command] = "-Dtools=enabled,-Dtools=disabled,jansson"
PACKAGECONFIG[heic] = "-Dheic=enabled,-Dheic=disabled,libheif"
PACKAGECONFIG[libcamera] = "-Dlibcamera=enabled,-Dlibcamera=disabled,libcamera"
PACKAGECONFIG[opencv] = "-Dopencv=enabled,-Dopencv=disabled,opencv"
PACKAGECONFIG[page] = "-Dweb=enabled,-Dweb=disabled,libmicrohttpd"
PACKAGECONFIG[pipewire] = "-Dpipewire=enabled,-Dpipewire=disabled,pipewire"
PACKAGECONFIG[window] = "-Dsdl2=enabled -Dsdl2_ttf=enabled,-Dsdl2=disabled -Dsdl2_ttf=disabled,libsdl2 libsdl2-ttf"

PACKAGES =+ "refocus"
FILES:refocus = "${bindir}/refocus ${libdir}/refocus ${datadir}"
