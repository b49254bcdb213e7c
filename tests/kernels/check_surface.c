/* check_surface.c: checks the kernels of the depth upsampler. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 3000, BEYOND = 7, ACROSS = RF_TURNED, GAP = 65535 / 44, WIDEST = 65535 / 8 };

/* Eight rows of samples, of cells side by side. */
static struct {
    uint16_t disparity[RF_AROUND][ACROSS];
    uint8_t colour[3][RF_AROUND][ACROSS], trust[RF_AROUND][ACROSS];
} samples;
/* The samples once more, column by column. */
static struct {
    uint16_t disparity[ACROSS * RF_AROUND];
    uint8_t colour[3][ACROSS * RF_AROUND], trust[ACROSS * RF_AROUND];
} turned;
static struct rf_parts parts;
static struct rf_cell cell, plain;
static struct rf_placement placement;
static uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE];

/* Makes samples of one to five surfaces, with noise, slopes, extremes and holes. */
static void make_samples(uint32_t *seed)
{
    const int surfaces = noise_between(seed, 1, 5), slope = noise_between(seed, -3000, 3000);
    const int spread = noise_between(seed, 0, 3) * 500;

    for (int i = 0; i < RF_AROUND * ACROSS; i++) {
        const int x = i % ACROSS, y = i / ACROSS;
        int d = (int)(noise(seed) % (uint32_t)surfaces) * 65535 / 4 + slope * (x % RF_AROUND) +
                noise_between(seed, -spread, spread);

        if (noise(seed) % 40 == 0)
            d = noise(seed) % 2 ? 65535 : 0;
        samples.disparity[y][x] = (uint16_t)(d < 0 ? 0 : d > 65535 ? 65535 : d);
        samples.trust[y][x] = noise(seed) % 4 ? 255 : (uint8_t)noise(seed);
        for (int c = 0; c < 3; c++)
            samples.colour[c][y][x] = (uint8_t)(noise(seed) % (noise(seed) % 3 ? 10 : 64));
    }
}

static void make_pixels(uint32_t *seed)
{
    const uint32_t colours = noise(seed) % 2 ? 64 : 6;

    for (int x = 0; x < RF_BATCH + RF_BATCH_SPARE; x++)
        for (int c = 0; c < 3; c++)
            colour[c][x] = (uint8_t)(noise(seed) % (noise(seed) % 3 ? 10 : colours));
    for (int x = 0; x < RF_BATCH; x++) {
        int left = 65535;

        for (int t = 0; t < RF_TAP_COUNT; t++) {
            placement.near_by[t][x] = (uint16_t)noise_between(seed, 0, left / 4);
            left -= placement.near_by[t][x];
        }
        placement.all[x] = (uint16_t)(65535 - left);
        placement.x[x] = (int16_t)noise_between(seed, -16384, 16384);
        placement.y[x] = (int16_t)noise_between(seed, -16384, 16384);
    }
}

static struct rf_window window_of(int at, bool trusting)
{
    struct rf_window window = {.disparity = turned.disparity + RF_AROUND * at};

    for (int c = 0; c < 3; c++)
        window.colour[c] = turned.colour[c] + RF_AROUND * at;
    window.trust = trusting ? turned.trust + RF_AROUND * at : NULL;
    return window;
}

/* Rows by the kernels, which are compared with the samples themselves. */
static int check_turned(const struct subject *subject, int round)
{
    const uint16_t *disparity[RF_AROUND];
    const uint8_t *byte[4][RF_AROUND];
    bool same = true;

    for (int j = 0; j < RF_AROUND; j++) {
        disparity[j] = samples.disparity[j];
        for (int c = 0; c < 3; c++)
            byte[c][j] = samples.colour[c][j];
        byte[3][j] = samples.trust[j];
    }
    subject->kernels.transpose16(turned.disparity, disparity);
    for (int c = 0; c < 4; c++)
        subject->kernels.transpose8(c < 3 ? turned.colour[c] : turned.trust, byte[c]);
    for (int i = 0; i < ACROSS * RF_AROUND; i++) {
        const int x = i / RF_AROUND, y = i % RF_AROUND;

        same &= turned.disparity[i] == samples.disparity[y][x] &&
                turned.trust[i] == samples.trust[y][x];
        for (int c = 0; c < 3; c++)
            same &= turned.colour[c][i] == samples.colour[c][y][x];
    }
    if (!same)
        printf("FAIL  turn %s: round %d\n", subject->cpu, round);
    return !same;
}

/* The contract, a pixel at a time. */
static uint16_t expect(const struct rf_window *window, int x, uint8_t *sure)
{
    uint32_t best = 0, second = 0;
    int out = cell.surface[0].low;

    for (int k = 0; k < cell.surfaces; k++) {
        const struct rf_surface *s = &cell.surface[k];
        uint32_t prior = 0, alike = 0, score;
        int d;

        for (int t = 0; t < RF_TAP_COUNT; t++)
            if (s->taps >> t & 1)
                prior += cell.sure ? placement.near_by[t][x]
                                   : (uint32_t)placement.near_by[t][x] * cell.trust[t] >> 16;
        for (int i = 0; i < RF_AROUND * RF_AROUND; i++) {
            int unlike = 0;

            for (int c = 0; c < 3; c++)
                unlike += abs(colour[c][x] - window->colour[c][i]);
            alike += s->samples >> i & 1 && unlike < 16 ? rf_likeness[unlike] : 0;
        }
        score = prior * (4 * (alike * s->grow * s->scale >> 16) + RF_UNLIKE) >> 16;
        d = s->mean + ((s->right * placement.x[x] + (1 << 14)) >> 15) +
            ((s->below * placement.y[x] + (1 << 14)) >> 15);
        d = s->low + (d < 0 ? 0 : d > s->range ? s->range : d);
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

/* Every tap is of one surface and lies in its range, every sample of it at most 1/88
 * beyond. */
static bool is_parted(const struct rf_window *window)
{
    int taps = 0;

    for (int k = 0; k < cell.surfaces; k++) {
        const struct rf_surface *s = &cell.surface[k];
        const int high = s->low + s->range;

        if (s->range > WIDEST || (k && s->low <= s[-1].low + s[-1].range) || (taps & s->taps))
            return false;
        for (int t = 0; t < RF_TAP_COUNT; t++) {
            const int d = window->disparity[(t / RF_TAPS + 2) * RF_AROUND + t % RF_TAPS + 2];

            if ((d >= s->low && d <= high) != (s->taps >> t & 1))
                return false;
        }
        taps |= s->taps;
        for (int i = 0; i < RF_AROUND * RF_AROUND; i++) {
            const int d = window->disparity[i];

            if ((s->samples >> i & 1) && (d < s->low - GAP / 2 || d > high + GAP / 2 ||
                                          (window->trust && window->trust[i] < 128)))
                return false;
        }
    }
    return taps == 65535;
}

static int compare(const void *a, const void *b)
{
    return *(const uint16_t *)a - *(const uint16_t *)b;
}

/* Checks n cells: their taps are in order, and parted where they should be. */
static bool are_parts(int n)
{
    for (int i = 0; i < n; i++) {
        uint16_t tap[RF_TAP_COUNT];
        int low = 0;

        for (int t = 0; t < RF_TAP_COUNT; t++)
            tap[t] = samples.disparity[t / RF_TAPS + 2][i + t % RF_TAPS + 2];
        qsort(tap, RF_TAP_COUNT, sizeof *tap, compare);
        for (int t = 0; t < RF_TAP_COUNT; t++) {
            const bool starts = t == 0 || tap[t] - tap[t - 1] > GAP || tap[t] - low > WIDEST;

            low = starts ? tap[t] : low;
            if (parts.sorted[t][i] != tap[t] || (parts.starts[i] >> t & 1) != starts)
                return false;
        }
    }
    return true;
}

static bool is_corner(int i, int j)
{
    return (i == 0 || i == RF_TAPS - 1) && (j == 0 || j == RF_TAPS - 1);
}

static int check_cells(const struct subject *subject, int round, uint32_t *seed)
{
    const int n = round % RF_CELLS + 1, at = round % n, step = noise_between(seed, 0, 20000);
    const bool trusting = round % 3 == 0;
    const struct rf_window window = window_of(at, trusting);
    const uint16_t *row[RF_TAPS];
    const uint8_t *trust[RF_TAPS] = {NULL};
    uint8_t rough[RF_CELLS];
    unsigned any = 0;

    for (int j = 0; j < RF_TAPS; j++) {
        row[j] = samples.disparity[j + 2] + 2;
        trust[j] = trusting ? samples.trust[j + 2] + 2 : NULL;
    }
    subject->kernels.part_taps(&parts, row, n);
    if (!are_parts(n)) {
        printf("FAIL  part %s: round %d\n", subject->cpu, round);
        return 1;
    }
    const unsigned found = subject->kernels.rough_cells(rough, row, trust, step, n);

    for (int i = 0; i < n; i++) {
        int is_rough = 0;

        for (int j = 0; j < RF_TAPS; j++)
            for (int k = 0; k < RF_TAPS; k++) {
                const bool here = trusting && trust[j][i + k] != 255;
                const bool right = k + 1 < RF_TAPS && abs(row[j][i + k] - row[j][i + k + 1]) > step;
                const bool below = j + 1 < RF_TAPS && abs(row[j][i + k] - row[j + 1][i + k]) > step;
                const bool inner = !is_corner(k, j);

                is_rough |= (here && inner) || (right && inner && !is_corner(k + 1, j)) ||
                                    (below && inner && !is_corner(k, j + 1))
                                ? RF_ROUGH
                            : here || right || below ? RF_ROUGH_CORNER
                                                     : 0;
            }
        is_rough = is_rough & RF_ROUGH ? RF_ROUGH : is_rough;
        any |= (unsigned)is_rough;
        if (rough[i] != is_rough) {
            printf("FAIL  rough %s: round %d, cell %d of %d\n", subject->cpu, round, i, n);
            return 1;
        }
    }
    if (found != any) {
        printf("FAIL  rough %s: round %d, any\n", subject->cpu, round);
        return 1;
    }
    subject->plain.find_surfaces(&plain, &window, &parts, at);
    subject->kernels.find_surfaces(&cell, &window, &parts, at);
    if (memcmp(&plain, &cell, sizeof cell) || !is_parted(&window)) {
        printf("FAIL  find_surfaces %s: round %d\n", subject->cpu, round);
        return 1;
    }
    return 0;
}

static int check_pixels(const struct subject *subject, int round)
{
    const int n = round % RF_BATCH + 1, whole = (n + 31) & ~31;
    const struct rf_window window = window_of(round % (round % RF_CELLS + 1), round % 3 == 0);
    uint16_t out[RF_BATCH + BEYOND];
    uint8_t sure[RF_BATCH + BEYOND];

    memset(out, 0xa5, sizeof out);
    memset(sure, 0xa5, sizeof sure);
    subject->kernels.choose_surface(out, sure, &cell, &window, &placement, colour, n);
    for (int x = 0; x < RF_BATCH + BEYOND; x++) {
        uint8_t is_sure = 0xa5;
        const int should = x < n ? expect(&window, x, &is_sure) : 0xa5a5;

        if ((x < n || x >= whole) && (out[x] != should || sure[x] != is_sure)) {
            printf("FAIL  surface %s: round %d, n = %d: pixel %d is %d, should be %d\n",
                   subject->cpu, round, n, x, out[x], should);
            return 1;
        }
    }
    return 0;
}

/* Rows that come to lie between samples, and colours in steps of four. */
static int check_widen(const struct subject *subject, int round, uint32_t *seed)
{
    enum { MOST = 40 };
    struct rf_taps taps[MOST];
    uint16_t out[MOST + BEYOND];
    uint8_t pixels[4 * MOST], quarter[3][MOST + BEYOND];
    uint8_t *const to[3] = {quarter[0], quarter[1], quarter[2]};
    const int n = round % (MOST + 1), bytes = 3 + round % 2;

    memset(out, 0xa5, sizeof out);
    memset(quarter, 0xa5, sizeof quarter);
    for (int x = 0; x < MOST; x++) {
        int left = 32768;

        taps[x].first = noise_between(seed, 0, ACROSS - RF_TAPS);
        for (int k = 0; k < RF_TAPS; k++) {
            const int share = noise_between(seed, 0, left < 32767 ? left : 32767);

            taps[x].share[k] = (int16_t)(k < RF_TAPS - 1 ? share : left < 32767 ? left : 32767);
            left -= taps[x].share[k];
        }
        taps[x].share[0] = (int16_t)(taps[x].share[0] + left);
    }
    for (int i = 0; i < bytes * MOST; i++)
        pixels[i] = (uint8_t)noise(seed);
    subject->kernels.widen4(out, samples.disparity[0], taps, n);
    subject->kernels.quarter(to, pixels, bytes, n);
    for (int x = 0; x < MOST + BEYOND; x++) {
        int sum = 1 << 14;

        for (int k = 0; k < RF_TAPS && x < n; k++)
            sum += (samples.disparity[0][taps[x].first + k] - 32768) * taps[x].share[k];
        if (out[x] != (x < n ? (sum >> 15) + 32768 : 0xa5a5)) {
            printf("FAIL  widen4 %s: round %d, pixel %d of %d\n", subject->cpu, round, x, n);
            return 1;
        }
        for (int c = 0; c < 3; c++)
            if (quarter[c][x] != (x < n ? pixels[bytes * x + c] / 4 : 0xa5)) {
                printf("FAIL  quarter %s: round %d, pixel %d of %d\n", subject->cpu, round, x, n);
                return 1;
            }
    }
    return 0;
}

/* Four rows by the shares of a row of pixels. */
static int check_blend(const struct subject *subject, int round, uint32_t *seed)
{
    const uint16_t *row[RF_TAPS];
    const int n = round % (ACROSS + 1);
    uint16_t out[ACROSS + BEYOND];
    int16_t share[RF_TAPS] = {0};
    int left = 32768;

    for (int j = 0; j < RF_TAPS; j++)
        row[j] = samples.disparity[j];
    for (int j = 0; j < RF_TAPS - 1; j++) { /* the last is left with one at least */
        share[j] = (int16_t)(round % 4            ? noise_between(seed, 0, left - 1)
                             : j == round / 4 % 3 ? 32767
                                                  : 0);
        left -= share[j];
    }
    share[RF_TAPS - 1] = (int16_t)(left < 32767 ? left : 32767);
    share[0] = (int16_t)(share[0] + left - share[RF_TAPS - 1]);
    memset(out, 0xa5, sizeof out);
    subject->kernels.blend4(out, row, share, n);
    for (int x = 0; x < ACROSS + BEYOND; x++) {
        int64_t sum = 1 << 14;

        for (int j = 0; j < RF_TAPS && x < n; j++)
            sum += (int64_t)row[j][x] * share[j];
        if (out[x] != (x < n ? sum >> 15 : 0xa5a5)) {
            printf("FAIL  blend4 %s: round %d, pixel %d of %d\n", subject->cpu, round, x, n);
            return 1;
        }
    }
    return 0;
}

/* The least of nine that more than 3/5 of the weights are at or below. */
static uint16_t leaning(const uint16_t nine[9], const uint8_t sure[9])
{
    int least = 65536, all = 0;

    for (int i = 0; i < 9; i++)
        all += sure[i] ? 4 : 1;
    for (int i = 0; i < 9; i++) {
        int below = 0;

        for (int k = 0; k < 9; k++)
            below += nine[k] / 2 > nine[i] / 2 ? 0 : sure[k] ? 4 : 1;
        if (5 * below > 3 * all && nine[i] / 2 * 2 < least)
            least = nine[i] / 2 * 2;
    }
    return (uint16_t)least;
}

static int check_lean(const struct subject *subject, int round, uint32_t *seed)
{
    enum { MOST = 40 };
    uint16_t d[3][MOST + 2], out[MOST + BEYOND];
    uint8_t is_sure[3][MOST + 2];
    const uint16_t *const row[3] = {d[0] + 1, d[1] + 1, d[2] + 1};
    const uint8_t *const sure[3] = {is_sure[0] + 1, is_sure[1] + 1, is_sure[2] + 1};
    const int n = round % (MOST + 1);

    for (int i = 0; i < 3 * (MOST + 2); i++) {
        const uint16_t any = (uint16_t)noise(seed);

        d[i / (MOST + 2)][i % (MOST + 2)] = round % 2 ? any : any % 3 * 32767;
        is_sure[i / (MOST + 2)][i % (MOST + 2)] = noise(seed) % 3 ? 0 : 255;
    }
    memset(out, 0xa5, sizeof out);
    subject->kernels.median3(out, row, sure, n);
    for (int x = 0; x < MOST + BEYOND; x++) {
        uint16_t nine[9], should = 0xa5a5;
        uint8_t nine_sure[9];

        if (x < n) {
            for (int i = 0; i < 9; i++) {
                nine[i] = d[i / 3][x + i % 3];
                nine_sure[i] = is_sure[i / 3][x + i % 3];
            }
            should = sure[1][x] ? row[1][x] : leaning(nine, nine_sure);
        }
        if (out[x] != should) {
            printf("FAIL  lean3 %s: round %d, pixel %d of %d\n", subject->cpu, round, x, n);
            return 1;
        }
    }
    return 0;
}

int check_surface(const struct subject *subject)
{
    uint32_t seed = 11;

    memset(&cell, 0, sizeof cell);
    memset(&plain, 0, sizeof plain);
    for (int round = 0; round < ROUNDS; round++) {
        make_samples(&seed);
        if (round % 50 == 1)
            memset(samples.trust, 3, sizeof samples.trust);
        make_pixels(&seed);
        if (check_turned(subject, round) || check_cells(subject, round, &seed) ||
            check_pixels(subject, round) || check_widen(subject, round, &seed) ||
            check_blend(subject, round, &seed) || check_lean(subject, round, &seed))
            return 1;
    }
    printf("ok    %-12s %-6s %d cells\n", "choose_surface", subject->cpu, ROUNDS);
    return 0;
}
