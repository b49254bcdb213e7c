/* engine.h: a renderer and its parameters, by the options of the command line. */
#ifndef RF_CLI_ENGINE_H
#define RF_CLI_ENGINE_H

#include <math.h>
#include <refocus/refocus.h>
#include "shot/bokeh.h"
#include "shot/controls.h"
#include "line/options.h"
#include "shot/methods.h"
#include "shot/papers.h"
#include "line/report.h"

struct engine_settings {
    int method, quality, blend, fill, cpu;
    double rays, iterations, sigma, highlights; /* NAN: not given */
    double threads, repeat;
    const char *aperture; /* NULL: that of the bokeh's preset */
    bool mirror, background, no_thin, json;
    bool in_strips;     /* in little memory, as strips.h says */
    int64_t memory_kib; /* most that the renderer may take, else it is short_of_memory; 0: any */
    struct paper_settings papers;
    struct control_settings controls;
    struct bokeh_settings bokeh;
};

enum { QUALITY_STANDARD = 1, QUALITY_BEST = 2, QUALITY_AUTO = 3 };

enum { HIGHLIGHTS_ESTIMATED = 0 }; /* `highlights`: no gain, which is 1 or more */

#define ENGINE_SETTINGS_NONE(quality_default, repeat_default)                                      \
    {                                                                                              \
        .quality = (quality_default), .rays = NAN, .iterations = NAN, .sigma = NAN,                \
        .highlights = NAN, .repeat = repeat_default, .papers = PAPER_SETTINGS_NONE,                \
        .controls = CONTROL_SETTINGS_NONE, .bokeh = BOKEH_SETTINGS_NONE                            \
    }

enum engine_fill { FILL_AUTO, FILL_SMOOTH, FILL_TEXTURED };

/* Words of --quality, --fill and --blend. */
extern const struct option_word engine_quality_words[], engine_fill_words[], engine_blend_words[];

struct engine {
    const char *name; /* name of the photo, for errors */
    struct refocus_renderer *renderer;
    struct refocus_renderer_info info;
    struct refocus_aperture *aperture;
    struct refocus_disparity field_map; /* samples NULL: none */
    struct controls controls;
    bool still_rays;        /* each frame has the rays that its blur takes: --quality auto */
    bool has_sides;         /* the aperture's light differs before and behind the focus */
    bool has_matte;         /* the renderer is made for scenes with a matte */
    double field_disparity; /* NAN: that in focus */
    bool behind;            /* the renderer is made for a second layer */
    bool deep;              /* the renderer takes deep photos and pictures */
    const struct refocus_light *light; /* light by a gain map, if that is rendered, or NULL */
    bool keeps_light;                  /* `rendered` is wanted; before engine_render() */
    /* Such light as it was rendered, before it went back into 8 bits; no plane: there is none. */
    struct refocus_image rendered;
    int spool; /* a file of spool.h that the picture goes to, `out` being the room for it; -1: none;
                  before engine_render() */
    bool
        short_of_memory; /* settings->memory_kib was too little: engine_create() failed, silently */
    uint32_t methods;    /* methods that the renderer is made for, REFOCUS_METHOD_BIT or-ed */
    bool places_edges; /* the renderer can put edges of a map on the photo's; before engine_create()
                        */
    struct refocus_depth_edges_report edges; /* by the last scene; struct_size 0: as given */
    struct refocus_settings params;
    double create_ms, prepare_ms;
    struct spread render_ms, cpu_ms; /* cpu_ms: of all threads, of a render */
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* The aperture and what else can be wrong before a photo is read. */
int engine_begin(struct engine *engine, const struct engine_settings *settings);

/* Whether deep photos can be rendered so, as the core says. */
bool engine_takes_deep(const struct refocus_settings *params);
/* Whether light above white, as of a gain map, can: other methods take it for white. */
bool engine_draws_light(const struct refocus_settings *params);

/* Give a still grain where none was asked for nor refused; `deep` is known. */
void engine_add_grain(struct engine *engine, const struct engine_settings *settings);

/* The largest blur radius, in pixels, that the method of these settings renders. */
double engine_most_blur(const struct engine_settings *settings);

/* Give parameters whose blur is known the rays that --quality auto has for it; engine_render()
 * does so itself. */
void engine_suit_rays(const struct engine *engine, struct refocus_settings *params);

/* Renderer for photos of this size and blur; prepare; render settings->repeat times. */
int engine_create(struct engine *engine, const struct engine_settings *settings, int width,
                  int height, double blur);
int engine_prepare(struct engine *engine, const struct refocus_scene *scene);
int engine_render(struct engine *engine, const struct refocus_image *out, int repeat);

/* Called after engine_begin(), whatever it returned. */
void engine_end(struct engine *engine);

/* The settings and times in words that every report has; NULL without memory. */
json_t *engine_json(const struct engine *engine);

#endif
