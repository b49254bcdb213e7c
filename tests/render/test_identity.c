/* test_identity.c: pictures whose result is known to the bit: one colour, no blur, in focus. */
#include "pictures.h"

/* Any colour, depth, aperture, number of rays and blending: the colour comes back. */
TEST(one_colour)
{
    static const int grey[] = {0, 1, 2, 3, 10, 11, 12, 100, 127, 128, 200, 253, 254, 255};
    static const uint8_t colours[][3] = {{255, 0, 0}, {0, 1, 255}, {13, 200, 77}, {254, 255, 1}};
    enum { W = 37, H = 21 };
    uint8_t out[3 * W * H];
    struct picture deep = picture_make(W, H, 31);

    for (int i = 0; i < 14 + 4; i++) {
        const uint8_t rgb[3] = {(uint8_t)grey[i % 14], (uint8_t)grey[i % 14],
                                (uint8_t)grey[i % 14]};
        struct picture flat = picture_flat(W, H, i < 14 ? rgb : colours[i - 14], 0);
        struct refocus_renderer *renderer;

        memcpy(flat.disparity, deep.disparity, sizeof(uint16_t) * W * H);
        renderer = prepared(&flat, 11, 2);
        for (int s = 0; s < style_count; s++) {
            if (left_out(s + i, 4))
                continue;
            render_style(renderer, &flat, &styles[s], 0.35f, 11, out);
            assert_same_pixels(out, flat.rgb, W, H, styles[s].name);
        }
        refocus_renderer_destroy(&renderer);
        picture_free(&flat);
    }
    picture_free(&deep);
}

/* Every grey and every σ of a blend, on a small picture. */
TEST(every_grey)
{
    static const float sigmas[] = {0, 1, 3, 10, 30, 64, 128, 400, 1000};
    enum { W = 18, H = 5 };
    uint8_t out[3 * W * H];
    struct picture deep = picture_make(W, H, 33);

    for (int grey = 0; grey < 256; grey++) {
        struct picture flat = picture_flat(
            W, H, (uint8_t[3]){(uint8_t)grey, (uint8_t)(255 - grey), (uint8_t)grey}, 0);
        struct refocus_renderer *renderer;

        memcpy(flat.disparity, deep.disparity, sizeof(uint16_t) * W * H);
        renderer = prepared(&flat, 5, 1);
        for (int i = 0; i < 27; i++) {
            struct style style = {"sweep", REFOCUS_METHOD_SWEEP, 24, 1, 0, 0, 1, 0, 0, 0, 0, 0};

            style.blend = (uint32_t)i % 3;
            style.sigma = sigmas[i / 3];
            render_style(renderer, &flat, &style, 0, 5, out);
            if (memcmp(out, flat.rgb, sizeof out))
                fail_msg("grey %d, blend %d, sigma %g: gives %d %d %d", grey, i % 3,
                         (double)sigmas[i / 3], out[0], out[1], out[2]);
        }
        refocus_renderer_destroy(&renderer);
        picture_free(&flat);
    }
    picture_free(&deep);
}

/* K = 0, and a K of less than half a pixel of blur anywhere: the photo. */
TEST(no_blur)
{
    enum { W = 61, H = 34 };
    struct picture p = picture_make(W, H, 21);
    struct refocus_renderer *renderer = prepared(&p, 3, 2), *sharp = prepared(&p, 0, 1);
    uint8_t out[3 * W * H];

    for (int s = 0; s < style_count; s++) {
        render_style(sharp, &p, &styles[s], 0.5f, 0, out);
        assert_same_pixels(out, p.rgb, W, H, styles[s].name);
        render_style(renderer, &p, &styles[s], 0.5f, 0, out);
        assert_same_pixels(out, p.rgb, W, H, styles[s].name);
        if (styles[s].leaks == 2) /* fields and stars are not of depth */
            continue;
        render_style(renderer, &p, &styles[s], 0.5f, 0.98f, out); /* r <= 0.49 */
        assert_same_pixels(out, p.rgb, W, H, styles[s].name);
    }
    refocus_renderer_destroy(&renderer);
    refocus_renderer_destroy(&sharp);
    picture_free(&p);
}

/* The left half near, the right half far: renders with every style and fails where a pixel
 * of the columns from @from to @to has changed; styles that leak more than @allowed are left
 * out. At least a quarter of all must have. */
static void columns_stay(float focus, int from, int to, int allowed)
{
    enum { W = 96, H = 40, K = 9 };
    struct picture p = picture_make(W, H, 71);
    struct refocus_renderer *renderer;
    uint8_t out[3 * W * H];

    for (int i = 0; i < W * H; i++)
        p.disparity[i] = i % W < W / 2 ? 65535 : 0;
    renderer = prepared(&p, K, 2);
    for (int s = 0; s < style_count; s++) {
        int changed = 0;

        if (styles[s].leaks > allowed)
            continue;
        render_style(renderer, &p, &styles[s], focus, K, out);
        for (int i = 0; i < W * H; i++) {
            const int same = !memcmp(out + 3 * i, p.rgb + 3 * i, 3);

            if (i % W >= from && i % W < to && !same)
                fail_msg("%s: (%d, %d) is in focus and changed", styles[s].name, i % W, i / W);
            changed += !same;
        }
        assert_true(changed > W * H / 4 || styles[s].rays == 1);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* The near half in focus has nothing blurred over it, so all of it stays. */
TEST(sharp_before_blurred)
{
    columns_stay(1, 0, 48, 0);
}

/* A blurred half before a sharp one: pixels well farther than K from the edge stay. */
TEST(blurred_before_sharp)
{
    columns_stay(0, 48 + 3 * 9 / 2 + 5, 96, 1); /* heat goes as far as a Gaussian */
}
