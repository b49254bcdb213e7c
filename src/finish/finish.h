/* finish.h: what is laid over the finished picture: spikes of a star filter, and grain.
 *
 * Both change pixels that are already encoded, tile by tile, and only where there is
 * something to add.
 */
#ifndef RF_FINISH_H
#define RF_FINISH_H

#include <stdbool.h>
#include <stdint.h>

struct refocus_renderer;
struct rf_frame;
struct rf_rect;

/* A lamp with spikes: its place in 1/16 pixel, its light, and its blur radius, Q7.8. */
struct rf_star {
    int64_t x, y;
    uint64_t light[3]; /* Q12, summed over its pixels */
    int32_t blur;
    int32_t pixels;
    int32_t x0, x1, y1; /* that the pixels lie in */
};

/* Most stars of a picture; the lamps after them, row by row, have no spikes. */
enum { RF_MOST_STARS = 1024, RF_MOST_SPIKES = 16, RF_NOISE_LEVELS = 8, RF_NOISE_BINS = 1024 };

/* Grain of the photo, measured where it is sharp. */
struct rf_grain {
    /* by luma and by variance, 1/16 code^2 */
    uint32_t blocks[RF_NOISE_LEVELS][RF_NOISE_BINS];
    uint16_t sigma[RF_NOISE_LEVELS]; /* standard deviation of luma, 1/256 code */
    uint8_t lost[1024];              /* by |s| >> 5: how much of it a blur takes, Q8 */
};

/* What the next function needs, once a frame: of the whole photo, whatever the window
 * is. */
void rf_finish_begin(struct rf_frame *f);

/* A rectangle of the window that is encoded. */
void rf_finish_rect(const struct rf_frame *f, struct rf_rect rect);

/* Stars of the lamps that are known, r->star[0 .. r->stars - 1]; the photo's grain,
 * r->grain. */
void rf_find_stars(struct rf_frame *f);
void rf_measure_grain(struct rf_frame *f);

/* Signed blurs of a few pixels of the photo in use, at most RF_DEQUANTISE_PATCH in width and
 * height, row by row. */
void rf_blurs_at(const struct rf_frame *f, int x, int y, int width, int height, int16_t *blur);

void rf_add_stars(const struct rf_frame *f, struct rf_rect rect);
void rf_add_grain(const struct rf_frame *f, struct rf_rect rect);

#endif
