/* replay_lens.c: the lens of a scripted camera: it moves by frames, sticks, and may say what is not
 * so; which picture of a focus stack it sees. */
#include "replay_lens.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include "pattern.h"

void rf_lens_start(struct rf_lens *lens, const struct rf_script *script)
{
    lens->position = lens->target = script->lens[0];
    lens->shown = NAN;
    lens->picture = -1;
}

void rf_lens_describe(const struct rf_lens *lens, const struct rf_script *script,
                      struct refocus_source_lens *out)
{
    if (!(script->lens[0] < script->lens[1]))
        return;
    out->modes = (1 << REFOCUS_SOURCE_FOCUS_COUNT) - 1;
    out->dioptres = 1;
    out->least = script->lens[0];
    out->greatest = script->lens[1];
    out->position = lens->shown;
}

/* Autofocus takes the middle for the subject. A lens that is switched off stops on its way. */
void rf_lens_focus(struct rf_lens *lens, const struct rf_script *script, uint32_t mode,
                   double position)
{
    lens->target = mode == REFOCUS_SOURCE_FOCUS_FIXED ? position
                   : mode == REFOCUS_SOURCE_FOCUS_OFF ? lens->position
                                                      : 0.5 * (script->lens[0] + script->lens[1]);
}

void rf_lens_move(struct rf_lens *lens, const struct rf_script *script, struct refocus_frame *frame)
{
    const double to = fmin(lens->target, script->lens_stop);

    if (!(script->lens[0] < script->lens[1]))
        return;
    if (fabs(to - lens->position) <= script->lens_speed)
        lens->position = to;
    else
        lens->position += to > lens->position ? script->lens_speed : -script->lens_speed;
    lens->shown = lens->position + script->lens_error;
    frame->lens_dioptres = (float)lens->shown;
}

int rf_lens_look(struct rf_lens *lens, const struct rf_script *script,
                 struct refocus_source **picture, struct refocus_reason *reason)
{
    const double range = script->lens[1] - script->lens[0];
    const double at = range > 0 ? (lens->position - script->lens[0]) / range : 0;
    const int n = (int)lround(fmax(0, fmin(at, 1)) * (script->pictures - 1));
    struct refocus_source_config config = refocus_source_config_default();
    char name[PATH_MAX] = "file:";
    int status;

    if (n == lens->picture)
        return REFOCUS_OK;
    refocus_source_close(picture);
    lens->picture = -1;
    if (!rf_pattern_name(name + 5, sizeof name - 5, script->stack, n))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "the name is too long");
    config.flags = REFOCUS_SOURCE_FAST;
    status = refocus_source_open(picture, name, reason);
    if (status == REFOCUS_OK)
        status = refocus_source_start(*picture, &config, NULL, reason);
    if (status == REFOCUS_OK)
        lens->picture = n;
    return status;
}
