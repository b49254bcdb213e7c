/* view_light.c: `refocus view` renders photos of more than 8 bits, and gain maps, as `refocus
 * render` does. */
#include "commands/view_light.h"
#include "line/interrupt.h"
#include "outputs/outputs.h"

static bool has_own_tones(const struct depth_settings *depth)
{
    return depth->transfer || !isnan(depth->white);
}

void view_light_begin(struct view_light *light, struct engine *engine,
                      struct shot_settings *settings, const char *output)
{
    struct depth_settings *const depth = &settings->depth;

    light->output = output;
    shot_suit_output(depth, output);
    if (has_own_tones(depth) && !engine_takes_deep(&engine->params))
        depth->deep = DEEP_NONE;
    light->adds_grain = isnan(settings->engine.bokeh.grain);
    engine_add_grain(engine, &settings->engine);
    engine->params.render.dither = depth->no_dither ? REFOCUS_DITHER_OFF : REFOCUS_DITHER_ORDERED;
}

int view_light_settle(const struct engine *engine, const struct shot_settings *settings,
                      struct input *input)
{
    const struct refocus_image *const photo = input->photo->image;
    const struct refocus_disparity map = refocus_disparity16(
        input->disparity, photo->width, photo->height, 2 * (ptrdiff_t)photo->width);
    const struct refocus_scene scene = refocus_scene_default(&input->deep, &map);
    struct engine sharp = *engine;
    int status;

    if (!input->deep.plane[0] || input->light || !has_own_tones(&settings->depth))
        return EXIT_DONE;
    sharp.deep = true;
    sharp.has_sides = false;
    sharp.methods = REFOCUS_METHOD_BIT(REFOCUS_METHOD_SWEEP);
    sharp.params = refocus_settings_default(0, 0);
    sharp.params.render.dither = engine->params.render.dither;
    status = engine_create(&sharp, &settings->engine, photo->width, photo->height, 0);
    if (status == EXIT_DONE)
        status = engine_prepare(&sharp, &scene);
    if (status == EXIT_DONE)
        status = engine_render(&sharp, photo, 1);
    interrupt_watch(NULL);
    refocus_renderer_destroy(&sharp.renderer);
    return status;
}

static bool takes_deep(void *of, struct refocus_settings *params)
{
    const struct view_light *const light = of;

    return shot_choose_bits(light->input, light->adds_grain, params);
}

static int to_tones(void *of, const struct refocus_image *picture,
                    const struct refocus_settings *params, const struct refocus_image *out)
{
    const struct view_light *const light = of;

    return refocus_light_to_base(light->input->light, picture, 0, 0, params->render.dither, out);
}

void view_light_join(struct view_light *light, const struct input *input,
                     struct rf_session_setup *session)
{
    light->input = input;
    if (!input->deep.plane[0])
        return;
    session->deep = &input->deep;
    session->takes_deep = takes_deep;
    session->to_tones = input->light ? to_tones : NULL;
    session->deep_user = light;
    session->saved = shot_picture(input, true, light->output);
    session->keeps_light = input->light && (!light->output || output_is_jpeg(light->output));
    if (session->saved.format == REFOCUS_FORMAT_RGB8)
        session->saved.format = REFOCUS_FORMAT_NONE;
}
