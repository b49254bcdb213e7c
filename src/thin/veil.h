/* veil.h: thin things far before the focus.
 *
 * A wire of two pixels that is blurred over forty is met by few rays, here by more and
 * there by less: streaks. What is so thin and so blurred is drawn instead: alpha N and
 * alpha of cells of 4 x 4 pixels are added up and spread evenly over a disc, in cells,
 * and what is between their middles is interpolated,
 *
 *     veil = sum of alpha N / pi s^2,  cover = sum of alpha / pi s^2
 *     out  = veil + (1 - cover) mean
 *
 * A disc is drawn as the differences along its rows, so its cost is that of its height.
 */
#ifndef RF_VEIL_H
#define RF_VEIL_H

#include <stdint.h>

#include "thin/thin.h"

enum {
    RF_VEIL_CELL = 4,
    RF_VEIL_BLUR = 8 << 8, /* Q7.8: two cells, the least */
};

/* One cell of what is drawn. */
struct rf_veil_source {
    uint16_t x, y;   /* cell */
    uint16_t radius; /* of its disc, cells in Q8 */
    int32_t each[4]; /* what each cell of that gets of alpha N and of alpha, as below */
};

struct rf_veil {
    struct rf_veil_source *source; /* 16 for each tile, in rows of tiles */
    uint32_t *sources;             /* of each row of tiles */
    struct rf_apart *apart;        /* of each tile */
    bool *swapped;                 /* of each row of tiles: rf_swap_thin_light() */
    int32_t (*cell)[4];            /* Q12 times 2^RF_VEIL_SHIFT */
    int stride;
};

/* Draw those of the tiles chosen. */
void rf_veil_draw(struct rf_frame *f);

/* Whether anything is drawn over a tile; lay it over its means, Q14. */
bool rf_has_veil(const struct refocus_renderer *r, int tx, int ty);
void rf_veil_over(const struct refocus_renderer *r, int tx, int ty, uint16_t mean[3][256]);

#endif
