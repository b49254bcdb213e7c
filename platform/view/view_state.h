/* view_state.h: the state that a picture of the viewer depends on, and the picture itself. */
#ifndef RF_VIEW_STATE_H
#define RF_VIEW_STATE_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/settings.h>

enum rf_view_mode { RF_VIEW_RESULT, RF_VIEW_BEFORE, RF_VIEW_DEPTH, RF_VIEW_MODES };

/* Everything that a picture depends on beside the photo and its depth. */
struct rf_view_state {
    float focus;         /* df; where focus_tap is set, what was found there */
    uint64_t focus_tap;  /* 0: focus holds; else the number of the tap at tap_x, tap_y */
    double tap_x, tap_y; /* pixel of the photo */
    float blur;          /* K in pixels of the photo */
    uint32_t method;     /* enum refocus_method */
    uint32_t mode;       /* enum rf_view_mode */
    bool hold;           /* quick pictures only, as long as something is being dragged */
    bool peaking;        /* mark what is sharp */
    double x, y, scale;  /* photo pixel at the window's corner; window pixels a photo pixel */
    int width, height;   /* size of the window, 1 to 16384 */
};

/* A picture for the window: 0xffRRGGBB, packed. */
struct rf_view_frame {
    uint32_t *pixels;
    int room;
    struct rf_view_state of; /* the state it shows, with the focus that was found */
    uint64_t request;        /* number of the request that it answers */
    bool full;               /* it has the whole photo's resolution, not a reduced one */
};

/* The things that can be written; the callback gets it on the session's thread. */
enum rf_view_save { RF_SAVE_PICTURE = 1, RF_SAVE_SETTINGS = 2, RF_SAVE_DEPTH = 4 };
struct rf_view_result {
    uint32_t what; /* enum rf_view_save, or-ed */
    const struct refocus_image *picture;
    const struct refocus_image *light; /* as the session's keeps_light asks for it, or NULL */
    const struct refocus_settings *params;
    const uint16_t *disparity;         /* the photo's disparities, packed */
    const struct rf_view_state *state; /* the state, with the focus that was found */
};

enum { RF_VIEW_WORDS = 256 };
struct rf_session_setup {
    const struct refocus_image *photo; /* RGB8; the caller's, until the end */
    /* All that the photo holds, of its size and in a deep format, or NULL; the caller's, too. Full
     * pictures are made of it where takes_deep() says so, quick ones of `photo`. */
    const struct refocus_image *deep;
    /* Whether a picture of params is made of `deep`; what has to be otherwise then, it changes. */
    bool (*takes_deep)(void *user, struct refocus_settings *params);
    /* Bring a picture of linear light, REFOCUS_FORMAT_RGB_HALF, into the 8 bits of the photo's
     * tones: a status. NULL: the renderer makes the 8 bits itself. */
    int (*to_tones)(void *user, const struct refocus_image *light,
                    const struct refocus_settings *params, const struct refocus_image *out);
    void *deep_user; /* the first argument of both; they run on the session's thread */
    /* The format, transfer and white of pictures that are saved of `deep`; REFOCUS_FORMAT_NONE:
     * they are RGB8, as those that are shown. The rest of it does not count. */
    struct refocus_image saved;
    bool keeps_light;          /* pictures that are saved want what to_tones() was given */
    const uint16_t *disparity; /* disparities of its size, packed; the caller's, too */
    const struct refocus_disparity
        *matte;                     /* matte of any size, or NULL; the caller's, until the end */
    struct refocus_settings params; /* the settings that the state does not hold */
    bool still_rays; /* pictures that are saved have, by the sweep, the rays that a still of their
                        blur takes; those that are shown have the rays of params */
    /* Set other parameters that follow from a focus that was found: it changes params, which have
     * it, the method and the blur already; lengths in pixels are the photo's. From the session's
     * thread; NULL: nothing. */
    void (*aim)(void *user, const struct rf_view_state *state, struct refocus_settings *params);
    void *aim_user;
    int threads;
    uint32_t cpu;
    void (*notify)(void *user); /* a frame is there; from the session's thread */
    void *notify_user;
    /* From the session's thread; words: what the window is to say of it. */
    void (*save)(void *user, const struct rf_view_result *result, char words[RF_VIEW_WORDS]);
    void *save_user;
};

#endif
