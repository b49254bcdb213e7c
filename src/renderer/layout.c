/* layout.c: lays out everything that a renderer holds in one block of memory. */
#include "renderer/layout.h"

#include <math.h>
#include <string.h>

#include "depth/upsample.h"
#include "edges/place.h"
#include "highlights/estimate.h"
#include "highlights/known.h"
#include "renderer/methods.h"
#include "support/arena.h"
#include "tiles/ranges.h"

/* The pixels beyond the picture that may be read: the largest offset, one for the pre-filter, and
 * one for rounding. */
static int padding_for(float max_blur_radius)
{
    return (int)ceilf(max_blur_radius) + 2;
}

/* Elements between the planes of a group. */
static ptrdiff_t pitch_for(int width, int pad)
{
    const int tiles = (width + RF_TILE - 1) / RF_TILE;
    const ptrdiff_t pitch = ((ptrdiff_t)tiles * RF_TILE + 2 * pad + 31) / 32;

    /* With an odd number of cache lines, rows and planes spread over all cache sets. */
    return 32 * (pitch | 1);
}

static void lay_out_level(struct rf_arena *arena, struct rf_level *level)
{
    const uint64_t pixels = (uint64_t)(level->width + 1) * (uint64_t)level->height;

    for (int c = 0; c < 3; c++)
        level->light.channel[c] = rf_arena_take(arena, pixels, 2);
    level->blur.at = rf_arena_take(arena, pixels, 2);
}

/* The number of elements of a group of padded planes. Row y of plane i is at group + y * stride + i
 * * pitch, so that rows that are read together lie together. */
static uint64_t group_size(const struct rf_photo *photo, int height)
{
    return (uint64_t)photo->stride * ((uint64_t)height + 2 * (uint64_t)photo->pad + RF_TILE);
}

/* Lays out the lists of a photo of at most this size: silhouettes, highlights, blends of bands. */
static void lay_out_lists(struct rf_arena *arena, struct rf_photo *photo, int width, int height,
                          bool known)
{
    rf_lay_out_silhouettes(&photo->silhouettes, arena, width, height);
    rf_lay_out_highlights(&photo->highlights, arena, width, height, known);
    photo->band_blend = rf_arena_take(arena, (uint64_t)(height + RF_TILE - 1) / RF_TILE, 1);
}

/* The bytes that refocus_prepare_scene() works in. */
static uint64_t prepare_bytes(const struct refocus_renderer_params *params)
{
    const int w = params->max_width, h = params->max_height;
    const struct refocus_image photo = {.width = w, .height = h};
    static const uint8_t sure = 255;
    struct rf_upsampler up = {.photo = &photo, .confidence = &sure, .columns = w, .rows = h};
    const uint64_t pixels = (uint64_t)w * (uint64_t)h;
    struct rf_arena arena = {NULL, 0}, guide = {NULL, 0};
    uint64_t edges;

    rf_arena_take(&guide, pixels, 3); /* the guide of deep photos and of those of Y, U and V */
    rf_upsampler_lay_out(&up, &arena);
    if (!params->depth_edges)
        return arena.used + guide.used;
    edges = rf_place_edges_bytes(w, h, w + 1, h + 1);
    if (arena.used < edges)
        arena.used = edges;
    rf_arena_take(&arena, pixels, 2); /* a map before its edges are placed */
    return arena.used + guide.used;
}

/* Lays out the frame that the edges of the next one are compared with. */
static void lay_out_last_edges(struct rf_arena *arena, struct rf_last_edges *last,
                               const struct refocus_renderer_params *params)
{
    const uint64_t pixels = (uint64_t)params->max_width * (uint64_t)params->max_height;

    if (params->depth_edges != REFOCUS_DEPTH_EDGES_STEADY)
        return;
    last->result = rf_arena_take(arena, pixels, 2);
    last->map = rf_arena_take(arena, pixels, 1);
    last->photo = rf_arena_take(arena, pixels, 1);
}

/* Lays out the photo, and the planes that depend on the lens setting. These share their memory with
 * the work of preparing a scene, whose end in the arena is returned. */
static uint64_t lay_out_whole(struct refocus_renderer *r,
                              const struct refocus_renderer_params *params, struct rf_arena *arena)
{
    struct rf_photo *photo = &r->photo;
    const int w = params->max_width, h = params->max_height;
    struct rf_arena prepare, estimate;
    uint64_t size;

    photo->pad = padding_for(params->max_blur_radius);
    photo->pitch = pitch_for(w, photo->pad);
    photo->stride = RF_GROUP * photo->pitch;
    size = group_size(photo, h);
    photo->group = rf_arena_take(arena, size, 2);
    photo->alpha = rf_arena_take(arena, (uint64_t)w * (uint64_t)h, 1);
    if (photo->group) {
        uint16_t *first = photo->group + photo->pad * (photo->stride + 1);

        for (int c = 0; c < 3; c++)
            photo->light[c] = first + c * photo->pitch;
        photo->disparity = first + 3 * photo->pitch;
    }
    lay_out_lists(arena, photo, w, h, params->deep);
    lay_out_last_edges(arena, &r->last_edges, params);
    r->last_light.light = rf_arena_take(arena, rf_steady_cells(w, h), sizeof(float));
    if (params->deep) {
        r->deep.curve = rf_arena_take(arena, 1, sizeof *r->deep.curve);
        r->deep_out.curve = rf_arena_take(arena, 1, sizeof *r->deep_out.curve);
        rf_lay_out_known(&photo->highlights, arena, w, h);
    }
    prepare = *arena;
    r->prepare_memory = rf_arena_take(&prepare, prepare_bytes(params), 1);
    estimate = *arena;
    r->highlights_memory = rf_arena_take(&estimate, rf_estimate_bytes(w, h), 1);
    if (prepare.used < estimate.used)
        prepare.used = estimate.used;
    r->smooth_group = rf_arena_take(arena, size, 2);
    r->background_group = rf_arena_take(arena, size, 2);
    return prepare.used;
}

static int up_to_tiles(int v)
{
    return (v + RF_TILE - 1) / RF_TILE * RF_TILE;
}

/*
 * Chooses the sides and margins of blocks. The mark of a pixel depends on pixels 2 K + 1 away. An
 * inpainted pixel depends, by way of levels below RF_KEPT, on known pixels 12 away, whose light
 * depends on up to 127 more (rf_prefilter_most_steps()); blur, where there are highlights, depends
 * on 5 more. Where blurs have a unit, the slabs of a tile depend on blocks of tiles that begin K +
 * 1 away.
 */
static void shape_blocks(struct rf_in_place *in_place, float max_blur_radius)
{
    enum { MARK_BLOCK = 128 };
    const int pad = padding_for(max_blur_radius);
    const int filtered = (1 << rf_prefilter_most_steps(max_blur_radius)) - 1;

    in_place->mark_block = MARK_BLOCK;
    in_place->mark_margin = up_to_tiles(2 * pad + 9);
    in_place->margin = up_to_tiles(pad + 21 + filtered);
    if (in_place->mark_margin < in_place->margin)
        in_place->mark_margin = in_place->margin;
    in_place->block = MARK_BLOCK + 2 * (in_place->mark_margin - in_place->margin);
}

/* Lays out a map of the whole photo whose edges are placed, and the memory of that. It ends with
 * the preparation, and all that comes after the map shares it: its end in the arena is returned. */
static uint64_t lay_out_placed(struct refocus_renderer *r,
                               const struct refocus_renderer_params *params, struct rf_arena *arena)
{
    const int w = params->max_width, h = params->max_height;
    struct rf_arena prepare;

    if (!params->depth_edges)
        return 0;
    r->in_place.placed = rf_arena_take(arena, (uint64_t)w * (uint64_t)h, 2);
    lay_out_last_edges(arena, &r->last_edges, params);
    prepare = *arena;
    r->prepare_memory = rf_arena_take(&prepare, rf_place_edges_bytes(w, h, w, h), 1);
    return prepare.used;
}

/* Lays out the planes of the window of a block, and the marks and levels that are stored for the
 * whole photo. Returns where the memory of lay_out_placed() ends. */
static uint64_t lay_out_blocks(struct refocus_renderer *r,
                               const struct refocus_renderer_params *params, struct rf_arena *arena)
{
    const int w = params->max_width, h = params->max_height;
    struct rf_in_place *in_place = &r->in_place;
    struct rf_photo *photo = &r->photo;
    const uint64_t prepared = lay_out_placed(r, params, arena);
    struct rf_arena estimate = *arena;
    uint64_t size;
    int side;

    if (params->highlights) {
        r->last_light.light = rf_arena_take(arena, rf_steady_cells(w, h), sizeof(float));
        estimate = *arena;
        r->highlights_memory = rf_arena_take(&estimate, rf_estimate_bytes(w, h), 1);
    }
    shape_blocks(in_place, params->max_blur_radius);
    photo->pad = padding_for(params->max_blur_radius);
    side = rf_block_side(in_place);
    photo->pitch = pitch_for(side + RF_TILE, 0);
    photo->stride = RF_GROUP * photo->pitch;
    size = (uint64_t)photo->stride * (uint64_t)(side + RF_TILE + 2 * RF_SPARE_ROWS);
    photo->group = rf_arena_take(arena, size, 2);
    r->smooth_group = rf_arena_take(arena, size, 2);
    r->background_group = rf_arena_take(arena, size, 2);
    photo->alpha = rf_arena_take(arena, (uint64_t)side * (uint64_t)side, 1);
    arena->used = arena->used > estimate.used ? arena->used : estimate.used;
    lay_out_lists(arena, photo, w, h, false);
    in_place->known.stride = (w + 7) / 8;
    in_place->known.bits = rf_arena_take(arena, (uint64_t)in_place->known.stride * (uint64_t)h, 1);
    rf_pyramid_shape(&in_place->kept, w, h);
    for (int i = RF_KEPT; i <= in_place->kept.levels; i++)
        lay_out_level(arena, &in_place->kept.level[i]);
    return prepared;
}

/* The most bytes that any of the methods of whole frames needs. */
static uint64_t work_bytes(const struct refocus_renderer_params *params)
{
    const struct rf_limits limits = {
        params->max_width, params->max_height, padding_for(params->max_blur_radius),
        rf_thread_count(params->threads), fminf(params->max_blur_radius, RF_PLAIN_RADIUS)};
    uint64_t most = 0;

    for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++) {
        const struct rf_method *method = rf_method_of(params->papers, i);
        uint64_t bytes;

        if (!(params->methods & REFOCUS_METHOD_BIT(i)) || !method || !method->work_bytes)
            continue;
        bytes = method->work_bytes(&limits);
        most = bytes > most ? bytes : most;
    }
    return most;
}

static int block_side(const struct refocus_renderer_params *params)
{
    struct rf_in_place in_place;

    shape_blocks(&in_place, params->max_blur_radius);
    return rf_block_side(&in_place);
}

/* The number of rays of the largest full mask, or of all sets of N rays, whichever is more. */
static uint64_t few_rays(const struct refocus_renderer_params *params)
{
    const float largest = fminf(params->max_blur_radius, RF_PLAIN_RADIUS);
    const uint64_t side = 2 * (uint64_t)ceilf(largest) + 1;
    const uint64_t sets = 7680; /* for both sides of the focus, and with coordinates apart */

    return side * side > sets ? side * side : sets;
}

/* The share of each worker: what the pass needs that needs the most. */
static uint64_t share_bytes(void)
{
    const uint64_t bytes[] = {rf_sweep_share(), rf_sweep_yuv_share(), rf_search_share(),
                              rf_splat_share(), rf_upsample_share(),  rf_prefilter_share(),
                              RF_THIN_SHARE};
    uint64_t most = 0;

    for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++)
        most = bytes[i] > most ? bytes[i] : most;
    return (most + RF_ARENA_ALIGN - 1) & ~(uint64_t)(RF_ARENA_ALIGN - 1);
}

/* Lays out tables that are too large for the stack, where a renderer lies while it is counted. */
static void lay_out_tables(struct rf_arena *arena, struct refocus_renderer *r)
{
    r->yuv = rf_arena_take(arena, 1, sizeof *r->yuv);
    r->transfer = rf_arena_take(arena, RF_BLEND_COUNT, sizeof *r->transfer);
    r->cat_eye = rf_arena_take(arena, 1, sizeof *r->cat_eye);
    r->cat_shape = rf_arena_take(arena, 1, sizeof *r->cat_shape);
    r->frame = rf_arena_take(arena, 1, sizeof *r->frame);
    r->exact = rf_arena_take(arena, 1, sizeof *r->exact);
}

/* The blocks of tiles of the largest window. */
static uint64_t blocks_of(int across, int down)
{
    return (uint64_t)rf_blocks_across((across + RF_TILE - 1) / RF_TILE) *
           (uint64_t)rf_blocks_across((down + RF_TILE - 1) / RF_TILE);
}

/* Tiles of the largest window. */
static uint64_t tiles_of(int across, int down)
{
    return (uint64_t)((across + RF_TILE - 1) / RF_TILE) *
           (uint64_t)((down + RF_TILE - 1) / RF_TILE);
}

/* Lays out what shares the memory of the pyramid. Returns where the largest of it ends. */
static uint64_t lay_out_pyramid(struct refocus_renderer *r, const struct rf_arena *arena,
                                int across, int down, int pad)
{
    struct rf_arena pyramid = *arena, foreground = *arena, sources = *arena;
    uint64_t most;

    rf_pyramid_shape(&r->pyramid, across, down);
    for (int i = 1; i <= r->pyramid.levels; i++)
        lay_out_level(&pyramid, &r->pyramid.level[i]);
    /* The pyramid is no longer needed when weights begin: this holds the foreground cells, and then
     * the weights. */
    r->foreground.stride = pitch_for(across, pad);
    r->foreground.most = rf_arena_take(
        &foreground, (uint64_t)r->foreground.stride * (uint64_t)(down + 2 * pad + RF_TILE), 2);
    if (r->foreground.most)
        r->foreground.most += pad * (r->foreground.stride + 1);
    if (r->has_thin) /* the pyramid begins after the sources are drawn */
        r->coverage.source = rf_arena_take(&sources, RF_COVERAGE_SOURCES * tiles_of(across, down),
                                           rf_coverage_source_bytes());
    most = pyramid.used > foreground.used ? pyramid.used : foreground.used;
    return most > sources.used ? most : sources.used;
}

/* Lays out what is known of each tile of the largest window. */
static void lay_out_tiles(struct refocus_renderer *r, const struct refocus_renderer_params *params,
                          struct rf_arena *arena, int across, int down, int pad)
{
    r->range.stride = rf_range_width(across, pad);
    r->range.at =
        rf_arena_take(arena, (uint64_t)r->range.stride * (uint64_t)rf_range_width(down, pad),
                      sizeof *r->range.at);
    if (r->range.at)
        r->range.at += rf_range_border(pad) * (r->range.stride + 1);
    r->stars.star = rf_arena_take(arena, RF_MOST_STARS, sizeof *r->stars.star);
    r->grain = rf_arena_take(arena, 1, sizeof *r->grain);
    r->bins = rf_arena_take(arena, tiles_of(across, down), sizeof *r->bins);
    if (rf_unit_of(params->max_blur_radius))
        r->blocks = rf_arena_take(arena, blocks_of(across, down), sizeof *r->blocks);
}

/* Sets the pointers of r; with arena->base == NULL it only counts the bytes. */
static void lay_out(struct refocus_renderer *r, const struct refocus_renderer_params *params,
                    struct rf_arena *arena)
{
    const int side = params->in_place ? block_side(params) : INT32_MAX;
    const int w = params->max_width, h = params->max_height;
    /* The size of the largest window. */
    const int across = w < side ? w : side, down = h < side ? h : side;
    const int threads = rf_thread_count(params->threads),
              pad = padding_for(params->max_blur_radius);
    uint64_t after, prepared = 0;

    r->most_edges = params->depth_edges;
    if (params->in_place)
        prepared = lay_out_blocks(r, params, arena);
    else
        prepared = lay_out_whole(r, params, arena);
    r->has_thin = params->thin && !params->in_place;
    after = lay_out_pyramid(r, arena, across, down, pad);
    arena->used = prepared > after ? prepared : after;
    if (r->has_thin) {
        rf_lay_out_coverage(&r->coverage, arena, w, h);
        rf_lay_out_thin(&r->photo.thin, arena, w, h);
    }
    if (params->textured && !params->in_place)
        r->texture = rf_arena_take(arena, (uint64_t)threads, rf_texture_scratch_bytes());
    r->has_behind = params->behind && !params->in_place;
    if (r->has_behind)
        rf_lay_out_behind(&r->photo.behind, arena, w, h);
    lay_out_tiles(r, params, arena, across, down, pad);
    r->ray_sets.memory = rf_arena_take(arena, params->in_place ? few_rays(params) : RF_FULL_RAYS,
                                       sizeof *r->ray_sets.memory);
    r->exec.scratch =
        rf_arena_take(arena, (uint64_t)threads * rf_scratch_size(w, params->max_blur_radius), 2);
    r->exec.shares.size = share_bytes();
    r->exec.shares.at = rf_arena_take(arena, (uint64_t)threads, r->exec.shares.size);
    r->light_weight = rf_arena_take(arena, RF_LIGHT_MAX + 1, 2);
    lay_out_tables(arena, r);
    if (params->in_place)
        return;
    r->work.at = rf_arena_take(arena, work_bytes(params), 1);
}

uint64_t rf_layout_size(const struct refocus_renderer_params *params)
{
    struct refocus_renderer counted;
    struct rf_arena arena = {NULL, RF_ARENA_ALIGN}; /* a block may begin anywhere */

    rf_arena_take(&arena, 1, sizeof counted);
    lay_out(&counted, params, &arena);
    return arena.used;
}

struct refocus_renderer *rf_layout_place(const struct refocus_renderer_params *params, void *block)
{
    struct rf_arena arena;
    struct refocus_renderer *r;

    rf_arena_begin(&arena, block);
    r = rf_arena_take(&arena, 1, sizeof *r);
    memset(r, 0, sizeof *r);
    lay_out(r, params, &arena);
    memset(r->yuv, 0, sizeof *r->yuv);
    memset(r->cat_eye, 0, sizeof *r->cat_eye);
    memset(r->cat_shape, 0, sizeof *r->cat_shape);
    return r;
}
