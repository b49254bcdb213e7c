/* png_io.h: PNG files for the quality tool: on libpng alone, so that the tool does not depend on
 * the file readers that it helps to judge. */
#ifndef QUALITY_PNG_IO_H
#define QUALITY_PNG_IO_H

#include <stdint.h>

/* Reads @path as @channels 3: 8-bit R G B, alpha dropped; or 1: 16-bit grey in the
 * machine's order, 8-bit values times 257. No gamma is applied. Returns memory to be
 * freed, or NULL after a line on standard error. */
void *png_io_read(const char *path, int channels, int *width, int *height);

/* Writes 8-bit R G B. Returns 0, or -1 after a line on standard error. */
int png_io_write(const char *path, const uint8_t *rgb, int width, int height);

#endif
