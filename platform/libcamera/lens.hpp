/* lens.hpp: the lens of a camera by the controls that libcamera has for it. */
#ifndef RF_LIBCAMERA_LENS_HPP
#define RF_LIBCAMERA_LENS_HPP

#include <map>

#include <libcamera/controls.h>

#include "backend.h"

namespace refocus_libcamera
{

bool has_control(const libcamera::ControlInfoMap &camera, const libcamera::ControlId &control);

/* Fill in what the lens can do; its position is known by frames alone. */
void describe_lens(const libcamera::ControlInfoMap &camera, struct refocus_source_lens *lens);

/* The controls by which a camera focuses so: enum refocus_source_focus and a position for FIXED.
 * None where it cannot. */
std::map<unsigned int, libcamera::ControlValue>
focus_controls(const libcamera::ControlInfoMap &camera, uint32_t mode, double position);

} // namespace refocus_libcamera

#endif
