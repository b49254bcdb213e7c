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
    MOST_SLABS = 12,
    LANES = RF_TILE * RF_TILE,
};

struct stage {
    struct guarded front, behind; /* groups of planes: blur and light, light */
    struct rf_slab slab[MOST_SLABS];
    int32_t offset[MOST_SLABS + 1][RF_RAY_CHUNK];
    struct rf_sweep_job job;
    uint32_t sum[3][LANES], expected[3][LANES];
};

static void follow(struct stage *s, int pixel, int ray)
{
    const struct rf_sweep_job *job = &s->job;
    const ptrdiff_t p = pixel / RF_TILE * STRIDE + pixel % RF_TILE;

    for (int k = 0; k < job->slabs; k++) {
        const ptrdiff_t q = p + job->offset[k][ray];
        const int above = job->blur[q] - job->slab[k].low;

        if (above >= 0 && above <= job->slab[k].width) {
            for (int c = 0; c < 3; c++)
                s->expected[c][pixel] += (uint16_t)job->blur[q + (1 + c) * PITCH];
            return;
        }
    }
    for (int c = 0; c < 3; c++)
        s->expected[c][pixel] += job->behind[p + job->offset[job->slabs][ray] + c * PITCH];
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
    uint16_t *front;
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
    };
    make_slabs(s, uniform, &seed);
    make_offsets(s, &seed);
    extreme = noise(&seed) % 4 == 0;
    s->job.bright = noise(&seed) % 4 == 0;
    most = s->job.bright ? 4 * 4095 : 4095;
    s->job.behind = make_group(&s->behind, 3, 0, most, extreme, place, &seed);
    front = make_group(&s->front, 4, 1, most, extreme, place, &seed);
    make_blurs(s, (int16_t *)front, uniform, &seed);
    s->job.blur = (const int16_t *)front;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            s->sum[c][i] = s->expected[c][i] = noise(&seed);
}

static bool check_case(const struct subject *subject, struct stage *s, int slabs, bool uniform,
                       enum place place, uint32_t seed)
{
    make_stage(s, slabs, uniform, place, seed);
    for (int i = 0; i < LANES; i++)
        for (int n = 0; n < s->job.rays; n++)
            follow(s, i, n);
    subject->kernels.sweep(s->sum, &s->job);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < LANES; i++) {
            if (s->sum[c][i] == s->expected[c][i])
                continue;
            printf("FAIL  %-12s %-6s seed %u, %d slabs, %d rays%s: channel %d of (%d, %d) is "
                   "%u, should be %u\n", "sweep", subject->cpu, (unsigned)seed, slabs,
                   s->job.rays, uniform ? ", uniform" : "", c, i % RF_TILE, i / RF_TILE,
                   (unsigned)s->sum[c][i], (unsigned)s->expected[c][i]);
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
        const int slabs = (int)seed % 9 == 8 ? MOST_SLABS : (int)seed % 9;
        const bool uniform = slabs == 1 && seed % 2;

        if (!check_case(subject, &s, slabs, uniform, (enum place)(seed % PLACES), seed)) {
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

    for (int i = 0; i < 50; i++)
        b->sweep(b->stage->sum, &b->stage->job);
}

void bench_sweep(const struct subject *subject)
{
    static struct stage s;

    if (!create(&s))
        return;
    for (int slabs = 0; slabs <= 4; slabs++) {
        struct bench b = {&s, subject->plain.sweep};
        char name[24];
        double plain, own;

        make_stage(&s, slabs ? slabs : 1, slabs == 0, INSIDE, 5);
        s.job.rays = RF_RAY_CHUNK;
        snprintf(name, sizeof name, slabs ? "sweep, %d" : "sweep, all", slabs);
        plain = best_time(call, &b);
        b.sweep = subject->kernels.sweep;
        own = best_time(call, &b);
        printf("ok    %-12s %-6s c %.3f  %s %.3f ns/ray sample\n", name, subject->cpu,
               plain * 1e9 / (50.0 * RF_RAY_CHUNK * LANES), subject->cpu,
               own * 1e9 / (50.0 * RF_RAY_CHUNK * LANES));
    }
    destroy(&s);
}
