/* depth_edges.c: puts the edges of a caller's disparity map where the photo has them, with memory
 * and threads of its own. */
#include <refocus/depth_edges.h>

#include <stdlib.h>
#include <string.h>

#include <refocus/render.h>

#include "colour/guide.h"
#include "depth/upsample.h"
#include "edges/place.h"
#include "image/format.h"
#include "image/read.h"
#include "image/disparity_map.h"
#include "support/arena.h"

/* A photo of Y, U and V, and the same in RGB8. */
struct guide {
    const struct refocus_image *photo;
    struct rf_yuv_curve *curve;
    struct refocus_image rgb;
};

static struct rf_yuv_row row_of(const struct refocus_image *photo, int y)
{
    const int down = rf_chroma_down(photo->format);
    const uint8_t *row[3] = {photo->plane[0] + y * photo->stride[0]};

    for (int i = 1; i < refocus_format_planes(photo->format); i++)
        row[i] = photo->plane[i] + (y >> down) * photo->stride[i];
    switch (photo->format) {
    case REFOCUS_FORMAT_NV12:
        return (struct rf_yuv_row){row[0], row[1], row[1] + 1, 1, 2};
    case REFOCUS_FORMAT_NV21:
        return (struct rf_yuv_row){row[0], row[1] + 1, row[1], 1, 2};
    case REFOCUS_FORMAT_I420:
        return (struct rf_yuv_row){row[0], row[1], row[2], 1, 1};
    default:
        return (struct rf_yuv_row){row[0], row[0] + 1, row[0] + 3, 2, 4};
    }
}

static void convert_row(void *context, int y, int worker)
{
    const struct guide *guide = context;
    const struct rf_yuv_row row = row_of(guide->photo, y);

    (void)worker;
    rf_guide_row(guide->curve, guide->rgb.plane[0] + y * guide->rgb.stride[0], &row,
                 guide->rgb.width);
}

static void convert(struct guide *guide, struct rf_pool *pool)
{
    rf_yuv_curve_init(guide->curve, guide->photo->matrix, guide->photo->range,
                      REFOCUS_BLEND_LINEAR);
    rf_pool_run(pool, convert_row, guide, guide->rgb.height);
}

/* Sets the pointers, or with arena->base == NULL only counts. */
static void lay_out(struct rf_place_edges *place, struct guide *guide, int threads,
                    struct rf_arena *arena)
{
    const struct refocus_image *photo = guide->photo;
    const int32_t width = photo->width, height = photo->height;

    place->memory = rf_arena_take(
        arena, rf_place_edges_bytes(width, height, place->map->width, place->map->height), 1);
    place->shares.size = rf_upsample_share();
    place->shares.at = rf_arena_take(arena, (uint64_t)threads, place->shares.size);
    if (!refocus_format_is_yuv(photo->format))
        return;
    guide->curve = rf_arena_take(arena, 1, sizeof *guide->curve);
    guide->rgb = refocus_image_packed(REFOCUS_FORMAT_RGB8,
                                      rf_arena_take(arena, (uint64_t)width * (uint64_t)height, 3),
                                      width, height, 3 * (ptrdiff_t)width);
    place->photo = &guide->rgb;
}

static int run(struct rf_place_edges *place, int threads, struct refocus_depth_edges_report *report)
{
    struct guide guide = {.photo = place->photo};
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN};
    struct rf_run run_state = {.looked_at = NULL};
    struct rf_pool pool;
    void *block;
    int status;

    lay_out(place, &guide, threads, &arena);
    if (arena.used > PTRDIFF_MAX)
        return REFOCUS_ERR_SIZE;
    block = malloc((size_t)arena.used);
    if (!block)
        return REFOCUS_ERR_MEMORY;
    rf_arena_begin(&arena, block);
    lay_out(place, &guide, threads, &arena);
    atomic_init(&run_state.state, RF_RUN_RUNNING);
    status = rf_pool_start(&pool, threads, NULL, &run_state);
    if (status == REFOCUS_OK) {
        place->pool = &pool;
        if (guide.curve)
            convert(&guide, &pool);
        if (!rf_place_edges(place, report))
            rf_copy_map(place->map, place->out.at, 2 * place->out.stride);
        rf_pool_end(&pool);
    }
    free(block);
    return status;
}

int refocus_depth_edges(const struct refocus_image *photo, const struct refocus_disparity *map,
                        const struct refocus_depth_edges_params *given, uint16_t *out,
                        ptrdiff_t stride, struct refocus_depth_edges_report *report)
{
    const size_t first = REFOCUS_SIZE_TO(struct refocus_depth_edges_report, changed);
    struct refocus_depth_edges_report found = refocus_depth_edges_report_default();
    struct refocus_depth_edges_params params;
    struct refocus_image own_photo;
    struct refocus_disparity own_map;
    struct rf_kernels kernels;
    struct rf_place_edges place = {
        .kernels = &kernels, .photo = &own_photo, .map = &own_map, .out = {out, stride / 2}};
    int status;

    if ((status = rf_read_image(NULL, "photo", &own_photo, photo)) ||
        (status = rf_read_map(NULL, "map", &own_map, map)) ||
        (status = refocus_struct_read(&params, sizeof params,
                                      REFOCUS_SIZE_TO(struct refocus_depth_edges_params, reserved),
                                      given)))
        return status;
    if (params.threads < 0 || params.threads > RF_MAX_THREADS || !refocus_cpu_name(params.cpu) ||
        params.reserved || !out || ((uintptr_t)out & 1) || (stride & 1) ||
        !rf_good_stride(stride, 2 * (ptrdiff_t)own_photo.width, own_photo.height) ||
        (report && (report->struct_size < first || report->struct_size > REFOCUS_MAX_STRUCT_SIZE)))
        return REFOCUS_ERR_ARGUMENT;
    if (!rf_kernels_select(&kernels, &params.cpu))
        return REFOCUS_ERR_UNSUPPORTED;
    status = run(&place, rf_thread_count(params.threads), &found);
    if (status == REFOCUS_OK && report)
        refocus_struct_write(report, first, &found, sizeof found);
    return status;
}
