/* fit_coverage.c: fits the coverage of a line of one pixel, as hair is, before a pattern, by least
 * squares (mixture.h). */
#include <assert.h>
#include <stdlib.h>

#include "thin/mixture.h"

enum {
    REACH = 4,           /* pixels that are looked at on each side */
    LEAST = 4,           /* so many of them belong to the line at least */
    MOST = 13,           /* so many belong to it at most */
    CLOSE = 4,           /* so many of the 3 x 3 around the pixel belong to it at most */
    JUMP = 65535 / 32,   /* disparities this far apart are two surfaces */
    PATTERN = 400 * 400, /* least variance of F, Q12 squared */
    SOLID = 32,          /* 1 - alpha, 255 = 1: below this a pixel shows no pattern */
    CLEAR = 225,         /* 1 - alpha above this counts as this */
    STEEPEST = 380,      /* a slope above this is none */
};

/* Sums over a line's pixels for a regression of C on F: products are of the three channels. */
struct fit {
    int64_t count, f[3], c[3], ff, fc, cc;
};

/* F beside a pixel: the mean of the far ones of the eight around it. False: fewer than two. */
static bool far_beside(const struct rf_thin_pass *t, int x, int y, int own, int64_t far[3])
{
    int count = 0;

    far[0] = far[1] = far[2] = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const ptrdiff_t q = rf_within(y + j, t->view->height - 1) * t->view->stride +
                                rf_within(x + i, t->view->width - 1);

            if (t->disparity.at[q] >= own - JUMP)
                continue;
            for (int c = 0; c < 3; c++)
                far[c] += t->light.channel[c][q];
            count++;
        }
    for (int c = 0; c < 3 && count; c++)
        far[c] = (far[c] + count / 2) / count;
    return count >= 2;
}

static void add_pixel(struct fit *fit, const struct rf_thin_pass *t, ptrdiff_t at,
                      const int64_t far[3])
{
    fit->count++;
    for (int c = 0; c < 3; c++) {
        const int64_t light = t->light.channel[c][at];

        fit->f[c] += far[c];
        fit->c[c] += light;
        fit->ff += far[c] * far[c];
        fit->fc += far[c] * light;
        fit->cc += light * light;
    }
}

static int near_in(const struct rf_thin_pass *t, struct rf_rect in, int own)
{
    int count = 0;

    for (int y = in.y0; y < in.y1; y++)
        for (int x = in.x0; x < in.x1; x++)
            count += abs(t->disparity.at[y * t->view->stride + x] - own) <= JUMP;
    return count;
}

/* Whether a pixel is on a line of one pixel with no other near. The 3 x 3 pixels around it are
 * enough to tell a wire, which is wider. */
static bool is_line(const struct rf_thin_pass *t, int x, int y, int own)
{
    int count;

    if (near_in(t, rf_around(t->view, x, y, 1), own) > CLOSE)
        return false;
    count = near_in(t, rf_around(t->view, x, y, REACH), own);
    return count >= LEAST && count <= MOST;
}

static void add_line(struct fit *fit, const struct rf_thin_pass *t, int x, int y, int own)
{
    const struct rf_rect in = rf_around(t->view, x, y, REACH);

    for (int qy = in.y0; qy < in.y1; qy++)
        for (int qx = in.x0; qx < in.x1; qx++) {
            const ptrdiff_t q = qy * t->view->stride + qx;
            int64_t far[3];

            if (abs(t->disparity.at[q] - own) <= JUMP && far_beside(t, qx, qy, own, far))
                add_pixel(fit, t, q, far);
        }
}

/* The slope of C over F, 255 = 1; 0: there is no pattern, or C does not follow it. */
static_assert(INT64_C(3) * (MOST * RF_LIGHT_MAX) * (MOST * RF_LIGHT_MAX) < INT64_C(1) << 34,
              "variances, of which 2 STEEPEST times fit 64 bits");
static int slope_of(const struct fit *fit)
{
    const int64_t n = fit->count;
    int64_t ff = n * fit->ff, fc = n * fit->fc, cc = n * fit->cc, slope;

    for (int c = 0; c < 3; c++) {
        ff -= fit->f[c] * fit->f[c];
        fc -= fit->f[c] * fit->c[c];
        cc -= fit->c[c] * fit->c[c];
    }
    if (ff < n * n * PATTERN || fc <= 0)
        return 0;
    slope = 255 * fc / ff;
    if (slope < SOLID || slope > STEEPEST || 2 * slope * fc < 255 * cc)
        return 0;
    return (int)(slope < CLEAR ? slope : CLEAR);
}

void rf_fit_coverage(const struct rf_thin_pass *t, struct rf_thin *thin, int tx, int ty)
{
    const int x = tx * RF_TILE + thin->at % RF_TILE, y = ty * RF_TILE + thin->at / RF_TILE;
    const ptrdiff_t at = y * t->view->stride + x;
    struct fit fit = {.count = 0};
    int slope;

    if (t->disparity.at[at] != thin->near_disparity || !is_line(t, x, y, thin->near_disparity))
        return;
    add_line(&fit, t, x, y, thin->near_disparity);
    slope = fit.count >= LEAST ? slope_of(&fit) : 0;
    if (!slope)
        return;
    thin->alpha = (uint8_t)(255 - slope);
    for (int c = 0; c < 3; c++) {
        const int64_t own = (255 * fit.c[c] - slope * fit.f[c]) / (255 * fit.count);
        const int64_t far = (t->light.channel[c][at] - (own > 0 ? own : 0)) * 255 / slope;

        thin->light[c] = (uint16_t)(far < 0 ? 0 : far < RF_LIGHT_MAX ? far : RF_LIGHT_MAX);
    }
}
