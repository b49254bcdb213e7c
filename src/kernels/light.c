/* light.c: loops over light and weights, plain C for the vectoriser. */
#include "kernels/cubic.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

enum { LANES = RF_TILE * RF_TILE };

union number {
    uint64_t bits;
    double real;
};

/* Whole numbers below 2^52 as doubles: the mantissa of 2^52 + v is v. */
static void RF_VEC(to_real)(double *restrict real, const uint64_t *restrict v, int n)
{
    const union number bias = {.real = 4503599627370496.0};

    for (int i = 0; i < n; i++) {
        const union number biased = {.bits = v[i] | bias.bits};

        real[i] = biased.real - bias.real;
    }
}

static void RF_VEC(rf_weighted_means)(uint16_t *restrict mean, const uint64_t *restrict sum,
                                      const uint64_t *restrict weight, int n)
{
    double s[LANES], w[LANES];

    RF_VEC(to_real)(s, sum, n);
    RF_VEC(to_real)(w, weight, n);
    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)(int32_t)(4 * s[i] / w[i] + 0.5);
}

static void RF_VEC(rf_weighed_means)(uint16_t *restrict mean, const uint32_t *restrict sum,
                                     const uint32_t *restrict weight, int n)
{
    for (int i = 0; i < n; i++) {
        const float v = (float)(int32_t)sum[i] * 8192.0f / (float)(int32_t)weight[i] + 0.5f;

        mean[i] = (uint16_t)(int32_t)(v < 65520.0f ? v : 65520.0f);
    }
}

/* Rows between those that are computed, by the cubic through the four nearest: Lagrange's shares
 * in Q14, of rows from `first` on; not beyond the rows before and after, so that an edge
 * does not ring. */
static const struct between {
    uint8_t before, first;
    int16_t share[4];
} between[3][RF_TILE] = {
    {
        /* 2 */
        {0, 0, {16384, 0, 0, 0}},
        {0, 0, {5120, 15360, -5120, 1024}},
        {1, 0, {0, 16384, 0, 0}},
        {1, 0, {-1024, 9216, 9216, -1024}},
        {2, 1, {0, 16384, 0, 0}},
        {2, 1, {-1170, 9830, 8192, -468}},
        {3, 2, {0, 16384, 0, 0}},
        {3, 2, {-1872, 13106, 6554, -1404}},
        {3, 2, {-1404, 6554, 13106, -1872}},
        {4, 3, {0, 16384, 0, 0}},
        {4, 3, {-468, 8192, 9830, -1170}},
        {5, 4, {0, 16384, 0, 0}},
        {5, 4, {-1024, 9216, 9216, -1024}},
        {6, 4, {0, 0, 16384, 0}},
        {6, 4, {1024, -5120, 15360, 5120}},
        {6, 4, {0, 0, 0, 16384}},
    },
    {
        /* 3 */
        {0, 0, {16384, 0, 0, 0}},
        {0, 0, {8091, 12137, -4855, 1011}},
        {0, 0, {2832, 16991, -4248, 809}},
        {1, 0, {0, 16384, 0, 0}},
        {1, 0, {-1011, 12136, 6068, -809}},
        {1, 0, {-809, 6068, 12136, -1011}},
        {2, 1, {0, 16384, 0, 0}},
        {2, 1, {-1011, 12136, 6068, -809}},
        {2, 1, {-809, 6068, 12136, -1011}},
        {3, 2, {0, 16384, 0, 0}},
        {3, 2, {-1011, 12136, 6068, -809}},
        {3, 2, {-809, 6068, 12136, -1011}},
        {4, 2, {0, 0, 16384, 0}},
        {4, 2, {809, -4248, 16991, 2832}},
        {4, 2, {1011, -4855, 12137, 8091}},
        {4, 2, {0, 0, 0, 16384}},
    },
    {
        /* 5 */
        {0, 0, {16384, 0, 0, 0}},
        {0, 0, {11010, 8258, -3670, 786}},
        {0, 0, {6816, 13631, -5112, 1049}},
        {0, 0, {3670, 16515, -4719, 918}},
        {0, 0, {1442, 17302, -2884, 524}},
        {1, 0, {0, 16384, 0, 0}},
        {1, 0, {-786, 14155, 3539, -524}},
        {1, 0, {-1049, 11011, 7340, -918}},
        {1, 0, {-918, 7340, 11011, -1049}},
        {1, 0, {-524, 3539, 14155, -786}},
        {2, 0, {0, 0, 16384, 0}},
        {2, 0, {524, -2884, 17302, 1442}},
        {2, 0, {918, -4719, 16515, 3670}},
        {2, 0, {1049, -5112, 13631, 6816}},
        {2, 0, {786, -3670, 8258, 11010}},
        {2, 0, {0, 0, 0, 16384}},
    },
};

static void RF_VEC(rf_between_rows)(uint16_t *restrict mean, const uint16_t *restrict computed,
                                    int step)
{
    for (int y = 0; y < RF_TILE; y++) {
        const struct between *row = &between[(step - 1) / 2][y];

        rf_cubic_row(mean + y * RF_TILE, computed + row->first * RF_TILE,
                     computed + row->before * RF_TILE, row->share);
    }
}

/* A value moved towards the average of two. */
static inline uint16_t moved(uint16_t own, uint16_t a, uint16_t b, uint32_t share)
{
    const uint16_t average = (uint16_t)((a + b + 1) >> 1);
    const uint16_t up = (uint16_t)(average > own ? average - own : 0);
    const uint16_t down = (uint16_t)(own > average ? own - average : 0);
    const uint16_t more = (uint16_t)((uint16_t)(up * share >> 16) >> 1);
    const uint16_t less = (uint16_t)((uint16_t)(down * share >> 16) >> 1);

    return (uint16_t)(own + more - less);
}

/* A row moved towards the averages of what lies `apart` elements before and after. */
static inline void soften_row(uint16_t *restrict out, const uint16_t *restrict own, ptrdiff_t apart,
                              uint16_t share)
{
    const uint16_t *before = own - apart, *after = own + apart;

    for (int x = 0; x < RF_TILE; x++)
        out[x] = moved(own[x], before[x], after[x], share);
}

static void RF_VEC(rf_soften)(uint16_t *mean, int rows, int each, bool down, uint16_t share)
{
    uint16_t padded[RF_TILE * (RF_TILE + 2)], across[RF_TILE * RF_TILE];
    uint16_t *const own = padded + RF_TILE;
    const int n = rows * RF_TILE;

    memcpy(own, mean, (size_t)n * sizeof *mean);
    memset(padded, 0, RF_TILE * sizeof *padded); /* beyond both ends: is not used */
    memset(own + n, 0, RF_TILE * sizeof *own);
    for (int y = 0; y < n; y += RF_TILE) {
        soften_row(across + y, own + y, each, share);
        for (int i = 0; i < each; i++) {
            across[y + i] = own[y + i];
            across[y + RF_TILE - 1 - i] = own[y + RF_TILE - 1 - i];
        }
    }
    memcpy(mean, across, (size_t)n * sizeof *mean);
    for (int y = RF_TILE; down && y < n - RF_TILE; y += RF_TILE)
        soften_row(mean + y, across + y, RF_TILE, share);
}

/* A row of cells at the middles of pixels, those of a channel together. */
static void across_cells(int32_t out[4][RF_TILE], int32_t cell[RF_VEIL_CELLS][4])
{
    for (int x = 0; x < RF_TILE; x++) {
        const int at = 2 * x + 5, i = at >> 3, part = at & 7; /* eighths of a cell */

        for (int c = 0; c < 4; c++)
            out[c][x] =
                (cell[i][c] * (8 - part) + cell[i + 1][c] * part) >> (RF_VEIL_SHIFT + 3 - 8);
    }
}

/* All channels between two rows of cells. */
static void down_cells(int32_t *restrict out, const int32_t *restrict above,
                       const int32_t *restrict below, int part)
{
    for (int k = 0; k < 4 * RF_TILE; k++)
        out[k] = (above[k] * (8 - part) + below[k] * part) >> 8;
}

static void lay_row(uint16_t *restrict out, const int32_t *restrict light,
                    const int32_t *restrict cover)
{
    for (int x = 0; x < RF_TILE; x++) {
        const int32_t some = cover[x] < 0 ? 0 : cover[x];
        const uint32_t part = (uint32_t)(some > 32768 ? 32768 : some);
        const int32_t v = out[x] + (light[x] >> 1) - (int32_t)((out[x] * part + 16384) >> 15);

        out[x] = (uint16_t)(v < 0 ? 0 : v > 65535 ? 65535 : v);
    }
}

static void RF_VEC(rf_lay_veil)(uint16_t *const mean[3],
                                int32_t cell[RF_VEIL_CELLS][RF_VEIL_CELLS][4])
{
    int32_t row[RF_VEIL_CELLS][4][RF_TILE];

    for (int i = 0; i < RF_VEIL_CELLS; i++)
        across_cells(row[i], cell[i]);
    for (int y = 0; y < RF_TILE; y++) {
        const int at = 2 * y + 5, i = at >> 3, part = at & 7;
        int32_t veil[4 * RF_TILE]; /* Q15 */

        down_cells(veil, row[i][0], row[i + 1][0], part);
        for (int c = 0; c < 3; c++)
            lay_row(mean[c] + y * RF_TILE, veil + c * RF_TILE, veil + 3 * RF_TILE);
    }
}

static inline uint16_t max16(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static uint16_t RF_VEC(rf_brightest)(const uint16_t *restrict red, const uint16_t *restrict green,
                                     const uint16_t *restrict blue, int n)
{
    uint16_t most = 0;

    for (int x = 0; x < n; x++)
        most = max16(most, max16(red[x], max16(green[x], blue[x])));
    return most;
}

void RF_VEC(rf_light_use)(struct rf_kernels *kernels)
{
    kernels->between_rows = RF_VEC(rf_between_rows);
    kernels->soften = RF_VEC(rf_soften);
    kernels->lay_veil = RF_VEC(rf_lay_veil);
    kernels->brightest = RF_VEC(rf_brightest);
    kernels->weighted_means = RF_VEC(rf_weighted_means);
    kernels->weighed_means = RF_VEC(rf_weighed_means);
}
