/* blur_errors.c: how wrong each blur of the narrowest aperture is about the wider ones.
 *
 * Frames of one focus differ by blur alone: a wider aperture shows a surface as the narrowest one
 * does, spread over a disc whose radius is in proportion to its distance from the focus in dioptres
 * (depth from defocus, Ens & Lawrence 1993). So the narrowest frame is blurred by each of RADII
 * discs, and the error of label n at a sample is the mean over frames k and channels of
 *
 *     | code(mean of I_0 over a disc of n r_k) - code(I_k m_0 / m_k) |
 *
 * in linear light of sRGB, m being means over a square around the sample: blur leaves them, so they
 * undo another exposure, another white and light that falls off towards the corners of a wide
 * aperture. With a the diameters of the apertures, squared radii of one blur after the other add
 * up:
 *
 *     r_k^2 = (a_k^2 - a_0^2) / (a_widest^2 - a_0^2)
 *
 * Sums over discs are those of a few rectangles each, of a summed-area table (Crow 1984), which
 * wraps around: all of them are below 2^32.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <string.h>

#include "colour/transfer.h"

enum {
    RADII = RF_STACK_RADII,
    MARGIN = RF_STACK_MARGIN, /* half of the square of the means, too */
    NOT_SHOWN = 1 << 15,      /* beside the light of a place that a wider frame does not show */
    HALF = 2 * RADII + 1,     /* rows of the largest disc */
    LESS = 8,                 /* bits that sums over a square have less when they are stored */
    FINE = 16,                /* parts of a code */
    CLIPPED = 250,            /* codes from here on do not tell how bright a blurred highlight is */
    INVERSE = 40,             /* bits of the inverse of an area */
};

/* Rows top to bottom, from -half to half, about a sample. */
struct band {
    int top, bottom, half;
};

struct disc {
    struct band band[HALF];
    int bands;
    uint64_t inverse; /* the inverse of its area: products are means rounded down */
};

/* A wider frame and one channel, at the work's size. */
struct work {
    struct refocus_stack *stack;
    uint16_t *narrow, *wide, *mean; /* Q12 light; sums over squares of the wide frame */
    double part;                    /* radii of this frame in parts of those of the widest */
    int frame, channel, parts;      /* errors are divided by parts, so that they are a mean */
};

static ptrdiff_t pitch_of(const struct refocus_stack *s)
{
    return s->columns + 2 * MARGIN + 1;
}

/* The rows of a disc of so many samples, those of one width as one band. */
static void make_disc(struct disc *disc, int radius)
{
    uint64_t area = 0;

    disc->bands = 0;
    for (int y = -radius; y <= radius; y++) {
        struct band *last = disc->bands ? &disc->band[disc->bands - 1] : NULL;
        int half = 0;

        /* Samples count within radius + 1 / 2, both sides in quarters. */
        while (4 * ((half + 1) * (half + 1) + y * y) <= (2 * radius + 1) * (2 * radius + 1))
            half++;
        area += (uint64_t)(2 * half + 1);
        if (last && last->half == half)
            last->bottom = y;
        else
            disc->band[disc->bands++] = (struct band){y, y, half};
    }
    disc->inverse = (UINT64_C(1) << INVERSE) / area + 1;
}

/* The summed-area table of a plane, whose border goes on for MARGIN samples, but for samples that
 * another plane does not show, unless that is NULL. */
static void sum_up(const struct refocus_stack *s, const uint16_t *plane, const uint16_t *shown)
{
    const ptrdiff_t pitch = pitch_of(s);
    uint32_t *above = s->table;

    memset(above, 0, (size_t)pitch * sizeof *above);
    for (int y = -MARGIN; y < s->rows + MARGIN; y++, above += pitch) {
        const ptrdiff_t row = (ptrdiff_t)rf_stack_clamp(y, s->rows - 1) * s->columns;
        uint32_t *out = above + pitch, sum = 0;

        out[0] = 0;
        for (int x = -MARGIN; x < s->columns + MARGIN; x++) {
            const ptrdiff_t at = row + rf_stack_clamp(x, s->columns - 1);

            if (!shown || !(shown[at] & NOT_SHOWN))
                sum += plane[at];
            out[x + MARGIN + 1] = above[x + MARGIN + 1] + sum;
        }
    }
}

/* Adds the sums of a band about each sample of a row. */
static void add_band(const struct refocus_stack *s, uint32_t *restrict sum, const struct band *band,
                     int y)
{
    const ptrdiff_t pitch = pitch_of(s);
    const uint32_t *above = s->table + (y + MARGIN + band->top) * pitch;
    const uint32_t *below = s->table + (y + MARGIN + band->bottom + 1) * pitch;
    const int left = MARGIN - band->half, right = MARGIN + band->half + 1;

    for (int x = 0; x < s->columns; x++)
        sum[x] += below[x + right] - below[x + left] - above[x + right] + above[x + left];
}

/* A row of a worker's own. */
static uint32_t *row_of(const struct refocus_stack *s, int worker)
{
    return s->column + (ptrdiff_t)worker * s->columns;
}

static void sums_of_squares(const struct refocus_stack *s, int y, uint32_t *sum)
{
    memset(sum, 0, (size_t)s->columns * sizeof *sum);
    add_band(s, sum, &(struct band){-MARGIN, MARGIN, MARGIN}, y);
}

static void means_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const struct refocus_stack *s = work->stack;
    uint32_t *sum = row_of(s, worker);
    uint16_t *mean = work->mean + (ptrdiff_t)y * s->columns;

    sums_of_squares(s, y, sum);
    for (int x = 0; x < s->columns; x++)
        mean[x] = (uint16_t)(sum[x] >> LESS);
}

/* Light of the wider frame becomes that of the narrowest in the mean. */
static void match_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const struct refocus_stack *s = work->stack;
    const uint16_t *mean = work->mean + (ptrdiff_t)y * s->columns;
    uint16_t *wide = work->wide + (ptrdiff_t)y * s->columns;
    uint32_t *sum = row_of(s, worker);

    sums_of_squares(s, y, sum);
    for (int x = 0; x < s->columns; x++)
        if (mean[x] && !(wide[x] & NOT_SHOWN)) {
            const uint32_t light = wide[x] * (sum[x] >> LESS) / mean[x];

            wide[x] = (uint16_t)(light < RF_LIGHT_MAX ? light : RF_LIGHT_MAX);
        }
}

static void errors_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const struct refocus_stack *s = work->stack;
    const uint16_t *code = s->code, *wide = work->wide + (ptrdiff_t)y * s->columns;
    uint32_t *sum = row_of(s, worker);

    for (int n = 0; n < RADII; n++) {
        struct disc disc;
        uint16_t *error = s->error + ((ptrdiff_t)n * s->rows + y) * s->columns;

        make_disc(&disc, (int)(n * work->part + 0.5));
        memset(sum, 0, (size_t)s->columns * sizeof *sum);
        for (int i = 0; i < disc.bands; i++)
            add_band(s, sum, &disc.band[i], y);
        for (int x = 0; x < s->columns; x++) {
            const int blurred = code[sum[x] * disc.inverse >> INVERSE];

            if (!(wide[x] & NOT_SHOWN))
                error[x] = (uint16_t)(error[x] + abs(blurred - code[wide[x]]) / work->parts);
        }
    }
}

/* The mean light of the pixels of a sample in frame k, as the narrowest one shows them; -1: it does
 * not show all of them. */
static int light_at(const struct work *work, int k, int column, int row)
{
    const struct refocus_stack *s = work->stack;
    int sum = 0, pixels = 0;

    for (int y = row * s->reduced; y < (row + 1) * s->reduced && y < s->height; y++)
        for (int x = column * s->reduced; x < (column + 1) * s->reduced && x < s->width; x++) {
            uint8_t rgb[3];

            if (!rf_stack_pixel(s, k, x, y, rgb) || (k && rgb[work->channel] >= CLIPPED))
                return -1;
            sum += s->transfer->to_light[rgb[work->channel]];
            pixels++;
        }
    return (sum + pixels / 2) / pixels;
}

static void load_row(void *context, int y, int worker)
{
    const struct work *work = context;
    const ptrdiff_t row = (ptrdiff_t)y * work->stack->columns;

    (void)worker;
    for (int x = 0; x < work->stack->columns; x++) {
        const int narrow = light_at(work, 0, x, y), wide = light_at(work, work->frame, x, y);

        work->narrow[row + x] = (uint16_t)narrow;
        work->wide[row + x] = (uint16_t)(wide < 0 ? NOT_SHOWN : wide);
    }
}

/* The codes of all light, in parts of a code: on the line between those of whole ones. */
static void make_codes(struct refocus_stack *s)
{
    const uint16_t *light = s->transfer->to_light;
    int code = 0;

    for (int l = 0; l <= RF_LIGHT_MAX; l++) {
        while (code < 254 && light[code + 1] <= l)
            code++;
        s->code[l] =
            (uint16_t)(FINE * code + FINE * (l - light[code]) / (light[code + 1] - light[code]));
    }
}

static void add_errors(struct work *work)
{
    struct refocus_stack *const s = work->stack;

    rf_pool_run(s->pool, load_row, work, s->rows);
    sum_up(s, work->wide, work->wide);
    rf_pool_run(s->pool, means_row, work, s->rows);
    sum_up(s, work->narrow, work->wide);
    rf_pool_run(s->pool, match_row, work, s->rows);
    sum_up(s, work->narrow, NULL);
    rf_pool_run(s->pool, errors_row, work, s->rows);
}

void rf_stack_blur_errors(struct refocus_stack *s)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    const double narrowest = s->frame[0].position, widest = s->frame[s->count - 1].position;
    struct work work = {.stack = s, .parts = 3 * (s->count - 1)};

    /* Costs come when errors are known: till then light has their memory, errors that of sums. */
    work.narrow = (uint16_t *)(void *)s->cost;
    work.wide = work.narrow + samples;
    work.mean = work.wide + samples;
    s->error = (uint16_t *)s->sum;
    rf_transfer_init(s->transfer, REFOCUS_BLEND_LINEAR);
    make_codes(s);
    memset(s->error, 0, RADII * samples * sizeof *s->error);
    for (work.frame = 1; work.frame < s->count; work.frame++) {
        const double a = s->frame[work.frame].position;

        work.part =
            sqrt((a * a - narrowest * narrowest) / (widest * widest - narrowest * narrowest));
        for (work.channel = 0; work.channel < 3; work.channel++)
            add_errors(&work);
    }
    for (int n = 0; n < RADII; n++)
        s->plane[n] = s->error + (size_t)n * samples;
    s->planes = RADII;
}
