/* render_yuv.c: checks whether a photo of Y, U and V can be rendered, and sets its pre-filter. */
#include "renderer/render_yuv.h"

#include <math.h>

#include "image/format.h"
#include "renderer/renderer.h"

/* Whether the look is one that only photos of R, G and B can have. */
static bool has_look(const struct rf_frame *f)
{
    const struct rf_settings *p = f->params;

    return p->cat_eye > 0 || p->fringe != 0 || p->grain > 0 ||
           (p->star_spikes > 0 && p->star_strength > 0) ||
           (p->aperture && rf_aperture_has_sides(p->aperture));
}

int rf_check_yuv(const struct rf_log *log, const struct rf_frame *f, struct rf_rect region)
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    const int odd_rows = r->yuv.down ? 1 : 0;

    if (refocus_format_is_yuv(f->out->format) != r->yuv.on)
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED, "out->format is %u, may be one of %s",
                         (unsigned)f->out->format, r->yuv.on ? "Y, U and V" : "R, G and B");
    if (!r->yuv.on)
        return REFOCUS_OK;
    if (rf_chroma_down(f->out->format) != r->yuv.down ||
        f->params->method != REFOCUS_METHOD_SWEEP || has_look(f))
        return rf_refuse(
            log, REFOCUS_ERR_UNSUPPORTED,
            "a photo of Y, U and V may be rendered by the sweep alone, without cat's eye, "
            "fringe, grain, stars and two-sided apertures, into its own sampling");
    if (region.x0 % 2 || (region.x1 % 2 && region.x1 < r->photo.width) || (region.y0 & odd_rows) ||
        ((region.y1 & odd_rows) && region.y1 < r->photo.height))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "region is from (%d, %d) to (%d, %d), may not split samples of U and V",
                         region.x0, region.y0, region.x1, region.y1);
    return REFOCUS_OK;
}

/* Sets the |s| at which gaps between the rays of chroma, in its samples, are as wide as those of
 * luma are at f->prefilter_above. */
static void set_chroma_above(const struct rf_frame *f, int above[RF_PREFILTER_STEPS])
{
    const struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_ray_set *set = &r->ray_sets.set[r->ray_sets.preset];
    const double times = 2 * sqrt((double)set->shared / set->count);

    for (int i = 0; i < RF_PREFILTER_STEPS; i++) {
        const double s = times * f->prefilter_above[i];

        above[i] = s < INT16_MAX ? (int)s : INT16_MAX;
    }
}

/* The largest blur, Q7.8. With a plain lens the end that is farther from the focus has it. */
static int largest_blur(const struct rf_frame *f)
{
    const int64_t df = f->focus.disparity, farther = df > UINT16_MAX - df ? df : UINT16_MAX - df;

    return f->plan.plain ? (int)(farther * f->focus.radius >> 16) + 1 : INT16_MAX;
}

struct rf_prefilter_chroma rf_chroma_prefilter(const struct rf_frame *f)
{
    const struct rf_chroma_planes *planes = &rf_renderer_of(f)->chroma;
    struct rf_prefilter_chroma chroma = {
        .size = planes->size,
        .blur = planes->blur,
        .light = planes->light,
        .spare = planes->background,
        .smooth = planes->smooth,
    };

    set_chroma_above(f, chroma.above);
    /* Further steps would touch no tile. */
    chroma.steps = largest_blur(f) > chroma.above[1] ? RF_PREFILTER_STEPS : 1;
    return chroma;
}
