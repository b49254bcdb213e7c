/* test_metrics.c: the metrics themselves, on cases with answers worked out by hand. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "unit_test.h"

#include "metrics.h"

enum { W = 13, H = 12 };

static void fill_noise(uint8_t *rgb, uint32_t seed)
{
    for (int i = 0; i < 3 * W * H; i++) {
        seed = seed * 1664525u + 1013904223u;
        rgb[i] = (uint8_t)(seed >> 24);
    }
}

TEST(equal_pictures)
{
    uint8_t a[3 * W * H];
    struct quality_scores s;

    fill_noise(a, 1);
    assert_int_equal(quality_score(a, a, W, H, 2, NULL, &s), 0);
    assert_true(s.rmse == 0 && isinf(s.psnr) && s.psnr > 0);
    assert_true(fabs(s.ssim - 1) < 1e-12);
    assert_int_equal(s.pixels, (W - 4) * (H - 4));
    assert_true(isnan(s.edge_psnr));
}

TEST(known_psnr)
{
    uint8_t a[3 * W * H], b[3 * W * H];
    long pixels;

    memset(a, 100, sizeof a);
    memset(b, 103, sizeof b);
    /* 20 log10(255 / 3) */
    assert_true(fabs(quality_psnr(quality_rmse(a, b, W, H, 0, NULL, &pixels)) - 38.588379) < 1e-5);
    assert_int_equal(pixels, W * H);

    /* One channel of one pixel by 30: mean square 900 / (3 W H). */
    memcpy(b, a, sizeof b);
    b[3 * (5 * W + 5) + 1] = 70;
    assert_true(fabs(quality_rmse(a, b, W, H, 0, NULL, NULL) - 30 / sqrt(3.0 * W * H)) < 1e-12);
    /* Inside a border of 5 there are 3 x 2 pixels; (5, 5) is one of them. */
    assert_true(fabs(quality_rmse(a, b, W, H, 5, NULL, &pixels) - 30 / sqrt(18.0)) < 1e-12);
    assert_int_equal(pixels, 6);
    assert_true(isnan(quality_rmse(a, b, W, H, 6, NULL, &pixels)));
    assert_int_equal(pixels, 0);
}

TEST(masked_rmse)
{
    uint8_t a[3 * W * H], b[3 * W * H], mask[W * H] = {0};
    long pixels;

    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    b[3 * (4 * W + 7)] = 200;
    mask[4 * W + 7] = 1;
    mask[4 * W + 8] = 1;
    assert_true(fabs(quality_rmse(a, b, W, H, 0, mask, &pixels) - 200 / sqrt(6.0)) < 1e-12);
    assert_int_equal(pixels, 2);
}

/* Two flat pictures: variances are 0, so SSIM is its luminance term alone,
 * (2 a b + C1) / (a^2 + b^2 + C1) with a = 100, b = 120, C1 = 6.5025. */
TEST(flat_ssim)
{
    uint8_t a[3 * W * H], b[3 * W * H];
    double ssim;

    memset(a, 100, sizeof a);
    memset(b, 120, sizeof b);
    assert_int_equal(quality_ssim(a, b, W, H, 0, &ssim), 0);
    assert_true(fabs(ssim - 24006.5025 / 24406.5025) < 1e-9);
    assert_int_equal(quality_ssim(a, b, 10, H, 0, &ssim), 0);
    assert_true(isnan(ssim));
}

/* A picture against its negative around 127.5: the same variance, covariance minus it.
 * With one window the sums can be written out directly. */
TEST(one_window_ssim)
{
    uint8_t a[3 * 121], b[3 * 121];
    double weight[11], total = 0, mean_a = 0, mean_b = 0, square = 0, ssim;

    for (int i = 0; i < 11; i++)
        total += weight[i] = exp(-(i - 5) * (i - 5) / 4.5);
    for (int i = 0; i < 121; i++) {
        const int value = (i * 37) % 256;
        memset(a + 3 * i, value, 3);
        memset(b + 3 * i, 255 - value, 3);
        const double w = weight[i % 11] * weight[i / 11] / (total * total);
        mean_a += w * value;
        mean_b += w * (255 - value);
        square += w * value * value;
    }
    const double variance = square - mean_a * mean_a;
    const double expected =
        (2 * mean_a * mean_b + 6.5025) * (-2 * variance + 58.5225) /
        ((mean_a * mean_a + mean_b * mean_b + 6.5025) * (2 * variance + 58.5225));
    assert_int_equal(quality_ssim(a, b, 11, 11, 0, &ssim), 0);
    assert_true(expected < -0.5);
    assert_true(fabs(ssim - expected) < 1e-9);
}

/* Left half d = 0, right half d = 1/2 (32768), focus at 0, K = 6: the jump is
 * 3 px and so is the larger blur radius, so 3 + 1 columns on either side. */
TEST(straight_edge)
{
    uint16_t d[W * H];
    uint8_t mask[W * H];

    for (int i = 0; i < W * H; i++)
        d[i] = i % W < 6 ? 0 : 32768;
    assert_int_equal(quality_edge_mask(d, W, H, 0, 6, mask), 0);
    for (int i = 0; i < W * H; i++)
        assert_int_equal(mask[i], i % W >= 2 && i % W <= 9 ? 255 : 0);

    /* K = 3: the jump is 1.5 px, no edge. */
    assert_int_equal(quality_edge_mask(d, W, H, 0, 3, mask), 0);
    for (int i = 0; i < W * H; i++)
        assert_int_equal(mask[i], 0);
}
