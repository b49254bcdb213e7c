/* temporal.c: steadies the disparities of a video from frame to frame. */
#include <refocus/temporal.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depth/temporal.h"
#include "image/format.h"
#include "image/read.h"
#include "support/arena.h"

enum {
    ALIKE = 12, /* codes of the guide that are the same thing in two frames */
    STILL = 6,  /* codes of the guide up to which nothing has moved */
    MOST_COUNT = 255,
};

struct refocus_temporal {
    int width, height;
    uint32_t strength; /* Q8 */
    int noise;         /* disparities */
    bool begun, guided;
    struct rf_frame now, last; /* last.disparity is filtered */
    uint16_t *before;          /* the last map as it came */
    uint16_t *filtered;
    uint8_t *count, *counted; /* frames that each sample has been seen in */
    struct rf_motion *motion;
    void *block;
};

static bool good(const struct refocus_temporal_params *p)
{
    return p->width >= 1 && p->width <= REFOCUS_MAX_SIDE && p->height >= 1 &&
           p->height <= REFOCUS_MAX_SIDE && p->strength >= 0 && p->strength <= 0.95f &&
           p->noise >= 0 && p->noise <= 0.25f;
}

static void lay_out(struct refocus_temporal *f, struct rf_arena *arena)
{
    const uint64_t samples = (uint64_t)f->width * (uint64_t)f->height;
    const uint64_t blocks = (uint64_t)((f->width + RF_BLOCK - 1) / RF_BLOCK) *
                            (uint64_t)((f->height + RF_BLOCK - 1) / RF_BLOCK);

    f->now.disparity = rf_arena_take(arena, samples, 2);
    f->last.disparity = rf_arena_take(arena, samples, 2);
    f->before = rf_arena_take(arena, samples, 2);
    f->filtered = rf_arena_take(arena, samples, 2);
    f->now.guide = rf_arena_take(arena, samples, 1);
    f->last.guide = rf_arena_take(arena, samples, 1);
    f->count = rf_arena_take(arena, samples, 1);
    f->counted = rf_arena_take(arena, samples, 1);
    f->motion = rf_arena_take(arena, blocks, sizeof *f->motion);
}

int refocus_temporal_create(struct refocus_temporal **filter,
                            const struct refocus_temporal_params *params)
{
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct refocus_temporal_params own;
    struct refocus_temporal *f;
    int status;

    if (!filter)
        return REFOCUS_ERR_ARGUMENT;
    *filter = NULL;
    status = refocus_struct_read(&own, sizeof own,
                                 REFOCUS_SIZE_TO(struct refocus_temporal_params, noise), params);
    if (status)
        return status;
    params = &own;
    if (!good(params))
        return REFOCUS_ERR_ARGUMENT;
    f = calloc(1, sizeof *f);
    if (!f)
        return REFOCUS_ERR_MEMORY;
    f->width = params->width;
    f->height = params->height;
    f->strength = (uint32_t)lrintf(params->strength * 256);
    f->noise = (int)lrintf(params->noise * 65535);
    lay_out(f, &arena);
    f->block = arena.used <= PTRDIFF_MAX ? malloc((size_t)arena.used) : NULL;
    if (!f->block) {
        free(f);
        return REFOCUS_ERR_MEMORY;
    }
    rf_arena_begin(&arena, f->block);
    lay_out(f, &arena);
    refocus_temporal_reset(f);
    *filter = f;
    return REFOCUS_OK;
}

void refocus_temporal_destroy(struct refocus_temporal **filter)
{
    if (!filter || !*filter)
        return;
    free((*filter)->block);
    free(*filter);
    *filter = NULL;
}

void refocus_temporal_reset(struct refocus_temporal *f)
{
    size_t blocks;

    if (!f)
        return;
    blocks = (size_t)((f->width + RF_BLOCK - 1) / RF_BLOCK) *
             (size_t)((f->height + RF_BLOCK - 1) / RF_BLOCK);
    f->begun = false;
    memset(f->motion, 0, blocks * sizeof *f->motion);
}

static uint16_t rescale(uint16_t d, double scale, double offset)
{
    const double value = scale * d + offset * 65535 + 0.5;

    return (uint16_t)(value > 0 ? value < 65535 ? value : 65535 : 0);
}

int refocus_temporal_rescale(struct refocus_temporal *f, double scale, double offset)
{
    size_t samples;

    if (!f || !(scale > 0) || !isfinite(scale) || !isfinite(offset))
        return REFOCUS_ERR_ARGUMENT;
    samples = f->begun ? (size_t)f->width * (size_t)f->height : 0;
    for (size_t i = 0; i < samples; i++) {
        f->last.disparity[i] = rescale(f->last.disparity[i], scale, offset);
        f->before[i] = rescale(f->before[i], scale, offset);
        if (!f->guided) /* then depth is its own guide */
            f->last.guide[i] = (uint8_t)(f->before[i] >> 8);
    }
    return REFOCUS_OK;
}

static int place(int i, int samples, int size)
{
    return (int)((2 * (int64_t)i + 1) * size / (2 * (int64_t)samples));
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Bytes from one brightness in plane 0 to the next: of Y, or of a pixel of R, G and B. */
static int step_of(uint32_t format)
{
    if (!refocus_format_is_yuv(format))
        return refocus_format_bytes(format);
    return format == REFOCUS_FORMAT_YUYV ? 2 : 1;
}

/* Brightness of the photo around a sample, Y or (c0 + 2 c1 + c2) / 4: of 3 x 3 pixels a third of
 * a sample apart, which calms noise and does not alias. */
static uint8_t guide_at(const struct refocus_image *photo, int x, int y, int dx, int dy)
{
    const bool luma = refocus_format_is_yuv(photo->format);
    const ptrdiff_t step = step_of(photo->format);
    int sum = 0;

    for (int j = -1; j <= 1; j++) {
        const uint8_t *row =
            photo->plane[0] + clamp(y + j * dy, photo->height - 1) * photo->stride[0];

        for (int i = -1; i <= 1; i++) {
            const uint8_t *p = row + clamp(x + i * dx, photo->width - 1) * step;

            sum += luma ? 4 * p[0] : p[0] + 2 * p[1] + p[2];
        }
    }
    return (uint8_t)(sum / 36);
}

static void load(struct refocus_temporal *f, const struct refocus_image *photo,
                 const struct refocus_disparity *map)
{
    const int dx = photo ? photo->width / (3 * f->width) : 0;
    const int dy = photo ? photo->height / (3 * f->height) : 0;

    for (int y = 0; y < f->height; y++) {
        const uint8_t *in = (const uint8_t *)map->samples + y * map->stride;
        const size_t row = (size_t)y * (size_t)f->width;

        for (int x = 0; x < f->width; x++) {
            const uint16_t d =
                (uint16_t)(map->bits == 16 ? ((const uint16_t *)in)[x] : in[x] * 257);

            f->now.disparity[row + (size_t)x] = d;
            f->now.guide[row + (size_t)x] =
                photo ? guide_at(photo, place(x, f->width, photo->width),
                                 place(y, f->height, photo->height), dx ? dx : 1, dy ? dy : 1)
                      : (uint8_t)(d >> 8);
        }
    }
}

/* Filters one sample as refocus_temporal_run() says. q is where it was. */
static void filter(struct refocus_temporal *f, size_t i, size_t q)
{
    const int d = f->now.disparity[i], p = f->last.disparity[q], apart = abs(d - p);
    const int changed = abs(f->now.guide[i] - f->last.guide[q]);
    const int n = f->count[q];
    const int64_t square = (int64_t)f->noise * f->noise;
    uint32_t keep;

    f->filtered[i] = (uint16_t)d;
    f->counted[i] = 1;
    if (f->guided && changed > ALIKE)
        return;
    if (apart >= f->noise) {
        /* The photo does not explain the jump: it is not believed before it is seen twice. */
        if (f->guided && f->strength > 0 && changed <= STILL && abs(d - f->before[q]) >= f->noise) {
            f->filtered[i] = (uint16_t)p;
            f->counted[i] = (uint8_t)n;
        }
        return;
    }
    keep = (uint32_t)(256 * n / (n + 1));
    keep = keep < f->strength ? keep : f->strength;
    f->filtered[i] = (uint16_t)(d + (int64_t)keep * (square - (int64_t)apart * apart) * (p - d) /
                                        (256 * square));
    f->counted[i] = (uint8_t)(n < MOST_COUNT ? n + 1 : n);
}

static void filter_all(struct refocus_temporal *f)
{
    const int columns = (f->width + RF_BLOCK - 1) / RF_BLOCK;

    rf_find_motion(f->motion, &f->now, &f->last, f->width, f->height);
    for (int y = 0; y < f->height; y++) {
        const struct rf_motion *motion = f->motion + (size_t)(y / RF_BLOCK) * (size_t)columns;

        for (int x = 0; x < f->width; x++) {
            const struct rf_motion v = motion[x / RF_BLOCK];
            const size_t from = (size_t)clamp(y + v.y, f->height - 1) * (size_t)f->width +
                                (size_t)clamp(x + v.x, f->width - 1);

            filter(f, (size_t)y * (size_t)f->width + (size_t)x, from);
        }
    }
}

static void swap16(uint16_t **a, uint16_t **b)
{
    uint16_t *const t = *a;

    *a = *b;
    *b = t;
}

static void swap8(uint8_t **a, uint8_t **b)
{
    uint8_t *const t = *a;

    *a = *b;
    *b = t;
}

int refocus_temporal_run(struct refocus_temporal *f, const struct refocus_image *photo,
                         const struct refocus_disparity *map, uint16_t *out, ptrdiff_t stride)
{
    struct refocus_image own_photo;
    struct refocus_disparity own_map;
    size_t samples;
    int status;

    if (!f)
        return REFOCUS_ERR_ARGUMENT;
    if ((photo && (status = rf_read_image(NULL, "photo", &own_photo, photo))) ||
        (status = rf_read_map(NULL, "map", &own_map, map)))
        return status;
    photo = photo ? &own_photo : NULL;
    map = &own_map;
    if (map->width != f->width || map->height != f->height || !out || ((uintptr_t)out & 1) ||
        (stride & 1) || !rf_good_stride(stride, 2 * (ptrdiff_t)f->width, f->height))
        return REFOCUS_ERR_ARGUMENT;
    samples = (size_t)f->width * (size_t)f->height;
    if (f->guided != (photo != NULL))
        f->begun = false; /* another guide: nothing to compare with */
    f->guided = photo != NULL;
    load(f, photo, map);
    if (f->begun) {
        filter_all(f);
    } else {
        memcpy(f->filtered, f->now.disparity, samples * sizeof *f->filtered);
        memset(f->counted, 1, samples);
    }
    f->begun = true;
    for (int y = 0; y < f->height; y++)
        memcpy((char *)out + y * stride, f->filtered + (size_t)y * (size_t)f->width,
               (size_t)f->width * sizeof *out);
    swap16(&f->before, &f->now.disparity);
    swap16(&f->last.disparity, &f->filtered);
    swap8(&f->last.guide, &f->now.guide);
    swap8(&f->count, &f->counted);
    return REFOCUS_OK;
}
