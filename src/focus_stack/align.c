/* align.c: frames of a focus stack are laid on each other: scale, rotation and shift.
 *
 * Neighbours in focus look most alike, so each frame is aligned with the next one towards the
 * reference, from coarse to fine, and the similarities are composed. A step is Gauss-Newton's, for
 *
 *     frame(W(x + d(x))) = gain reference(x) + bias
 *
 * with d(x) = e x + f in the complex plane. Gradients are those of the mean of both pictures, so
 * that the sharper one does not weigh more. Residuals are clamped to three times their mean
 * (Huber's function), so that what moves has little say. Sums are integers; the few steps in double
 * precision are single operations that IEEE rounds alike everywhere.
 *
 * Frames of several apertures differ by more: what is out of focus is another picture. There
 * residuals beyond that bound do not count, so that what is in focus decides. Wide apertures give
 * less light to the corners: the gain may fall off with the squared distance from the middle.
 *
 * Where frames are not alike after that, a camera has moved by more than the coarsest picture lets
 * a step see: then all shifts of that picture are looked at first.
 */
#include "focus_stack/align.h"
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    STEPS = 10,      /* at each level */
    LEAST_SIDE = 16, /* least side of a level that is used */
    SEARCHED = 32,   /* least side of a level whose shifts are looked at */
};

/* Frames are alike from this correlation on: neighbours of nine frames have .98 and more, the first
 * and the last of them .85, pictures of two places .1 and less. */
#define ALIKE 0.7
/* A shift is taken that makes them alike at least so much: below, it fits by chance. */
#define LEAST_ALIKE 0.5

static double middle(int size)
{
    return 0.5 * (size - 1);
}

/* Samples of the frame where the similarity puts those of the reference. */
static void warp(const struct rf_align_level *l, const struct rf_similarity *s)
{
    const double mx = middle(l->width), my = middle(l->height);
    const int64_t dx = llrint(s->c[0] * 65536), dy = llrint(s->c[1] * 65536);

    for (int y = 0; y < l->height; y++) {
        const double v = y - my;
        int64_t px = llrint((s->c[0] * -mx - s->c[1] * v + s->t[0] + mx) * 65536);
        int64_t py = llrint((s->c[1] * -mx + s->c[0] * v + s->t[1] + my) * 65536);
        int16_t *out = l->warped + (size_t)y * (size_t)l->width;

        for (int x = 0; x < l->width; x++, px += dx, py += dy) {
            const int64_t column = px >> 16, row = py >> 16;
            const uint16_t *p;
            int u, w;

            out[x] = -1;
            if (column < 0 || row < 0 || column + 1 >= l->width || row + 1 >= l->height)
                continue;
            u = (int)(px >> 8) & 255;
            w = (int)(py >> 8) & 255;
            p = l->frame + row * l->width + column;
            out[x] = (int16_t)(((p[0] * (256 - u) + p[1] * u) * (256 - w) +
                                (p[l->width] * (256 - u) + p[l->width + 1] * u) * w + 32768) >>
                               16);
        }
    }
}

/* first, then second: places go through `second` before. */
static struct rf_similarity compose(const struct rf_similarity *first,
                                    const struct rf_similarity *second)
{
    const double *c = first->c, *d = second->c, *t = second->t;
    struct rf_similarity out;

    out.c[0] = c[0] * d[0] - c[1] * d[1];
    out.c[1] = c[0] * d[1] + c[1] * d[0];
    out.t[0] = c[0] * t[0] - c[1] * t[1] + first->t[0];
    out.t[1] = c[0] * t[1] + c[1] * t[0] + first->t[1];
    return out;
}

double rf_similarity_reach(const struct rf_similarity *s, int width, int height)
{
    const double x = middle(width), y = middle(height);
    double most = 0;

    for (int i = 0; i < 4; i++) {
        const double u = i & 1 ? x : -x, v = i & 2 ? y : -y;
        const double dx = s->c[0] * u - s->c[1] * v + s->t[0] - u;
        const double dy = s->c[1] * u + s->c[0] * v + s->t[1] - v;
        const double far = sqrt(dx * dx + dy * dy);

        most = far > most ? far : most;
    }
    return most;
}

/* Mean of the absolute residuals, in codes of Q4, or -1 where the pictures hardly overlap. */
static double residual_of(const struct rf_align_level *l, const struct rf_similarity *s,
                          struct rf_align_sums *sums, int clamp)
{
    warp(l, s);
    rf_align_add_up(sums, l, clamp);
    return 4 * sums->pixels > (int64_t)l->width * l->height
               ? (double)sums->residual / (double)sums->pixels
               : -1;
}

/* Improves a similarity at one level; returns whether it makes sense. */
static bool refine(const struct rf_align_level *l, struct rf_similarity *s)
{
    int clamp = INT16_MAX;

    for (int i = 0; i < STEPS; i++) {
        struct rf_similarity step = {{1, 0}, {0, 0}};
        double x[RF_ALIGN_UNKNOWNS], mean;
        struct rf_align_sums sums;

        mean = residual_of(l, s, &sums, clamp);
        if (mean < 0 || !rf_align_solve(&sums, l->unknowns, x))
            return false;
        clamp = (int)(3 * mean) + 8;
        /* row[0] is 4 * 2 / 8 = 1 of the derivative, row[2] four of it. */
        step.c[0] += x[0];
        step.c[1] = x[1];
        step.t[0] = 4 * x[2];
        step.t[1] = 4 * x[3];
        if (!(rf_similarity_reach(&step, l->width, l->height) < 0.125 * l->width))
            return false;
        *s = compose(s, &step);
        if (rf_similarity_reach(&step, l->width, l->height) < 0.004)
            break;
    }
    return true;
}

static struct rf_align_level level_of(const struct refocus_stack *s,
                                      const struct rf_stack_frame *reference,
                                      const struct rf_stack_frame *frame, int i)
{
    /* Frames before the reference and behind it are aligned at the same time. */
    const struct rf_align_level l = {.reference = reference->small[i],
                                     .frame = frame->small[i],
                                     .warped = frame > reference ? (int16_t *)s->moved : s->sum,
                                     .width = s->width / s->small_by >> i,
                                     .height = s->height / s->small_by >> i,
                                     .unknowns =
                                         RF_ALIGN_UNKNOWNS - (s->kind == REFOCUS_STACK_FOCUS)};

    return l;
}

/* From places of the photo to those of a level: centres of pixels lie at half integers of both. */
static void rescale(struct rf_similarity *s, double by)
{
    s->t[0] *= by;
    s->t[1] *= by;
}

/* Correlation of a frame with its neighbour at a similarity of places in the finest picture. */
static double likeness(const struct rf_align_level *finest, const struct rf_similarity *s)
{
    warp(finest, s);
    return rf_stack_correlation(finest->reference, finest->warped, finest->width, finest->width,
                                finest->height);
}

/* From a level on to the finest; `found` is of places in the finest small picture. */
static void refine_from(const struct refocus_stack *s, const struct rf_stack_frame *reference,
                        const struct rf_stack_frame *frame, int first, struct rf_similarity *found)
{
    for (int i = first; i >= 0; i--) {
        const struct rf_align_level l = level_of(s, reference, frame, i);
        struct rf_similarity at_level = *found;

        if (l.width < LEAST_SIDE || l.height < LEAST_SIDE)
            continue;
        rescale(&at_level, 1.0 / (1 << i));
        if (!refine(&l, &at_level))
            continue;
        rescale(&at_level, 1 << i);
        *found = at_level;
    }
}

/* The similarity from one frame to its neighbour, of places in the finest small picture. Where it
 * makes nothing better, frames stay as they are. */
static struct rf_similarity between(const struct refocus_stack *s,
                                    const struct rf_stack_frame *reference,
                                    const struct rf_stack_frame *frame)
{
    const struct rf_align_level finest = level_of(s, reference, frame, 0);
    const struct rf_similarity none = {{1, 0}, {0, 0}};
    struct rf_similarity found = none, shifted;
    struct rf_align_sums sums;
    double alike;
    int coarsest = RF_STACK_LEVELS - 1;

    refine_from(s, reference, frame, coarsest, &found);

    const double before = residual_of(&finest, &none, &sums, INT16_MAX);
    const double after = residual_of(&finest, &found, &sums, INT16_MAX);

    if (after < 0 || after >= before)
        found = none;
    alike = likeness(&finest, &found);
    if (alike >= ALIKE)
        return found;
    while (coarsest > 0 &&
           (finest.width >> coarsest < SEARCHED || finest.height >> coarsest < SEARCHED))
        coarsest--;

    const struct rf_align_level coarse = level_of(s, reference, frame, coarsest);

    shifted = none;
    rf_stack_best_shift(coarse.reference, coarse.frame, coarse.width, coarse.height, shifted.t);
    rescale(&shifted, 1 << coarsest);
    refine_from(s, reference, frame, coarsest, &shifted);

    const double now = likeness(&finest, &shifted);

    return now > alike && now >= LEAST_ALIKE ? shifted : found;
}

/* Less than this at the corners is left alone: interpolation would cost more. */
#define LEAST_REACH 0.2

void rf_stack_warp(const struct refocus_stack *s, const struct rf_stack_frame *frame, int level,
                   const uint16_t *in, int16_t *out)
{
    struct rf_align_level l = level_of(s, frame, frame, level);
    struct rf_similarity similarity = frame->from_reference;

    l.frame = in;
    l.warped = out;
    rescale(&similarity, 1.0 / (s->small_by << level));
    warp(&l, &similarity);
}

void rf_stack_align_each(struct refocus_stack *s, int reference)
{
    for (int i = 0; i < s->count; i++) {
        struct rf_similarity found = {{1, 0}, {0, 0}};

        if (i != reference && s->align == REFOCUS_STACK_ALIGN_SIMILARITY)
            found = between(s, &s->frame[reference], &s->frame[i]);
        rescale(&found, s->small_by);
        s->frame[i].from_reference = found;
    }
}

/* The greatest correlation of three levels: fine texture is lost in blur, but not in coarse ones.
 */
static double likeness_of(const struct refocus_stack *s, const struct rf_stack_frame *reference,
                          const struct rf_stack_frame *frame, const struct rf_similarity *found)
{
    double most = 0;

    for (int i = 0; i < RF_STACK_LEVELS - 1; i++) {
        const struct rf_align_level l = level_of(s, reference, frame, i);
        struct rf_similarity at_level = *found;

        rescale(&at_level, 1.0 / (1 << i));
        if (i && (l.width < LEAST_SIDE || l.height < LEAST_SIDE))
            break;

        const double here = likeness(&l, &at_level);

        most = here > most ? here : most;
    }
    return most;
}

struct sides {
    struct refocus_stack *stack;
    int reference;
    double alike[2]; /* the least of frames before the reference, and of those behind it */
};

/* Aligns the frames on one side of the reference. */
static void align_side(void *context, int side, int worker)
{
    struct sides *const sides = context;
    const struct refocus_stack *s = sides->stack;
    const int way = side ? 1 : -1;

    (void)worker;
    sides->alike[side] = 1;
    for (int i = sides->reference + way; i >= 0 && i < s->count; i += way) {
        struct rf_stack_frame *frame = &sides->stack->frame[i];
        const struct rf_stack_frame *last = &s->frame[i - way];
        struct rf_similarity found = {{1, 0}, {0, 0}};

        if (s->align == REFOCUS_STACK_ALIGN_SIMILARITY)
            found = between(s, last, frame);

        const double alike = likeness_of(s, last, frame, &found);

        if (alike < sides->alike[side])
            sides->alike[side] = alike;
        rescale(&found, s->small_by);
        frame->from_reference = compose(&found, &last->from_reference);
    }
}

void rf_stack_align(struct refocus_stack *s, int reference)
{
    const struct rf_similarity none = {{1, 0}, {0, 0}};
    struct sides sides = {.stack = s, .reference = reference};

    s->frame[reference].from_reference = none;
    rf_pool_run(s->pool, align_side, &sides, 2);
    s->alike = sides.alike[sides.alike[1] < sides.alike[0]];
    for (int i = 0; i < s->count; i++)
        if (rf_similarity_reach(&s->frame[i].from_reference, s->width, s->height) < LEAST_REACH)
            s->frame[i].from_reference = none;
}
