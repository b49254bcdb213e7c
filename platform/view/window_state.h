/* window_state.h: the state of the window: what is shown, which tool is active, what is pressed. */
#ifndef RF_VIEW_WINDOW_STATE_H
#define RF_VIEW_WINDOW_STATE_H

#include <SDL.h>
#include "view.h"

enum rf_tool { RF_TOOL_FOCUS, RF_TOOL_PAINT, RF_TOOL_GRADIENT };

enum rf_action {
    RF_ACT_NONE,
    RF_ACT_FOCUS,
    RF_ACT_PAINT,
    RF_ACT_MORE,
    RF_ACT_LESS,
    RF_ACT_BRUSH,
    RF_ACT_GROUND,
    RF_ACT_GRADIENT,
    RF_ACT_FILL,
    RF_ACT_NEARER,
    RF_ACT_FARTHER,
    RF_ACT_LARGER,
    RF_ACT_SMALLER,
    RF_ACT_UNDO,
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
    RF_ACT_SETTINGS,
    RF_ACT_QUIT,
    RF_ACTIONS
};

/* A request that is not answered wholly. */
struct rf_pending {
    uint64_t request;
    int time; /* index in the report */
};

enum { RF_PENDING = 64, RF_PATH = 4096 };

struct rf_window {
    const struct rf_view_setup *setup;
    struct rf_view_report *report;
    struct rf_session *session;
    struct rf_view_state state;

    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
    int texture_width, texture_height;
    int width, height; /* pixels of what is drawn */
    double density;    /* pixels in a unit of the mouse's places */
    const struct rf_view_frame *frame;
    Uint32 frame_event;
    bool redraw, quit, help, settings;
    bool fitted; /* the whole photo is shown, also after a change of size */

    enum rf_tool tool;
    uint32_t stroke_kind; /* kind of the next stroke, enum refocus_stroke_kind */
    double brush;         /* radius, pixels of the window */
    double value;         /* disparity to fill with */
    bool pressed, dragged, painting, panning;
    bool two_fingers;                        /* until all are lifted */
    double press_x, press_y, last_x, last_y; /* pixels of the window */
    double press_blur;
    Uint64 press_counter; /* when */
    SDL_FPoint path[RF_PATH];
    int path_count;
    uint64_t taps;

    struct rf_pending pending[RF_PENDING];
    int pending_count;
};

#endif
