/* mixture.c: the mixtures of a tile in the list, and which of them are separated. */
#include "thin/mixture.h"

const struct rf_thin_run *rf_thin_run_of(const struct rf_thin_pass *t, int tx, int ty)
{
    const int row = ty + t->view->y0 / RF_TILE, column = tx + t->view->x0 / RF_TILE;
    const int across = (t->view->photo_width + RF_TILE - 1) / RF_TILE;

    return &t->list->run[(size_t)row * across + column];
}

struct rf_thin *rf_thin_of(const struct rf_thin_pass *t, int tx, int ty, uint32_t *count)
{
    const struct rf_thin_run *run = rf_thin_run_of(t, tx, ty);
    const int row = ty + t->view->y0 / RF_TILE;

    *count = run->count;
    return t->list->pixel + (uint64_t)row * rf_thin_capacity(t->view->photo_width) + run->first;
}

struct rf_thin_choice *rf_thin_choice_of(const struct rf_thin_pass *t, int tx, int ty)
{
    return &t->coverage->choice[(size_t)ty * t->view->tiles_x + tx];
}
