/* interpolated.c: depth of field from three pictures, NVIDIA 2004: the cheapest preview.
 *
 * A table gives each disparity a blurriness of 0 to 1. The colour is interpolated between
 * three targets: the picture itself (0), one blurred by a radius of r1 c0 (1/2) and one
 * by r2 c0 (1). The blurred ones are smaller the more they are blurred, filtered by three
 * boxes in x and in y, and enlarged again as they are read. Nothing is known of edges.
 */
#include "methods/blurriness.h"
#include "methods/frame.h"

#include <math.h>

enum { CHANNELS = 4, MOST_SHIFT = 3, ROWS = 16 };

/* A picture of 1 / 2^shift the size: light times weight in R, G, B, and the weight. */
struct target {
    int shift, width, height;
    double radius; /* in its own pixels */
    float *plane[CHANNELS];
};

struct work {
    struct rf_frame *f;
    uint8_t table[RF_BLURRINESS_SIZE];
    struct target target[2], turned; /* turned: one with x and y exchanged */
    struct target *from, *to;        /* of the filter pass that runs */
    float *row;                      /* scratch of each thread */
    int row_length;
};

/* Memory when the arena has some; else *counted is filled and the bytes are counted. */
static struct work *lay_out(const struct rf_limits *limits, struct rf_arena *arena,
                            struct work *counted)
{
    struct work *work = rf_arena_take(arena, 1, sizeof *work);
    const uint64_t pixels = (uint64_t)limits->width * (uint64_t)limits->height;

    if (!work)
        work = counted;
    for (int c = 0; c < CHANNELS; c++) {
        work->target[0].plane[c] = rf_arena_take(arena, pixels, sizeof(float));
        work->target[1].plane[c] = rf_arena_take(arena, pixels, sizeof(float));
        work->turned.plane[c] = rf_arena_take(arena, pixels, sizeof(float));
    }
    work->row_length = limits->width > limits->height ? limits->width : limits->height;
    work->row = rf_arena_take(arena, (uint64_t)work->row_length * (uint64_t)limits->threads,
                              sizeof(float));
    return work;
}

uint64_t rf_interpolated_work(const struct rf_limits *limits)
{
    struct rf_arena arena = {NULL, 0};
    struct work counted;

    lay_out(limits, &arena, &counted);
    return arena.used;
}

void rf_blurriness_table(uint8_t table[RF_BLURRINESS_SIZE], double focus, double blur,
                         double c0, double middle, double last)
{
    for (int i = 0; i < RF_BLURRINESS_SIZE; i++) {
        const double circle = blur * fabs(i / (RF_BLURRINESS_SIZE - 1.0) - focus);
        const double blurriness =
            circle <= c0       ? 0
            : circle <= middle ? 0.5 * (circle - c0) / (middle - c0)
            : circle < last    ? 0.5 + 0.5 * (circle - middle) / (last - middle)
                               : 1;

        table[i] = (uint8_t)(blurriness * 255 + 0.5);
    }
}

/* Size of a target for a blur radius in pixels. */
static void shape_target(struct target *target, const struct refocus_renderer *r,
                         double radius)
{
    target->shift = 0;
    while (target->shift < MOST_SHIFT && radius / (2 << target->shift) >= 2)
        target->shift++;
    target->width = (r->width + (1 << target->shift) - 1) >> target->shift;
    target->height = (r->height + (1 << target->shift) - 1) >> target->shift;
    target->radius = radius / (1 << target->shift);
}

/* A row of a target: means of blocks of the picture, whose border is extended. */
static void reduce_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const struct target *t = work->to;
    const struct rf_frame *f = work->f;
    const int side = 1 << t->shift;
    const float share = 1.0f / (float)(side * side);

    (void)worker;
    for (int x = 0; x < t->width; x++) {
        double sum[CHANNELS] = {0, 0, 0, 0};

        for (int j = 0; j < side; j++) {
            for (int i = 0; i < side; i++) {
                const ptrdiff_t at = (ptrdiff_t)(y * side + j) * f->r->stride + x * side + i;
                const double w = rf_weight_of(f, f->r->front.light, at);

                sum[3] += w;
                for (int c = 0; c < 3; c++)
                    sum[c] += w * f->r->front.light[c][at];
            }
        }
        for (int c = 0; c < CHANNELS; c++)
            t->plane[c][(size_t)y * (size_t)t->width + (size_t)x] = (float)sum[c] * share;
    }
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* One box over a row of n values, ends extended: 2 h + 1 values and the share a of one more at
 * each side. */
static void box(float *restrict out, size_t step, const float *restrict in, int n, int h,
                double a)
{
    const double share = 1 / (2 * h + 1 + 2 * a);
    double sum = 0;

    for (int i = -h; i <= h; i++)
        sum += in[clamp(i, n - 1)];
    for (int x = 0; x < n; x++) {
        const float left = in[clamp(x - h - 1, n - 1)], right = in[clamp(x + h + 1, n - 1)];

        out[(size_t)x * step] = (float)((sum + a * ((double)left + right)) * share);
        sum += (double)right - in[clamp(x - h, n - 1)];
    }
}

/* Rows of *from, filtered, into columns of *to. Three boxes of variance radius^2 / 12 have the
 * variance of a disc along one axis, radius^2 / 4. */
static void filter_rows(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct target *from = work->from, *to = work->to;
    const double variance = from->radius * from->radius / 12;
    const int n = from->width;
    int h = 0;
    double a;

    while ((h + 1) * (h + 2) / 3.0 <= variance)
        h++;
    a = (2 * h + 1) * (variance - h * (h + 1) / 3.0) / (2 * ((h + 1.0) * (h + 1.0) - variance));
    for (int y = item * ROWS; y < (item + 1) * ROWS && y < from->height; y++) {
        if (rf_cancelled(work->f->r))
            return;
        for (int c = 0; c < CHANNELS; c++) {
            /* rows of both are scratch to each other until the last box */
            float *row = from->plane[c] + (size_t)y * (size_t)n;
            float *column = to->plane[c] + y;
            float *scratch = work->row + (size_t)worker * (size_t)work->row_length;

            box(scratch, 1, row, n, h, a);
            box(row, 1, scratch, n, h, a);
            box(column, (size_t)from->height, row, n, h, a);
        }
    }
}

static void turn(struct work *work, struct target *from, struct target *to)
{
    to->width = from->height;
    to->height = from->width;
    to->radius = from->radius;
    to->shift = from->shift;
    work->from = from;
    work->to = to;
    rf_pool_run(&work->f->r->pool, filter_rows, work, (from->height + ROWS - 1) / ROWS);
}

static void make_target(struct work *work, struct target *target, double radius)
{
    shape_target(target, work->f->r, radius);
    work->to = target;
    rf_pool_run(&work->f->r->pool, reduce_row, work, target->height);
    turn(work, target, &work->turned);
    turn(work, &work->turned, target);
}

/* A target's light and weight at a pixel of the picture, by its four nearest. */
static void sample(const struct target *t, int x, int y, double share, double out[CHANNELS])
{
    const double scale = 1.0 / (1 << t->shift);
    const double fx = (x + 0.5) * scale - 0.5, fy = (y + 0.5) * scale - 0.5;
    const int ix = (int)floor(fx), iy = (int)floor(fy);
    const double ax = fx - ix, ay = fy - iy;

    for (int j = 0; j < 2; j++) {
        for (int i = 0; i < 2; i++) {
            const size_t at = (size_t)clamp(iy + j, t->height - 1) * (size_t)t->width +
                              (size_t)clamp(ix + i, t->width - 1);
            const double w = share * (i ? ax : 1 - ax) * (j ? ay : 1 - ay);

            for (int c = 0; c < CHANNELS; c++)
                out[c] += w * t->plane[c][at];
        }
    }
}

static void write_row(void *context, int item, int worker)
{
    const struct work *work = context;
    const struct rf_frame *f = work->f;
    const struct refocus_renderer *r = f->r;
    const int y = f->region.y0 + item;

    (void)worker;
    for (int x = f->region.x0; x < f->region.x1; x++) {
        const ptrdiff_t at = y * r->stride + x;
        const uint32_t d = r->disparity[y * r->stride + x];
        const int blurriness = work->table[(d * (RF_BLURRINESS_SIZE - 1) + 32767) / 65535];
        const double b = blurriness * 2 / 255.0, w = rf_weight_of(f, r->front.light, at);
        double sum[CHANNELS] = {0, 0, 0, 0};

        if (blurriness == 0) {
            rf_copy_tile(f, (struct rf_rect){x, y, x + 1, y + 1});
            continue;
        }
        if (b < 1) {
            for (int c = 0; c < 3; c++)
                sum[c] = (1 - b) * w * r->front.light[c][at];
            sum[3] = (1 - b) * w;
        }
        sample(&work->target[0], x, y, b < 1 ? b : 2 - b, sum);
        if (b > 1)
            sample(&work->target[1], x, y, b - 1, sum);
        rf_write_real(f, x, y, sum, sum[3]);
    }
}

void rf_interpolated_frame(struct rf_frame *f)
{
    const struct refocus_render_params *p = f->params;
    const struct rf_limits limits = rf_limits_of(f->r);
    struct rf_arena arena = {f->r->work, 0};
    struct work *work = lay_out(&limits, &arena, NULL);
    const double df = p->focus_disparity, c0 = p->sharp_radius;
    double last = c0 * p->last_ratio, middle = c0 * p->middle_ratio;

    f->r->work_owner = RF_NO_METHOD;
    work->f = f;
    if (last <= 0)
        last = p->max_blur_radius * (df > 0.5 ? df : 1 - df);
    if (last <= c0) /* then nothing is blurred at all */
        last = 2 * c0;
    if (middle <= c0 || middle >= last)
        middle = (c0 + last) / 2;
    rf_blurriness_table(work->table, df, p->max_blur_radius, c0, middle, last);
    make_target(work, &work->target[0], middle);
    if (!rf_cancelled(f->r))
        make_target(work, &work->target[1], last);
    rf_pool_run(&f->r->pool, write_row, work, f->region.y1 - f->region.y0);
}
