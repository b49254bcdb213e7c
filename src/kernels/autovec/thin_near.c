/* thin_near.c: find_thin: computes N and alpha, light and coverage of the thin structure, for a
 * batch of mixtures. */
#include "kernels/autovec/thin_parts.h"

#include <string.h>

enum { TAPS = RF_THIN_TAPS };

static void gather(struct rf_thin_taps *taps, const struct rf_thin_batch *b, int k,
                   const struct rf_thin_tile *t, const struct rf_thin_window *w)
{
    const int x = b->at[k] % RF_TILE, y = b->at[k] / RF_TILE;

    for (int j = 0; j < ACROSS; j++) { /* each a little longer than it is */
        const uint16_t *const map = &w->before[y + j - BEFORE + MARGIN][x - BEFORE + MARGIN];
        const ptrdiff_t at = (y + j - BEFORE) * t->stride + x - BEFORE;

        memcpy(taps->near + ACROSS * j, map, 16);
        for (int c = 0; c < 3; c++)
            memcpy(taps->light[c] + ACROSS * j, t->light[c] + at, 16);
    }
    memset(taps->near + ACROSS * ACROSS, 0, sizeof taps->near - ACROSS * ACROSS * 2);
    for (int c = 0; c < 3; c++)
        memset(taps->light[c] + ACROSS * ACROSS, 0, sizeof taps->light[c] - ACROSS * ACROSS * 2);
}

struct sums {
    uint16_t most[BATCH];
    uint32_t weights[BATCH], high[3][BATCH], low[3][BATCH];
};

static inline int32_t dot(const int16_t *restrict weight, const uint16_t *restrict light)
{
    int32_t sum = 0;

    for (int i = 0; i < TAPS; i++)
        sum += weight[i] * (int16_t)light[i];
    return sum;
}

static void add_taps(struct sums *restrict sums, int k, const struct rf_thin_taps *restrict taps,
                     uint16_t level, const uint16_t far_light[3])
{
    const uint16_t red = far_light[0], green = far_light[1], blue = far_light[2];
    int16_t high[TAPS], low[TAPS]; /* weights, 10 bits each */
    uint32_t weights = 0;
    uint16_t most = 0;

    for (int i = 0; i < TAPS; i++)
        most = rf_most16(most, taps->near[i]);
    for (int i = 0; i < TAPS; i++) {
        const int16_t r = (int16_t)(taps->light[0][i] - red);
        const int16_t g = (int16_t)(taps->light[1][i] - green);
        const int16_t b = (int16_t)(taps->light[2][i] - blue);
        const uint32_t near = taps->near[i] > level ? UINT32_MAX : 0;
        const uint32_t weight =
            (((uint32_t)(r * r) >> 6) + ((uint32_t)(g * g) >> 6) + ((uint32_t)(b * b) >> 6) + 1) &
            near;

        weights += weight;
        high[i] = (int16_t)(weight >> 10);
        low[i] = (int16_t)(weight & 1023);
    }
    sums->most[k] = most > level ? most : 0;
    sums->weights[k] = weights;
    for (int c = 0; c < 3; c++) {
        sums->high[c][k] = (uint32_t)dot(high, taps->light[c]);
        sums->low[c][k] = (uint32_t)dot(low, taps->light[c]);
    }
}

/* Whether N may be too bright for a mixture. */
static bool may_be_bright(const struct rf_thin_taps *taps)
{
    uint16_t most = 0;

    for (int i = 0; i < TAPS; i++)
        most = rf_most16(
            most, rf_most16(taps->light[0][i], rf_most16(taps->light[1][i], taps->light[2][i])));
    return most > BRIGHT;
}

/* N, and the nearest disparity of it. What is kept and not mixed needs only the latter,
 * and whether N is too bright. */
static void set_near(struct rf_thin_mixture *m, const struct rf_thin_batch *b,
                     const struct rf_thin_tile *t, const struct rf_thin_window *w,
                     struct rf_thin_taps *taps)
{
    struct sums sums;
    uint8_t wanted[BATCH];
    int count = 0;

    memset(&sums, 0, sizeof sums);
    for (int k = 0; k < b->count; k++) {
        wanted[count] = (uint8_t)k;
        count += m->mixed[k] || b->kept[k];
        sums.most[k] = b->kept[k] ? b->own[k] : 0;
    }
    for (int i = 0; i < count; i++)
        gather(&taps[i], b, wanted[i], t, w);
    for (int i = 0; i < count; i++) {
        const int k = wanted[i];

        if (m->mixed[k] || may_be_bright(&taps[i]))
            add_taps(&sums, k, &taps[i], b->level[k],
                     (const uint16_t[3]){(uint16_t)m->far_light[0][k], (uint16_t)m->far_light[1][k],
                                         (uint16_t)m->far_light[2][k]});
    }
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < BATCH; k++) {
            const uint32_t by = sums.weights[k] + (sums.weights[k] == 0);
            const uint32_t high = sums.high[c][k], low = sums.low[c][k];
            const float real =
                (float)(int32_t)high * 1024 + (float)(int32_t)low + (float)(int32_t)(by / 2);

            m->near_light[c][k] = quotient(real, (high << 10) + low + by / 2, by);
        }
    }
    memcpy(m->near, sums.most, sizeof m->near);
}

static void add_share(int32_t *restrict along, int32_t *restrict square,
                      const uint16_t *restrict light, const int32_t *restrict far_light,
                      const int32_t *restrict near_light)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t whole = near_light[x] - far_light[x];

        along[x] += whole * (light[x] - far_light[x]);
        square[x] += whole * whole;
    }
}

static void divide_share(int32_t *restrict alpha, const int32_t *restrict along,
                         const int32_t *restrict square)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t all = square[x], some = along[x] & ~(along[x] >> 31);
        const int32_t part = some < all ? some : all;

        alpha[x] = quotient(255 * (float)part, 255 * (uint32_t)part, (uint32_t)(all + (all == 0)));
    }
}

/* No less than makes N black or white. */
static void keep_range(int32_t *restrict alpha, const uint16_t *restrict light,
                       const int32_t *restrict far_light)
{
    for (int x = 0; x < BATCH; x++) {
        const int32_t off = light[x] - far_light[x];
        const int32_t part = 255 * (off < 0 ? -off : off);
        const int32_t whole = off < 0 ? far_light[x] : WHITE - far_light[x];
        const int32_t room = whole > 0 ? whole : 1;
        const int32_t most = part + room - 1;
        const int32_t least = quotient((float)most, (uint32_t)most, (uint32_t)room);

        alpha[x] = least > alpha[x] ? least : alpha[x];
    }
}

/* 0xffffffff: C is more than 30 degrees off the line from F to N. A negative `along` may be either:
 * it is no share. */
static void find_strays(uint32_t *restrict stray, const int32_t *restrict along,
                        const int32_t *restrict square, const int32_t *restrict contrast)
{
    for (int x = 0; x < BATCH; x++) {
        const uint32_t a = (uint32_t)along[x] >> 10; /* 0 to 3 * 2^14 */
        const uint32_t all = ((uint32_t)square[x] >> 10) * ((uint32_t)contrast[x] >> 10);

        stray[x] = a * a < all - (all >> 2) ? UINT32_MAX : 0;
    }
}

/* alpha, Q8: the share of N - F. */
static void set_alpha(struct rf_thin_mixture *m, const struct rf_thin_batch *b)
{
    int32_t along[BATCH] = {0}, square[BATCH] = {0};
    uint32_t stray[BATCH];

    for (int c = 0; c < 3; c++)
        add_share(along, square, b->light[c], m->far_light[c], m->near_light[c]);
    divide_share(m->alpha, along, square);
    for (int c = 0; c < 3; c++)
        keep_range(m->alpha, b->light[c], m->far_light[c]);
    find_strays(stray, along, square, m->contrast);
    for (int x = 0; x < BATCH; x++) {
        const int32_t alpha = m->alpha[x] < 255 ? m->alpha[x] : 255;
        const bool some = along[x] > 0 && square[x] >= FAINT * 16;

        m->alpha[x] = some && !stray[x] ? alpha : 0;
    }
}

void RF_VEC(rf_thin_near)(struct rf_thin_mixture *m, const struct rf_thin_batch *b,
                          const struct rf_thin_tile *t, const struct rf_thin_window *w,
                          struct rf_thin_taps *taps)
{
    set_near(m, b, t, w, taps);
    set_alpha(m, b);
}
