/* check_series.c: the row of heat flow, bit for bit against the contract's words. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "guarded.h"

enum { MOST = 70, STRIDE = MOST + 10 };

/* Rows of a case: n long each, and `here` three of n + 2. */
struct stage {
    struct guarded row, here, start, across, own;
    struct guarded *all[5];
};

static float real(uint32_t *seed)
{
    static const float scales[] = {1, 4096, 1e-6f, 5e-10f};
    const float value = (float)noise_between(seed, -(1 << 20), 1 << 20) / (1 << 20);

    return value * scales[noise(seed) % 4];
}

static float *fill(struct guarded *guarded, int count, enum place place, uint32_t *seed)
{
    float *row = guarded_place(guarded, (size_t)count * sizeof(float), sizeof(float), place,
                               noise(seed) % 8);

    for (int i = 0; i < count; i++)
        row[i] = real(seed);
    return row;
}

static float expected(const struct rf_series_job *job, float row, int x)
{
    const float up = job->here[x - job->stride], down = job->here[x + job->stride];
    const float sides = job->here[x - 1] + job->here[x + 1];
    const float vertical = up + down;
    const float around = vertical + sides;
    const float gain = job->across[x] * around, kept = job->own[x] * job->here[x];
    const float flow = gain + kept;
    const float left = flow - row, added = job->share * job->start[x];

    return added + left;
}

static bool check_case(const struct subject *subject, struct stage *s, enum place place, int n,
                       uint32_t seed)
{
    float *row = fill(&s->row, n, place, &seed), before[MOST];
    const struct rf_series_job job = {
        .here = fill(&s->here, 2 * STRIDE + n + 2, place, &seed) + STRIDE + 1,
        .start = fill(&s->start, n, place, &seed),
        .across = fill(&s->across, n, place, &seed),
        .own = fill(&s->own, n, place, &seed),
        .stride = STRIDE,
        .share = real(&seed),
    };

    memcpy(before, row, (size_t)n * sizeof *row);
    subject->kernels.series_row(row, &job, n);
    for (int i = 0; i < 5; i++) {
        if (!guarded_intact(s->all[i])) {
            printf("FAIL  %-12s %-6s seed %u: wrote beside row %d\n", "series_row", subject->cpu,
                   (unsigned)seed, i);
            return false;
        }
    }
    for (int x = 0; x < n; x++) {
        const float right = expected(&job, before[x], x);

        if (memcmp(&row[x], &right, sizeof right) != 0) {
            printf("FAIL  %-12s %-6s n = %d: element %d is %.9g, should be %.9g\n", "series_row",
                   subject->cpu, n, x, (double)row[x], (double)right);
            return false;
        }
    }
    return true;
}

int check_series(const struct subject *subject)
{
    static struct stage s;
    uint32_t seed = 1;
    bool good = true;

    s.all[0] = &s.row;
    s.all[1] = &s.here;
    s.all[2] = &s.start;
    s.all[3] = &s.across;
    s.all[4] = &s.own;
    for (int i = 0; i < 5; i++)
        good = good && guarded_create(s.all[i], 4 * STRIDE * sizeof(float));
    if (!good)
        printf("FAIL  no memory between pages\n");
    for (; good && seed <= 600; seed++)
        good = check_case(subject, &s, (enum place)(seed % PLACES), (int)seed % (MOST + 1), seed);
    for (int i = 0; i < 5; i++)
        guarded_destroy(s.all[i]);
    if (good)
        printf("ok    %-12s %-6s %d cases\n", "series_row", subject->cpu, (int)seed - 1);
    return !good;
}
