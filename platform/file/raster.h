/* raster.h: a decoded picture as its file stores it. */
#ifndef RF_FILE_RASTER_H
#define RF_FILE_RASTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Samples are in the machine's byte order. */
struct rf_raster {
    uint8_t *pixels; /* owned; top row first; NULL when there is none */
    int32_t width, height;
    int32_t channels;   /* 1 or 3; between decoding and rf_part_alpha() 2 or 4 */
    uint32_t sample;    /* enum refocus_sample */
    uint32_t max_value; /* code of white; 0 for F32 */
    bool lossy;         /* read from a JPEG: channels that were equal may differ by a little */
};

/* Bytes that one sample of enum refocus_sample takes. */
size_t rf_sample_bytes(uint32_t sample);
/* Bytes from a row to the next; rows are packed. */
size_t rf_raster_stride(const struct rf_raster *raster);
/* One sample of 8 or 16 bits; the samples of a pixel follow each other. */
uint32_t rf_raster_sample(const struct rf_raster *raster, size_t index);
void rf_raster_free(struct rf_raster *raster);

#endif
