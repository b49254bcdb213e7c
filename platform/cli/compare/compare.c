/* compare.c: the command `refocus compare` renders a photo with several methods and scores them
 * against a reference. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "compare/compare_picture.h"
#include "compare/compare_list.h"
#include "compare/compare_report.h"
#include "shot/engine.h"
#include "shot/shot.h"
#include "inputs/read_input.h"
#include "inputs/matte.h"
#include "inputs/lens.h"
#include "outputs/outputs.h"
#include "inputs/depth_options.h"
#include "shot/shot_options.h"

struct settings {
    struct depth_settings depth;
    struct lens_settings lens;
    struct engine_settings engine;
    const char *reference, *methods, *output;
    double border;
};

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    {OPTION(OPTION_TEXT, "--reference", "GT", struct settings, reference),
     .brief = "the picture as it should be, of the photo's size",
     .help = "the picture as it should be, of the photo's size"},
    OUTPUT_OPTION(struct settings, output,
                  "a picture of labelled crops where depth jumps: " OUTPUT_PICTURES),
    GROUP(depth_file_options, struct settings, depth),
    GROUP(depth_unit_options, struct settings, depth),
    GROUP(upsample_options, struct settings, depth),
    GROUP(limit_options, struct settings, depth.limits),
    GROUP(depth_edges_options, struct settings, depth),
    GROUP(orient_depth_options, struct settings, depth),
    GROUP(matte_options, struct settings, depth),
    GROUP(light_options, struct settings, depth),
    {.kind = OPTION_HEADING, .help = "What is compared"},
    {OPTION(OPTION_TEXT, "--methods", "NAME[:OPTION[=VALUE]...],...", struct settings, methods),
     .brief = "such as sweep,search:rays=full:iterations=1",
     .help = "methods of 'refocus render', with commas, each with options of its own "
             "such as search:rays=full:iterations=1 or jittered:cell=4; default: all "
             "that know the aperture"},
    {OPTION(OPTION_NUMBER, "--border", "N", struct settings, border), .least = 0,
     .greatest = REFOCUS_MAX_SIDE,
     .help = "pixels at each side that do not count, less than half the picture; default the "
             "blur radius"},
    {.kind = OPTION_HEADING, .help = "Focus and blur"},
    GROUP(focus_options, struct settings, lens),
    GROUP(lens_options, struct settings, lens),
    {.kind = OPTION_HEADING, .help = "Rendering"},
    GROUP(ray_options, struct settings, engine),
    QUALITY_OPTION(struct settings, engine.quality, "standard", NULL),
    GROUP(rendering_options, struct settings, engine),
    {.kind = OPTION_HEADING, .help = "Running"},
    GROUP(run_options, struct settings, engine),
    GROUP(repeat_options, struct settings, engine),
    GROUP(paper_options, struct settings, engine),
    {.help = NULL},
};

static int check(const struct settings *settings, const char *photo)
{
    const char *const inputs[] = {
        photo, settings->depth.file, settings->reference, settings->engine.aperture,
        matte_is_none(settings->depth.matte) ? NULL : settings->depth.matte};
    int status = input_check_depth(&settings->depth);

    if (status == EXIT_DONE)
        status = input_check_lens(&settings->lens);
    if (status == EXIT_DONE && !settings->reference)
        status = report_failure(EXIT_WRONG, "--reference",
                                "there is nothing to compare with; give --reference GT");
    if (status == EXIT_DONE && settings->output)
        status = output_check(settings->output, OUTPUT_PICTURE, NULL, inputs, 5);
    return status;
}

static int read_reference(struct refocus_photo **reference, const char *file,
                          const struct refocus_image *photo)
{
    struct refocus_reason reason = {""};
    const int status = refocus_photo_read(reference, file, limits_taken(), &reason);

    if (status != REFOCUS_OK || !(*reference)->image->plane[0])
        return report_failure(EXIT_FAILED, file, "%s",
                              reason.text[0] ? reason.text : "it is not a picture");
    if ((*reference)->image->width != photo->width || (*reference)->image->height != photo->height)
        return report_failure(EXIT_FAILED, file,
                              "it has %dx%d pixels, the photo %dx%d; give one of the same size",
                              (int)(*reference)->image->width, (int)(*reference)->image->height,
                              (int)photo->width, (int)photo->height);
    input_tell_bits(*reference, file);
    return EXIT_DONE;
}

/* A packed copy of a picture, or room for one. */
static uint8_t *packed(const struct refocus_image *image, bool copy)
{
    const size_t row = 3 * (size_t)image->width;
    uint8_t *rgb = malloc(row * (size_t)image->height);

    for (int y = 0; rgb && copy && y < image->height; y++)
        memcpy(rgb + (size_t)y * row, image->plane[0] + y * image->stride[0], row);
    return rgb;
}

static uint64_t memory_of(const struct engine *engine, const struct refocus_image *photo,
                          uint32_t method)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(
        photo->width, photo->height, engine->params.render.max_blur_radius);

    params.threads = engine->info.threads;
    params.papers = refocus_papers();
    params.methods = REFOCUS_METHOD_BIT(method);
    params.thin = engine->params.thin.enabled || engine->has_matte;
    params.deep = engine->deep;
    params.textured = engine->params.render.inpaint == REFOCUS_INPAINT_TEXTURED;
    return refocus_renderer_memory(&params);
}

static int add(struct comparison *c, const char *name, const struct refocus_image *image, bool copy)
{
    struct compared *item = &c->item[c->count++];

    item->name = name;
    item->rgb = packed(image, copy);
    return item->rgb ? EXIT_DONE : report_failure(EXIT_FAILED, name, "not enough memory");
}

static int check_border(const struct comparison *c, int border)
{
    if (2 * (int64_t)border < c->width && 2 * (int64_t)border < c->height)
        return EXIT_DONE;
    return report_failure(EXIT_WRONG, "--border",
                          "%d pixels at each side leave nothing of %dx%d to compare; give fewer",
                          border, c->width, c->height);
}

static int score(struct comparison *c, const uint8_t *mask, int border)
{
    for (int i = 1; i < c->count; i++) {
        struct compared *item = &c->item[i];

        if (quality_score(item->rgb, c->item[0].rgb, c->width, c->height, border, mask,
                          &item->scores) != 0)
            return report_failure(EXIT_FAILED, item->name, "not enough memory to score it");
        item->scored = item->scores.pixels > 0;
    }
    return EXIT_DONE;
}

/* Work that all methods share is done once for the photo, and once more when the lens moves: by one
 * pixel at another focus, so that no method is charged more of it than the next one. */
static void warm_up(const struct engine *engine)
{
    struct refocus_settings params = engine->params;
    uint8_t rgb[3];
    const struct refocus_image pixel = refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, 1, 1, 3);

    engine_suit_rays(engine, &params);
    params.render.focus_disparity += params.render.focus_disparity > 0.5f ? -0.1f : 0.1f;
    params.render.region_width = params.render.region_height = 1;
    refocus_render_settings(engine->renderer, &params, &pixel);
}

static int render_all(struct engine *engine, struct comparison *c, const struct variants *variants,
                      const struct input *input, const struct settings *settings)
{
    const struct refocus_settings lens = engine->params;
    const struct refocus_image *photo = input->photo->image;

    for (int i = 0; i < variants->count; i++) {
        const struct variant *variant = &variants->variant[i];
        struct refocus_settings *params = &engine->params;
        struct refocus_image out = *photo;
        int status = add(c, variant->label, photo, false);

        *params = variant->engine.params;
        params->render.focus_disparity = lens.render.focus_disparity;
        params->render.max_blur_radius = lens.render.max_blur_radius;
        engine->still_rays = variant->engine.still_rays;
        engine->field_disparity = variant->engine.field_disparity;
        if (status == EXIT_DONE)
            status = papers_place(&variant->settings.papers, params, photo->width, photo->height);
        if (status != EXIT_DONE)
            return status;
        shot_suit_papers(input, &settings->lens, &variant->settings.papers, params);
        out.plane[0] = c->item[c->count - 1].rgb;
        out.stride[0] = (ptrdiff_t)photo->width * 3;
        report_progress(refocus_method_name(params->render.method), (i + 0.5) / variants->count);
        warm_up(engine);
        status = engine_render(engine, &out, (int)settings->engine.repeat);
        if (status != EXIT_DONE)
            return status;
        c->item[c->count - 1].ms = engine->render_ms;
        c->item[c->count - 1].cpu_ms = engine->cpu_ms;
        c->item[c->count - 1].memory = memory_of(engine, photo, params->render.method);
    }
    return EXIT_DONE;
}

static int write_crops(const struct comparison *c, const uint16_t *disparity, const char *output)
{
    struct refocus_image picture = compare_picture(c, disparity);
    const int status = picture.plane[0] ? output_write_image(output, &picture, NULL)
                                        : report_failure(EXIT_FAILED, output, "not enough memory");

    free(picture.plane[0]);
    return status;
}

static int compare(struct engine *engine, struct input *input, struct comparison *c,
                   const struct settings *settings, const struct variants *variants)
{
    const struct refocus_image *photo = input->photo->image;
    const struct refocus_disparity disparity = refocus_disparity16(
        input->disparity, input->width, input->height, (ptrdiff_t)input->width * 2);
    struct refocus_scene scene = input_scene(input, &disparity);
    const size_t pixels = (size_t)photo->width * (size_t)photo->height;
    uint16_t *prepared = malloc(pixels * 2);
    uint8_t *mask = malloc(pixels);
    double blur = 0, focus = 0;
    int status, border = 0;

    engine->places_edges = input_has_edges_placed(input, &settings->depth);
    scene.depth_edges = engine->places_edges;
    engine->has_matte = input->matte.samples != NULL;
    engine->deep = input->deep.plane[0] != NULL;
    engine->light = input->light;
    status = prepared && mask ? input_blur(input, &settings->lens, &blur)
                              : report_failure(EXIT_FAILED, "compare", "not enough memory");
    if (status == EXIT_DONE)
        status = engine_create(engine, &settings->engine, photo->width, photo->height, blur);
    if (status == EXIT_DONE)
        status = engine_prepare(engine, &scene);
    if (status == EXIT_DONE) {
        refocus_get_view(engine->renderer, REFOCUS_VIEW_DISPARITY, prepared,
                         (ptrdiff_t)photo->width * 2);
        status = input_focus(input, &settings->lens, prepared, &focus);
        engine->params.render.focus_disparity = (float)focus;
        border = isnan(settings->border) ? (int)ceil(blur) : (int)settings->border;
    }
    if (status == EXIT_DONE)
        status = check_border(c, border);
    if (status == EXIT_DONE)
        status = add(c, "photo", photo, true);
    if (status == EXIT_DONE)
        status = render_all(engine, c, variants, input, settings);
    if (status == EXIT_DONE &&
        quality_edge_mask(prepared, c->width, c->height, focus, blur, mask) != 0)
        status = report_failure(EXIT_FAILED, "compare", "not enough memory");
    if (status == EXIT_DONE)
        status = score(c, mask, border);
    report_progress_end();
    if (status == EXIT_DONE && settings->output)
        status = write_crops(c, prepared, settings->output);
    if (status == EXIT_DONE)
        status = compare_report(c, engine, input->photo_name, settings->reference, border,
                                settings->engine.json);
    free(prepared);
    free(mask);
    return status;
}

/* All methods are compared on the same photo by one renderer, made for what any of them asks for.
 * Returns the largest blur that all can render. */
static double settle_methods(struct engine *engine, struct settings *settings,
                             struct variants *variants)
{
    double most_blur = REFOCUS_MAX_BLUR_RADIUS;

    settings->depth.light = true;
    for (int i = 0; i < variants->count; i++) {
        struct variant *variant = &variants->variant[i];
        struct refocus_settings *params = &variant->engine.params;

        engine->methods |= variant->engine.methods;
        engine->params.thin.enabled |= params->thin.enabled;
        if (params->render.inpaint == REFOCUS_INPAINT_TEXTURED)
            engine->params.render.inpaint = REFOCUS_INPAINT_TEXTURED;
        settings->depth.light &= engine_draws_light(params);
        params->render.dither =
            settings->depth.no_dither ? REFOCUS_DITHER_OFF : REFOCUS_DITHER_ORDERED;
        most_blur = fmin(most_blur, engine_most_blur(&variant->settings));
    }
    return most_blur;
}

static int run(int argc, char **argv)
{
    struct settings settings = {.depth = DEPTH_SETTINGS_NONE,
                                .lens = LENS_SETTINGS_NONE,
                                .engine = ENGINE_SETTINGS_NONE(QUALITY_STANDARD, 1),
                                .border = NAN};
    struct comparison comparison = {0};
    struct refocus_photo *reference = NULL;
    struct engine engine;
    struct input input = {0};
    struct variants variants = {0};
    const char *files[2];
    double most_blur;
    int status;

    settings.engine.method = -1; /* several: options of any may be given */
    status = options_parse(&compare_command, argc, argv, &settings, files);
    settings.engine.method = REFOCUS_METHOD_SWEEP;
    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings, files[0]);
    if (status != EXIT_DONE)
        return status;
    status = engine_begin(&engine, &settings.engine);
    engine.name = files[0];
    if (status == EXIT_DONE)
        status = variants_begin(&variants, settings.methods, &settings.engine);
    most_blur = settle_methods(&engine, &settings, &variants);
    if (status == EXIT_DONE)
        status = input_read(&input, files[0], &settings.depth);
    input.most_blur = most_blur;
    if (status == EXIT_DONE)
        status = read_reference(&reference, settings.reference, input.photo->image);
    if (status == EXIT_DONE) {
        comparison.width = input.photo->image->width;
        comparison.height = input.photo->image->height;
        status = add(&comparison, "reference", reference->image, true);
    }
    if (status == EXIT_DONE)
        status = compare(&engine, &input, &comparison, &settings, &variants);
    report_progress_end();
    for (int i = 0; i < comparison.count; i++)
        free(comparison.item[i].rgb);
    refocus_photo_free(&reference);
    variants_end(&variants);
    engine_end(&engine);
    input_free(&input);
    return status;
}

const struct command compare_command = {
    .name = "compare",
    .usage = "PHOTO --reference GT [options]",
    .summary = "render with several methods and score them against a reference picture",
    .notes = "PSNR and RMSE are of the 8-bit values, SSIM of their luma; the edge PSNR "
             "is of the pixels within reach of a depth edge of two pixels of blur or "
             "more. The row 'photo' is the untouched photo. The times are of rendering "
             "alone; MiB is all that a renderer for the one method takes.",
    .table = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
