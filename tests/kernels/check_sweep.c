/* check_sweep.c: the sweep over one strip, against a reference that follows one ray of one pixel
 * at a time. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "guarded.h"

enum {
    PAD = 9,
    SIDE = RF_TILE + 2 * PAD, /* strips are as wide as that and not as high */
    PITCH = SIDE + 5,         /* between the rows of a group's planes */
    STRIDE = 4 * PITCH,
    WEIGHT_STRIDE = SIDE + 3,
    MOST_SLABS = 12,
    LANES = RF_STRIP_LANES,
};

struct stage {
    struct guarded front, background; /* groups of planes: blur and light, light and weight */
    struct guarded weight;            /* weight of the front */
    struct rf_slab slab[MOST_SLABS];
    struct rf_sorted_rays rays;
    uint8_t tested[MOST_SLABS][RF_RAY_CHUNK]; /* slab of a test */
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

    for (int t = 0; t < s->rays.tests[ray]; t++) {
        const struct rf_slab *slab = &s->slab[s->tested[t][ray]];
        const ptrdiff_t q = p + s->rays.offset[t][ray];
        const int above = job->blur[q] - slab->low;

        if (above >= 0 && above <= slab->width) {
            count(s, pixel, (const uint16_t *)job->blur + q + PITCH,
                  job->weight[w + s->rays.weight_offset[t][ray]]);
            return;
        }
    }
    count(s, pixel, s->rays.last[ray] + p,
          s->rays.last_weight[ray][s->rays.last_is_background[ray] ? p : w]);
}

/* An offset as far as the planes reach, at first to their corners; *weight is that of weights. */
static int32_t make_offset(int n, int32_t *weight, uint32_t *seed)
{
    int dx = noise_between(seed, -PAD, PAD), dy = noise_between(seed, -PAD, PAD);

    if (n < 4) {
        dx = n % 2 ? PAD : -PAD;
        dy = n / 2 ? PAD : -PAD;
    }
    *weight = dy * WEIGHT_STRIDE + dx;
    return dy * STRIDE + dx;
}

/* Rays of as many tests as there are slabs, or of fewer too; a last of either layer. */
static void make_rays(struct stage *s, const uint16_t *front, const uint16_t *background, int tests,
                      bool same, uint32_t *seed)
{
    static const int counts[] = {0, 1, 15, 16, 17, 24, 32, 63, RF_RAY_CHUNK};
    struct rf_sorted_rays *rays = &s->rays;

    rays->rays = counts[noise(seed) % 9];
    for (int n = 0; n < rays->rays; n++) {
        int32_t offset, weight_offset;

        rays->tests[n] = (uint8_t)(same ? tests : noise_between(seed, 0, tests));
        for (int t = 0; t < rays->tests[n]; t++) {
            const int k = noise_between(seed, 0, MOST_SLABS - 1);

            s->tested[t][n] = (uint8_t)k;
            rays->from[t][n] = rf_range_from(&s->slab[k]);
            rays->to[t][n] = rf_range_to(&s->slab[k], &s->slab[k]);
            rays->offset[t][n] = make_offset(n, &rays->weight_offset[t][n], seed);
        }
        offset = make_offset(n, &weight_offset, seed);
        rays->last_is_background[n] = noise(seed) % 2;
        rays->last[n] = (rays->last_is_background[n] ? background : front + PITCH) + offset;
        rays->last_weight[n] = rays->last_is_background[n] ? background + 3 * PITCH + offset
                                                           : s->job.weight + weight_offset;
    }
}

static void make_slabs(struct stage *s, uint32_t *seed)
{
    for (int k = 0; k < MOST_SLABS; k++) {
        s->slab[k].low = (int16_t)noise_between(seed, -127 * 256 - 32, 127 * 256 - 400);
        s->slab[k].width = (uint16_t)noise_between(seed, 0, 320);
        s->slab[k].centre = 0;
    }
    if (noise(seed) % 4 == 0)
        s->slab[0].low = -127 * 256 - 32;
}

/* Light of planes from `first` on of a group of `planes`; no light between their rows. Ends
 * with the last pixel of the last plane. Returns the tile's first pixel. */
static uint16_t *make_group(struct guarded *guarded, int planes, int first, int most, bool extreme,
                            enum place place, uint32_t *seed)
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

/* Blurs: about as many inside slabs as outside, and the edges on both sides. */
static void make_blurs(struct stage *s, int16_t *blur, uint32_t *seed)
{
    for (int y = -PAD; y < RF_TILE + PAD; y++) {
        for (int x = -PAD; x < RF_TILE + PAD; x++) {
            const struct rf_slab *slab = &s->slab[noise(seed) % MOST_SLABS];
            const int outside = 1 + slab->width / 2;
            const int v = slab->low + noise_between(seed, -outside, slab->width + outside);

            blur[y * STRIDE + x] = (int16_t)(v < -32512 ? -32512 : v > 32512 ? 32512 : v);
        }
    }
}

static void make_weights(uint16_t *weight, ptrdiff_t stride, int most, bool extreme, uint32_t *seed)
{
    for (int y = -PAD; y < RF_TILE + PAD; y++)
        for (int x = -PAD; x < RF_TILE + PAD; x++)
            weight[y * stride + x] = (uint16_t)(extreme ? most : noise_between(seed, 1, most));
}

static void make_stage(struct stage *s, int tests, bool same, enum place place, uint32_t seed)
{
    const size_t weights = (SIDE - 1) * WEIGHT_STRIDE + SIDE;
    uint16_t *front, *background, *weight;
    bool extreme;
    int most, heaviest = RF_WEIGHT_MAX;

    s->job = (struct rf_sweep_job){
        .stride = STRIDE,
        .pitch = PITCH,
        .rays = &s->rays,
        .weight_stride = WEIGHT_STRIDE,
        .lanes = (int)(2 + 2 * (seed % 4)) * RF_TILE,
    };
    make_slabs(s, &seed);
    extreme = noise(&seed) % 4 == 0;
    s->job.bright = noise(&seed) % 2 ? RF_WHITE : (enum rf_bright)(noise(&seed) % 4);
    most = 4095 * (s->job.bright == RF_WHITE ? 1 : 2 << s->job.bright);
    s->job.steps = 65535 / most;
    background = make_group(&s->background, 4, 0, most, extreme, place, &seed);
    make_weights(background + 3 * PITCH, STRIDE, heaviest, extreme, &seed);
    weight = guarded_place(&s->weight, weights * 2, 2, place, noise(&seed) % 17);
    weight += PAD * (WEIGHT_STRIDE + 1);
    make_weights(weight, WEIGHT_STRIDE, heaviest, extreme, &seed);
    s->job.weight = weight;
    front = make_group(&s->front, 4, 1, most, extreme, place, &seed);
    make_blurs(s, (int16_t *)front, &seed);
    make_rays(s, front, background, tests, same, &seed);
    s->job.blur = (const int16_t *)front;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            s->sum[c][i] = s->expected[c][i] = noise(&seed);
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < LANES; i++)
            s->weighted[c][i] = s->expected_weighted[c][i] = noise(&seed);
}

/* The first difference, said; `which` is the kernel. */
static bool is_same(const struct subject *subject, const struct stage *s, const char *which,
                    uint32_t seed, int c, int i, uint64_t is, uint64_t should)
{
    if (is == should)
        return true;
    printf("FAIL  %-12s %-6s seed %u, %d rays: channel %d of (%d, %d) is "
           "%llu, should be %llu\n",
           which, subject->cpu, (unsigned)seed, s->rays.rays, c, i % RF_TILE, i / RF_TILE,
           (unsigned long long)is, (unsigned long long)should);
    return false;
}

static void run(const struct rf_kernels *kernels, struct stage *s, bool weighted)
{
    uint64_t *const wide[4] = {s->weighted[0], s->weighted[1], s->weighted[2], s->weighted[3]};
    uint32_t *const sum[3] = {s->sum[0], s->sum[1], s->sum[2]};

    if (weighted)
        kernels->sweep_weighted(wide, &s->job);
    else
        kernels->sweep(sum, &s->job);
}

static bool check_case(const struct subject *subject, struct stage *s, int tests, bool same,
                       enum place place, uint32_t seed)
{
    make_stage(s, tests, same, place, seed);
    for (int i = 0; i < s->job.lanes; i++)
        for (int n = 0; n < s->rays.rays; n++)
            follow(s, i, n);
    run(&subject->kernels, s, false);
    if (s->job.bright != RF_BRIGHTEST) /* the contract bounds the light that is weighed */
        run(&subject->kernels, s, true);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            if (!is_same(subject, s, "sweep", seed, c, i, s->sum[c][i], s->expected[c][i]))
                return false;
    for (int c = 0; c < 4 && s->job.bright != RF_BRIGHTEST; c++)
        for (int i = 0; i < LANES; i++)
            if (!is_same(subject, s, "sweep_weighted", seed, c, i, s->weighted[c][i],
                         s->expected_weighted[c][i]))
                return false;
    return true;
}

static bool create(struct stage *s)
{
    return guarded_create(&s->front, SIDE * STRIDE * 2) &&
           guarded_create(&s->background, SIDE * STRIDE * 2) &&
           guarded_create(&s->weight, SIDE * WEIGHT_STRIDE * 2);
}

static void destroy(struct stage *s)
{
    guarded_destroy(&s->front);
    guarded_destroy(&s->background);
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
        const int tests = (int)seed % 9 == 8 ? MOST_SLABS : (int)seed % 9;

        if (!check_case(subject, &s, tests, seed % 2, (enum place)(seed % PLACES), seed)) {
            destroy(&s);
            return 1;
        }
    }
    destroy(&s);
    printf("ok    %-12s %-6s %d cases, plain and weighted\n", "sweep", subject->cpu, (int)seed - 1);
    return 0;
}
