/* lens_options.c: the options of focus and blur, which commands have as groups. */
#include "inputs/lens.h"

const struct option focus_options[] = {
    {OPTION(OPTION_NUMBER, "--focus", "D", struct lens_settings, focus), .group = "focus",
     .least = 0, .greatest = 1, .brief = "disparity in focus: 1 nearest, 0 farthest",
     .help = "disparity in focus: 1 nearest, 0 farthest"},
    {OPTION(OPTION_NUMBERS, "--focus-at", "X,Y", struct lens_settings, focus_at), .group = "focus",
     .least = -INFINITY, .greatest = INFINITY, .count = 2,
     .brief = "focus on the surface at that pixel",
     .help = "focus on the surface at that pixel: the nearer one at an edge; without any "
             "--focus...: the point or distance that the file names, else what stands before its "
             "surroundings near the centre, else the centre"},
    {OPTION(OPTION_NUMBERS, "--focus-rectangle", "X,Y,W,H", struct lens_settings, focus_rectangle),
     .group = "focus", .least = 0, .greatest = REFOCUS_MAX_SIDE, .count = 4,
     .help = "focus on the nearest surface that has a quarter of that rectangle, pixels"},
    {OPTION(OPTION_NUMBER, "--focus-distance", "M", struct lens_settings, focus_distance),
     .group = "focus", .least = 0, .above = true, .greatest = INFINITY,
     .help = "metres in focus, also 'inf'; near and far must be known"},
    {OPTION(OPTION_NUMBER, "--blur", "K", struct lens_settings, blur), .group = "blur", .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS, .brief = "largest blur radius, pixels",
     .help = "blur radius in pixels of disparity 0 when 1 is in focus; without it and --f-number: "
             "the blur that the file names, or of the lens that its phone simulates, else 1/50 of "
             "the larger side, at most 127"},
    {.help = NULL},
};

const struct option lens_options[] = {
    {OPTION(OPTION_NUMBER, "--f-number", "N", struct lens_settings, f_number), .group = "blur",
     .least = 0, .above = true, .greatest = 1000, .brief = "the blur of such a lens instead",
     .help = "blur of a lens of this f-number, at most 944 pixels; without a focal length, or "
             "metres of the depth, the blur that the file names, or the default, which stands for "
             "the f-number of the file, or f/2, made more or less"},
    {OPTION(OPTION_NUMBER, "--focal-length", "MM", struct lens_settings, focal_length), .least = 0,
     .above = true, .greatest = 100000,
     .help = "focal length for --f-number; default: the EXIF focal length in 35 mm terms, for the "
             "blur that a full-frame camera has at that f-number"},
    {OPTION(OPTION_NUMBER, "--sensor-width", "MM", struct lens_settings, sensor_width), .least = 0,
     .above = true, .greatest = 10000,
     .help = "width of the sensor area that the picture shows, with --focal-length; default: 36 mm "
             "for the larger side of the picture"},
    {.help = NULL},
};
