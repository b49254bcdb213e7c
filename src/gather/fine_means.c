/* fine_means.c: sums of rays are exact, and means of Q14 are not fine enough for slopes of 16 bits.
 * The means of a tile are computed once more, as distances from the least of them, so that the
 * kernels of means have bits to spare in all but the most contrasty tiles.
 *
 * An example: the means of a tile go from 800.3 to 812.9. Distances from 800.3 in 1/256 are up to
 * 3226; a pixel whose distance is 900 after softening is 800.3 + 900 / 256 = 803.8, which is 804 as
 * its mean, and -0.2 is left over.
 */
#include "gather/fine_means.h"

#include "support/compare.h"

#include <string.h>

enum {
    LANES = RF_TILE * RF_TILE,
    MORE = 8,         /* bits */
    MOST_SHIFT = 6,   /* with more of them shifted out little is left over */
    MOST = 2 << MORE, /* the roundings of three kernels leave over no more */
};

void rf_fine_means(struct rf_fine_means *fine, int c, const struct rf_kernels *kernels,
                   const struct rf_mean_steps *steps, const uint32_t *sum, const uint16_t *mean)
{
    const int lanes = steps->rows.count * RF_TILE, step = steps->rows.step;
    uint32_t value[LANES], least = UINT32_MAX, greatest = 0;
    uint16_t computed[LANES], between[LANES];
    const uint16_t *const distance = step > 1 ? between : computed;
    int shift = 0;

    memcpy(fine->mean[c], mean, sizeof fine->mean[c]);
    for (int i = 0; i < lanes; i++) {
        value[i] = (uint32_t)((((uint64_t)sum[i] << (MORE + 2)) + steps->rays / 2) / steps->rays);
        least = value[i] < least ? value[i] : least;
        greatest = value[i] > greatest ? value[i] : greatest;
    }
    while ((greatest - least) >> shift > UINT16_MAX)
        shift++;
    if (shift > MOST_SHIFT) {
        memset(fine->more[c], 0, sizeof fine->more[c]);
        return;
    }
    for (int i = 0; i < lanes; i++)
        computed[i] = (uint16_t)((value[i] - least) >> shift);
    if (steps->softness)
        kernels->soften(computed, steps->rows.count, 1, step == 1, steps->softness);
    if (step > 1)
        kernels->between_rows(between, computed, step);
    for (int i = 0; i < LANES; i++) {
        const int more = (int)(least + ((uint32_t)distance[i] << shift)) - ((int)mean[i] << MORE);

        fine->more[c][i] = (int16_t)rf_larger(rf_smaller(more, MOST), -MOST);
    }
}

void rf_fine_means_forget(struct rf_fine_means *fine, uint16_t mean[3][RF_TILE * RF_TILE])
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            if (mean[c][i] != fine->mean[c][i])
                fine->more[c][i] = 0;
}
