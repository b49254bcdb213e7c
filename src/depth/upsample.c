#include "depth/upsample.h"

#include <stdlib.h>

enum {
    TAPS = 4,
    SAMPLES = TAPS * TAPS,
    SURFACE = 65535 / 24, /* disparities closer than this are of one surface */
};

/* A place between samples: the first of four, and weights of the four in Q8. */
struct taps {
    int first;
    int weight[TAPS];
};

/* Quadratic fall-off over two samples: (2 - |t|)^2 in Q8, t in Q8. */
static int nearness(int t)
{
    const int left = 512 - abs(t);

    return left <= 0 ? 0 : (left * left) >> 10;
}

/* Pixel centres at (x + 1/2) / size of both rasters. */
static struct taps taps_at(int x, int size, int samples)
{
    const int64_t at = ((2 * (int64_t)x + 1) * samples * 128) / size - 128; /* Q8 */
    struct taps taps = {(int)(at >> 8) - 1, {0}};

    for (int i = 0; i < TAPS; i++)
        taps.weight[i] = nearness((int)(at - ((int64_t)(taps.first + i) * 256)));
    return taps;
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

static int sample_at(const struct refocus_disparity *map, int x, int y)
{
    const uint8_t *row = (const uint8_t *)map->samples + y * map->stride;

    return map->bits == 16 ? ((const uint16_t *)row)[x] : row[x] * 257;
}

/* How alike two pixels are: 256 for the same colour, at least 4. */
static int likeness(const struct refocus_renderer *r, ptrdiff_t p, ptrdiff_t q)
{
    const uint8_t *code = r->transfer[r->blend].to_code;
    int apart = 0;

    for (int c = 0; c < 3; c++)
        apart += abs(code[4 * r->front.light[c][p]] - code[4 * r->front.light[c][q]]);
    return apart >= 63 ? 4 : 256 - 4 * apart;
}

/* Mean of the samples of the surface that carries the most weight. */
static int heaviest(const int *d, const int *weight)
{
    int64_t best_weight = -1, best_sum = 0;

    for (int i = 0; i < SAMPLES; i++) {
        int64_t w = 0, sum = 0;

        for (int j = 0; j < SAMPLES; j++) {
            if (abs(d[j] - d[i]) <= SURFACE) {
                w += weight[j];
                sum += (int64_t)weight[j] * d[j];
            }
        }
        if (w > best_weight) {
            best_weight = w;
            best_sum = sum;
        }
    }
    return best_weight > 0 ? (int)((best_sum + best_weight / 2) / best_weight) : d[0];
}

static int upsample(const struct refocus_renderer *r, const struct refocus_disparity *map,
                    int x, int y, const struct taps *across, const struct taps *down)
{
    int d[SAMPLES], weight[SAMPLES], low = 65535, high = 0;
    int64_t w = 0, sum = 0;
    const ptrdiff_t p = y * r->stride + x;

    for (int i = 0; i < SAMPLES; i++) {
        const int sx = clamp(across->first + i % TAPS, map->width - 1);
        const int sy = clamp(down->first + i / TAPS, map->height - 1);

        d[i] = sample_at(map, sx, sy);
        weight[i] = across->weight[i % TAPS] * down->weight[i / TAPS];
        low = d[i] < low ? d[i] : low;
        high = d[i] > high ? d[i] : high;
        w += weight[i];
        sum += (int64_t)weight[i] * d[i];
    }
    if (high - low <= SURFACE)
        return (int)((sum + w / 2) / w);
    for (int i = 0; i < SAMPLES; i++) {
        const int sx = clamp(across->first + i % TAPS, map->width - 1);
        const int sy = clamp(down->first + i / TAPS, map->height - 1);
        const int64_t qx = ((2 * (int64_t)sx + 1) * r->width) / (2 * map->width);
        const int64_t qy = ((2 * (int64_t)sy + 1) * r->height) / (2 * map->height);

        weight[i] *= likeness(r, p, (ptrdiff_t)qy * r->stride + (ptrdiff_t)qx);
    }
    return heaviest(d, weight);
}

void rf_upsample_rows(struct refocus_renderer *r, const struct refocus_disparity *map, int y0,
                      int y1)
{
    const bool sampled = map->width >= r->width && map->height >= r->height;

    for (int y = y0; y < y1; y++) {
        const struct taps down = taps_at(y, r->height, map->height);
        uint16_t *out = r->disparity + y * r->stride;

        for (int x = 0; x < r->width; x++) {
            const struct taps across = taps_at(x, r->width, map->width);

            if (sampled)
                out[x] = (uint16_t)sample_at(
                    map, (int)((2 * (int64_t)x + 1) * map->width / (2 * r->width)),
                    (int)((2 * (int64_t)y + 1) * map->height / (2 * r->height)));
            else
                out[x] = (uint16_t)upsample(r, map, x, y, &across, &down);
        }
    }
}
