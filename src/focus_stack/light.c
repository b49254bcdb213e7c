/* light.c: how much light a focus stack has above white, where its photo is clipped.
 *
 * A highlight is clipped in the frame that is focused on it. Frames of another focus spread its
 * light over a circle of confusion, where it is below white and so is measured. With L the light of
 * the photo and x what it lacks where it is clipped, frame k is predicted by
 *
 *     F_k = A_k (L + x)
 *
 * where A_k spreads each cell over its circle of confusion in that frame, r = K |d - d_k|, but not
 * over what is nearer. A_k L is divided by A_k 1: what is hidden or beyond the border is taken to
 * be as bright as what is seen beside it; x is not, as there need not be a lamp as well. x >= 0 is
 * found by rounds of simultaneous iterative reconstruction (SIRT, Gilbert 1972),
 *
 *     x += (sum of B_k M_k (F_k - A_k (L + x))) / (n + LITTLE),  n = sum of B_k M_k A_k c
 *
 * over all frames, c being the share of a cell that is clipped. M_k are the cells that frame k
 * tells of: those that are not clipped there, and those that may be where less than it has is
 * predicted. White with noise counts as clipped, or else it would tell of light of 1. B_k is c
 * times the transpose of A_k, times the square of the area of the circle of confusion: an error of
 * the radius is one of the light in proportion to the light, so that errors count in parts of what
 * a cell spreads there; else frames with little blur would outweigh the others. Sums are first
 * smoothed along each clipped surface, the less the later the round is (normalised convolution, as
 * in smooth.c), as its middle reaches no cell that is not clipped.
 *
 * Two frames leave x as 0: wherever depth is wrong, some light explains the one in which it is
 * blurred.
 *
 * A cell is a square of pixels, at most CELLS of them along the longer side. R, G, B and a fourth
 * value that fills vectors lie together. Floats are added up in one order, whatever the number of
 * threads is: each worker has rows of its own to write.
 */
#include "focus_stack/light.h"

#include <math.h>
#include <string.h>

#include "colour/transfer.h"
#include "image/deep.h"
#include "support/arena.h"

enum {
    LANES = RF_LIGHT_LANES,
    WHOLE = 3,   /* the value beside R, G and B of L is 1, which becomes A_k 1 */
    CELLS = 480, /* RF_LIGHT_MOST is a fortieth, the largest K of decontaminate.c */
    ROUNDS = 4,
    BRIGHT = 230,       /* a channel may be white from here on, beside one that is clipped */
    LENGTH = 16,        /* cells over which the first round hands 1 / e on */
    RESIDUAL = 1 << 14, /* stands for light of 1; differences are from -1 to 1 */
    CLIPPED = 1,        /* bit of a residual: the frame may be clipped there */
    UNUSED = INT16_MIN, /* the frame does not show it */
};

#define LITTLE      0.01F /* keeps n from being 0 */
#define LEAST_WHOLE 0.25F /* A_k 1 in a corner; where it is less, most is hidden */
#define SURELY      0.05F /* smaller differences of what is clipped tell nothing */

static int cells_by(const struct refocus_stack *s)
{
    const int longer = s->width > s->height ? s->width : s->height;

    return (longer + CELLS - 1) / CELLS;
}

static void lay_out(struct rf_lights *l, struct rf_arena *arena)
{
    const uint64_t cells = (uint64_t)l->columns * (uint64_t)l->rows;
    float **const plane[] = {&l->light,  &l->clipped, &l->excess, &l->norm,
                             &l->spread, &l->ones,    &l->change};

    l->disc = rf_arena_take(arena, RF_LIGHT_RADII, sizeof *l->disc);
    for (size_t i = 0; i < sizeof plane / sizeof *plane; i++)
        *plane[i] = rf_arena_take(arena, cells, LANES * sizeof **plane[i]);
    l->residual = rf_arena_take(arena, cells * (uint64_t)l->stack->count, LANES * 2);
    l->disparity = rf_arena_take(arena, cells, 2);
    l->near = rf_arena_take(arena, cells, 1);
}

/* ----- cells ----- */

/* Whether light of a channel may be above what the photo has: it is clipped, or another channel is,
 * and JPEG and demosaicing may have taken it from this one, in what is white. */
static bool lacks_light(const uint8_t *rgb, int c)
{
    return rgb[c] >= RF_STACK_WHITE || (rgb[c] >= BRIGHT && rf_stack_is_clipped(rgb));
}

/* Means over the pixels of a row of cells: light of the photo and what of it is clipped. */
static void load_row(void *context, int y, int worker)
{
    const struct rf_lights *l = context;
    const struct refocus_stack *s = l->stack;

    (void)worker;
    for (int x = 0; x < l->columns; x++) {
        const size_t at = rf_light_cell(l, x, y);
        const int u = rf_stack_clamp(x * l->by + l->by / 2, s->width - 1);
        const int v = rf_stack_clamp(y * l->by + l->by / 2, s->height - 1);
        int sum[LANES] = {0}, clipped[LANES] = {0}, pixels = 0;

        for (int j = y * l->by; j < (y + 1) * l->by && j < s->height; j++)
            for (int i = x * l->by; i < (x + 1) * l->by && i < s->width; i++, pixels++) {
                const uint8_t *rgb = l->photo->rgb + j * l->photo->stride + 3 * (ptrdiff_t)i;

                for (int c = 0; c < 3; c++) {
                    sum[c] += s->transfer->to_light[rgb[c]];
                    clipped[c] += lacks_light(rgb, c);
                }
            }
        l->near[at] = clipped[0] || clipped[1] || clipped[2] ? RF_LIGHT_WHITE : 0;
        l->disparity[at] =
            s->moved[(size_t)(v / s->reduced) * (size_t)s->columns + (size_t)(u / s->reduced)];
        for (int c = 0; c < LANES; c++) {
            l->light[LANES * at + c] = (float)sum[c] / (float)(pixels * RF_LIGHT_MAX);
            l->clipped[LANES * at + c] = (float)clipped[c] / (float)pixels;
            l->excess[LANES * at + c] = l->norm[LANES * at + c] = 0;
        }
        l->light[LANES * at + WHOLE] = 1;
    }
}

/* The residual of a frame at a cell: how far its mean light, RESIDUAL for 1, is above the mean of
 * what is spread there, as an even number, or CLIPPED more where it may be farther. */
static void find_residual(const struct rf_lights *l, int x, int y, int16_t out[LANES])
{
    const struct refocus_stack *s = l->stack;
    const float *spread = l->spread + LANES * rf_light_cell(l, x, y);
    const float whole = fmaxf(spread[WHOLE], LEAST_WHOLE);
    bool clipped[3] = {false};
    int sum[3] = {0}, pixels = 0;

    for (int c = 0; c < LANES; c++)
        out[c] = UNUSED;
    for (int j = y * l->by; j < (y + 1) * l->by && j < s->height; j++)
        for (int i = x * l->by; i < (x + 1) * l->by && i < s->width; i++, pixels++) {
            uint8_t rgb[3];

            if (!rf_stack_pixel(s, l->frame, i, j, rgb))
                return;
            for (int c = 0; c < 3; c++) {
                clipped[c] |= rgb[c] > RF_STACK_NEAR;
                sum[c] += s->transfer->to_light[rgb[c]];
            }
        }
    for (int c = 0; c < 3; c++) {
        const float light = (float)sum[c] / (float)(pixels * RF_LIGHT_MAX);
        const int more = (int)((light - spread[c] / whole) * RESIDUAL / 2);

        out[c] = (int16_t)(2 * (rf_stack_clamp(more + RESIDUAL / 2, RESIDUAL) - RESIDUAL / 2) +
                           (clipped[c] ? CLIPPED : 0));
    }
}

static int16_t *residuals_of_row(const struct rf_lights *l, int y)
{
    return l->residual +
           LANES * (rf_light_cell(l, 0, l->rows) * (size_t)l->frame + rf_light_cell(l, 0, y));
}

static void residual_row(void *context, int y, int worker)
{
    const struct rf_lights *l = context;
    int16_t *out = residuals_of_row(l, y);

    (void)worker;
    for (int x = 0; x < l->columns; x++, out += LANES)
        if (l->near[rf_light_cell(l, x, y)] & RF_LIGHT_NEAR)
            find_residual(l, x, y, out);
        else
            for (int c = 0; c < LANES; c++)
                out[c] = UNUSED;
}

/* `spread` becomes what a frame has more than that, where it tells, and `ones` 0 where it does not:
 * of what is clipped is known only that it is not below white. */
static void miss_row(void *context, int y, int worker)
{
    const struct rf_lights *l = context;
    const int16_t *in = residuals_of_row(l, y);
    float *spread = l->spread + LANES * rf_light_cell(l, 0, y),
          *ones = l->ones + LANES * rf_light_cell(l, 0, y);

    (void)worker;
    for (int i = 0; i < LANES * l->columns; i++) {
        const bool clipped = in[i] & CLIPPED;
        const float more = (float)(in[i] - clipped) / RESIDUAL - spread[i];
        const bool tells = in[i] != UNUSED && (!clipped || more > SURELY);

        spread[i] = tells ? more : 0;
        ones[i] = tells ? ones[i] : 0;
    }
}

/* ----- rounds ----- */

static void look_at(struct rf_lights *l, int frame)
{
    l->frame = frame;
    l->focus = rf_stack_disparity(l->stack, 256 * frame);
}

static void find_residuals(struct rf_lights *l)
{
    for (int k = 0; k < l->stack->count; k++) {
        look_at(l, k);
        rf_light_spread(l, RF_LIGHT_SOURCE, l->light, l->spread);
        rf_pool_run(l->stack->pool, residual_row, l, l->rows);
    }
}

/* Each cell of a line gets what reaches it along that, both ways, from its clipped surface. */
static void hand_on(const struct rf_lights *l, float *to, const float *from, size_t first,
                    size_t apart, int count)
{
    for (int way = 1; way >= -1; way -= 2) {
        float sum = 0;

        for (int i = 0; i < count; i++) {
            const size_t at = first + (size_t)(way > 0 ? i : count - 1 - i) * apart;

            sum = l->clipped[at] > 0 ? sum * l->kept : 0;
            to[at] = way > 0 ? sum + from[at] : to[at] + sum;
            sum += from[at];
        }
    }
}

static void along_row(void *context, int y, int worker)
{
    const struct rf_lights *l = context;
    const size_t row = LANES * rf_light_cell(l, 0, y);

    (void)worker;
    for (size_t c = 0; c < LANES; c++) {
        hand_on(l, l->spread, l->change, row + c, LANES, l->columns);
        hand_on(l, l->ones, l->norm, row + c, LANES, l->columns);
    }
}

static void along_column(void *context, int x, int worker)
{
    const struct rf_lights *l = context;
    const size_t row = LANES * (size_t)l->columns;

    (void)worker;
    for (size_t c = 0; c < LANES; c++) {
        hand_on(l, l->change, l->spread, LANES * (size_t)x + c, row, l->rows);
        hand_on(l, l->norm, l->ones, LANES * (size_t)x + c, row, l->rows);
    }
}

static void find_excess(struct rf_lights *l)
{
    const size_t n = LANES * rf_light_cell(l, 0, l->rows);
    float *const light = l->light; /* not needed any more: c x */

    for (int round = 0; round < ROUNDS; round++) {
        const int length = LENGTH >> round;

        for (size_t i = 0; i < n; i++) {
            light[i] = l->clipped[i] * l->excess[i];
            l->change[i] = l->norm[i] = 0;
        }
        for (int k = 0; k < l->stack->count; k++) {
            look_at(l, k);
            rf_light_spread_excess(l, light);
            rf_pool_run(l->stack->pool, miss_row, l, l->rows);
            rf_light_gather(l);
        }
        l->kept = (float)length / (float)(length + 1);
        rf_pool_run(l->stack->pool, along_row, l, l->rows);
        rf_pool_run(l->stack->pool, along_column, l, l->columns);
        for (size_t i = 0; i < n; i++) {
            const float x = l->excess[i] + l->change[i] / (l->norm[i] + LITTLE);

            l->excess[i] = x > 0 ? x : 0;
        }
    }
}

static void write_row(void *context, int y, int worker)
{
    const struct rf_lights *l = context;
    const struct refocus_stack *s = l->stack;
    const uint8_t *in = l->photo->rgb + y * l->photo->stride;

    (void)worker;
    for (int x = 0; x < s->width; x++, in += 3) {
        uint8_t *out = rf_deep_pixel(l->out, x, y);

        for (int c = 0; c < 3; c++) {
            float light = (float)s->transfer->to_light[in[c]] / RF_LIGHT_MAX;

            if (l->radius > 0 && lacks_light(in, c))
                light += l->excess[LANES * rf_light_cell(l, x / l->by, y / l->by) + (size_t)c];
            rf_deep_store(l->out, out + c * l->out->bytes, light);
        }
    }
}

static void begin(struct rf_lights *l, struct refocus_stack *s)
{
    l->stack = s;
    l->by = cells_by(s);
    l->columns = (s->width + l->by - 1) / l->by;
    l->rows = (s->height + l->by - 1) / l->by;
}

uint64_t rf_stack_light_bytes(struct refocus_stack *s)
{
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct rf_lights l = {0};

    begin(&l, s);
    lay_out(&l, &arena);
    return arena.used;
}

void rf_stack_find_light(struct refocus_stack *s, const struct rf_stack_photo *photo,
                         struct rf_deep *out, void *work)
{
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct rf_lights l = {.photo = photo, .out = out, .radius = s->radius};

    begin(&l, s);
    rf_arena_begin(&arena, work);
    lay_out(&l, &arena);
    l.radius = s->count > 2 ? l.radius / l.by : 0;
    if (l.radius > 0) {
        rf_light_make_discs(&l);
        rf_pool_run(s->pool, load_row, &l, l.rows);
        rf_light_mark_around(&l, RF_LIGHT_WHITE, RF_LIGHT_NEAR);
        rf_light_mark_around(&l, RF_LIGHT_NEAR, RF_LIGHT_SOURCE);
        find_residuals(&l);
        find_excess(&l);
    }
    rf_pool_run(s->pool, write_row, &l, s->height);
}
