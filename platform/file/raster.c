/* raster.c: sizes and samples of a decoded picture. */
#include "raster.h"

#include <stdlib.h>

#include <refocus/depth.h>

size_t rf_sample_bytes(uint32_t sample)
{
    return sample == REFOCUS_SAMPLE_F32 ? 4 : sample == REFOCUS_SAMPLE_U16 ? 2 : 1;
}

size_t rf_raster_stride(const struct rf_raster *raster)
{
    return (size_t)raster->width * (size_t)raster->channels * rf_sample_bytes(raster->sample);
}

uint32_t rf_raster_sample(const struct rf_raster *raster, size_t index)
{
    return raster->sample == REFOCUS_SAMPLE_U8
               ? raster->pixels[index]
               : ((const uint16_t *)(const void *)raster->pixels)[index];
}

void rf_raster_free(struct rf_raster *raster)
{
    free(raster->pixels);
    raster->pixels = NULL;
}
