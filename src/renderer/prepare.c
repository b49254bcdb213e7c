/* prepare.c: loads a photo and its disparity map for the renders that follow. */
#include <refocus/render.h>

#include <string.h>

#include "depth/dequantise.h"
#include "depth/upsample.h"
#include "edges/place.h"
#include "image/format.h"
#include "image/read.h"
#include "image/viewport.h"
#include "image/disparity_map.h"
#include "renderer/renderer.h"
#include "renderer/layout.h"
#include "renderer/load.h"

/* A scene as it was read: its structs are copies of the caller's. */
struct scene {
    struct refocus_image photo;
    struct refocus_disparity disparity, matte;
    bool has_matte;
    uint32_t depth_edges; /* enum refocus_depth_edges */
    const uint8_t *confidence;
    ptrdiff_t confidence_stride;
    bool has_behind;
    struct refocus_image behind;
    struct refocus_disparity behind_disparity;
};

static bool places_edges(const struct scene *scene)
{
    return scene->depth_edges != REFOCUS_DEPTH_EDGES_AS_GIVEN;
}

/* Brings the map to the photo's size, working in `arena`. */
static void upsample(struct refocus_renderer *r, const struct scene *scene,
                     const struct refocus_image *photo, struct rf_arena arena,
                     struct rf_disparity_q16 out)
{
    struct rf_upsampler up = {
        .kernels = r->exec.kernels,
        .photo = photo,
        .map = &scene->disparity,
        .confidence = scene->confidence,
        .confidence_stride = scene->confidence_stride,
        .columns = rf_upsample_samples(scene->disparity.width, r->view.width),
        .rows = rf_upsample_samples(scene->disparity.height, r->view.height),
        .shares = r->exec.shares,
        .out = out,
    };

    rf_upsampler_lay_out(&up, &arena);
    rf_upsample(&up, &r->pool);
}

/* Puts samples of a map of the photo's size back that are rather sure than not. */
static void keep_sure(const struct scene *scene, struct rf_disparity_q16 out)
{
    const struct refocus_disparity *map = &scene->disparity;

    for (int y = 0; y < map->height; y++) {
        const uint8_t *sure = scene->confidence + y * scene->confidence_stride;
        const void *const row = rf_map_row(map, y);

        for (int x = 0; x < map->width; x++)
            if (sure[x] >= 128)
                out.at[y * out.stride + x] = rf_map_sample(map, row, x);
    }
}

/* The map as its edges are looked for in: where there is confidence, one of the photo's size that
 * is taken from `arena`. */
static struct refocus_disparity settle(struct refocus_renderer *r, const struct scene *scene,
                                       const struct refocus_image *photo, struct rf_arena *arena)
{
    const int width = r->view.width, height = r->view.height;
    struct rf_disparity_q16 out = {NULL, width};

    if (!scene->confidence || !places_edges(scene))
        return scene->disparity;
    out.at = rf_arena_take(arena, (uint64_t)width * (uint64_t)height, 2);
    upsample(r, scene, photo, *arena, out);
    if (scene->disparity.width == width && scene->disparity.height == height)
        keep_sure(scene, out);
    return refocus_disparity16(out.at, width, height, 2 * (ptrdiff_t)width);
}

/* Puts the edges of a map on the photo's. Says whether it wrote the result. */
static bool place(struct refocus_renderer *r, const struct scene *scene,
                  const struct refocus_image *photo, const struct refocus_disparity *map,
                  void *memory, struct rf_disparity_q16 out)
{
    const struct rf_place_edges place = {
        .kernels = r->exec.kernels,
        .pool = &r->pool,
        .photo = photo,
        .map = map,
        .last = scene->depth_edges == REFOCUS_DEPTH_EDGES_STEADY ? &r->last_edges : NULL,
        .memory = memory,
        .shares = r->exec.shares,
        .out = out,
    };

    return places_edges(scene) && rf_place_edges(&place, &r->edges);
}

/* Frames that are not placed steadily have none after them that is compared with them. */
static void forget_edges(struct refocus_renderer *r, const struct scene *scene)
{
    if (scene->depth_edges != REFOCUS_DEPTH_EDGES_STEADY || rf_cancelled(&r->exec))
        r->last_edges.width = 0;
}

/* Writes the disparities. */
static void take_in_map(struct refocus_renderer *r, const struct scene *scene,
                        const struct refocus_image *photo, struct rf_arena arena)
{
    const struct refocus_disparity map = settle(r, scene, photo, &arena);

    if (rf_cancelled(&r->exec))
        return;
    if (place(r, scene, photo, &map, arena.base + arena.used, r->disparity))
        return;
    if (rf_cancelled(&r->exec))
        return;
    if (map.width == r->view.width && map.height == r->view.height)
        /* A map that was made here has no steps, and lies where they would be smoothed. */
        rf_load_disparity(r, &map, map.samples != scene->disparity.samples ? 0 : rf_code_step(&map),
                          0, 0);
    else
        upsample(r, scene, photo, arena, r->disparity);
}

/* Memory for the photo in RGB8, for passes that look at its colours: apart from the planes of the
 * photo, into which disparities are written while it is read. */
static struct refocus_image take_guide(const struct refocus_renderer *r, struct rf_arena *arena)
{
    const int width = r->view.width, height = r->view.height;

    return refocus_image_packed(REFOCUS_FORMAT_RGB8,
                                rf_arena_take(arena, (uint64_t)width * (uint64_t)height, 3), width,
                                height, 3 * (ptrdiff_t)width);
}

/* Takes in the matte. All planes of a lens setting serve as scratch. */
static void take_in_matte(struct refocus_renderer *r, const struct refocus_disparity *matte)
{
    const struct rf_matte_pass pass = {
        .exec = &r->exec,
        .view = &r->view,
        .matte = matte,
        .transfer = &r->transfer[r->blend],
        .light = r->light,
        .disparity = r->disparity,
        .pyramid = &r->pyramid,
        .alpha = {(uint16_t *)r->blur.at, r->blur.stride},
        .near = {r->smooth.channel[0], r->smooth.stride},
        .lost = {r->smooth.channel[1], r->smooth.stride},
        .far = {r->smooth.channel[2], r->smooth.stride},
        .list = &r->photo.thin,
    };

    r->pyramid.apart = RF_NEVER_APART;
    rf_matte_take_in(&pass);
    rf_planes_end(&r->lifetimes);
}

static void take_in(struct refocus_renderer *r, const struct scene *scene)
{
    const struct refocus_image *photo = &scene->photo;
    const struct refocus_disparity *map = &scene->disparity;
    const bool same_size = map->width == r->view.width && map->height == r->view.height;
    const bool guided = !same_size || places_edges(scene);
    struct rf_arena arena = {r->prepare_memory, 0};
    const struct refocus_image guide =
        (r->yuv->on || r->deep.on) && guided ? take_guide(r, &arena) : *photo;

    rf_planes_end(&r->lifetimes);
    rf_load_light(r, photo, guided ? &guide : NULL);
    take_in_map(r, scene, &guide, arena);
    forget_edges(r, scene);
    if (scene->has_matte && !rf_cancelled(&r->exec))
        take_in_matte(r, &scene->matte);
    if (!rf_cancelled(&r->exec))
        rf_find_silhouettes(
            &r->exec,
            &(struct rf_silhouette_window){&r->view, r->light, r->disparity,
                                           r->deep.on && r->deep.exceeds ? &r->deep : NULL},
            rf_whole(r), &r->photo.silhouettes);
}

/* Leaves photo and map where they are, but for a map whose edges were moved. */
static void take_in_place(struct refocus_renderer *r, const struct scene *scene)
{
    struct rf_in_place *in_place = &r->in_place;
    const struct refocus_disparity *map = &scene->disparity;
    const struct rf_disparity_q16 out = {in_place->placed, map->width};

    in_place->photo = scene->photo;
    in_place->map = *map;
    in_place->code_step = rf_code_step(map);
    if (place(r, scene, &scene->photo, map, r->prepare_memory, out)) {
        in_place->map =
            refocus_disparity16(out.at, map->width, map->height, 2 * (ptrdiff_t)out.stride);
        in_place->code_step = 0;
    }
    forget_edges(r, scene);
    if (!rf_cancelled(&r->exec))
        rf_find_silhouettes_in_blocks(r);
}

static int read_behind(const struct refocus_renderer *r, const struct rf_log *log,
                       struct scene *scene, const struct refocus_scene *given)
{
    const struct refocus_image *photo = &scene->photo, *behind = &scene->behind;
    const struct refocus_disparity *map = &scene->behind_disparity;
    int status;

    if ((status = rf_read_image(log, "behind", &scene->behind, given->behind)) ||
        (status = rf_read_map(log, "behind_disparity", &scene->behind_disparity,
                              given->behind_disparity)))
        return status;
    if (!r->has_behind || rf_is_yuv8(photo->format) || rf_is_yuv8(behind->format))
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED,
                         "behind needs behind = 1 of the renderer's parameters, without in_place, "
                         "and photo and behind of R, G, B");
    if (behind->width != photo->width || behind->height != photo->height ||
        map->width != photo->width || map->height != photo->height)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "behind is %d x %d and behind_disparity %d x %d, may be %d x %d, as photo",
                         (int)behind->width, (int)behind->height, (int)map->width, (int)map->height,
                         (int)photo->width, (int)photo->height);
    scene->has_behind = true;
    return REFOCUS_OK;
}

static int read_matte(const struct refocus_renderer *r, const struct rf_log *log,
                      struct scene *scene, const struct refocus_scene *given)
{
    scene->has_matte = given->matte != NULL;
    if (!scene->has_matte)
        return REFOCUS_OK;
    if (!r->has_thin || rf_is_yuv8(scene->photo.format))
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED,
                         "a matte needs a photo of R, G, B and a renderer with thin");
    return rf_read_map(log, "matte", &scene->matte, given->matte);
}

static int read_scene(const struct refocus_renderer *r, const struct rf_log *log,
                      struct scene *scene, const struct refocus_scene *given)
{
    int status;

    scene->depth_edges = given->depth_edges;
    if (given->depth_edges > REFOCUS_DEPTH_EDGES_STEADY)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "depth_edges is %u, may be 0 to 2",
                         (unsigned)given->depth_edges);
    if (given->depth_edges > r->most_edges)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "depth_edges is %u, which the renderer was not made for",
                         (unsigned)given->depth_edges);
    if ((status = rf_read_any_image(log, "photo", &scene->photo, given->photo)) ||
        (status = rf_read_map(log, "disparity", &scene->disparity, given->disparity)))
        return status;
    if (scene->photo.width > r->max_width || scene->photo.height > r->max_height)
        return rf_refuse(log, REFOCUS_ERR_SIZE, "photo is %d x %d, may be up to %d x %d",
                         (int)scene->photo.width, (int)scene->photo.height, r->max_width,
                         r->max_height);
    if (r->in_place.on &&
        (scene->disparity.width != scene->photo.width ||
         scene->disparity.height != scene->photo.height || rf_is_yuv8(scene->photo.format)))
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED,
                         "in_place needs a photo of R, G, B and a disparity of its size");
    if (rf_is_deep(scene->photo.format) && !r->deep.curve)
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED,
                         "photo->format is %u, which needs deep = 1 of the renderer's parameters, "
                         "and not in_place",
                         (unsigned)scene->photo.format);
    scene->confidence = given->confidence;
    scene->confidence_stride = given->confidence_stride;
    if (given->confidence && r->in_place.on)
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED, "with in_place there is no confidence");
    if (given->confidence &&
        !rf_good_stride(given->confidence_stride, scene->disparity.width, scene->disparity.height))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "confidence_stride is %lld, may be a row or more either way",
                         (long long)given->confidence_stride);
    scene->has_behind = scene->has_matte = false;
    if ((status = read_matte(r, log, scene, given)))
        return status;
    if (given->behind || given->behind_disparity)
        return read_behind(r, log, scene, given);
    return REFOCUS_OK;
}

static int prepare(struct refocus_renderer *r, const struct rf_log *log,
                   const struct refocus_scene *given)
{
    struct rf_photo *own = &r->photo;
    struct scene scene;
    int status;

    r->prepared = r->blurred = false;
    memset(&r->cache, 0, sizeof r->cache);
    if ((status = read_scene(r, log, &scene, given)))
        return status;
    own->width = scene.photo.width;
    own->height = scene.photo.height;
    own->highlights_blend = own->thin.blend = RF_NO_BLEND;
    own->silhouettes.count = 0;
    own->silhouettes.capacity = (uint32_t)((uint64_t)own->width * (uint64_t)own->height / 64 + 64);
    r->edges = refocus_depth_edges_report_default();
    own->thin.has_matte = false;
    own->behind.width = own->behind.height = 0;
    r->blend = REFOCUS_BLEND_LINEAR; /* silhouettes are always found in linear light */
    rf_yuv_begin(r->yuv, &scene.photo, r->blend);
    rf_deep_begin(&r->deep, &scene.photo, true);
    rf_run_begin(r);
    if (r->in_place.on) {
        take_in_place(r, &scene);
    } else {
        rf_use(r, rf_whole(r));
        memset(own->band_blend, REFOCUS_BLEND_LINEAR, (size_t)rf_bands(&r->view));
        if (r->has_thin)
            rf_matte_forget(&own->thin, &r->view);
        take_in(r, &scene);
        if (scene.has_behind && !rf_cancelled(&r->exec))
            rf_behind_load(&r->exec, &scene.behind, &scene.behind_disparity, &own->behind);
    }
    if (rf_run_end(r))
        return REFOCUS_ERR_CANCELLED;
    r->prepared = true;
    return REFOCUS_OK;
}

static int prepare_given(const char *function, struct refocus_renderer *r,
                         const struct refocus_scene *given)
{
    struct rf_log log = {.function = function};
    struct refocus_scene scene;
    int status = rf_enter(r, &log);

    if (status)
        return status;
    r->prepared = false;
    status = rf_read_struct(&log, "scene", &scene, sizeof scene,
                            REFOCUS_SIZE_TO(struct refocus_scene, disparity), given);
    return rf_leave(r, status ? status : prepare(r, &log, &scene));
}

int refocus_prepare(struct refocus_renderer *r, const struct refocus_image *photo,
                    const struct refocus_disparity *disparity)
{
    const struct refocus_scene scene = refocus_scene_default(photo, disparity);

    return prepare_given("refocus_prepare", r, &scene);
}

int refocus_prepare_scene(struct refocus_renderer *r, const struct refocus_scene *given)
{
    return prepare_given("refocus_prepare_scene", r, given);
}

int refocus_get_depth_edges(const struct refocus_renderer *r,
                            struct refocus_depth_edges_report *report)
{
    struct refocus_renderer *const own = (struct refocus_renderer *)(uintptr_t)r; /* to enter it */
    const int status = report ? rf_enter(own, NULL) : REFOCUS_ERR_ARGUMENT;

    if (status)
        return status;
    if (!r->prepared)
        return rf_leave(own, REFOCUS_ERR_STATE);
    return rf_leave(own, refocus_struct_write(
                             report, REFOCUS_SIZE_TO(struct refocus_depth_edges_report, changed),
                             &r->edges, sizeof r->edges));
}
