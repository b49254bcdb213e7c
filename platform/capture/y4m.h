/* y4m.h: the header of a YUV4MPEG2 stream. */
#ifndef RF_CAPTURE_Y4M_H
#define RF_CAPTURE_Y4M_H

#include <stdbool.h>
#include <stdint.h>
#include "failure.h"

struct rf_y4m {
    uint32_t format; /* enum refocus_frame_format */
    bool tall;       /* 4:2:2, which becomes YUYV: U and V have all rows */
    bool full_range;
    int width, height; /* 0: not there, or out of the range */
    double fps;
};

/* Parse a header, which is taken apart; `path` is for the reason of an error. */
int rf_y4m_parse(struct rf_y4m *y4m, char *header, const char *path, struct refocus_reason *reason);

#endif
