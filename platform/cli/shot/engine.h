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

enum { QUALITY_STANDARD = 1, QUALITY_AUTO = 3 };

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

/* Rows of tables of options, for settings with a member of the type above. */
#define METHOD_OPTION(type, member)                                                                \
    {                                                                                              \
        OPTION(OPTION_CHOICE, "--method", "NAME", type, member.method),                            \
            .choice = refocus_method_name, .summary = refocus_method_summary,                      \
            .brief = "how it is rendered", .help = "how it is rendered; default sweep"             \
    }
/* usual: the quality that is the default; summaries: what each of them is, or NULL. */
#define RAY_OPTIONS(type, member, usual, summaries)                                                \
    {OPTION(OPTION_INTEGER, "--rays", "N", type, member.rays),                                     \
     .least = 1,                                                                                   \
     .greatest = REFOCUS_MAX_RAYS,                                                                 \
     .word = "full",                                                                               \
     .word_value = REFOCUS_RAYS_FULL,                                                              \
     .help = "ray samples a pixel at the largest blur; full = every pixel of the "                 \
             "aperture mask; default: by --quality",                                               \
     OF_METHODS_THAT(type, member.method, method_takes_rays)},                                     \
        {OPTION(OPTION_CHOICE, "--quality", "NAME", type, member.quality),                         \
         .words = engine_quality_words, .summary = summaries, .brief = "time against smoothness",  \
         .help = "presets; default " usual "; --rays overrules"},                                  \
        {OPTION(OPTION_INTEGER, "--iterations", "T", type, member.iterations), .least = 1,         \
         .greatest = 64,                                                                           \
         .help = "search: tests of the randomized intersection search, default 2; the "            \
                 "paper's is 1",                                                                   \
         OF_METHODS(type, member.method, OF_SEARCH)},                                              \
        {OPTION(OPTION_FLAG, "--mirror", NULL, type, member.mirror),                               \
         .help = "search: where a ray is hidden take the mirrored pixel",                          \
         OF_METHODS(type, member.method, OF_SEARCH)},                                              \
    {                                                                                              \
        OPTION(OPTION_FLAG, "--background", NULL, type, member.background),                        \
            .help = "search: where a ray is hidden take the background layer",                     \
            OF_METHODS(type, member.method, OF_SEARCH)                                             \
    }
#define LAYER_OPTIONS(type, member)                                                                \
    {OPTION(OPTION_FLAG, "--no-thin", NULL, type, member.no_thin),                                 \
     .help = "sweep: gather thin structures far before the focus, and in it, by rays "             \
             "like everything else, instead of splatting them; so does quality preview",           \
     OF_METHODS(type, member.method, OF_SWEEP)},                                                   \
    {                                                                                              \
        OPTION(OPTION_CHOICE, "--fill", "HOW", type, member.fill),                                 \
            .words = engine_fill_words,                                                            \
            .help = "sweep: how the background is made up that a blurred foreground uncovers",     \
            OF_METHODS(type, member.method, OF_SWEEP)                                              \
    }
#define BLEND_OPTIONS(type, member)                                                                \
    {OPTION(OPTION_TEXT, "--aperture", "SHAPE", type, member.aperture),                            \
     .choice = bokeh_figure_name, .summary = bokeh_figure_summary,                                 \
     .brief = "disc, polygon:6, heart, star, or a mask picture",                                   \
     .help = "disc (default), polygon:BLADES or polygon:BLADES:DEGREES with 3 to 16 "              \
             "blades, a mask picture of at most 255x255, white = open, or a figure:"},             \
        {OPTION(OPTION_CHOICE, "--blend", "NAME", type, member.blend),                             \
         .words = engine_blend_words, .help = "the values that are averaged; default linear"},     \
        {OPTION(OPTION_NUMBER, "--sigma", "S", type, member.sigma),                                \
         .least = 1,                                                                               \
         .greatest = 1e30,                                                                         \
         .word = "off",                                                                            \
         .word_value = INFINITY,                                                                   \
         .help = "weight exp(-(max(R,G,B) - 255)^2 / 2 S^2) of bright samples; default off"},      \
    {                                                                                              \
        OPTION(OPTION_NUMBER, "--highlights", "GAIN", type, member.highlights),                    \
            .least = 1, .greatest = 16, .word = "off", .word_value = 1, .other_word = "auto",      \
            .other_value = HIGHLIGHTS_ESTIMATED,                                                   \
            .help = "sweep, search: light given back to clipped highlights: auto = as much as "    \
                    "the photo tells, the default; up to GAIN times white to small ones",          \
            OF_METHODS(type, member.method, OF_SWEEP | OF_SEARCH)                                  \
    }
#define METHOD_OPTIONS(type, member, usual)                                                        \
    RAY_OPTIONS(type, member, usual, NULL), LAYER_OPTIONS(type, member), BLEND_OPTIONS(type, member)
#define RUN_OPTIONS(type, member)                                                                  \
    {OPTION(OPTION_INTEGER, "--threads", "N", type, member.threads), .elsewhere = true,            \
     .greatest = 64, .help = "0 = one for each processor, the default; never changes the result"}, \
        {OPTION(OPTION_CHOICE, "--cpu", "NAME", type, member.cpu), .elsewhere = true,              \
         .choice = refocus_cpu_name,                                                               \
         .help = "instruction set, auto = the best that there is, the default; never "             \
                 "changes the result"},                                                            \
    {                                                                                              \
        OPTION(OPTION_FLAG, "--json", NULL, type, member.json),                                    \
            .elsewhere = true, .brief = "print a report as one JSON object",                       \
            .help = "print a report as one JSON object; times in milliseconds, without "           \
                    "reading and writing of files"                                                 \
    }
#define REPEAT_OPTION(type, member)                                                                \
    {                                                                                              \
        OPTION(OPTION_INTEGER, "--repeat", "N", type, member.repeat),                              \
            .elsewhere = true, .least = 1, .greatest = 10000,                                      \
            .help = "render N times and report the times"                                          \
    }

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
