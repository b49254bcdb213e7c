/* gain_make.c: the gain map of a picture that was refocused in light beyond white. Each pixel has
 * its own gain, as clipping ends from one pixel to the next. If one of picture and light is
 * larger, a sample is the gain between their means in its block, as gain_apply.c takes it apart
 * again. */
#include "gain_make.h"

#include <math.h>
#include <stdlib.h>

#include "half.h"
#include "tone.h"

enum {
    UNITS = 1 << 16, /* values are multiples of 1 / UNITS, which XMP and ISO 21496-1 both hold */
};

/* Light by which nothing is divided where the picture is black. */
static const double offset = 1.0 / 64;

/* Pictures, and the samples of the map between them. */
struct work {
    const struct rf_rows *base;
    const struct refocus_image *light;
    int width, height;
    double (*sums)[2][3]; /* a row of blocks: picture, and light */
    int (*counts)[2];
    int y[2]; /* rows of them that have been summed up */
    float of_code[256];
};

/* Bytes of a pixel of light; 0: it is of another format. */
static int bytes_of(const struct refocus_image *light)
{
    return light->format == REFOCUS_FORMAT_RGB_HALF    ? 6
           : light->format == REFOCUS_FORMAT_RGB_FLOAT ? 12
                                                       : 0;
}

bool rf_gain_can_make(const struct rf_rows *base, const struct refocus_image *light)
{
    return base->format == REFOCUS_FORMAT_RGB8 && bytes_of(light) > 0 && light->plane[0] &&
           light->width >= 1 && light->width <= REFOCUS_MAX_SIDE && light->height >= 1 &&
           light->height <= REFOCUS_MAX_SIDE &&
           rf_good_rows(light->stride[0], bytes_of(light) * (int64_t)light->width, light->height);
}

/* The block of a pixel, as gain_apply.c counts them. */
static int block_at(int at, int size, int blocks)
{
    return (int)((at + 0.5) * blocks / size);
}

static void add_base(struct work *work, int y)
{
    const uint8_t *const codes = work->base->top + y * work->base->stride;

    for (int x = 0; x < work->base->width; x++) {
        const int block = block_at(x, work->base->width, work->width);

        for (int c = 0; c < 3; c++)
            work->sums[block][0][c] += (double)work->of_code[codes[3 * x + c]];
        work->counts[block][0]++;
    }
}

static void add_light(struct work *work, int y)
{
    const uint8_t *const row = work->light->plane[0] + y * work->light->stride[0];
    const bool halves = work->light->format == REFOCUS_FORMAT_RGB_HALF;

    for (int x = 0; x < work->light->width; x++) {
        const int block = block_at(x, work->light->width, work->width);
        uint16_t half[3];
        float light[3];

        memcpy(light, row + (ptrdiff_t)x * (int)sizeof light, halves ? 0 : sizeof light);
        memcpy(half, row + (ptrdiff_t)x * (int)sizeof half, sizeof half);
        for (int c = 0; c < 3 && halves; c++)
            light[c] = half[c] <= RF_HALF_MOST ? rf_half_value(half[c]) : 0;
        /* negative light, and no number at all, are none */
        for (int c = 0; c < 3; c++)
            work->sums[block][1][c] += light[c] > 0 ? fmin((double)light[c], 65504) : 0;
        work->counts[block][1]++;
    }
}

/* Sum up the next row of blocks; from row 0 on they follow each other. */
static void sum(struct work *work, int row)
{
    if (row == 0)
        work->y[0] = work->y[1] = 0;
    memset(work->sums, 0, (size_t)work->width * sizeof *work->sums);
    memset(work->counts, 0, (size_t)work->width * sizeof *work->counts);
    while (work->y[0] < work->base->height &&
           block_at(work->y[0], work->base->height, work->height) == row)
        add_base(work, work->y[0]++);
    while (work->y[1] < work->light->height &&
           block_at(work->y[1], work->light->height, work->height) == row)
        add_light(work, work->y[1]++);
}

static double gain_at(const struct work *work, int x, int c)
{
    const double base = work->sums[x][0][c] / work->counts[x][0];
    const double light = work->sums[x][1][c] / work->counts[x][1];
    /* In single precision, which is faster and enough: a sample has eight bits. */
    const double gain = (double)log2f((float)((light + offset) / (base + offset)));

    return fmin(fmax(gain, -RF_GAIN_MOST_STOPS), RF_GAIN_MOST_STOPS);
}

static void find_range(struct work *work, double *least, double *greatest)
{
    *least = RF_GAIN_MOST_STOPS;
    *greatest = -RF_GAIN_MOST_STOPS;
    for (int y = 0; y < work->height; y++) {
        sum(work, y);
        for (int x = 0; x < work->width; x++) {
            for (int c = 0; c < 3; c++) {
                *least = fmin(*least, gain_at(work, x, c));
                *greatest = fmax(*greatest, gain_at(work, x, c));
            }
        }
    }
    *least = floor(*least * UNITS) / UNITS;
    *greatest = ceil(*greatest * UNITS) / UNITS;
}

static void fill(struct work *work, double least, double greatest, uint8_t *samples)
{
    const double scale = greatest > least ? 255 / (greatest - least) : 0;

    for (int y = 0; y < work->height; y++) {
        sum(work, y);
        for (int x = 0; x < work->width; x++)
            for (int c = 0; c < 3; c++)
                *samples++ = (uint8_t)((gain_at(work, x, c) - least) * scale + 0.5);
    }
}

static int smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Set the values of a map whose gains go evenly from one to another. */
static void set_values(struct rf_gain_values *values, double least, double greatest,
                       double base_offset, double other_offset, double headroom)
{
    for (int c = 0; c < 3; c++) {
        values->least[c] = least;
        values->greatest[c] = greatest;
        values->gamma[c] = 1;
        values->base_offset[c] = base_offset;
        values->other_offset[c] = other_offset;
    }
    values->other_headroom = floor(fmax(fmax(greatest, headroom), 0) * UNITS) / UNITS;
}

/* Whether one range and one pair of offsets hold for all channels. */
static bool is_of_one_range(const struct rf_gain_map *map)
{
    const struct rf_gain_values *const v = &map->values;
    bool is = true;

    for (int c = 1; c < 3; c++) {
        is = is && v->base_offset[c] == v->base_offset[0] &&
             v->other_offset[c] == v->other_offset[0] &&
             (map->samples.channels > 1 ||
              memcmp(map->gain[c], map->gain[0], sizeof map->gain[0]) == 0);
    }
    return is;
}

int rf_gain_copy(struct rf_gain_map *copy, const struct rf_gain_map *map)
{
    const struct rf_gain_values *const old = &map->values;
    const size_t count = rf_raster_stride(&map->samples) * (size_t)map->samples.height;
    float least = map->gain[0][0], greatest = least;
    float scale;

    memset(copy, 0, sizeof *copy);
    if (!is_of_one_range(map))
        return REFOCUS_ERR_UNSUPPORTED;
    copy->samples = map->samples;
    copy->samples.pixels = malloc(count);
    if (!copy->samples.pixels)
        return REFOCUS_ERR_MEMORY;
    for (int i = 0; i < 3 * 256; i++) {
        least = fminf(least, map->gain[i / 256][i % 256]);
        greatest = fmaxf(greatest, map->gain[i / 256][i % 256]);
    }
    set_values(&copy->values, floor((double)least * UNITS) / UNITS,
               ceil((double)greatest * UNITS) / UNITS, old->base_offset[0], old->other_offset[0],
               old->other_headroom);
    scale = greatest > least ? 255 / (greatest - least) : 0;
    for (size_t i = 0; i < count; i++) {
        const int c = (int)(i % (size_t)map->samples.channels);

        copy->samples.pixels[i] =
            (uint8_t)((map->gain[c][map->samples.pixels[i]] - least) * scale + 0.5f);
    }
    return REFOCUS_OK;
}

int rf_gain_make(struct rf_gain_map *map, const struct rf_rows *base,
                 const struct refocus_image *light, double headroom)
{
    struct work work = {.base = base,
                        .light = light,
                        .width = smaller(base->width, light->width),
                        .height = smaller(base->height, light->height)};
    int status = REFOCUS_ERR_MEMORY;

    memset(map, 0, sizeof *map);
    work.sums = malloc((size_t)work.width * sizeof *work.sums);
    work.counts = malloc((size_t)work.width * sizeof *work.counts);
    map->samples.pixels = malloc(3 * (size_t)work.width * (size_t)work.height);
    if (work.sums && work.counts && map->samples.pixels) {
        double least, greatest;

        for (int i = 0; i < 256; i++)
            work.of_code[i] = rf_tone_light(i);
        find_range(&work, &least, &greatest);
        fill(&work, least, greatest, map->samples.pixels);
        map->samples.width = work.width;
        map->samples.height = work.height;
        map->samples.channels = 3;
        map->samples.sample = REFOCUS_SAMPLE_U8;
        map->samples.max_value = 255;
        set_values(&map->values, least, greatest, offset, offset, headroom);
        status = REFOCUS_OK;
    } else {
        rf_raster_free(&map->samples);
    }
    free(work.sums);
    free(work.counts);
    return status;
}
