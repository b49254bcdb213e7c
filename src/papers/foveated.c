/* foveated.c: exact where one looks, fast elsewhere, Mulder & van Liere 2000.
 *
 * The centre of attention volume is a cone about the line of sight, cut at two depths.
 * In it the "high resolution" technique works: circles of confusion of diameter 1, 3,
 * 5, ... are spread as uniform discs, all samples whose circle holds a pixel, front to
 * back: the borders of the discs before the focus from the outermost in, the middle,
 * then those behind it from the innermost out. Alpha saturates, so nothing gets too
 * bright, and the alpha that is missing at the end comes from the picture (hypo-intensity
 * correction).
 *
 * Outside, two Gaussian pyramids (5 x 5, halved each time) hold the pixels before and
 * behind the focus. A pixel reads the pyramid of its own side between the two levels whose
 * blurs are nearest to its circle of confusion; the part that they do not cover comes from
 * the picture.
 *
 * Across the side of the volume the one fades into the other.
 */
#include "papers/papers.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    CHANNELS = 5, /* light times weight, weight, coverage; premultiplied by coverage */
    LEVELS = 8,   /* level 7 is as wide as a disc of radius 181 */
    BORDERS = REFOCUS_PLAIN_BLUR_RADIUS + 2,
    ONE = 1 << 24, /* alpha */
    ROWS = 8,
};

struct offset {
    int16_t x, y;
};

struct level {
    int width, height;
    float *plane[CHANNELS];
};

struct work {
    struct rf_frame *f;
    struct level pyramid[2][LEVELS]; /* before and behind the focus */
    float *half[CHANNELS];           /* rows of a level, halved in x */
    int levels;
    const struct level *from;
    struct level *to;

    struct offset *offset; /* sorted by distance; border b begins at border[b] */
    int border[BORDERS + 1], front_borders, back_borders;
    uint32_t alpha[BORDERS]; /* alpha[b]: one pixel of a disc of diameter 2 b + 1 */

    double centre_x, centre_y, radius, margin; /* the volume, pixels */
};

static uint64_t disc_pixels(int borders)
{
    const uint64_t side = 2 * (uint64_t)borders + 1;

    return side * side;
}

static void size_levels(struct work *work, int width, int height)
{
    for (work->levels = 0; work->levels < LEVELS; work->levels++) {
        for (int side = 0; side < 2; side++) {
            work->pyramid[side][work->levels].width = width;
            work->pyramid[side][work->levels].height = height;
        }
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
}

/* Lays out the memory of the arena; without any it fills *counted and only counts the bytes. */
static struct work *lay_out(const struct rf_limits *limits, struct rf_arena *arena,
                            struct work *counted)
{
    struct work *work = rf_arena_take(arena, 1, sizeof *work);

    if (!work)
        work = counted;
    size_levels(work, limits->width, limits->height);
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < LEVELS; i++)
            for (int c = 0; c < CHANNELS; c++) {
                struct level *level = &work->pyramid[side][i];

                level->plane[c] = rf_arena_take(
                    arena, (uint64_t)level->width * (uint64_t)level->height, sizeof(float));
            }
    for (int c = 0; c < CHANNELS; c++)
        work->half[c] = rf_arena_take(
            arena, (uint64_t)((limits->width + 1) / 2) * (uint64_t)limits->height, sizeof(float));
    work->offset = rf_arena_take(arena, disc_pixels((int)ceilf(limits->max_blur_radius) + 1),
                                 sizeof *work->offset);
    return work;
}

static uint64_t work_bytes(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};
    struct work counted;

    lay_out(limits, &arena, &counted);
    return arena.used;
}

/* The border b of the disc that a signed blur has: its diameter is 2 b + 1. */
static int border_of(int s)
{
    return ((s < 0 ? -s : s) + 128) >> 8;
}

/* A pixel (x, y) lies in border b if its middle is in the disc of diameter 2 b + 1 and in no
 * smaller one: b - 1/2 < |(x, y)| <= b + 1/2. In whole numbers (b + 1/2)^2 = b^2 + b. */
static void list_borders(struct work *work, int most)
{
    int n = 0;

    for (int b = 0; b <= most && !rf_cancelled(work->f->exec); b++) {
        work->border[b] = n;
        for (int y = -b; y <= b; y++) {
            for (int x = -b; x <= b; x++) {
                const int square = x * x + y * y;

                if (square <= b * b + b && (b == 0 || square > b * b - b))
                    work->offset[n++] = (struct offset){(int16_t)x, (int16_t)y};
            }
        }
        work->alpha[b] = (uint32_t)(ONE / n);
    }
    work->border[most + 1] = n;
}

/* The sums of one pixel in the high resolution technique. */
static_assert(UINT64_C(1) * ONE * RF_WEIGHT_MAX * RF_LIGHT_MAX < UINT64_C(1) << 53,
              "a double holds them, as alpha adds up to one");
struct sums {
    uint64_t light[3], weight;
    uint32_t alpha;
};

static void blend(const struct rf_frame *f, ptrdiff_t q, uint32_t alpha, struct sums *sums)
{
    const uint32_t room = ONE - sums->alpha;
    const uint32_t a = alpha < room ? alpha : room;
    const uint64_t w = (uint64_t)a * rf_weight_of(f, f->light.channel, q);

    sums->alpha += a;
    sums->weight += w;
    for (int c = 0; c < 3; c++)
        sums->light[c] += w * f->light.channel[c][q];
}

/* Blends the samples in border b whose disc reaches p, before (sign -1) or behind (1) the focus. */
static void blend_border(const struct work *work, ptrdiff_t p, int b, int sign, struct sums *sums)
{
    for (int i = work->border[b]; i < work->border[b + 1] && sums->alpha < ONE; i++) {
        const ptrdiff_t q = p + work->offset[i].y * work->f->view->stride + work->offset[i].x;
        const int s = work->f->blur.at[q] * sign;

        if (s >= 128 && border_of(s) >= b)
            blend(work->f, q, work->alpha[border_of(s)], sums);
    }
}

static void exact(const struct work *work, int x, int y, double light[3])
{
    const ptrdiff_t p = y * work->f->view->stride + x;
    struct sums sums = {{0, 0, 0}, 0, 0};

    for (int b = work->front_borders; b > 0; b--)
        blend_border(work, p, b, -1, &sums);
    blend(work->f, p, work->alpha[border_of(work->f->blur.at[p])], &sums);
    for (int b = 1; b <= work->back_borders; b++)
        blend_border(work, p, b, 1, &sums);
    blend(work->f, p, ONE, &sums); /* hypo-intensity correction */
    for (int c = 0; c < 3; c++)
        light[c] = (double)sums.light[c] / (double)sums.weight;
}

/* Writes a row of level 0: pixels before the focus in one pyramid, pixels behind it in the other.
 */
static void first_level_row(void *context, int y, int worker)
{
    const struct work *work = context;

    (void)worker;
    for (int x = 0; x < work->f->view->width; x++) {
        const ptrdiff_t p = y * work->f->view->stride + x;
        const size_t at = (size_t)y * (size_t)work->f->view->width + (size_t)x;
        const double w = rf_weight_of(work->f, work->f->light.channel, p);

        for (int side = 0; side < 2; side++) {
            const struct level *level = &work->pyramid[side][0];
            const int s = side ? work->f->blur.at[p] : -work->f->blur.at[p];
            const float present = s >= 128;

            for (int c = 0; c < 3; c++)
                level->plane[c][at] = present * (float)(w * work->f->light.channel[c][p]);
            level->plane[3][at] = present * (float)w;
            level->plane[4][at] = present;
        }
    }
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Filters by (1 4 6 4 1) / 16 about in[2 x], ends extended; neighbours are `step` apart. */
static float reduce(const float *in, int x, int n, size_t step)
{
    const float *at[5];

    for (int i = 0; i < 5; i++)
        at[i] = in + (size_t)clamp(2 * x + i - 2, n - 1) * step;
    return (*at[0] + *at[4] + 4 * (*at[1] + *at[3]) + 6 * *at[2]) / 16;
}

static void halve_x_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const struct level *from = work->from, *to = work->to;

    (void)worker;
    for (int c = 0; c < CHANNELS; c++)
        for (int x = 0; x < to->width; x++)
            work->half[c][(size_t)y * (size_t)to->width + (size_t)x] =
                reduce(from->plane[c] + (size_t)y * (size_t)from->width, x, from->width, 1);
}

static void halve_y_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const struct level *from = work->from, *to = work->to;
    const size_t width = (size_t)to->width;

    (void)worker;
    for (int c = 0; c < CHANNELS; c++)
        for (size_t x = 0; x < width; x++)
            to->plane[c][(size_t)y * width + x] = reduce(work->half[c] + x, y, from->height, width);
}

static void make_pyramids(struct work *work)
{
    struct rf_pool *pool = work->f->exec->pool;

    rf_pool_run(pool, first_level_row, work, work->f->view->height);
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i + 1 < work->levels; i++) {
            work->from = &work->pyramid[side][i];
            work->to = &work->pyramid[side][i + 1];
            rf_pool_run(pool, halve_x_row, work, work->from->height);
            rf_pool_run(pool, halve_y_row, work, work->to->height);
        }
    }
}

static void sample(const struct level *level, int i, int x, int y, double share,
                   double out[CHANNELS])
{
    const int side = 1 << i, ix = x >> i, iy = y >> i;
    const double ax = (double)(x & (side - 1)) / side, ay = (double)(y & (side - 1)) / side;

    for (int dy = 0; dy < 2; dy++) {
        for (int dx = 0; dx < 2; dx++) {
            const size_t at = (size_t)clamp(iy + dy, level->height - 1) * (size_t)level->width +
                              (size_t)clamp(ix + dx, level->width - 1);
            const double w = share * (dx ? ax : 1 - ax) * (dy ? ay : 1 - ay);

            for (int c = 0; c < CHANNELS; c++)
                out[c] += w * level->plane[c][at];
        }
    }
}

/* The variance along one axis of a pixel as level i shows it: (4^i - 1) / 3 by the filters, and a
 * sixth of the square of the level's own pixel by the interpolation. A disc of radius r has
 * r^2 / 4. */
static double level_variance(int i)
{
    const double four = (double)(1 << 2 * i);

    return i ? (four - 1) / 3 + four / 6 : 0;
}

static void fast(const struct work *work, int x, int y, double light[3])
{
    const struct rf_frame *f = work->f;
    const ptrdiff_t p = y * f->view->stride + x;
    const int s = f->blur.at[p];
    const double variance = s / 256.0 * (s / 256.0) / 4;
    const double w = rf_weight_of(f, f->light.channel, p);
    double sum[CHANNELS] = {0, 0, 0, 0, 0}, part;
    int i = 0;

    if (s >= 128 || s <= -128) {
        const struct level *pyramid = work->pyramid[s > 0];

        while (i + 2 < work->levels && level_variance(i + 1) <= variance)
            i++;
        part = (variance - level_variance(i)) / (level_variance(i + 1) - level_variance(i));
        part = part > 1 ? 1 : part;
        sample(&pyramid[i], i, x, y, 1 - part, sum);
        sample(&pyramid[i + 1], i + 1, x, y, part, sum);
    }
    /* Where the level does not cover, the picture shows. */
    part = sum[4] < 1 ? 1 - sum[4] : 0;
    for (int c = 0; c < 3; c++)
        light[c] = (sum[c] + part * w * f->light.channel[c][p]) / (sum[3] + part * w);
}

/* The share of the exact technique: 1 in the volume, 0 outside, falling across its side. */
static double attention(const struct work *work, int x, int y)
{
    const struct rf_settings *p = work->f->params;
    const double dx = x - work->centre_x, dy = y - work->centre_y;
    const double beyond = sqrt(dx * dx + dy * dy) - work->radius;
    const double d = work->f->disparity.at[y * work->f->view->stride + x] / 65535.0;
    const double deeper = fabs(d - p->focus_disparity) - p->attention_depth;
    double share = beyond <= 0 ? 1 : beyond < work->margin ? 1 - beyond / work->margin : 0;

    if (deeper > 0)
        share *= deeper < 0.1 ? 1 - deeper / 0.1 : 0;
    return share;
}

static void write_rows(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct rf_frame *f = work->f;

    (void)worker;
    for (int y = f->region.y0 + item * ROWS;
         y < f->region.y0 + (item + 1) * ROWS && y < f->region.y1; y++) {
        for (int x = f->region.x0; x < f->region.x1; x++) {
            const double share = attention(work, x, y);
            double a[3] = {0, 0, 0}, b[3] = {0, 0, 0};

            if (rf_cancelled(f->exec))
                return;
            if (share > 0)
                exact(work, x, y, a);
            if (share < 1)
                fast(work, x, y, b);
            for (int c = 0; c < 3; c++)
                a[c] = share * a[c] + (1 - share) * b[c];
            rf_write_real(f, x, y, a, 1);
        }
    }
}

/* Makes the volume. The cone's radius is to half the picture's width as tan(half its angle) to
 * tan(half the picture's). */
static void make_volume(struct work *work)
{
    const struct rf_settings *p = work->f->params;
    double s, c, picture;

    rf_sincos_turns(p->picture_angle / 720.0, &s, &c);
    picture = s / c;
    rf_sincos_turns(p->attention_angle / 720.0, &s, &c);
    work->radius = work->f->view->width / 2.0 * (s / c) / picture;
    work->margin = work->radius / 4;
    work->centre_x = p->attention_x * (work->f->view->width - 1);
    work->centre_y = p->attention_y * (work->f->view->height - 1);
}

static void render_frame(struct rf_frame *f)
{
    const struct rf_limits limits = f->limits;
    struct rf_arena arena = {f->work->at, 0};
    struct work *work = lay_out(&limits, &arena, NULL);

    f->work->owner = RF_NO_METHOD;
    work->f = f;
    size_levels(work, f->view->width, f->view->height);
    work->front_borders = border_of(rf_nearest_blur(f));
    work->back_borders = border_of(rf_farthest_blur(f));
    list_borders(work, work->front_borders > work->back_borders ? work->front_borders
                                                                : work->back_borders);
    make_volume(work);
    make_pyramids(work);
    rf_pool_run(f->exec->pool, write_rows, work, (f->region.y1 - f->region.y0 + ROWS - 1) / ROWS);
}

const struct rf_method rf_foveated_method = {.frame = render_frame, .work_bytes = work_bytes};
