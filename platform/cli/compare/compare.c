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
    struct shot_settings shot;
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
    GROUP(depth_file_options, struct settings, shot.depth),
    GROUP(depth_unit_options, struct settings, shot.depth),
    GROUP(upsample_options, struct settings, shot.depth),
    GROUP(limit_options, struct settings, shot.depth.limits),
    GROUP(depth_edges_options, struct settings, shot.depth),
    GROUP(orient_depth_options, struct settings, shot.depth),
    GROUP(matte_options, struct settings, shot.depth),
    GROUP(light_options, struct settings, shot.depth),
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
    GROUP(focus_options, struct settings, shot.lens),
    GROUP(lens_options, struct settings, shot.lens),
    {.kind = OPTION_HEADING, .help = "Rendering"},
    GROUP(ray_options, struct settings, shot.engine),
    QUALITY_OPTION(struct settings, shot.engine.quality, "standard", NULL),
    GROUP(rendering_options, struct settings, shot.engine),
    {.kind = OPTION_HEADING, .help = "Running"},
    GROUP(run_options, struct settings, shot.engine),
    GROUP(repeat_options, struct settings, shot.engine),
    GROUP(paper_options, struct settings, shot.engine),
    {.help = NULL},
};

static int check(struct settings *settings, const char *photo)
{
    const char *inputs[SHOT_INPUTS + 1];
    int count = shot_inputs(&settings->shot, photo, inputs);
    int status = shot_check(&settings->shot, false);

    inputs[count++] = settings->reference;
    if (status == EXIT_DONE && !settings->reference)
        status = report_failure(EXIT_WRONG, "--reference",
                                "there is nothing to compare with; give --reference GT");
    if (status == EXIT_DONE && settings->output)
        status = output_check(settings->output, OUTPUT_PICTURE, NULL, inputs, count);
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

static uint64_t memory_of(const struct shot *shot, uint32_t method)
{
    const struct engine *engine = &shot->engine;
    const struct refocus_image *photo = shot->input.photo->image;
    struct refocus_renderer_params params = refocus_renderer_params_default(
        photo->width, photo->height, engine->params.render.max_blur_radius);

    params.threads = engine->info.threads;
    params.papers = refocus_papers();
    params.methods = REFOCUS_METHOD_BIT(method);
    params.thin = engine->params.thin.enabled || engine->has_matte;
    params.deep = shot->deep;
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

static int render_all(struct shot *shot, struct comparison *c, const struct variants *variants,
                      const struct settings *settings)
{
    struct engine *engine = &shot->engine;
    const struct refocus_settings lens = engine->params;
    const struct refocus_image *photo = shot->input.photo->image;

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
        shot_suit_papers(&shot->input, &settings->shot.lens, &variant->settings.papers, params);
        out.plane[0] = c->item[c->count - 1].rgb;
        out.stride[0] = (ptrdiff_t)photo->width * 3;
        report_progress(refocus_method_name(params->render.method), (i + 0.5) / variants->count);
        status = shot_suit(shot);
        if (status != EXIT_DONE)
            return status;
        warm_up(engine);
        status = engine_render(engine, &out, (int)settings->shot.engine.repeat);
        if (status != EXIT_DONE)
            return status;
        c->item[c->count - 1].ms = engine->render_ms;
        c->item[c->count - 1].cpu_ms = engine->cpu_ms;
        c->item[c->count - 1].memory = memory_of(shot, params->render.method);
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

/* The variant that takes most of the photo: of the others some may take 8 bits. */
static const struct variant *deepest(const struct variants *variants)
{
    const struct variant *best = &variants->variant[0];

    for (int i = 1; i < variants->count; i++) {
        const struct refocus_settings *params = &variants->variant[i].engine.params;

        if (engine_takes_deep(params) + engine_draws_light(params) >
            engine_takes_deep(&best->engine.params) + engine_draws_light(&best->engine.params))
            best = &variants->variant[i];
    }
    return best;
}

/* All methods are compared on the same photo by one renderer, made for what any of them asks for.
 * Sets the largest blur that all can render. */
static void settle_methods(struct shot *shot, struct variants *variants,
                           const struct settings *settings)
{
    struct engine *engine = &shot->engine;

    shot->input.most_blur = REFOCUS_MAX_BLUR_RADIUS;
    for (int i = 0; i < variants->count; i++) {
        struct variant *variant = &variants->variant[i];
        struct refocus_settings *params = &variant->engine.params;

        engine->methods |= variant->engine.methods;
        engine->params.thin.enabled |= params->thin.enabled;
        if (params->render.inpaint == REFOCUS_INPAINT_TEXTURED)
            engine->params.render.inpaint = REFOCUS_INPAINT_TEXTURED;
        params->render.dither =
            settings->shot.depth.no_dither ? REFOCUS_DITHER_OFF : REFOCUS_DITHER_ORDERED;
        shot->input.most_blur = fmin(shot->input.most_blur, engine_most_blur(&variant->settings));
    }
}

/* The photo is prepared: render, score and report. */
static int compare(struct shot *shot, struct comparison *c, const struct settings *settings,
                   const struct variants *variants)
{
    const struct refocus_image *photo = shot->input.photo->image;
    const struct refocus_render_params *lens = &shot->engine.params.render;
    const double focus = (double)lens->focus_disparity, blur = (double)lens->max_blur_radius;
    const int border = isnan(settings->border) ? (int)ceil(blur) : (int)settings->border;
    const size_t pixels = (size_t)photo->width * (size_t)photo->height;
    uint16_t *prepared = malloc(pixels * 2);
    uint8_t *mask = malloc(pixels);
    int status = prepared && mask ? check_border(c, border)
                                  : report_failure(EXIT_FAILED, "compare", "not enough memory");

    if (status == EXIT_DONE)
        refocus_get_view(shot->engine.renderer, REFOCUS_VIEW_DISPARITY, prepared,
                         (ptrdiff_t)photo->width * 2);
    if (status == EXIT_DONE)
        status = add(c, "photo", photo, true);
    if (status == EXIT_DONE)
        status = render_all(shot, c, variants, settings);
    if (status == EXIT_DONE &&
        quality_edge_mask(prepared, c->width, c->height, focus, blur, mask) != 0)
        status = report_failure(EXIT_FAILED, "compare", "not enough memory");
    if (status == EXIT_DONE)
        status = score(c, mask, border);
    report_progress_end();
    if (status == EXIT_DONE && settings->output)
        status = write_crops(c, prepared, settings->output);
    if (status == EXIT_DONE)
        status = compare_report(c, &shot->engine, shot->input.photo_name, settings->reference,
                                border, settings->shot.engine.json);
    free(prepared);
    free(mask);
    return status;
}

/* The photo and the reference are read, and the photo is prepared for all methods. */
static int open_photo(struct shot *shot, const char *photo, struct comparison *c,
                      struct refocus_photo **reference, const struct settings *settings,
                      struct variants *variants)
{
    struct shot_settings wanted = settings->shot;
    int status;

    wanted.engine = deepest(variants)->settings;
    shot_suit_output(&wanted.depth, NULL);
    status = shot_begin(shot, photo, &wanted);
    if (status == EXIT_DONE)
        status = read_reference(reference, settings->reference, shot->input.photo->image);
    if (status == EXIT_DONE) {
        c->width = shot->input.photo->image->width;
        c->height = shot->input.photo->image->height;
        status = add(c, "reference", (*reference)->image, true);
    }
    settle_methods(shot, variants, settings);
    return status == EXIT_DONE ? shot_prepare(shot, &wanted, 0) : status;
}

static int run(int argc, char **argv)
{
    struct settings settings = {.shot = SHOT_SETTINGS_NONE, .border = NAN};
    struct comparison comparison = {0};
    struct refocus_photo *reference = NULL;
    struct shot shot = {.engine = {.spool = -1}};
    struct variants variants = {0};
    const char *files[2];
    int status;

    settings.shot.engine.quality = QUALITY_STANDARD;
    settings.shot.engine.bokeh.grain = 0; /* the reference's is another */
    settings.shot.engine.method = -1;     /* several: options of any may be given */
    status = options_parse(&compare_command, argc, argv, &settings, files);
    settings.shot.engine.method = REFOCUS_METHOD_SWEEP;
    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings, files[0]);
    if (status != EXIT_DONE)
        return status;
    status = variants_begin(&variants, settings.methods, &settings.shot.engine);
    if (status == EXIT_DONE)
        status = open_photo(&shot, files[0], &comparison, &reference, &settings, &variants);
    if (status == EXIT_DONE)
        status = compare(&shot, &comparison, &settings, &variants);
    report_progress_end();
    for (int i = 0; i < comparison.count; i++)
        free(comparison.item[i].rgb);
    refocus_photo_free(&reference);
    variants_end(&variants);
    shot_close(&shot);
    return status;
}

const struct command compare_command = {
    .name = "compare",
    .usage = "PHOTO --reference GT [options]",
    .summary = "render with several methods and score them against a reference picture",
    .notes = "PSNR and RMSE are of the 8-bit values, SSIM of their luma; the edge PSNR "
             "is of the pixels within reach of a depth edge of two pixels of blur or "
             "more. The row 'photo' is the untouched photo. The times are of rendering "
             "alone; MiB is all that a renderer for the one method takes. Pictures are those of "
             "render with --grain off; of a photo of more than 8 bits each method takes what it "
             "can.",
    .table = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
