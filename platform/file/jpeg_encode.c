/* jpeg_encode.c: pixels become a JPEG in memory by TurboJPEG. */
#include "jpeg_encode.h"

#include <limits.h>
#include <string.h>
#include <turbojpeg.h>

#include "reason.h"

enum { SIDE_MAX = 65500 }; /* the limit of libjpeg */

static int pixel_format(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_BGR8:
        return TJPF_BGR;
    case REFOCUS_FORMAT_RGBA8:
        return TJPF_RGBX;
    case REFOCUS_FORMAT_BGRA8:
        return TJPF_BGRX;
    case RF_FORMAT_GRAY8:
        return TJPF_GRAY;
    default:
        return TJPF_RGB;
    }
}

static int compress(tjhandle jpeg, const struct rf_rows *rows, int quality, unsigned char **bytes,
                    unsigned long *size)
{
    const bool flipped = rows->stride < 0;
    const ptrdiff_t step = flipped ? -rows->stride : rows->stride;
    const uint8_t *const first =
        flipped ? rows->top + (rows->height - 1) * rows->stride : rows->top;
    /* Chroma is halved where it does not show: 4:4:4 keeps coloured edges from 90 up.
     */
    const int sampling = rows->format == RF_FORMAT_GRAY8 ? TJSAMP_GRAY
                         : quality >= 90                 ? TJSAMP_444
                                                         : TJSAMP_420;

    return tjCompress2(jpeg, first, rows->width, rows->height == 1 ? 0 : (int)step, rows->height,
                       pixel_format(rows->format), bytes, size, sampling, quality,
                       TJFLAG_ACCURATEDCT | (flipped ? TJFLAG_BOTTOMUP : 0));
}

/* Our segments belong behind SOI and JFIF. */
static unsigned long find_insertion(const unsigned char *bytes, unsigned long size)
{
    unsigned long length;

    if (size < 6 || bytes[2] != 0xff || bytes[3] != 0xe0)
        return 2;
    length = 4 + ((unsigned long)bytes[4] << 8 | bytes[5]);
    return length <= size ? length : 2;
}

int rf_jpeg_encode(struct rf_jpeg_encoded *encoded, const struct rf_rows *rows, int quality,
                   struct refocus_reason *reason)
{
    int status = REFOCUS_OK;
    tjhandle jpeg;

    memset(encoded, 0, sizeof *encoded);
    if (rows->width > SIDE_MAX || rows->height > SIDE_MAX) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "a JPEG has at most %d pixels a side; write a PNG", SIDE_MAX);
    }
    if (rows->height > 1 && (rows->stride > INT_MAX || rows->stride < -INT_MAX)) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "rows lie too far apart in memory for a JPEG; write a PNG");
    }
    jpeg = tjInitCompress();
    if (!jpeg)
        return rf_fail_memory(reason);
    if (compress(jpeg, rows, quality, &encoded->bytes, &encoded->size) != 0) {
        status = rf_fail(reason, REFOCUS_ERR_MEMORY, "the JPEG encoder gave up: %s",
                         tjGetErrorStr2(jpeg));
    } else {
        encoded->split = find_insertion(encoded->bytes, encoded->size);
    }
    tjDestroy(jpeg);
    return status;
}

void rf_jpeg_encoded_free(struct rf_jpeg_encoded *encoded)
{
    tjFree(encoded->bytes);
    encoded->bytes = NULL;
}
