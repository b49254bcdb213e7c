/* pyramid.h: the photo at smaller and smaller sizes. */
#ifndef RF_STROKES_PYRAMID_H
#define RF_STROKES_PYRAMID_H

#include <stdint.h>
#include <refocus/image.h>

/* Luma and two differences, 0 to 255. */
struct rf_colour {
    uint8_t y, u, v, unused;
};

/* Level k holds means of squares of 2^k pixels; the last ones may be cut off by the
 * border. */
enum { RF_LEVELS = 16 };
struct rf_pyramid {
    struct refocus_image photo;         /* level 0 */
    struct rf_colour *level[RF_LEVELS]; /* levels 1 and on; [0] is NULL */
    int32_t width[RF_LEVELS], height[RF_LEVELS];
    int levels;
};

int rf_pyramid_create(struct rf_pyramid *pyramid, const struct refocus_image *photo);
void rf_pyramid_free(struct rf_pyramid *pyramid);
/* Colours of a row from column x on. */
void rf_pyramid_row(const struct rf_pyramid *pyramid, int level, int32_t x, int32_t y,
                    int32_t count, struct rf_colour *row);

#endif
