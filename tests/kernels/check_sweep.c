/* The sweep over one strip, against a reference that follows one ray of one pixel at a time. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "guarded.h"

enum {
    PAD = 9,
    SIDE = RF_TILE + 2 * PAD, /* strips are as wide as that and not as high */
    PITCH = SIDE + 5, /* between the rows of a group's planes */
    STRIDE = 4 * PITCH,
    MOST_SLABS = 12,
    LANES = RF_STRIP_LANES,
};

struct stage {
    struct guarded front, behind; /* groups of planes: blur and light, light */
    struct rf_slab slab[MOST_SLABS];
    struct rf_sorted_rays rays;
    struct rf_sweep_job job;
    uint32_t sum[3][LANES], expected[3][LANES];
};

static void follow(struct stage *s, int pixel, int ray)
{
    const struct rf_sweep_job *job = &s->job;
    const ptrdiff_t p = pixel / RF_TILE * STRIDE + pixel % RF_TILE;

    for (int t = 0; t < s->rays.tests[ray]; t++) {
        const struct rf_slab *slab = &s->slab[s->rays.slab[t][ray]];
        const ptrdiff_t q = p + s->rays.offset[t][ray];
        const int above = job->blur[q] - slab->low;

        if (above >= 0 && above <= slab->width) {
            for (int c = 0; c < 3; c++)
                s->expected[c][pixel] += (uint16_t)job->blur[q + (1 + c) * PITCH];
            return;
        }
    }
    for (int c = 0; c < 3; c++)
        s->expected[c][pixel] += s->rays.last[ray][p + c * PITCH];
}

/* Offsets as far as the planes reach, at first to their corners. */
static int32_t make_offset(int n, uint32_t *seed)
{
    int dx = noise_between(seed, -PAD, PAD), dy = noise_between(seed, -PAD, PAD);

    if (n < 4) {
        dx = n % 2 ? PAD : -PAD;
        dy = n / 2 ? PAD : -PAD;
    }
    return dy * STRIDE + dx;
}

/* Rays of as many tests as there are slabs, or of fewer too; a last of either layer. */
static void make_rays(struct stage *s, const uint16_t *front, const uint16_t *behind, int tests,
                      bool same, uint32_t *seed)
{
    static const int counts[] = {0, 1, 15, 16, 17, 24, 32, 63, RF_RAY_CHUNK};

    s->rays.rays = counts[noise(seed) % 9];
    for (int n = 0; n < s->rays.rays; n++) {
        s->rays.tests[n] = (uint8_t)(same ? tests : noise_between(seed, 0, tests));
        for (int t = 0; t < s->rays.tests[n]; t++) {
            s->rays.slab[t][n] = (uint8_t)noise_between(seed, 0, MOST_SLABS - 1);
            s->rays.offset[t][n] = make_offset(n, seed);
        }
        s->rays.last[n] = (noise(seed) % 2 ? front + PITCH : behind) + make_offset(n, seed);
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

static void make_stage(struct stage *s, int tests, bool same, enum place place, uint32_t seed)
{
    uint16_t *front, *behind;
    bool extreme;
    int most;

    s->job = (struct rf_sweep_job){
        .stride = STRIDE,
        .pitch = PITCH,
        .slabs = MOST_SLABS,
        .slab = s->slab,
        .rays = &s->rays,
    };
    make_slabs(s, &seed);
    extreme = noise(&seed) % 4 == 0;
    s->job.bright = noise(&seed) % 4 == 0;
    most = s->job.bright ? 4 * 4095 : 4095;
    behind = make_group(&s->behind, 3, 0, most, extreme, place, &seed);
    front = make_group(&s->front, 4, 1, most, extreme, place, &seed);
    make_blurs(s, (int16_t *)front, &seed);
    make_rays(s, front, behind, tests, same, &seed);
    s->job.blur = (const int16_t *)front;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            s->sum[c][i] = s->expected[c][i] = noise(&seed);
}

static bool check_case(const struct subject *subject, struct stage *s, int tests, bool same,
                       enum place place, uint32_t seed)
{
    uint32_t *const sum[3] = {s->sum[0], s->sum[1], s->sum[2]};

    make_stage(s, tests, same, place, seed);
    for (int i = 0; i < LANES; i++)
        for (int n = 0; n < s->rays.rays; n++)
            follow(s, i, n);
    subject->kernels.sweep(sum, &s->job);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < LANES; i++) {
            if (s->sum[c][i] == s->expected[c][i])
                continue;
            printf("FAIL  %-12s %-6s seed %u, %d tests, %d rays: channel %d of (%d, %d) is "
                   "%u, should be %u\n", "sweep", subject->cpu, (unsigned)seed, tests,
                   s->rays.rays, c, i % RF_TILE, i / RF_TILE, (unsigned)s->sum[c][i],
                   (unsigned)s->expected[c][i]);
            return false;
        }
    }
    return true;
}

static bool create(struct stage *s)
{
    return guarded_create(&s->front, SIDE * STRIDE * 2) &&
           guarded_create(&s->behind, SIDE * STRIDE * 2);
}

static void destroy(struct stage *s)
{
    guarded_destroy(&s->front);
    guarded_destroy(&s->behind);
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
    printf("ok    %-12s %-6s %d cases\n", "sweep", subject->cpu, (int)seed - 1);
    return 0;
}

struct bench {
    struct stage *stage;
    rf_sweep_fn *sweep;
};

static void call(void *context)
{
    const struct bench *b = context;
    uint32_t *const sum[3] = {b->stage->sum[0], b->stage->sum[1], b->stage->sum[2]};

    for (int i = 0; i < 50; i++)
        b->sweep(sum, &b->stage->job);
}

/* The seed's rays are repeated until a chunk is full. */
static void fill_chunk(struct rf_sorted_rays *rays)
{
    for (int n = rays->rays; n < RF_RAY_CHUNK; n++) {
        const int like = n % rays->rays;

        rays->tests[n] = rays->tests[like];
        rays->last[n] = rays->last[like];
        for (int t = 0; t < rays->tests[n]; t++) {
            rays->slab[t][n] = rays->slab[t][like];
            rays->offset[t][n] = rays->offset[t][like];
        }
    }
    rays->rays = RF_RAY_CHUNK;
}

void bench_sweep(const struct subject *subject)
{
    static struct stage s;

    if (!create(&s))
        return;
    for (int tests = 0; tests <= 5; tests++) {
        struct bench b = {&s, subject->plain.sweep};
        char name[24];
        double plain, own;

        for (uint32_t seed = 5; seed == 5 || s.rays.rays < 15 || s.job.bright; seed++)
            make_stage(&s, tests, true, INSIDE, seed);
        fill_chunk(&s.rays);
        snprintf(name, sizeof name, "sweep, %d", tests);
        plain = best_time(call, &b);
        b.sweep = subject->kernels.sweep;
        own = best_time(call, &b);
        printf("ok    %-12s %-6s c %.3f  %s %.3f ns/ray sample\n", name, subject->cpu,
               plain * 1e9 / (50.0 * RF_RAY_CHUNK * LANES), subject->cpu,
               own * 1e9 / (50.0 * RF_RAY_CHUNK * LANES));
    }
    destroy(&s);
}
