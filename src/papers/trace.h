/* trace.h: rays through the picture in double precision, for raytrace and jittered. */
#ifndef RF_TRACE_H
#define RF_TRACE_H

#include "gather/frame.h"

/* A ray covers at most K + 2 pixels along its longer axis. */
enum { RF_MAX_STEPS = REFOCUS_PLAIN_BLUR_RADIUS + 3 };

/* A pixel on the way of a ray and the disparities that the ray can hit there. */
struct rf_step {
    int16_t dx, dy;
    uint16_t low, width; /* a hit if 0 <= d - low <= width */
    ptrdiff_t offset;    /* in f->disparity.at */
};

struct rf_path {
    double u, v;
    bool central; /* the ray through the middle of the lens hits its own pixel */
    int steps;    /* from the nearest plane to the farthest */
    struct rf_step step[RF_MAX_STEPS];
};

/* The least and the largest blur K (df - d), in pixels, that rays of a tile can hit. */
struct rf_blur_range {
    double least, most;
};
struct rf_blur_range rf_blur_range_of(const struct rf_frame *f, int tx, int ty);

/* Finds the way of ray (u, v), which is the same for every pixel of a tile: the part of it where
 * there can be a hit. */
void rf_path_of(const struct rf_frame *f, struct rf_blur_range reach, double u, double v,
                struct rf_path *path);

/* Sums of eq. 5 over the exact curve of the blend, for the pixels of a tile. */
struct rf_exact_sums {
    double light[RF_TILE * RF_TILE][3];
    double weight[RF_TILE * RF_TILE];
};

/* Adds the light of the ray of (x, y) to the sums: that of the front-most hit, or where there is
 * none that of the pixel mirrored about (x, y). */
void rf_path_add(const struct rf_frame *f, const struct rf_path *path, int x, int y, double weight,
                 struct rf_exact_sums *sums);

/* Writes the means to the output picture. */
void rf_exact_write(const struct rf_frame *f, struct rf_rect rect,
                    const struct rf_exact_sums *sums);

#endif
