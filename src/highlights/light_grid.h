/* light_grid.h: what the light that clipping took is estimated from: means of the photo over the
 * cells of a grid, and Gaussian blurs of these at seven scales.
 *
 * The grid has 512 cells along the longer side of the photo, or one for each pixel of a smaller
 * one. A pixel counts as clipped to the part
 *
 *     s = smoothstep((m - 242) / 12),  m its greatest code,
 *
 * and as not clipped to the part 1 - s. Codes of a photo of Y, U and V are those of kernels->guide.
 * Scale k is a blur of standard deviation 0.8 2^k cells, or nearly so: a pyramid of means of 2 x 2,
 * each level smoothed by a binomial 1 2 1 and read between its cells in proportion, so that nothing
 * steps where a highlight moves by a pixel.
 */
#ifndef RF_LIGHT_GRID_H
#define RF_LIGHT_GRID_H

#include <stdint.h>

#include "highlights/light_pyramid.h"
#include "image/photo_source.h"
#include "support/arena.h"
#include "support/compare.h"
#include "support/executor.h"

enum { RF_GRID_SIDE = RF_PYRAMID_SIDE, RF_GRID_SCALES = 7, RF_CODES_OF_LIGHT = RF_LIGHT_MAX + 1 };

/* The means. Linear light is 0 to 1. */
enum rf_grid_measure {
    RF_GRID_CLIPPED,   /* s */
    RF_GRID_UNCLIPPED, /* (1 - s) Y, Y luminance */
    RF_GRID_LOG,       /* log2(Y + 0.003), clipped or not */
    RF_GRID_GREY,      /* s min(R, G, B) / max(R, G, B) */
    RF_GRID_PLATEAU,   /* place of the greatest code between 250 and 255: 0 to 1 */
    RF_GRID_WHITE,     /* place of the least code between 246 and 255: 0 to 1 */
    RF_GRID_RED,       /* (1 - s) R, G, B */
    RF_GRID_GREEN,
    RF_GRID_BLUE,
    RF_GRID_DARK,  /* w = (1 - s) / (Y + 0.002)^2, by which dark pixels count most */
    RF_GRID_LIGHT, /* w Y */
    RF_GRID_LIGHT_SQUARED,
    RF_GRID_GLARE, /* w g, g the glare that s would have around it */
    RF_GRID_GLARE_SQUARED,
    RF_GRID_GLARE_LIGHT, /* w g Y */
    RF_GRID_MEASURES
};

/* A mean at the scales from `first` to `last`. */
struct rf_grid_plane {
    int first, last;
    float *scale[RF_GRID_SCALES];
};

/* Tables by Q12 light in the blend of the photo's planes. */
struct rf_grid_tables {
    uint16_t linear[RF_CODES_OF_LIGHT];                            /* linear light, Q12 */
    uint16_t soft[RF_CODES_OF_LIGHT];                              /* s of a greatest channel, Q8 */
    uint16_t plateau[RF_CODES_OF_LIGHT], white[RF_CODES_OF_LIGHT]; /* Q8 */
    uint16_t log[RF_CODES_OF_LIGHT];  /* by linear light: (log2(light + 0.003) + 9), Q8 */
    uint16_t dark[RF_CODES_OF_LIGHT]; /* by linear light: 1 / (light + 0.002)^2, a quarter of it */
    uint16_t light[RF_CODES_OF_LIGHT], light_squared[RF_CODES_OF_LIGHT]; /* such of w Y, Q8, Q15 */
    int clipped;                 /* s is 0 of light up to this one */
    int first[RF_GRID_SIDE + 1]; /* the first pixel of each column of cells, and the end */
};

struct rf_light_grid {
    const struct rf_executor *exec;
    const struct rf_photo_source *photo;
    int width, height; /* cells */
    int step;          /* light that is not clipped is looked at in every step-th row and column */
    struct rf_grid_tables *tables;
    struct rf_grid_plane plane[RF_GRID_MEASURES];
    double mean_log; /* mean of RF_GRID_LOG over the whole photo */
};

/* Bytes that a grid of photos of at most this size takes. */
uint64_t rf_light_grid_bytes(int max_width, int max_height);

/* Lays the grid of a photo out; exec and photo are set. */
void rf_light_grid_lay_out(struct rf_light_grid *grid, struct rf_arena *arena);

/* Measures the photo, whose light is in the blend that `photo->transfer` is of; `linear` is the
 * transfer of linear light. Returns false if nothing is clipped, and nothing was measured then. */
bool rf_light_grid_measure(struct rf_light_grid *grid, const struct rf_transfer *linear);

/* Cells across and down at a scale. */
static inline int rf_grid_size(int cells, int scale)
{
    return (cells + (1 << scale) - 1) >> scale;
}

/* The middle of a cell at a scale: between four means, which are read in proportion. */
struct rf_grid_place {
    int scale;
    ptrdiff_t at[4];
    float right, low;
};
struct rf_grid_place rf_grid_place(const struct rf_light_grid *grid, int scale, int x, int y);

/* A row of cells at a scale: between two rows of means. */
struct rf_grid_row {
    int scale, across;
    float unit;
    ptrdiff_t above, below;
    float low;
};
struct rf_grid_row rf_grid_row(const struct rf_light_grid *grid, int scale, int y);

/* The middle of cell x in it. */
static inline struct rf_grid_place rf_grid_place_in(const struct rf_grid_row *row, int x)
{
    const float u = ((float)x + 0.5f) * row->unit - 0.5f;
    const int before = u < 0 ? -1 : (int)u;
    const int left = rf_larger(before, 0), right = rf_smaller(before + 1, row->across - 1);

    return (struct rf_grid_place){
        row->scale,
        {row->above + left, row->above + right, row->below + left, row->below + right},
        u - (float)before,
        row->low,
    };
}

/* A mean there, at a scale that its plane has. */
static inline float rf_grid_at(const struct rf_light_grid *grid, enum rf_grid_measure measure,
                               const struct rf_grid_place *place)
{
    const float *at = grid->plane[measure].scale[place->scale];
    const float a = at[place->at[0]], b = at[place->at[1]], c = at[place->at[2]];
    const float upper = a + place->right * (b - a);
    const float lower = c + place->right * (at[place->at[3]] - c);

    return upper + place->low * (lower - upper);
}

/* The cell that pixel i of a side lies in; the side has so many pixels and cells. */
static inline int rf_grid_cell(int i, int pixels, int cells)
{
    return (int)((int64_t)i * cells / pixels);
}

/* The mean light, by one of the measures of what is not clipped, of what is not. */
static inline float rf_unclipped_at(const struct rf_light_grid *grid, enum rf_grid_measure measure,
                                    const struct rf_grid_place *place)
{
    return rf_grid_at(grid, measure, place) /
           (1 - rf_grid_at(grid, RF_GRID_CLIPPED, place) + 0.001f);
}

/* Pixels of a row of the photo: their light, or their codes. */
struct rf_grid_pixels {
    const uint16_t *light[3];
    const uint8_t *code; /* or NULL */
    struct rf_order order;
    const uint16_t *to_light;
};

/* Finds n of them from (x, y) on; of a photo of Y, U and V, at most RF_GRID_RUN from an even x on
 * are converted into `rgb`. */
enum { RF_GRID_RUN = 128 };
struct rf_grid_pixels rf_grid_pixels(const struct rf_light_grid *grid, int x, int y, int n,
                                     uint8_t rgb[3 * RF_GRID_RUN]);

/* The channels of the i-th, Q12 in the photo's blend. */
static inline void rf_grid_colour(const struct rf_grid_pixels *pixels, int i, int colour[3])
{
    if (!pixels->code) {
        for (int c = 0; c < 3; c++)
            colour[c] = pixels->light[c][i];
    } else {
        const uint8_t *code = pixels->code + (ptrdiff_t)i * pixels->order.bytes;

        colour[0] = pixels->to_light[code[pixels->order.r]];
        colour[1] = pixels->to_light[code[pixels->order.g]];
        colour[2] = pixels->to_light[code[pixels->order.b]];
    }
}

/* Whether any of n pixels of a row may be clipped. */
bool rf_grid_may_be_clipped(const struct rf_light_grid *grid, int x, int y, int n);

#endif
