/* samples.h: samples of Y, U and V are copied from one order in memory to another. */
#ifndef RF_CAPTURE_SAMPLES_H
#define RF_CAPTURE_SAMPLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <refocus/platform/source.h>

/* The frame format that a picture has; REFOCUS_FRAME_ANY for none. */
uint32_t rf_frame_format_of(uint32_t image_format);

/* Y, U or V of frames, wherever they lie. */
struct rf_samples {
    uint8_t *first;
    int step;         /* bytes to the next one in the row */
    ptrdiff_t stride; /* bytes to the next row */
};
void rf_samples_of(struct rf_samples samples[3], uint32_t format, const uint8_t *const plane[3],
                   const ptrdiff_t stride[3]);
/* Copy codes of Y as they are, and those of U and V, which have so many rows: where one has twice
 * as many, rows are repeated, or become the mean of two, half up. */
void rf_copy_samples(const struct rf_samples to[3], int to_rows, const struct rf_samples from[3],
                     int from_rows, int width, int height);
/* Whether a frame format has such samples; whether two have as many: both 4:2:0 or 4:2:2. */
bool rf_has_samples(uint32_t format);
bool rf_same_samples(uint32_t format, uint32_t other);
/* Rows of U and V in a frame format. */
int rf_rows_of_chroma(uint32_t format, int height);
/* Put a picture of Y, U and V into a frame of such a format that has that many rows of U and V. */
void rf_rearrange(const struct refocus_image *image, const struct refocus_frame *frame,
                  int chroma_rows);

#endif
