/* From the options to a photo, its disparities, and a lens setting. */
#ifndef RF_CLI_INPUTS_H
#define RF_CLI_INPUTS_H

#include <math.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>
#include "line/options.h"

struct network_settings;
struct stereo_settings;

struct depth_settings {
    const char *file, *unit;
    double near_m, far_m; /* NAN: not given */
    double speckle;       /* patches of fewer samples are removed; 0: none */
    const char *invalid;  /* names of codes for "no value", or NULL */
    bool full;            /* bring the depth to the photo's size */
    bool optional;        /* a photo without any will do: its disparities are NULL
                             then */
    double snap;          /* edges of a map of the photo's size may be off by so much;
                             0: as they are */
    int upsample;         /* how; 0: as the core does, else 1 + enum
                             refocus_cv_filter */
};

struct lens_settings {
    double focus, focus_at[2], focus_distance, focus_rectangle[4];
    double blur, f_number, focal_length, sensor_width;
};

#define DEPTH_SETTINGS_NONE                                                                        \
    {                                                                                              \
        .near_m = NAN, .far_m = NAN                                                                \
    }
#define LENS_SETTINGS_NONE                                                                         \
    {                                                                                              \
        .focus = NAN, .focus_at = {NAN, NAN}, .focus_distance = NAN, .focus_rectangle = {NAN},     \
        .blur = NAN, .f_number = NAN, .focal_length = NAN, .sensor_width = NAN                     \
    }

/* Rows of tables of options, for settings with a member of the types above. */
#define DEPTH_FILE_OPTION(type, member)                                                            \
    {                                                                                              \
        .kind = OPTION_TEXT, .name = "--depth", .argument = "FILE",                                \
        .offset = offsetof(type, member.file),                                                     \
        .help = "depth map: PNG, PGM or JPEG of 8 or 16 bits, PFM, or a photo that "               \
                "carries one; without it the depth that the photo itself carries"                  \
    }
#define DEPTH_UNIT_OPTIONS(type, member)                                                           \
    {.kind = OPTION_TEXT,                                                                          \
     .name = "--depth-unit",                                                                       \
     .argument = "U",                                                                              \
     .offset = offsetof(type, member.unit),                                                        \
     .help = "what its samples are: disparity (bright = near), inverse (dark = "                   \
             "near), mm, m, or a number per metre such as 5000/m; default: what the "              \
             "file says, else disparity"},                                                         \
        {.kind = OPTION_NUMBER,                                                                    \
         .name = "--near",                                                                         \
         .argument = "M",                                                                          \
         .offset = offsetof(type, member.near_m),                                                  \
         .least = 0,                                                                               \
         .above = true,                                                                            \
         .greatest = 1e9,                                                                          \
         .help = "metres of disparity 1; default: what the file says, else what is "               \
                 "measured in distances"},                                                         \
    {                                                                                              \
        .kind = OPTION_NUMBER, .name = "--far", .argument = "M",                                   \
        .offset = offsetof(type, member.far_m), .least = 0, .above = true, .greatest = INFINITY,   \
        .help = "metres of disparity 0, also 'inf'; default as for --near"                         \
    }
#define REPAIR_OPTIONS(type, member)                                                               \
    {.kind = OPTION_TEXT,                                                                          \
     .name = "--invalid",                                                                          \
     .argument = "CODES",                                                                          \
     .offset = offsetof(type, member.invalid),                                                     \
     .help = "samples that hold no value, with commas: zero, max (255 or 65535), "                 \
             "2047; NaN and infinity never do, nor does zero in distances"},                       \
    {                                                                                              \
        .kind = OPTION_INTEGER, .name = "--speckle", .argument = "N",                              \
        .offset = offsetof(type, member.speckle), .least = 0, .greatest = REFOCUS_MAX_SPECKLE,     \
        .help = "fill patches of fewer than N samples like holes; default 0: none"                 \
    }
#define FOCUS_OPTIONS(type, member)                                                                \
    {.kind = OPTION_NUMBER,                                                                        \
     .name = "--focus",                                                                            \
     .argument = "D",                                                                              \
     .offset = offsetof(type, member.focus),                                                       \
     .least = 0,                                                                                   \
     .greatest = 1,                                                                                \
     .help = "disparity in focus: 1 nearest, 0 farthest"},                                         \
        {.kind = OPTION_NUMBERS,                                                                   \
         .name = "--focus-at",                                                                     \
         .argument = "X,Y",                                                                        \
         .offset = offsetof(type, member.focus_at),                                                \
         .least = -INFINITY,                                                                       \
         .greatest = INFINITY,                                                                     \
         .count = 2,                                                                               \
         .help = "focus on the surface at that pixel: the nearer one at an edge; without "         \
                 "any --focus...: the point that the file names, else the centre"},                \
        {.kind = OPTION_NUMBERS,                                                                   \
         .name = "--focus-rectangle",                                                              \
         .argument = "X,Y,W,H",                                                                    \
         .offset = offsetof(type, member.focus_rectangle),                                         \
         .least = 0,                                                                               \
         .greatest = REFOCUS_MAX_SIDE,                                                             \
         .count = 4,                                                                               \
         .help = "focus on the nearest surface that has a quarter of that rectangle, "             \
                 "pixels"},                                                                        \
        {.kind = OPTION_NUMBER,                                                                    \
         .name = "--focus-distance",                                                               \
         .argument = "M",                                                                          \
         .offset = offsetof(type, member.focus_distance),                                          \
         .least = 0,                                                                               \
         .above = true,                                                                            \
         .greatest = INFINITY,                                                                     \
         .help = "metres in focus, also 'inf'; near and far must be known"},                       \
    {                                                                                              \
        .kind = OPTION_NUMBER, .name = "--blur", .argument = "K",                                  \
        .offset = offsetof(type, member.blur), .least = 0, .greatest = REFOCUS_MAX_BLUR_RADIUS,    \
        .help = "blur radius in pixels of disparity 0 when 1 is in focus; without it "             \
                "and --f-number: 1/50 of the larger side, at most 127"                             \
    }
#define LENS_OPTIONS(type, member)                                                                 \
    {.kind = OPTION_NUMBER,                                                                        \
     .name = "--f-number",                                                                         \
     .argument = "N",                                                                              \
     .offset = offsetof(type, member.f_number),                                                    \
     .least = 0,                                                                                   \
     .above = true,                                                                                \
     .greatest = 1000,                                                                             \
     .help = "blur of a lens of this f-number, at most 127 pixels; where the depth "               \
             "has no metres, the blur that the file names, or the default, which "                 \
             "stands for the f-number of the file, or f/2, made more or less"},                    \
        {.kind = OPTION_NUMBER,                                                                    \
         .name = "--focal-length",                                                                 \
         .argument = "MM",                                                                         \
         .offset = offsetof(type, member.focal_length),                                            \
         .least = 0,                                                                               \
         .above = true,                                                                            \
         .greatest = 100000,                                                                       \
         .help = "focal length for --f-number; default: the EXIF focal length in 35 mm "           \
                 "terms, for the blur that a full-frame camera has at that f-number"},             \
    {                                                                                              \
        .kind = OPTION_NUMBER, .name = "--sensor-width", .argument = "MM",                         \
        .offset = offsetof(type, member.sensor_width), .least = 0, .above = true,                  \
        .greatest = 10000,                                                                         \
        .help = "width of the sensor area that the picture shows, with --focal-length; "           \
                "default: 36 mm for the larger side of the picture"                                \
    }

struct input {
    const char *photo_name, *depth_name;
    struct refocus_photo *photo;
    struct refocus_photo *side;             /* a depth file of its own, or NULL */
    const struct refocus_photo *depth_from; /* one of the two */
    struct refocus_photo made;              /* its depth: made of pictures, samples
                                               below */
    float *made_samples;
    uint16_t *disparity; /* packed */
    uint8_t *confidence; /* of each sample of the map: 0 = filled */
    int width, height;   /* of the disparities: the map's, or the
                            photo's */
    struct refocus_depth_report report;
};

/* These return exit codes and print why it is not EXIT_DONE. */
int input_check_depth(const struct depth_settings *settings);
int input_check_lens(const struct lens_settings *settings);

/* Whether the settings say what is in focus. */
bool input_focus_is_given(const struct lens_settings *settings);

/* Read a photo into a new input, which it names; ended by input_free(), also after an
 * error. What to give instead of a depth map ends the words of that error. */
int input_read_photo(struct input *input, const char *photo, const char *instead);

/* One line where a photo has more than the 8 bits a channel that are rendered. */
void input_tell_bits(const struct refocus_photo *photo, const char *name);

/* Read a photo and its depth; ended by input_free(), also after an error. */
int input_read(struct input *input, const char *photo, const struct depth_settings *settings);

/* Read a depth file, or the depth of a photo; input->photo is NULL afterwards. */
int input_read_depth(struct input *input, const char *file, const struct depth_settings *settings);
/* Read a photo, and make depth: of it and the right one of a stereo pair, NULL when
 * they lie side by side in one, or within the file as two pictures; or by a network. */
int input_read_stereo(struct input *input, const char *left, const char *right,
                      const struct stereo_settings *how, const struct depth_settings *settings);
int input_read_estimate(struct input *input, const char *photo, const char *model,
                        const struct network_settings *network,
                        const struct depth_settings *settings);
/* The last steps of both: input->made is of the photo. */
int input_convert(struct input *input, const struct depth_settings *settings);
void input_free(struct input *input);

/* K of the settings; a warning says when --f-number could not be taken at its word. */
int input_blur(const struct input *input, const struct lens_settings *settings, double *blur);

/* The same without a warning, and the f-number that has that blur; NAN: none was given. */
int input_blur_and_f_number(const struct input *input, const struct lens_settings *settings,
                            double *blur, double *f_number);

/* How input_blur() came by it, for reports: "blur_from" and "f_number", the one that has
 * that blur. */
json_t *input_blur_json(const struct input *input, const struct lens_settings *settings);

/* df of the settings; prepared: the packed disparities of the photo's size. */
int input_focus(const struct input *input, const struct lens_settings *settings,
                const uint16_t *prepared, double *focus);

/* Disparity of the surface at a pixel: refocus_focus_at_point(). */
double input_surface_at(const uint16_t *disparity, int width, int height, int x, int y);

/* Exit code for what a function of the file library returned. */
int input_exit_code(int status);

#endif
