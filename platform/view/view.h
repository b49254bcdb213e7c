/* view.h: the window of `refocus view` as the command calls it. */
#ifndef RF_VIEW_VIEW_H
#define RF_VIEW_VIEW_H

#include "session.h"

/* From an event to the first picture that answers it, and to the full one;
 * milliseconds, < 0 when something newer came before it. */
struct rf_view_time {
    const char *cause; /* "open", "tap", "aperture", "release", "zoom", "size" or the name of
                          a key's action */
    double first_ms, full_ms;
    double first_cpu_ms; /* processor time of all threads up to the first one */
};

struct rf_view_setup {
    struct rf_session_setup session; /* filled but for notify, which is the window's */
    struct rf_view_state state;      /* focus, blur and method to begin with */
    const char *title;               /* UTF-8 */
    double dpi;                      /* dots per inch; 0: as the screen says */
    const char *font;                /* a file, NULL: one that systems have, or "none" */
    /* Words about the lens of a state; NULL: plain ones. */
    void (*describe)(void *user, const struct rf_view_state *state, char *words, size_t size);
    void *describe_user;
    uint32_t methods;  /* REFOCUS_METHOD_BIT() of those to choose from, or-ed; 0 = all */
    int width, height; /* size of the window; 0 = as large as the photo asks for */
    bool fullscreen;
    int (*stop)(void *user); /* polled: not 0 = end; may be NULL */
    void *stop_user;
    int quit_after_ms; /* 0 = never */
};

enum { RF_VIEW_TIMES = 4096 };
struct rf_view_report {
    struct rf_view_time times[RF_VIEW_TIMES];
    int count;
    char driver[32];   /* SDL's driver: "x11", "wayland", "kmsdrm", ... */
    int width, height; /* size of the window, pixels */
    int reduction;     /* reduction of the first pictures */
    struct rf_view_state last;
};

#if defined(__GNUC__)
#define RF_VIEW_CALL __attribute__((visibility("default")))
#else
#define RF_VIEW_CALL
#endif

/* Show the window until it is closed. Returns REFOCUS_OK or a status, with words in
 * reason (256 bytes). To be called from the main thread. */
RF_VIEW_CALL int rf_view_run(const struct rf_view_setup *setup, struct rf_view_report *report,
                             char *reason);

#endif
