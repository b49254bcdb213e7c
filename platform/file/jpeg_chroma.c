/* jpeg_chroma.c: colour that a JPEG stores at half of its size is brought to the size of luma. */
#include "jpeg_chroma.h"

#include <string.h>

enum {
    VARIANCE = 64 << 12, /* in the units of variances below, Q4 and 256 of them */
    SLOPE_ONE = 1 << 10,
    TOGETHER = 64, /* samples whose pixels are made together: loops of one kind fill vectors */
};

/* Sums over three rows, weights 1 2 1, with a column more on either side. */
struct columns {
    int32_t *y, *yy, *c[2], *yc[2];
};

/* Rows between two of samples, 4 times them. */
struct between {
    int32_t *y, *c[2], *slope[2];
};

struct chroma {
    int width, height, columns, rows;
    float error; /* squared, of means in Q8: what is no larger may be quantisation */
    const uint8_t *luma, *in[2];
    uint16_t *means;    /* luma over 2 x 2 pixels, Q2 */
    int16_t *slope[2];  /* Q10: below 8, as chroma deviates by 128 and 128 s / (s^2 + 64) is */
    int16_t *colour[2]; /* Q4: what is interpolated */
    struct columns column;
    struct between between;
    int32_t *sum[2], *late[2]; /* Q8, and Q4 of the row before */
};

enum { PLANES = 5, ROWS = 6 + 5 + 4 };

uint64_t rf_jpeg_chroma_bytes(int32_t width, int32_t height)
{
    const uint64_t columns = ((uint64_t)width + 1) / 2, rows = ((uint64_t)height + 1) / 2;

    return (columns + 2) * ROWS * sizeof(int32_t) + columns * rows * PLANES * sizeof(uint16_t);
}

static void lay_out(struct chroma *s, void *work)
{
    const size_t n = (size_t)s->columns + 2, samples = (size_t)s->columns * (size_t)s->rows;
    int32_t *at = work;
    int32_t **row[ROWS] = {&s->column.y,         &s->column.yy,        &s->column.c[0],
                           &s->column.c[1],      &s->column.yc[0],     &s->column.yc[1],
                           &s->between.y,        &s->between.c[0],     &s->between.c[1],
                           &s->between.slope[0], &s->between.slope[1], &s->sum[0],
                           &s->sum[1],           &s->late[0],          &s->late[1]};

    for (int i = 0; i < ROWS; i++, at += n)
        *row[i] = at;
    s->means = (uint16_t *)at;
    s->slope[0] = (int16_t *)(s->means + samples);
    s->slope[1] = s->slope[0] + samples;
    s->colour[0] = s->slope[1] + samples;
    s->colour[1] = s->colour[0] + samples;
}

static size_t row_at(const struct chroma *s, int row)
{
    const int last = s->rows - 1;

    return (size_t)(row < 0 ? 0 : row > last ? last : row) * (size_t)s->columns;
}

/* Sums of luma over 2 x 2 pixels; the last ones of odd sides count twice. */
static void reduce(const struct chroma *s)
{
    for (int j = 0; j < s->rows; j++) {
        const uint8_t *restrict up = s->luma + (size_t)(2 * j) * (size_t)(2 * s->columns);
        const uint8_t *restrict down = 2 * j + 1 < s->height ? up + 2 * s->columns : up;
        uint16_t *restrict out = s->means + row_at(s, j);
        const int pairs = s->width / 2;

        for (int i = 0; i < pairs; i++)
            out[i] = (uint16_t)(up[2 * i] + up[2 * i + 1] + down[2 * i] + down[2 * i + 1]);
        if (pairs < s->columns)
            out[pairs] = (uint16_t)(2 * (up[2 * pairs] + down[2 * pairs]));
    }
}

static void pad(int32_t *row, int n)
{
    row[0] = row[1];
    row[n + 1] = row[n];
}

static void add_rows(const struct chroma *s, int j)
{
    const int n = s->columns;
    int32_t *restrict y = s->column.y, *restrict yy = s->column.yy;

    memset(y, 0, ((size_t)n + 2) * 6 * sizeof *y); /* all of struct columns */
    for (int v = -1; v <= 1; v++) {
        const uint16_t *restrict means = s->means + row_at(s, j + v);
        const int weight = v ? 1 : 2;

        for (int i = 0; i < n; i++) {
            y[i + 1] += weight * means[i];
            yy[i + 1] += weight * means[i] * means[i];
        }
        for (int k = 0; k < 2; k++) {
            const uint8_t *restrict in = s->in[k] + row_at(s, j + v);
            int32_t *restrict c = s->column.c[k], *restrict yc = s->column.yc[k];

            for (int i = 0; i < n; i++) {
                c[i + 1] += weight * (in[i] - 128);
                yc[i + 1] += weight * means[i] * (in[i] - 128);
            }
        }
    }
    pad(y, n);
    pad(yy, n);
    for (int k = 0; k < 2; k++) {
        pad(s->column.c[k], n);
        pad(s->column.yc[k], n);
    }
}

static inline int32_t three(const int32_t *p)
{
    return p[-1] + 2 * p[0] + p[1];
}

/* Slopes of a row of samples. The largest sum is 16 x 16 x 1020^2 < 2^28. */
static void slopes(const struct chroma *s, int j)
{
    add_rows(s, j);
    for (int k = 0; k < 2; k++) {
        const int32_t *restrict y = s->column.y + 1, *restrict yy = s->column.yy + 1;
        const int32_t *restrict c = s->column.c[k] + 1, *restrict yc = s->column.yc[k] + 1;
        int16_t *restrict out = s->slope[k] + row_at(s, j);

        for (int i = 0; i < s->columns; i++) {
            const int32_t mean = three(y + i);
            const int32_t variance = 16 * three(yy + i) - mean * mean;
            const int32_t both = 16 * three(yc + i) - mean * three(c + i);

            /* Covariances are of Q2 and variances of Q4. */
            out[i] = (int16_t)((float)both * (4.0F * SLOPE_ONE) / (float)(variance + VARIANCE));
        }
    }
}

/* Sets what a row of pixels is of: 3 of the nearer row of samples and 1 of the other. */
static void blend_rows(const struct chroma *s, int row)
{
    const size_t p = row_at(s, row / 2), q = row_at(s, row & 1 ? row / 2 + 1 : row / 2 - 1);
    const int n = s->columns;
    int32_t *restrict y = s->between.y;

    for (int i = 0; i < n; i++)
        y[i + 1] = 3 * s->means[p + (size_t)i] + s->means[q + (size_t)i];
    pad(y, n);
    for (int k = 0; k < 2; k++) {
        const int16_t *restrict in = s->colour[k];
        const int16_t *restrict slope = s->slope[k];
        int32_t *restrict c = s->between.c[k], *restrict a = s->between.slope[k];

        for (int i = 0; i < n; i++) {
            c[i + 1] = 3 * in[p + (size_t)i] + in[q + (size_t)i];
            a[i + 1] = 3 * slope[p + (size_t)i] + slope[q + (size_t)i];
        }
        pad(c, n);
        pad(a, n);
    }
}

/* Chroma in Q6 of the pixels of `n` samples from `first` on, where `in` has their luma: 9 3 3 1 of
 * the samples around, and the slope times how far the luma is above the mean that is read alike.
 * The slope is Q10 once its sixteenth is taken, below 2^13, and `over`, Q6, below 2^14. */
static void set_chroma(const struct between *b, int k, const uint8_t *restrict in, int first, int n,
                       int16_t *restrict out)
{
    const int32_t *restrict y = b->y + first + 1; /* samples are one later in padded rows */
    const int32_t *restrict c = b->c[k] + first + 1, *restrict slope = b->slope[k] + first + 1;

    for (int i = 0; i < n; i++)
        for (int side = 0; side < 2; side++) {
            const int far = side ? i + 1 : i - 1;
            const int over = 64 * in[2 * i + side] - (3 * y[i] + y[far]);
            const int value = 3 * c[i] + c[far], a = (3 * slope[i] + slope[far]) >> 4;
            const int q6 = (value * 256 + a * over + 512) >> 10;

            out[2 * i + side] = (int16_t)(q6 < -8192 ? -8192 : q6 > 8191 ? 8191 : q6);
        }
}

/* Adds up the chroma of the pixels of a row of samples, Q8 means. */
static void add_pixels(const struct chroma *s, int j)
{
    int16_t chroma[2 * TOGETHER];

    for (int k = 0; k < 2; k++)
        memset(s->sum[k], 0, (size_t)s->columns * sizeof *s->sum[k]);
    for (int row = 2 * j; row < 2 * j + 2; row++) {
        const uint8_t *luma = s->luma + (size_t)row * (size_t)(2 * s->columns);

        blend_rows(s, row);
        for (int first = 0; first < s->columns; first += TOGETHER) {
            const int n = s->columns - first < TOGETHER ? s->columns - first : TOGETHER;

            for (int k = 0; k < 2; k++) {
                int32_t *restrict sum = s->sum[k] + first;

                set_chroma(&s->between, k, luma + 2 * (ptrdiff_t)first, first, n, chroma);
                for (int i = 0; i < n; i++)
                    sum[i] += chroma[2 * i] + chroma[2 * i + 1];
            }
        }
    }
}

/* Gives samples what the pixels between them miss of the means that the file has. A row changes
 * once the next has been looked at. */
static void correct(const struct chroma *s)
{
    for (int k = 0; k < 2; k++) {
        const uint8_t *restrict in = s->in[k];
        int16_t *restrict out = s->colour[k];

        for (size_t i = 0; i < (size_t)s->columns * (size_t)s->rows; i++)
            out[i] = (int16_t)(16 * (in[i] - 128));
        memset(s->late[k], 0, (size_t)s->columns * sizeof *s->late[k]);
    }
    for (int j = 0; j <= s->rows; j++) {
        if (j < s->rows)
            add_pixels(s, j);
        for (int k = 0; k < 2; k++) {
            const uint8_t *restrict in = s->in[k] + row_at(s, j);
            int16_t *restrict before = s->colour[k] + row_at(s, j - 1);
            const int32_t *restrict sum = s->sum[k];
            int32_t *restrict late = s->late[k];
            const float error = s->error;

            for (int i = 0; i < s->columns; i++) {
                const float missing = (float)(256 * (in[i] - 128) - sum[i]);
                const float square = missing * missing;

                before[i] = (int16_t)(before[i] + late[i]);
                late[i] = (int32_t)(missing * square / (square + error) * 0.0625F);
            }
        }
    }
}

static inline uint32_t code_of(int v)
{
    return (uint32_t)(v < 0 ? 0 : v > 255 ? 255 : v);
}

/* The equations of JFIF, Q16; chroma is Q6, so that products are below 2^30. R, G and B are the
 * first three bytes of each. */
static void set_colours(const uint8_t *restrict luma, const int16_t *restrict cb,
                        const int16_t *restrict cr, int n, uint32_t *restrict out)
{
    const int half = 1 << 21;

    for (int x = 0; x < n; x++) {
        const int y = luma[x];
        const uint32_t r = code_of(y + ((91881 * cr[x] + half) >> 22));
        const uint32_t g = code_of(y - ((22554 * cb[x] + 46802 * cr[x] + half) >> 22));
        const uint32_t b = code_of(y + ((116130 * cb[x] + half) >> 22));

        out[x] = r | g << 8 | b << 16;
    }
}

static void write_row(const struct chroma *s, const uint8_t *in, uint8_t *out)
{
    int16_t chroma[2][2 * TOGETHER];
    uint32_t colour[2 * TOGETHER];

    for (int first = 0; first < s->columns; first += TOGETHER) {
        const int columns = s->columns - first < TOGETHER ? s->columns - first : TOGETHER;
        const int left = s->width - 2 * first, n = left < 2 * columns ? left : 2 * columns;
        const uint8_t *luma = in + 2 * (ptrdiff_t)first;

        for (int k = 0; k < 2; k++)
            set_chroma(&s->between, k, luma, first, columns, chroma[k]);
        set_colours(luma, chroma[0], chroma[1], n, colour);
        for (int x = 0; x < n; x++, out += 3) {
            out[0] = (uint8_t)colour[x];
            out[1] = (uint8_t)(colour[x] >> 8);
            out[2] = (uint8_t)(colour[x] >> 16);
        }
    }
}

void rf_jpeg_chroma(struct rf_raster *raster, const struct rf_jpeg_planes *planes, void *work)
{
    const int w = raster->width, h = raster->height;
    const float error = 2 * 256.0F * (float)planes->step;
    struct chroma s = {.width = w,
                       .height = h,
                       .error = error * error,
                       .columns = (w + 1) / 2,
                       .rows = (h + 1) / 2,
                       .luma = planes->y,
                       .in = {planes->chroma[0], planes->chroma[1]}};

    lay_out(&s, work);
    reduce(&s);
    for (int j = 0; j < s.rows; j++)
        slopes(&s, j);
    correct(&s);
    for (int y = 0; y < h; y++) {
        blend_rows(&s, y);
        write_row(&s, planes->y + (size_t)y * (size_t)(2 * s.columns),
                  raster->pixels + (size_t)y * rf_raster_stride(raster));
    }
}
