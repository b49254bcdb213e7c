/* look.h: what is laid over the finished picture: spikes of a star filter, and film grain.
 *
 * Both change pixels that are already encoded, tile by tile, and only where there is something to
 * add.
 */
#ifndef RF_LOOK_H
#define RF_LOOK_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "focus/focus.h"
#include "highlights/highlights.h"
#include "image/photo_source.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"

/* Most stars of a picture; the highlights after them, row by row, have no spikes. */
enum { RF_MOST_STARS = 1024, RF_MOST_SPIKES = 16 };

enum {
    RF_NOISE_LEVELS = 8,
    RF_NOISE_WIDTH = 256 / RF_NOISE_LEVELS, /* codes of a level */
    RF_NOISE_BINS = 960,
    RF_GRAIN_PLACES = 1024,
    RF_GRAIN_UNIT = 128, /* unit of weights of smoothed noise */
};

/* A highlight with spikes: its place in 1/16 pixel, its light, and its blur radius, Q7.8. */
struct rf_star {
    int64_t x, y;
    uint64_t light[3]; /* Q12, summed over its pixels */
    int32_t blur;
    int32_t pixels;
    int32_t x0, x1, y1; /* bounds of the pixels */
};

struct rf_stars {
    struct rf_star *star; /* room for RF_MOST_STARS */
    int count;
};

/* Grain of the photo, measured where it is smooth. */
struct rf_grain {
    /* number of blocks by luma and by variance between every other pixel, in 64 bins an octave; the
     * sum of their variances between neighbours, 1/16 code^2; how much they are texture, Q8; and by
     * how much variance grows less with distance, 1/64 octave */
    uint32_t blocks[RF_NOISE_LEVELS][RF_NOISE_BINS], near[RF_NOISE_LEVELS][RF_NOISE_BINS];
    uint32_t rough[RF_NOISE_LEVELS][RF_NOISE_BINS];
    int32_t bend[RF_NOISE_LEVELS][RF_NOISE_BINS];
    bool any;                        /* there is some */
    uint16_t sigma[RF_NOISE_LEVELS]; /* standard deviation of luma, 1/256 code */
    int side;                        /* weight of neighbours in smoothed noise, Q7 */
    uint8_t lost[RF_GRAIN_PLACES]; /* the share of the grain a blur takes, Q8, by |s| in 1/8 pixel;
                           the last one is of all larger ones */
};

/* The look of a frame. */
struct rf_look {
    bool has_stars, has_grain;
    const struct rf_executor *exec;
    const struct rf_settings *params;
    struct rf_photo_source photo;
    const struct rf_focus_plan *plan;
    const struct rf_highlights *highlights; /* highlights of the photo, if it has stars */
    struct rf_stars *stars;                 /* stars, which rf_look_begin() finds */
    struct rf_grain *grain;                 /* grain, which rf_look_begin() measures */
};

/* The picture that a frame is written to: `out` covers the part `region` of the window. */
struct rf_canvas {
    const struct rf_viewport *view;
    struct rf_blur_q8 blur;
    const struct refocus_image *out;
    struct rf_rect region;
};

/* Finds out what the next function needs, once a frame, of the whole photo, whatever the window
 * is. */
void rf_look_begin(const struct rf_look *look);

/* Lays the look over an encoded part of the window within one tile. */
void rf_look_over(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect);

/* The parts of both. Stars: reads highlights and their blur, writes the list; adds their light.
 * Grain: reads the photo, writes the measure; adds as much noise as blur took. */
void rf_find_stars(const struct rf_look *look);
void rf_measure_grain(const struct rf_look *look);
void rf_add_stars(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect);
void rf_add_grain(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect);

/* Signed blurs, as they are stored, of a few pixels of the photo, at most RF_DEQUANTISE_PATCH in
 * width and height, row by row. */
void rf_blurs_at(const struct rf_look *look, int x, int y, int width, int height, int16_t *blur);

static inline int rf_luma(int r, int g, int b)
{
    return (54 * r + 183 * g + 19 * b + 128) >> 8;
}

/* Finds the codes R, G, B of a pixel of the window in the picture. */
void rf_codes_at(const struct rf_canvas *canvas, int x, int y, uint8_t *code[3]);

#endif
