/* make_formats.h: small TIFF, OpenEXR and DNG files, put together byte by byte. */
#ifndef RF_TEST_MAKE_FORMATS_H
#define RF_TEST_MAKE_FORMATS_H

#include "make.h"

/* A picture of W x H pixels with the pattern of make.h in each sample; floats are the pattern of
 * 255 in units of 1/64. */
struct tiff_kind {
    bool big_endian, floats, planar;
    int bits, channels, photometric, orientation;
    bool alpha;     /* The last channel is 0 at (1, 1), else the greatest code. */
    bool thumbnail; /* the first directory says that it is one, and that there is more below */
};
struct bytes make_tiff(int width, int height, struct tiff_kind kind);

/* Channels by their names in alphabetical order, with spaces between; 32-bit floats, not
 * compressed: pattern(x, y, channel, 255) / 64. The data window begins at (x, y). */
struct bytes make_exr(int width, int height, const char *channels, int x, int y);

/* Up to eight of these in one file; channels count on from part to part. A deep part is none but by
 * its header. */
struct exr_part {
    const char *name, *channels, *view; /* view NULL: not said */
    int width, x, y;
    bool deep;
};
struct bytes make_exr_parts(int height, const struct exr_part *parts, int count);

/* A DNG of one mosaic RGGB of 16 bits in which each 2 x 2 pixels are alike: grey of that level. A
 * JPEG lies behind it if there is one; it is freed. */
struct bytes make_dng(int width, int height, unsigned level, struct bytes preview);

/* A NumPy array of that version: 1 to 3, the text of its header, and its samples. */
struct bytes make_npy(int version, const char *header, const void *samples, size_t size);

#endif
