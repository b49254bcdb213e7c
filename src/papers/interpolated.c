/* interpolated.c: depth of field from three pictures, NVIDIA 2004: a quick preview.
 *
 * A table gives each disparity a blurriness of 0 to 1. The colour is interpolated between
 * three targets: the picture itself (0), one blurred by a radius of r1 c0 (1/2) and one
 * by r2 c0 (1). The blurred ones are smaller the more they are blurred, filtered in x and in y
 * (target.c), and enlarged again as they are read. Nothing is known of edges.
 */
#include "papers/blurriness.h"
#include "papers/target.h"
#include "support/compare.h"

#include <assert.h>
#include <math.h>

enum {
    SECOND = 1 << 15,
    ROWS = 2, /* rows of a work item: two of a P010 picture share samples of chroma */
};

struct work {
    struct rf_frame *f;
    uint8_t table[RF_BLURRINESS_SIZE];
    /* Q15 share of the way to the first target, or SECOND plus that from the first to the second:
     */
    uint16_t share[RF_BLURRINESS_SIZE];
    struct rf_target target[2];
    struct rf_target_work making;
};

/* Lays out the memory of the arena; without any it fills *counted and only counts the bytes. */
static struct work *lay_out(const struct rf_limits *limits, struct rf_arena *arena,
                            struct work *counted)
{
    struct work *work = rf_arena_take(arena, 1, sizeof *work);
    const uint64_t pixels = (uint64_t)limits->width * (uint64_t)limits->height;
    struct rf_target_work *making;

    if (!work)
        work = counted;
    making = &work->making;
    for (int c = 0; c < RF_TARGET_CHANNELS; c++)
        making->across[c] = rf_arena_take(arena, pixels, sizeof(float));
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++)
            work->target[i].light[c] = rf_arena_take(arena, pixels, sizeof(int16_t));
    making->row_length = limits->width + RF_TARGET_SPARE;
    making->row = rf_arena_take(arena, (uint64_t)making->row_length * (uint64_t)limits->threads,
                                RF_TARGET_ROWS * sizeof(float));
    return work;
}

static uint64_t work_bytes(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};
    struct work counted;

    lay_out(limits, &arena, &counted);
    return arena.used;
}

void rf_blurriness_table(uint8_t table[RF_BLURRINESS_SIZE], double focus, double blur, double c0,
                         double middle, double last)
{
    for (int i = 0; i < RF_BLURRINESS_SIZE; i++) {
        const double circle = blur * fabs(i / (RF_BLURRINESS_SIZE - 1.0) - focus);
        const double blurriness = circle <= c0       ? 0
                                  : circle <= middle ? 0.5 * (circle - c0) / (middle - c0)
                                  : circle < last ? 0.5 + 0.5 * (circle - middle) / (last - middle)
                                                  : 1;

        table[i] = (uint8_t)(blurriness * 255 + 0.5);
    }
}

/* Goes from a to b by a share in Q15. Both are Q14, which leaves room for a sign. */
static_assert(2 * RF_MEAN_MAX <= INT16_MAX, "twice a difference fits 16 bits");
static inline int16_t between(int16_t a, int16_t b, int16_t share)
{
    return (int16_t)(a + (int16_t)((2 * (b - a) * share) >> 16));
}

static void mix_rows(int16_t *restrict out, const int16_t *restrict a, const int16_t *restrict b,
                     int16_t share, int n)
{
    for (int x = 0; x < n; x++)
        out[x] = between(a[x], b[x], share);
}

/* Interpolates from the middle of each pixel to that of the next. */
static inline void lines(int16_t *restrict out, const int16_t *restrict row, const int16_t *share,
                         int n, const int side)
{
    for (int x = 0; x < n; x++)
        for (int i = 0; i < side; i++)
            out[x * side + i] = between(row[x], row[x + 1], share[i]);
}

/* Draws straight lines between the middles of n pixels, each `side` = 2^shift wide, at n * side
 * places; `row` has pixels -1 and n, too. */
static void enlarge(int16_t *restrict out, const int16_t *restrict row, int n, int shift)
{
    const int side = 1 << shift;
    int16_t share[1 << RF_TARGET_SHIFTS], *place = out + side / 2;

    for (int i = 0; i < side; i++)
        share[i] = (int16_t)((2 * i + 1) << (14 - shift));
    for (int i = 0; i < side / 2; i++) {
        out[i] = between(row[-1], row[0], share[side / 2 + i]);
        out[n * side - side / 2 + i] = between(row[n - 1], row[n], share[i]);
    }
    switch (shift) { /* the compiler knows the side in each case */
    case 1:
        lines(place, row, share, n - 1, 2);
        break;
    case 2:
        lines(place, row, share, n - 1, 4);
        break;
    case 3:
        lines(place, row, share, n - 1, 8);
        break;
    default:
        lines(place, row, share, n - 1, 16);
    }
}

/* Enlarges one channel of a target to row y of the picture. */
static void enlarged_row(const struct rf_target *b, int c, int y, int16_t *row, int16_t *out)
{
    const int place = 2 * y + 1 - (1 << b->shift); /* from the middle of row 0, in halves */
    const int first = place < 0 ? -1 : place >> (b->shift + 1);
    const int share = place - first * (2 << b->shift);
    const int16_t *light = b->light[c];
    const size_t width = (size_t)b->width;

    if (b->shift == 0)
        row = out;
    mix_rows(row, light + width * (size_t)rf_clamp(first, 0, b->height - 1),
             light + width * (size_t)rf_clamp(first + 1, 0, b->height - 1),
             (int16_t)(share << (14 - b->shift)), b->width);
    if (b->shift == 0)
        return;
    row[-1] = row[0];
    row[width] = row[width - 1];
    enlarge(out, row, b->width, b->shift);
}

/* Interpolates between the picture and the first target, or from SECOND on between both targets. */
static void interpolate(uint16_t *restrict mean, const uint16_t *restrict light,
                        const int16_t *restrict middle, const int16_t *restrict last,
                        const uint16_t *restrict share, int n)
{
    for (int x = 0; x < n; x++) {
        const int16_t second = (int16_t)(share[x] >= SECOND ? -1 : 0);
        const int16_t sharp = (int16_t)(4 * light[x]);
        const int16_t a = (int16_t)((middle[x] & second) | (sharp & ~second));
        const int16_t b = (int16_t)((last[x] & second) | (middle[x] & ~second));

        mean[x] = (uint16_t)between(a, b, (int16_t)(share[x] & (SECOND - 1)));
    }
}

/* Computes the means of row y of the region. Works in four rows of scratch. */
static void mean_row(const struct work *work, int y, int16_t *scratch, uint16_t *const mean[3])
{
    const struct rf_frame *f = work->f;
    const int x0 = f->region.x0, n = f->region.x1 - x0;
    const size_t length = (size_t)work->making.row_length;
    int16_t *row = scratch, *middle = row + length, *last = middle + length;
    uint16_t *share = (uint16_t *)(last + length);
    const uint16_t *d = f->disparity.at + y * f->view->stride + x0;

    for (int x = 0; x < n; x++)
        share[x] = work->share[(d[x] * (RF_BLURRINESS_SIZE - 1u) + 32767) >> 16];
    for (int c = 0; c < 3; c++) {
        enlarged_row(&work->target[0], c, y, row + 1, middle);
        enlarged_row(&work->target[1], c, y, row + 1, last);
        interpolate(mean[c], f->light.channel[c] + y * f->view->stride + x0, middle + x0, last + x0,
                    share, n);
    }
}

static_assert((4 + 3 * ROWS) * sizeof(int16_t) <= RF_TARGET_ROWS * sizeof(float),
              "scratch of a thread holds the means of all rows of an item");
static void write_rows(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct rf_frame *f = work->f;
    const int y0 = f->region.y0 + ROWS * item, y1 = rf_smaller(y0 + ROWS, f->region.y1);
    const size_t length = (size_t)work->making.row_length;
    int16_t *scratch = (int16_t *)(void *)rf_target_scratch(&work->making, worker);
    uint16_t *first = (uint16_t *)(scratch + 4 * length);
    uint16_t *mean[3] = {first, first + ROWS * length, first + 2 * ROWS * length};

    for (int y = y0; y < y1; y++) {
        const size_t at = (size_t)(y - y0) * length;

        mean_row(work, y, scratch, (uint16_t *const[3]){mean[0] + at, mean[1] + at, mean[2] + at});
    }
    rf_encode_rows(f, (struct rf_rect){f->region.x0, y0, f->region.x1, y1},
                   (const uint16_t *const[3]){mean[0], mean[1], mean[2]}, (int)length);
}

/* Turns the table into shares of the way from one target to the next. */
static void make_shares(struct work *work)
{
    for (int i = 0; i < RF_BLURRINESS_SIZE; i++) {
        const int b = 2 * work->table[i];

        work->share[i] = (uint16_t)(b <= 255 ? b * 32767 / 255 : SECOND + (b - 255) * 32767 / 255);
    }
}

static void render_frame(struct rf_frame *f)
{
    const struct rf_settings *p = f->params;
    const struct rf_limits limits = f->limits;
    struct rf_arena arena = {f->work->at, 0};
    struct work *work = lay_out(&limits, &arena, NULL);
    const double df = p->focus_disparity, c0 = p->sharp_radius;
    double last = c0 * p->last_ratio, middle = c0 * p->middle_ratio;

    f->work->owner = RF_NO_METHOD;
    work->f = f;
    if (last <= 0)
        last = p->max_blur_radius * (df > 0.5 ? df : 1 - df);
    if (last <= c0) /* nothing is blurred at all */
        last = 2 * c0;
    if (middle <= c0 || middle >= last)
        middle = (c0 + last) / 2;
    rf_blurriness_table(work->table, df, p->max_blur_radius, c0, middle, last);
    make_shares(work);
    work->making.f = f;
    rf_target_make(&work->making, &work->target[0], middle);
    if (!rf_cancelled(f->exec))
        rf_target_make(&work->making, &work->target[1], last);
    rf_pool_run(f->exec->pool, write_rows, work, (f->region.y1 - f->region.y0 + ROWS - 1) / ROWS);
}

const struct rf_method rf_interpolated_method = {.frame = render_frame, .work_bytes = work_bytes};
