/* strips.c: strip mode, which renders a photo block by block. The photo stays in the caller's
 * memory; the planes hold one block with a margin at a time, and the passes work on that window.
 *
 * The hidden background is inpainted with colours from all over the photo. So there are two
 * runs through the photo. The first stores the marks of all pixels, and the levels of the
 * pyramid from RF_KEPT on, which are then inpainted. The second renders: it computes the levels
 * below RF_KEPT again for each block. Nothing is approximated: the bytes are the same as without
 * strips.
 *
 * Edges of the map are placed before, if the scene asks for that: how soft the map is and how it
 * lies on the photo is known from all of it. The result is a map of the renderer's own, and the
 * memory to work in is what marks, levels and planes of a block lie in later.
 */
#include <string.h>

#include "background/inpaint.h"
#include "background/mark.h"
#include "depth/dequantise.h"
#include "image/format.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "renderer/layout.h"
#include "renderer/load.h"
#include "renderer/passes.h"

/* Block number i, row by row, of those of side `block` that cover the photo. */
static struct rf_rect block_of(const struct refocus_renderer *r, int block, int i)
{
    const struct rf_rect all = rf_whole(r);
    const int across = (all.x1 + block - 1) / block;
    const int x = i % across * block, y = i / across * block;

    return (struct rf_rect){x, y, x + block < all.x1 ? x + block : all.x1,
                            y + block < all.y1 ? y + block : all.y1};
}

static int blocks(const struct refocus_renderer *r, int block)
{
    const struct rf_rect all = rf_whole(r);

    return (all.x1 + block - 1) / block * ((all.y1 + block - 1) / block);
}

/* A block with its margin, cut off at the sides of the photo. */
static struct rf_rect around(const struct refocus_renderer *r, struct rf_rect block, int margin)
{
    const struct rf_rect all = rf_whole(r);

    return (struct rf_rect){block.x0 > margin ? block.x0 - margin : 0,
                            block.y0 > margin ? block.y0 - margin : 0,
                            block.x1 + margin < all.x1 ? block.x1 + margin : all.x1,
                            block.y1 + margin < all.y1 ? block.y1 + margin : all.y1};
}

/* A part of a picture, as a picture of its own. */
static struct refocus_image image_part(const struct refocus_image *image, struct rf_rect part)
{
    struct refocus_image out = *image;

    out.width = part.x1 - part.x0;
    out.height = part.y1 - part.y0;
    out.plane[0] +=
        part.y0 * image->stride[0] + (ptrdiff_t)part.x0 * refocus_format_bytes(image->format);
    return out;
}

static struct refocus_disparity map_part(const struct refocus_disparity *map, struct rf_rect part)
{
    struct refocus_disparity out = *map;

    out.samples = (const uint8_t *)map->samples + part.y0 * map->stride +
                  (ptrdiff_t)part.x0 * (map->bits / 8);
    out.width = part.x1 - part.x0;
    out.height = part.y1 - part.y0;
    return out;
}

/* Makes a block of the caller's photo and its margin the window. */
static void load(struct refocus_renderer *r, struct rf_rect block, int margin)
{
    const struct rf_rect window = around(r, block, margin);
    const struct rf_rect mapped =
        around(r, window, r->in_place.code_step ? RF_DEQUANTISE_REACH : 0);
    const struct refocus_image photo = image_part(&r->in_place.photo, window);
    const struct refocus_disparity map = map_part(&r->in_place.map, mapped);

    r->in_place.beyond =
        (struct rf_rect){margin - (block.x0 - window.x0), margin - (block.y0 - window.y0),
                         margin - (window.x1 - block.x1), margin - (window.y1 - block.y1)};
    rf_use(r, window);
    rf_load_light(r, &photo, NULL);
    rf_load_disparity(r, &map, r->in_place.code_step, window.x0 - mapped.x0, window.y0 - mapped.y0);
}

void rf_find_silhouettes_in_blocks(struct refocus_renderer *r)
{
    const struct rf_in_place *in_place = &r->in_place;

    for (int i = 0; i < blocks(r, in_place->block) && !rf_cancelled(&r->exec); i++) {
        const struct rf_rect block = block_of(r, in_place->block, i);

        load(r, block, RF_TILE);
        if (!rf_cancelled(&r->exec))
            rf_find_silhouettes(
                &r->exec, &(struct rf_silhouette_window){&r->view, r->light, r->disparity, NULL},
                rf_part_in_window(&r->view, block), &r->photo.silhouettes);
    }
}

/* Computes light, blur and smooth light of a block and its margin. */
static void make_window(struct rf_frame *f, struct rf_rect block, int margin, enum rf_need need)
{
    struct refocus_renderer *r = rf_renderer_of(f);

    load(r, block, margin);
    rf_set_planes(f);
    if (need == RF_NEED_LIGHT || rf_cancelled(&r->exec))
        return;
    rf_pass_blur(f, need == RF_NEED_LAYERS);
    if (need == RF_NEED_BLUR || rf_cancelled(&r->exec))
        return;
    rf_pass_silhouettes(f);
    rf_pass_smooth(f);
}

/* The number of pixels of level RF_KEPT that n pixels of the photo make, rounded up. */
static int kept_pixels(int n)
{
    return (n + (1 << RF_KEPT) - 1) >> RF_KEPT;
}

/* Stores level RF_KEPT of the pyramid above a block, which begins at a multiple of its pixels. */
static void keep_level(struct refocus_renderer *r, struct rf_rect block)
{
    const struct rf_level *from = &r->pyramid.level[RF_KEPT];
    const struct rf_level *to = &r->in_place.kept.level[RF_KEPT];
    const int x0 = block.x0 >> RF_KEPT, y0 = block.y0 >> RF_KEPT;
    const int n = kept_pixels(block.x1 - block.x0);
    const ptrdiff_t dx = (block.x0 - r->view.x0) >> RF_KEPT;
    const ptrdiff_t dy = (block.y0 - r->view.y0) >> RF_KEPT;

    for (int y = 0; y < kept_pixels(block.y1 - block.y0); y++) {
        const ptrdiff_t in = (dy + y) * from->blur.stride + dx,
                        out = (y0 + y) * to->blur.stride + x0;

        for (int c = 0; c < 3; c++)
            memcpy(to->light.channel[c] + out, from->light.channel[c] + in, (size_t)n * 2);
        memcpy(to->blur.at + out, from->blur.at + in, (size_t)n * 2);
        if (x0 + n == to->width && to->width % 2)
            to->blur.at[out + n] = RF_NO_BLUR; /* there is one more column */
    }
}

/* Runs through the photo for the first time. */
static void mark(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    struct rf_in_place *in_place = &r->in_place;

    rf_pyramid_shape(&in_place->kept, r->photo.width, r->photo.height);
    in_place->kept.apart = rf_layers_apart(f->params->max_blur_radius, f->focus.unit);
    for (int i = 0; i < blocks(r, in_place->mark_block) && !rf_cancelled(&r->exec); i++) {
        const struct rf_rect block = block_of(r, in_place->mark_block, i);

        make_window(f, block, in_place->mark_margin, RF_NEED_LAYERS);
        if (rf_cancelled(&r->exec))
            break;
        rf_pass_mark_background(f, RF_KEPT);
        rf_known_store(&in_place->known, &r->view, r->background.blur, block);
        if (!rf_cancelled(&r->exec))
            keep_level(r, block);
    }
    rf_background_push(&r->exec, &in_place->kept, RF_KEPT, in_place->kept.levels);
    rf_background_pull(&r->exec, &r->view, &in_place->kept, RF_KEPT, in_place->kept.levels);
}

static void known_band(void *context, int band, int worker)
{
    struct refocus_renderer *r = context;
    const struct rf_mark pass = {
        .planes = 3, .blur = r->blur, .smooth = r->smooth, .background = r->background};

    (void)worker;
    rf_known_mark_rows(&r->in_place.known, &r->view, &pass, rf_band_start(band),
                       rf_band_end(&r->view, band));
    rf_background_push_band(&r->exec, &r->pyramid, band, 0, RF_KEPT - 1);
}

/* Computes the background of the window from the marks and levels that were stored. */
static void make_background(struct rf_frame *f)
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_level *kept = &r->in_place.kept.level[RF_KEPT];
    struct rf_level *level = &r->pyramid.level[RF_KEPT], own;
    ptrdiff_t at;

    if (blocks(r, r->in_place.block) == 1) { /* the window is all of the photo */
        rf_pass_mark_background(f, r->pyramid.levels);
        rf_pass_inpaint(f, r->pyramid.levels);
        return;
    }
    rf_plane_begin(&r->lifetimes, RF_PLANE_BACKGROUND_BLUR);
    rf_plane_begin(&r->lifetimes, RF_PLANE_BACKGROUND_LIGHT);
    rf_plane_begin(&r->lifetimes, RF_PLANE_PYRAMID);
    r->pyramid.apart = r->in_place.kept.apart;
    rf_pool_run(&r->pool, known_band, r, rf_bands(&r->view));
    own = *level;
    at = (r->view.y0 >> RF_KEPT) * kept->blur.stride + (r->view.x0 >> RF_KEPT);
    for (int c = 0; c < 3; c++)
        level->light.channel[c] = kept->light.channel[c] + at;
    level->blur.at = kept->blur.at + at;
    level->light.stride = level->blur.stride = kept->blur.stride;
    rf_pass_inpaint(f, RF_KEPT);
    *level = own;
}

/* Whether the first run through the photo was for this lens and light. */
static bool is_marked(const struct rf_frame *f)
{
    return rf_renderer_of(f)->cache.background && rf_same_lens(f) && rf_same_light(f);
}

static void mark_once(struct rf_frame *f)
{
    struct rf_pass_cache *m = &rf_renderer_of(f)->cache;

    if (blocks(rf_renderer_of(f), rf_renderer_of(f)->in_place.block) == 1 || is_marked(f))
        return;
    m->background = false;
    mark(f);
    *m = (struct rf_pass_cache){
        .blur = true, .smooth = true, .plan = f->plan, .shift = f->scale.shift};
    rf_note_light(f);
    m->background = !rf_cancelled(&rf_renderer_of(f)->exec);
}

void rf_run_strips(struct rf_frame *f, struct rf_rect region, enum rf_need need,
                   void (*tiles)(struct rf_frame *f))
{
    struct refocus_renderer *r = rf_renderer_of(f);
    const struct rf_in_place *in_place = &r->in_place;
    const struct refocus_image *const out = f->out;

    r->blend = f->params->blend;
    rf_set_weights(f);
    if (need == RF_NEED_LAYERS) {
        rf_pass_highlights(f);
        if (!rf_cancelled(&r->exec))
            mark_once(f);
    }
    for (int i = 0; i < blocks(r, in_place->block) && !rf_cancelled(&r->exec); i++) {
        const struct rf_rect b = block_of(r, in_place->block, i);
        const struct rf_rect part = {
            b.x0 > region.x0 ? b.x0 : region.x0, b.y0 > region.y0 ? b.y0 : region.y0,
            b.x1 < region.x1 ? b.x1 : region.x1, b.y1 < region.y1 ? b.y1 : region.y1};
        struct refocus_image image;

        if (part.x0 >= part.x1 || part.y0 >= part.y1)
            continue;
        make_window(f, b, in_place->margin, need);
        if (need == RF_NEED_LAYERS && !rf_cancelled(&r->exec))
            make_background(f);
        if (need == RF_NEED_LAYERS && !rf_cancelled(&r->exec))
            rf_pass_boost(f);
        if (need != RF_NEED_LIGHT && f->weighted && (rf_is_sweep(f) || rf_is_search(f)) &&
            !rf_cancelled(&r->exec))
            rf_pass_weights(f);
        image = image_part(out, (struct rf_rect){part.x0 - region.x0, part.y0 - region.y0,
                                                 part.x1 - region.x0, part.y1 - region.y0});
        f->out = &image;
        f->region = rf_part_in_window(&r->view, part);
        if (!rf_cancelled(&r->exec))
            tiles(f);
    }
    f->out = out;
}
