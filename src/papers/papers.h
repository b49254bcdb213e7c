/* papers.h: the methods that the papers compare, and the functions that these methods share.
 *
 * Methods that work on whole frames run their own passes on f->exec and write all pixels of
 * f->region. Their memory is f->work: as much as their work_bytes says for the renderer's limits,
 * laid out by the function that also counts it. Between two frames of one method the memory keeps
 * its content; when another method was at work, f->work->owner says so.
 */
#ifndef RF_PAPERS_H
#define RF_PAPERS_H

#include "gather/method.h"
#include "support/arena.h"

rf_tile_fn rf_raytrace_tile, rf_jittered_tile, rf_blur_tile;
rf_exact_init_fn rf_exact_init;
rf_frame_fn rf_lightfield_frame, rf_scatter_frame, rf_foveated_frame, rf_interpolated_frame,
    rf_diffusion_frame;
rf_work_bytes_fn rf_lightfield_work, rf_scatter_work, rf_foveated_work, rf_interpolated_work,
    rf_diffusion_work;

/* Writes pixel (x, y) of the region: the quotient of Q12 light times weights and of the weights. */
static inline void rf_write_mean(const struct rf_frame *f, int x, int y, const uint64_t light[3],
                                 uint64_t weight)
{
    const uint8_t *to_code = f->transfer->to_code;
    uint8_t rgb[3];

    for (int c = 0; c < 3; c++)
        rgb[c] = to_code[(4 * light[c] + weight / 2) / weight];
    rf_write_pixel(f, x, y, rgb);
}

/* Writes a pixel from real numbers. Sums of one colour may be off by rounding, as long as it is
 * less than half a step of the mean. */
static inline void rf_write_real(const struct rf_frame *f, int x, int y, const double light[3],
                                 double weight)
{
    const uint8_t *to_code = f->transfer->to_code;
    uint8_t rgb[3];

    for (int c = 0; c < 3; c++) {
        const double mean = 4 * light[c] / weight + 0.5;

        rgb[c] = to_code[mean < 0 ? 0 : mean > RF_MEAN_MAX ? RF_MEAN_MAX : (int)mean];
    }
    rf_write_pixel(f, x, y, rgb);
}

#endif
