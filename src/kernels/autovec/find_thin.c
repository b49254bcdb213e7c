/* find_thin.c: finds the pixels of a tile that mix something near with its background, and in what
 * parts. */
#include "kernels/autovec/thin_parts.h"

#include <assert.h>
#include <string.h>

/* Weights of what is hit, by steps less one, for each of the two kinds of directions. */
#define SQUARES(of)                                                                                \
    {                                                                                              \
        of(1), of(4), of(9), of(16), of(25), of(36), of(49), of(64), of(81), of(100), 0            \
    }
#define STRAIGHT(square) 1440 / (square)
#define SLANTED(square)  1440 / (2 * (square))
static const uint16_t weight_of[2][FAR + 1] = {SQUARES(STRAIGHT), SQUARES(SLANTED)};

/* Finds where a pixel that is hit in each direction lies, in rows of the given stride. */
static void find_places(int32_t place[WAYS][FAR + 1], ptrdiff_t stride)
{
    for (int i = 0; i < WAYS; i++) {
        for (int n = 0; n < FAR; n++)
            place[i][n] = (int32_t)((n + 1) * (way[i][1] * stride + way[i][0]));
        place[i][FAR] = 0;
    }
}

struct places {
    int32_t window[WAYS][FAR + 1], tile[WAYS][FAR + 1];
};

static void add_pixel(struct rf_thin_batch *b, const struct rf_thin_row *row,
                      const struct rf_thin_tile *t, const struct rf_thin_window *w,
                      const struct places *places, int x, int y)
{
    const ptrdiff_t at = y * t->stride + x;
    const uint16_t *const map = &w->map[y + MARGIN][x + MARGIN];
    const uint16_t *const red = t->light[0] + at, *const green = t->light[1] + at,
                          *const blue = t->light[2] + at;
    const int k = b->count++;

    b->at[k] = (uint8_t)(y * RF_TILE + x);
    b->kept[k] = row->kept[x];
    b->thin[k] = row->thin[x];
    b->level[k] = row->level[x];
    b->own[k] = *map;
    b->light[0][k] = *red;
    b->light[1][k] = *green;
    b->light[2][k] = *blue;
    for (int i = 0; i < WAYS; i++) {
        const unsigned n = row->hit[i][x];
        const ptrdiff_t to = places->tile[i][n];

        b->weight[i][k] = weight_of[i >= 4][n];
        b->disparity[i][k] = map[places->window[i][n]];
        b->hit[0][i][k] = red[to];
        b->hit[1][i][k] = green[to];
        b->hit[2][i][k] = blue[to];
    }
}

static bool is_bright(const struct rf_thin_batch *b, const struct rf_thin_mixture *m, int k)
{
    for (int c = 0; c < 3; c++)
        if (b->light[c][k] > BRIGHT || m->near_light[c][k] > BRIGHT)
            return true;
    return false;
}

/* Memory that is too large for the stack. */
struct share {
    struct rf_thin_window window;
    struct rf_thin_taps taps[BATCH];
};
static_assert(sizeof(struct share) <= RF_THIN_SHARE, "it fits the memory of callers");

/* Writes the mixtures among the batch: pixels of something thin, or beside something near and
 * mixed. The batch is empty afterwards. */
static int separate(struct rf_thin *out, int most, struct rf_thin_batch *b,
                    const struct rf_thin_tile *t, struct share *share)
{
    struct rf_thin_mixture m;
    int count = 0;

    if (b->count == 0)
        return 0;
    RF_VEC(rf_thin_far)(&m, b);
    RF_VEC(rf_thin_near)(&m, b, t, &share->window, share->taps);
    for (int k = 0; k < b->count && count < most; k++) {
        const bool kept = b->kept[k], mixed = m.mixed[k];

        if (!m.near[k] || (!kept && (m.alpha[k] < LEAST || !mixed)) || is_bright(b, &m, k))
            continue;
        out[count++] = (struct rf_thin){
            .at = b->at[k],
            .alpha = (uint8_t)(mixed && m.alpha[k] ? m.alpha[k] : 255), /* it may be anything */
            .near_disparity = kept ? b->own[k] : m.near[k],
            .far_disparity = m.far[k],
            .light = {(uint16_t)m.far_light[0][k], (uint16_t)m.far_light[1][k],
                      (uint16_t)m.far_light[2][k]},
            .thick = !b->thin[k]};
    }
    memset(b->weight, 0, sizeof b->weight);
    b->count = 0;
    return count;
}

int RF_VEC(rf_find_thin)(struct rf_thin *out, const struct rf_thin_tile *tile, int most,
                         void *memory)
{
    const int rows = rf_clamp(tile->below, 0, RF_TILE), columns = rf_clamp(tile->right, 0, RF_TILE);
    struct share *const share = memory;
    struct rf_thin_window *const w = &share->window;
    struct places places;
    struct rf_thin_batch batch;
    int count = 0;

    if (!RF_VEC(rf_thin_window)(w, tile))
        return 0;
    find_places(places.window, ROW);
    find_places(places.tile, tile->stride);
    memset(&batch, 0, sizeof batch);
    for (int y = 0; y < rows; y++) {
        struct rf_thin_row row;

        unsigned look = RF_VEC(rf_thin_row)(&row, w, y, columns);

        for (; look; look &= look - 1) {
            add_pixel(&batch, &row, tile, w, &places, __builtin_ctz(look), y);
            if (batch.count == BATCH)
                count += separate(out + count, most - count, &batch, tile, share);
        }
    }
    return count + separate(out + count, most - count, &batch, tile, share);
}
