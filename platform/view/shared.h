/* shared.h: the state that the calls of a session and its thread share. */
#ifndef RF_VIEW_SHARED_H
#define RF_VIEW_SHARED_H

#include <pthread.h>
#include "view_state.h"

/* Pixels of the reduced photo: a picture of them in a few hundredths of a second. */
enum { PREVIEW_PIXELS = 600000, PREVIEW_RAYS = 32 };

struct rf_session {
    struct rf_session_setup setup;
    int reduction, width, height; /* size of the reduced photo */

    pthread_t thread;
    bool started;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    /* Under the lock. */
    struct rf_view_state state;
    uint64_t request, answered; /* the newest one, and the last that is wholly done */
    uint32_t save;
    bool shown, quit, finished;
    bool rendering;    /* the full picture, */
    uint64_t rendered; /* the request that it is for */
    int status;
    char words[RF_VIEW_WORDS]; /* words about what was saved, or "" */
    struct rf_view_frame frames[3];
    int front, ready, back; /* ready: -1 when it was taken */

    /* The thread's own. */
    struct refocus_renderer *small, *full;
    uint8_t *small_photo, *small_out, *full_out;
    uint16_t *small_disparity;
    uint32_t *scratch;
    int scratch_room;
    bool small_prepared, full_prepared;
    bool full_deep;             /* the full renderer is prepared with all that the photo holds */
    bool have_full;             /* full_out is what full_of says */
    struct refocus_image light; /* light of full_out, if it is kept; no plane: there is none */
    struct refocus_settings full_of;
};

#endif
