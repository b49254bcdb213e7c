/* shot_options.c: the options of rendering that several commands have. */
#include "shot/shot_options.h"

#include "shot/methods.h"
#include "shot/shot.h"

enum {
    SWEEP = 1 << REFOCUS_METHOD_SWEEP,
    SEARCH = 1 << REFOCUS_METHOD_SEARCH,
    JITTERED = 1 << REFOCUS_METHOD_JITTERED,
    SCATTER = 1 << REFOCUS_METHOD_SCATTER,
    FOVEATED = 1 << REFOCUS_METHOD_FOVEATED,
    INTERPOLATED = 1 << REFOCUS_METHOD_INTERPOLATED,
    DIFFUSION = 1 << REFOCUS_METHOD_DIFFUSION,
};

/* The beginning of a row in a table of struct engine_settings. */
#define ENGINE(kind, name, argument, field)                                                        \
    OPTION(kind, name, argument, struct engine_settings, field)
#define NUMBER(name, argument, field, from, to)                                                    \
    ENGINE(OPTION_NUMBER, name, argument, field), .least = (from), .greatest = (to)
#define INTEGER(name, argument, field, from, to)                                                   \
    ENGINE(OPTION_INTEGER, name, argument, field), .least = (from), .greatest = (to)

/* An option that only some methods look at. */
#define BY_METHOD                                                                                  \
    .of = "--method", .of_word = refocus_method_name,                                              \
    .of_offset = offsetof(struct engine_settings, method)
#define OF(methods) BY_METHOD, .of_words = (methods)

const struct option method_options[] = {
    {ENGINE(OPTION_CHOICE, "--method", "NAME", method), .choice = refocus_method_name,
     .summary = refocus_method_summary, .brief = "how it is rendered",
     .help = "how it is rendered; default sweep"},
    {.help = NULL},
};

const struct option ray_options[] = {
    {INTEGER("--rays", "N", rays, 1, REFOCUS_MAX_RAYS), .word = "full",
     .word_value = REFOCUS_RAYS_FULL,
     .help = "ray samples a pixel at the largest blur; full = every pixel of the aperture mask; "
             "default: by --quality",
     BY_METHOD, .of_takes = method_takes_rays},
    {.help = NULL},
};

const struct option search_options[] = {
    {INTEGER("--iterations", "T", iterations, 1, 64),
     .help = "search: tests of the randomized intersection search, default 2; the paper's is 1",
     OF(SEARCH)},
    {ENGINE(OPTION_FLAG, "--mirror", NULL, mirror),
     .help = "search: where a ray is hidden take the mirrored pixel", OF(SEARCH)},
    {ENGINE(OPTION_FLAG, "--background", NULL, background),
     .help = "search: where a ray is hidden take the background layer", OF(SEARCH)},
    {.help = NULL},
};

const struct option blend_options[] = {
    {ENGINE(OPTION_TEXT, "--aperture", "SHAPE", aperture), .choice = bokeh_figure_name,
     .summary = bokeh_figure_summary, .brief = "disc, polygon:6, heart, star, or a mask picture",
     .help = "disc (default), polygon:BLADES or polygon:BLADES:DEGREES with 3 to 16 blades, a mask "
             "picture of at most 255x255, white = open, or a figure:"},
    {ENGINE(OPTION_CHOICE, "--blend", "NAME", blend), .words = engine_blend_words,
     .help = "the values that are averaged; default linear"},
    {NUMBER("--sigma", "S", sigma, 1, 1e30), .word = "off", .word_value = INFINITY,
     .help = "weight exp(-(max(R,G,B) - 255)^2 / 2 S^2) of bright samples; default off"},
    {NUMBER("--highlights", "GAIN", highlights, 1, 16), .word = "off", .word_value = 1,
     .other_word = "auto", .other_value = HIGHLIGHTS_ESTIMATED,
     .help = "sweep, search: light given back to clipped highlights: auto = as much as the photo "
             "tells, the default; up to GAIN times white to small ones",
     OF(SWEEP | SEARCH)},
    {.help = NULL},
};

const struct option rendering_options[] = {
    GROUP_HERE(search_options),
    {ENGINE(OPTION_FLAG, "--no-thin", NULL, no_thin),
     .help = "sweep: gather thin structures far before the focus, and in it, by rays like "
             "everything else, instead of splatting them; so does quality preview",
     OF(SWEEP)},
    {ENGINE(OPTION_CHOICE, "--fill", "HOW", fill), .words = engine_fill_words,
     .help = "sweep: how the background is made up that a blurred foreground uncovers", OF(SWEEP)},
    GROUP_HERE(blend_options),
    {.help = NULL},
};

const struct option run_options[] = {
    {ENGINE(OPTION_INTEGER, "--threads", "N", threads), .elsewhere = true, .greatest = 64,
     .help = "0 = one for each processor, the default; never changes the result"},
    {ENGINE(OPTION_CHOICE, "--cpu", "NAME", cpu), .elsewhere = true, .choice = refocus_cpu_name,
     .help =
         "instruction set, auto = the best that there is, the default; never changes the result"},
    {ENGINE(OPTION_FLAG, "--json", NULL, json), .elsewhere = true,
     .brief = "print a report as one JSON object",
     .help = "print a report as one JSON object; times in milliseconds, without reading and "
             "writing of files"},
    {.help = NULL},
};

const struct option repeat_options[] = {
    {ENGINE(OPTION_INTEGER, "--repeat", "N", repeat), .elsewhere = true, .least = 1,
     .greatest = 10000, .help = "render N times and report the times"},
    {.help = NULL},
};

const struct option control_options[] = {
    {.kind = OPTION_HEADING, .help = "Focus beyond a plain lens"},
    {NUMBER("--focus-width", "W", controls.focus_width, 0, 1),
     .help = "disparities to either side of the focus that stay sharp; default 0"},
    {NUMBER("--focus-transition", "W", controls.focus_transition, 0, 1),
     .help = "further disparities over which the blur grows to the lens's; default that of "
             "--focus-width"},
    {ENGINE(OPTION_TEXT, "--also-focus", "D:W:T,...", controls.also_focus),
     .help = "up to 15 more bands in focus: a disparity and, if wanted, its width and transition; "
             "default those of the focus"},
    {ENGINE(OPTION_NUMBERS, "--focus-plane", "X,Y,X,Y,X,Y", controls.focus_plane), .least = 0,
     .greatest = REFOCUS_MAX_SIDE - 1, .count = 6,
     .help = "plane of focus through what is seen at three pixels, as of a view camera; in place "
             "of --focus..."},
    {ENGINE(OPTION_NUMBERS, "--tilt-line", "X,Y,X,Y", controls.tilt_line), .least = 0,
     .greatest = REFOCUS_MAX_SIDE - 1, .count = 4,
     .help = "line of the photo that the plane of focus passes at the focus, for --tilt-angle; "
             "default: level, through --focus-at or the centre"},
    {NUMBER("--tilt-angle", "DEG", controls.tilt_angle, -89, 89),
     .help = "angle of the plane of focus: at 45 the disparity in focus grows by 1 over a "
             "picture's width, to the right of the line; default 0"},
    {NUMBER("--tilt-compress", "C", controls.tilt_compress, 0, 1),
     .help = "how much depth is compressed along that line: 0 = not, the default, 1 = only the "
             "place counts, as in pictures of miniatures"},
    {ENGINE(OPTION_TEXT, "--focus-map", "FILE", controls.focus_map),
     .help = "surface in focus: grey picture of the disparity in focus at each place"},
    {ENGINE(OPTION_TEXT, "--sharp-mask", "FILE", controls.sharp_mask),
     .help = "what stays sharp whatever its depth: grey picture, white = sharp"},
    {NUMBER("--far-clamp", "D", controls.far_clamp, 0, 1),
     .help = "disparity beyond which nothing is blurred more; default 0"},
    {NUMBER("--near-clamp", "D", controls.near_clamp, 0, 1),
     .help = "disparity before which nothing is blurred more; default 1"},
    {NUMBER("--blur-limit", "R", controls.blur_limit, 0, REFOCUS_MAX_BLUR_RADIUS),
     .help = "largest blur radius, pixels; default 944"},
    {.help = NULL},
};

const struct option bokeh_options[] = {
    {.kind = OPTION_HEADING, .help = "Bokeh"},
    {ENGINE(OPTION_CHOICE, "--bokeh", "NAME", bokeh.preset), .choice = bokeh_preset_name,
     .summary = bokeh_preset_summary, .brief = "the look of a lens",
     .help = "presets; what else is given overrules them"},
    {NUMBER("--curvature", "C", bokeh.curvature, 0, 1),
     .help = "of the blades of a polygon: 0 = straight, the default, 1 = arcs of the circle"},
    {ENGINE(OPTION_NUMBER, "--open-f-number", "N", bokeh.open_f_number), .least = 0, .above = true,
     .greatest = 1000,
     .help = "f-number of the lens wide open, where it is round: a polygon shows as --f-number "
             "closes it"},
    {NUMBER("--squeeze", "Q", bokeh.squeeze, 0.5, 2),
     .help = "width / height of the discs, below 1 as of an anamorphic lens; default 1"},
    {NUMBER("--ring", "R", bokeh.ring, 0, 0.9),
     .help = "radius of a stop in the middle, as of a mirror lens; default 0"},
    {NUMBER("--edge", "E", bokeh.edge, -1, 1),
     .help = "behind the focus: 1 = bubbles with bright edges, -1 = discs that fade out; before it "
             "the contrary; default 0"},
    {NUMBER("--edge-before", "E", bokeh.edge_before, -1, 1),
     .help = "the edge before the focus, when it is not the contrary"},
    {NUMBER("--cat-eye", "A", bokeh.cat_eye, 0, 0.9),
     .help = "how much narrower discs are in the corners; default 0"},
    {NUMBER("--fringe", "A", bokeh.fringe, -0.5, 0.5),
     .help = "edges of colour: green behind the focus and magenta before it, or the contrary; "
             "default 0"},
    {NUMBER("--grain", "G", bokeh.grain, 0, 4), .word = "off",
     .help = "the photo's noise put back into what is blurred: 1 = as much as was measured, off = "
             "0; default 1 for stills of 8 bits, 0 for others and for live; --seed chooses it, in "
             "live one more for each frame"},
    {NUMBER("--highlight-stops", "S", bokeh.highlight_stops, 0, 4),
     .help = "sweep, search: light given back to small clipped highlights, in stops, for "
             "--highlights 2^S",
     OF(SWEEP | SEARCH)},
    {.help = NULL},
};

const struct option paper_options[] = {
    {.kind = OPTION_HEADING, .help = "Of single methods"},
    {INTEGER("--cell", "A", papers.cell, 1, 16),
     .help = "jittered: a ray of each A x A pixels of the mask; default 2", OF(JITTERED)},
    {INTEGER("--seed", "N", papers.seed, 0, 999999999),
     .help = "jittered: which ones; of --grain: which; default 0", OF(JITTERED),
     .needs = "--grain"},
    {ENGINE(OPTION_CHOICE, "--spread", "NAME", papers.spread), .words = papers_spread_words,
     .help = "scatter: light in a circle of confusion; default uniform", OF(SCATTER)},
    {NUMBER("--airy-radius", "R", papers.airy_radius, 0.25, 16),
     .help = "scatter, lommel: first dark ring of a point in focus, pixels; default 1",
     .needs = "--spread"},
    {NUMBER("--depth-ratio", "Q", papers.depth_ratio, 1, 1000),
     .help = "scatter: far / near metres, for light that falls with the square of the distance; "
             "default 1, not at all",
     OF(SCATTER)},
    {INTEGER("--star", "N", papers.star, 0, 16),
     .help = "sweep, scatter: spikes of a star filter, 0 or 2 to 16; default 0",
     OF(SWEEP | SCATTER)},
    {NUMBER("--star-length", "L", papers.star_length, 0, 127),
     .help = "pixels of a spike; default 24", .needs = "--star,--bokeh"},
    {NUMBER("--star-angle", "DEG", papers.star_angle, -3600, 3600),
     .help = "of the first spike, counter-clockwise from the right; default 0",
     .needs = "--star,--bokeh"},
    {NUMBER("--star-strength", "P", papers.star_strength, 0, 1),
     .help = "share of the light in the spikes; default 0.25", .needs = "--star,--bokeh"},
    {NUMBER("--sharp-radius", "R", papers.sharp_radius, 0.5, 16),
     .help = "interpolated: c0, blur radius up to which all is sharp; default 0.5",
     OF(INTERPOLATED)},
    {NUMBER("--middle-ratio", "Q", papers.middle_ratio, 1, 1000), .above = true,
     .help = "interpolated: r1, radius of the middle picture / c0; default (1 + r2) / 2",
     OF(INTERPOLATED)},
    {NUMBER("--last-ratio", "Q", papers.last_ratio, 1, 1000), .above = true,
     .help = "interpolated: r2, radius of the last picture / c0; default: the largest blur",
     OF(INTERPOLATED)},
    {ENGINE(OPTION_NUMBERS, "--attention", "X,Y", papers.attention), .least = 0, .greatest = 65535,
     .count = 2,
     .help = "foveated: pixel that is looked at; default: where the focus is found, as by "
             "--focus-at, else the centre",
     OF(FOVEATED)},
    {NUMBER("--attention-angle", "DEG", papers.attention_angle, 0, 170),
     .help = "foveated: across the exact part; default 10", OF(FOVEATED)},
    {NUMBER("--picture-angle", "DEG", papers.picture_angle, 1, 170),
     .help = "foveated: across the picture; default 50", OF(FOVEATED)},
    {NUMBER("--attention-depth", "D", papers.attention_depth, 0, 1),
     .help = "foveated: disparity about the focus of the exact part; default 1, all", OF(FOVEATED)},
    {ENGINE(OPTION_CHOICE, "--field", "NAME", papers.field), .words = papers_field_words,
     .help = "sweep, search, blur, diffusion: where it is blurred; default lens"},
    {ENGINE(OPTION_NUMBERS, "--field-at", "X,Y", papers.field_at), .least = 0, .greatest = 65535,
     .count = 2, .help = "pixel of the field's centre; default the picture's", .needs = "--field"},
    {NUMBER("--field-disparity", "D", papers.field_disparity, 0, 1),
     .help = "of the field's centre; default that in focus", .needs = "--field"},
    {NUMBER("--field-radius", "R", papers.field_radius, 0, 4),
     .help = "distance that stays sharp, of the width or in disparity; default 0.1",
     .needs = "--field"},
    {NUMBER("--field-falloff", "R", papers.field_falloff, 0.001, 4),
     .help = "further distance to the full blur; default 0.3", .needs = "--field"},
    {NUMBER("--field-angle", "DEG", papers.field_angle, -3600, 3600),
     .help = "of a plane: 0 = upright and along the view, 90 = facing it", .needs = "--field"},
    {ENGINE(OPTION_TEXT, "--field-map", "FILE", papers.field_map),
     .help = "for picture: grey picture of the field, white = the full blur"},
    {INTEGER("--layers", "N", papers.layers, 1, 8),
     .help = "diffusion: that the picture is split into by depth; default 4", OF(DIFFUSION)},
    {ENGINE(OPTION_CHOICE, "--solver", "NAME", papers.solver), .words = papers_solver_words,
     .help = "diffusion: series (default), or the paper's single steps", OF(DIFFUSION)},
    {NUMBER("--conductivity", "W", papers.conductivity, 0.01, 1),
     .help = "diffusion: weight of a step where blur is strongest; default 0.125", OF(DIFFUSION)},
    {.help = NULL},
};

const struct option strips_options[] = {
    {ENGINE(OPTION_FLAG, "--low-memory", NULL, in_strips),
     .help = "render in strips: a fourth of the memory, and longer. Thin structures are gathered "
             "by rays, what is hidden is smooth, no matte is used, of a photo 8 bits are taken, "
             "and in photos of more than 4 megapixels edges of the depth map are placed at a "
             "smaller size. The picture waits in a temporary file in TMPDIR or /var/tmp. Where "
             "there is too little memory it is done by itself"},
    {.help = NULL},
};

const struct option shot_lens_options[] = {
    {.kind = OPTION_HEADING, .help = "Focus and blur"},
    GROUP(focus_options, struct shot_settings, lens),
    GROUP(lens_options, struct shot_settings, lens),
    GROUP(control_options, struct shot_settings, engine),
    GROUP(bokeh_options, struct shot_settings, engine),
    {.help = NULL},
};

const struct option shot_method_options[] = {
    {.kind = OPTION_HEADING, .help = "Rendering"},
    GROUP(method_options, struct shot_settings, engine),
    GROUP(ray_options, struct shot_settings, engine),
    QUALITY_OPTION(struct shot_settings, engine.quality, "auto", NULL),
    GROUP(rendering_options, struct shot_settings, engine),
    {.help = NULL},
};
