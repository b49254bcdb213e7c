/* metrics.c: PSNR, SSIM and other scores of a picture against a reference are computed. */
#include "metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WINDOW = 11, HALF = WINDOW / 2 };

double quality_rmse(const uint8_t *a, const uint8_t *b, int width, int height, int border,
                    const uint8_t *mask, long *pixels)
{
    uint64_t sum = 0;
    long count = 0;

    for (int y = border; y < height - border; y++) {
        for (int x = border; x < width - border; x++) {
            const size_t i = (size_t)y * (size_t)width + (size_t)x;

            if (mask && !mask[i])
                continue;
            for (int c = 0; c < 3; c++) {
                const int difference = a[3 * i + (size_t)c] - b[3 * i + (size_t)c];
                sum += (uint64_t)(difference * difference);
            }
            count++;
        }
    }
    if (pixels)
        *pixels = count;
    return count ? sqrt((double)sum / (3.0 * (double)count)) : NAN;
}

double quality_psnr(double rmse)
{
    return rmse > 0 ? 20 * log10(255 / rmse) : rmse == 0 ? INFINITY : NAN;
}

static double luma(const uint8_t *rgb)
{
    return 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
}

static void window_weights(double weight[WINDOW])
{
    double sum = 0;

    for (int i = 0; i < WINDOW; i++)
        sum += weight[i] = exp(-(i - HALF) * (i - HALF) / (2 * 1.5 * 1.5));
    for (int i = 0; i < WINDOW; i++)
        weight[i] /= sum;
}

/* The five moments of one row, filtered along x: a, b, a a, b b, a b. */
static void filter_row(const uint8_t *a, const uint8_t *b, int width, const double weight[WINDOW],
                       double *out)
{
    for (int x = HALF; x < width - HALF; x++) {
        double m[5] = {0};

        for (int i = 0; i < WINDOW; i++) {
            const double p = luma(a + 3 * (x + i - HALF));
            const double q = luma(b + 3 * (x + i - HALF));

            m[0] += weight[i] * p;
            m[1] += weight[i] * q;
            m[2] += weight[i] * p * p;
            m[3] += weight[i] * q * q;
            m[4] += weight[i] * p * q;
        }
        memcpy(out + 5 * x, m, sizeof m);
    }
}

static double ssim_of(const double m[5])
{
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    const double var_a = m[2] - m[0] * m[0], var_b = m[3] - m[1] * m[1];
    const double covariance = m[4] - m[0] * m[1];

    return (2 * m[0] * m[1] + c1) * (2 * covariance + c2) /
           ((m[0] * m[0] + m[1] * m[1] + c1) * (var_a + var_b + c2));
}

int quality_ssim(const uint8_t *a, const uint8_t *b, int width, int height, int border,
                 double *ssim)
{
    const int margin = border > HALF ? border : HALF;
    const size_t row = 5 * (size_t)width;
    double weight[WINDOW], sum = 0;
    double *rows = calloc(WINDOW * row, sizeof *rows); /* row y is at y % WINDOW */
    long count = 0;

    if (!rows)
        return -1;
    window_weights(weight);
    for (int y = 0; y < height; y++) {
        const int centre = y - HALF;

        filter_row(a + 3 * (size_t)y * (size_t)width, b + 3 * (size_t)y * (size_t)width, width,
                   weight, rows + (size_t)(y % WINDOW) * row);
        if (centre < margin || centre >= height - margin)
            continue;
        for (int x = margin; x < width - margin; x++) {
            double m[5] = {0};

            for (int i = 0; i < WINDOW; i++) {
                const double *from = rows + (size_t)((centre + i - HALF) % WINDOW) * row + 5 * x;
                for (int k = 0; k < 5; k++)
                    m[k] += weight[i] * from[k];
            }
            sum += ssim_of(m);
            count++;
        }
    }
    free(rows);
    *ssim = count ? sum / (double)count : NAN;
    return 0;
}

/* Adds a disc to @cover, which holds the differences along each row of how many discs
 * lie over a pixel: one entry more than pixels in a row. */
static void add_disc(int32_t *cover, int width, int height, int x, int y, double radius)
{
    const int reach = (int)floor(radius);

    for (int dy = -reach; dy <= reach; dy++) {
        const int half = (int)floor(sqrt(radius * radius - dy * dy));
        const int from = x - half < 0 ? 0 : x - half;
        const int to = x + half >= width ? width : x + half + 1;

        if (y + dy < 0 || y + dy >= height)
            continue;
        cover[(size_t)(y + dy) * ((size_t)width + 1) + (size_t)from]++;
        cover[(size_t)(y + dy) * ((size_t)width + 1) + (size_t)to]--;
    }
}

/* Radius of the edge band about (x, y), or -1 where no jump is. */
static double edge_radius(const uint16_t *disparity, int width, int height, int x, int y,
                          double focus, double blur)
{
    static const int step[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const double here = disparity[(size_t)y * (size_t)width + (size_t)x] / 65535.0;
    double radius = -1;

    for (int i = 0; i < 4; i++) {
        const int u = x + step[i][0], v = y + step[i][1];

        if (u < 0 || v < 0 || u >= width || v >= height)
            continue;
        const double there = disparity[(size_t)v * (size_t)width + (size_t)u] / 65535.0;
        if (blur * fabs(here - there) >= 2)
            radius = fmax(radius, blur * fmax(fabs(here - focus), fabs(there - focus)));
    }
    return radius;
}

int quality_edge_mask(const uint16_t *disparity, int width, int height, double focus, double blur,
                      uint8_t *mask)
{
    int32_t *cover = calloc(((size_t)width + 1) * (size_t)height, sizeof *cover);

    if (!cover)
        return -1;
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const double radius = edge_radius(disparity, width, height, x, y, focus, blur);
            if (radius >= 0)
                add_disc(cover, width, height, x, y, radius);
        }
    }
    for (int y = 0; y < height; y++) {
        int32_t discs = 0;
        for (int x = 0; x < width; x++) {
            discs += cover[(size_t)y * ((size_t)width + 1) + (size_t)x];
            mask[(size_t)y * (size_t)width + (size_t)x] = discs > 0 ? 255 : 0;
        }
    }
    free(cover);
    return 0;
}

int quality_score(const uint8_t *picture, const uint8_t *reference, int width, int height,
                  int border, const uint8_t *mask, struct quality_scores *scores)
{
    scores->rmse = quality_rmse(picture, reference, width, height, border, NULL, &scores->pixels);
    scores->psnr = quality_psnr(scores->rmse);
    scores->edge_psnr = NAN;
    scores->edge_pixels = 0;
    if (mask)
        scores->edge_psnr = quality_psnr(
            quality_rmse(picture, reference, width, height, border, mask, &scores->edge_pixels));
    return quality_ssim(picture, reference, width, height, border, &scores->ssim);
}
