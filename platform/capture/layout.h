/* layout.h: how frames lie in memory, by their format. */
#ifndef RF_CAPTURE_LAYOUT_H
#define RF_CAPTURE_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/source.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of planes of a format; 0 for an unknown one. */
int rf_format_planes(uint32_t format);
/* Bytes in a row of a plane, and number of its rows. */
int64_t rf_plane_row(uint32_t format, int plane, int width);
int rf_plane_rows(uint32_t format, int plane, int height);
/* Whether so many rows of so many bytes can lie so far apart in memory, in either direction. */
bool rf_stride_fits(ptrdiff_t stride, int64_t row, int rows);
/* The stride of another plane that goes with the stride of plane 0. */
int64_t rf_plane_stride(uint32_t format, int plane, int64_t stride);
/* Bytes in a frame whose planes follow each other; 0 when a side is out of its range. */
uint64_t rf_frame_bytes(uint32_t format, int64_t stride, int width, int height);
/* Point a frame's planes into such memory. */
void rf_frame_lay_out(struct refocus_frame *frame, const uint8_t *memory, int64_t stride);
/* The matrix of streams that have no word for it, as players take it: BT.709 from a width of 1280
 * or more than 576 rows on, else BT.601. */
uint32_t rf_matrix_by_size(int width, int height);
/* The format of that name in any case; REFOCUS_FRAME_ANY for none. */
uint32_t rf_format_by_name(const char *name);

#ifdef __cplusplus
}
#endif

#endif
