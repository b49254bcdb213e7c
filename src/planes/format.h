/* format.h: where R, G, B and alpha stand in a pixel of a packed format. */
#ifndef RF_FORMAT_H
#define RF_FORMAT_H

#include <refocus/image.h>

struct rf_order {
    int bytes, r, g, b, a; /* a < 0: no alpha */
};

static inline struct rf_order rf_order_of(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_RGB8:
        return (struct rf_order){3, 0, 1, 2, -1};
    case REFOCUS_FORMAT_BGR8:
        return (struct rf_order){3, 2, 1, 0, -1};
    case REFOCUS_FORMAT_RGBA8:
        return (struct rf_order){4, 0, 1, 2, 3};
    default:
        return (struct rf_order){4, 2, 1, 0, 3};
    }
}

#endif
