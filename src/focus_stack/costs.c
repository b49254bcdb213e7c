/* costs.c: what each focus of a stack costs at each sample, its guide and its confidence. */
#include "focus_stack/focus_stack.h"

#include <string.h>

enum {
    BAND = 64, /* rows that a worker takes at a time */
    /* Squares of sharpness, in quarters of a squared code: */
    ERROR_NOISE = 64, /* 4 codes of what a blur is wrong by, which noise and rounding make */
    BESIDE_EDGES = RF_STACK_NOISE / 4, /* 10 codes that the skirt of a blurred edge makes */
    /* The least sharp frame in parts of the sharpest, Q8, since noise is alike in all frames: */
    SURE = 64,    /* depth is sure down from here; */
    UNSURE = 128, /* depth is unknown up from here */
    TELLING = 1,  /* the square whose means tell which it is */
};

static const int reach[RF_STACK_SQUARES] = {0, 4, 8};

struct move {
    const struct refocus_stack *stack;
    const struct rf_stack_frame *frame;
};

static void move_row(void *context, int y, int worker)
{
    const struct move *move = context;
    const struct refocus_stack *s = move->stack;
    const int w = s->columns, h = s->rows, k = s->reduced;
    const struct rf_stack_line line =
        rf_stack_line(s, move->frame, 0.5 * (k - 1), y * k + 0.5 * (k - 1), k);
    const int64_t half = (int64_t)(k - 1) << 31;
    uint16_t *out = s->moved + (size_t)y * (size_t)w;

    (void)worker;
    for (int x = 0; x < w; x++) {
        /* Q32 pixels of the frame, to Q8 samples. */
        const int64_t px = ((line.x + x * line.dx - half) >> 24) / k;
        const int64_t py = ((line.y + x * line.dy - half) >> 24) / k;
        const int u = (int)(px & 255), v = (int)(py & 255);
        const int64_t left = px >> 8, above = py >> 8;
        const int x0 = left < 0 ? 0 : left < w ? (int)left : w - 1;
        const int y0 = above < 0 ? 0 : above < h ? (int)above : h - 1;
        const int x1 = left < 0 ? 0 : rf_stack_clamp(x0 + 1, w - 1);
        const int y1 = above < 0 ? 0 : rf_stack_clamp(y0 + 1, h - 1);
        const uint16_t *p = move->frame->sharpness + (size_t)y0 * (size_t)w;
        const uint16_t *q = move->frame->sharpness + (size_t)y1 * (size_t)w;

        out[x] =
            (uint16_t)((((uint32_t)p[x0] * (uint32_t)(256 - u) + (uint32_t)p[x1] * (uint32_t)u) /
                            256 * (uint32_t)(256 - v) +
                        ((uint32_t)q[x0] * (uint32_t)(256 - u) + (uint32_t)q[x1] * (uint32_t)u) /
                            256 * (uint32_t)v) >>
                       8);
    }
}

/* Sharpness of a frame as the reference sees it: bilinear, in the memory that it has. */
static void move(struct refocus_stack *s, struct rf_stack_frame *frame)
{
    const struct rf_similarity *m = &frame->from_reference;

    if (m->c[0] == 1 && m->c[1] == 0 && m->t[0] == 0 && m->t[1] == 0)
        return;
    rf_pool_run(s->pool, move_row, &(struct move){s, frame}, s->rows);
    memcpy(frame->sharpness, s->moved,
           (size_t)s->columns * (size_t)s->rows * sizeof *frame->sharpness);
}

static uint32_t *columns_of(const struct refocus_stack *s, int worker, int i, int k)
{
    return s->column +
           (size_t)((worker * RF_STACK_SQUARES + i) * s->planes + k) * (size_t)s->columns;
}

/* The sums of columns move from row y - 1 to row y, or are begun there. */
static void add_row(const struct refocus_stack *s, int worker, int y, bool begin)
{
    for (int i = 0; i < RF_STACK_SQUARES; i++)
        for (int k = 0; k < s->planes; k++) {
            const uint16_t *in = s->plane[k];
            const size_t w = (size_t)s->columns;
            uint32_t *restrict sum = columns_of(s, worker, i, k);
            const int first = begin ? y - reach[i] : y + reach[i];

            if (begin)
                memset(sum, 0, w * sizeof *sum);
            for (int v = first; v <= y + reach[i]; v++) {
                const uint16_t *restrict row = in + (size_t)rf_stack_clamp(v, s->rows - 1) * w;

                for (size_t x = 0; x < w; x++)
                    sum[x] += rf_stack_squared(row[x]);
            }
            if (!begin) {
                const uint16_t *restrict row =
                    in + (size_t)rf_stack_clamp(y - reach[i] - 1, s->rows - 1) * w;

                for (size_t x = 0; x < w; x++)
                    sum[x] -= rf_stack_squared(row[x]);
            }
        }
}

/* Costs of one sample from means over a square: 0 of the sharpest frame, below 85. */
static void add_costs(const struct refocus_stack *s, uint8_t *cost, const uint32_t *mean)
{
    uint32_t most = 0;

    for (int k = 0; k < s->count; k++)
        most = mean[k] > most ? mean[k] : most;
    for (int k = 0; k < s->count; k++)
        cost[k] = (uint8_t)(cost[k] + (uint64_t)(most - mean[k]) * 85 / (most + RF_STACK_NOISE));
}

/* Costs by mean squares of errors: 0 of the least one, below 85. */
static void add_error_costs(const struct refocus_stack *s, uint8_t *cost, const uint32_t *mean)
{
    uint32_t least = mean[0], most = mean[0];

    for (int k = 1; k < s->planes; k++) {
        least = mean[k] < least ? mean[k] : least;
        most = mean[k] > most ? mean[k] : most;
    }

    const uint64_t scale = (UINT64_C(85) << 24) / (most + ERROR_NOISE);

    for (int k = 0; k < s->planes; k++)
        cost[k] = (uint8_t)(cost[k] + ((mean[k] - least) * scale >> 24));
}

static uint8_t sure_by(uint64_t least, uint64_t most, uint64_t noise)
{
    const int ratio = (int)((least + noise) * 256 / (most + noise));

    return (uint8_t)rf_stack_clamp(255 * (UNSURE - ratio) / (UNSURE - SURE), 255);
}

/* How sure the depth of a sample is; in focus stacks, what faint.c needs as well. */
static void tell(const struct refocus_stack *s, size_t i, const uint32_t *mean)
{
    const uint32_t noise = 2 * s->noise;
    uint32_t least = mean[0], most = mean[0];

    for (int k = 1; k < s->planes; k++) {
        least = mean[k] < least ? mean[k] : least;
        most = mean[k] > most ? mean[k] : most;
    }
    if (s->kind == REFOCUS_STACK_FOCUS) {
        const struct rf_stack_faint faint = rf_stack_faint(s);

        faint.strongest[i] = most;
        faint.sure[i] = sure_by(least, most, ERROR_NOISE + noise);
        s->sure[i] = sure_by(least, most, noise > BESIDE_EDGES ? noise : BESIDE_EDGES);
    } else {
        s->sure[i] = sure_by(least, most, ERROR_NOISE);
    }
}

/* A sum over a square as a mean; divisors are constants, by which compilers multiply. */
static uint32_t mean_of(uint64_t sum, int i)
{
    return (uint32_t)(i == 0 ? sum : i == 1 ? sum / (9 * 9) : sum / (17 * 17));
}

static void cost_row(struct refocus_stack *s, int worker, int y)
{
    const uint32_t noise = s->kind == REFOCUS_STACK_FOCUS ? s->noise : 0; /* alike in all frames */
    const int w = s->columns, n = s->labels;
    uint8_t *cost = s->cost + (size_t)y * (size_t)w * (size_t)n;

    memset(cost, 255, (size_t)w * (size_t)n);
    for (int x = 0; x < w; x++)
        memset(cost + (size_t)x * (size_t)n, 0, (size_t)s->depths);
    for (int i = 0; i < RF_STACK_SQUARES; i++) {
        const int r = reach[i];
        const uint32_t *column[REFOCUS_STACK_MOST_FRAMES];
        uint64_t sum[REFOCUS_STACK_MOST_FRAMES] = {0};
        uint32_t mean[REFOCUS_STACK_MOST_FRAMES];

        for (int k = 0; k < s->planes; k++) {
            column[k] = columns_of(s, worker, i, k);
            for (int x = -r - 1; x < r; x++)
                sum[k] += column[k][rf_stack_clamp(x, w - 1)];
        }
        for (int x = 0; x < w; x++) {
            const int right = rf_stack_clamp(x + r, w - 1), left = rf_stack_clamp(x - r - 1, w - 1);

            for (int k = 0; k < s->planes; k++) {
                sum[k] += column[k][right];
                sum[k] -= column[k][left];
                mean[k] = mean_of(sum[k], i);
                mean[k] -= mean[k] < noise ? mean[k] : noise;
            }
            if (s->kind != REFOCUS_STACK_FOCUS)
                add_error_costs(s, cost + (size_t)x * (size_t)n, mean);
            else if (s->sub > 1)
                rf_stack_model_costs(s, cost + (size_t)x * (size_t)n, mean);
            else
                add_costs(s, cost + (size_t)x * (size_t)n, mean);
            if (i == TELLING)
                tell(s, (size_t)y * (size_t)w + (size_t)x, mean);
        }
    }
}

void rf_stack_sample_lines(const struct refocus_stack *s, struct rf_stack_line *line, int y)
{
    const double half = 0.5 * (s->reduced - 1);

    for (int k = 0; k < s->count; k++)
        line[k] = rf_stack_line(s, &s->frame[k], half, y * s->reduced + half, s->reduced);
}

void rf_stack_guide(struct refocus_stack *s, const struct rf_stack_line *line, int k, int x, int y)
{
    const int u = rf_stack_clamp((int)((line[k].x + x * line[k].dx) >> 32), s->width - 1);
    const int v = rf_stack_clamp((int)((line[k].y + x * line[k].dy) >> 32), s->height - 1);

    memcpy(s->guide + 3 * ((size_t)y * (size_t)s->columns + (size_t)x),
           s->frame[k].rgb + 3 * ((size_t)v * (size_t)s->width + (size_t)u), 3);
}

/* Whether frame k and those beside it in focus show the place of a sample. */
static bool is_shown(const struct refocus_stack *s, const struct rf_stack_line *line, int k, int x)
{
    for (int i = k - 1; i <= k + 1; i++)
        if (i >= 0 && i < s->count && !rf_stack_reaches(s, &line[i], x))
            return false;
    return true;
}

/* The colour of the frame that costs least, where depth may change. Beyond the border of a frame
 * its sharpness is repeated: if the least cost is such a one's, or may be, nothing was measured. */
static void guide_row(struct refocus_stack *s, int y)
{
    struct rf_stack_line line[REFOCUS_STACK_MOST_FRAMES];

    rf_stack_sample_lines(s, line, y);
    for (int x = 0; x < s->columns; x++) {
        const size_t i = (size_t)y * (size_t)s->columns + (size_t)x;
        const uint8_t *cost = s->cost + i * (size_t)s->labels;
        int best = 0;

        for (int k = 1; k < s->depths; k++)
            best = cost[k] < cost[best] ? k : best;
        best = (best + s->sub / 2) / s->sub;
        rf_stack_guide(s, line, best, x, y);
        if (!is_shown(s, line, best, x))
            s->sure[i] = 0;
    }
}

/* The colour of the frame of the narrowest aperture. */
static void guide_by_narrowest(struct refocus_stack *s, int y)
{
    struct rf_stack_line line[REFOCUS_STACK_MOST_FRAMES];

    rf_stack_sample_lines(s, line, y);
    for (int x = 0; x < s->columns; x++)
        rf_stack_guide(s, line, 0, x, y);
}

static void cost_band(void *context, int band, int worker)
{
    struct refocus_stack *const s = context;
    const int begin = band * BAND, end = begin + BAND < s->rows ? begin + BAND : s->rows;

    for (int y = begin; y < end; y++) {
        add_row(s, worker, y, y == begin);
        cost_row(s, worker, y);
        if (s->kind != REFOCUS_STACK_FOCUS)
            guide_by_narrowest(s, y);
    }
}

static void guide_focus_row(void *context, int y, int worker)
{
    (void)worker;
    rf_stack_leave_out(context, y);
    guide_row(context, y);
}

void rf_stack_sharpness(struct refocus_stack *s)
{
    for (int k = 0; k < s->count; k++) {
        move(s, &s->frame[k]);
        s->plane[k] = s->frame[k].sharpness;
    }
    s->planes = s->count;
}

void rf_stack_costs(struct refocus_stack *s)
{
    rf_pool_run(s->pool, cost_band, s, (s->rows + BAND - 1) / BAND);
    if (s->kind == REFOCUS_STACK_FOCUS) {
        rf_stack_take_faint(s);
        rf_pool_run(s->pool, guide_focus_row, s, s->rows);
    }
}
