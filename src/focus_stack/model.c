/* model.c: costs of depths between frames, by how their sharpness compares, for stacks of nine
 * frames and fewer.
 *
 * A surface at a distance of x steps from the focus of a frame has a mean square of sharpness there
 * of
 *
 *     1 / (1 + rho x^2)
 *
 * times that in focus: blur grows in proportion to x, and rho is its square a step on, against the
 * finest detail of the texture. A depth costs the share of the sharpness that is in other frames
 * than this says. Of 2, the exponent of texture whose spectrum falls as 1 / f^2, of 1.5, that of
 * edges, and of 1, the last was best on path-traced scenes: windows hold surfaces of several
 * depths.
 *
 * Three frames and more tell rho from depth: of six, each a third of the last, the one that fits
 * best counts. The ratio of neighbours is at most 1 + rho, so the first is that of the greatest
 * ratios in the photo. Two frames do not tell: rho is then the same everywhere, and where nothing
 * is in focus in either, depth is stretched to the ends.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>

enum {
    BINS = 128, /* for ratios, four to an octave */
    LEAST_RATIO = 4,
    ONE = 1 << 12, /* a share of all */
    MOST = 85,     /* cost of a square, so that three fit a byte */
};

int rf_stack_sub(int frames)
{
    static const int sub[RF_STACK_FEW + 1] = {1, 1, 12, 6, 5, 3, 3, 2, 2, 2};

    return frames <= RF_STACK_FEW ? sub[frames] : 1;
}

static int bin_of(uint64_t more, uint64_t less)
{
    const uint64_t ratio = 4 * more / less;
    int octave = 0;

    while (ratio >> octave >= 8)
        octave++;
    return 4 * octave + (int)(ratio >> octave & 3);
}

/* The ratio of the sharpness of neighbours that one in so many samples with texture exceeds. */
static double ratio_of(const struct refocus_stack *s, uint32_t one_in)
{
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    uint32_t count[BINS] = {0}, all = 0, beyond = 0;
    int bin = BINS;

    for (size_t i = 0; i < samples; i += RF_STACK_STRIDE)
        for (int k = 0; k + 1 < s->count; k++) {
            const uint64_t a = rf_stack_squared(s->frame[k].sharpness[i]);
            const uint64_t b = rf_stack_squared(s->frame[k + 1].sharpness[i]);

            if (a < 4 * RF_STACK_NOISE && b < 4 * RF_STACK_NOISE)
                continue;
            count[bin_of((a > b ? a : b) + RF_STACK_NOISE / 4,
                         (a > b ? b : a) + RF_STACK_NOISE / 4)]++;
            all++;
        }
    while (bin > 0 && beyond * one_in <= all)
        beyond += count[--bin];

    const double ratio = ldexp(1 + (bin & 3) / 4.0, bin / 4);

    return ratio > LEAST_RATIO ? ratio : LEAST_RATIO;
}

/* The shares of a depth that lies at a position, by a model. */
static void share_out(struct refocus_stack *s, int m, int d, double at, double rho)
{
    const double first = s->frame[0].position;
    const double step = (s->frame[s->count - 1].position - first) / (s->count - 1);
    double sharp[RF_STACK_FEW], sum = 0;

    for (int k = 0; k < s->count; k++) {
        const double x = (at - s->frame[k].position) / step;

        sharp[k] = 1 / (1 + rho * x * x);
        sum += sharp[k];
    }
    s->shares[m][d] = 0;
    for (int k = 0; k < s->count; k++) {
        s->share[m][k][d] = (int16_t)(sharp[k] / sum * ONE + 0.5);
        s->shares[m][d] = (int16_t)(s->shares[m][d] + s->share[m][k][d]);
    }
}

void rf_stack_model(struct refocus_stack *s)
{
    double rho = ratio_of(s, s->count > 2 ? 50 : 20) - 1;

    s->models = s->count > 2 ? RF_STACK_MODELS : 1;
    for (int m = 0; m < s->models; m++) {
        for (int d = 0; d < s->depths; d++) {
            const int k = rf_stack_clamp(d / s->sub, s->count - 2);
            const double below = s->frame[k].position, above = s->frame[k + 1].position;

            share_out(s, m, d, below + (above - below) * (d - k * s->sub) / s->sub, rho);
        }
        rho /= 3;
    }
}

/* Differences of shares add up to twice the larger of each two, less all of them. n, at least the
 * number of depths, is known to the compiler. */
static inline void add_costs(const struct refocus_stack *s, uint8_t *restrict cost,
                             const uint32_t *mean, int n)
{
    int16_t least[RF_STACK_FEW_DEPTHS], share[RF_STACK_FEW], all = 0;
    uint64_t sum = 0;

    for (int k = 0; k < s->count; k++)
        sum += mean[k];
    /* Means are below 2^24, and none is above the sum. */
    const uint64_t one = ((uint64_t)ONE << 28) / (sum + 1);

    for (int k = 0; k < s->count; k++) {
        share[k] = (int16_t)(mean[k] * one >> 28);
        all = (int16_t)(all + share[k]);
    }
    for (int d = 0; d < n; d++)
        least[d] = 2 * ONE;
    for (int m = 0; m < s->models; m++) {
        int16_t larger[RF_STACK_FEW_DEPTHS] = {0};

        for (int k = 0; k < s->count; k++) {
            const int16_t *restrict model = s->share[m][k], here = share[k];

            for (int d = 0; d < n; d++)
                larger[d] = (int16_t)(larger[d] + (here > model[d] ? here : model[d]));
        }
        for (int d = 0; d < n; d++) {
            const int16_t wrong = (int16_t)(2 * larger[d] - all - s->shares[m][d]);

            least[d] = wrong < least[d] ? wrong : least[d];
        }
    }

    const int scale = (int)(MOST * sum / (sum + RF_STACK_NOISE));

    for (int d = s->depths; d < n; d++) /* costs that fill vectors up stay */
        least[d] = 0;
    for (int d = 0; d < n; d++)
        cost[d] = (uint8_t)(cost[d] + (scale * least[d] >> 13));
}

void rf_stack_model_costs(const struct refocus_stack *s, uint8_t *cost, const uint32_t *mean)
{
    if (s->depths <= 16)
        add_costs(s, cost, mean, 16);
    else
        add_costs(s, cost, mean, RF_STACK_FEW_DEPTHS);
}
