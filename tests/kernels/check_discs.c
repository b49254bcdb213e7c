/* check_discs.c: discs of highlights, and what hides them: each kernel against its contract's
 * words, one pixel at a time. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = RF_TILE * RF_TILE, FAR = 40, SIDE = RF_TILE + 2 * FAR };

static int wrong(const struct subject *subject, const char *kernel, int at, long is, long should)
{
    printf("FAIL  %-12s %-6s element %d is %ld, should be %ld\n", kernel, subject->cpu, at, is,
           should);
    return 1;
}

/* A disc of a run that reaches into the tile, of any size, whole or cut off above and
 * below. */
static struct rf_disc_job make_job(uint32_t *seed, uint16_t visible[2 * LANES])
{
    const int count = noise_between(seed, 1, 16), most = noise_between(seed, 0, 127 * 64);
    const int x = noise_between(seed, -most / 64 - count, RF_TILE + most / 64);
    const int unit = noise_between(seed, 0, RF_DISC_MOST_UNIT);
    struct rf_disc_job job = {
        .first = noise_between(seed, 0, RF_TILE),
        .planes = noise(seed) % 2 ? 3 : 1,
        .shift = 8 + unit,
        .unit = unit,
        .from = (int16_t)((64 * x - 32) >> unit),
        .to = (int16_t)((64 * (x + count) - 32) >> unit),
        .visible = noise(seed) % 2 ? visible : NULL,
    };

    job.end = noise_between(seed, job.first, RF_TILE);
    for (int n = 1; n < count; n *= 2)
        job.shift--;
    for (int y = 0; y < RF_TILE; y++) {
        job.right[y] = (int16_t)noise_between(seed, 0, most >> unit);
        job.left[y] = (int16_t)noise_between(seed, -(most >> unit), job.right[y]);
    }
    for (int c = 0; c < 3; c++)
        job.each[c] = (int16_t)(noise(seed) % (noise(seed) % 2 ? 32768 : 512));
    for (int i = 0; i < 2 * LANES; i++)
        visible[i] = noise(seed) % 4 ? 0xffff : 0;
    return job;
}

/* Returns how much of the run pixel x sees, 2^unit / 64 pixel. */
static int seen(const struct rf_disc_job *job, int x, int y)
{
    const int pixel = 64 >> job->unit;
    const int from = pixel * x + job->left[y], to = pixel * x + job->right[y];
    const int v = (to < job->to ? to : job->to) - (from > job->from ? from : job->from);

    return v > 0 ? v : 0;
}

static int check_draw(const struct subject *subject)
{
    uint16_t mean[3][LANES], should[3][LANES], visible[2 * LANES];
    uint32_t seed = 31;

    for (int round = 0; round < 3000; round++) {
        const struct rf_disc_job job = make_job(&seed, visible);

        for (int c = 0; c < 3; c++)
            for (int i = 0; i < LANES; i++)
                mean[c][i] = should[c][i] = (uint16_t)(noise(&seed) % 65536);
        for (int y = job.first; y < job.end; y++) {
            for (int x = 0; x < RF_TILE; x++) {
                const int i = y * RF_TILE + x, v = seen(&job, x, y);

                for (int c = 0; c < job.planes; c++) {
                    const int half = v / 2;
                    const int w = !job.visible
                                      ? v
                                      : (visible[i] ? half : 0) + (visible[LANES + i] ? half : 0);
                    const long light =
                        mean[c][i] + ((w << job.shift) * (long)job.each[c] + 16384) / 32768;

                    should[c][i] = (uint16_t)(light < 65535 ? light : 65535);
                }
            }
        }
        subject->kernels.draw_disc((uint16_t *const[3]){mean[0], mean[1], mean[2]}, &job);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < LANES; i++)
                if (mean[c][i] != should[c][i])
                    return wrong(subject, "draw_disc", i, mean[c][i], should[c][i]);
    }
    printf("ok    %-12s %-6s\n", "draw_disc", subject->cpu);
    return 0;
}

static double half_at(double radius, double y)
{
    return y * y < radius * radius ? sqrt(radius * radius - y * y) : 0;
}

/* The mean of discs of so many rows, half pixels apart from y on. */
static double mean_half(double radius, int y, int tall)
{
    double sum = 0;

    for (int row = 0; row < tall; row++) {
        const double away = 0.5 * y + row - 0.5 * (tall - 1);

        sum += half_at(radius, away - 0.25) + half_at(radius, away + 0.25);
    }
    return sum / (2 * tall);
}

/* Compares with the chords of plain C, and roughly with those of double precision. */
static int check_chords(const struct subject *subject)
{
    for (int radius = 0; radius <= 950 * 256; radius += radius < 1024    ? 1
                                                        : radius < 32512 ? 61
                                                                         : 3001) {
        for (int first = -300; first <= 280; first += radius % 2 ? 15 : 32) {
            const int tall = 1 + (radius + first + 300) % 4;
            const int unit = radius <= 127 * 256 ? radius % 3 : RF_DISC_MOST_UNIT;
            int16_t half[RF_TILE], plain[RF_TILE];

            subject->kernels.half_chords(half, radius, first, tall, unit);
            subject->plain.half_chords(plain, radius, first, tall, unit);
            for (int i = 0; i < RF_TILE; i++) {
                const double should = (64 >> unit) * mean_half(radius / 256.0, first + 2 * i, tall);

                if (half[i] != plain[i] || fabs(half[i] - should) > 0.52)
                    return wrong(subject, "half_chords", i, half[i], lround(should));
            }
        }
    }
    printf("ok    %-12s %-6s\n", "half_chords", subject->cpu);
    return 0;
}

static int rounded(long v, int shift)
{
    return (int)((v + (1L << (shift - 1))) >> shift);
}

/* Whether pixel (x, y) hits the slab where mask k looks: the first one up and to the
 * left, unless it is mirrored. */
static bool is_hit(const struct rf_disc_job *job, const struct rf_disc_way *way,
                   const struct rf_slab *slab, const int16_t *blur, int x, int y, int k)
{
    const long step = (1L << way->shift) * way->times;
    const int pixel = 64 >> job->unit, shift = 23 - way->unit;
    const int from = pixel * x + job->left[y], to = pixel * x + job->right[y];
    const int sum = (from > job->from ? from : job->from) + (to < job->to ? to : job->to);
    const int sees = seen(job, x, y), is_left = way->mirrored ? k : !k;
    const int aside = is_left ? -(way->aside * sees / 16) : (16 - way->aside) * sees / 16;
    const int whole = job->from + job->to - 2 * pixel * x;
    const int least = 2 * job->left[y], most = 2 * job->right[y];
    const int limited = whole < least ? least : whole > most ? most : whole;
    const int right = rounded((sees ? sum - 2 * pixel * x + aside : limited) * step, shift);
    const int down =
        rounded((pixel * (way->middle - 2 * y) + (k ? pixel / 2 : -pixel / 2)) * step, shift);
    const int s = blur[(y + down) * SIDE + x + right];

    return s >= slab->low && s <= slab->low + slab->width;
}

static int check_hide(const struct subject *subject)
{
    static int16_t plane[SIDE * SIDE];
    uint16_t visible[2 * LANES], should[2 * LANES], unused[2 * LANES];
    uint32_t seed = 33;

    for (int round = 0; round < 2000; round++) {
        const int16_t *const blur = plane + FAR * SIDE + FAR;
        struct rf_disc_job job = make_job(&seed, unused);
        const int unit = round % 4 > 2 ? round / 4 % 4 : 0;
        const int low = noise_between(&seed, -600, 400);
        const struct rf_slab slab = {(int16_t)low, (uint16_t)noise_between(&seed, 0, 500), 0};
        const struct rf_disc_way way = {.shift = noise_between(&seed, 0, 2),
                                        .middle = noise_between(&seed, -24, 54),
                                        .rows = 1 << noise_between(&seed, 0, 2),
                                        .most = FAR,
                                        .unit = unit,
                                        .aside = noise_between(&seed, 1, 15),
                                        .mirrored = noise(&seed) % 2,
                                        .times = (int16_t)(noise_between(&seed, -19000, 19000) /
                                                           (round % 2 ? 1 : 16) / (1 << unit))};

        for (int y = 0; y < RF_TILE; y++) {
            job.right[y] = (int16_t)noise_between(&seed, 0, 30 * 64);
            job.left[y] = (int16_t)noise_between(&seed, -30 * 64, job.right[y]);
        }
        for (int i = 0; i < SIDE * SIDE; i++)
            plane[i] = (int16_t)noise_between(&seed, -700, 1000);
        for (int i = 0; i < 2 * LANES; i++)
            visible[i] = should[i] = (uint16_t)noise(&seed);
        for (int y = job.first; y < job.end; y++)
            for (int x = 0; x < RF_TILE; x++)
                for (int k = 0; k < 2; k++)
                    should[k * LANES + y * RF_TILE + x] =
                        is_hit(&job, &way, &slab, blur, x, y - (y - job.first) % way.rows, k)
                            ? 0
                            : 0xffff;
        subject->kernels.occlude_disc(visible, blur, SIDE, &slab, &job, &way);
        for (int i = 0; i < 2 * LANES; i++)
            if (visible[i] != should[i])
                return wrong(subject, "occlude_disc", i, visible[i], should[i]);
    }
    printf("ok    %-12s %-6s\n", "occlude_disc", subject->cpu);
    return 0;
}

static int check_meets(const struct subject *subject)
{
    static int16_t plane[SIDE * SIDE];
    uint32_t seed = 34;

    for (int round = 0; round < 20000; round++) {
        const int width = noise_between(&seed, RF_TILE, SIDE), height = noise_between(&seed, 1, 12),
                  low = noise_between(&seed, -32000, 32000);
        const struct rf_slab slab = {(int16_t)low, (uint16_t)noise_between(&seed, 0, 900), 0};
        const int at = noise_between(&seed, 0, SIDE * height - 1);
        const bool inside = at % SIDE < width;
        bool hit;

        for (int i = 0; i < SIDE * SIDE; i++)
            plane[i] = (int16_t)(low < 0 ? low + slab.width + 1 : low - 1);
        plane[at] = (int16_t)(low + (noise(&seed) % 2 ? slab.width : 0));
        hit = subject->kernels.any_in_slab(plane, SIDE, width, height, &slab);
        if (hit != inside)
            return wrong(subject, "any_in_slab", at, hit, inside);
    }
    printf("ok    %-12s %-6s\n", "any_in_slab", subject->cpu);
    return 0;
}

int check_discs(const struct subject *subject)
{
    return check_draw(subject) + check_chords(subject) + check_meets(subject) + check_hide(subject);
}
