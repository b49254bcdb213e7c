/* engine.c: a renderer is made, prepared and timed by the options of the command line. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <refocus/platform/file.h>
#include "shot/engine.h"
#include "line/interrupt.h"
#include "shot/spool.h"

const struct option_word engine_quality_words[] = {
    {"preview", "32 rays, thin structures gathered by them"},
    {"standard", "64 rays, thin structures splatted"},
    {"best", "128 rays, thin structures splatted, texture continued behind them"},
    [QUALITY_AUTO] = {"auto", "standard, but more rays, up to 256, where they would lie farther "
                              "apart than at a blur of 20 pixels"},
    {0}};

static const struct {
    int rays;
    bool thin, textured;
} qualities[] = {
    {32, false, false}, {64, true, false}, {128, true, true}, [QUALITY_AUTO] = {64, true, false}};

const struct option_word engine_fill_words[] = {
    {"auto", "textured with --quality best, else smooth"},
    {"smooth", "from the colours around"},
    {"textured", "texture and edges around are continued; takes a second or two a megapixel"},
    {0}};

const struct option_word engine_blend_words[] = {
    [REFOCUS_BLEND_LINEAR] = {"linear", "linear light by the sRGB curve"},
    [REFOCUS_BLEND_STORED] = {"stored", "stored values, as in the paper"},
    [REFOCUS_BLEND_GAMMA] = {"gamma", "gamma 2.2"},
    {0}};

static int check_aperture(uint32_t method, const struct engine_settings *settings)
{
    if (!(refocus_method_traits(method) & REFOCUS_METHOD_DISC_ONLY) ||
        bokeh_is_plain_disc(&settings->bokeh, settings->aperture))
        return EXIT_DONE;
    return report_failure(
        EXIT_WRONG, "--aperture",
        "'%s' does not go with --method %s, which knows a disc alone; leave one of them out",
        settings->aperture && strcmp(settings->aperture, "disc") != 0 ? settings->aperture
                                                                      : "such a disc",
        refocus_method_name(method));
}

int engine_begin(struct engine *engine, const struct engine_settings *settings)
{
    struct refocus_settings *params = &engine->params;
    int status;

    memset(engine, 0, sizeof *engine);
    engine->spool = -1;
    *params = refocus_settings_default(0, 0);
    params->render.method = (uint32_t)settings->method;
    params->render.blend = (uint32_t)settings->blend;
    params->render.rays =
        isnan(settings->rays) ? qualities[settings->quality].rays : (int32_t)settings->rays;
    engine->still_rays = settings->quality == QUALITY_AUTO && isnan(settings->rays);
    if (!isnan(settings->iterations))
        params->search.iterations = (int32_t)settings->iterations;
    if (!isnan(settings->sigma))
        params->render.sigma = (float)settings->sigma;
    if (!(refocus_method_traits(params->render.method) & REFOCUS_METHOD_HIGHLIGHTS))
        params->highlights.gain = 1; /* so that it is not reported */
    else if (isnan(settings->highlights) || settings->highlights == HIGHLIGHTS_ESTIMATED)
        params->highlights.estimate = 1;
    else
        params->highlights.gain = (float)settings->highlights;
    params->thin.enabled = qualities[settings->quality].thin && !settings->no_thin;
    if (settings->fill == FILL_TEXTURED ||
        (settings->fill == FILL_AUTO && qualities[settings->quality].textured))
        params->render.inpaint = REFOCUS_INPAINT_TEXTURED;
    params->search.mirror = settings->mirror;
    params->search.background = settings->background;
    engine->methods = REFOCUS_METHOD_BIT(params->render.method);
    engine->field_disparity = settings->papers.field_disparity;
    engine->has_sides = bokeh_has_sides(&settings->bokeh);
    status = bokeh_aperture(&settings->bokeh, settings->aperture, &engine->aperture);
    params->render.aperture = engine->aperture;
    if (status == EXIT_DONE)
        status = check_aperture(params->render.method, settings);
    if (status == EXIT_DONE)
        status = papers_apply(&settings->papers, params, &engine->field_map);
    if (status == EXIT_DONE)
        status = controls_apply(&settings->controls, params, &engine->controls);
    if (status == EXIT_DONE)
        status = bokeh_apply(&settings->bokeh, !isnan(settings->highlights), params);
    return status;
}

void engine_suit_rays(const struct engine *engine, struct refocus_settings *params)
{
    if (engine->still_rays && params->render.method == REFOCUS_METHOD_SWEEP)
        params->render.rays = refocus_still_rays(params->render.max_blur_radius);
}

static int interrupted(const struct engine *engine)
{
    return report_failure(EXIT_FAILED, engine->name, REPORT_INTERRUPTED);
}

double engine_most_blur(const struct engine_settings *settings)
{
    const uint32_t traits = refocus_method_traits((uint32_t)settings->method);

    return traits & REFOCUS_METHOD_ANY_RADIUS ? REFOCUS_MAX_BLUR_RADIUS : REFOCUS_PLAIN_BLUR_RADIUS;
}

int engine_create(struct engine *engine, const struct engine_settings *settings, int width,
                  int height, double blur)
{
    struct refocus_renderer_params params =
        refocus_renderer_params_default(width, height, (float)blur);
    const double start = report_clock_ms();
    int status;

    params.threads = (int32_t)settings->threads;
    params.cpu = (uint32_t)settings->cpu;
    params.papers = refocus_papers();
    params.methods = engine->methods;
    params.in_place = settings->in_strips;
    params.highlights = settings->in_strips;
    params.thin = engine->params.thin.enabled || engine->has_matte;
    params.depth_edges = engine->places_edges && !settings->in_strips;
    params.behind = engine->behind;
    params.deep = engine->deep;
    params.textured = engine->params.render.inpaint == REFOCUS_INPAINT_TEXTURED;
    engine->params.render.max_blur_radius = (float)blur;
    if (settings->memory_kib > 0 &&
        refocus_renderer_memory(&params) / 1024 > (uint64_t)settings->memory_kib)
        status = REFOCUS_ERR_MEMORY;
    else
        status = refocus_renderer_create(&engine->renderer, &params);
    engine->create_ms = report_clock_ms() - start;
    if (status == REFOCUS_ERR_UNSUPPORTED)
        return report_failure(EXIT_FAILED, "--cpu", "this processor or build has no %s; give auto",
                              refocus_cpu_name(params.cpu));
    if (status == REFOCUS_ERR_THREAD)
        return report_failure(EXIT_FAILED, "--threads",
                              "%s: memory is short, or there are too many; give fewer, or a "
                              "smaller picture",
                              refocus_strerror(status));
    engine->short_of_memory = status == REFOCUS_ERR_MEMORY && settings->memory_kib > 0;
    if (engine->short_of_memory)
        return EXIT_FAILED;
    if (status == REFOCUS_ERR_ARGUMENT)
        return report_failure(EXIT_FAILED, engine->name,
                              "%s: this command and its library, %s, do not go together; give it "
                              "the one that it was built with",
                              refocus_strerror(status), refocus_version());
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, engine->name,
                              "%s: %dx%d pixels with blur %.4g need %.0f MiB; give a "
                              "smaller picture or less blur%s",
                              refocus_strerror(status), width, height, blur,
                              (double)refocus_renderer_memory(&params) / (1 << 20),
                              settings->in_strips ? "" : ", or --low-memory where there is that");
    interrupt_watch(engine->renderer);
    engine->info = refocus_renderer_info_default();
    refocus_renderer_get_info(engine->renderer, &engine->info);
    return papers_place(&settings->papers, &engine->params, width, height);
}

int engine_prepare(struct engine *engine, const struct refocus_scene *scene)
{
    const double start = report_clock_ms();
    const int status =
        interrupt_came() ? REFOCUS_ERR_CANCELLED : refocus_prepare_scene(engine->renderer, scene);

    engine->prepare_ms = report_clock_ms() - start;
    if (status == REFOCUS_OK && scene->depth_edges) {
        engine->edges = refocus_depth_edges_report_default();
        refocus_get_depth_edges(engine->renderer, &engine->edges);
    }
    if (status == REFOCUS_ERR_CANCELLED)
        return interrupted(engine);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, engine->name, "it cannot be prepared: %s",
                              refocus_strerror(status));
    return EXIT_DONE;
}

bool engine_takes_deep(const struct refocus_settings *params)
{
    return (refocus_method_traits(params->render.method) & REFOCUS_METHOD_TAKES_DEEP) &&
           params->render.blend == REFOCUS_BLEND_LINEAR && params->render.sigma >= 1e6f &&
           params->look.grain == 0 && params->look.star_spikes == 0;
}

bool engine_draws_light(const struct refocus_settings *params)
{
    return engine_takes_deep(params) &&
           (refocus_method_traits(params->render.method) & REFOCUS_METHOD_HIGHLIGHTS);
}

void engine_add_grain(struct engine *engine, const struct engine_settings *settings)
{
    if (isnan(settings->bokeh.grain) && !engine->deep)
        engine->params.look.grain = 1;
}

/* Render whole, or, where that is slow and somebody watches, or into a file, in strips of rows. The
 * progress goes from begin by share. */
static int render_strips(struct engine *engine, const struct refocus_image *out, double begin,
                         double share)
{
    enum { STRIPS = 20, SPOOLED = 4 };
    const bool spools = engine->spool >= 0;
    const bool strips = report_is_watched() && out->height >= STRIPS &&
                        engine->params.render.method == REFOCUS_METHOD_RAYTRACE;
    const int count = strips ? STRIPS : spools ? SPOOLED : 1;
    int status = REFOCUS_OK;

    for (int i = 0; i < count && status == REFOCUS_OK; i++) {
        const int y0 = (int)((int64_t)out->height * i / count);
        const int y1 = (int)((int64_t)out->height * (i + 1) / count);
        struct refocus_settings params = engine->params;
        struct refocus_image strip = *out;

        report_progress("rendering", begin + share * i / count);
        if (interrupt_came())
            return REFOCUS_ERR_CANCELLED;
        params.render.region_y += y0;
        params.render.region_width = strip.width;
        params.render.region_height = strip.height = y1 - y0;
        strip.plane[0] += spools ? 0 : y0 * strip.stride[0];
        status = refocus_render_settings(engine->renderer, &params, &strip);
        if (status == REFOCUS_OK && spools &&
            spool_put(engine->spool, engine->name, out->height, &strip) != EXIT_DONE)
            return REFOCUS_ERR_IO;
    }
    return status;
}

/* Light by a gain map goes back into the tones of the photo where 8 bits are asked for. */
static int render_once(struct engine *engine, const struct refocus_image *out, double begin,
                       double share)
{
    const size_t stride = 6 * (size_t)out->width;
    struct refocus_image light;
    int status;

    if (!engine->light || out->format != REFOCUS_FORMAT_RGB8)
        return render_strips(engine, out, begin, share);
    light = refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, malloc(stride * (size_t)out->height),
                                 out->width, out->height, (ptrdiff_t)stride);
    status = light.plane[0] ? render_strips(engine, &light, begin, share) : REFOCUS_ERR_MEMORY;
    if (status == REFOCUS_OK)
        status = refocus_light_to_base(engine->light, &light, engine->params.render.region_x,
                                       engine->params.render.region_y, engine->params.render.dither,
                                       out);
    free(engine->rendered.plane[0]);
    engine->rendered.plane[0] = NULL;
    if (status == REFOCUS_OK && engine->keeps_light)
        engine->rendered = light;
    else
        free(light.plane[0]);
    return status;
}

int engine_render(struct engine *engine, const struct refocus_image *out, int repeat)
{
    const float focus = engine->params.render.focus_disparity;
    const float beside = focus + (focus > 0.5f ? -2.0f : 2.0f) / 65535.0f;
    double *times, *cpu_times;
    int status = controls_check_method(&engine->params);

    if (status == EXIT_DONE)
        status = bokeh_check_method(&engine->params, engine->has_sides);
    if (status != EXIT_DONE)
        return status;
    times = malloc(2 * (size_t)repeat * sizeof *times);
    if (!times)
        return report_failure(EXIT_FAILED, "--repeat", "not enough memory; give less");
    cpu_times = times + repeat;
    engine_suit_rays(engine, &engine->params);
    engine->params.field.disparity = isnan(engine->field_disparity)
                                         ? engine->params.render.focus_disparity
                                         : (float)engine->field_disparity;
    for (int i = 0; i < repeat && status == REFOCUS_OK; i++) {
        const double start = report_clock_ms(), cpu_start = report_cpu_ms();

        /* every other one is a step of disparity off, or all but rays would be kept */
        engine->params.render.focus_disparity = (repeat - i) % 2 ? focus : beside;
        status = render_once(engine, out, 0.3 + 0.6 * i / repeat, 0.6 / repeat);
        cpu_times[i] = report_cpu_ms() - cpu_start;
        times[i] = report_clock_ms() - start;
    }
    engine->params.render.focus_disparity = focus;
    if (status == REFOCUS_OK) {
        engine->render_ms = report_spread(times, repeat);
        engine->cpu_ms = report_spread(cpu_times, repeat);
    }
    free(times);
    if (status == REFOCUS_ERR_CANCELLED)
        return interrupted(engine);
    if (status == REFOCUS_ERR_IO)
        return EXIT_FAILED; /* spool_put() has said why */
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, engine->name, "it cannot be rendered: %s",
                              refocus_strerror(status));
    return EXIT_DONE;
}

void engine_end(struct engine *engine)
{
    interrupt_watch(NULL);
    refocus_renderer_destroy(&engine->renderer);
    refocus_aperture_destroy(&engine->aperture);
    free(engine->rendered.plane[0]);
    if (engine->spool >= 0)
        close(engine->spool);
    free((void *)engine->field_map.samples);
    controls_free(&engine->controls);
}

json_t *engine_json(const struct engine *engine)
{
    const struct refocus_settings *params = &engine->params;
    json_t *rays = params->render.rays == REFOCUS_RAYS_FULL ? json_string("full")
                                                            : json_integer(params->render.rays);

    return json_pack(
        "{s:s, s:o, s:s, s:o, s:o, s:i, s:f, s:f, s:i, s:s, s:f, s:f, s:o, s:o, s:I, s:I}",
        "method", refocus_method_name(params->render.method), "rays", rays, "blend",
        engine_blend_words[params->render.blend].name, "sigma",
        params->render.sigma < 1e30f ? json_real(params->render.sigma) : json_string("off"),
        "highlights",
        params->highlights.estimate > 0 ? json_string("auto")
                                        : json_real((double)params->highlights.gain),
        "iterations", (int)params->search.iterations, "blur",
        (double)params->render.max_blur_radius, "focus", (double)params->render.focus_disparity,
        "threads", (int)engine->info.threads, "cpu", refocus_cpu_name(engine->info.cpu),
        "create_ms", engine->create_ms, "prepare_ms", engine->prepare_ms, "render_ms",
        report_spread_json(engine->render_ms), "cpu_ms", report_spread_json(engine->cpu_ms),
        "renderer_bytes", (json_int_t)engine->info.memory, "peak_rss_kib",
        (json_int_t)report_peak_rss_kib());
}
