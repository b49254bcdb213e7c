/* picture.c: pictures for the page as `refocus render` makes them. */
#include <stdlib.h>
#include <string.h>
#include "line/memory.h"
#include "outputs/outputs.h"
#include "outputs/resize.h"
#include "serve/serving.h"
#include "shot/strips.h"

static struct refocus_disparity map_of(const uint16_t *samples, int width, int height)
{
    return refocus_disparity16(samples, width, height, 2 * (ptrdiff_t)width);
}

int serve_settings(const struct serving *s, const char *bytes, size_t size,
                   struct shot_settings *settings)
{
    const int status = page_settings_read(bytes, size, &s->base, settings);

    return status == EXIT_DONE ? shot_check(settings, false) : status;
}

bool serve_has_settings(struct serving *s, const struct rf_web_ask *ask, const char *bytes,
                        struct shot_settings *settings)
{
    if (serve_settings(s, bytes, ask->bytes, settings) == EXIT_DONE)
        return true;
    answer_failure(s, ANSWER_WRONG);
    return false;
}

int serve_failed(const struct serving *s, int status)
{
    return status == REFOCUS_OK
               ? EXIT_DONE
               : report_failure(EXIT_FAILED, s->work->name, "%s", refocus_strerror(status));
}

int serve_new_picture(const struct serving *s, int width, int height, struct refocus_image *out)
{
    const uint64_t bytes = 3 * (uint64_t)width * (uint64_t)height;

    *out = refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, height, 3 * (ptrdiff_t)width);
    out->plane[0] = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    return serve_failed(s, out->plane[0] ? REFOCUS_OK : REFOCUS_ERR_MEMORY);
}

/* The lens of the settings, for the whole photo. */
int serve_lens_of(const struct serving *s, const struct shot_settings *settings,
                  struct engine *engine)
{
    const struct refocus_image *const photo = s->input.photo->image;
    struct refocus_settings *const params = &engine->params;
    double blur = 0;
    int status = input_blur(&s->input, &settings->lens, &blur);

    params->render.max_blur_radius = (float)blur;
    if (status == EXIT_DONE)
        status = papers_place(&settings->engine.papers, params, photo->width, photo->height);
    if (status == EXIT_DONE)
        status =
            shot_aim(&s->input, &settings->lens, &engine->controls, serve_disparity(s), params);
    /* Settings are refused that this photo cannot have, as metres of one without any. */
    return status == EXIT_DONE ? EXIT_DONE : EXIT_WRONG;
}

/* Whether the depth is what the photo carries: the renderer then gets it as `refocus render` gives
 * it, so that pictures are the same to the last bit. */
static bool has_own_depth(const struct serving *s)
{
    return s->has_depth && !serve_is_painted(s);
}

static bool serves(const struct made_for *made, const struct made_for *wanted)
{
    return !made->in_strips && (made->methods & wanted->methods) == wanted->methods &&
           made->thin >= wanted->thin && made->textured >= wanted->textured &&
           made->deep == wanted->deep && made->edges >= wanted->edges;
}

void serve_release_full(struct serving *s)
{
    serve_watch(NULL);
    refocus_renderer_destroy(&s->full);
    s->full_stale = true;
}

/* Leaves out what strip mode cannot do, as `refocus render` does where there is little memory. */
static void leave_out(struct engine *engine, const struct engine_settings *settings)
{
    engine->has_matte = engine->deep = engine->places_edges = false;
    engine->light = NULL;
    engine_add_grain(engine, settings);
}

/* A new renderer, in strips where one for the whole photo would take more than there is. That one
 * is for this picture's blur alone: strips overlap by what a renderer may blur, and it is soon
 * made. */
static int make_renderer(struct serving *s, const struct shot_settings *settings,
                         struct engine *engine, bool *in_strips)
{
    const struct refocus_image *const photo = s->input.photo->image;
    const int64_t most = memory_free_kib() / 4 * 3; /* the rest is for the pictures */
    const uint32_t methods = engine->methods;
    const double blur = (double)engine->params.render.max_blur_radius;
    struct engine_settings used = settings->engine;
    int status;

    *in_strips = false;
    if (!strips_suit(&used, &settings->depth, false))
        used.memory_kib = 0;
    else if (most < used.memory_kib)
        used.memory_kib = most;
    engine->methods |= s->made_for.methods;
    status = engine_create(engine, &used, photo->width, photo->height, REFOCUS_PLAIN_BLUR_RADIUS);
    if (!engine->short_of_memory)
        return status;
    *in_strips = used.in_strips = true;
    used.memory_kib = 0;
    engine->methods = methods;
    leave_out(engine, &used);
    return engine_create(engine, &used, photo->width, photo->height, blur);
}

/* Give the engine the renderer that there is, or a new one. */
static int take_renderer(struct serving *s, const struct shot_settings *settings,
                         struct engine *engine)
{
    struct made_for wanted = {.methods = engine->methods,
                              .thin = engine->params.thin.enabled != 0,
                              .textured = engine->params.render.inpaint == REFOCUS_INPAINT_TEXTURED,
                              .deep = engine->deep,
                              .edges = engine->places_edges};
    int status;

    if (s->full && serves(&s->made_for, &wanted)) {
        engine->renderer = s->full;
        s->full = NULL;
        return EXIT_DONE;
    }
    serve_release_full(s);
    status = make_renderer(s, settings, engine, &wanted.in_strips);
    wanted.methods = engine->methods;
    s->made_for = wanted;
    return status;
}

static int prepare(struct serving *s, struct engine *engine)
{
    const struct refocus_image *const photo = s->input.photo->image;
    const struct refocus_disparity full = map_of(serve_disparity(s), photo->width, photo->height);
    const struct refocus_disparity given =
        map_of(s->input.disparity, s->input.width, s->input.height);
    const bool own = has_own_depth(s) && !s->made_for.in_strips;
    struct refocus_scene scene = input_scene(&s->input, own ? &given : &full);
    int status;

    if (!s->full_stale)
        return EXIT_DONE;
    if (!engine->deep)
        scene.photo = photo;
    if (!own)
        scene.confidence = NULL;
    if (s->made_for.in_strips)
        scene.matte = NULL;
    scene.depth_edges = engine->places_edges;
    status = engine_prepare(engine, &scene);
    s->full_stale = status != EXIT_DONE;
    return status;
}

int serve_render(struct serving *s, const struct shot_settings *settings, bool keeps_light,
                 struct engine *engine, struct refocus_image *out)
{
    const struct refocus_image *const photo = s->input.photo->image;
    int status = engine_begin(engine, &settings->engine);

    out->plane[0] = NULL;
    engine->name = s->work->name;
    engine->has_matte = s->input.matte.samples != NULL;
    engine->deep = shot_takes_deep(&s->input, &engine->params);
    engine_add_grain(engine, &settings->engine);
    engine->places_edges = has_own_depth(s) && input_has_edges_placed(&s->input, &s->base.depth);
    engine->light = engine->deep ? s->input.light : NULL;
    engine->keeps_light = keeps_light;
    engine->params.render.dither =
        settings->depth.no_dither ? REFOCUS_DITHER_OFF : REFOCUS_DITHER_ORDERED;
    if (status == EXIT_DONE)
        status = serve_lens_of(s, settings, engine);
    if (status == EXIT_DONE)
        status = serve_new_picture(s, photo->width, photo->height, out);
    if (status == EXIT_DONE) {
        const float blur = engine->params.render.max_blur_radius;

        status = take_renderer(s, settings, engine);
        engine->params.render.max_blur_radius = blur;
    }
    if (status == EXIT_DONE) {
        serve_watch(engine->renderer);
        status = prepare(s, engine);
    }
    if (status == EXIT_DONE)
        status = engine_render(engine, out, 1);
    if (engine->renderer)
        s->full = engine->renderer;
    engine->renderer = NULL;
    if (status != EXIT_DONE) {
        free(out->plane[0]);
        out->plane[0] = NULL;
    }
    return status;
}

int serve_fit(const struct serving *s, int size, struct refocus_image *picture)
{
    const struct resize asked = {.width = size, .height = size};
    struct refocus_image small;
    int width = picture->width, height = picture->height, status;

    if (size > 0)
        resize_fit(&asked, picture->width, picture->height, &width, &height);
    if (width == picture->width && height == picture->height)
        return EXIT_DONE;
    status = serve_failed(s, resize_image(picture, width, height, &small));
    if (status == EXIT_DONE) {
        free(picture->plane[0]);
        *picture = small;
    }
    return status;
}

/* A JPEG with nothing in it but the colour profile, as by render --strip. */
void serve_answer_rendered(struct serving *s, int status, int size, int quality,
                           struct refocus_image *picture)
{
    struct refocus_write_options options = output_keeps(NULL);
    struct refocus_blob bytes = {0};

    options.icc = s->input.photo->icc.data ? &s->input.photo->icc : NULL;
    options.quality = quality;
    if (status == EXIT_DONE)
        status = serve_fit(s, size, picture);
    if (status == EXIT_DONE)
        status = serve_encode("jpg", picture, &options, &bytes);
    free(picture->plane[0]);
    if (status == EXIT_DONE) {
        answer_bytes(s, "image/jpeg", "", bytes.data, bytes.size);
    } else if (serve_is_replaced()) {
        report_failure(EXIT_FAILED, s->work->name, "a newer request has replaced it");
        answer_failure(s, ANSWER_REPLACED);
    } else {
        answer_failure(s, status == EXIT_WRONG ? ANSWER_WRONG : ANSWER_FAILED);
    }
}

void serve_answer_picture(struct serving *s, const struct rf_web_ask *ask, const char *bytes)
{
    struct refocus_image picture = {0};
    struct shot_settings settings;
    struct engine engine;
    int status;

    if (!serve_has_settings(s, ask, bytes, &settings))
        return;
    if (serve_is_replaced()) {
        memset(&engine, 0, sizeof engine);
        status = EXIT_FAILED;
    } else if (ask->quick) {
        status = serve_render_quick(s, &settings, &engine, &picture);
    } else {
        status = serve_render(s, &settings, false, &engine, &picture);
    }
    engine_end(&engine);
    serve_answer_rendered(s, status, ask->size, ask->quick ? SERVE_QUICK_QUALITY : 0, &picture);
}
