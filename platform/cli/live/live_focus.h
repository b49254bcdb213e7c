/* live_focus.h: focus and blur as commands and the camera's lens ask for them. */
#ifndef RF_CLI_LIVE_FOCUS_H
#define RF_CLI_LIVE_FOCUS_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include "inputs/lens.h"
#include "live/live_range.h"

/* Something to focus on. A point is looked up in the next frame, and is a distance from then on,
 * or a disparity where distances are not known. */
struct live_target {
    bool known;             /* false: the disparity at the point has not been read yet */
    bool dioptres;          /* value is 1/m, else a disparity */
    bool follows_lens;      /* where the camera's own lens is, if it says so */
    double value, point[2]; /* the point NAN: the centre */
};

struct live_focus {
    pthread_mutex_t lock;
    bool made;                   /* the lock is there */
    struct live_target from, to; /* a pull from one to the other */
    int64_t begin_ns, duration_ns;
    bool begun; /* at begin_ns; else it begins with the next frame */
    int64_t now_ns;
    struct live_range range; /* time and range of the present frame */
    double blur, blur_most;
    double stretch;     /* K as a multiple of --blur, after the range has moved; 1 once it has stood
                           still for long */
    bool blur_asked;    /* by a command */
    double per_dioptre; /* 0, or K of a lens for a scene 1/m deep, which holds in place of blur */
    int width, height;  /* size of the pictures; 0: none has come */
    double rectangle[4]; /* x, y, width, height of what is followed; NAN: nothing is */
    uint64_t rectangles; /* Rectangles asked for so far. */
};

/* False: there is no lock to be had; live_focus_free() is right even so. */
bool live_focus_init(struct live_focus *focus, const struct lens_settings *lens);
void live_focus_free(struct live_focus *focus);
/* A line of commands, which holds from the next frame on; false: it is not understood, and why.
 * *quit is set by "quit". */
bool live_focus_command(struct live_focus *focus, const char *line, bool *quit, char *why,
                        size_t size);
/* A frame, and when it was taken: pulls go on by that, and not by when it is worked on. The lens
 * of its camera is given, or NAN, and the range of its disparities, which becomes as wide as it
 * must be to hold what is in focus. */
void live_focus_frame(struct live_focus *focus, int64_t now_ns, double lens_dioptres,
                      struct live_range *range);
/* Whether there is a point to look up in that frame, for live_focus_found(). */
bool live_focus_point(struct live_focus *focus, double point[2]);
/* The pixel that is focused on, or will be after the pull; NAN: none was said. */
void live_focus_looked_at(struct live_focus *focus, double point[2]);
void live_focus_found(struct live_focus *focus, const double point[2], double disparity);
/* The rectangle that is to be followed from the frame on in which *asked, that of the last call, is
 * not the number that it receives; false: none is. */
bool live_focus_rectangle(struct live_focus *focus, double rectangle[4], uint64_t *asked);
/* Whether a rectangle lies within the pictures, as far as their size is known. */
bool live_focus_has_inside(const struct live_focus *focus, const double box[4]);
/* The subject has that disparity: the focus goes there within some tenths of a second, and to
 * a first one at once. */
void live_focus_follow(struct live_focus *focus, double disparity, bool first, double seconds);
/* The disparity in focus and the blur that hold for that frame. */
void live_focus_get(struct live_focus *focus, double *disparity, double *blur);
/* From now on the blur is that of a lens whose K is so much for a scene 1/m deep, until the command
 * "blur" says another; without a range of distances nothing is blurred. */
void live_focus_lens(struct live_focus *focus, double per_dioptre);
/* The size of the pictures, beyond which points are refused. */
void live_focus_size(struct live_focus *focus, int width, int height);

#endif
