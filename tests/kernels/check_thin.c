/* check_thin.c: find_thin against its reference: wires, hair, surfaces and noise, all sizes of
 * photos. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "thin_plain.h"

enum {
    MOST_SIDE = 100,
    SPARE = 5, /* elements around the photo, that hold anything */
    STRIDE = MOST_SIDE + 2 * SPARE,
    ORIGIN = SPARE * STRIDE + SPARE,
    ROUNDS = 120,
};

static uint16_t disparity[(MOST_SIDE + 2 * SPARE) * STRIDE];
static uint16_t light[3][(MOST_SIDE + 2 * SPARE) * STRIDE];
static uint16_t most3[MOST_SIDE * STRIDE];

static struct photo make_photo(uint32_t *seed, int round)
{
    struct photo p = {.width = noise_between(seed, 1, MOST_SIDE),
                      .height = noise_between(seed, 1, MOST_SIDE),
                      .stride = STRIDE,
                      .disparity = disparity + ORIGIN,
                      .most3 = most3};

    if (round == 0)
        p.width = p.height = MOST_SIDE;
    for (int c = 0; c < 3; c++)
        p.light[c] = light[c] + ORIGIN;
    for (size_t i = 0; i < sizeof disparity / 2; i++) {
        disparity[i] = (uint16_t)noise(seed);
        for (int c = 0; c < 3; c++)
            light[c][i] = (uint16_t)noise(seed);
    }
    return p;
}

static uint16_t limited(int v, int most)
{
    return (uint16_t)(v < 0 ? 0 : v > most ? most : v);
}

/* One to three surfaces behind, sloped, with a little noise. */
static void draw_behind(struct photo *p, uint32_t *seed)
{
    const int surfaces = noise_between(seed, 1, 3), slope = noise_between(seed, -40, 40);
    const int step = noise_between(seed, 0, 15000), at = noise_between(seed, 0, 8000);
    const int rough = noise(seed) % 3 ? 30 : 3000, grain = noise(seed) % 2 ? 8 : 900;
    const int shade = noise_between(seed, 0, 4095);

    for (int i = 0; i < p->width * p->height; i++) {
        const int x = i % p->width, y = i / p->width;
        const size_t k = (size_t)(SPARE + y) * STRIDE + SPARE + (size_t)x;
        const int which = (x + y / 2) * surfaces / (p->width + p->height);

        disparity[k] =
            limited(at + which * step + slope * x + noise_between(seed, 0, rough), 65535);
        for (int c = 0; c < 3; c++)
            light[c][k] = limited(shade + 300 * c * which + noise_between(seed, 0, grain), 4095);
    }
}

/* A line, mixed at its edges. */
static void draw_line(struct photo *p, uint32_t *seed)
{
    const double slope = noise_between(seed, -300, 300) / 100.0;
    const double wide = noise_between(seed, 2, 34) / 4.0;
    const double x0 = noise_between(seed, 0, p->width), y0 = noise_between(seed, 0, p->height);
    const int near = noise(seed) % 8 ? noise_between(seed, 8000, 65535) : 65535;
    const int shade[3] = {noise_between(seed, 0, 4095), noise_between(seed, 0, 4095),
                          noise(seed) % 9 ? noise_between(seed, 0, 3900) : 4095};

    for (int i = 0; i < p->width * p->height; i++) {
        const int x = i % p->width, y = i / p->width;
        const size_t k = (size_t)(SPARE + y) * STRIDE + SPARE + (size_t)x;
        const double off = (noise(seed) % 64 ? 0 : 1) + (x - x0) - slope * (y - y0);
        const double cover = wide / 2 + 0.5 - (off < 0 ? -off : off);
        const double part = cover < 0 ? 0 : cover > 1 ? 1 : cover;

        if (part > 0.5)
            disparity[k] = (uint16_t)(near - (int)(noise(seed) % 300));
        for (int c = 0; c < 3; c++)
            light[c][k] = limited((int)(part * shade[c] + (1 - part) * light[c][k]), 4095);
    }
}

static void draw_noise(struct photo *p, uint32_t *seed)
{
    const uint32_t few = 2 + noise(seed) % 60;

    for (int i = 0; i < p->width * p->height; i++) {
        const size_t k = (size_t)(SPARE + i / p->width) * STRIDE + SPARE + (size_t)(i % p->width);

        if (noise(seed) % few == 0)
            disparity[k] = (uint16_t)(noise(seed) % 4 ? noise(seed) : 65535 * (noise(seed) % 2));
        for (int c = 0; c < 3 && noise(seed) % few == 0; c++)
            light[c][k] = (uint16_t)(noise(seed) % 4096);
    }
}

static void find_most(struct photo *p)
{
    for (int i = 0; i < p->width * p->height; i++) {
        const int x = i % p->width, y = i / p->width;
        uint16_t most = 0;

        for (int k = 0; k < 9; k++) {
            const int u = x + k % 3 - 1, v = y + k / 3 - 1;

            if (u >= 0 && v >= 0 && u < p->width && v < p->height &&
                p->disparity[v * STRIDE + u] > most)
                most = p->disparity[v * STRIDE + u];
        }
        most3[y * STRIDE + x] = most;
    }
}

static bool same(const struct rf_thin *a, const struct rf_thin *b)
{
    return a->at == b->at && a->alpha == b->alpha && a->near_disparity == b->near_disparity &&
           a->far_disparity == b->far_disparity && a->thick == b->thick &&
           !memcmp(a->light, b->light, sizeof a->light);
}

static uint64_t share[RF_THIN_SHARE / sizeof(uint64_t)];

static struct rf_thin_tile tile_of(const struct photo *p, int tx, int ty)
{
    const ptrdiff_t at = ty * RF_TILE * p->stride + tx * RF_TILE;

    return (struct rf_thin_tile){
        .disparity = p->disparity + at,
        .light = {p->light[0] + at, p->light[1] + at, p->light[2] + at},
        .stride = p->stride,
        .left = tx * RF_TILE,
        .above = ty * RF_TILE,
        .right = p->width - tx * RF_TILE,
        .below = p->height - ty * RF_TILE,
    };
}

/* How many there are, or -1 after a line on standard output. */
static int check_tile(const struct subject *subject, const struct photo *p, int tx, int ty,
                      int most)
{
    enum { ALL = RF_TILE * RF_TILE };
    static struct rf_thin out[ALL + 1], plain[ALL];
    const struct rf_thin_tile tile = tile_of(p, tx, ty);
    const int all = find_thin_plain(plain, p, tx, ty), should = all < most ? all : most;
    int count;

    memset(out, 0x5a, sizeof out);
    count = subject->kernels.find_thin(out, &tile, most, share);
    for (int i = 0; i < should && count == should; i++) {
        if (same(&out[i], &plain[i]))
            continue;
        printf("FAIL  find_thin %s: tile %d, %d of %d x %d: pixel %d: at %d alpha %d "
               "%u %u %u %u %u, "
               "should be %d %d %u %u %u %u %u\n",
               subject->cpu, tx, ty, p->width, p->height, i, out[i].at, out[i].alpha,
               out[i].near_disparity, out[i].far_disparity, out[i].light[0], out[i].light[1],
               out[i].light[2], plain[i].at, plain[i].alpha, plain[i].near_disparity,
               plain[i].far_disparity, plain[i].light[0], plain[i].light[1], plain[i].light[2]);
        return -1;
    }
    if (count != should || ((uint8_t *)&out[should])[0] != 0x5a) {
        printf("FAIL  find_thin %s: tile %d, %d of %d x %d: %d, should be %d\n", subject->cpu, tx,
               ty, p->width, p->height, count, should);
        return -1;
    }
    return count;
}

int check_thin(const struct subject *subject)
{
    uint32_t seed = 19;
    int found = 0, full = 0;

    for (int round = 0; round < ROUNDS; round++) {
        struct photo p = make_photo(&seed, round);

        draw_behind(&p, &seed);
        for (int i = noise_between(&seed, 0, 6); i > 0; i--)
            draw_line(&p, &seed);
        if (round % 4 == 0)
            draw_noise(&p, &seed);
        find_most(&p);
        for (int ty = 0; ty * RF_TILE < p.height; ty++) {
            for (int tx = 0; tx * RF_TILE < p.width; tx++) {
                const int most = round % 3 ? RF_TILE * RF_TILE : noise_between(&seed, 0, 60);
                const int count = check_tile(subject, &p, tx, ty, most);

                if (count < 0)
                    return 1;
                found += count;
                full += count == most;
            }
        }
    }
    if (found < 5000 || !full) {
        printf("FAIL  find_thin %s: the scenes hold %d pixels, %d tiles are full\n", subject->cpu,
               found, full);
        return 1;
    }
    printf("ok    %-12s %-6s %d pixels of %d scenes\n", "find_thin", subject->cpu, found, ROUNDS);
    return 0;
}
