/* papers.c: the options of the methods from papers become their parameters. */
#include <stdlib.h>
#include <string.h>
#include <refocus/platform/file.h>
#include "shot/papers.h"
#include "inputs/limits.h"
#include "line/report.h"

const struct option_word papers_spread_words[] = {{"uniform", NULL}, {"lommel", NULL}, {0}};
const struct option_word papers_field_words[] = {{"lens", NULL},
                                                 {"cylinder", NULL},
                                                 {"plus", NULL},
                                                 {"plane", NULL},
                                                 {"sphere", NULL},
                                                 {"picture", NULL},
                                                 {0}};
const struct option_word papers_solver_words[] = {{"series", NULL}, {"steps", NULL}, {0}};

uint8_t *papers_read_grey(const char *file, int *width, int *height)
{
    struct refocus_reason reason = {""};
    struct refocus_photo *photo = NULL;
    uint8_t *grey = NULL;
    const int status = refocus_photo_read(&photo, file, limits_taken(), &reason);

    if (status != REFOCUS_OK || !photo->image->plane[0]) {
        report_failure(EXIT_FAILED, file, "%s",
                       reason.text[0] ? reason.text : "it is not a grey picture");
        goto end;
    }
    const struct refocus_image *image = photo->image;
    *width = image->width;
    *height = image->height;
    grey = malloc((size_t)image->width * (size_t)image->height);
    if (!grey) {
        report_failure(EXIT_FAILED, file, "not enough memory");
        goto end;
    }
    for (int y = 0; y < image->height; y++) {
        const uint8_t *row = image->plane[0] + y * image->stride[0];

        for (int x = 0; x < image->width; x++) /* luma, exact for grey pixels */
            grey[(size_t)y * (size_t)image->width + (size_t)x] =
                (uint8_t)((54 * row[3 * x] + 183 * row[3 * x + 1] + 19 * row[3 * x + 2]) >> 8);
    }
end:
    refocus_photo_free(&photo);
    return grey;
}

static void take(float *to, double from)
{
    if (!isnan(from))
        *to = (float)from;
}

static int read_map(const struct paper_settings *settings, struct refocus_settings *params,
                    struct refocus_disparity *map)
{
    int width, height;
    uint8_t *grey;

    if (settings->field != REFOCUS_FIELD_PICTURE) {
        if (settings->field_map)
            return report_failure(EXIT_WRONG, "--field-map",
                                  "it goes with --field picture; give that too");
        return EXIT_DONE;
    }
    if (!settings->field_map)
        return report_failure(EXIT_WRONG, "--field",
                              "picture needs one; give a grey picture to --field-map");
    grey = papers_read_grey(settings->field_map, &width, &height);
    if (!grey)
        return EXIT_FAILED;
    if (width > REFOCUS_MAX_SIDE || height > REFOCUS_MAX_SIDE) {
        free(grey);
        return report_failure(EXIT_FAILED, settings->field_map,
                              "%dx%d pixels are too many; give at most %d a side", width, height,
                              (int)REFOCUS_MAX_SIDE);
    }
    *map = refocus_disparity8(grey, width, height, width);
    params->field.map = map;
    return EXIT_DONE;
}

int papers_apply(const struct paper_settings *settings, struct refocus_settings *params,
                 struct refocus_disparity *map)
{
    const struct paper_settings *s = settings;

    if (s->star == 1)
        return report_failure(EXIT_WRONG, "--star",
                              "'1' cannot be used; give 0 for none, or 2 to 16 spikes");
    if (s->middle_ratio >= s->last_ratio)
        return report_failure(EXIT_WRONG, "--middle-ratio",
                              "%g is not below --last-ratio %g; give the smaller "
                              "number to --middle-ratio",
                              s->middle_ratio, s->last_ratio);
    params->jittered.cell = isnan(s->cell) ? params->jittered.cell : (int32_t)s->cell;
    if (!isnan(s->seed))
        params->jittered.seed = params->look.grain_seed = (uint32_t)s->seed;
    params->scatter.spread = (uint32_t)s->spread;
    take(&params->scatter.airy_radius, s->airy_radius);
    take(&params->scatter.depth_ratio, s->depth_ratio);
    params->look.star_spikes = isnan(s->star) ? 0 : (int32_t)s->star;
    take(&params->look.star_length, s->star_length);
    take(&params->look.star_angle, s->star_angle);
    take(&params->look.star_strength, s->star_strength);
    take(&params->interpolated.sharp_radius, s->sharp_radius);
    take(&params->interpolated.middle_ratio, s->middle_ratio);
    take(&params->interpolated.last_ratio, s->last_ratio);
    take(&params->foveated.angle, s->attention_angle);
    take(&params->foveated.picture_angle, s->picture_angle);
    take(&params->foveated.depth, s->attention_depth);
    params->field.shape = (uint32_t)s->field;
    take(&params->field.radius, s->field_radius);
    take(&params->field.falloff, s->field_falloff);
    take(&params->field.angle, s->field_angle);
    params->diffusion.layers = isnan(s->layers) ? params->diffusion.layers : (int32_t)s->layers;
    params->diffusion.solver = (uint32_t)s->solver;
    take(&params->diffusion.conductivity, s->conductivity);
    return read_map(settings, params, map);
}

/* A pixel's place along a side, 0 to 1; one beyond the picture is taken for its border. */
static float part_of(double at, int side)
{
    return (float)(side > 1 ? fmin(fmax(at / (side - 1), 0), 1) : 0.5);
}

static int place(const char *name, const double at[2], int width, int height, float *x, float *y)
{
    if (isnan(at[0]))
        return EXIT_DONE;
    if (at[0] > width - 1 || at[1] > height - 1)
        return report_failure(EXIT_WRONG, name,
                              "%g,%g lies outside of the picture; give 0,0 to %d,%d", at[0], at[1],
                              width - 1, height - 1);
    *x = part_of(at[0], width);
    *y = part_of(at[1], height);
    return EXIT_DONE;
}

void papers_suit(const struct paper_settings *settings, const double looked_at[2], int width,
                 int height, struct refocus_settings *params)
{
    if (!isnan(settings->attention[0]) || isnan(looked_at[0]))
        return;
    params->foveated.x = part_of(looked_at[0], width);
    params->foveated.y = part_of(looked_at[1], height);
}

int papers_place(const struct paper_settings *settings, struct refocus_settings *params, int width,
                 int height)
{
    const int status = place("--attention", settings->attention, width, height, &params->foveated.x,
                             &params->foveated.y);

    if (status != EXIT_DONE)
        return status;
    return place("--field-at", settings->field_at, width, height, &params->field.x,
                 &params->field.y);
}
