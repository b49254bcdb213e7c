/* open.c: a photo is opened for the page, which is told of it. */
#include <stdlib.h>
#include <string.h>
#include "inputs/painted.h"
#include "outputs/outputs.h"
#include "serve/serving.h"
#include "view/reduce.h"

bool serve_is_painted(const struct serving *s)
{
    return refocus_strokes_count(s->strokes) > 0;
}

const uint16_t *serve_disparity(const struct serving *s)
{
    return s->strokes ? refocus_strokes_disparity(s->strokes) : s->placed;
}

/* The least whole number by which the photo is small enough. */
static int reduction_for(const struct refocus_image *photo, int64_t most_pixels, int most_side)
{
    int n = 1;

    while ((int64_t)(photo->width / n) * (photo->height / n) > most_pixels ||
           (photo->width + n - 1) / n > most_side || (photo->height + n - 1) / n > most_side)
        n++;
    return n;
}

static int no_memory(const struct serving *s)
{
    return report_failure(EXIT_FAILED, s->work->name, "not enough memory");
}

static int read_depth(struct serving *s)
{
    struct input *const input = &s->input;

    s->has_depth = input->disparity != NULL;
    if (s->has_depth)
        return input_placed(input, &s->base.depth, &s->placed);
    painted_begin(input, &s->base.depth);
    s->placed = calloc((size_t)input->width * (size_t)input->height, sizeof *s->placed);
    return s->placed ? EXIT_DONE : no_memory(s);
}

int serve_open(struct serving *s)
{
    int status = input_read(&s->input, s->work->photo, &s->base.depth);

    s->input.most_blur = REFOCUS_PLAIN_BLUR_RADIUS; /* the page may change the method */
    if (status == EXIT_DONE)
        status = read_depth(s);
    return status == EXIT_DONE ? serve_reduce(s) : status;
}

int serve_reduce(struct serving *s)
{
    const struct refocus_image *const photo = s->input.photo->image;
    size_t pixels;

    s->reduction = reduction_for(photo, SERVE_QUICK_PIXELS, SERVE_QUICK_SIDE);
    s->width = (photo->width + s->reduction - 1) / s->reduction;
    s->height = (photo->height + s->reduction - 1) / s->reduction;
    pixels = (size_t)s->width * (size_t)s->height;
    s->small_photo = malloc(3 * pixels);
    s->small_disparity = malloc(2 * pixels);
    if (!s->small_photo || !s->small_disparity)
        return no_memory(s);
    rf_reduce_photo(photo, s->reduction, s->small_photo);
    s->small_stale = s->full_stale = true;
    return EXIT_DONE;
}

/* The looks, each a change of the settings. */
static json_t *looks_json(void)
{
    json_t *const list = json_array();
    const char *name;

    for (uint32_t i = 0; (name = bokeh_preset_name(i)) != NULL; i++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:{s:s}}", "name", name, "summary",
                                              bokeh_preset_summary(i), "settings", "bokeh", name));
    return list;
}

json_t *serve_range_json(const struct serving *s)
{
    const size_t pixels =
        (size_t)s->input.photo->image->width * (size_t)s->input.photo->image->height;
    const uint16_t *const disparity = serve_disparity(s);
    uint16_t least = 65535, most = 0;

    if (!s->has_depth && !serve_is_painted(s))
        return json_null();
    for (size_t i = 0; i < pixels; i++) {
        least = disparity[i] < least ? disparity[i] : least;
        most = disparity[i] > most ? disparity[i] : most;
    }
    return json_pack("[f, f]", least / 65535.0, most / 65535.0);
}

static bool has_metres(const struct serving *s)
{
    return s->input.report.near_m > 0 && s->input.report.far_m > s->input.report.near_m;
}

enum { WIDEST = 1, NARROWEST = 22 }; /* f-numbers */

static json_t *limits_json(const struct serving *s)
{
    return json_pack("{s:i, s:o, s:[i, i], s:i}", "blur", (int)REFOCUS_PLAIN_BLUR_RADIUS,
                     "f_number",
                     has_metres(s) ? json_pack("[i, i]", WIDEST, NARROWEST) : json_null(),
                     "highlights", 1, 16, "pull_seconds", SERVE_PULL_SECONDS);
}

/* The blur of f/1, by which others have 1 / f-number of it; NAN: there are no f-numbers. */
static double blur_of_f1(const struct serving *s)
{
    struct lens_settings wide = s->base.lens;
    double most, number;

    wide.blur = NAN;
    wide.f_number = WIDEST;
    if (!has_metres(s) || input_blur_and_f_number(&s->input, &wide, &most, &number) != EXIT_DONE)
        return NAN;
    return number * most;
}

/* The f-number that has a blur, in tenths; NAN: none does, or it is beyond the limits. */
static double f_number_of(const struct serving *s, double blur)
{
    const double number = blur > 0 ? round(10 * blur_of_f1(s) / blur) / 10 : NAN;

    return number >= WIDEST && number <= NARROWEST ? number : NAN;
}

/* The settings to begin with. */
static json_t *settings_json(const struct serving *s, const struct engine *engine, double blur)
{
    const double number = f_number_of(s, blur);

    return json_pack("{s:f, s:f, s:s, s:i, s:s, s:s, s:s}", "focus",
                     (double)engine->params.render.focus_disparity,
                     isnan(number) ? "blur" : "f-number", isnan(number) ? blur : number,
                     "highlights", "auto", "focus-width", 0, "bokeh", bokeh_preset_name(0),
                     "quality", engine_quality_words[QUALITY_AUTO].name, "method",
                     refocus_method_name((uint32_t)s->base.engine.method));
}

static json_t *session_json(const struct serving *s, json_t *settings)
{
    const struct refocus_image *const photo = s->input.photo->image;
    const double number = s->input.photo->info->f_number;

    return json_pack(
        "{s:b, s:s, s:o, s:i, s:i, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "live",
        s->feed != NULL, "session", s->work->session, "name", report_text_json(s->work->name),
        "width", (int)photo->width, "height", (int)photo->height, "depth", s->has_depth, "f_number",
        number > 0 ? json_real(number) : json_null(), "f1_blur", report_number_json(blur_of_f1(s)),
        "range", serve_range_json(s), "settings", settings, "limits", limits_json(s), "presets",
        looks_json(), "films", serve_films_json());
}

void serve_answer_session(struct serving *s)
{
    struct engine engine;
    double blur = 0;
    int status = s->work->photo ? serve_open(s) : serve_live_open(s);

    if (status != EXIT_DONE) {
        answer_failure(s, ANSWER_NOT_A_PHOTO);
        return;
    }
    status = engine_begin(&engine, &s->base.engine);
    if (status == EXIT_DONE)
        status = input_blur(&s->input, &s->base.lens, &blur);
    if (status == EXIT_DONE)
        status = shot_aim(&s->input, &s->base.lens, &engine.controls, s->placed, &engine.params);
    answer_depth(s->has_depth);
    if (status == EXIT_DONE)
        answer_json(s, session_json(s, settings_json(s, &engine, blur)));
    else
        answer_failure(s, ANSWER_FAILED);
    engine_end(&engine);
}

void serve_answer_thumbnail(struct serving *s)
{
    enum { SIDE = 256 };
    struct refocus_write_options options = output_keeps(NULL);
    struct refocus_image small = {0};
    struct refocus_blob bytes = {0};
    const struct refocus_image *photo;
    int status = input_read_photo(&s->input, s->work->photo, "a photo");
    int n;

    if (status == EXIT_DONE) {
        photo = s->input.photo->image;
        n = reduction_for(photo, SIDE * SIDE, SIDE);
        small = refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, (photo->width + n - 1) / n,
                                     (photo->height + n - 1) / n,
                                     3 * (ptrdiff_t)((photo->width + n - 1) / n));
        small.plane[0] = malloc((size_t)small.stride[0] * (size_t)small.height);
        status = small.plane[0] ? EXIT_DONE : no_memory(s);
        if (status == EXIT_DONE) {
            rf_reduce_photo(photo, n, small.plane[0]);
            options.icc = s->input.photo->icc.data ? &s->input.photo->icc : NULL;
            options.quality = 80;
            status = serve_encode("jpg", &small, &options, &bytes);
        }
        free(small.plane[0]);
        answer_depth(s->input.photo->depth->samples != NULL);
    }
    if (status == EXIT_DONE)
        answer_bytes(s, "image/jpeg", "", bytes.data, bytes.size);
    else
        answer_failure(s, ANSWER_NOT_A_PHOTO);
}

void serve_answer_focus(struct serving *s, const char *bytes, size_t size)
{
    const int width = s->input.photo->image->width, height = s->input.photo->image->height;
    json_t *const root = json_loadb(bytes, size, 0, NULL);
    double x = NAN, y = NAN;

    if (json_unpack(root, "{s:F, s:F}", "x", &x, "y", &y) != 0 || !(x >= 0 && x <= 1) ||
        !(y >= 0 && y <= 1)) {
        report_failure(EXIT_WRONG, "focus", "give {\"x\": 0 to 1, \"y\": 0 to 1}");
        answer_failure(s, ANSWER_WRONG);
    } else {
        answer_json(s, json_pack("{s:f}", "focus",
                                 input_surface_at(serve_disparity(s), width, height,
                                                  (int)fmin(x * width, width - 1),
                                                  (int)fmin(y * height, height - 1))));
    }
    json_decref(root);
}
