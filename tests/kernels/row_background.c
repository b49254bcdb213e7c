/* row_background.c: a plain reference for each row kernel of the hidden background: its marks, and
 * the pyramid that inpaints it. */
#include "row_background.h"

#include <stdlib.h>
#include <string.h>

#include "image/planes.h"

/* The unit of blurs that goes with a parameter. */
static int unit_for(int parameter)
{
    return parameter % (RF_MAX_UNIT + 1);
}

/* The result is moved to the first row, whichever it is in. Values are `parameter` steps of a cone
 * without a unit apart at the most. */
void run_spread_row(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    const int unit = unit_for(parameter);
    const uint16_t *result = k->spread_row(row[0], row[1], parameter << unit, unit, n);

    if (result != row[0])
        memcpy(row[0], result, (size_t)n * 2);
}

static int fallen(int value, int fall)
{
    return value > fall ? value - fall : 0;
}

void expect_spread_row(void *const *row, int parameter, int n)
{
    uint16_t *const in = row[0], *const out = row[1];
    const int fall = RF_CONE_STEP >> unit_for(parameter);

    for (int x = 0; x < n; x++) {
        int most = 0;

        for (int q = 0; q < n; q++) {
            const int value = fallen(in[q], abs(q - x) * fall);

            most = value > most ? value : most;
        }
        out[x] = (uint16_t)most;
    }
    if (n > 0)
        memcpy(in, out, (size_t)n * 2);
}

void run_dilate_from(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->dilate_from(row[0], row[1], parameter, n);
}

void expect_dilate_from(void *const *row, int parameter, int n)
{
    uint16_t *out = row[0];
    const uint16_t *before = row[1];
    const int half = 1 << parameter >> 1;

    for (int x = 0; x < n; x++) {
        for (int dx = -1; dx <= 1; dx++) {
            const int fall = dx == 0 ? RF_CONE_STEP : RF_CONE_DIAGONAL;
            const int value = fallen(before[x + dx], (fall + half) >> parameter);

            if (value > out[x])
                out[x] = (uint16_t)value;
        }
    }
}

void run_mark_foreground(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    (void)parameter;
    k->mark_foreground(row[0], row[1], row[2], n);
}

void expect_mark_foreground(void *const *row, int parameter, int n)
{
    int16_t *background = row[0];
    const int16_t *blur = row[1];
    const uint16_t *dilated = row[2];

    (void)parameter;
    for (int x = 0; x < n; x++) {
        if (dilated[x] - 32768 > blur[x])
            background[x] = RF_NO_BLUR;
        else
            background[x] = blur[x];
    }
}

void run_push(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    uint16_t *const out[3] = {row[0], row[1], row[2]};
    /* three channels from two pairs of rows */
    const uint16_t *const upper[3] = {row[4], row[5], row[5]};
    const uint16_t *const lower[3] = {row[6], row[7], row[6]};

    k->push(out, row[3], upper, lower, row[8], row[9], (int16_t)parameter, n);
}

/* The mean of the children that count: those not far in front of the farthest. */
static uint16_t expected_mean(const int *light, const int *blur, int apart, int *farthest)
{
    int sum = 0, count = 0;

    *farthest = RF_NO_BLUR;
    for (int i = 0; i < 4; i++)
        *farthest = blur[i] > *farthest ? blur[i] : *farthest;
    for (int i = 0; i < 4; i++)
        if (blur[i] != RF_NO_BLUR && (apart == INT16_MAX || *farthest - blur[i] <= apart)) {
            sum += light[i];
            count++;
        }
    return count == 0 ? 0 : (uint16_t)((2 * sum + count) / (2 * count));
}

void expect_push(void *const *row, int parameter, int n)
{
    static const int upper[3] = {4, 5, 5}, lower[3] = {6, 7, 6};

    for (int x = 0; x < n; x++) {
        int light[4], blur[4], farthest;

        for (int i = 0; i < 4; i++)
            blur[i] = ((const int16_t *)row[8 + i / 2])[2 * x + i % 2];
        for (int c = 0; c < 3; c++) {
            for (int i = 0; i < 4; i++)
                light[i] = ((const uint16_t *)row[i < 2 ? upper[c] : lower[c]])[2 * x + i % 2];
            ((uint16_t *)row[c])[x] = expected_mean(light, blur, parameter, &farthest);
        }
        ((int16_t *)row[3])[x] = (int16_t)(farthest & ~RF_INPAINTED);
    }
}

void run_pull(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    const struct rf_parents parents = {row[2], row[3], row[4], row[5], (int16_t)parameter};
    const struct rf_mixed_parents mixed = {(uint16_t *)row[6] - 1, (int16_t *)row[7] - 1};

    k->pull(row[0], row[1], &parents, mixed, n);
}

/* A parent, or a mixture of two. */
struct parent {
    int light, blur;
};

static struct parent mix(struct parent near, struct parent far, int apart)
{
    const int deeper = far.blur - near.blur, mean = (3 * near.light + far.light + 2) / 4;

    if (apart != INT16_MAX && deeper > apart)
        return (struct parent){near.blur & RF_INPAINTED ? mean : far.light, far.blur};
    if (apart != INT16_MAX && -deeper > apart)
        return (struct parent){far.blur & RF_INPAINTED ? mean : near.light, near.blur};
    return (struct parent){mean, near.blur};
}

/* The mixture for child i of a row. */
static struct parent expected_parent(const uint16_t *const light[2], const int16_t *const blur[2],
                                     int apart, int i, int n)
{
    const int x = i / 2, other = i % 2 ? x + 1 : x - 1;
    const int at[2] = {x, other < 0 || other >= n ? x : other};
    struct parent column[2];

    for (int k = 0; k < 2; k++)
        column[k] = mix((struct parent){light[0] ? light[0][at[k]] : 0, blur[0][at[k]]},
                        (struct parent){light[1] ? light[1][at[k]] : 0, blur[1][at[k]]}, apart);
    return mix(column[0], column[1], apart);
}

void expect_pull(void *const *row, int parameter, int n)
{
    const uint16_t *const light[2] = {row[2], row[3]};
    const int16_t *const blur[2] = {row[4], row[5]};

    for (int i = 0; i < 2 * n; i++)
        if (((const int16_t *)row[1])[i] == RF_NO_BLUR)
            ((uint16_t *)row[0])[i] = (uint16_t)expected_parent(light, blur, parameter, i, n).light;
}

void run_pull_blur(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    const struct rf_parents parents = {NULL, NULL, row[1], row[2], (int16_t)parameter};

    k->pull_blur(row[0], &parents, (int16_t *)row[3] - 1, n);
}

void expect_pull_blur(void *const *row, int parameter, int n)
{
    const uint16_t *const light[2] = {NULL, NULL};
    const int16_t *const blur[2] = {row[1], row[2]};
    int16_t *out = row[0];

    for (int i = 0; i < 2 * n; i++)
        if (out[i] == RF_NO_BLUR)
            out[i] = (int16_t)(expected_parent(light, blur, parameter, i, n).blur | RF_INPAINTED);
}

void run_push1(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->push1(row[0], row[1], row[2], row[3], row[4], row[5], (int16_t)parameter, n);
}

void expect_push1(void *const *row, int parameter, int n)
{
    for (int x = 0; x < n; x++) {
        int light[4], blur[4], farthest;

        for (int i = 0; i < 4; i++) {
            light[i] = ((const uint16_t *)row[2 + i / 2])[2 * x + i % 2];
            blur[i] = ((const int16_t *)row[4 + i / 2])[2 * x + i % 2];
        }
        ((uint16_t *)row[0])[x] = expected_mean(light, blur, parameter, &farthest);
        ((int16_t *)row[1])[x] = (int16_t)(farthest & ~RF_INPAINTED);
    }
}
