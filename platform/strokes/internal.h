/* What the files of this folder share. */
#ifndef RF_STROKES_INTERNAL_H
#define RF_STROKES_INTERNAL_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/platform/strokes.h>
#include "cut.h"

/* Luma and two differences, 0 to 255. */
struct rf_colour {
    uint8_t y, u, v, unused;
};

/* Level k holds means of squares of 2^k pixels; the last ones may be cut off by the
 * border. */
enum { RF_LEVELS = 16 };
struct rf_pyramid {
    struct refocus_image photo;         /* level 0 */
    struct rf_colour *level[RF_LEVELS]; /* of 1 and on; [0] is NULL */
    int32_t width[RF_LEVELS], height[RF_LEVELS];
    int levels;
};

int rf_pyramid_create(struct rf_pyramid *pyramid, const struct refocus_image *photo);
void rf_pyramid_free(struct rf_pyramid *pyramid);
/* Colours of a row from column x on. */
void rf_pyramid_row(const struct rf_pyramid *pyramid, int level, int32_t x, int32_t y,
                    int32_t count, struct rf_colour *row);

/* Pixels of a level, of an area of the picture. */
struct rf_area {
    int32_t x, y, width, height;
};
static inline int64_t rf_area_pixels(struct rf_area area)
{
    return (int64_t)area.width * area.height;
}

/* A stroke as the painting keeps it. */
struct rf_stroke {
    struct refocus_stroke stroke;
    float *points; /* x, y of each */
    int32_t count, room;
};

/* brush.c: distances from a path in sixteenths of a brush radius, in the pixels of an
 * area of a level; RF_FAR where it is farther than anything asks for. */
enum { RF_RADIUS = 16, RF_FAR = 65535 };
void rf_brush_distance(const struct rf_stroke *stroke, int level, struct rf_area area,
                       uint16_t *distance);
/* Set to 1 what lies within the radius, at full size. */
void rf_brush_cover(const struct rf_stroke *stroke, struct rf_area area, uint8_t *mask);
/* What lies within so many pixels of the path, cut by the picture. */
struct rf_area rf_brush_area(const struct rf_stroke *stroke, double margin, int32_t width,
                             int32_t height);

/* Rows of spans: what a layer covers. x[2 i] is inside, x[2 i + 1] is the first
 * outside. */
struct rf_spans {
    int32_t y, rows;
    int64_t *first; /* of row i: first[i] to first[i + 1], counted in numbers */
    int32_t *x;
};
int rf_spans_of_mask(struct rf_spans *spans, const uint8_t *mask, struct rf_area area);
int rf_spans_of_all(struct rf_spans *spans, int32_t width, int32_t height);
int rf_spans_copy(struct rf_spans *to, const struct rf_spans *from);
void rf_spans_free(struct rf_spans *spans);
/* Spans of picture row y: how many numbers, and where. */
int64_t rf_spans_row(const struct rf_spans *spans, int32_t y, const int32_t **x);
/* The columns of row y in which two differ; false when none. */
bool rf_spans_differ(const struct rf_spans *a, const struct rf_spans *b, int32_t y, int32_t *from,
                     int32_t *to);

/* colour.c: how likely a colour is the object's, from counts of both sides. */
enum { RF_BINS = 16 * 32 * 32 };
struct rf_likeness {
    uint32_t object[RF_BINS], outside[RF_BINS]; /* counts, then smoothed */
    uint32_t scratch[RF_BINS];
    int16_t score[RF_BINS]; /* > 0: the object's; RF_BIT = twice as likely */
};
enum { RF_BIT = 16 };
static inline int rf_bin(struct rf_colour c)
{
    return c.y >> 4 << 10 | c.u >> 3 << 5 | c.v >> 3;
}
void rf_likeness_clear(struct rf_likeness *likeness);
void rf_likeness_settle(struct rf_likeness *likeness);

/* select.c: the object that strokes 0 to count - 1 (object, more, less) are painted
 * over. */
struct rf_selector {
    struct rf_cut cut;
    struct rf_likeness likeness;
    struct {
        void *memory;
        size_t size;
    } scratch[8];
};
void rf_selector_free(struct rf_selector *selector);
int rf_select(struct rf_selector *selector, const struct rf_pyramid *pyramid,
              const struct rf_stroke *strokes, int count, struct rf_spans *spans);
/* Memory that is kept for the next time; what is in it is lost. NULL: there is none. */
void *rf_selector_scratch(struct rf_selector *selector, int which, int64_t count, size_t size);

/* strokes.c: between hold and release strokes are only listed, so that each layer is
 * selected and painted once. Instead of release, return goes back to the first count
 * strokes and needs no memory for it: what the last of their layers covers is kept. */
int rf_strokes_hold(struct refocus_strokes *strokes, struct rf_spans *kept);
int rf_strokes_release(struct refocus_strokes *strokes);
void rf_strokes_return(struct refocus_strokes *strokes, int count, struct rf_spans *kept);
void rf_strokes_size(const struct refocus_strokes *strokes, int32_t *width, int32_t *height);

/* fill.c: the pixels from one column to before another. */
void rf_fill_span(const struct refocus_fill *fill, uint16_t *row, int32_t y, int32_t from,
                  int32_t to);

#endif
