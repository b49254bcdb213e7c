/* subject.c: the subject of a photo is what stands before its surroundings, near the centre. */
#include <string.h>
#include "inputs/subject.h"

enum {
    SIDE = 64,         /* Samples are taken in so many rows and columns. */
    LEVELS = 256,      /* Disparities are told apart by so many. */
    HALF = 10,         /* A range has so many levels on either side of its middle. */
    LEAST = 2048,      /* 1/32: what does not stand out has this weight. */
    CLEARLY = 3,       /* The subject has so many times the weight of the centre's range. */
    STRIP = SIDE / 16, /* Columns at either side of the picture that surroundings are in. */
    SURROUNDING = 4,   /* They have a quarter of both strips. */
};

/* Samples, each with its weight, and the sums of weights of each level. */
struct samples {
    uint16_t at[SIDE][SIDE];
    int64_t weight[SIDE][SIDE];
    int64_t level[LEVELS];
};

static uint16_t median_of(const uint16_t row[SIDE])
{
    uint16_t sorted[SIDE];

    for (int i = 0; i < SIDE; i++) {
        int k = i;

        for (; k > 0 && sorted[k - 1] > row[i]; k--)
            sorted[k] = sorted[k - 1];
        sorted[k] = row[i];
    }
    return sorted[SIDE / 2];
}

static void take_samples(struct samples *s, const uint16_t *disparity, int width, int height)
{
    memset(s->level, 0, sizeof s->level);
    for (int y = 0; y < SIDE; y++) {
        const int64_t row = (int64_t)(2 * y + 1) * height / (2 * SIDE);
        int median;

        for (int x = 0; x < SIDE; x++)
            s->at[y][x] = disparity[row * width + (int64_t)(2 * x + 1) * width / (2 * SIDE)];
        median = median_of(s->at[y]);
        for (int x = 0; x < SIDE; x++) {
            const int across = 2 * x + 1 - SIDE, down = 2 * y + 1 - SIDE;
            const int inwards = 2 * SIDE * SIDE - across * across - down * down;
            const int out = s->at[y][x] > median ? s->at[y][x] - median : 0;

            s->weight[y][x] = (int64_t)inwards * (out + LEAST);
            s->level[s->at[y][x] >> 8] += s->weight[y][x];
        }
    }
}

static bool is_in(int level, int middle)
{
    return level >= middle - HALF && level <= middle + HALF;
}

static int64_t weight_of_range(const struct samples *s, int middle)
{
    int64_t sum = 0;

    for (int level = 0; level < LEVELS; level++)
        if (is_in(level, middle))
            sum += s->level[level];
    return sum;
}

/* Whether a range has a good part of both strips at the sides of the picture. */
static bool surrounds(const struct samples *s, int middle)
{
    int left = 0, right = 0;

    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < STRIP; x++) {
            left += is_in(s->at[y][x] >> 8, middle);
            right += is_in(s->at[y][SIDE - 1 - x] >> 8, middle);
        }
    return left * SURROUNDING >= SIDE * STRIP && right * SURROUNDING >= SIDE * STRIP;
}

/* The weighted mean of the samples of a range, 0 to 1. */
static double mean_of_range(const struct samples *s, int middle)
{
    double sum = 0;

    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (is_in(s->at[y][x] >> 8, middle))
                sum += (double)s->weight[y][x] * s->at[y][x];
    return sum / (double)weight_of_range(s, middle) / 65535;
}

bool input_find_subject(const uint16_t *disparity, int width, int height, double centre,
                        double *subject)
{
    const int own = (int)(centre * 65535 + 0.5) >> 8;
    struct samples samples;
    int64_t most = 0;
    int best = 0;

    take_samples(&samples, disparity, width, height);
    for (int level = 0; level < LEVELS; level++) {
        const int64_t weight = weight_of_range(&samples, level);

        if (weight > most) {
            most = weight;
            best = level;
        }
    }
    if (best <= own + 2 * HALF || most < CLEARLY * weight_of_range(&samples, own) ||
        surrounds(&samples, best))
        return false;
    *subject = mean_of_range(&samples, best);
    return true;
}
