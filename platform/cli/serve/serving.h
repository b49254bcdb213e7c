/* serving.h: a process of `refocus serve` that has a photo open and answers requests for it, one
 * after the other. */
#ifndef RF_CLI_SERVE_SERVING_H
#define RF_CLI_SERVE_SERVING_H

#include <refocus/platform/strokes.h>
#include "live/live_feed.h"
#include "shot/shot.h"
#include "web/web.h"

/* Statuses of HTTP. */
enum {
    ANSWER_DONE = 200,
    ANSWER_WRONG = 400,
    ANSWER_REPLACED = 409,
    ANSWER_NOT_A_PHOTO = 422,
    ANSWER_FAILED = 500,
};

/* The most pixels of a reduced photo, and of its longer side. */
enum { SERVE_QUICK_PIXELS = 600000, SERVE_QUICK_SIDE = 1024, SERVE_QUICK_QUALITY = 85 };

enum { SERVE_PULL_SECONDS = 20 }; /* the longest focus pull */

/* A full renderer can do again what it was made for. */
struct made_for {
    uint32_t methods;
    bool thin, textured, deep, edges;
    bool in_strips; /* memory was too little for the whole photo: it is for one picture */
};

/* Settings of the command line, for every process. */
struct serve_base {
    struct shot_settings shot;
    struct live_settings live;
};

struct serving {
    const struct rf_web_work *work;
    const struct live_settings *live;
    struct live_feed *feed;  /* frames of cameras; NULL: it is a photo */
    uint32_t frame;          /* number of the one that is seen */
    struct live_frame taken; /* the frame that `input` is made of, as a photo */
    struct refocus_photo as_photo;
    struct refocus_photo_info no_info;
    struct refocus_image no_image;
    struct refocus_depth_map no_depth;
    struct shot_settings base; /* settings of the command line */
    struct input input;
    uint16_t *placed;                /* disparities of the photo's size, or all 0 */
    bool has_depth;                  /* the photo has some of its own */
    struct refocus_strokes *strokes; /* painted over it, or NULL */
    json_t *draft;                   /* the last stroke, while it is not finished, or NULL */
    json_t *undone;                  /* strokes that can be done again, the last one first to be */

    int reduction, width, height; /* size of the reduced photo */
    uint8_t *small_photo;
    uint16_t *small_disparity;
    struct refocus_renderer *small, *full;
    struct made_for made_for;
    bool small_stale, full_stale; /* the depth has changed since it was prepared */

    char why[1024]; /* the last failure */
};

/* answer.c: each request gets one of these. */

/* Send a reply; the bytes are freed. */
void answer_bytes(struct serving *s, const char *type, const char *ending, void *bytes,
                  size_t size);
void answer_json(struct serving *s, json_t *object);
/* Send the last failure. */
void answer_failure(struct serving *s, int status);
/* Note whether the photo has depth, for the next reply. */
void answer_depth(int depth);

/* Note the number of the frame that is seen, for the next reply. */
void answer_frame(uint32_t number);

/* work.c: a picture that something newer makes out of date. */

/* The renderer that is ended early then, or NULL. */
void serve_watch(struct refocus_renderer *renderer);
bool serve_is_replaced(void);

/* settings.c */

/* The command whose options are the members of settings that come from the page. */
extern const struct command page_settings;

/* Read settings from the page over those of the command line, each by itself: shot_check() is still
 * to come. An exit code, and reports why. */
int page_settings_read(const char *bytes, size_t size, const struct shot_settings *base,
                       struct shot_settings *settings);

/* open.c: these return exit codes and report why it is not EXIT_DONE. */
int serve_open(struct serving *s);
void serve_answer_session(struct serving *s);
void serve_answer_thumbnail(struct serving *s);
void serve_answer_focus(struct serving *s, const char *bytes, size_t size);

/* Make what follows from the photo and its size: the reduced one. An exit code. */
int serve_reduce(struct serving *s);

/* The least and the greatest disparity, null without depth. */
json_t *serve_range_json(const struct serving *s);

/* live.c: frames of cameras in place of a photo; exit codes. */

/* The settings when no camera is given, and the check of those that are. */
void serve_live_none(struct serve_base *base);
int serve_live_check(struct serve_base *base);
int serve_live_open(struct serving *s);
/* The frame as a JPEG with its depth, as cameras take it: in focus everywhere. */
int serve_live_still(struct serving *s, struct refocus_blob *bytes);
void serve_answer_live_frame(struct serving *s, const struct rf_web_ask *ask, const char *bytes);

/* Whether something is painted over the photo's depth. */
bool serve_is_painted(const struct serving *s);

/* The disparities of the photo's size as they are painted. */
const uint16_t *serve_disparity(const struct serving *s);

/* picture.c: the settings of a request, which are checked; an exit code. */
int serve_settings(const struct serving *s, const char *bytes, size_t size,
                   struct shot_settings *settings);

/* The settings of a request, or false, after it has been answered with what is wrong with them. */
bool serve_has_settings(struct serving *s, const struct rf_web_ask *ask, const char *bytes,
                        struct shot_settings *settings);

/* Give back the full renderer, which the next full picture makes anew. */
void serve_release_full(struct serving *s);

/* A picture, whose plane[0] is to be freed; exit codes. engine: receives what rendered
 * it, without its renderer, and is ended by engine_end(), whatever is returned. */
int serve_render(struct serving *s, const struct shot_settings *settings, bool keeps_light,
                 struct engine *engine, struct refocus_image *out);
void serve_answer_picture(struct serving *s, const struct rf_web_ask *ask, const char *bytes);

/* The lens of settings for the whole photo, after engine_begin(). */
int serve_lens_of(const struct serving *s, const struct shot_settings *settings,
                  struct engine *engine);
/* EXIT_DONE, or report what a status of the library means. */
int serve_failed(const struct serving *s, int status);
int serve_new_picture(const struct serving *s, int width, int height, struct refocus_image *out);
/* Make a picture fit into so many pixels each way; 0: it stays. */
int serve_fit(const struct serving *s, int size, struct refocus_image *picture);
/* Answer with a JPEG of a picture, which is freed, or with why there is none. quality 0: the
 * usual. */
void serve_answer_rendered(struct serving *s, int status, int size, int quality,
                           struct refocus_image *picture);

/* quick.c: pictures of the reduced photo. */
int serve_aim(struct serving *s, const struct shot_settings *settings, struct engine *engine);
/* params: the lens for the whole photo, which becomes that for the reduced one. */
int serve_render_reduced(struct serving *s, struct refocus_settings *params, int most_rays,
                         struct refocus_image *out);
int serve_render_quick(struct serving *s, const struct shot_settings *settings,
                       struct engine *engine, struct refocus_image *out);
/* A view by its kind: depth, blur, peaking; of a live frame "picture", too. */
void serve_answer_overlay(struct serving *s, const struct rf_web_ask *ask, const char *bytes);

/* pull.c */
void serve_answer_pull(struct serving *s, const struct rf_web_ask *ask, const char *bytes);
/* The formats of pulls that can be written here. */
json_t *serve_films_json(void);

/* save.c */
void serve_answer_save(struct serving *s, const struct rf_web_ask *ask, const char *bytes);
/* Write a picture into memory, in the format of that ending. */
int serve_encode(const char *ending, const struct refocus_image *image,
                 const struct refocus_write_options *options, struct refocus_blob *bytes);

/* serve_temporary() names a new file for a short time. serve_take_back() reads what was written
 * into it, if `status`, that of writing it, is EXIT_DONE, then removes the file and frees its name.
 * Exit codes. */
int serve_temporary(const char *ending, char **path);
int serve_take_back(int status, char *path, struct refocus_blob *bytes);

/* paint.c: a draft is a stroke under the finger: it is replaced by the next one, or by the stroke
 * that it has become, and answered with what it selects. */
void serve_answer_draft(struct serving *s, const char *bytes, size_t size);
void serve_answer_stroke(struct serving *s, const char *bytes, size_t size);
void serve_answer_undo(struct serving *s, bool redo);
void serve_answer_strokes(struct serving *s);

/* The life of the process. */
void serve_work(void *of, const struct rf_web_work *work);

#endif
