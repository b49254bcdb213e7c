/* shot.c: one photo is read and prepared, with its lens setting in engine.params. */
#include <stdlib.h>
#include <string.h>
#include "inputs/depth_options.h"
#include "inputs/estimate.h"
#include "inputs/matte.h"
#include "inputs/painted.h"
#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"
#include "shot/shot.h"
#include "shot/spool.h"
#include "shot/strips.h"

const struct option shot_depth_options[] = {
    GROUP(depth_file_options, struct shot_settings, depth),
    GROUP(depth_unit_options, struct shot_settings, depth),
    GROUP(depth_ways_options, struct shot_settings, depth),
    GROUP(repair_options, struct shot_settings, depth),
    GROUP(upsample_options, struct shot_settings, depth),
    GROUP(depth_edges_options, struct shot_settings, depth),
    GROUP(orient_depth_options, struct shot_settings, depth),
    GROUP(matte_options, struct shot_settings, depth),
    GROUP(limit_options, struct shot_settings, depth.limits),
    {.help = NULL},
};

int shot_aim(const struct input *input, const struct lens_settings *lens,
             const struct controls *controls, const uint16_t *disparity,
             struct refocus_settings *params)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_disparity map =
        refocus_disparity16(disparity, photo->width, photo->height, (ptrdiff_t)photo->width * 2);
    struct controls aimed = *controls;
    double focus = 0;
    const int status = input_focus(input, lens, disparity, &focus);

    if (status != EXIT_DONE)
        return status;
    params->render.focus_disparity = (float)focus;
    if (!isnan(lens->focus_at[0]))
        controls_turn_about(&aimed, photo, lens->focus_at[1]);
    return controls_aim(&aimed, params, &map);
}

void shot_suit_papers(const struct input *input, const struct lens_settings *lens,
                      const struct paper_settings *papers, struct refocus_settings *params)
{
    const struct refocus_image *photo = input->photo->image;
    double looked_at[2];

    input_focus_point(input, lens, looked_at);
    papers_suit(papers, looked_at, photo->width, photo->height, params);
}

static int choose_focus(struct shot *shot, const struct lens_settings *lens)
{
    const struct refocus_image *photo = shot->input.photo->image;
    const size_t pixels = (size_t)photo->width * (size_t)photo->height;
    const ptrdiff_t stride = (ptrdiff_t)photo->width * 2;
    uint16_t *prepared = shot->full ? shot->full : malloc(pixels * sizeof *prepared);
    int status = EXIT_DONE;

    if (!prepared || (!shot->full && refocus_get_view(shot->engine.renderer, REFOCUS_VIEW_DISPARITY,
                                                      prepared, stride) != REFOCUS_OK))
        status = report_failure(EXIT_FAILED, shot->input.photo_name,
                                "not enough memory to find the focus");
    if (status == EXIT_DONE)
        status =
            shot_aim(&shot->input, lens, &shot->engine.controls, prepared, &shot->engine.params);
    if (!shot->full)
        free(prepared);
    return status;
}

int shot_check(struct shot_settings *settings, bool own_focus)
{
    int status = input_check_depth(&settings->depth);

    if (input_depth_is_made(&settings->depth))
        settings->depth.make = input_estimate_depth;
    if (settings->depth.strokes)
        settings->depth.full = settings->depth.optional = true;
    settings->engine.bokeh.f_number = settings->lens.f_number;
    if (status == EXIT_DONE)
        status = input_check_lens(&settings->lens);
    if (status == EXIT_DONE)
        status = controls_check(&settings->engine.controls,
                                own_focus || input_focus_is_given(&settings->lens));
    if (status == EXIT_DONE && settings->engine.in_strips)
        status = strips_check(&settings->engine, &settings->depth, settings->behind.image != NULL);
    return status;
}

int shot_inputs(const struct shot_settings *settings, const char *photo,
                const char *inputs[SHOT_INPUTS])
{
    int count = 0;

    inputs[count++] = photo;
    inputs[count++] = settings->depth.file;
    inputs[count++] = matte_is_none(settings->depth.matte) ? NULL : settings->depth.matte;
    inputs[count++] = settings->behind.image;
    inputs[count++] = settings->behind.depth;
    inputs[count++] = settings->engine.aperture;
    inputs[count++] = settings->engine.papers.field_map;
    inputs[count++] = settings->engine.controls.focus_map;
    inputs[count++] = settings->engine.controls.sharp_mask;
    inputs[count++] = settings->load;
    inputs[count++] = settings->config;
    inputs[count++] = settings->depth.model;
    inputs[count++] = settings->depth.right;
    inputs[count++] = settings->depth.strokes;
    return count;
}

/* Reads the photo, its depth and what is behind it, as far as the method can use them. */
static int read_files(struct shot *shot, const char *photo, const struct shot_settings *settings)
{
    const bool in_strips = settings->engine.in_strips;
    struct depth_settings depth = settings->depth;
    int status;

    report_progress("reading", 0);
    report_cut(photo);
    if (!engine_takes_deep(&shot->engine.params) || in_strips)
        depth.deep = DEEP_NONE;
    depth.light &= engine_draws_light(&shot->engine.params) && !in_strips;
    status = input_read(&shot->input, photo, &depth);
    if (status == EXIT_DONE)
        status = painted_over(&shot->input, &depth);
    shot->input.most_blur = engine_most_blur(&settings->engine);
    if (status == EXIT_DONE)
        status = behind_read(&shot->behind, &settings->behind, &settings->depth, &shot->input);
    report_cut(NULL);
    return status;
}

void shot_suit_output(struct depth_settings *depth, const char *output)
{
    const bool all = (output && output_deep_format(output)) || depth->transfer ||
                     !isnan(depth->white) || depth->no_dither;

    depth->deep = all ? DEEP_ALL : DEEP_LIGHT;
    depth->light = true;
}

bool shot_takes_deep(const struct input *input, const struct refocus_settings *params)
{
    return input->deep.plane[0] &&
           (input->light ? engine_draws_light(params) : engine_takes_deep(params));
}

/* The scene with all that the photo holds, or with its 8 bits. */
static struct refocus_scene scene_of(const struct shot *shot)
{
    const struct input *input = &shot->input;
    struct refocus_scene scene = input_scene(input, &shot->map);

    if (!shot->deep)
        scene.photo = input->photo->image;
    scene.depth_edges = shot->engine.places_edges;
    if (shot->full) {
        scene.depth_edges = REFOCUS_DEPTH_EDGES_AS_GIVEN;
        scene.confidence = NULL;
    }
    behind_add(&shot->behind, &scene);
    return scene;
}

bool shot_choose_bits(const struct input *input, bool adds_grain, struct refocus_settings *params)
{
    bool deep;

    if (adds_grain)
        params->look.grain = 0; /* so that deep photos are taken */
    deep = shot_takes_deep(input, params);
    if (adds_grain && !deep)
        params->look.grain = 1;
    return deep;
}

static bool choose_bits(struct shot *shot)
{
    return shot_choose_bits(&shot->input, shot->adds_grain, &shot->engine.params);
}

static int prepare_bits(struct shot *shot, bool deep)
{
    const struct input *input = &shot->input;
    struct refocus_scene scene;

    shot->deep = deep;
    shot->engine.light = deep ? input->light : NULL;
    if (!deep && input->deep.plane[0] && !input->light && !shot->told) {
        input_tell_bits(input->photo, input->photo_name);
        shot->told = true;
    }
    scene = scene_of(shot);
    return engine_prepare(&shot->engine, &scene);
}

int shot_suit(struct shot *shot)
{
    const bool deep = choose_bits(shot);

    return deep == shot->deep ? EXIT_DONE : prepare_bits(shot, deep);
}

/* The depth of the scene, of the photo's size where that was made already. */
static struct refocus_disparity map_of(const struct shot *shot)
{
    const struct input *input = &shot->input;
    const struct refocus_image *image = input->photo->image;

    if (shot->full)
        return refocus_disparity16(shot->full, image->width, image->height,
                                   2 * (ptrdiff_t)image->width);
    return refocus_disparity16(input->disparity, input->width, input->height,
                               (ptrdiff_t)input->width * 2);
}

/* Makes the renderer for what was read, and prepares it. */
static int prepare(struct shot *shot, const struct shot_settings *settings, double blur,
                   double most_blur)
{
    struct engine *engine = &shot->engine;
    const struct refocus_image *image = shot->input.photo->image;
    int status;

    shot->map = map_of(shot);
    shot->adds_grain = isnan(settings->engine.bokeh.grain);
    engine->has_matte = shot->input.matte.samples != NULL;
    engine->behind = settings->behind.image != NULL;
    engine->deep = shot->input.deep.plane[0] != NULL;
    engine->params.render.dither =
        settings->depth.no_dither ? REFOCUS_DITHER_OFF : REFOCUS_DITHER_ORDERED;
    status = engine_create(engine, &settings->engine, image->width, image->height,
                           fmax(blur, most_blur));
    engine->params.render.max_blur_radius = (float)blur;
    shot_suit_papers(&shot->input, &settings->lens, &settings->engine.papers, &engine->params);
    return status == EXIT_DONE ? prepare_bits(shot, choose_bits(shot)) : status;
}

int shot_begin(struct shot *shot, const char *photo, const struct shot_settings *settings)
{
    int status;

    memset(shot, 0, sizeof *shot);
    status = engine_begin(&shot->engine, &settings->engine);
    shot->engine.name = photo;
    return status == EXIT_DONE ? read_files(shot, photo, settings) : status;
}

int shot_prepare(struct shot *shot, const struct shot_settings *settings, double most_blur)
{
    double blur = 0;
    int status = input_blur(&shot->input, &settings->lens, &blur);

    if (status != EXIT_DONE)
        return status;
    report_progress("preparing", 0.15);
    shot->engine.places_edges = input_has_edges_placed(&shot->input, &settings->depth);
    if (settings->engine.in_strips)
        status = strips_disparity(&shot->input, shot->engine.places_edges, &settings->engine,
                                  &shot->full, &shot->engine.edges);
    if (status == EXIT_DONE)
        status = prepare(shot, settings, blur, most_blur);
    return status == EXIT_DONE ? choose_focus(shot, &settings->lens) : status;
}

int shot_open(struct shot *shot, const char *photo, const struct shot_settings *settings,
              double most_blur)
{
    const int status = shot_begin(shot, photo, settings);

    return status == EXIT_DONE ? shot_prepare(shot, settings, most_blur) : status;
}

int shot_rendered(struct shot *shot, const struct refocus_image *out)
{
    interrupt_watch(NULL);
    refocus_renderer_destroy(&shot->engine.renderer);
    free(shot->full);
    shot->full = NULL;
    return shot->engine.spool >= 0 ? spool_get(shot->engine.spool, shot->input.photo_name, out)
                                   : EXIT_DONE;
}

void shot_close(struct shot *shot)
{
    engine_end(&shot->engine);
    behind_free(&shot->behind);
    free(shot->full);
    input_free(&shot->input);
}

/* With a gain map, a PNG has 8 bits as the photo has, and a PFM all the light. A PNG is of the
 * photo's kind. */
struct refocus_image shot_picture(const struct input *input, bool deep, const char *output)
{
    const uint32_t format = output && deep ? output_deep_format(output) : REFOCUS_FORMAT_NONE;
    const bool wide = format && (!input->light || format == REFOCUS_FORMAT_RGB_FLOAT);
    const struct refocus_image *photo = input->photo->image;
    struct refocus_image picture = refocus_image_packed(wide ? format : REFOCUS_FORMAT_RGB8, NULL,
                                                        photo->width, photo->height, 0);

    if (picture.format == REFOCUS_FORMAT_RGB16 && input->deep.format == picture.format) {
        picture.transfer = input->deep.transfer;
        picture.white = input->deep.white;
    }
    return picture;
}

int shot_output(struct shot *shot, const double region[4], const char *output,
                struct refocus_image *out)
{
    const struct refocus_image *photo = shot->input.photo->image;
    struct refocus_settings *params = &shot->engine.params;
    int width = photo->width, height = photo->height, bytes;

    if (!isnan(region[0])) {
        if (region[2] < 1 || region[3] < 1 || region[0] + region[2] > width ||
            region[1] + region[3] > height)
            return report_failure(
                EXIT_WRONG, "--region", "%g,%g,%g,%g does not lie within the %dx%d pixels of %s",
                region[0], region[1], region[2], region[3], width, height, shot->input.photo_name);
        params->render.region_x = (int32_t)region[0];
        params->render.region_y = (int32_t)region[1];
        params->render.region_width = width = (int32_t)region[2];
        params->render.region_height = height = (int32_t)region[3];
    }
    *out = shot_picture(&shot->input, shot->deep, output);
    bytes = refocus_format_bytes(out->format);
    out->width = width;
    out->height = height;
    out->stride[0] = (ptrdiff_t)width * bytes;
    if ((uint64_t)width * (uint64_t)bytes * (uint64_t)height <= SIZE_MAX)
        out->plane[0] = malloc((size_t)width * (size_t)bytes * (size_t)height);
    if (!out->plane[0])
        return report_failure(EXIT_FAILED, shot->input.photo_name,
                              "not enough memory for %dx%d pixels", width, height);
    return EXIT_DONE;
}
