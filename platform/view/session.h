/* What a viewer shows, worked out on a thread of its own: no call here waits for a
 * picture. */
#ifndef RF_VIEW_SESSION_H
#define RF_VIEW_SESSION_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/render.h>
#include <refocus/platform/strokes.h>

struct rf_session;

enum rf_view_mode { RF_VIEW_RESULT, RF_VIEW_BEFORE, RF_VIEW_DEPTH, RF_VIEW_MODES };

/* All that a picture depends on beside the photo and its depth. */
struct rf_view_state {
    float focus;         /* df; where focus_tap is set, what was found there */
    uint64_t focus_tap;  /* 0: focus holds; else the number of the tap at tap_x, tap_y */
    double tap_x, tap_y; /* pixel of the photo */
    float blur;          /* K in pixels of the photo */
    uint32_t method;     /* enum refocus_method */
    uint32_t mode;       /* enum rf_view_mode */
    bool hold;           /* quick pictures only, as long as something is being dragged */
    bool peaking;        /* mark what is sharp */
    bool selection;      /* mark what the last layer of the painting covers */
    double x, y, scale;  /* photo pixel at the window's corner; window pixels a photo pixel */
    int width, height;   /* of the window, 1 to 16384 */
};

/* A picture for the window: 0xffRRGGBB, packed. */
struct rf_view_frame {
    uint32_t *pixels;
    int room;
    struct rf_view_state of; /* with the focus that was found */
    uint64_t request;        /* which one it answers */
    bool full;               /* of the whole photo's resolution, not of a reduced one */
    int strokes;             /* that the painting has */
};

/* What can be written; the callback gets it on the session's thread. */
enum rf_view_save { RF_SAVE_PICTURE = 1, RF_SAVE_SETTINGS = 2, RF_SAVE_DEPTH = 4 };
struct rf_view_result {
    uint32_t what; /* enum rf_view_save, or-ed */
    const struct refocus_image *picture;
    const struct refocus_render_params *params;
    const uint16_t *disparity; /* of the photo's size, packed */
    const struct refocus_strokes *strokes;
    const struct rf_view_state *state; /* with the focus that was found */
};

struct rf_session_setup {
    const struct refocus_image *photo;   /* RGB8; the caller's, until the end */
    const uint16_t *disparity;           /* of its size, packed; NULL: all 0. Copied */
    struct refocus_strokes *strokes;     /* the painting so far, over those disparities,
                                            or NULL: none. The caller's, but the
                                            session's to change until its end */
    struct refocus_render_params params; /* what the state does not say */
    /* What else follows from a focus that was found: changes params, which have it, the
     * method and the blur already; lengths in pixels are the photo's. From the
     * session's thread; NULL: nothing. */
    void (*aim)(void *user, const struct rf_view_state *state,
                struct refocus_render_params *params);
    void *aim_user;
    int threads;
    uint32_t cpu;
    void (*notify)(void *user); /* a frame is there; from the session's thread */
    void *notify_user;
    void (*save)(void *user, const struct rf_view_result *result);
    void *save_user;
};

/* REFOCUS_OK, REFOCUS_ERR_MEMORY, REFOCUS_ERR_THREAD, REFOCUS_ERR_SIZE. */
int rf_session_create(struct rf_session **session, const struct rf_session_setup *setup);
void rf_session_destroy(struct rf_session **session);

/* These return the number of the request, which frames answer; 0 = no memory for it. A
 * newer request replaces one that is not done. */
uint64_t rf_session_show(struct rf_session *session, const struct rf_view_state *state);
uint64_t rf_session_begin(struct rf_session *session, const struct refocus_stroke *stroke,
                          bool end_from_depth);
uint64_t rf_session_extend(struct rf_session *session, float x, float y);
uint64_t rf_session_undo(struct rf_session *session);
uint64_t rf_session_save(struct rf_session *session, uint32_t what);

/* To be called some times a second: ends work on requests that are out of date. */
void rf_session_tick(struct rf_session *session);

/* The newest frame, when there is one that was not taken yet: it stays the caller's
 * until the next call that returns true. */
bool rf_session_frame(struct rf_session *session, const struct rf_view_frame **frame);

/* The first status that was no success: the thread goes on with what it can. */
int rf_session_status(struct rf_session *session);

/* Pixels of a photo for one of the reduced picture, each way. */
int rf_session_reduction(const struct rf_session *session);

#endif
