/* manager.hpp: the one camera manager of the process, and the switch between libcamera's
 * releases. */
#ifndef RF_LIBCAMERA_MANAGER_HPP
#define RF_LIBCAMERA_MANAGER_HPP

#include <memory>
#include <string>

#include <libcamera/libcamera.h>

/* Written for 0.0.3 and newer in the words that all of them understand: releases differ
 * in what is const, a Span, an optional or a string_view. What a release cannot do
 * without is chosen by this number and nowhere else; tests/libcamera/releases.sh
 * compiles against each. */
#define RF_LIBCAMERA_VERSION                                                                       \
    (LIBCAMERA_VERSION_MAJOR * 10000 + LIBCAMERA_VERSION_MINOR * 100 + LIBCAMERA_VERSION_PATCH)
#if RF_LIBCAMERA_VERSION < 3
#error "libcamera 0.0.3 or newer is needed"
#endif

namespace refocus_libcamera
{

/* NULL when libcamera does not start. Runs as long as somebody holds it. */
std::shared_ptr<libcamera::CameraManager> get_manager();

/* Find a camera by its identifier, else by its number; NULL for none. */
std::shared_ptr<libcamera::Camera> find_camera(libcamera::CameraManager &manager,
                                               const std::string &name);

} // namespace refocus_libcamera

#endif
