/* shot.h: one photo that is read and prepared, with its lens setting in engine.params. */
#ifndef RF_CLI_SHOT_H
#define RF_CLI_SHOT_H

#include "inputs/behind.h"
#include "inputs/read_input.h"
#include "inputs/lens.h"
#include "settings/config.h"
#include "settings/settings.h"
#include "shot/engine.h"

/* The settings that all commands share which make pictures of a photo. */
struct shot_settings {
    struct depth_settings depth;
    struct behind_settings behind;
    struct lens_settings lens;
    struct engine_settings engine;
    const char *load, *save;     /* files of settings, or NULL */
    const char *config, *preset; /* parts of the configuration, or NULL */
};

#define SHOT_SETTINGS_NONE                                                                         \
    {                                                                                              \
        .depth = DEPTH_SETTINGS_NONE, .lens = LENS_SETTINGS_NONE,                                  \
        .engine = ENGINE_SETTINGS_NONE(QUALITY_AUTO, 1)                                            \
    }

/* The options of its depth are here; those of lens and method stand in shot_options.h. */
extern const struct option shot_depth_options[];

struct shot {
    struct input input;
    uint16_t *full; /* disparities of the photo's size that are rendered in strips, or NULL */
    struct behind behind;
    struct engine engine;
    struct refocus_disparity map; /* the depth of the scene */
    bool adds_grain; /* pictures of 8 bits have grain, which no option gives or refuses */
    bool deep;       /* all that the photo holds is prepared, not its 8 bits */
    bool told;       /* a line has said that 8 bits are taken */
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Called before a photo is read: settle values that options take from each other, and refuse
 * options that do not go together. own_focus: each picture has a focus of its own, whatever the
 * lens settings say. */
int shot_check(struct shot_settings *settings, bool own_focus);

/* The files that a picture is made of, some of which may be NULL, and their number: for
 * checks that none of them is written over. */
enum { SHOT_INPUTS = 14 };
int shot_inputs(const struct shot_settings *settings, const char *photo,
                const char *inputs[SHOT_INPUTS]);

/* Set what single methods take of the photo where no option says it: papers_suit(). */
void shot_suit_papers(const struct input *input, const struct lens_settings *lens,
                      const struct paper_settings *papers, struct refocus_settings *params);

/* Focus by the settings and packed disparities of the photo's size, and the plane of
 * focus through it. */
int shot_aim(const struct input *input, const struct lens_settings *lens,
             const struct controls *controls, const uint16_t *disparity,
             struct refocus_settings *params);

/* Give back what no picture needs that was rendered, and fill `out` where that went to a file;
 * shot_close() is still to come. */
int shot_rendered(struct shot *shot, const struct refocus_image *out);

/* Take of deep photos, and of gain maps, what a picture of that name is made of: `render` and the
 * other commands then make the same pixels. 8-bit pictures are made of dithered codes, which keeps
 * shallow gradients, unless there is light above white. NULL: a picture of 8 bits. */
void shot_suit_output(struct depth_settings *depth, const char *output);

/* Whether a picture of these settings is made of all that the photo holds, or of its 8 bits. */
bool shot_takes_deep(const struct input *input, const struct refocus_settings *params);

/* The answer of shot_takes_deep(), where no option gives or refuses grain (adds_grain): pictures of
 * 8 bits get it in `params`, and deep ones lose it. */
bool shot_choose_bits(const struct input *input, bool adds_grain, struct refocus_settings *params);

/* most_blur: what the renderer is made for, where that is more than the settings' blur;
 * 0: that. Ended by shot_close(), whatever it returned. */
int shot_open(struct shot *shot, const char *photo, const struct shot_settings *settings,
              double most_blur);
void shot_close(struct shot *shot);

/* The two halves of shot_open(), for several methods on one photo: files are read for the settings
 * that take most of it, and the engine is widened to all methods before the photo is prepared. */
int shot_begin(struct shot *shot, const char *photo, const struct shot_settings *settings);
int shot_prepare(struct shot *shot, const struct shot_settings *settings, double most_blur);

/* Called before engine_render() with settings that may take the photo otherwise than those before
 * them: it is prepared anew where a picture takes all that it holds and the last one took 8 bits.
 */
int shot_suit(struct shot *shot);

/* A picture of the whole photo, without memory and stride, as deep as a file of that name and,
 * where all that the photo holds is rendered (deep), the photo are; NULL: of 8 bits. */
struct refocus_image shot_picture(const struct input *input, bool deep, const char *output);

/* A picture to render into, of the whole photo or, where region[0] is not NAN, of X, Y,
 * width and height in it; plane[0] is to be freed. It is as deep as the photo and a file of that
 * name are; NULL: of 8 bits. */
int shot_output(struct shot *shot, const double region[4], const char *output,
                struct refocus_image *out);

#endif
