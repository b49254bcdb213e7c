/* shot.c: a photo and its depth map are rendered as the settings say. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "shot.h"

/* As `refocus render` has them. */
static const struct {
    int rays;
    uint32_t thin, inpaint;
} qualities[] = {
    {32, 0, REFOCUS_INPAINT_SMOOTH},
    {64, 1, REFOCUS_INPAINT_SMOOTH},
    {128, 1, REFOCUS_INPAINT_TEXTURED},
    [RF_GEGL_STILL] = {64, 1, REFOCUS_INPAINT_SMOOTH},
};

/* Disparities, and where samples had no value a byte for each that says how sure it is. */
struct map {
    uint16_t *disparity;
    uint8_t *confidence;
    struct refocus_disparity view;
};

static int fail(char *why, int status, const char *text)
{
    snprintf(why, RF_GEGL_WORDS, "%s", text);
    return status;
}

static bool is_deep(uint32_t format)
{
    return format != REFOCUS_FORMAT_RGB8 && format != REFOCUS_FORMAT_RGBA8;
}

static struct refocus_depth_map samples_of(const struct rf_gegl_shot *shot)
{
    const struct rf_gegl_settings *const settings = shot->settings;
    struct refocus_depth_map samples = refocus_depth_map_default();

    samples.sample = REFOCUS_SAMPLE_F32;
    samples.samples = shot->depth;
    samples.width = shot->depth_width;
    samples.height = shot->depth_height;
    samples.stride = (ptrdiff_t)shot->depth_width * (ptrdiff_t)sizeof *shot->depth;
    if (settings->unit == RF_GEGL_METRES) {
        samples.meaning = REFOCUS_DEPTH_DISTANCE;
        samples.metres_per_unit = 1;
        samples.near_m = settings->near_m;
        samples.far_m = settings->far_m;
    } else {
        samples.value_near = settings->unit == RF_GEGL_DISPARITY;
        samples.value_far = settings->unit == RF_GEGL_INVERSE;
    }
    return samples;
}

static int explain_depth(const struct rf_gegl_shot *shot, int status, char *why)
{
    const struct rf_gegl_settings *const settings = shot->settings;

    if (status == REFOCUS_ERR_NO_DEPTH)
        return fail(why, status, "no sample of the depth map holds a value");
    if (status == REFOCUS_ERR_ARGUMENT && settings->unit == RF_GEGL_METRES)
        return fail(why, status,
                    "near and far do not fit the depth map; near has to be less than far");
    snprintf(why, RF_GEGL_WORDS, "the depth map of %dx%d pixels: %s", shot->depth_width,
             shot->depth_height, refocus_strerror(status));
    return status;
}

static int make_map(struct map *map, const struct rf_gegl_shot *shot, char *why)
{
    const uint64_t count = (uint64_t)shot->depth_width * (uint64_t)shot->depth_height;
    const struct refocus_depth_map samples = samples_of(shot);
    struct refocus_repair_params repair = refocus_repair_params_default();
    struct refocus_depth_report report = refocus_depth_report_default();
    int status = REFOCUS_ERR_MEMORY;

    map->disparity = count <= SIZE_MAX / 2 ? malloc((size_t)count * 2) : NULL;
    map->confidence = map->disparity ? malloc((size_t)count) : NULL;
    repair.confidence = map->confidence;
    repair.confidence_stride = shot->depth_width;
    repair.photo = is_deep(shot->photo->format) ? NULL : shot->photo;
    if (map->confidence)
        status = refocus_depth_repair(&samples, &repair, map->disparity,
                                      2 * (ptrdiff_t)shot->depth_width, &report);
    if (status != REFOCUS_OK)
        return explain_depth(shot, status, why);
    if (report.unknown == 0) {
        free(map->confidence);
        map->confidence = NULL;
    }
    map->view = refocus_disparity16(map->disparity, shot->depth_width, shot->depth_height,
                                    2 * (ptrdiff_t)shot->depth_width);
    return REFOCUS_OK;
}

static int make_aperture(const struct rf_gegl_settings *settings,
                         struct refocus_aperture **aperture)
{
    static const uint32_t figures[] = {
        [RF_GEGL_DISC] = REFOCUS_FIGURE_NONE,
        [RF_GEGL_POLYGON] = REFOCUS_FIGURE_NONE,
        [RF_GEGL_HEART] = REFOCUS_FIGURE_HEART,
        [RF_GEGL_STAR] = REFOCUS_FIGURE_STAR,
    };
    struct refocus_aperture_params params = refocus_aperture_params_default();

    params.figure = figures[settings->shape];
    if (settings->shape == RF_GEGL_POLYGON || settings->shape == RF_GEGL_STAR)
        params.blades = settings->blades;
    if (settings->shape != RF_GEGL_DISC)
        params.rotation_deg = fmod(settings->rotation, 360);
    if (settings->shape == RF_GEGL_POLYGON)
        params.curvature = settings->curvature;
    params.squeeze = settings->squeeze;
    params.hole = settings->ring;
    params.edge_behind = settings->edge;
    params.edge_before = -settings->edge;
    return refocus_aperture_create(aperture, &params);
}

static struct refocus_settings params_of(const struct rf_gegl_shot *shot)
{
    const struct rf_gegl_settings *const settings = shot->settings;
    struct refocus_settings params =
        refocus_settings_default((float)settings->focus, (float)settings->blur);

    params.render.rays = settings->quality == RF_GEGL_STILL
                             ? refocus_still_rays((float)settings->blur)
                             : qualities[settings->quality].rays;
    params.render.inpaint = qualities[settings->quality].inpaint;
    params.thin.enabled = qualities[settings->quality].thin;
    params.focus.half_width = (float)settings->focus_width;
    params.focus.transition = (float)(settings->focus_transition < 0 ? settings->focus_width
                                                                     : settings->focus_transition);
    params.look.cat_eye = (float)settings->cat_eye;
    params.look.fringe = (float)settings->fringe;
    params.look.grain = is_deep(shot->photo->format) || is_deep(shot->out->format) ? 0 : 1;
    if (settings->highlights >= 1)
        params.highlights.gain = (float)settings->highlights;
    else
        params.highlights.estimate = 1;
    return params;
}

static int create(struct refocus_renderer **renderer, const struct rf_gegl_shot *shot, char *why)
{
    const struct rf_gegl_settings *const settings = shot->settings;
    const struct refocus_image *const photo = shot->photo;
    struct refocus_renderer_params params =
        refocus_renderer_params_default(photo->width, photo->height, (float)settings->blur);
    int status;

    params.threads = shot->threads;
    params.thin = qualities[settings->quality].thin;
    params.textured = qualities[settings->quality].inpaint == REFOCUS_INPAINT_TEXTURED;
    params.depth_edges = settings->place_edges ? REFOCUS_DEPTH_EDGES_AUTO : 0;
    params.deep = is_deep(photo->format) || is_deep(shot->out->format);
    status = refocus_renderer_create(renderer, &params);
    if (status != REFOCUS_OK)
        snprintf(why, RF_GEGL_WORDS, "%s: %dx%d pixels with blur %.4g need %.0f MiB",
                 refocus_strerror(status), (int)photo->width, (int)photo->height, settings->blur,
                 (double)refocus_renderer_memory(&params) / (1 << 20));
    return status;
}

static int prepare(struct refocus_renderer *renderer, const struct rf_gegl_shot *shot,
                   const struct map *map)
{
    struct refocus_scene scene = refocus_scene_default(shot->photo, &map->view);

    scene.depth_edges = shot->settings->place_edges ? REFOCUS_DEPTH_EDGES_AUTO : 0;
    scene.confidence = map->confidence;
    scene.confidence_stride = map->confidence ? shot->depth_width : 0;
    return refocus_prepare_scene(renderer, &scene);
}

static int pixel_at(double share, int32_t pixels)
{
    return (int)fmin(share * pixels, pixels - 1);
}

/* Where a place is given, the disparity of the surface there. */
static int find_focus(struct refocus_renderer *renderer, const struct rf_gegl_shot *shot,
                      float *focus)
{
    const struct rf_gegl_settings *const settings = shot->settings;
    const int32_t width = shot->photo->width, height = shot->photo->height;
    const ptrdiff_t stride = 2 * (ptrdiff_t)width;
    struct refocus_disparity map;
    uint16_t *prepared;
    int status;

    if (settings->focus_x < 0 || settings->focus_y < 0)
        return REFOCUS_OK;
    prepared = malloc((size_t)stride * (size_t)height);
    if (!prepared)
        return REFOCUS_ERR_MEMORY;
    map = refocus_disparity16(prepared, width, height, stride);
    status = refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, prepared, stride);
    if (status == REFOCUS_OK)
        status = refocus_focus_at_point(&map, pixel_at(settings->focus_x, width),
                                        pixel_at(settings->focus_y, height), 0, focus);
    free(prepared);
    return status;
}

static int render(struct refocus_renderer *renderer, const struct rf_gegl_shot *shot,
                  const struct refocus_aperture *aperture)
{
    struct refocus_settings params = params_of(shot);
    const int status = find_focus(renderer, shot, &params.render.focus_disparity);

    if (status != REFOCUS_OK)
        return status;
    params.render.aperture = aperture;
    params.render.region_x = shot->x;
    params.render.region_y = shot->y;
    params.render.region_width = shot->out->width;
    params.render.region_height = shot->out->height;
    return refocus_render_settings(renderer, &params, shot->out);
}

int rf_gegl_shot_take(const struct rf_gegl_shot *shot, char why[RF_GEGL_WORDS])
{
    struct refocus_renderer *renderer = NULL;
    struct refocus_aperture *aperture = NULL;
    struct map map = {0};
    int status;

    why[0] = '\0';
    status = make_map(&map, shot, why);
    if (status == REFOCUS_OK)
        status = create(&renderer, shot, why);
    if (status == REFOCUS_OK)
        status = make_aperture(shot->settings, &aperture);
    if (status == REFOCUS_OK)
        status = prepare(renderer, shot, &map);
    free(map.disparity);
    free(map.confidence);
    if (status == REFOCUS_OK)
        status = render(renderer, shot, aperture);
    if (status != REFOCUS_OK && why[0] == '\0')
        fail(why, status, refocus_strerror(status));
    refocus_aperture_destroy(&aperture);
    refocus_renderer_destroy(&renderer);
    return status;
}
