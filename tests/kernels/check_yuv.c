/* check_yuv.c: kernels of luma and chroma: encode, guide and decode against colour/yuv.h a sample
 * at a time, the sweep of one plane and the aim of chroma against their contracts. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guarded.h"

enum {
    MOST = 100,
    LANES = RF_TILE * RF_TILE,
    PAD = 9,
    SIDE = RF_TILE + 2 * PAD,
    STRIDE = SIDE + 7
};

static struct rf_yuv_curve curve;

static int fail(const struct subject *subject, const char *kernel, uint32_t seed, int i, int is,
                int should)
{
    printf("FAIL  %-12s %-6s seed %u: element %d is %d, should be %d\n", kernel, subject->cpu,
           (unsigned)seed, i, is, should);
    return 1;
}

/* Codes: extremes, then noise. */
static uint8_t code(uint32_t seed, uint32_t *state)
{
    static const uint8_t extreme[] = {0, 255, 16, 235, 128, 240};

    return seed % 3 ? (uint8_t)(noise(state) >> 5) : extreme[noise(state) % 6];
}

static int check_encode(const struct subject *subject, struct guarded g[6])
{
    for (uint32_t seed = 1; seed <= 400; seed++) {
        const int n = seed <= 41 ? (int)seed - 1 : (int)(seed % MOST);
        const enum place place = (enum place)(seed % PLACES);
        const bool two = seed % 4 > 0;
        uint32_t state = seed;
        uint8_t *in[3];
        uint16_t *to[3];

        rf_yuv_curve_init(&curve, seed % 2, seed / 2 % 2, seed / 4 % 3);
        for (int i = 0; i < 3; i++) {
            in[i] = guarded_place(&g[i], 2 * (size_t)n, 1, place, 3);
            to[i] = guarded_place(&g[3 + i], 4 * (size_t)n, 2, place, 5);
            for (int x = 0; x < 2 * n; x++)
                in[i][x] = code(seed, &state);
        }
        subject->kernels.encode((uint16_t *const[2]){to[0], two ? to[1] : to[0]}, to[2],
                                (const uint8_t *const[2]){in[0], two ? in[1] : in[0]}, in[2],
                                &curve, n);
        for (int x = 0; x < n; x++) {
            int light[4];
            struct rf_chroma expected;

            for (int k = 0; k < 4; k++)
                light[k] = curve.light_of_luma[in[two ? k / 2 : 0][2 * x + k % 2]];
            expected = rf_chroma_of(&curve, (light[0] + light[1] + light[2] + light[3] + 2) / 4,
                                    in[2][2 * x], in[2][2 * x + 1]);
            if (to[2][2 * x] != expected.blue || to[2][2 * x + 1] != expected.red)
                return fail(subject, "encode", seed, x, to[2][2 * x], expected.blue);
            for (int k = 0; k < (two ? 4 : 2); k++) {
                const int should = rf_luminance(light[k], expected.excess);

                if (to[k / 2][2 * x + k % 2] != should)
                    return fail(subject, "encode", seed, 2 * x + k % 2, to[k / 2][2 * x + k % 2],
                                should);
            }
        }
        for (int i = 0; i < 6; i++)
            if (!guarded_intact(&g[i]))
                return fail(subject, "encode", seed, -1, 0, 0);
    }
    printf("ok    %-12s %-6s 400 cases\n", "encode", subject->cpu);
    return 0;
}

static int check_guide(const struct subject *subject, struct guarded g[6])
{
    for (uint32_t seed = 1; seed <= 400; seed++) {
        const int n = seed <= 41 ? (int)seed - 1 : (int)(seed % (2 * MOST));
        const enum place place = (enum place)(seed % PLACES);
        uint32_t state = seed;
        uint8_t *const luma = guarded_place(&g[0], (size_t)n, 1, place, 3);
        uint8_t *const uv = guarded_place(&g[1], (size_t)n + n % 2, 1, place, 1);
        uint8_t *const rgb = guarded_place(&g[2], 3 * (size_t)n, 1, place, 5);

        rf_yuv_curve_init(&curve, seed % 2, seed / 2 % 2, seed / 4 % 3);
        for (int x = 0; x < n; x++)
            luma[x] = code(seed, &state);
        for (int x = 0; x < n + n % 2; x++)
            uv[x] = code(seed, &state);
        subject->kernels.guide(rgb, luma, uv, &curve, n);
        for (int x = 0; x < n; x++) {
            const int tone = curve.luma[luma[x]], u = uv[x & ~1], v = uv[x | 1];
            const int should[3] = {tone + rf_more(&curve, 1, v), tone - rf_less_green(&curve, u, v),
                                   tone + rf_more(&curve, 0, u)};

            for (int c = 0; c < 3; c++)
                if (rgb[3 * x + c] != (rf_clip_tone(should[c]) + 2) / 4)
                    return fail(subject, "guide", seed, 3 * x + c, rgb[3 * x + c],
                                (rf_clip_tone(should[c]) + 2) / 4);
        }
        for (int i = 0; i < 3; i++)
            if (!guarded_intact(&g[i]))
                return fail(subject, "guide", seed, -1, 0, 0);
    }
    printf("ok    %-12s %-6s 400 cases\n", "guide", subject->cpu);
    return 0;
}

static int clipped(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Sample c of a job, by the contract. */
static int check_sample(const struct subject *subject, uint32_t seed,
                        const struct rf_decode_job *in, const struct rf_decode_job *out, int row,
                        int x)
{
    const int rows = 1 << in->down, at = row * RF_TILE + 2 * x;
    const uint16_t *own = in->own_chroma + row * in->stride + 2 * x;
    const bool same_chroma = in->chroma[at] == 4 * own[0] && in->chroma[at + 1] == 4 * own[1];
    bool same = same_chroma;
    struct rf_chroma_code expected;
    int light = 0;

    for (int k = 0; k < 4; k++)
        light +=
            clipped(in->luma[(row * rows + k / 2 % rows) * RF_TILE + 2 * x + k % 2], RF_MEAN_MAX);
    expected = rf_chroma_code(in->curve, (light + 2) / 4, in->chroma[at], in->chroma[at + 1]);
    for (int k = 0; k < 2 * rows; k++) {
        const int y = row * rows + k / 2, p = y * RF_TILE + 2 * x + k % 2;
        const bool kept =
            same_chroma && in->luma[p] == 4 * in->own_luma[y * in->stride + 2 * x + k % 2];
        const int mean = clipped(in->luma[p], RF_MEAN_MAX) - expected.excess;
        const int should = kept ? in->y[p] : in->curve->to_code[clipped(mean, RF_MEAN_MAX)];

        same = same && kept;
        if (out->y[p] != should)
            return fail(subject, "decode", seed, p, out->y[p], should);
    }
    if (out->uv[at] != (same ? in->uv[at] : expected.u) ||
        out->uv[at + 1] != (same ? in->uv[at + 1] : expected.v))
        return fail(subject, "decode", seed, at, out->uv[at], same ? in->uv[at] : expected.u);
    return 0;
}

static int check_decode(const struct subject *subject)
{
    static uint16_t own[2][RF_TILE * STRIDE];
    static struct rf_decode_job in, out;

    for (uint32_t seed = 1; seed <= 600; seed++) {
        uint32_t state = seed;
        const int least = seed % 5 ? 0 : 4 * RF_MEAN_MAX / 4, down = (int)(seed / 2 % 2);

        rf_yuv_curve_init(&curve, seed % 2, seed / 4 % 2, seed / 8 % 3);
        in = (struct rf_decode_job){.curve = &curve,
                                    .down = down,
                                    .own_luma = own[0],
                                    .own_chroma = own[1],
                                    .stride = STRIDE};
        for (int i = 0; i < LANES; i++) {
            const int at = i / RF_TILE * STRIDE + i % RF_TILE;

            own[0][at] = (uint16_t)noise_between(&state, 0, seed % 7 ? RF_LIGHT_MAX : 16380);
            own[1][at] = (uint16_t)noise_between(&state, 1, RF_CHROMA_MAX);
            in.luma[i] = (uint16_t)(noise(&state) % 2 ? 4 * own[0][at]
                                                      : noise_between(&state, least, 65520));
            if (noise(&state) % 2 && seed % 3)
                in.luma[i] = (uint16_t)noise_between(&state, 0, RF_MEAN_MAX);
            in.chroma[i] = (uint16_t)(i % 4 < 2 || noise(&state) % 4 == 0
                                          ? 4 * own[1][at]
                                          : noise_between(&state, 4, 4 * RF_CHROMA_MAX));
            for (int k = 0; seed % 3 && k < 2; k++) { /* near it */
                uint16_t *v = k ? &in.chroma[i] : &in.luma[i];
                const int to = *v + noise_between(&state, -18, 18);

                if (noise(&state) % 2 && *v == 4 * own[k][at] && to >= 4 * k && to <= 65520)
                    *v = (uint16_t)to;
            }
            in.y[i] = (uint8_t)noise(&state);
            in.uv[i] = (uint8_t)noise(&state);
        }
        out = in;
        subject->kernels.decode(&out);
        for (int row = 0; row < RF_TILE >> down; row++)
            for (int x = 0; x < RF_TILE / 2; x++)
                if (check_sample(subject, seed, &in, &out, row, x))
                    return 1;
    }
    printf("ok    %-12s %-6s 600 cases\n", "decode", subject->cpu);
    return 0;
}

static int round_down(int v, int by)
{
    return v < 0 ? -((-v + by - 1) / by) : v / by;
}

static int check_aim_chroma(const struct subject *subject)
{
    int32_t offset[RF_RAY_CHUNK], pixel[RF_RAY_CHUNK];
    int16_t u[RF_RAY_CHUNK], v[RF_RAY_CHUNK];

    for (uint32_t seed = 1; seed <= 400; seed++) {
        uint32_t state = seed;
        const int n = (int)(seed % (RF_RAY_CHUNK + 1)), down = (int)(seed / 3 % 2);
        const int unit = (int)(seed / 6 % 4), shift = 23 - unit;
        const int blur =
            seed % 4 ? noise_between(&state, -32512, 32512) : (seed % 8 ? 32512 : -32512);

        for (int i = 0; i < n; i++) {
            u[i] = (int16_t)(i % 3 ? noise_between(&state, -32767, 32767) : i % 2 ? 32767 : -32767);
            v[i] = (int16_t)noise_between(&state, -32767, 32767);
        }
        subject->kernels.aim_chroma(offset, pixel, u, v, blur, unit, down, 1000, n);
        for (int i = 0; i < n; i++) {
            const int x = round_down(u[i] * blur + (1 << shift), 2 << shift);
            const int y = round_down(v[i] * blur + (1 << (shift + down - 1)), 1 << (shift + down));
            const int32_t at = 2 * x + y * 1000, to = 2 * x + y * (1 << down) * 1000;

            if (pixel[i] != to)
                return fail(subject, "aim_chroma", seed, i, pixel[i], to);
            if (offset[i] != at)
                return fail(subject, "aim_chroma", seed, i, offset[i], at);
        }
    }
    printf("ok    %-12s %-6s 400 cases\n", "aim_chroma", subject->cpu);
    return 0;
}

struct stage {
    struct guarded blur, light, weight;
    struct rf_slab slab[RF_BINS];
    struct rf_sorted_rays rays;
    struct rf_sweep1_job job;
    uint32_t sum[LANES], expected[LANES];
    uint64_t weighted[2][LANES], expected_weighted[2][LANES]; /* products, weights */
};

static uint16_t *make_plane(struct guarded *g, enum place place, int rows, uint32_t *state,
                            int least, int most, bool extreme)
{
    const int count = (rows + 2 * PAD - 1) * STRIDE + SIDE;
    uint16_t *all = guarded_place(g, (size_t)count * 2, 2, place, noise(state) % 17);

    for (int i = 0; i < count; i++)
        all[i] = (uint16_t)(extreme ? most : noise_between(state, least, most));
    return all + PAD * (STRIDE + 1);
}

static int offset_in(uint32_t *state)
{
    return noise_between(state, -PAD, PAD) * STRIDE + noise_between(state, -PAD, PAD);
}

static int even_offset_in(uint32_t *state)
{
    return noise_between(state, -PAD, PAD) * STRIDE + 2 * noise_between(state, -PAD / 2, PAD / 2);
}

/* How many tests rays have, and which are shared by chroma. */
static void set_classes(struct stage *s, const uint16_t *light, uint32_t *state)
{
    struct rf_sorted_rays *rays = &s->rays;
    int n = 0;

    for (int class = 0; class < RF_SORTED_TESTS; class ++) {
        rays->begin[class] = (uint8_t)n;
        while (n < rays->rays && (rays->tests[n] == class || class == RF_SORTED_TESTS - 1))
            n++;
        rays->shared[class] = (uint8_t)noise_between(state, 0, n - rays->begin[class]);
    }
    rays->begin[RF_SORTED_TESTS] = (uint8_t)n;
    for (int i = 0; i < rays->rays; i++) {
        rays->chroma_last[i] = light + offset_in(state);
        rays->last_weight[i] = s->job.weight + offset_in(state);
        rays->chroma_last_weight[i] = s->job.weight + even_offset_in(state);
        for (int t = 0; t < rays->tests[i]; t++) {
            rays->chroma_offset[t][i] = even_offset_in(state);
            rays->chroma_weight_offset[t][i] = even_offset_in(state);
        }
    }
}

static bool counts(const struct stage *s, int n)
{
    const struct rf_sorted_rays *rays = &s->rays;
    const int class = rays->tests[n] < RF_SORTED_TESTS ? rays->tests[n] : RF_SORTED_TESTS - 1;

    return !s->job.chroma || n - rays->begin[class] < rays->shared[class];
}

static void make_stage(struct stage *s, uint32_t seed, enum place place)
{
    static const int steps[] = {4, 8, 16}, row_counts[] = {2, 4, 6, 8, 10, 12, 14, 16};
    uint32_t state = seed;
    const int step = steps[seed % 3], rows = row_counts[seed / 3 % 8];
    const int slabs = 1 + (int)(seed % 11), jump = (int)(seed / 5 % 2);
    const bool chroma = seed / 7 % 2;
    const int down = chroma && seed / 14 % 2;
    const uint16_t *light;

    for (int k = 0; k < slabs; k++)
        s->slab[k] = (struct rf_slab){(int16_t)noise_between(&state, -3000, 3000),
                                      (uint16_t)noise_between(&state, 0, 479), 0};
    light = make_plane(&s->light, place, rows + jump, &state, 0, 65535 / step, seed % 4 == 0);
    s->job = (struct rf_sweep1_job){
        .blur = (const int16_t *)make_plane(&s->blur, place, rows + jump, &state, 0, 0, false),
        .light = light,
        .apart = STRIDE,
        .half = (rows / 2 + jump) * STRIDE, /* a row is left out in the middle, or none */
        .rows = rows,
        .steps = step,
        .chroma = chroma,
        .rays = &s->rays,
        .weight = make_plane(&s->weight, place, (rows + jump) << down, &state, 1, RF_WEIGHT_MAX,
                             seed % 4 == 0),
        .down = down,
    };
    for (int y = -PAD; y < rows + jump + PAD; y++)
        for (int x = -PAD; x < RF_TILE + PAD; x++) {
            const struct rf_slab *slab = &s->slab[noise(&state) % (uint32_t)slabs];
            int16_t *blur = (int16_t *)(uintptr_t)s->job.blur + y * STRIDE + x;

            *blur = (int16_t)(slab->low + noise_between(&state, -100, slab->width + 100));
            if (chroma && x % 2 && x > -PAD) /* the blur of chroma comes twice */
                *blur = blur[-1];
        }
    s->rays.rays = (int)(seed % (RF_RAY_CHUNK + 1));
    for (int n = 0; n < s->rays.rays; n++) {
        s->rays.tests[n] = (uint8_t)(n * (slabs + 1) / (s->rays.rays + 1));
        for (int t = 0; t < s->rays.tests[n]; t++) {
            s->rays.from[t][n] = rf_range_from(&s->slab[t]);
            s->rays.to[t][n] = rf_range_to(&s->slab[t], &s->slab[t]);
            s->rays.offset[t][n] = offset_in(&state);
        }
        s->rays.last[n] = light + offset_in(&state);
    }
    set_classes(s, light, &state);
    for (int i = 0; i < LANES; i++) {
        s->sum[i] = s->expected[i] = noise(&state);
        for (int k = 0; k < 2; k++)
            s->weighted[k][i] = s->expected_weighted[k][i] = noise(&state);
    }
}

static void expect(struct stage *s, int i, uint16_t light, uint16_t weight)
{
    s->expected[i] += light;
    s->expected_weighted[0][i] += (uint64_t)light * weight;
    s->expected_weighted[1][i] += weight;
}

static void follow(struct stage *s, int i, int n)
{
    const struct rf_sorted_rays *rays = &s->rays;
    const bool chroma = s->job.chroma;
    const int x = i % RF_TILE, y = i / RF_TILE, half = s->job.rows / 2;
    const ptrdiff_t row = y < half ? y * STRIDE : s->job.half + (y - half) * STRIDE;
    const ptrdiff_t p = row + x;
    const uint16_t *weight = s->job.weight + row * (1 << s->job.down) + (chroma ? x / 2 * 2 : x);

    for (int t = 0; t < s->rays.tests[n]; t++) {
        const struct rf_slab *slab = &s->slab[t];
        const ptrdiff_t q = p + (chroma ? rays->chroma_offset : rays->offset)[t][n];
        const int above = s->job.blur[q] - slab->low;

        if (above >= 0 && above <= slab->width) {
            expect(s, i, s->job.light[q],
                   weight[(chroma ? rays->chroma_weight_offset : rays->offset)[t][n]]);
            return;
        }
    }
    expect(s, i, (chroma ? rays->chroma_last : rays->last)[n][p],
           (chroma ? rays->chroma_last_weight : rays->last_weight)[n][weight - s->job.weight]);
}

static int check_sweep1(const struct subject *subject)
{
    static struct stage s;
    int failures = 0;

    if (!guarded_create(&s.blur, (SIDE + 1) * STRIDE * 2) ||
        !guarded_create(&s.light, (SIDE + 1) * STRIDE * 2) ||
        !guarded_create(&s.weight, (SIDE + RF_TILE + 2) * STRIDE * 2)) {
        printf("FAIL  no memory between pages\n");
        return 1;
    }
    for (uint32_t seed = 1; seed <= 600 && !failures; seed++) {
        make_stage(&s, seed, (enum place)(seed % PLACES));
        for (int i = 0; i < s.job.rows * RF_TILE; i++)
            for (int n = 0; n < s.rays.rays; n++)
                if (counts(&s, n))
                    follow(&s, i, n);
        subject->kernels.sweep1(s.sum, &s.job);
        for (int i = 0; i < LANES && !failures; i++)
            if (s.sum[i] != s.expected[i])
                failures = fail(subject, "sweep1", seed, i, (int)s.sum[i], (int)s.expected[i]);
        subject->kernels.sweep1_weighted(s.weighted[0], s.weighted[1], &s.job);
        for (int i = 0; i < 2 * LANES && !failures; i++)
            if (s.weighted[i / LANES][i % LANES] != s.expected_weighted[i / LANES][i % LANES])
                failures =
                    fail(subject, "sweep1_weighted", seed, i, (int)s.weighted[i / LANES][i % LANES],
                         (int)s.expected_weighted[i / LANES][i % LANES]);
    }
    guarded_destroy(&s.blur);
    guarded_destroy(&s.light);
    guarded_destroy(&s.weight);
    if (!failures)
        printf("ok    %-12s %-6s 600 cases, plain and weighted\n", "sweep1", subject->cpu);
    return failures;
}

/* Row y of the cubic through rows 0 2 5 7, by Lagrange, not beyond those beside it. */
static double cubic(const uint16_t *computed, int x, int y)
{
    static const int at[4] = {0, 2, 5, 7};
    double v = 0, low = 0, high = 0;

    for (int k = 0; k < 4; k++) {
        double share = 1;

        for (int j = 0; j < 4; j++)
            if (j != k)
                share *= (double)(y - at[j]) / (at[k] - at[j]);
        v += share * computed[k * RF_TILE + x];
        if (k < 3 && at[k] <= y && y <= at[k + 1]) {
            low = fmin(computed[k * RF_TILE + x], computed[(k + 1) * RF_TILE + x]);
            high = fmax(computed[k * RF_TILE + x], computed[(k + 1) * RF_TILE + x]);
        }
    }
    return fmin(fmax(v, low), high);
}

static int check_between(const struct subject *subject)
{
    uint32_t state = 19;

    for (uint32_t seed = 1; seed <= 200; seed++) {
        uint16_t computed[4 * RF_TILE], mean[8 * RF_TILE], plain[8 * RF_TILE];

        for (int k = 0; k < 4 * RF_TILE; k++)
            computed[k] =
                (uint16_t)(k % RF_TILE == 0 ? (int)seed * 327 : noise_between(&state, 0, 65535));
        subject->kernels.between_chroma(mean, computed);
        subject->plain.between_chroma(plain, computed);
        if (memcmp(mean, plain, sizeof mean))
            return fail(subject, "between_chroma in C", seed, 0, mean[0], plain[0]);
        for (int k = 0; k < 8 * RF_TILE; k++) {
            const double should = cubic(computed, k % RF_TILE, k / RF_TILE);

            if (k % RF_TILE == 0 ? mean[k] != computed[0] : fabs(mean[k] - should) > 8)
                return fail(subject, "between_chroma", seed, k, mean[k], (int)should);
        }
    }
    printf("ok    %-12s %-6s 200 cases\n", "rows between", subject->cpu);
    return 0;
}

/* Pairs one after the other, in each of the four ways, and at any length. */
static int check_keep(const struct subject *subject)
{
    for (uint32_t seed = 1; seed <= 200; seed++) {
        uint16_t out[2 * MOST + 2], own[2 * MOST], filled[2 * MOST + 2];
        int16_t background[2 * MOST];
        const int n = (int)seed % (MOST + 1);
        uint32_t state = seed;

        for (int i = 0; i < 2 * n; i++) {
            own[i] = (uint16_t)noise(&state);
            background[i] =
                (int16_t)(noise(&state) % 3 ? noise_between(&state, -32512, 32512) : RF_NO_BLUR);
        }
        for (int i = 0; i < 2 * n + 2; i++)
            out[i] = filled[i] = (uint16_t)noise(&state);
        subject->kernels.restore_known2(out, own, background, n);
        for (int i = 0; i < 2 * n + 2; i++) {
            const int pair = i & ~1;
            const bool known =
                i < 2 * n && background[pair] != RF_NO_BLUR && background[pair + 1] != RF_NO_BLUR;
            const uint16_t should = known ? own[i] : filled[i];

            if (out[i] != should)
                return fail(subject, "restore_known2", seed, i, out[i], should);
        }
    }
    printf("ok    %-12s %-6s 200 cases\n", "restore_known2", subject->cpu);
    return 0;
}

int check_yuv(const struct subject *subject)
{
    struct guarded g[6];
    int failures = check_decode(subject) + check_aim_chroma(subject) + check_sweep1(subject) +
                   check_between(subject) + check_keep(subject);
    int made = 0;

    while (made < 6 && guarded_create(&g[made], 6 * MOST + 64))
        made++;
    failures += made < 6 ? 1 : check_encode(subject, g) + check_guide(subject, g);
    while (made > 0)
        guarded_destroy(&g[--made]);
    return failures;
}
