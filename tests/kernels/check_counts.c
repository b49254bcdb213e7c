/* check_counts.c: searches that count what pixels see, against the contract's words, one pixel and
 * ray at a time. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "guarded.h"

enum {
    ROWS = RF_TILE + 2 * RF_COUNT_REACH,
    PLANE = ROWS * RF_COUNT_ROW,
    MIDDLE = RF_COUNT_REACH * RF_COUNT_ROW + RF_COUNT_REACH, /* the first pixel of a tile */
    MOST_BLUR = RF_COUNT_REACH * 256,
};

struct stage {
    struct guarded blur, planes, counts, touched;
    struct rf_counted_rays rays;
    uint16_t count[RF_COUNTS][RF_TILE];
    uint8_t touched_before[RF_COUNTS];
    uint16_t number[RF_COUNTS];
    uint32_t sum[RF_COUNTED_PLANES][RF_TILE], expected[RF_COUNTED_PLANES][RF_TILE];
};

/* floor(x + 1/2) of Q15 times Q7.8, by division. */
static int rounded(int u, int blur)
{
    const int64_t x = (int64_t)u * blur + (1 << 22);

    return (int)(x >= 0 ? x / (1 << 23) : -((-x + (1 << 23) - 1) / (1 << 23)));
}

static bool is_hit(const struct stage *s, int n, int p, int *offset)
{
    const int16_t *const blur = (const int16_t *)s->blur.row;
    const int guess = blur[p + s->rays.start[n]];
    const int x = rounded(s->rays.u[n], guess), y = rounded(s->rays.v[n], guess);
    const int seen = blur[p + y * RF_COUNT_ROW + x];
    const int apart = seen > guess ? seen - guess : guess - seen;

    *offset = y * RF_COUNT_ROW + x;
    return apart <= s->rays.within[n] || seen <= blur[p];
}

/* Noise, extremes, one surface, or two whose edge crosses the tile, flat or sloped. */
static void make_blurs(int16_t *blur, uint32_t *seed)
{
    const int kind = (int)(noise(seed) % 5), bound = noise_between(seed, 0, RF_COUNT_ROW);
    const int near = noise_between(seed, -MOST_BLUR, MOST_BLUR);
    const int far = noise_between(seed, -MOST_BLUR / 2, MOST_BLUR / 2);

    for (int i = 0; i < PLANE; i++) {
        const int x = i % RF_COUNT_ROW;
        const int any = noise_between(seed, -MOST_BLUR, MOST_BLUR);
        const int edge = x + i / RF_COUNT_ROW / 3 < bound ? near : far;
        const int all[] = {any, any < 0 ? -MOST_BLUR : MOST_BLUR, near, edge, far + 40 * x};

        blur[i] = (int16_t)all[kind];
    }
}

static void make_rays(struct rf_counted_rays *rays, uint32_t *seed)
{
    static const int counts[] = {0, 1, 2, 65, 130}, within[] = {0, 1, 128, 300, 32766};

    rays->rays = counts[noise(seed) % 5];
    for (int n = 0; n < rays->rays; n++) {
        const int corner = n < 2 ? (n ? 32767 : -32767) : 0;

        rays->start[n] =
            (int16_t)(noise_between(seed, -RF_COUNT_REACH, RF_COUNT_REACH) * RF_COUNT_ROW +
                      noise_between(seed, -RF_COUNT_REACH, RF_COUNT_REACH));
        rays->u[n] = (int16_t)(corner ? corner : noise_between(seed, -32767, 32767));
        rays->v[n] = (int16_t)(corner ? corner : noise_between(seed, -32767, 32767));
        rays->within[n] = (uint16_t)within[noise(seed) % 5];
        rays->times[n] = (uint16_t)noise_between(seed, 1, 250);
    }
}

static bool check_counts_of_row(const struct subject *subject, struct stage *s, enum place place,
                                uint32_t seed)
{
    const uint32_t name = seed;
    const int row = (int)(seed % RF_TILE), p = MIDDLE + row * RF_COUNT_ROW;
    int16_t *const blur = guarded_place(&s->blur, PLANE * 2, 2, place, noise(&seed) % 8);
    uint16_t(*const count)[RF_TILE] =
        guarded_place(&s->counts, sizeof s->count, 2, place, noise(&seed) % 8);
    uint8_t *const touched = guarded_place(&s->touched, RF_COUNTS, 1, place, noise(&seed) % 8);

    make_blurs(blur, &seed);
    make_rays(&s->rays, &seed);
    for (int k = 0; k < RF_COUNTS; k++) {
        touched[k] = s->touched_before[k] = noise(&seed) % 4 == 0;
        for (int i = 0; i < RF_TILE; i++)
            count[k][i] = s->count[k][i] = (uint16_t)(noise(&seed) % 50);
    }
    for (int n = 0; n < s->rays.rays; n++) {
        for (int i = 0; i < RF_TILE; i++) {
            int offset;
            const bool hit = is_hit(s, n, p + i, &offset);

            s->count[rf_count_number(0, 0) + (hit ? offset : 0)][i] += s->rays.times[n];
        }
    }
    subject->kernels.count_hits(count, touched, blur + p, &s->rays);
    for (int k = 0; k < RF_COUNTS; k++) {
        for (int i = 0; i < RF_TILE; i++) {
            if (count[k][i] == s->count[k][i])
                continue;
            printf("FAIL  %-12s %-6s seed %u, %d rays: offset %d of pixel %d counts %d, should be "
                   "%d\n",
                   "count_hits", subject->cpu, (unsigned)name, s->rays.rays, k, i, count[k][i],
                   s->count[k][i]);
            return false;
        }
        if (touched[k] < s->touched_before[k] || touched[k] > 1) {
            printf("FAIL  %-12s %-6s seed %u: the mark of offset %d is %d\n", "count_hits",
                   subject->cpu, (unsigned)name, k, touched[k]);
            return false;
        }
    }
    return guarded_intact(&s->blur) && guarded_intact(&s->counts) && guarded_intact(&s->touched);
}

/* Every count that changed is marked: adds up counts of unmarked offsets. */
static bool are_marked(const struct subject *subject, struct stage *s, uint32_t seed)
{
    uint16_t(*const count)[RF_TILE] = (uint16_t(*)[RF_TILE])s->counts.row;
    const int16_t *const blur = (const int16_t *)s->blur.row;
    const int p = MIDDLE + (int)(seed % RF_TILE) * RF_COUNT_ROW;

    memset(s->counts.row, 0, sizeof s->count);
    memset(s->touched.row, 0, RF_COUNTS);
    subject->kernels.count_hits(count, s->touched.row, blur + p, &s->rays);
    for (int k = 0; k < RF_COUNTS; k++)
        for (int i = 0; i < RF_TILE; i++)
            if (count[k][i] && !s->touched.row[k]) {
                printf("FAIL  %-12s %-6s seed %u: offset %d is not marked\n", "count_hits",
                       subject->cpu, (unsigned)seed, k);
                return false;
            }
    return true;
}

/* Counts of a pixel add up to 2^15 - 1 at the most. */
static void make_counts(struct stage *s, uint16_t (*count)[RF_TILE], int n, uint32_t *seed)
{
    const int most = n ? INT16_MAX / n : 0;

    for (int k = 0; k < n; k++) {
        s->number[k] = (uint16_t)rf_count_number(noise_between(seed, -RF_COUNT_REACH, 0) + k % 31,
                                                 k / 31 % 63 - RF_COUNT_REACH);
        for (int i = 0; i < RF_TILE; i++)
            count[s->number[k]][i] =
                (uint16_t)(noise(seed) % 3 ? most : noise_between(seed, 0, most));
    }
}

static bool check_sums(const struct subject *subject, struct stage *s, enum place place,
                       uint32_t seed)
{
    static const int lengths[] = {0, 1, 2, 3, 40, 601}, planes[] = {1, 2, 3, 4, 7};
    const uint32_t name = seed;
    const int row = (int)(seed % RF_TILE), n = lengths[noise(&seed) % 6];
    uint16_t *const plane =
        guarded_place(&s->planes, RF_COUNTED_PLANES * PLANE * 2, 2, place, noise(&seed) % 8);
    uint16_t(*const count)[RF_TILE] =
        guarded_place(&s->counts, sizeof s->count, 2, place, noise(&seed) % 8);
    struct rf_counted_job job = {
        .count = (const uint16_t(*)[RF_TILE])count,
        .plane = plane + row * RF_COUNT_ROW,
        .pitch = PLANE,
        .planes = planes[noise(&seed) % 5],
        .n = n,
        .number = s->number,
    };

    for (int i = 0; i < RF_COUNTED_PLANES * PLANE; i++)
        plane[i] = noise(&seed) % 4 ? INT16_MAX : (uint16_t)(noise(&seed) & INT16_MAX);
    make_counts(s, count, n, &seed);
    for (int j = 0; j < RF_COUNTED_PLANES; j++)
        for (int i = 0; i < RF_TILE; i++) {
            s->sum[j][i] = s->expected[j][i] = noise(&seed);
            for (int k = 0; j < job.planes && k < n; k++)
                s->expected[j][i] += (uint32_t)count[s->number[k]][i] *
                                     plane[j * PLANE + row * RF_COUNT_ROW + s->number[k] + i];
        }
    subject->kernels.add_counted(s->sum, &job);
    if (!memcmp(s->sum, s->expected, sizeof s->sum) && guarded_intact(&s->planes) &&
        guarded_intact(&s->counts))
        return true;
    printf("FAIL  %-12s %-6s seed %u, %d offsets, %d planes\n", "add_counted", subject->cpu,
           (unsigned)name, n, job.planes);
    return false;
}

int check_counts(const struct subject *subject)
{
    static struct stage s;
    uint32_t seed = 1;
    bool good = guarded_create(&s.blur, PLANE * 2);

    good = guarded_create(&s.planes, RF_COUNTED_PLANES * PLANE * 2) && good;
    good = guarded_create(&s.counts, sizeof s.count) && good;
    good = guarded_create(&s.touched, RF_COUNTS) && good;
    if (!good)
        printf("FAIL  no memory between pages\n");
    for (; good && seed <= 60; seed++)
        good = check_counts_of_row(subject, &s, (enum place)(seed % PLACES), seed) &&
               are_marked(subject, &s, seed) &&
               check_sums(subject, &s, (enum place)(seed % PLACES), seed);
    guarded_destroy(&s.blur);
    guarded_destroy(&s.planes);
    guarded_destroy(&s.counts);
    guarded_destroy(&s.touched);
    if (good)
        printf("ok    %-12s %-6s %d cases\n", "search counts", subject->cpu, (int)seed - 1);
    return !good;
}
