/* foveated.c: exact where one looks, fast elsewhere, Mulder & van Liere 2000.
 *
 * The centre of attention volume is a cone about the line of sight, cut at two depths.
 * In it the "high resolution" technique works: circles of confusion, of the diameter of 1, 3,
 * 5, ... that is nearest to theirs, are spread as uniform discs, all samples whose circle holds a
 * pixel, front to back: the borders of the discs before the focus from the outermost in, the
 * middle, then those behind it from the innermost out. Alpha saturates, so nothing gets too bright,
 * and the alpha that is missing at the end comes from the picture (hypo-intensity correction).
 *
 * Outside, two Gaussian pyramids are read, see pyramids.h.
 *
 * Across the side of the volume the one fades into the other.
 */
#include "papers/papers.h"
#include "papers/pyramids.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    BORDERS = REFOCUS_PLAIN_BLUR_RADIUS + 2,
    ONE = 1 << 24, /* alpha */
    ROWS = 8,
};

struct offset {
    int16_t x, y;
};

struct work {
    struct rf_frame *f;
    struct rf_pyramids low;

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

/* Lays out the memory of the arena; without any it fills *counted and only counts the bytes. */
static struct work *lay_out(const struct rf_limits *limits, struct rf_arena *arena,
                            struct work *counted)
{
    struct work *work = rf_arena_take(arena, 1, sizeof *work);

    if (!work)
        work = counted;
    rf_pyramids_lay_out(&work->low, limits, arena);
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

/* The border b of the disc that a signed blur has: its diameter 2 b + 1 is the odd number nearest
 * to 2 r. Radii of 3.0 to 3.9 have discs of diameter 7, those below 1 are sharp. */
static int border_of(int s)
{
    return (s < 0 ? -s : s) >> 8;
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
    const uint64_t w = (uint64_t)a * rf_weight_of(f, q);

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

        if (s > 0 && border_of(s) >= b)
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
                rf_pyramids_show(&work->low, x, y, b);
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
    work->front_borders = border_of(rf_nearest_blur(f));
    work->back_borders = border_of(rf_farthest_blur(f));
    list_borders(work, work->front_borders > work->back_borders ? work->front_borders
                                                                : work->back_borders);
    make_volume(work);
    rf_pyramids_make(&work->low, f);
    rf_pool_run(f->exec->pool, write_rows, work, (f->region.y1 - f->region.y0 + ROWS - 1) / ROWS);
}

const struct rf_method rf_foveated_method = {.frame = render_frame, .work_bytes = work_bytes};
