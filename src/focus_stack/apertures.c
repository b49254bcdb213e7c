/* apertures.c: depth of frames of one focus and several apertures.
 *
 * Labels are radii of blur (blur_errors.c), from 0 to RADII - 1 samples. What is blurred by more
 * than the largest of them has more than that many samples to a radius: samples are then made twice
 * as large, until hardly any is blurred by so much. How much a surface is blurred tells how far it
 * is from the focus, but not on which side: the caller says which end is in focus.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <string.h>

enum {
    RADII = RF_STACK_RADII,
    MANY = 20, /* one in so many that are sure lies at the largest radii: they are too small */
    LEAST_SIDE = 32, /* samples of a side, fewer than which are not halved again */
    FARTHEST = 50,   /* one in so many that are sure may lie beyond the end of the range */
};

/* How many of the samples that are sure have each radius, rounded; returns all of them. */
static int count_radii(const struct refocus_stack *s, int count[RADII])
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    int all = 0;

    memset(count, 0, RADII * sizeof *count);
    for (size_t i = 0; i < samples; i++)
        if (s->sure[i] >= RF_STACK_MEASURED) {
            count[(s->depth[i] + 128) / 256]++;
            all++;
        }
    return all;
}

/* Whether samples are too small for the blur; they become larger then. */
static bool grow(struct refocus_stack *s)
{
    int count[RADII];
    const int all = count_radii(s, count);

    if (MANY * (count[RADII - 1] + count[RADII - 2]) <= all || s->columns < 2 * LEAST_SIDE ||
        s->rows < 2 * LEAST_SIDE)
        return false;
    s->reduced *= 2;
    s->columns = (s->width + s->reduced - 1) / s->reduced;
    s->rows = (s->height + s->reduced - 1) / s->reduced;
    return true;
}

/* The end of the range of radii, Q8: hardly any that is sure has more. */
static int farthest_of(const struct refocus_stack *s)
{
    int count[RADII], beyond = 0, radius = RADII - 1;
    const int all = count_radii(s, count);

    while (radius > 1 && FARTHEST * (beyond + count[radius]) <= all)
        beyond += count[radius--];
    return 256 * radius;
}

/* The largest radii are what no radius explains: they are not measured. */
static void leave_beyond(const struct refocus_stack *s, int depth)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;

    for (size_t i = 0; i < samples; i++)
        if (s->depth[i] > depth)
            s->sure[i] = 0;
}

/* Two frames without positions: the sharper one has the narrower aperture. */
static void tell_narrower(struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    uint64_t sum[2] = {0, 0};

    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < samples; i++)
            sum[k] += s->frame[k].sharpness[i];
    if (sum[0] < sum[1]) {
        const struct rf_stack_frame frame = s->frame[0];

        s->frame[0] = s->frame[1];
        s->frame[1] = frame;
    }
    for (int k = 0; k < 2; k++)
        s->frame[k].position = k;
}

void rf_stack_apertures(struct refocus_stack *s, struct refocus_stack_result *result)
{
    if (s->without_positions)
        tell_narrower(s);

    const double narrowest = s->frame[0].position, widest = s->frame[s->count - 1].position;

    s->still = 0;
    rf_stack_align(s, s->still);
    s->sub = 1;
    s->depths = RADII;
    s->noise = 0;
    do {
        rf_stack_blur_errors(s);
        rf_stack_costs(s);
        rf_stack_aggregate(s);
        rf_stack_choose(s);
    } while (grow(s));
    leave_beyond(s, 256 * (RADII - 2));
    s->farthest = farthest_of(s);
    leave_beyond(s, s->farthest);
    rf_stack_fill(s, false);
    rf_stack_median(s);
    rf_stack_smooth(s);
    result->order_margin = 1;
    result->direction = result->disorder = 0;
    result->by_rows = 0;
    s->matched = 0;
    s->exposure = 1;
    /* The narrowest aperture blurs, too, and the squares of both add up to those of the widest. */
    result->blur = (float)(s->farthest / 256.0 * s->reduced /
                           sqrt(1 - narrowest * narrowest / (widest * widest)));
}
