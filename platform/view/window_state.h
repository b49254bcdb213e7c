/* window_state.h: the state of the window: what is shown, what is pressed. */
#ifndef RF_VIEW_WINDOW_STATE_H
#define RF_VIEW_WINDOW_STATE_H

#include <SDL.h>
#include "sdl/text.h"
#include "view.h"

enum rf_action {
    RF_ACT_NONE,
    RF_ACT_METHOD,
    RF_ACT_DEPTH,
    RF_ACT_PEAKING,
    RF_ACT_BEFORE,
    RF_ACT_FIT,
    RF_ACT_PIXELS,
    RF_ACT_SAVE_PICTURE,
    RF_ACT_SAVE_SETTINGS,
    RF_ACT_SAVE_DEPTH,
    RF_ACT_HELP,
    RF_ACT_QUIT,
};

/* A request that is not answered wholly. */
struct rf_pending {
    uint64_t request;
    int time; /* index in the report */
};

enum { RF_PENDING = 64 };

struct rf_window {
    const struct rf_view_setup *setup;
    struct rf_view_report *report;
    struct rf_session *session;
    struct rf_view_state state;

    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
    int texture_width, texture_height;
    int width, height;         /* pixels of what is drawn */
    double density;            /* pixels in a unit of the mouse's places */
    double unit;               /* pixels in 1/96 inch of the screen */
    struct rf_text *text;      /* NULL: no font */
    char words[RF_VIEW_WORDS]; /* words that stand in the line until the next request, or "" */
    int line_end;              /* column after the words in the line */
    const struct rf_view_frame *frame;
    Uint32 frame_event;
    bool redraw, quit, help;
    bool used;   /* focus, aperture or size were changed */
    bool fitted; /* the whole photo is shown, also after a change of size */

    bool pressed, dragged, panning;
    bool two_fingers;                        /* until all are lifted */
    double press_x, press_y, last_x, last_y; /* pixels of the window */
    double press_blur;
    uint64_t taps;

    struct rf_pending pending[RF_PENDING];
    int pending_count;
};

#endif
