/* method.h: the operations of a refocus method, and the table by which a library offers them. */
#ifndef RF_METHOD_H
#define RF_METHOD_H

#include <refocus/render.h>

#include "gather/frame.h"
#include "gather/work_memory.h"

/* Renders a whole frame: runs its own passes on f->exec and writes all pixels of f->region. */
typedef void rf_frame_fn(struct rf_frame *f);

/* Bytes of f->work that a method needs for pictures and lenses up to the limits. */
typedef uint64_t rf_work_bytes_fn(const struct rf_limits *limits);

/* Makes the curve of a blend and the weights of a sigma in double precision. */
typedef void rf_exact_init_fn(struct rf_exact *exact, uint32_t blend, double sigma);

struct rf_method {
    rf_tile_fn *tile;             /* called for each tile; else NULL, and */
    rf_frame_fn *frame;           /* this once for the whole frame */
    rf_tile_fn *yuv_tile;         /* called for each tile of a photo of Y, U and V; NULL: refused */
    rf_work_bytes_fn *work_bytes; /* NULL: none */
    rf_exact_init_fn *exact;      /* fills f->exact of methods in double precision; else NULL */
    bool layers; /* it needs the pre-filter, the bins of tiles and the hidden background */
};

/* The table that the library of the papers hands to the core. Both are of one build: they share
 * the private structs of this folder, so the version and the size of the largest one must agree. */
struct refocus_papers {
    const char *version;                                  /* REFOCUS_VERSION_STRING */
    uint64_t frame_size;                                  /* sizeof(struct rf_frame) */
    const struct rf_method *method[REFOCUS_METHOD_COUNT]; /* NULL where the core has its own */
};

#endif
