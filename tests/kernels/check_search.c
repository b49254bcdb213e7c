/* check_search.c: the search over one strip, against the contract's words, one pixel and ray at
 * a time. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "guarded.h"

enum {
    PAD = 12,
    SIDE = RF_TILE + 2 * PAD,
    LANES = RF_STRIP_LANES,
    MOST_BLUR = PAD * 256,
    ORIGIN = PAD * SIDE + PAD,
};

struct stage {
    struct guarded plane[4]; /* blur, light */
    struct rf_search_rays rays;
    struct rf_search_job job;
    uint32_t sum[3][LANES], expected[3][LANES];
};

/* floor(x + 1/2) of Q15 times Q7.8, by division. */
static int rounded(int u, int blur)
{
    const int64_t x = (int64_t)u * blur + (1 << 22);

    return (int)(x >= 0 ? x / (1 << 23) : -((-x + (1 << 23) - 1) / (1 << 23)));
}

static void follow(struct stage *s, int pixel, int n)
{
    const struct rf_search_job *job = &s->job;
    const struct rf_search_rays *rays = &s->rays;
    const ptrdiff_t p = pixel / RF_TILE * SIDE + pixel % RF_TILE;
    int guess = job->blur[p + rays->start[n]], tests = job->tests;
    ptrdiff_t q;

    for (;;) {
        int apart;

        q = p + rounded(rays->v[n], guess) * SIDE + rounded(rays->u[n], guess);
        apart = job->blur[q] - guess;
        apart = apart < 0 ? -apart : apart;
        if (apart <= rays->within[n])
            break;
        if (--tests == 0) {
            if (job->blur[q] > job->blur[p])
                q = p;
            break;
        }
        guess = job->blur[q];
    }
    for (int c = 0; c < 3; c++)
        s->expected[c][pixel] += job->light[c][q];
}

/* Two surfaces, or noise, or one: so that rows agree and do not. */
static void make_blurs(int16_t *blur, uint32_t *seed)
{
    const int kind = (int)(noise(seed) % 4), bound = noise_between(seed, 0, SIDE);
    const int near = noise_between(seed, -MOST_BLUR, MOST_BLUR);
    const int far = noise_between(seed, -MOST_BLUR, MOST_BLUR);

    for (int i = 0; i < SIDE * SIDE; i++) {
        const int flat = i % SIDE + i / SIDE / 3 < bound ? near : far;
        const int any = noise_between(seed, -MOST_BLUR, MOST_BLUR);
        const int extreme = any < 0 ? -MOST_BLUR : MOST_BLUR;

        blur[i] = (int16_t)(kind == 0 ? any : kind == 1 ? extreme : kind == 2 ? near : flat);
    }
}

static void make_stage(struct stage *s, enum place place, uint32_t seed)
{
    static const int counts[] = {0, 1, 2, 7, RF_RAY_CHUNK};
    static const int within[] = {0, 1, 128, 300, 32766};
    const size_t bytes = (size_t)SIDE * SIDE * 2;

    s->job = (struct rf_search_job){
        .stride = SIDE,
        .tests = noise_between(&seed, 1, 5),
        .rays = &s->rays,
    };
    s->rays.rays = counts[noise(&seed) % 5];
    for (int i = 0; i < 4; i++) {
        uint16_t *plane = guarded_place(&s->plane[i], bytes, 2, place, noise(&seed) % 8);

        if (i == 0)
            make_blurs((int16_t *)plane, &seed);
        for (int j = 0; i > 0 && j < SIDE * SIDE; j++)
            plane[j] = (uint16_t)(noise(&seed) % 4096);
        if (i == 0)
            s->job.blur = (const int16_t *)plane + ORIGIN;
        else
            s->job.light[i - 1] = plane + ORIGIN;
    }
    for (int n = 0; n < RF_RAY_CHUNK; n++) {
        const int dx = noise_between(&seed, -PAD, PAD), dy = noise_between(&seed, -PAD, PAD);
        const int corner = n < 2 ? (n ? 32767 : -32767) : 0;

        s->rays.start[n] = dy * SIDE + dx;
        s->rays.u[n] = (int16_t)(corner ? corner : noise_between(&seed, -32767, 32767));
        s->rays.v[n] = (int16_t)(corner ? corner : noise_between(&seed, -32767, 32767));
        s->rays.within[n] = within[noise(&seed) % 5];
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            s->sum[c][i] = s->expected[c][i] = noise(&seed);
}

static bool check_case(const struct subject *subject, struct stage *s, enum place place,
                       uint32_t seed)
{
    make_stage(s, place, seed);
    for (int i = 0; i < LANES; i++)
        for (int n = 0; n < s->rays.rays; n++)
            follow(s, i, n);
    subject->kernels.search((uint32_t *const[3]){s->sum[0], s->sum[1], s->sum[2]}, &s->job);
    for (int i = 0; i < 4; i++) {
        if (!guarded_intact(&s->plane[i])) {
            printf("FAIL  %-12s %-6s seed %u: wrote beside plane %d\n", "search", subject->cpu,
                   (unsigned)seed, i);
            return false;
        }
    }
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < LANES; i++) {
            if (s->sum[c][i] == s->expected[c][i])
                continue;
            printf("FAIL  %-12s %-6s seed %u, %d rays, %d tests: channel %d of (%d, %d) is "
                   "%u, should be %u\n",
                   "search", subject->cpu, (unsigned)seed, s->rays.rays, s->job.tests, c,
                   i % RF_TILE, i / RF_TILE, (unsigned)s->sum[c][i], (unsigned)s->expected[c][i]);
            return false;
        }
    }
    return true;
}

int check_search(const struct subject *subject)
{
    static struct stage s;
    uint32_t seed = 1;
    bool good = true;

    for (int i = 0; i < 4; i++)
        good = good && guarded_create(&s.plane[i], (size_t)SIDE * SIDE * 2);
    if (!good)
        printf("FAIL  no memory between pages\n");
    for (; good && seed <= 300; seed++)
        good = check_case(subject, &s, (enum place)(seed % PLACES), seed);
    for (int i = 0; i < 4; i++)
        guarded_destroy(&s.plane[i]);
    if (good)
        printf("ok    %-12s %-6s %d cases\n", "search", subject->cpu, (int)seed - 1);
    return !good;
}

struct bench {
    struct stage *stage;
    rf_search_fn *search;
};

static void call(void *context)
{
    const struct bench *b = context;
    uint32_t *const sum[3] = {b->stage->sum[0], b->stage->sum[1], b->stage->sum[2]};

    for (int i = 0; i < 20; i++)
        b->search(sum, &b->stage->job);
}

/* Two surfaces, whose edge runs through the strip, or one. */
static void bench_case(const struct subject *subject, struct stage *s, bool edge)
{
    const double samples = 20.0 * RF_RAY_CHUNK * LANES;
    struct bench b = {s, subject->plain.search};
    int16_t *blur;
    double plain, own;

    make_stage(s, INSIDE, 1);
    blur = (int16_t *)s->plane[0].row;
    for (int i = 0; i < SIDE * SIDE; i++)
        blur[i] = edge && i % SIDE + i / SIDE / 3 < PAD + RF_TILE / 2 ? -1500 : 700;
    for (int n = 0; n < RF_RAY_CHUNK; n++)
        s->rays.within[n] = 128;
    s->rays.rays = RF_RAY_CHUNK;
    s->job.tests = 2;
    plain = best_time(call, &b);
    b.search = subject->kernels.search;
    own = best_time(call, &b);
    printf("ok    %-12s %-6s c %.3f  %s %.3f ns/ray sample\n",
           edge ? "search, edge" : "search, flat", subject->cpu, plain * 1e9 / samples,
           subject->cpu, own * 1e9 / samples);
}

void bench_search(const struct subject *subject)
{
    static struct stage s;
    bool good = true;

    for (int i = 0; i < 4; i++)
        good = good && guarded_create(&s.plane[i], (size_t)SIDE * SIDE * 2);
    if (good) {
        bench_case(subject, &s, false);
        bench_case(subject, &s, true);
    }
    for (int i = 0; i < 4; i++)
        guarded_destroy(&s.plane[i]);
}
