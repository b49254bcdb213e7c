/* upsample_standalone.c: upsamples a map for a caller, with memory and threads of its own. */
#include <refocus/depth.h>

#include <stdlib.h>

#include "depth/upsample.h"
#include "image/format.h"
#include "image/read.h"
#include "image/disparity_map.h"

static bool good_params(const struct refocus_upsample_params *params,
                        const struct refocus_disparity *map)
{
    return params->threads >= 0 && params->reserved == 0 && params->threads <= RF_MAX_THREADS &&
           refocus_cpu_name(params->cpu) &&
           (!params->confidence ||
            rf_good_stride(params->confidence_stride, map->width, map->height));
}

/* Lays out all that upsampling needs. */
static void lay_out(struct rf_upsampler *up, int threads, struct rf_arena *arena)
{
    rf_upsampler_lay_out(up, arena);
    up->shares.size = rf_upsample_share();
    up->shares.at = rf_arena_take(arena, (uint64_t)threads, up->shares.size);
}

int refocus_upsample(const struct refocus_image *photo, const struct refocus_disparity *map,
                     const struct refocus_upsample_params *given, uint16_t *out, ptrdiff_t stride)
{
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct rf_kernels kernels;
    struct rf_pool pool;
    struct rf_run run = {.looked_at = NULL};
    uint32_t cpu;
    struct refocus_image own_photo;
    struct refocus_disparity own_map;
    struct refocus_upsample_params own_params;
    const struct refocus_upsample_params *const params = &own_params;
    int status, threads;
    void *block;

    if ((status = rf_read_image(NULL, "photo", &own_photo, photo)) ||
        (status = rf_read_map(NULL, "map", &own_map, map)) ||
        (status = refocus_struct_read(
             &own_params, sizeof own_params,
             REFOCUS_SIZE_TO(struct refocus_upsample_params, confidence_stride), given)))
        return status;
    photo = &own_photo;
    map = &own_map;
    if (!refocus_format_bytes(photo->format) || !good_params(params, map) || !out ||
        ((uintptr_t)out & 1) || (stride & 1) ||
        !rf_good_stride(stride, 2 * (ptrdiff_t)photo->width, photo->height))
        return REFOCUS_ERR_ARGUMENT;
    cpu = params->cpu;
    if (!rf_kernels_select(&kernels, &cpu))
        return REFOCUS_ERR_UNSUPPORTED;
    if (map->width == photo->width && map->height == photo->height) {
        rf_copy_map(map, out, stride);
        return REFOCUS_OK;
    }
    threads = rf_thread_count(params->threads);
    struct rf_upsampler up = {
        .kernels = &kernels,
        .photo = photo,
        .map = map,
        .confidence = params->confidence,
        .confidence_stride = params->confidence_stride,
        .columns = rf_upsample_samples(map->width, photo->width),
        .rows = rf_upsample_samples(map->height, photo->height),
        .in_strips = true,
        .out = {out, stride / 2},
    };
    lay_out(&up, threads, &arena);
    if (arena.used > PTRDIFF_MAX)
        return REFOCUS_ERR_SIZE;
    block = malloc((size_t)arena.used);
    if (!block)
        return REFOCUS_ERR_MEMORY;
    rf_arena_begin(&arena, block);
    lay_out(&up, threads, &arena);
    atomic_init(&run.state, RF_RUN_RUNNING);
    status = rf_pool_start(&pool, threads, NULL, &run);
    if (status == REFOCUS_OK) {
        rf_upsample(&up, &pool);
        rf_pool_end(&pool);
    }
    free(block);
    return status;
}
