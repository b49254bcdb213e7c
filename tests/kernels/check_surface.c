/* The kernels of the depth upsampler. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 3000, BEYOND = 7 };

static struct rf_cell cell, plain;
static struct rf_batch batch;

/* Samples of one to five surfaces, with noise, slopes, extremes and holes. */
static void make_samples(uint16_t disparity[RF_SAMPLES], uint8_t trust[RF_SAMPLES], uint32_t *seed)
{
    const int surfaces = noise_between(seed, 1, 5), slope = noise_between(seed, -3000, 3000);
    const int spread = noise_between(seed, 0, 3) * 500;

    for (int i = 0; i < RF_SAMPLES; i++) {
        int d = (int)(noise(seed) % (uint32_t)surfaces) * 65535 / 4 +
                slope * (i % RF_AROUND) + noise_between(seed, -spread, spread);

        if (noise(seed) % 40 == 0)
            d = noise(seed) % 2 ? 65535 : 0;
        disparity[i] = (uint16_t)(d < 0 ? 0 : d > 65535 ? 65535 : d);
        trust[i] = noise(seed) % 4 ? 255 : (uint8_t)noise(seed);
        for (int c = 0; c < 3; c++)
            cell.colour[c][i] = (uint8_t)(noise(seed) % (noise(seed) % 3 ? 20 : 128));
    }
}

static void make_batch(uint32_t *seed)
{
    for (int x = 0; x < RF_BATCH + RF_BATCH_SPARE; x++) {
        int left[2] = {65535, 65535};

        for (int c = 0; c < 3; c++)
            batch.colour[c][x] = (uint8_t)(noise(seed) % (noise(seed) % 3 ? 20 : 128));
        for (int i = 0; i < RF_TAPS; i++) {
            batch.across[i][x] = (uint16_t)noise_between(seed, 0, left[0]);
            batch.down[i][x] = (uint16_t)noise_between(seed, 0, left[1]);
            left[0] -= batch.across[i][x];
            left[1] -= batch.down[i][x];
        }
        batch.x[x] = (int16_t)noise_between(seed, -16384, 16384);
        batch.y[x] = (int16_t)noise_between(seed, -16384, 16384);
    }
}

/* The contract, a pixel at a time. */
static uint16_t expect(int x, uint8_t *sure)
{
    uint32_t best = 0, second = 0;
    int out = cell.surface[0].low;

    for (int k = 0; k < cell.surfaces; k++) {
        const struct rf_surface *s = &cell.surface[k];
        uint32_t prior = 0, alike = 0, score;
        int d;

        for (int t = 0; t < s->taps; t++) {
            const uint32_t near_by = (uint32_t)batch.across[s->tap[t] % RF_TAPS][x] *
                                     batch.down[s->tap[t] / RF_TAPS][x] >> 16;

            prior += near_by * s->trust[t] >> 16;
        }
        for (int i = 0; i < s->samples; i++) {
            int unlike = 0;

            for (int c = 0; c < 3; c++)
                unlike += abs(batch.colour[c][x] - cell.colour[c][s->sample[i]]);
            alike += rf_likeness[unlike > 31 ? 0 : (31 - unlike) / 2];
        }
        score = prior * (4 * (alike * s->grow * s->scale >> 16) + RF_UNLIKE) >> 16;
        d = s->mean + ((s->right * batch.x[x] + s->below * batch.y[x]) >> 15);
        d = d < s->low ? s->low : d > s->high ? s->high : d;
        if (score > best) {
            second = best;
            best = score;
            out = d;
        } else if (score > second) {
            second = score;
        }
    }
    *sure = best / 4 > second ? 255 : 0;
    return (uint16_t)out;
}

/* Every tap is of one surface and lies in its range, every sample of it at most 1/88 beyond. */
static bool is_parted(const uint16_t disparity[RF_SAMPLES], const uint8_t *trust)
{
    int taps = 0;

    for (int k = 0; k < cell.surfaces; k++) {
        const struct rf_surface *s = &cell.surface[k];

        if (s->high - s->low > 65535 / 8 || (k && s->low <= s[-1].high))
            return false;
        for (int t = 0; t < s->taps; t++) {
            const int i = (s->tap[t] / RF_TAPS + 2) * RF_AROUND + s->tap[t] % RF_TAPS + 2;

            if (disparity[i] < s->low || disparity[i] > s->high)
                return false;
        }
        taps += s->taps;
        for (int n = 0; n < s->samples; n++)
            if (disparity[s->sample[n]] < s->low - 65535 / 88 ||
                disparity[s->sample[n]] > s->high + 65535 / 88 ||
                (trust && trust[s->sample[n]] < 128) ||
                (n && s->sample[n] <= s->sample[n - 1]))
                return false;
    }
    return taps == RF_TAPS * RF_TAPS;
}

int check_surface(const struct subject *subject)
{
    uint32_t seed = 11;

    for (int round = 0; round < ROUNDS; round++) {
        uint16_t disparity[RF_SAMPLES], out[RF_BATCH + BEYOND];
        uint8_t trust[RF_SAMPLES], sure[RF_BATCH + BEYOND];
        const uint8_t *given = round % 3 ? trust : NULL;
        const int n = round % RF_BATCH + 1, whole = (n + 31) & ~31;

        memset(&cell, 0, sizeof cell);
        make_samples(disparity, trust, &seed);
        if (round % 50 == 1)
            memset(trust, 3, sizeof trust);
        make_batch(&seed);
        memset(out, 0xa5, sizeof out);
        memset(sure, 0xa5, sizeof sure);
        plain = cell;
        subject->plain.find_surfaces(&plain, disparity, given);
        subject->kernels.find_surfaces(&cell, disparity, given);
        if (memcmp(&plain, &cell, sizeof cell) || !is_parted(disparity, given)) {
            printf("FAIL  find_surfaces %s: round %d\n", subject->cpu, round);
            return 1;
        }
        subject->kernels.surface(out, sure, &cell, &batch, n);
        for (int x = 0; x < RF_BATCH + BEYOND; x++) {
            uint8_t is_sure = 0xa5;
            const int should = x < whole ? expect(x, &is_sure) : 0xa5a5;

            if (out[x] != should || sure[x] != is_sure) {
                printf("FAIL  surface %s: round %d, n = %d: pixel %d is %d, should be %d\n",
                       subject->cpu, round, n, x, out[x], should);
                return 1;
            }
        }
    }
    printf("ok    %-12s %-6s %d cells\n", "surface", subject->cpu, ROUNDS);
    return 0;
}
