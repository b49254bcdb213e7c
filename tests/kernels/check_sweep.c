/* The sweep over one tile, against a reference that follows one ray of one pixel at a time. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "guarded.h"

enum {
    PAD = 9,
    SIDE = RF_TILE + 2 * PAD,
    PITCH = SIDE + 5, /* between the rows of a group's planes */
    STRIDE = 4 * PITCH,
    WEIGHT_STRIDE = SIDE + 3,
    MOST_SLABS = 12,
    LANES = RF_TILE * RF_TILE,
};

struct stage {
    struct guarded front, behind; /* groups of planes: blur and light, light and weight */
    struct guarded weight;        /* of the front */
    struct rf_slab slab[MOST_SLABS];
    int32_t offset[MOST_SLABS + 1][RF_RAY_CHUNK];
    int32_t weight_offset[MOST_SLABS][RF_RAY_CHUNK];
    struct rf_sweep_job job;
    uint32_t sum[3][LANES], expected[3][LANES];
    uint64_t weighted[4][LANES], expected_weighted[4][LANES];
};

static void count(struct stage *s, int pixel, const uint16_t *red, uint16_t weight)
{
    for (int c = 0; c < 3; c++) {
        s->expected[c][pixel] += red[c * PITCH];
        s->expected_weighted[c][pixel] += (uint64_t)red[c * PITCH] * weight;
    }
    s->expected_weighted[3][pixel] += weight;
}

static void follow(struct stage *s, int pixel, int ray)
{
    const struct rf_sweep_job *job = &s->job;
    const ptrdiff_t p = pixel / RF_TILE * STRIDE + pixel % RF_TILE;
    const ptrdiff_t w = pixel / RF_TILE * WEIGHT_STRIDE + pixel % RF_TILE;
    ptrdiff_t q;

    for (int k = 0; k < job->slabs; k++) {
        int above;

        q = p + job->offset[k][ray];
        above = job->blur[q] - job->slab[k].low;
        if (above >= 0 && above <= job->slab[k].width) {
            count(s, pixel, (const uint16_t *)job->blur + q + PITCH,
                  job->weight[w + s->weight_offset[k][ray]]);
            return;
        }
    }
    q = p + job->offset[job->slabs][ray];
    count(s, pixel, job->behind + q, job->behind_weight[q]);
}

/* Offsets as far as the planes reach, at first to their corners. */
static void make_offsets(struct stage *s, uint32_t *seed)
{
    for (int k = 0; k <= s->job.slabs; k++) {
        for (int n = 0; n < RF_RAY_CHUNK; n++) {
            int dx = noise_between(seed, -PAD, PAD), dy = noise_between(seed, -PAD, PAD);

            if (n < 4) {
                dx = n % 2 ? PAD : -PAD;
                dy = n / 2 ? PAD : -PAD;
            }
            s->offset[k][n] = dy * STRIDE + dx;
            if (k < s->job.slabs)
                s->weight_offset[k][n] = dy * WEIGHT_STRIDE + dx;
        }
    }
}

/* Slabs anywhere, but for `one`: then all blurs are in the first. */
static void make_slabs(struct stage *s, bool one, uint32_t *seed)
{
    for (int k = 0; k < MOST_SLABS; k++) {
        s->slab[k].low = (int16_t)noise_between(seed, -127 * 256 - 32, 127 * 256 - 400);
        s->slab[k].width = (uint16_t)noise_between(seed, 0, 320);
        s->slab[k].centre = 0;
    }
    if (noise(seed) % 4 == 0)
        s->slab[0].low = -127 * 256 - 32;
    if (one)
        s->slab[0].width = 319;
}

/* Light of planes from `first` on of a group of `planes`; no light between their rows. Ends
 * with the last pixel of the last plane. Returns the tile's first pixel. */
static uint16_t *make_group(struct guarded *guarded, int planes, int first, int most,
                            bool extreme, enum place place, uint32_t *seed)
{
    const int count = (SIDE - 1) * STRIDE + (planes - 1) * PITCH + SIDE;
    uint16_t *all = guarded_place(guarded, (size_t)count * 2, 2, place, noise(seed) % 17);

    for (int i = 0; i < count; i++) {
        const int plane = i % STRIDE / PITCH, x = i % PITCH;

        all[i] = 0xffff;
        if (plane >= first && plane < planes && x < SIDE)
            all[i] = (uint16_t)(extreme ? most : noise_between(seed, 0, most));
    }
    return all + PAD * (STRIDE + 1);
}

static void make_weights(uint16_t *weight, ptrdiff_t stride, bool extreme, uint32_t *seed)
{
    for (int y = -PAD; y < RF_TILE + PAD; y++)
        for (int x = -PAD; x < RF_TILE + PAD; x++)
            weight[y * stride + x] =
                (uint16_t)(extreme ? RF_WEIGHT_MAX : noise_between(seed, 1, RF_WEIGHT_MAX));
}

/* Blurs: about as many inside slabs as outside, and the edges on both sides. */
static void make_blurs(struct stage *s, int16_t *blur, bool one, uint32_t *seed)
{
    const int slabs = one || s->job.slabs == 0 ? 1 : s->job.slabs;

    for (int y = -PAD; y < RF_TILE + PAD; y++) {
        for (int x = -PAD; x < RF_TILE + PAD; x++) {
            const struct rf_slab *slab = &s->slab[noise(seed) % (uint32_t)slabs];
            const int outside = one ? 0 : 1 + slab->width / 2;
            const int v = slab->low + noise_between(seed, -outside, slab->width + outside);

            blur[y * STRIDE + x] = (int16_t)(v < -32512 ? -32512 : v > 32512 ? 32512 : v);
        }
    }
}

static void make_stage(struct stage *s, int slabs, bool uniform, enum place place,
                       uint32_t seed)
{
    static const int counts[] = {0, 1, 15, 16, 17, 24, 32, 63, RF_RAY_CHUNK};
    const size_t weights = (SIDE - 1) * WEIGHT_STRIDE + SIDE;
    uint16_t *front, *behind, *weight;
    bool extreme;
    int most;

    s->job = (struct rf_sweep_job){
        .stride = STRIDE,
        .pitch = PITCH,
        .rays = counts[noise(&seed) % 9],
        .slabs = slabs,
        .slab = s->slab,
        .offset = (const int32_t(*)[RF_RAY_CHUNK])s->offset,
        .uniform = uniform,
        .weight_stride = WEIGHT_STRIDE,
        .weight_offset = (const int32_t(*)[RF_RAY_CHUNK])s->weight_offset,
    };
    make_slabs(s, uniform, &seed);
    make_offsets(s, &seed);
    extreme = noise(&seed) % 4 == 0;
    s->job.bright = noise(&seed) % 4 == 0;
    most = s->job.bright ? 4 * 4095 : 4095;
    behind = make_group(&s->behind, 4, 0, most, extreme, place, &seed);
    make_weights(behind + 3 * PITCH, STRIDE, extreme, &seed);
    s->job.behind = behind;
    s->job.behind_weight = behind + 3 * PITCH;
    weight = guarded_place(&s->weight, weights * 2, 2, place, noise(&seed) % 17);
    weight += PAD * (WEIGHT_STRIDE + 1);
    make_weights(weight, WEIGHT_STRIDE, extreme, &seed);
    s->job.weight = weight;
    front = make_group(&s->front, 4, 1, most, extreme, place, &seed);
    make_blurs(s, (int16_t *)front, uniform, &seed);
    s->job.blur = (const int16_t *)front;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            s->sum[c][i] = s->expected[c][i] = noise(&seed);
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < LANES; i++)
            s->weighted[c][i] = s->expected_weighted[c][i] = noise(&seed);
}

/* The first difference, said; `which` is the kernel. */
static bool same(const struct subject *subject, const struct stage *s, const char *which,
                 uint32_t seed, int c, int i, uint64_t is, uint64_t should)
{
    if (is == should)
        return true;
    printf("FAIL  %-12s %-6s seed %u, %d slabs, %d rays%s: channel %d of (%d, %d) is "
           "%llu, should be %llu\n", which, subject->cpu, (unsigned)seed, s->job.slabs,
           s->job.rays, s->job.uniform ? ", uniform" : "", c, i % RF_TILE, i / RF_TILE,
           (unsigned long long)is, (unsigned long long)should);
    return false;
}

static bool check_case(const struct subject *subject, struct stage *s, int slabs, bool uniform,
                       enum place place, uint32_t seed)
{
    make_stage(s, slabs, uniform, place, seed);
    for (int i = 0; i < LANES; i++)
        for (int n = 0; n < s->job.rays; n++)
            follow(s, i, n);
    subject->kernels.sweep(s->sum, &s->job);
    subject->kernels.sweep_weighted(s->weighted, &s->job);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            if (!same(subject, s, "sweep", seed, c, i, s->sum[c][i], s->expected[c][i]))
                return false;
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < LANES; i++)
            if (!same(subject, s, "sweep_weighted", seed, c, i, s->weighted[c][i],
                      s->expected_weighted[c][i]))
                return false;
    return true;
}

static bool create(struct stage *s)
{
    return guarded_create(&s->front, SIDE * STRIDE * 2) &&
           guarded_create(&s->behind, SIDE * STRIDE * 2) &&
           guarded_create(&s->weight, SIDE * WEIGHT_STRIDE * 2);
}

static void destroy(struct stage *s)
{
    guarded_destroy(&s->front);
    guarded_destroy(&s->behind);
    guarded_destroy(&s->weight);
}

int check_sweep(const struct subject *subject)
{
    static struct stage s;
    uint32_t seed = 1;

    if (!create(&s)) {
        printf("FAIL  no memory between pages\n");
        return 1;
    }
    for (; seed <= 400; seed++) {
        const int slabs = (int)seed % 9 == 8 ? MOST_SLABS : (int)seed % 9;
        const bool uniform = slabs == 1 && seed % 2;

        if (!check_case(subject, &s, slabs, uniform, (enum place)(seed % PLACES), seed)) {
            destroy(&s);
            return 1;
        }
    }
    destroy(&s);
    printf("ok    %-12s %-6s %d cases, plain and weighted\n", "sweep", subject->cpu,
           (int)seed - 1);
    return 0;
}

struct bench {
    struct stage *stage;
    const struct rf_kernels *kernels;
    bool weighted;
};

static void call(void *context)
{
    const struct bench *b = context;

    for (int i = 0; i < 50; i++) {
        if (b->weighted)
            b->kernels->sweep_weighted(b->stage->weighted, &b->stage->job);
        else
            b->kernels->sweep(b->stage->sum, &b->stage->job);
    }
}

/* slabs 0: one that holds everything. */
static void bench_case(const struct subject *subject, struct stage *s, int slabs, bool weighted)
{
    const double samples = 50.0 * RF_RAY_CHUNK * LANES;
    struct bench b = {s, &subject->plain, weighted};
    double plain, own;
    char name[24];

    make_stage(s, slabs ? slabs : 1, slabs == 0, INSIDE, 5);
    s->job.rays = RF_RAY_CHUNK;
    s->job.bright = false;
    snprintf(name, sizeof name, slabs ? "%s, %d" : "%s, all", weighted ? "weighted" : "sweep",
             slabs);
    plain = best_time(call, &b);
    b.kernels = &subject->kernels;
    own = best_time(call, &b);
    printf("ok    %-12s %-6s c %.3f  %s %.3f ns/ray sample\n", name, subject->cpu,
           plain * 1e9 / samples, subject->cpu, own * 1e9 / samples);
}

void bench_sweep(const struct subject *subject)
{
    static struct stage s;

    if (!create(&s))
        return;
    for (int slabs = 0; slabs <= 4; slabs++)
        for (int weighted = 0; weighted < 2; weighted++)
            bench_case(subject, &s, slabs, weighted);
    destroy(&s);
}
