/* moving.c: what moves while a focus stack is photographed is found, and taken from one frame.
 *
 * A change of focus spreads light, but hardly moves any over a distance: means over a window stay,
 * of luminance, of R - G and of B - G. So something has moved where one of them has
 *
 *     |mean frame - gain mean reference| > NOISE + contrast / 2
 *
 * with the larger mean absolute deviation of both from their means, over a window of twice the
 * side, as contrast: the part of a strong edge's light that blur takes over the border of the
 * window. Such places are left out of a frame where they touch one that exceeds STRONG_HALVES / 2
 * times this bound. The reference shows them all.
 */
#include "focus_stack/focus_stack.h"

#include <stdlib.h>
#include <string.h>

enum {
    LEVEL = 1,         /* the level of the small pictures has 65536 pixels at the most */
    WINDOW = 20,       /* a window reaches over this part of the longer side */
    LEAST_REACH = 2,   /* pixels that a window reaches over in the smallest photo */
    NOISE = 3 * 16,    /* Q4 codes */
    STRONG_HALVES = 5, /* 2.5 times the bound */
    SWEEPS = 8,        /* the most times that a region grows, each way */
};

/* Planes of one frame: four in the memory of `moved`, and the mask, deviation and contrast in that
 * of the frame's finest small picture, which no one needs after the alignment. */
struct planes {
    int width, height, reach;
    int16_t *reference, *frame, *reference_mean, *frame_mean, *deviation, *contrast;
    int32_t *column;
    uint8_t *mask;
};

/* Means over squares, as far as they lie in the picture. */
static void means(const struct planes *p, int16_t *restrict out, const int16_t *in, int reach)
{
    const int w = p->width, h = p->height;

    memset(p->column, 0, (size_t)w * sizeof *p->column);
    for (int y = -reach; y < h; y++) {
        const int last = y + reach, gone = y - reach - 1;

        for (int x = 0; x < w; x++) {
            p->column[x] += last < h ? in[(ptrdiff_t)last * w + x] : 0;
            p->column[x] -= gone >= 0 ? in[(ptrdiff_t)gone * w + x] : 0;
        }
        if (y < 0)
            continue;

        const int rows = (last < h ? last : h - 1) - (gone < 0 ? -1 : gone);
        int32_t sum = 0;

        for (int x = -reach; x < w; x++) {
            const int right = x + reach, left = x - reach - 1;

            sum += right < w ? p->column[right] : 0;
            sum -= left >= 0 ? p->column[left] : 0;
            if (x >= 0)
                out[(ptrdiff_t)y * w + x] =
                    (int16_t)(sum /
                              (rows * ((right < w ? right : w - 1) - (left < 0 ? -1 : left))));
        }
    }
}

/* How much brighter a frame is than the reference, Q12. */
static int gain_of(const int16_t *frame, const uint16_t *reference, ptrdiff_t pixels)
{
    int64_t here = 1, there = 1;

    for (ptrdiff_t i = 0; i < pixels; i++)
        if (frame[i] >= 0) {
            here += frame[i];
            there += reference[i];
        }
    return (int)(here * 4096 / there < 8192 ? here * 4096 / there : 8192);
}

/* The reference gets the exposure of the frame; what the frame does not show is as there. */
static void match(const struct planes *p, const uint16_t *reference, int gain, int grey)
{
    const ptrdiff_t pixels = (ptrdiff_t)p->width * p->height;

    for (ptrdiff_t i = 0; i < pixels; i++) {
        const int outside = p->frame[i] < 0;

        p->reference[i] = (int16_t)((reference[i] - grey) * gain / 4096);
        p->frame[i] = outside ? p->reference[i] : (int16_t)(p->frame[i] - grey);
    }
}

/* One way over the mask: what touches what moves, moves if it may. Returns whether any does. */
static bool grow(const struct planes *p, int way)
{
    const int w = p->width, pixels = w * p->height;
    bool grown = false;

    for (int j = 0; j < pixels; j++) {
        const int i = way > 0 ? j : pixels - 1 - j, x = i % w;
        const bool beside = (way > 0 ? x > 0 : x + 1 < w) && p->mask[i - way] == RF_STACK_MOVING;

        if (p->mask[i] == RF_STACK_PERHAPS &&
            (beside || (j >= w && p->mask[i - way * w] == RF_STACK_MOVING))) {
            p->mask[i] = RF_STACK_MOVING;
            grown = true;
        }
    }
    return grown;
}

/* Marks where one channel tells that something moves. */
static void mark(const struct planes *p)
{
    const int pixels = p->width * p->height;

    means(p, p->reference_mean, p->reference, p->reach);
    means(p, p->frame_mean, p->frame, p->reach);
    for (int i = 0; i < pixels; i++) {
        const int a = abs(p->reference[i] - p->reference_mean[i]);
        const int b = abs(p->frame[i] - p->frame_mean[i]);

        p->deviation[i] = (int16_t)(a > b ? a : b);
    }
    means(p, p->contrast, p->deviation, 2 * p->reach);
    for (int i = 0; i < pixels; i++) {
        const int change = 2 * abs(p->frame_mean[i] - p->reference_mean[i]);
        const int bound = 2 * NOISE + p->contrast[i];

        if (2 * change > STRONG_HALVES * bound)
            p->mask[i] = RF_STACK_MOVING;
        else if (change > bound && !p->mask[i])
            p->mask[i] = RF_STACK_PERHAPS;
    }
}

/* out[i] is the largest of in[i - reach] to in[i + reach], n each. */
static void largest(uint8_t *restrict out, const uint8_t *restrict in, int n, int reach)
{
    memcpy(out, in, (size_t)n);
    for (int d = 1; d <= reach && d < n; d++) {
        for (int i = 0; i < n - d; i++)
            out[i] = out[i] > in[i + d] ? out[i] : in[i + d];
        for (int i = d; i < n; i++)
            out[i] = out[i] > in[i - d] ? out[i] : in[i - d];
    }
}

/* out becomes the larger of it and in, pixel by pixel. */
static void larger(uint8_t *restrict out, const uint8_t *restrict in, int n)
{
    for (int i = 0; i < n; i++)
        out[i] = out[i] > in[i] ? out[i] : in[i];
}

/* The border of what moves has less of its light in the window: a mask reaches as far as that. */
static void widen(const struct planes *p)
{
    const int w = p->width, h = p->height;
    uint8_t *across = (uint8_t *)p->contrast;

    for (ptrdiff_t i = 0; i < (ptrdiff_t)w * h; i++)
        p->mask[i] = p->mask[i] == RF_STACK_MOVING ? RF_STACK_MOVING : RF_STACK_STILL;
    for (int y = 0; y < h; y++)
        largest(across + (ptrdiff_t)y * w, p->mask + (ptrdiff_t)y * w, w, p->reach);
    for (int y = 0; y < h; y++) {
        const int last = y + p->reach < h ? y + p->reach : h - 1;

        for (int v = y > p->reach ? y - p->reach : 0; v <= last; v++)
            larger(p->mask + (ptrdiff_t)y * w, across + (ptrdiff_t)v * w, w);
    }
}

static void find(const struct refocus_stack *s, const struct rf_stack_frame *frame,
                 const struct planes *p)
{
    const struct rf_stack_frame *reference = &s->frame[s->still];
    const ptrdiff_t pixels = (ptrdiff_t)p->width * p->height;
    int gain;

    memset(p->mask, RF_STACK_STILL, (size_t)pixels);
    rf_stack_warp(s, frame, LEVEL, frame->small[LEVEL], p->frame);
    gain = gain_of(p->frame, reference->small[LEVEL], pixels);
    match(p, reference->small[LEVEL], gain, 0);
    mark(p);
    for (int c = 0; c < 2; c++) {
        rf_stack_warp(s, frame, LEVEL, frame->colour[c], p->frame);
        match(p, reference->colour[c], gain, RF_STACK_GREY);
        mark(p);
    }
    for (int i = 0; i < SWEEPS; i++) {
        const bool down = grow(p, 1);

        if (!grow(p, -1) && !down)
            break;
    }
    widen(p);
}

struct coloured {
    const struct refocus_stack *stack;
    struct rf_stack_frame *frame;
};

static void colour_row(void *context, int y, int worker)
{
    const struct coloured *coloured = context;
    const struct refocus_stack *s = coloured->stack;
    const int k = s->small_by << LEVEL, w = s->width / s->small_by >> LEVEL;

    (void)worker;
    for (int x = 0; x < w; x++) {
        int32_t sum[3] = {0};

        for (int v = 0; v < k; v++) {
            const uint8_t *p = coloured->frame->rgb +
                               3 * ((size_t)(y * k + v) * (size_t)s->width + (size_t)(x * k));

            for (int u = 0; u < k; u++, p += 3)
                for (int c = 0; c < 3; c++)
                    sum[c] += p[c];
        }
        for (int c = 0; c < 2; c++)
            coloured->frame->colour[c][(size_t)y * (size_t)w + (size_t)x] =
                (uint16_t)(RF_STACK_GREY + 16 * (sum[2 * c] - sum[1]) / (k * k));
    }
}

void rf_stack_measure_colour(const struct refocus_stack *s, struct rf_stack_frame *frame)
{
    struct coloured coloured = {s, frame};

    rf_pool_run(s->pool, colour_row, &coloured, s->height / s->small_by >> LEVEL);
}

void rf_stack_find_moving(struct refocus_stack *s)
{
    const int w = s->width / s->small_by >> LEVEL, h = s->height / s->small_by >> LEVEL;
    const int longer = w > h ? w : h;
    const ptrdiff_t pixels = (ptrdiff_t)w * h;

    for (int k = 0; k < s->count; k++) {
        struct rf_stack_frame *frame = &s->frame[k];
        int16_t *lent = (int16_t *)frame->small[0], *moved = (int16_t *)s->moved;
        const struct planes planes = {
            .width = w,
            .height = h,
            .reach = longer / WINDOW > LEAST_REACH ? longer / WINDOW : LEAST_REACH,
            .frame = moved,
            .reference = moved + pixels,
            .reference_mean = moved + 2 * pixels,
            .frame_mean = moved + 3 * pixels,
            .deviation = lent + pixels,
            .contrast = lent + 2 * pixels,
            .column = (int32_t *)(void *)s->path,
            .mask = (uint8_t *)lent,
        };

        frame->moving = NULL;
        if (k != s->still) {
            find(s, frame, &planes);
            frame->moving = planes.mask;
        }
    }
}

const uint8_t *rf_stack_moving_row(const struct refocus_stack *s, int k, int y)
{
    const int w = s->width / s->small_by >> LEVEL, h = s->height / s->small_by >> LEVEL;

    return s->frame[k].moving ? s->frame[k].moving +
                                    (ptrdiff_t)rf_stack_clamp(y / (s->small_by << LEVEL), h - 1) * w
                              : NULL;
}

int rf_stack_moving_column(const struct refocus_stack *s, int x)
{
    return rf_stack_clamp(x / (s->small_by << LEVEL), (s->width / s->small_by >> LEVEL) - 1);
}

/* A place in the mask, Q8 from the middle of its first pixel. */
static int place_in_mask(const struct refocus_stack *s, int x)
{
    const int block = s->small_by << LEVEL;

    return rf_stack_clamp(((2 * x + 1) * 128 - 128 * block) / block, INT32_MAX);
}

struct rf_stack_mask rf_stack_moving_mask(const struct refocus_stack *s, int k, int y)
{
    const int w = s->width / s->small_by >> LEVEL, h = s->height / s->small_by >> LEVEL;
    const int place = place_in_mask(s, y);
    struct rf_stack_mask mask = {{NULL, NULL}, place & 255};

    for (int i = 0; i < 2 && s->frame[k].moving; i++)
        mask.row[i] = s->frame[k].moving + (ptrdiff_t)rf_stack_clamp((place >> 8) + i, h - 1) * w;
    return mask;
}

int rf_stack_moving_share(const struct refocus_stack *s, const struct rf_stack_mask *mask, int x)
{
    const int last = (s->width / s->small_by >> LEVEL) - 1, place = place_in_mask(s, x);
    const int left = rf_stack_clamp(place >> 8, last), right = rf_stack_clamp(left + 1, last);
    const int u = place & 255, v = mask->below;
    const uint8_t *const up = mask->row[0], *const down = mask->row[1];

    if (!up)
        return 0;
    return ((rf_stack_moves(up, left) * (256 - u) + rf_stack_moves(up, right) * u) * (256 - v) +
            (rf_stack_moves(down, left) * (256 - u) + rf_stack_moves(down, right) * u) * v) >>
           8;
}

void rf_stack_leave_out(struct refocus_stack *s, int y)
{
    const int middle = (s->reduced - 1) / 2;
    const uint8_t *moving[REFOCUS_STACK_MOST_FRAMES];
    int all = 0;

    for (int k = 0; k < s->count; k++)
        moving[k] = rf_stack_moving_row(s, k, y * s->reduced + middle);
    for (int x = 0; x < s->columns; x++) {
        const size_t i = (size_t)y * (size_t)s->columns + (size_t)x;
        const int column = rf_stack_moving_column(s, x * s->reduced + middle);
        bool any = false;

        for (int k = 0; k < s->count; k++)
            if (rf_stack_moves(moving[k], column)) {
                for (int d = -s->sub / 2; d <= s->sub / 2; d++)
                    if (k * s->sub + d >= 0 && k * s->sub + d < s->depths)
                        s->cost[i * (size_t)s->labels + (size_t)(k * s->sub + d)] = UINT8_MAX;
                any = true;
            }
        if (any)
            s->sure[i] = 0;
        all += any;
    }
    atomic_fetch_add_explicit(&s->moving, all, memory_order_relaxed);
}
