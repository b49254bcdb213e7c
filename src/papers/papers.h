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

/* Lists the methods: REFOCUS_METHOD_NAME is done by rf_name_method, a row at the end of its file.
 */
#define RF_PAPERS_METHODS(METHOD)                                                                  \
    METHOD(RAYTRACE, raytrace)                                                                     \
    METHOD(JITTERED, jittered)                                                                     \
    METHOD(LIGHTFIELD, lightfield)                                                                 \
    METHOD(BLUR, blur)                                                                             \
    METHOD(SCATTER, scatter)                                                                       \
    METHOD(FOVEATED, foveated)                                                                     \
    METHOD(INTERPOLATED, interpolated)                                                             \
    METHOD(DIFFUSION, diffusion)

#define RF_DECLARE_METHOD(NAME, name) extern const struct rf_method rf_##name##_method;
RF_PAPERS_METHODS(RF_DECLARE_METHOD)
#undef RF_DECLARE_METHOD

rf_exact_init_fn rf_exact_init;

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
