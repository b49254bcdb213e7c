/* snap_edges.c: moves the edges of a disparity map to those of the photo. */
#include <refocus/depth.h>
#include <refocus/render.h>

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "image/format.h"
#include "image/read.h"
#include "support/pool.h"

enum {
    STEP = 65535 / 24, /* an edge */
    SAME = 65535 / 12, /* samples of one surface differ by no more */
    UNSURE = 16,       /* confidence beside an edge: says nothing of colours, and little else */
};

struct snap {
    const struct refocus_disparity *map;
    int width, height, reach;
    int columns, rows;      /* the coarse map has a sample for every reach x reach pixels */
    uint16_t *least, *most; /* disparities up to `reach` away from each pixel */
    uint16_t *coarse;
    uint8_t *confidence;
};

static uint16_t at(const struct snap *s, int x, int y)
{
    const uint8_t *row = (const uint8_t *)s->map->samples + y * s->map->stride;

    return (uint16_t)(s->map->bits == 16 ? ((const uint16_t *)row)[x] : row[x] * 257);
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

static uint16_t lesser(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

static uint16_t greater(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

/* Least and greatest within reach, along the row and then down the columns. */
static void find_ranges(const struct snap *s)
{
    const size_t w = (size_t)s->width;

    for (int y = 0; y < s->height; y++) {
        uint16_t *least = s->least + (size_t)y * w, *most = s->most + (size_t)y * w;

        for (int x = 0; x < s->width; x++) {
            least[x] = most[x] = at(s, x, y);
            for (int i = clamp(x - s->reach, x); i <= clamp(x + s->reach, s->width - 1); i++) {
                least[x] = lesser(least[x], at(s, i, y));
                most[x] = greater(most[x], at(s, i, y));
            }
        }
    }
}

static bool is_beside_edge(const struct snap *s, int x, int y)
{
    const int from = clamp(y - s->reach, y), to = clamp(y + s->reach, s->height - 1);
    uint16_t least = 65535, most = 0;

    for (int j = from; j <= to; j++) {
        const size_t i = (size_t)j * (size_t)s->width + (size_t)x;

        least = lesser(least, s->least[i]);
        most = greater(most, s->most[i]);
    }
    return most - least > STEP;
}

static int place(int i, int samples, int size)
{
    return (int)((2 * (int64_t)i + 1) * size / (2 * (int64_t)samples));
}

static void make_coarse(const struct snap *s)
{
    for (int j = 0; j < s->rows; j++)
        for (int i = 0; i < s->columns; i++) {
            const int x = place(i, s->columns, s->width), y = place(j, s->rows, s->height);
            const size_t to = (size_t)j * (size_t)s->columns + (size_t)i;

            s->coarse[to] = at(s, x, y);
            s->confidence[to] = is_beside_edge(s, x, y) ? UNSURE : 255;
        }
}

/* Whether the surface of a pixel is wide enough to be seen away from its edges. */
static bool is_wide(const struct snap *s, int x, int y)
{
    const int i = (int)((int64_t)x * s->columns / s->width);
    const int j = (int)((int64_t)y * s->rows / s->height), d = at(s, x, y);

    for (int v = clamp(j - 2, j); v <= clamp(j + 2, s->rows - 1); v++)
        for (int u = clamp(i - 2, i); u <= clamp(i + 2, s->columns - 1); u++) {
            const size_t k = (size_t)v * (size_t)s->columns + (size_t)u;

            if (s->confidence[k] == 255 && abs(s->coarse[k] - d) <= SAME)
                return true;
        }
    return false;
}

static void put_back(const struct snap *s, uint16_t *out, ptrdiff_t stride)
{
    for (int y = 0; y < s->height; y++) {
        uint16_t *row = (uint16_t *)((char *)out + y * stride);

        for (int x = 0; x < s->width; x++)
            if (!is_beside_edge(s, x, y) || !is_wide(s, x, y))
                row[x] = at(s, x, y);
    }
}

int refocus_depth_snap(const struct refocus_image *photo, const struct refocus_disparity *given,
                       const struct refocus_snap_params *given_params, uint16_t *out,
                       ptrdiff_t stride)
{
    struct refocus_upsample_params upsample = refocus_upsample_params_default();
    struct refocus_image own_photo;
    struct refocus_disparity own_map;
    struct refocus_snap_params own_params;
    const struct refocus_disparity *const map = &own_map;
    const struct refocus_snap_params *const params = &own_params;
    struct snap s = {.map = map};
    uint64_t pixels, samples;
    int status;

    if ((status = rf_read_image(NULL, "photo", &own_photo, photo)) ||
        (status = rf_read_map(NULL, "map", &own_map, given)) ||
        (status =
             refocus_struct_read(&own_params, sizeof own_params,
                                 REFOCUS_SIZE_TO(struct refocus_snap_params, cpu), given_params)))
        return status;
    photo = &own_photo;
    status = REFOCUS_ERR_MEMORY;
    if (!refocus_format_bytes(photo->format) || params->reach < 1 ||
        params->reach > REFOCUS_MAX_SNAP || params->threads < 0 ||
        params->threads > RF_MAX_THREADS || !refocus_cpu_name(params->cpu) ||
        map->width != photo->width || map->height != photo->height || !out ||
        ((uintptr_t)out & 1) || (stride & 1) ||
        !rf_good_stride(stride, 2 * (ptrdiff_t)photo->width, photo->height))
        return REFOCUS_ERR_ARGUMENT;
    s.width = map->width;
    s.height = map->height;
    s.reach = params->reach;
    s.columns = (s.width + s.reach - 1) / s.reach;
    s.rows = (s.height + s.reach - 1) / s.reach;
    pixels = (uint64_t)s.width * (uint64_t)s.height;
    samples = (uint64_t)s.columns * (uint64_t)s.rows;
    if (pixels > SIZE_MAX / 4)
        return REFOCUS_ERR_SIZE;
    s.least = malloc((size_t)pixels * 2);
    s.most = malloc((size_t)pixels * 2);
    s.coarse = malloc((size_t)samples * 2);
    s.confidence = malloc((size_t)samples);
    if (s.least && s.most && s.coarse && s.confidence) {
        const struct refocus_disparity coarse =
            refocus_disparity16(s.coarse, s.columns, s.rows, 2 * (ptrdiff_t)s.columns);

        find_ranges(&s);
        make_coarse(&s);
        upsample.threads = params->threads;
        upsample.cpu = params->cpu;
        upsample.confidence = s.confidence;
        upsample.confidence_stride = s.columns;
        status = refocus_upsample(photo, &coarse, &upsample, out, stride);
        if (status == REFOCUS_OK)
            put_back(&s, out, stride);
    }
    free(s.confidence);
    free(s.coarse);
    free(s.most);
    free(s.least);
    return status;
}
