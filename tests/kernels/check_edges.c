/* check_edges.c: checks the kernels that put the edges of disparity maps in their place, against
 * their contracts' words, one pixel at a time. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guarded.h"

enum {
    MOST_ROW = 200,                                    /* pixels of a row of steepest */
    MOST_STEP = 3,                                     /* from one row of a window to the next */
    MOST_GAP = 5,                                      /* elements between its rows */
    ROUNDS = 2 * (RF_MOST_VOTE_ROWS + 1) * 5 * PLACES, /* every case of each with each */
    MOST_STRIDE = RF_MOST_VOTE_COLUMNS + MOST_GAP,
    WINDOW = RF_MOST_VOTE_ROWS * MOST_STEP * MOST_STRIDE,
};

/* A few of everything that is passed between guarded pages. */
struct stage {
    struct guarded row[3], out, colour[3], disparity, nearness, weight;
};

/* ----- noise ----- */

/* How unlike the elements of a row are. */
enum mix { ALL_GREATEST, ALL_LEAST, EXTREMES, FEW, ANY, MIXES };

/* Extremes come first, and then each in turn. */
static enum mix mix_of(uint32_t seed)
{
    return (enum mix)(seed % MIXES);
}

/* Changes when every mix was with every shape of window. */
static enum place place_in(uint32_t seed)
{
    return (enum place)(seed / (ROUNDS / PLACES) % PLACES);
}

static uint32_t element(uint32_t *seed, enum mix mix, uint32_t least, uint32_t most)
{
    const uint32_t any = noise(seed);

    switch (mix) {
    case ALL_GREATEST:
        return most;
    case ALL_LEAST:
        return least;
    case EXTREMES:
        return any & 1 ? most : least;
    case FEW: /* equal neighbours, and values on both sides of limits */
        return least + (most - least) / 3 * (any % 4);
    default:
        return least + any % (most - least + 1);
    }
}

static uint16_t *words(struct guarded *guarded, int n, enum place place, enum mix mix,
                       uint32_t *seed)
{
    uint16_t *row = guarded_place(guarded, (size_t)n * 2, 2, place, noise(seed) % 17);

    for (int i = 0; i < n; i++)
        row[i] = (uint16_t)element(seed, mix, 0, 65535);
    return row;
}

static uint8_t *bytes(struct guarded *guarded, int n, enum place place, enum mix mix,
                      uint32_t *seed)
{
    uint8_t *row = guarded_place(guarded, (size_t)n, 1, place, noise(seed) % 17);

    for (int i = 0; i < n; i++)
        row[i] = (uint8_t)element(seed, mix, 0, 255);
    return row;
}

/* Every length from 0 to 40, and some around those of more vectors. */
static int length_of(uint32_t seed)
{
    static const int larger[] = {41, 48, 63, 64, 65, 100, 127, MOST_ROW};
    const int choice = (int)(seed % (41 + sizeof larger / sizeof *larger));

    return choice <= 40 ? choice : larger[choice - 41];
}

static bool fail(const struct subject *subject, const char *what, uint32_t seed, int n, int at,
                 uint64_t is, uint64_t should)
{
    printf("FAIL  %-12s %-6s seed %u, n = %d: element %d is %llu, should be %llu\n", what,
           subject->cpu, (unsigned)seed, n, at, (unsigned long long)is, (unsigned long long)should);
    return false;
}

/* ----- steepest ----- */

/* Right, left, below, above, and the four at the corners. */
static const int direction[RF_NO_DIRECTION][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                                  {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};

static int direction_of(const uint16_t *const row[3], int x, int sign)
{
    int best = sign * row[1][x], found = RF_NO_DIRECTION;

    for (int k = 0; k < RF_NO_DIRECTION; k++) {
        const int there = sign * row[1 + direction[k][1]][x + direction[k][0]];

        if (there > best) {
            best = there;
            found = k;
        }
    }
    return found;
}

static bool check_steepest(const struct subject *subject, struct stage *s, uint32_t seed)
{
    const uint32_t first = seed;
    const enum place place = place_in(seed);
    const int n = length_of(seed);
    const uint16_t *row[3];
    uint8_t *out = bytes(&s->out, n, place, ANY, &seed);

    for (int k = 0; k < 3; k++)
        row[k] = words(&s->row[k], n + 2, place, mix_of(first), &seed) + 1;
    subject->kernels.steepest(out, row, n);
    for (int x = 0; x < n; x++) {
        const int should = 16 * direction_of(row, x, -1) + direction_of(row, x, 1);

        if (out[x] != should)
            return fail(subject, "steepest", first, n, x, out[x], (uint64_t)should);
    }
    return guarded_intact(&s->out);
}

/* ----- windows ----- */

/* A window of some columns and rows. */
struct shape {
    int columns, rows, step;
    ptrdiff_t stride, nearness_stride;
};

/* Every number of rows with every number of columns. */
static struct shape shape_of(uint32_t first, uint32_t *seed)
{
    struct shape shape = {.columns = first % 2 ? RF_VOTE_COLUMNS : RF_MOST_VOTE_COLUMNS,
                          .rows = (int)(first / 2 % (RF_MOST_VOTE_ROWS + 1)),
                          .step = noise_between(seed, 1, MOST_STEP)};

    shape.stride = shape.columns + noise_between(seed, 0, MOST_GAP);
    shape.nearness_stride = shape.columns + noise_between(seed, 0, MOST_GAP);
    return shape;
}

/* Elements from the first that is looked at to the last one. */
static int size_of(const struct shape *shape)
{
    return shape->rows ? (int)((shape->rows - 1) * shape->step * shape->stride) + shape->columns
                       : 0;
}

static int nearness_size(const struct shape *shape)
{
    return shape->rows ? (int)((shape->rows - 1) * shape->nearness_stride) + shape->columns : 0;
}

/* ----- tally ----- */

/* (1 - (difference / 73)^2)^8 as the kernels compute it, 1 being 255: steps of 16 bits. */
static uint32_t likeness(int difference)
{
    const int least = difference > 73 ? 73 : difference;
    uint32_t share = (uint32_t)(65535 - 49 * least * least / 4);

    for (int i = 0; i < 3; i++)
        share = share * share / 65536;
    return share / 256;
}

/* The likeness in whole steps is within 2/255 of the contract's formula. */
static bool check_likeness(const struct subject *subject)
{
    for (int d = 0; d <= 3 * 255; d++) {
        const double off = d < 73 ? d / 73.0 : 1, real = 255 * pow(1 - off * off, 8);
        const double gauss = 255 * exp(-d * d / (2 * 18.0 * 18.0));

        if (fabs(likeness(d) - real) > 2 || fabs(real - gauss) > 10) {
            printf("FAIL  %-12s %-6s difference %d: likeness %u, should be %.2f, a Gaussian has "
                   "%.2f\n",
                   "tally", subject->cpu, d, (unsigned)likeness(d), real, gauss);
            return false;
        }
    }
    return true;
}

static struct rf_votes expect_votes(const struct rf_vote_window *w)
{
    struct rf_votes votes = {0, 0, 0, 0};

    for (int y = 0; y < w->rows; y++)
        for (int x = 0; x < w->columns; x++) {
            const ptrdiff_t at = y * w->step * w->stride + x;
            const uint16_t d = w->voter[at];
            int difference = 0;
            uint32_t weight, value;

            if (d < w->least || d > w->most)
                continue;
            for (int c = 0; c < 3; c++)
                difference += abs(w->colour[c][at] - w->own[c]);
            weight = w->nearness[y * w->nearness_stride + x] * likeness(difference) / 32;
            value = weight * (uint32_t)((d - w->least) / 32);
            *(d > w->middle ? &votes.near : &votes.far) += weight;
            *(d > w->middle ? &votes.near_value : &votes.far_value) += value;
        }
    return votes;
}

static int limit(enum mix mix, uint32_t *seed)
{
    const int disparity = (int)element(seed, mix, 0, 65535);

    return disparity > 1 ? disparity : 1;
}

/* The limits of a few disparities are some of them: they belong to the range. */
static void choose_limits(struct rf_vote_window *w, enum mix mix, uint32_t *seed)
{
    const int one = limit(mix, seed), other = limit(mix, seed);

    w->least = (uint16_t)(one < other ? one : other);
    w->most = (uint16_t)(one < other ? other : one);
    if (mix < EXTREMES) {
        w->least = 1;
        w->most = 65535;
    }
    w->middle = (uint16_t)(mix == FEW ? limit(mix, seed) : noise_between(seed, w->least, w->most));
}

static bool check_tally(const struct subject *subject, struct stage *s, uint32_t seed)
{
    const uint32_t first = seed;
    const enum place place = place_in(seed);
    const enum mix mix = mix_of(seed);
    const struct shape shape = shape_of(first, &seed);
    const int size = size_of(&shape);
    struct rf_vote_window w = {.stride = shape.stride,
                               .nearness_stride = shape.nearness_stride,
                               .columns = shape.columns,
                               .rows = shape.rows,
                               .step = shape.step};
    uint32_t is[4], should[4];
    struct rf_votes votes, expected;

    for (int c = 0; c < 3; c++) {
        uint8_t *colour = bytes(&s->colour[c], size, place, mix, &seed);

        w.own[c] = (uint8_t)element(&seed, mix, 0, 255);
        /* Colours that differ by much do not tell one likeness from another. */
        for (int i = 0; i < size && mix == ANY; i++)
            colour[i] = (uint8_t)(w.own[c] - w.own[c] / 8 + noise_between(&seed, 0, 31));
        w.colour[c] = colour;
    }
    w.voter = words(&s->disparity, size, place, mix, &seed);
    w.nearness = bytes(&s->nearness, nearness_size(&shape), place, mix, &seed);
    choose_limits(&w, mix, &seed);
    votes = subject->kernels.tally(&w);
    expected = expect_votes(&w);
    memcpy(is, &votes, sizeof is);
    memcpy(should, &expected, sizeof should);
    for (int i = 0; i < 4; i++)
        if (is[i] != should[i])
            return fail(subject, "tally", first, shape.rows, i, is[i], should[i]);
    return true;
}

/* ----- core_sums ----- */

static bool check_core_sums(const struct subject *subject, struct stage *s, uint32_t seed)
{
    const uint32_t first = seed;
    const enum place place = place_in(seed);
    const enum mix mix = mix_of(seed);
    const struct shape shape = shape_of(first, &seed);
    const uint16_t *core = words(&s->disparity, size_of(&shape), place, mix, &seed);
    const uint8_t *nearness = bytes(&s->nearness, nearness_size(&shape), place, mix, &seed);
    struct rf_vote_window limits;
    struct rf_core_sums sums, should = {0, 0, 0};

    choose_limits(&limits, mix, &seed);
    const struct rf_core_window w = {.core = core,
                                     .stride = shape.stride,
                                     .nearness = nearness,
                                     .nearness_stride = shape.nearness_stride,
                                     .columns = shape.columns,
                                     .rows = shape.rows,
                                     .step = shape.step,
                                     .least = limits.least,
                                     .most = limits.most};
    sums = subject->kernels.core_sums(&w);
    for (int y = 0; y < w.rows; y++)
        for (int x = 0; x < w.columns; x++) {
            const uint64_t d = core[y * w.step * w.stride + x];
            const uint8_t near_by = nearness[y * w.nearness_stride + x];

            if (d < w.least || d > w.most || near_by == 0)
                continue;
            should.count++;
            should.weight += near_by;
            should.value += near_by * d;
        }
    if (sums.value != should.value)
        return fail(subject, "core_sums", first, w.rows, 0, sums.value, should.value);
    if (sums.weight != should.weight)
        return fail(subject, "core_sums", first, w.rows, 1, sums.weight, should.weight);
    if (sums.count != should.count)
        return fail(subject, "core_sums", first, w.rows, 2, sums.count, should.count);
    return true;
}

/* ----- surface_sums ----- */

/* Any weights that add up to at most 2^16. */
static void spread_weights(uint16_t *weight, int n, enum mix mix, uint32_t *seed)
{
    uint32_t left = 65536;

    if (mix == ALL_GREATEST && n > 0)
        weight[noise(seed) % (uint32_t)n] = 65535;
    for (int i = 0; i < n && mix != ALL_GREATEST; i++) {
        const uint32_t one = noise(seed) % (left / 16 + 2), some = one < left ? one : left;

        weight[i] = (uint16_t)some;
        left -= some;
    }
}

/* Disparities at the limits of what belongs to the surface, on one side of it. */
static void put_limits(uint16_t *label, int n, uint16_t surface, uint16_t most, uint32_t *seed)
{
    const int side = surface < 32768 ? 1 : -1;

    for (int i = 0; i < n; i++)
        if (noise(seed) % 8 == 0)
            label[i] = (uint16_t)(surface + side * (most - noise_between(seed, 0, 1)));
}

static bool check_surface_sums(const struct subject *subject, struct stage *s, uint32_t seed)
{
    const uint32_t first = seed;
    const enum place place = place_in(seed);
    const enum mix mix = mix_of(seed);
    struct shape shape = shape_of(first, &seed);
    struct rf_surface_sums sums, should = {0, 0, 0};
    struct rf_surface_window w = {.stride = shape.stride,
                                  .weight_stride = shape.nearness_stride,
                                  .columns = shape.columns,
                                  .rows = shape.rows};
    uint16_t *label, *weight;

    shape.step = 1;
    label = words(&s->disparity, size_of(&shape), place, mix, &seed);
    weight = words(&s->weight, nearness_size(&shape), place, ALL_LEAST, &seed);
    spread_weights(weight, nearness_size(&shape), mix, &seed);
    w.surface = (uint16_t)element(&seed, mix, 0, 65535);
    w.most = (uint16_t)noise_between(&seed, 1, mix == FEW ? 3 : 30000);
    put_limits(label, size_of(&shape), w.surface, w.most, &seed);
    w.label = label;
    w.weight = weight;
    sums = subject->kernels.surface_sums(&w);
    for (int y = 0; y < w.rows; y++)
        for (int x = 0; x < w.columns; x++) {
            const uint32_t share = weight[y * w.weight_stride + x];
            const int d = label[y * w.stride + x];

            should.all += share;
            if (abs(d - w.surface) < w.most)
                should.own += share;
            else
                should.other += share * (uint32_t)d;
        }
    if (sums.own != should.own)
        return fail(subject, "surface_sums", first, w.rows, 0, sums.own, should.own);
    if (sums.all != should.all)
        return fail(subject, "surface_sums", first, w.rows, 1, sums.all, should.all);
    if (sums.other != should.other)
        return fail(subject, "surface_sums", first, w.rows, 2, sums.other, should.other);
    return true;
}

int check_edges(const struct subject *subject)
{
    static const char *const names[] = {"steepest", "tally", "core_sums", "surface_sums"};
    bool (*const check[])(const struct subject *, struct stage *, uint32_t) = {
        check_steepest, check_tally, check_core_sums, check_surface_sums};
    struct stage s;
    bool ready = guarded_create(&s.out, MOST_ROW) && guarded_create(&s.disparity, WINDOW * 2) &&
                 guarded_create(&s.nearness, WINDOW) && guarded_create(&s.weight, WINDOW * 2);
    int failures = 0;

    for (int k = 0; k < 3; k++)
        ready = ready && guarded_create(&s.row[k], (MOST_ROW + 2) * 2) &&
                guarded_create(&s.colour[k], WINDOW);
    if (!ready) {
        printf("FAIL  no memory between pages\n");
        return 1;
    }
    for (int k = 0; k < 4; k++) {
        bool good = k != 1 || check_likeness(subject);

        for (uint32_t seed = 0; good && seed < ROUNDS; seed++)
            good = check[k](subject, &s, seed);
        if (good)
            printf("ok    %-12s %-6s %d cases\n", names[k], subject->cpu, ROUNDS);
        failures += !good;
    }
    guarded_destroy(&s.out);
    guarded_destroy(&s.disparity);
    guarded_destroy(&s.nearness);
    guarded_destroy(&s.weight);
    for (int k = 0; k < 3; k++) {
        guarded_destroy(&s.row[k]);
        guarded_destroy(&s.colour[k]);
    }
    return failures;
}
