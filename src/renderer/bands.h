/* bands.h: rows are shared out in bands of one row of tiles; calls begin and end. */
#ifndef RF_BANDS_H
#define RF_BANDS_H

#include "renderer/renderer.h"

enum { RF_MAX_BANDS = (REFOCUS_MAX_SIDE + RF_TILE - 1) / RF_TILE };

static inline int rf_bands(const struct refocus_renderer *r)
{
    return r->tiles_y;
}

static inline int rf_band_start(int band)
{
    return band * RF_TILE;
}

static inline int rf_band_end(const struct refocus_renderer *r, int band)
{
    const int end = (band + 1) * RF_TILE;

    return end < r->height ? end : r->height;
}

static inline void rf_run_begin(struct refocus_renderer *r)
{
    atomic_store(&r->run.state, RF_RUN_RUNNING);
}

static inline bool rf_cancelled(const struct refocus_renderer *r)
{
    return rf_run_cancelled(&((struct refocus_renderer *)r)->run);
}

/* The same, for the i-th of many small things: each 64th looks. */
static inline bool rf_cancelled_at(const struct refocus_renderer *r, uint32_t i)
{
    return i % 64 == 0 && rf_cancelled(r);
}

/* Whether the run that ends here was cancelled. */
static inline bool rf_run_end(struct refocus_renderer *r)
{
    return atomic_exchange(&r->run.state, RF_RUN_IDLE) == RF_RUN_CANCELLED;
}

#endif
