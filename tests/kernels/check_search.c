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

enum { BLUR, LIGHT, BACK_BLUR = 4, BACK, WEIGHT = 8, STAGED }; /* planes; weights have a stride */
enum { WEIGHT_SIDE = SIDE + 9, WEIGHT_ORIGIN = PAD * WEIGHT_SIDE + PAD };

struct stage {
    struct guarded plane[STAGED];
    uint16_t light_weight[RF_LIGHT_MAX + 1];
    struct rf_search_rays rays;
    struct rf_search_job job;
    uint32_t sum[3][LANES];
    uint64_t weighted[4][LANES], expected[2][4][LANES]; /* plain, weighted */
};

/* floor(x + 1/2) of Q15 times Q7.8, by division. */
static int rounded(int u, int blur)
{
    const int64_t x = (int64_t)u * blur + (1 << 22);

    return (int)(x >= 0 ? x / (1 << 23) : -((-x + (1 << 23) - 1) / (1 << 23)));
}

static void expect(struct stage *s, int pixel, const uint16_t *const light[3], ptrdiff_t q,
                   uint64_t weight)
{
    for (int c = 0; c < 3; c++) {
        s->expected[0][c][pixel] += light[c][q];
        s->expected[1][c][pixel] += weight * light[c][q];
    }
    s->expected[1][3][pixel] += weight;
}

static void expect_front(struct stage *s, int pixel, int x, int y)
{
    x += pixel % RF_TILE;
    y += pixel / RF_TILE;
    expect(s, pixel, s->job.light, y * SIDE + x, s->job.weight[y * WEIGHT_SIDE + x]);
}

static void expect_hidden(struct stage *s, int pixel, int n, int guess)
{
    const struct rf_search_job *job = &s->job;
    const int u = s->rays.u[n], v = s->rays.v[n];
    ptrdiff_t q = pixel / RF_TILE * SIDE + pixel % RF_TILE;
    int most = 0;

    if (job->fallback == RF_FALLBACK_OWN) {
        expect_front(s, pixel, 0, 0);
        return;
    }
    if (job->fallback == RF_FALLBACK_MIRRORED) {
        expect_front(s, pixel, -rounded(u, guess), -rounded(v, guess));
        return;
    }
    guess = job->background_blur[q];
    q += rounded(v, guess) * SIDE + rounded(u, guess);
    for (int c = 0; c < (job->first_weighs ? 1 : 3); c++)
        most = job->background[c][q] > most ? job->background[c][q] : most;
    expect(s, pixel, job->background, q,
           s->light_weight[most > RF_LIGHT_MAX ? RF_LIGHT_MAX : most]);
}

static void follow(struct stage *s, int pixel, int n)
{
    const struct rf_search_job *job = &s->job;
    const struct rf_search_rays *rays = &s->rays;
    const ptrdiff_t p = pixel / RF_TILE * SIDE + pixel % RF_TILE;
    int guess = job->blur[p + rays->start[n]];

    for (int tests = job->tests;; tests--) {
        const int x = rounded(rays->u[n], guess), y = rounded(rays->v[n], guess);
        const int seen = job->blur[p + y * SIDE + x];
        const int apart = seen > guess ? seen - guess : guess - seen;

        if (apart > rays->within[n] && tests == 1 && seen > job->blur[p]) {
            expect_hidden(s, pixel, n, guess);
            return;
        }
        if (apart <= rays->within[n] || tests == 1) {
            expect_front(s, pixel, x, y);
            return;
        }
        guess = seen;
    }
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

/* Light that sums just hold: white, or some times that. */
static void make_light(struct stage *s, uint32_t *seed)
{
    static const int brighter[] = {1, 4, 8};
    const int bright = brighter[noise(seed) % 3];

    s->job.steps = (int)noise(seed) % 2 ? 16 / bright : 1;
    for (int i = LIGHT; i < WEIGHT; i++) {
        uint16_t *plane = (uint16_t *)s->plane[i].row;

        for (int j = 0; i != BACK_BLUR && j < SIDE * SIDE; j++)
            plane[j] = (uint16_t)(noise(seed) % (uint32_t)(bright * RF_LIGHT_MAX + 1));
    }
    for (int j = 0; j < SIDE * WEIGHT_SIDE; j++)
        ((uint16_t *)s->plane[WEIGHT].row)[j] = (uint16_t)(1 + noise(seed) % RF_WEIGHT_MAX);
    for (int i = 0; i <= RF_LIGHT_MAX; i++)
        s->light_weight[i] = (uint16_t)(1 + noise(seed) % RF_WEIGHT_MAX);
}

static void make_rays(struct stage *s, uint32_t *seed)
{
    static const int counts[] = {0, 1, 2, 7, RF_RAY_CHUNK};
    static const int within[] = {0, 1, 128, 300, 32766};
    struct rf_search_rays *rays = &s->rays;

    rays->rays = counts[noise(seed) % 5];
    for (int n = 0; n < RF_RAY_CHUNK; n++) {
        const int dx = noise_between(seed, -PAD, PAD), dy = noise_between(seed, -PAD, PAD);
        const int corner = n < 2 ? (n ? 32767 : -32767) : 0;

        rays->start[n] = dy * SIDE + dx;
        rays->u[n] = (int16_t)(corner ? corner : noise_between(seed, -32767, 32767));
        rays->v[n] = (int16_t)(corner ? corner : noise_between(seed, -32767, 32767));
        rays->within[n] = within[noise(seed) % 5];
    }
}

static void make_stage(struct stage *s, enum place place, uint32_t seed)
{
    s->job = (struct rf_search_job){
        .stride = SIDE,
        .tests = noise_between(&seed, 1, 5),
        .rays = &s->rays,
        .fallback = (enum rf_fallback)(noise(&seed) % 3),
        .weight_stride = WEIGHT_SIDE,
        .light_weight = s->light_weight,
        .first_weighs = seed % 3 == 0,
    };
    for (int i = 0; i < STAGED; i++) {
        const size_t side = i == WEIGHT ? WEIGHT_SIDE : SIDE;
        uint16_t *plane = guarded_place(&s->plane[i], SIDE * side * 2, 2, place, noise(&seed) % 8);

        if (i == BLUR || i == BACK_BLUR)
            make_blurs((int16_t *)plane, &seed);
    }
    make_light(s, &seed);
    make_rays(s, &seed);
    s->job.blur = (const int16_t *)s->plane[BLUR].row + ORIGIN;
    s->job.background_blur = (const int16_t *)s->plane[BACK_BLUR].row + ORIGIN;
    s->job.weight = (const uint16_t *)s->plane[WEIGHT].row + WEIGHT_ORIGIN;
    for (int c = 0; c < 3; c++) {
        s->job.light[c] = (const uint16_t *)s->plane[LIGHT + c].row + ORIGIN;
        s->job.background[c] = (const uint16_t *)s->plane[BACK + c].row + ORIGIN;
    }
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < LANES; i++) {
            s->weighted[c][i] = s->expected[1][c][i] = (uint64_t)noise(&seed) << 20;
            if (c < 3)
                s->sum[c][i] = (uint32_t)(s->expected[0][c][i] = noise(&seed));
        }
}

static bool differs(const struct subject *subject, const struct stage *s, const char *name,
                    uint32_t seed, int c, int i, uint64_t value, uint64_t expected)
{
    if (value == expected)
        return false;
    printf("FAIL  %-12s %-6s seed %u, %d rays, %d tests: channel %d of (%d, %d) is "
           "%llu, should be %llu\n",
           name, subject->cpu, (unsigned)seed, s->rays.rays, s->job.tests, c, i % RF_TILE,
           i / RF_TILE, (unsigned long long)value, (unsigned long long)expected);
    return true;
}

static bool check_case(const struct subject *subject, struct stage *s, enum place place,
                       uint32_t seed)
{
    make_stage(s, place, seed);
    for (int i = 0; i < LANES; i++)
        for (int n = 0; n < s->rays.rays; n++)
            follow(s, i, n);
    subject->kernels.search((uint32_t *const[3]){s->sum[0], s->sum[1], s->sum[2]}, &s->job);
    s->job.steps *= s->job.steps > 1 ? 2 : 1;
    subject->kernels.search_weighted(
        (uint64_t *const[4]){s->weighted[0], s->weighted[1], s->weighted[2], s->weighted[3]},
        &s->job);
    for (int i = 0; i < STAGED; i++) {
        if (!guarded_intact(&s->plane[i])) {
            printf("FAIL  %-12s %-6s seed %u: wrote beside plane %d\n", "search", subject->cpu,
                   (unsigned)seed, i);
            return false;
        }
    }
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < LANES; i++)
            if ((c < 3 && differs(subject, s, "search", seed, c, i, s->sum[c][i],
                                  (uint32_t)s->expected[0][c][i])) ||
                differs(subject, s, "search_weighted", seed, c, i, s->weighted[c][i],
                        s->expected[1][c][i]))
                return false;
    return true;
}

static bool create_planes(struct stage *s)
{
    bool good = true;

    for (int i = 0; i < STAGED; i++)
        good = guarded_create(&s->plane[i], (size_t)SIDE * WEIGHT_SIDE * 2) && good;
    return good;
}

static void destroy_planes(struct stage *s)
{
    for (int i = 0; i < STAGED; i++)
        guarded_destroy(&s->plane[i]);
}

int check_search(const struct subject *subject)
{
    static struct stage s;
    uint32_t seed = 1;
    bool good = create_planes(&s);

    if (!good)
        printf("FAIL  no memory between pages\n");
    for (; good && seed <= 600; seed++)
        good = check_case(subject, &s, (enum place)(seed % PLACES), seed);
    destroy_planes(&s);
    if (good)
        printf("ok    %-12s %-6s %d cases\n", "search", subject->cpu, (int)seed - 1);
    return !good;
}
