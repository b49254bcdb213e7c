/* y4m.h: the header of a YUV4MPEG2 stream. */
#ifndef RF_CAPTURE_Y4M_H
#define RF_CAPTURE_Y4M_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "failure.h"

struct rf_y4m {
    uint32_t format; /* enum refocus_frame_format */
    bool tall;       /* 4:2:2, which becomes YUYV: U and V have all rows */
    bool full_range;
    int width, height;     /* 0: not there, or out of the range */
    double fps;            /* 0: not there */
    int32_t aspect[2];     /* width to height of a pixel; 0 and 0: not known */
    uint32_t chroma_place; /* enum refocus_chroma_place, of 4:2:0 */
};

/* Parse a header, which is taken apart; `path` is for the reason of an error. */
int rf_y4m_parse(struct rf_y4m *y4m, char *header, const char *path, struct refocus_reason *reason);

enum { RF_Y4M_HEADER = 160 };
/* Write the header of a stream of 4:2:0 or 4:2:2, with the end of its line; returns its length. */
size_t rf_y4m_write(char header[RF_Y4M_HEADER], const struct rf_y4m *y4m);

#endif
