/* layout.c: where everything in a renderer's block of memory lies. */
#include "renderer/layout.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#include "depth/upsample.h"
#include "methods/frame.h"
#include "support/arena.h"
#include "tiles/ranges.h"

/* Pixels that may be read beyond the picture: the largest offset, one for the pre-filter,
 * one for rounding. */
int rf_padding_for(float max_blur_radius)
{
    return (int)ceilf(max_blur_radius) + 2;
}

ptrdiff_t rf_pitch_for(int width, int pad)
{
    const int tiles = (width + RF_TILE - 1) / RF_TILE;
    const ptrdiff_t pitch = ((ptrdiff_t)tiles * RF_TILE + 2 * pad + 31) & ~(ptrdiff_t)31;

    return pitch % 512 ? pitch : pitch + 32; /* rows a page apart would share cache sets */
}

int rf_threads_for(const struct refocus_renderer_params *params)
{
    long n = params->threads;

    if (n == 0)
        n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > RF_MAX_THREADS ? RF_MAX_THREADS : (int)n;
}

static void take_level(struct rf_arena *arena, struct rf_level *level, int width, int height)
{
    const uint64_t pixels = (uint64_t)(width + 1) * height;

    for (int c = 0; c < 3; c++)
        level->light[c] = rf_arena_take(arena, pixels, 2);
    level->blur = rf_arena_take(arena, pixels, 2);
}

/* A group of padded planes: row y of plane i is at group + y * stride + i * pitch, so that
 * what is read together lies together. Returns pixel (0, 0) of plane 0. */
static uint16_t *take_group(struct rf_arena *arena, const struct refocus_renderer *r,
                            uint64_t rows)
{
    uint16_t *group = rf_arena_take(arena, (uint64_t)r->stride * rows, 2);

    return group ? group + r->pad * (r->stride + 1) : NULL;
}

static uint16_t *plane_of(uint16_t *group, const struct refocus_renderer *r, int i)
{
    return group ? group + i * r->pitch : NULL;
}

/* The pyramid of a picture of this size, for sizes alone or with memory. */
int rf_pyramid(struct rf_level level[RF_LEVELS], int width, int height)
{
    int levels = 0;

    while (width > 1 || height > 1) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        level[levels].width = width;
        level[levels].height = height;
        level[levels].stride = (width + 1) & ~1;
        levels++;
    }
    return levels;
}

/* Bytes for the greediest of the methods that work on whole frames. */
static uint64_t work_bytes(const struct refocus_renderer_params *params)
{
    static const struct {
        uint32_t method;
        rf_work_fn_size *size;
    } needs[] = {{REFOCUS_METHOD_LIGHTFIELD, rf_lightfield_work},
                 {REFOCUS_METHOD_SCATTER, rf_scatter_work},
                 {REFOCUS_METHOD_FOVEATED, rf_foveated_work},
                 {REFOCUS_METHOD_INTERPOLATED, rf_interpolated_work},
                 {REFOCUS_METHOD_DIFFUSION, rf_diffusion_work}};
    const struct rf_limits limits = {
        params->max_width, params->max_height, rf_padding_for(params->max_blur_radius),
        rf_threads_for(params), params->max_blur_radius};
    uint64_t most = 0;

    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        const uint64_t bytes = params->methods & REFOCUS_METHOD_BIT(needs[i].method)
                                   ? needs[i].size(&limits)
                                   : 0;

        most = bytes > most ? bytes : most;
    }
    return most;
}

/* Sets the pointers of r, or with arena->base == NULL only counts. */
static void lay_out(struct refocus_renderer *r, const struct refocus_renderer_params *params,
                    struct rf_arena *arena)
{
    const int w = params->max_width, h = params->max_height;
    const int pad = rf_padding_for(params->max_blur_radius);
    const uint64_t rows = (uint64_t)h + 2 * pad + RF_TILE;
    uint16_t *photo, *seen, *behind;
    const uint64_t tiles = (uint64_t)((w + RF_TILE - 1) / RF_TILE) *
                           (uint64_t)((h + RF_TILE - 1) / RF_TILE);
    struct rf_level level[RF_LEVELS];
    const int levels = rf_pyramid(level, w, h);
    const int threads = rf_threads_for(params);
    uint64_t before, after;

    r->pad = pad;
    r->pitch = rf_pitch_for(w, pad);
    r->stride = RF_GROUP * r->pitch;
    photo = take_group(arena, r, rows);
    seen = take_group(arena, r, rows);
    behind = take_group(arena, r, rows);
    for (int c = 0; c < 3; c++) {
        r->front.light[c] = plane_of(photo, r, c);
        r->smooth[c] = plane_of(seen, r, 1 + c);
        r->behind.light[c] = plane_of(behind, r, 1 + c);
    }
    r->disparity = plane_of(photo, r, 3);
    r->front.blur = (int16_t *)seen;
    r->behind.blur = (int16_t *)behind;
    r->alpha = rf_arena_take(arena, (uint64_t)w * h, 1);
    before = arena->used;
    for (int i = 0; i < levels; i++) {
        take_level(arena, &level[i], level[i].width, level[i].height);
        r->level[i] = level[i];
    }
    after = arena->used;
    arena->used = before; /* the pyramid is done with before there are weights */
    r->weight_stride = r->pitch;
    r->weight = rf_arena_take(arena, (uint64_t)r->pitch * rows, 2);
    r->weight = r->weight ? r->weight + pad * (r->pitch + 1) : NULL;
    arena->used = arena->used > after ? arena->used : after;
    for (int i = 0; i < rf_lamp_parts(h); i++) {
        r->highlights[i].lamp =
            rf_arena_take(arena, rf_lamp_capacity(w), sizeof(struct rf_highlight));
        r->highlights[i].capacity = rf_lamp_capacity(w);
    }
    r->rim = rf_arena_take(arena, rf_rim_capacity(w, h), sizeof *r->rim);
    r->range_stride = rf_range_width(w, pad);
    r->range = rf_arena_take(arena, (uint64_t)r->range_stride * rf_range_width(h, pad),
                             sizeof *r->range);
    if (r->range)
        r->range += rf_range_border(pad) * (r->range_stride + 1);
    r->bins = rf_arena_take(arena, tiles, sizeof *r->bins);
    r->rays = rf_arena_take(arena, RF_FULL_RAYS, sizeof *r->rays);
    r->scratch = rf_arena_take(arena, (uint64_t)threads * rf_scratch_size(w), 2);
    r->taps = rf_arena_take(arena, (uint64_t)w + h, sizeof *r->taps);
    r->near_by = rf_arena_take(arena, RF_TAPS * ((uint64_t)w + RF_BATCH_SPARE), 2);
    r->column = rf_arena_take(arena, (uint64_t)w + 4, sizeof *r->column);
    r->light_weight = rf_arena_take(arena, RF_LIGHT_MAX + 1, 2);
    r->work = rf_arena_take(arena, work_bytes(params), 1);
}

uint64_t rf_layout_size(const struct refocus_renderer_params *params)
{
    struct refocus_renderer counted;
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN}; /* blocks may begin anywhere */

    rf_arena_take(&arena, 1, sizeof counted);
    lay_out(&counted, params, &arena);
    return arena.used;
}

struct refocus_renderer *rf_layout_place(const struct refocus_renderer_params *params,
                                         void *block)
{
    const uintptr_t at = (uintptr_t)block;
    struct rf_arena arena = {(uint8_t *)block + (-at & (RF_ARENA_ALIGN - 1)), 0};
    struct refocus_renderer *r = rf_arena_take(&arena, 1, sizeof *r);

    memset(r, 0, sizeof *r);
    lay_out(r, params, &arena);
    return r;
}
