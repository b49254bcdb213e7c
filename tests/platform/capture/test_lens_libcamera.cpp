/* test_lens_libcamera.cpp: which controls the lens of a libcamera camera is moved by, for cameras
 * that have some of them. No camera that runs here has a lens. */
#include "lens.hpp"

#include <csetjmp>
#include <cstdarg>

#include <libcamera/control_ids.h>
#include "unit_test.h"

using namespace libcamera;
using namespace refocus_libcamera;

enum {
    CONTINUOUS = 1 << REFOCUS_SOURCE_FOCUS_CONTINUOUS,
    ONCE = 1 << REFOCUS_SOURCE_FOCUS_ONCE,
    FIXED = 1 << REFOCUS_SOURCE_FOCUS_FIXED,
    OFF = 1 << REFOCUS_SOURCE_FOCUS_OFF,
};

static const ControlInfo any_mode{(int32_t)controls::AfModeManual,
                                  (int32_t)controls::AfModeContinuous};
static const ControlInfo trigger{(int32_t)controls::AfTriggerStart,
                                 (int32_t)controls::AfTriggerCancel};
static const ControlInfo place{0.5f, 12.0f};

static refocus_source_lens lens_of(const ControlInfoMap &camera)
{
    refocus_source_lens lens = refocus_source_lens_default();

    describe_lens(camera, &lens);
    return lens;
}

static void modes_are_those_of_the_controls(void **)
{
    const ControlInfo manual{
        Span<const ControlValue>{{ControlValue((int32_t)controls::AfModeManual)}}};
    const ControlInfoMap none{{}, controls::controls};
    const ControlInfoMap all{{{&controls::AfMode, any_mode},
                              {&controls::AfTrigger, trigger},
                              {&controls::LensPosition, place}},
                             controls::controls};
    const ControlInfoMap hand{{{&controls::AfMode, manual},
                               {&controls::AfTrigger, trigger},
                               {&controls::LensPosition, place}},
                              controls::controls};
    const ControlInfoMap alone{{{&controls::AfMode, any_mode}}, controls::controls};

    assert_int_equal(lens_of(none).modes, 0);
    assert_int_equal(lens_of(all).modes, CONTINUOUS | ONCE | FIXED | OFF);
    assert_true(lens_of(all).dioptres && lens_of(all).least == 0.5 && lens_of(all).greatest == 12);
    assert_int_equal(lens_of(hand).modes, FIXED | OFF);
    assert_int_equal(lens_of(alone).modes, CONTINUOUS | OFF);
    assert_true(lens_of(alone).greatest == 0 && !lens_of(alone).dioptres);
    for (uint32_t mode = 0; mode < REFOCUS_SOURCE_FOCUS_COUNT; mode++)
        assert_true(focus_controls(none, mode, 1).empty());
    assert_true(focus_controls(hand, REFOCUS_SOURCE_FOCUS_ONCE, 1).empty());
}

static void each_mode_has_its_controls(void **)
{
    const ControlInfoMap all{{{&controls::AfMode, any_mode},
                              {&controls::AfTrigger, trigger},
                              {&controls::LensPosition, place}},
                             controls::controls};
    static const int32_t modes[] = {controls::AfModeContinuous, controls::AfModeAuto,
                                    controls::AfModeManual, controls::AfModeManual};

    for (uint32_t mode = 0; mode < REFOCUS_SOURCE_FOCUS_COUNT; mode++) {
        auto wanted = focus_controls(all, mode, 2.5);

        assert_true(wanted[controls::AfMode.id()] == ControlValue(modes[mode]));
        assert_int_equal(wanted.count(controls::AfTrigger.id()), mode == REFOCUS_SOURCE_FOCUS_ONCE);
        assert_int_equal(wanted.count(controls::LensPosition.id()),
                         mode == REFOCUS_SOURCE_FOCUS_FIXED);
    }
    auto fixed = focus_controls(all, REFOCUS_SOURCE_FOCUS_FIXED, 2.5);
    auto once = focus_controls(all, REFOCUS_SOURCE_FOCUS_ONCE, 2.5);
    assert_true(fixed[controls::LensPosition.id()] == ControlValue(2.5f));
    assert_true(once[controls::AfTrigger.id()] == ControlValue((int32_t)controls::AfTriggerStart));
}

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(modes_are_those_of_the_controls),
        cmocka_unit_test(each_mode_has_its_controls),
    };

    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
