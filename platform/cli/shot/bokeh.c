/* bokeh.c: the shape of the aperture and what a lens adds to it are made from options. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "shot/bokeh.h"
#include "shot/papers.h"
#include "line/report.h"

/* Numbers of 0 mean what they say: nothing. */
struct preset {
    const char *name, *summary;
    const char *aperture;
    double curvature, squeeze, ring, edge, edge_before, cat_eye, fringe;
    int star;
};

static const struct preset presets[] = {
    {"plain", "a perfect lens, the default", "disc", 0, 1, 0, 0, 0, 0, 0, 0},
    {"classic", "seven blades, a little curved; discs narrower in the corners", "polygon:7:90", 0.4,
     1, 0, 0.1, -0.1, 0.3, 0, 0},
    {"smooth", "discs that fade out, as behind an apodizing filter", "disc", 0, 1, 0, -1, -1, 0, 0,
     0},
    {"bubble", "discs with bright edges behind the focus", "disc", 0, 1, 0, 0.7, -0.7, 0.2, 0, 0},
    {"ring", "rings, as of a mirror lens", "disc", 0, 1, 0.45, 0, 0, 0, 0, 0},
    {"swirl", "cat's eyes that turn around the middle", "disc", 0, 1, 0, 0.35, -0.35, 0.65, 0, 0},
    {"cine", "upright ovals, as of an anamorphic lens", "disc", 0, 0.55, 0, 0, 0, 0.2, 0, 0},
    {"vintage", "six blades, bright edges with colour", "polygon:6:90", 0.25, 1, 0, 0.4, -0.4, 0.35,
     0.08, 0},
    {"heart", "hearts", "heart", 0, 1, 0, 0, 0, 0, 0, 0},
    {"star", "five-pointed stars", "star", 0, 1, 0, 0, 0, 0, 0, 0},
    {"sparkle", "spikes on highlights, as of a star filter", "disc", 0, 1, 0, 0, 0, 0, 0, 6},
};

/* The figures of --aperture; `points` is how many a figure has by default, 0 where it has none. */
static const struct figure {
    const char *name, *summary;
    uint32_t figure;
    int32_t points;
} figures[] = {
    {"heart", "a heart, its point below", REFOCUS_FIGURE_HEART, 0},
    {"star", "a star, of five points or as star:POINTS of 3 to 16", REFOCUS_FIGURE_STAR, 5},
};

enum { FIGURES = sizeof figures / sizeof *figures };

const char *bokeh_figure_name(uint32_t index)
{
    return index < FIGURES ? figures[index].name : NULL;
}

const char *bokeh_figure_summary(uint32_t index)
{
    return index < FIGURES ? figures[index].summary : NULL;
}

const char *bokeh_preset_name(uint32_t index)
{
    return index < sizeof presets / sizeof *presets ? presets[index].name : NULL;
}

const char *bokeh_preset_summary(uint32_t index)
{
    return index < sizeof presets / sizeof *presets ? presets[index].summary : NULL;
}

static double or_else(double given, double otherwise)
{
    return isnan(given) ? otherwise : given;
}

static const char *shape_of(const struct bokeh_settings *settings, const char *shape)
{
    return shape ? shape : presets[settings->preset].aperture;
}

#define POLYGON "polygon:"

/* "polygon:6" or "polygon:6:15". */
static int parse_polygon(const char *shape, struct refocus_aperture_params *params)
{
    double degrees = 0;
    long blades;
    char *end;

    errno = 0;
    blades = strtol(shape + strlen(POLYGON), &end, 10);
    if (errno == 0 && end != shape + strlen(POLYGON) && *end == ':') {
        const char *number = end + 1;

        degrees = number[strspn(number, "+-.0123456789")] == '\0' ? strtod(number, &end) : NAN;
        if (end == number)
            degrees = NAN;
    }
    if (errno != 0 || *end != '\0' || blades < 3 || blades > 16 || !isfinite(degrees))
        return report_failure(EXIT_WRONG, "--aperture",
                              "'%s' cannot be used; give polygon:BLADES or "
                              "polygon:BLADES:DEGREES with 3 to 16 blades",
                              shape);
    params->blades = (int32_t)blades;
    params->rotation_deg = fmod(degrees, 360);
    return EXIT_DONE;
}

/* A figure by its name, or where it has points by NAME:POINTS. */
static const struct figure *find_figure(const char *shape)
{
    for (size_t i = 0; i < FIGURES; i++) {
        const size_t length = strlen(figures[i].name);

        if (strncmp(shape, figures[i].name, length) == 0 &&
            (shape[length] == '\0' || (shape[length] == ':' && figures[i].points)))
            return &figures[i];
    }
    return NULL;
}

static int parse_figure(const struct figure *figure, const char *shape,
                        struct refocus_aperture_params *params)
{
    const char *number = shape + strlen(figure->name);
    char *end = NULL;
    long points = figure->points;

    if (*number == ':')
        points =
            number[1 + strspn(number + 1, "0123456789")] == '\0' ? strtol(number + 1, &end, 10) : 0;
    if (figure->points && (points < 3 || points > 16))
        return report_failure(EXIT_WRONG, "--aperture",
                              "'%s' cannot be used; give %s, or %s:POINTS with 3 to 16 points",
                              shape, figure->name, figure->name);
    params->figure = figure->figure;
    params->blades = (int32_t)points;
    return EXIT_DONE;
}

/* Reports that `option` names no shape. `or_else`: what else the option takes, as the end of the
 * list of shapes, or "". */
static int report_unknown_shape(const char *option, const char *shape, const char *or_else)
{
    char names[256] = "";

    for (size_t i = 0; i < FIGURES; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
                 i + 1 == FIGURES && !or_else[0] ? " or " : ", ", figures[i].name);
    return report_failure(
        EXIT_WRONG, option,
        "'%s' is not known; give disc, polygon:BLADES, polygon:BLADES:DEGREES%s%s", shape, names,
        or_else);
}

/* A mask out of a greyscale picture, to be freed. */
static int read_mask(const char *file, struct refocus_aperture_params *params)
{
    int width, height;
    uint8_t *mask;

    if (!strpbrk(file, "./") && access(file, F_OK) != 0)
        return report_unknown_shape("--aperture", file, " or a mask picture");
    mask = papers_read_grey(file, &width, &height);
    if (!mask)
        return EXIT_FAILED;
    params->mask = mask;
    params->mask_width = width;
    params->mask_height = height;
    params->mask_stride = width;
    if (width > REFOCUS_MAX_APERTURE_SIDE || height > REFOCUS_MAX_APERTURE_SIDE)
        return report_failure(EXIT_FAILED, file,
                              "%dx%d pixels are too many for an aperture; give at most %dx%d",
                              width, height, REFOCUS_MAX_APERTURE_SIDE, REFOCUS_MAX_APERTURE_SIDE);
    return EXIT_DONE;
}

int bokeh_check_is_shape(const char *option, const char *shape)
{
    return strcmp(shape, "disc") == 0 || strncmp(shape, POLYGON, strlen(POLYGON)) == 0 ||
                   find_figure(shape)
               ? EXIT_DONE
               : report_unknown_shape(option, shape, "");
}

static int parse_shape(const char *shape, struct refocus_aperture_params *params)
{
    const struct figure *figure = find_figure(shape);

    if (strcmp(shape, "disc") == 0)
        return EXIT_DONE;
    if (strncmp(shape, POLYGON, strlen(POLYGON)) == 0)
        return parse_polygon(shape, params);
    return figure ? parse_figure(figure, shape, params) : read_mask(shape, params);
}

/* How far the iris is open, of 1: 0 where there is no barrel. */
static int find_iris(const struct bokeh_settings *s, double *iris)
{
    *iris = 0;
    if (isnan(s->open_f_number))
        return EXIT_DONE;
    if (isnan(s->f_number))
        return report_failure(EXIT_WRONG, "--open-f-number",
                              "it goes with --f-number; give that too");
    if (s->f_number < s->open_f_number)
        return report_failure(EXIT_WRONG, "--open-f-number",
                              "f/%g is wider than that; give a number above 0, at most %g",
                              s->f_number, s->f_number);
    *iris = s->open_f_number / s->f_number;
    return EXIT_DONE;
}

static int fill_params(const struct bokeh_settings *s, struct refocus_aperture_params *params)
{
    const struct preset *preset = &presets[s->preset];
    const bool polygon = params->blades && !params->figure;
    double iris;
    const int status = find_iris(s, &iris);

    if (status != EXIT_DONE)
        return status;
    if (!polygon && !isnan(s->curvature))
        return report_failure(EXIT_WRONG, "--curvature",
                              "it needs blades; give --aperture polygon:BLADES too");
    if (!polygon && iris > 0)
        return report_failure(EXIT_WRONG, "--open-f-number",
                              "it needs blades; give --aperture polygon:BLADES too");
    params->curvature = polygon ? or_else(s->curvature, preset->curvature) : 0;
    params->opening = iris;
    params->squeeze = or_else(s->squeeze, preset->squeeze);
    params->hole = or_else(s->ring, preset->ring);
    params->edge_behind = or_else(s->edge, preset->edge);
    params->edge_before = or_else(s->edge_before, isnan(s->edge) ? preset->edge_before : -s->edge);
    return EXIT_DONE;
}

int bokeh_aperture(const struct bokeh_settings *settings, const char *shape,
                   struct refocus_aperture **aperture)
{
    struct refocus_aperture_params params = refocus_aperture_params_default();
    int status;

    shape = shape_of(settings, shape);
    status = parse_shape(shape, &params);
    if (status == EXIT_DONE)
        status = fill_params(settings, &params);
    if (status == EXIT_DONE) {
        const int made = refocus_aperture_create(aperture, &params);

        if (made == REFOCUS_ERR_ARGUMENT && params.mask)
            status = report_failure(EXIT_FAILED, shape,
                                    "no pixel of the aperture is "
                                    "open; give white where light passes");
        else if (made != REFOCUS_OK)
            status = report_failure(EXIT_FAILED, "--aperture", "%s", refocus_strerror(made));
    }
    free((void *)params.mask);
    return status;
}

bool bokeh_has_sides(const struct bokeh_settings *s)
{
    const struct preset *preset = &presets[s->preset];
    const double behind = or_else(s->edge, preset->edge);

    return or_else(s->edge_before, isnan(s->edge) ? preset->edge_before : -s->edge) != behind;
}

bool bokeh_is_plain_disc(const struct bokeh_settings *s, const char *shape)
{
    const struct preset *preset = &presets[s->preset];

    return strcmp(shape_of(s, shape), "disc") == 0 && or_else(s->squeeze, preset->squeeze) == 1 &&
           or_else(s->ring, preset->ring) == 0 && or_else(s->edge, preset->edge) == 0 &&
           !bokeh_has_sides(s);
}

int bokeh_apply(const struct bokeh_settings *s, bool highlights_given,
                struct refocus_settings *params)
{
    const struct preset *preset = &presets[s->preset];

    if (!isnan(s->highlight_stops) && highlights_given)
        return report_failure(EXIT_WRONG, "--highlight-stops",
                              "the light of highlights is given twice; give --highlights or "
                              "--highlight-stops");
    params->look.cat_eye = (float)or_else(s->cat_eye, preset->cat_eye);
    params->look.fringe = (float)or_else(s->fringe, preset->fringe);
    params->look.grain = (float)or_else(s->grain, 0);
    if (!isnan(s->highlight_stops)) {
        params->highlights.gain = (float)exp2(s->highlight_stops);
        params->highlights.estimate = 0;
    }
    if (preset->star && params->look.star_spikes == 0)
        params->look.star_spikes = preset->star;
    return EXIT_DONE;
}

/* The option of something that only sweep can do, or NULL. */
static const char *of_sweep(const struct refocus_settings *p, bool has_sides)
{
    if (p->look.cat_eye > 0)
        return "--cat-eye";
    if (p->look.fringe != 0)
        return "--fringe";
    if (has_sides)
        return "--edge";
    return p->look.star_spikes > 0 && p->render.method != REFOCUS_METHOD_SCATTER ? "--star" : NULL;
}

bool bokeh_suits_method(const struct refocus_settings *p, bool has_sides)
{
    return p->render.method == REFOCUS_METHOD_SWEEP || !of_sweep(p, has_sides);
}

int bokeh_check_method(const struct refocus_settings *p, bool has_sides)
{
    if (!bokeh_suits_method(p, has_sides))
        return report_failure(EXIT_WRONG, of_sweep(p, has_sides),
                              "it does not go with --method %s; give sweep, or leave it out",
                              refocus_method_name(p->render.method));
    if (has_sides && p->render.rays == REFOCUS_RAYS_FULL)
        return report_failure(EXIT_WRONG, "--rays",
                              "'full' does not go with discs that differ before and behind the "
                              "focus; give a whole number from 1 to %d",
                              REFOCUS_MAX_RAYS);
    return EXIT_DONE;
}
