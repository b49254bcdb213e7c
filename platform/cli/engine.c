#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <refocus/platform/file.h>
#include "engine.h"
#include "interrupt.h"

static const struct {
    const char *name, *summary;
    int rays;
    float highlight_gain, sigma;
} qualities[] = {{"preview", "32 rays", 32, 4, 1e30f},
                 {"standard", "64 rays", 64, 4, 1e30f},
                 {"best", "128 rays, and bright samples count more (--sigma 400)", 128, 4, 400}};

static const struct {
    const char *name, *summary;
} blends[] = {
    [REFOCUS_BLEND_LINEAR] = {"linear", "linear light by the sRGB curve"},
    [REFOCUS_BLEND_STORED] = {"stored", "stored values, as in the paper"},
    [REFOCUS_BLEND_GAMMA] = {"gamma", "gamma 2.2"},
};

const char *engine_quality_name(uint32_t index)
{
    return index < sizeof qualities / sizeof *qualities ? qualities[index].name : NULL;
}

const char *engine_quality_summary(uint32_t index)
{
    return index < sizeof qualities / sizeof *qualities ? qualities[index].summary : NULL;
}

const char *engine_blend_name(uint32_t index)
{
    return index < sizeof blends / sizeof *blends ? blends[index].name : NULL;
}

const char *engine_blend_summary(uint32_t index)
{
    return index < sizeof blends / sizeof *blends ? blends[index].summary : NULL;
}

/* "polygon:6" or "polygon:6:15". */
static int polygon_aperture(struct engine *engine, const char *shape)
{
    double degrees = 0;
    long blades;
    char *end;

    errno = 0;
    blades = strtol(shape + strlen("polygon:"), &end, 10);
    if (errno == 0 && end != shape + strlen("polygon:") && *end == ':') {
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
    if (refocus_aperture_create_polygon(&engine->aperture, (int)blades, degrees) !=
        REFOCUS_OK)
        return report_failure(EXIT_FAILED, "--aperture", "not enough memory");
    return EXIT_DONE;
}

/* A mask out of a greyscale picture. */
static int mask_aperture(struct engine *engine, const char *file)
{
    int width, height, status;
    uint8_t *mask = papers_read_grey(file, &width, &height);

    if (!mask)
        return EXIT_FAILED;
    if (width > REFOCUS_MAX_APERTURE_SIDE || height > REFOCUS_MAX_APERTURE_SIDE) {
        free(mask);
        return report_failure(EXIT_FAILED, file, "%dx%d pixels are too many for an aperture; "
                              "give at most %dx%d", width, height, REFOCUS_MAX_APERTURE_SIDE,
                              REFOCUS_MAX_APERTURE_SIDE);
    }
    status = refocus_aperture_create_mask(&engine->aperture, mask, width, height, width);
    free(mask);
    if (status == REFOCUS_OK)
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, file, "%s",
                          status == REFOCUS_ERR_ARGUMENT
                              ? "no pixel of the aperture is open; give white where light passes"
                              : refocus_strerror(status));
}

static int make_aperture(struct engine *engine, const char *shape)
{
    if (strcmp(shape, "disc") == 0) {
        if (refocus_aperture_create_disc(&engine->aperture) != REFOCUS_OK)
            return report_failure(EXIT_FAILED, "--aperture", "not enough memory");
        return EXIT_DONE;
    }
    if (strncmp(shape, "polygon:", strlen("polygon:")) == 0)
        return polygon_aperture(engine, shape);
    if (!strpbrk(shape, "./") && access(shape, F_OK) != 0)
        return report_failure(EXIT_WRONG, "--aperture",
                              "'%s' is not known; give disc, polygon:BLADES, "
                              "polygon:BLADES:DEGREES or a mask picture",
                              shape);
    return mask_aperture(engine, shape);
}

/* Methods whose circles of confusion are circles. */
static int check_aperture(uint32_t method, const char *aperture)
{
    if (method < REFOCUS_METHOD_SCATTER || strcmp(aperture, "disc") == 0)
        return EXIT_DONE;
    return report_failure(EXIT_WRONG, "--aperture",
                          "'%s' does not go with --method %s, which knows a disc alone; leave "
                          "one of them out", aperture, refocus_method_name(method));
}

int engine_begin(struct engine *engine, const struct engine_settings *settings)
{
    struct refocus_render_params *params = &engine->params;
    int status;

    memset(engine, 0, sizeof *engine);
    *params = refocus_render_params_default(0, 0);
    params->method = (uint32_t)settings->method;
    params->blend = (uint32_t)settings->blend;
    params->rays = isnan(settings->rays) ? qualities[settings->quality].rays
                                         : (int32_t)settings->rays;
    if (!isnan(settings->iterations))
        params->iterations = (int32_t)settings->iterations;
    params->sigma = isnan(settings->sigma) ? qualities[settings->quality].sigma
                                           : (float)settings->sigma;
    params->highlight_gain = isnan(settings->highlights)
                                 ? qualities[settings->quality].highlight_gain
                                 : (float)settings->highlights;
    params->mirror = settings->mirror;
    params->background = settings->background;
    engine->methods = REFOCUS_METHOD_BIT(params->method);
    engine->field_disparity = settings->papers.field_disparity;
    status = make_aperture(engine, settings->aperture);
    params->aperture = engine->aperture;
    if (status == EXIT_DONE)
        status = check_aperture(params->method, settings->aperture);
    if (status == EXIT_DONE)
        status = papers_apply(&settings->papers, params, &engine->field_map);
    return status;
}

static int interrupted(const struct engine *engine)
{
    return report_failure(EXIT_FAILED, engine->name, "interrupted; nothing was written");
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
    params.methods = engine->methods;
    engine->params.max_blur_radius = (float)blur;
    status = refocus_renderer_create(&engine->renderer, &params);
    engine->create_ms = report_clock_ms() - start;
    if (status == REFOCUS_ERR_UNSUPPORTED)
        return report_failure(EXIT_FAILED, "--cpu",
                              "this processor or build has no %s; give auto",
                              refocus_cpu_name(params.cpu));
    if (status == REFOCUS_ERR_THREAD)
        return report_failure(EXIT_FAILED, "--threads", "%s; give fewer",
                              refocus_strerror(status));
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, engine->name,
                              "%s: %dx%d pixels with blur %.4g need %.0f MiB; give a smaller "
                              "picture or less blur",
                              refocus_strerror(status), width, height, blur,
                              (double)refocus_renderer_memory(&params) / (1 << 20));
    interrupt_watch(engine->renderer);
    refocus_renderer_get_info(engine->renderer, &engine->info);
    return papers_place(&settings->papers, &engine->params, width, height);
}

int engine_prepare(struct engine *engine, const struct refocus_image *photo,
                   const struct refocus_disparity *disparity)
{
    const double start = report_clock_ms();
    const int status = interrupt_came()
                           ? REFOCUS_ERR_CANCELLED
                           : refocus_prepare(engine->renderer, photo, disparity);

    engine->prepare_ms = report_clock_ms() - start;
    if (status == REFOCUS_ERR_CANCELLED)
        return interrupted(engine);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, engine->name, "it cannot be prepared: %s",
                              refocus_strerror(status));
    return EXIT_DONE;
}

/* Render whole, or, where that is slow and somebody watches, in strips of rows. The progress
 * goes from begin by share. */
static int render_once(struct engine *engine, const struct refocus_image *out, double begin,
                       double share)
{
    enum { STRIPS = 20 };
    const bool strips = report_is_watched() && out->height >= STRIPS &&
                        engine->params.method == REFOCUS_METHOD_RAYTRACE;
    const int count = strips ? STRIPS : 1;
    int status = REFOCUS_OK;

    for (int i = 0; i < count && status == REFOCUS_OK; i++) {
        const int y0 = (int)((int64_t)out->height * i / count);
        const int y1 = (int)((int64_t)out->height * (i + 1) / count);
        struct refocus_render_params params = engine->params;
        struct refocus_image strip = *out;

        report_progress("rendering", begin + share * i / count);
        if (interrupt_came())
            return REFOCUS_ERR_CANCELLED;
        params.region_y += y0;
        params.region_width = strip.width;
        params.region_height = strip.height = y1 - y0;
        strip.plane[0] += y0 * strip.stride[0];
        status = refocus_render(engine->renderer, &params, &strip);
    }
    return status;
}

int engine_render(struct engine *engine, const struct refocus_image *out, int repeat)
{
    const float focus = engine->params.focus_disparity;
    const float beside = focus + (focus > 0.5f ? -2 : 2) / 65535.0f;
    double *times = malloc((size_t)repeat * sizeof *times);
    int status = REFOCUS_OK;

    if (!times)
        return report_failure(EXIT_FAILED, "--repeat", "not enough memory; give less");
    engine->params.field_disparity = isnan(engine->field_disparity)
                                         ? engine->params.focus_disparity
                                         : (float)engine->field_disparity;
    for (int i = 0; i < repeat && status == REFOCUS_OK; i++) {
        const double start = report_clock_ms();

        /* every other one is a step of disparity off, or all but rays would be kept */
        engine->params.focus_disparity = (repeat - i) % 2 ? focus : beside;
        status = render_once(engine, out, 0.3 + 0.6 * i / repeat, 0.6 / repeat);
        times[i] = report_clock_ms() - start;
    }
    engine->params.focus_disparity = focus;
    if (status == REFOCUS_OK)
        engine->render_ms = report_spread(times, repeat);
    free(times);
    if (status == REFOCUS_ERR_CANCELLED)
        return interrupted(engine);
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
    free((void *)engine->field_map.samples);
}

json_t *engine_json(const struct engine *engine)
{
    const struct refocus_render_params *params = &engine->params;
    json_t *rays = params->rays == REFOCUS_RAYS_FULL ? json_string("full")
                                                     : json_integer(params->rays);

    return json_pack(
        "{s:s, s:o, s:s, s:o, s:f, s:i, s:f, s:f, s:i, s:s, s:f, s:f, s:o, s:I, s:I}", "method",
        refocus_method_name(params->method), "rays", rays, "blend",
        engine_blend_name(params->blend), "sigma",
        params->sigma < 1e30f ? json_real(params->sigma) : json_string("off"), "highlights",
        (double)params->highlight_gain, "iterations",
        (int)params->iterations, "blur", (double)params->max_blur_radius, "focus",
        (double)params->focus_disparity, "threads", (int)engine->info.threads, "cpu",
        refocus_cpu_name(engine->info.cpu), "create_ms", engine->create_ms, "prepare_ms",
        engine->prepare_ms, "render_ms", report_spread_json(engine->render_ms),
        "renderer_bytes", (json_int_t)engine->info.memory, "peak_rss_kib",
        (json_int_t)report_peak_rss_kib());
}
