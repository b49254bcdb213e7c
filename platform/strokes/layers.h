/* layers.h: a painting: a list of strokes, the layers that they make, and the disparities that are
 * seen from above. */
#ifndef RF_STROKES_LAYERS_H
#define RF_STROKES_LAYERS_H

#include <stdbool.h>
#include "pyramid.h"
#include "selector.h"
#include "spans.h"
#include "stroke.h"

/* The strokes of a layer follow each other in the list. */
struct rf_layer {
    int first, count;
    bool stale; /* the strokes are others than its spans */
    struct rf_spans spans;
};

struct refocus_strokes {
    struct rf_pyramid pyramid;
    uint16_t *base; /* NULL: all 0 */
    uint16_t *disparity;
    struct rf_selector selector;
    struct rf_stroke *strokes;
    struct rf_layer *layers;
    int count, layer_count;
    int room, layer_room;
    int points;
    bool held; /* nothing is selected or painted until rf_strokes_release() */
};

/* The layer on top, or NULL. */
struct rf_layer *rf_last_layer(const struct refocus_strokes *strokes);

/* Find the pixels that the strokes of a layer cover. REFOCUS_OK, or REFOCUS_ERR_MEMORY. */
int rf_cover(struct refocus_strokes *strokes, const struct rf_layer *layer, struct rf_spans *spans);

/* Paint anew where two coverages of a layer differ, or all that either covers when the fill is
 * another. *changed, unless NULL, becomes what was painted; it stays as it is where nothing was. */
void rf_repaint(struct refocus_strokes *strokes, const struct rf_spans *before,
                const struct rf_spans *after, bool all, struct refocus_changed *changed);

/* The last layer's strokes have changed: cover again, and paint the difference; while the strokes
 * are held, the layer is only marked. After REFOCUS_ERR_MEMORY the layer is as before. */
int rf_update_layer(struct refocus_strokes *strokes, bool all, struct refocus_changed *changed);

/* Free the last stroke, and its layer with the layer's first; nothing is painted. */
void rf_drop_stroke(struct refocus_strokes *strokes);

/* Paint all of the picture. */
void rf_paint_all(struct refocus_strokes *strokes);

#endif
