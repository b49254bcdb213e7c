/* lens.cpp: the modes of autofocus in libcamera's words, and which of them a camera has. */
#include "lens.hpp"

#include <algorithm>

#include <libcamera/control_ids.h>

using namespace libcamera;

namespace refocus_libcamera
{

/* AfModeManual leaves the lens where it is until a position is said. */
static const struct {
    int32_t af_mode;
    bool triggered, placed;
} ways[REFOCUS_SOURCE_FOCUS_COUNT] = {{controls::AfModeContinuous, false, false},
                                      {controls::AfModeAuto, true, false},
                                      {controls::AfModeManual, false, true},
                                      {controls::AfModeManual, false, false}};

bool has_control(const ControlInfoMap &camera, const ControlId &control)
{
    return camera.find(control.id()) != camera.end();
}

static bool can(const ControlInfoMap &camera, uint32_t mode)
{
    const auto found = camera.find(controls::AfMode.id());

    if (found == camera.end() || mode >= REFOCUS_SOURCE_FOCUS_COUNT ||
        (ways[mode].triggered && !has_control(camera, controls::AfTrigger)) ||
        (ways[mode].placed && !has_control(camera, controls::LensPosition)))
        return false;
    const auto &values = found->second.values(); /* empty: a range, which says no more */
    return values.empty() || std::find(values.begin(), values.end(),
                                       ControlValue(ways[mode].af_mode)) != values.end();
}

void describe_lens(const ControlInfoMap &camera, struct refocus_source_lens *lens)
{
    for (uint32_t mode = 0; mode < REFOCUS_SOURCE_FOCUS_COUNT; mode++)
        lens->modes |= can(camera, mode) ? 1u << mode : 0;
    if (lens->modes >> REFOCUS_SOURCE_FOCUS_FIXED & 1) {
        const ControlInfo &range = camera.at(controls::LensPosition.id());

        lens->dioptres = 1;
        lens->least = range.min().get<float>();
        lens->greatest = range.max().get<float>();
    }
}

std::map<unsigned int, ControlValue> focus_controls(const ControlInfoMap &camera, uint32_t mode,
                                                    double position)
{
    std::map<unsigned int, ControlValue> wanted;

    if (!can(camera, mode))
        return wanted;
    wanted[controls::AfMode.id()] = ControlValue(ways[mode].af_mode);
    if (ways[mode].triggered)
        wanted[controls::AfTrigger.id()] = ControlValue((int32_t)controls::AfTriggerStart);
    if (ways[mode].placed)
        wanted[controls::LensPosition.id()] = ControlValue((float)position);
    return wanted;
}

} // namespace refocus_libcamera
