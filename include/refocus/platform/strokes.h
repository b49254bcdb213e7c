/** @file platform/strokes.h  Depth by a finger: objects are painted over, and get a
 *  depth.
 *
 * Part of librefocus-strokes, not of the core: `#include <refocus/platform/strokes.h>`,
 * pkg-config name `refocus-strokes`. Without jansson the two functions on JSON return
 * REFOCUS_ERR_UNSUPPORTED, and the rest is the same.
 *
 * A painting is a list of strokes over a photo (Yang et al. 2016, section on depth by
 * strokes): the ground first, then objects over it, each later one in front of the
 * earlier. A stroke over an object selects it to its edge; the selection is filled with
 * one disparity or with a gradient between two points. Undo drops the last stroke. What
 * comes out depends on the photo and the list of strokes alone, not on how a stroke was
 * cut into segments nor on strokes dropped again.
 *
 * Coordinates are pixels of the photo, x right, y down, centres at whole numbers.
 *
 * One thread at a time may call into a painting.
 */
#ifndef REFOCUS_PLATFORM_STROKES_H
#define REFOCUS_PLATFORM_STROKES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A painting. Opaque. */
struct refocus_strokes;

/** The effect of a stroke. */
enum refocus_stroke_kind {
    REFOCUS_STROKE_ALL = 0,    /**< the whole picture, for the ground; has no points */
    REFOCUS_STROKE_OBJECT = 1, /**< selects the object that it is painted over, to its
                                    edge */
    REFOCUS_STROKE_MORE = 2,   /**< adds to the object of the strokes before */
    REFOCUS_STROKE_LESS = 3,   /**< takes from the object of the strokes before */
    REFOCUS_STROKE_BRUSH = 4,  /**< exactly what the brush covers */
    REFOCUS_STROKE_FILL = 5,   /**< fills the last layer anew; has no points */
};

/** How a selection is filled. */
enum refocus_fill_kind {
    REFOCUS_FILL_NONE = 0,     /**< without a fill: the layer is only selected */
    REFOCUS_FILL_SOLID = 1,    /**< with one disparity: d0 */
    REFOCUS_FILL_GRADIENT = 2, /**< d0 at (x0, y0) to d1 at (x1, y1), linear on the way
                                    and constant before and beyond: a plane, disparities
                                    being linear in a picture of one */
};

/** The fill of a selection. The struct is complete. */
struct refocus_fill {
    uint32_t kind; /**< enum refocus_fill_kind */
    float d0, d1;  /**< disparities, 0 farthest to 1 nearest */
    float x0, y0;  /**< pixels, within a million of 0 */
    float x1, y1;  /**< pixels, not the same point */
};

/** A stroke without its points. Start from refocus_stroke_default(). */
struct refocus_stroke {
    uint32_t struct_size; /**< sizeof(struct refocus_stroke) */
    uint32_t kind;        /**< enum refocus_stroke_kind */
    float radius;         /**< radius of the brush in pixels, 0.5 to 4096 */
    float reach;          /**< object, more: how far from its path, in brush radii,
                               a stroke selects, 1 to 64 */
    struct refocus_fill
        fill; /**< fill of the layer; with more and less NONE keeps the fill that it has */
};

static inline struct refocus_stroke refocus_stroke_default(uint32_t kind, float radius)
{
    struct refocus_stroke stroke;

    memset(&stroke, 0, sizeof stroke);
    stroke.struct_size = sizeof stroke;
    stroke.kind = kind;
    stroke.radius = radius;
    stroke.reach = 4;
    return stroke;
}

/** A part of the picture; of no size when nothing changed. The struct is complete. */
struct refocus_changed {
    int32_t x, y, width, height;
};

/** Most strokes of a painting, and most points of all of them together. */
enum { REFOCUS_MAX_STROKES = 4096, REFOCUS_MAX_STROKE_POINTS = 1 << 20 };

/** Most work of the strokes of a file, in pixels that they look at, some 10 ns each; in photos of
 * more than two megapixels 64 times their pixels. An object looks at all within its reach and a
 * quarter more, and counts 1.3 million more where that is 12,000 pixels or more, less where it is
 * less; a brush looks at all under it, and at a run in each row of each segment. */
enum { REFOCUS_MAX_STROKE_WORK = 1 << 27 };

/** Why a file was refused: one line, no full stop. The struct is complete. */
struct refocus_strokes_reason {
    char text[256];
};

/**
 * Begin a painting.
 *
 * Memory: 3 bytes a pixel, and while a stroke is made up to 2 bytes a pixel that it
 * reaches and 120 bytes a pixel of its edge.
 *
 * @param photo  of a packed format of 8 bits. Its pixels are read until refocus_strokes_destroy()
 *               and must not change
 * @param base   what is painted over, of the photo's size; copied; NULL: all 0
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_SIZE, REFOCUS_ERR_MEMORY; on an
 *         error *strokes is NULL
 */
REFOCUS_API int refocus_strokes_create(struct refocus_strokes **strokes,
                                       const struct refocus_image *photo,
                                       const struct refocus_disparity *base);

/** Free all, set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_strokes_destroy(struct refocus_strokes **strokes);

/**
 * Begin a stroke. Those without points are done with that; the others go on with
 * refocus_strokes_extend().
 *
 * @param changed  receives the part of the disparities that changed; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (more and less without an
 *         object as the last layer, fill without a layer), REFOCUS_ERR_SIZE (too many
 *         strokes), REFOCUS_ERR_MEMORY. On an error nothing has changed.
 */
REFOCUS_API int refocus_strokes_begin(struct refocus_strokes *strokes,
                                      const struct refocus_stroke *stroke,
                                      struct refocus_changed *changed);

/**
 * Go on with the last stroke: select and fill by all of its points so far.
 *
 * @param points  x and y of each, pixels of the photo: x from -0.5 to width - 0.5
 * @param count   of points, >= 1
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (the last stroke has no
 *         points, or there is none), REFOCUS_ERR_SIZE (too many points),
 *         REFOCUS_ERR_MEMORY. On an error nothing has changed.
 */
REFOCUS_API int refocus_strokes_extend(struct refocus_strokes *strokes, const float *points,
                                       int count, struct refocus_changed *changed);

/** Drop the last stroke. As refocus_strokes_extend(); REFOCUS_ERR_STATE when there is
 *  none. */
REFOCUS_API int refocus_strokes_undo(struct refocus_strokes *strokes,
                                     struct refocus_changed *changed);

/** Strokes that there are; 0 for NULL. */
REFOCUS_API int refocus_strokes_count(const struct refocus_strokes *strokes);

/**
 * A stroke and its points, x and y of each. They are the painting's, until it is
 * changed. Each of @p stroke, @p points and @p count may be NULL.
 *
 * @param stroke  receives the stroke; only its struct_size is read, which
 *                refocus_stroke_default() sets
 * @return REFOCUS_OK or REFOCUS_ERR_ARGUMENT; on an error nothing is written
 */
REFOCUS_API int refocus_strokes_get(const struct refocus_strokes *strokes, int index,
                                    struct refocus_stroke *stroke, const float **points,
                                    int *count);

/** The disparities, packed, of the photo's size; the painting's, and changed by it. NULL
 *  for NULL. */
REFOCUS_API const uint16_t *refocus_strokes_disparity(const struct refocus_strokes *strokes);

/**
 * The mask that the last layer covers, 255 or 0.
 *
 * @param mask    a picture of any size of the whole photo, each pixel as at its centre
 * @param stride  bytes from a row to the next; may be negative
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT
 */
REFOCUS_API int refocus_strokes_selection(const struct refocus_strokes *strokes, uint8_t *mask,
                                          int width, int height, ptrdiff_t stride);

/**
 * Paint the strokes of a file after those that there are. The file is one JSON object:
 *
 *     {"refocus-strokes": 1, "width": 2000, "height": 1333, "strokes": [
 *       {"kind": "all", "gradient": [[1000, 1332, 0.95], [1000, 480, 0.05]]},
 *       {"kind": "object", "radius": 24, "points": [[310, 500], [402.5, 511]],
 *        "disparity": 0.6},
 *       {"kind": "less", "radius": 8, "points": [[330, 480]]}]}
 *
 * width and height are those of the upright photo. Kinds: all, object, more, less,
 * brush, fill; see enum refocus_stroke_kind. "disparity" D or "gradient" [[X0, Y0, D0],
 * [X1, Y1, D1]] is the fill, neither means none. "radius" and "points" belong to every
 * kind but all and fill, "reach" may go with object and more. Other keys are errors.
 *
 * @param reason  receives words on an error; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_FORMAT, REFOCUS_ERR_SIZE (it is
 *         of a picture of another size, or has too many strokes or points, more work than
 *         REFOCUS_MAX_STROKE_WORK, or more than 64 MiB), REFOCUS_ERR_MEMORY,
 * REFOCUS_ERR_UNSUPPORTED. On an error nothing has changed.
 */
REFOCUS_API int refocus_strokes_load(struct refocus_strokes *strokes, const void *bytes,
                                     size_t size, struct refocus_strokes_reason *reason);

/**
 * The strokes as such a file, in memory of malloc() that the caller frees. Numbers are
 * written so that they are read as the same again.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY, REFOCUS_ERR_UNSUPPORTED
 */
REFOCUS_API int refocus_strokes_save(const struct refocus_strokes *strokes, char **text,
                                     size_t *size);

#ifdef __cplusplus
}
#endif
#endif
