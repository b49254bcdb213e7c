################################################################################
#
# librefocus: copy this folder to package/librefocus, and name it in package/Config.in
#
################################################################################

# The address and revision are those of your copy of the repository.
LIBREFOCUS_VERSION = main
LIBREFOCUS_SITE = https://example.org/librefocus.git
LIBREFOCUS_SITE_METHOD = git
LIBREFOCUS_LICENSE = MIT
LIBREFOCUS_LICENSE_FILES = LICENSE
LIBREFOCUS_INSTALL_STAGING = YES
LIBREFOCUS_CONF_OPTS = -Dbuildtype=release -Dauto_features=disabled \
	-Dtests=disabled -Dexamples=false

ifeq ($(BR2_aarch64)$(BR2_ARM_CPU_HAS_NEON)$(BR2_x86_64),y)
LIBREFOCUS_CONF_OPTS += -Dsimd=enabled
endif

ifeq ($(BR2_PACKAGE_LIBREFOCUS_COMMAND),y)
LIBREFOCUS_CONF_OPTS += -Dtools=enabled -Dpng=enabled -Djpeg=enabled -Dxmp=enabled
LIBREFOCUS_DEPENDENCIES += host-pkgconf jansson libpng jpeg-turbo expat
endif

$(eval $(meson-package))
