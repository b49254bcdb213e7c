/* detect.h: types and functions that detecting clipped components and classifying them share. */
#ifndef RF_DETECT_H
#define RF_DETECT_H

#include "highlights/clipped.h"
#include "highlights/highlights.h"

/* Cells that a component is high and wide at most to be classified as a whole. */
enum { RF_COMPONENT_SIDE = 24 };

/* The photo's light in cells, squares of pixels, as highlights are as large as the photo makes
 * them: rf_cell_side(). A cell is clipped if any of its pixels is. */
struct rf_cell_photo {
    int width, height;
    int cell;               /* pixels that a cell is wide and high */
    int across, down;       /* cells */
    uint16_t *const *light; /* planes, rows `stride` elements apart, or NULL: */
    const uint8_t *code;    /* rows `stride` bytes apart */
    ptrdiff_t stride;
    struct rf_order order;
    const uint16_t *to_light;
    bool core; /* only what has two clipped channels counts as clipped; see rf_trim_glow() */
};

/* The detection in rows y0 to y1 - 1, by one thread. */
struct rf_detection {
    struct rf_cell_photo photo;
    struct rf_highlights *highlights;
    int y0, y1;
    struct rf_highlight run; /* the run that was listed last, which may go on; count 0: nothing */
    int lost[3];             /* light that its pixels have lost in all, Q12 */
    int full[3];             /* light that each wholly clipped pixel has lost */
};

/* Connected clipped cells: bit i of row[j] is cell (x + i, y + j). The row after the last is 0. */
struct rf_component {
    int x, y, rows;
    uint64_t row[RF_COMPONENT_SIDE + 1];
};

static inline void rf_colour_at(const struct rf_cell_photo *p, int x, int y, int colour[3])
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

/* The channel that is compared with white: the brightest, of a core the second brightest. */
static inline int rf_level_of(const struct rf_cell_photo *p, const int colour[3])
{
    const int more = colour[0] > colour[1] ? colour[0] : colour[1];
    const int less = colour[0] > colour[1] ? colour[1] : colour[0];

    if (p->core)
        return colour[2] > more ? more : colour[2] > less ? colour[2] : less;
    return colour[2] > more ? colour[2] : more;
}

/* Beyond the photo nothing is clipped. */
static inline bool rf_is_clipped(const struct rf_cell_photo *p, int x, int y)
{
    int colour[3];

    if (x < 0 || y < 0 || x >= p->width || y >= p->height)
        return false;
    rf_colour_at(p, x, y, colour);
    return rf_level_of(p, colour) > RF_CLIPPED;
}

/* The pixels of a cell. */
static inline struct rf_rect rf_pixels_of(const struct rf_cell_photo *p, int x, int y)
{
    const int x1 = (x + 1) * p->cell, y1 = (y + 1) * p->cell;

    return (struct rf_rect){x * p->cell, y * p->cell, x1 < p->width ? x1 : p->width,
                            y1 < p->height ? y1 : p->height};
}

/* A component without its limbs: what is more than half as thick as its thickest part. False: it
 * has none, or they are most of it. */
bool rf_trim_limbs(struct rf_component *body, const struct rf_component *component);

/* A component without its glow: the cells that have pixels with two clipped channels; `p` has
 * `core` set. False: these are none, or all. */
bool rf_trim_glow(struct rf_component *core, const struct rf_cell_photo *p,
                  const struct rf_component *component);

/* Lists the pixels of a component, or of what is left when it is trimmed, if that is a highlight.
 */
void rf_classify_component(struct rf_detection *d, const struct rf_component *component);

/* Lists those of a cell of something larger, a tube or a row of highlights, by the squares around
 * it. */
void rf_classify_cell(struct rf_detection *d, int x, int y);

/* Ends the run that was listed last; to be called when all rows are done. */
void rf_end_run(struct rf_detection *d);

/* Forgets all highlights. */
void rf_clear_highlights(struct rf_highlights *highlights);

/* Adds one. Of more than there is room for, the first by rows stay, in whichever order they come.
 * Rows of different parts may run at once. */
void rf_list_highlight(struct rf_highlights *highlights, const struct rf_highlight *run);

/* Puts them in the order of the rows. */
void rf_sort_highlights(const struct rf_executor *exec, struct rf_highlights *highlights);

#endif
