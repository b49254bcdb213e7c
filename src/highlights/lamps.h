/* lamps.h: what finding lamps and judging them have in common (highlights.h). */
#ifndef RF_LAMPS_H
#define RF_LAMPS_H

#include "highlights/clipped.h"
#include "image/format.h"

/* The photo's light, in planes or, in strip mode, as the caller's codes. */
struct rf_lamp_photo {
    int width, height;
    int cell;               /* pixels that a cell is wide and high */
    int across, down;       /* cells */
    uint16_t *const *light; /* planes, rows `stride` elements apart, or NULL: */
    const uint8_t *code;    /* rows `stride` bytes apart */
    ptrdiff_t stride;
    struct rf_order order;
    const uint16_t *to_light;
    bool core; /* clipped is what has two clipped channels; see rf_lamp_core() */
};

/* Rows y0 to y1 - 1 are looked through. */
struct rf_lamp_search {
    const struct refocus_renderer *r;
    struct rf_lamp_photo photo;
    struct rf_highlights *lists;
    int y0, y1;
    struct rf_highlight run; /* what was listed last may go on; count 0: nothing */
    int lost[3];             /* by its pixels in all, Q12 */
    int full[3];             /* by each that is clipped wholly */
};

/* What hangs together: bit i of row[j] is cell (x + i, y + j). The row after the last is 0. */
struct rf_lamp_shape {
    int x, y, rows;
    uint64_t row[RF_LAMP_SIDE + 1];
};

static inline void rf_colour_at(const struct rf_lamp_photo *p, int x, int y, int colour[3])
{
    if (p->light) {
        for (int c = 0; c < 3; c++)
            colour[c] = p->light[c][y * p->stride + x];
    } else {
        const uint8_t *code = p->code + y * p->stride + x * p->order.bytes;

        colour[0] = p->to_light[code[p->order.r]];
        colour[1] = p->to_light[code[p->order.g]];
        colour[2] = p->to_light[code[p->order.b]];
    }
}

/* What is compared with white: the brightest channel, of a core the second. */
static inline int rf_level_of(const struct rf_lamp_photo *p, const int colour[3])
{
    const int more = colour[0] > colour[1] ? colour[0] : colour[1];
    const int less = colour[0] > colour[1] ? colour[1] : colour[0];

    if (p->core)
        return colour[2] > more ? more : colour[2] > less ? colour[2] : less;
    return colour[2] > more ? colour[2] : more;
}

/* Beyond the photo nothing is. */
static inline bool rf_is_clipped(const struct rf_lamp_photo *p, int x, int y)
{
    int colour[3];

    if (x < 0 || y < 0 || x >= p->width || y >= p->height)
        return false;
    rf_colour_at(p, x, y, colour);
    return rf_level_of(p, colour) > RF_CLIPPED;
}

/* Pixels x0 to x1 - 1 of rows y0 to y1 - 1 of a cell. */
static inline struct rf_rect rf_pixels_of(const struct rf_lamp_photo *p, int x, int y)
{
    const int x1 = (x + 1) * p->cell, y1 = (y + 1) * p->cell;

    return (struct rf_rect){x * p->cell, y * p->cell, x1 < p->width ? x1 : p->width,
                            y1 < p->height ? y1 : p->height};
}

/* A shape without its limbs: what is more than half as thick as its thickest part. False: it has
 * none, or they are most of it. */
bool rf_lamp_body(struct rf_lamp_shape *body, const struct rf_lamp_shape *shape);

/* A shape without its glow: the cells that have pixels with two clipped channels; `p` has `core`
 * set. False: these are none, or all. */
bool rf_lamp_core(struct rf_lamp_shape *core, const struct rf_lamp_photo *p,
                  const struct rf_lamp_shape *shape);

/* List the pixels of a shape, or of its body or core, if that is a lamp. */
void rf_list_shape(struct rf_lamp_search *s, const struct rf_lamp_shape *shape);

/* List those of a cell of something larger, a tube or a row of lamps, by the squares around it. */
void rf_list_cell(struct rf_lamp_search *s, int x, int y);

/* To be called at last. */
void rf_end_list(struct rf_lamp_search *s);

#endif
