/* test_pictures.c: pictures go in and come out in all formats, strides, regions and sizes, with
 * coarse depth. */
#include "pictures.h"

/* A copy of a picture in another format and stride. */
struct copy {
    uint8_t *memory;
    struct refocus_image image;
};

static const struct {
    uint32_t format;
    int r, g, b;
} formats[] = {{REFOCUS_FORMAT_RGB8, 0, 1, 2},
               {REFOCUS_FORMAT_BGR8, 2, 1, 0},
               {REFOCUS_FORMAT_RGBA8, 0, 1, 2},
               {REFOCUS_FORMAT_BGRA8, 2, 1, 0}};

/* @upward: the last row first in memory. Bytes that are no pixels are 0xee. */
static struct copy make_copy(int format, int width, int height, int slack, int upward)
{
    const int bytes = refocus_format_bytes(formats[format].format);
    const ptrdiff_t stride = (ptrdiff_t)width * bytes + slack;
    struct copy copy = {.memory = malloc((size_t)stride * (size_t)height + 1)};

    assert_non_null(copy.memory);
    memset(copy.memory, 0xee, (size_t)stride * (size_t)height + 1);
    copy.image =
        refocus_image_packed(formats[format].format, copy.memory + 1, width, height, stride);
    if (upward) {
        copy.image.plane[0] += stride * (height - 1);
        copy.image.stride[0] = -stride;
    }
    return copy;
}

static uint8_t *at(const struct copy *copy, int x, int y)
{
    return copy->image.plane[0] + y * copy->image.stride[0] +
           x * refocus_format_bytes(copy->image.format);
}

static uint8_t alpha_of(int x, int y)
{
    return (uint8_t)(x * 7 + y * 13);
}

static void fill_copy(struct copy *copy, int format, const struct picture *p)
{
    for (int y = 0; y < p->height; y++) {
        for (int x = 0; x < p->width; x++) {
            uint8_t *to = at(copy, x, y);
            const uint8_t *from = p->rgb + 3 * ((size_t)y * (size_t)p->width + (size_t)x);

            to[formats[format].r] = from[0];
            to[formats[format].g] = from[1];
            to[formats[format].b] = from[2];
            if (refocus_format_bytes(copy->image.format) == 4)
                to[3] = alpha_of(x, y);
        }
    }
}

/* Compares with R G B; the bytes between rows are still 0xee. */
static void check_copy(const struct copy *copy, int format, int slack, const uint8_t *rgb,
                       int has_alpha, const char *what)
{
    const int bytes = refocus_format_bytes(copy->image.format), w = copy->image.width;

    for (int y = 0; y < copy->image.height; y++) {
        for (int x = 0; x < w; x++, rgb += 3) {
            const uint8_t *to = at(copy, x, y);

            if (to[formats[format].r] != rgb[0] || to[formats[format].g] != rgb[1] ||
                to[formats[format].b] != rgb[2])
                fail_msg("%s: (%d, %d) is wrong", what, x, y);
            if (bytes == 4 && to[3] != (has_alpha ? alpha_of(x, y) : 255))
                fail_msg("%s: alpha of (%d, %d) is %d", what, x, y, to[3]);
        }
        for (int i = 0; i < slack; i++)
            assert_int_equal(at(copy, w, y)[i], 0xee);
    }
    assert_int_equal(copy->memory[0], 0xee);
}

TEST(every_format)
{
    struct picture p = picture_make(53, 37, 12);
    const struct refocus_disparity disparity = picture_disparity(&p);
    struct refocus_renderer *renderer = prepared(&p, 7, 2);
    uint8_t *expected = malloc(3 * 53 * 37);

    assert_non_null(expected);
    for (int s = 0; s < style_count; s += 5) {
        struct refocus_settings params = style_params(&styles[s], 0.2f, 7);
        const struct refocus_image photo = picture_image(&p);

        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), 0);
        render_style(renderer, &p, &styles[s], 0.2f, 7, expected);
        for (int from = 0; from < 4; from++) {
            struct copy in = make_copy(from, 53, 37, from * 5, from & 1);
            struct refocus_aperture *aperture = style_aperture(&styles[s]);

            fill_copy(&in, from, &p);
            params.render.aperture = aperture;
            assert_int_equal(refocus_prepare(renderer, &in.image, &disparity), 0);
            for (int to = 0; to < 4; to++) {
                struct copy out = make_copy(to, 53, 37, 3 + to, !(to & 1));

                assert_int_equal(refocus_render_settings(renderer, &params, &out.image), 0);
                check_copy(&out, to, 3 + to, expected, from >= 2, styles[s].name);
                free(out.memory);
            }
            refocus_aperture_destroy(&aperture);
            free(in.memory);
        }
    }
    free(expected);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Depth upside down in memory, with slack, and as 8 bits. */
TEST(disparity_layouts)
{
    enum { W = 45, H = 29, STRIDE = W + 3 };
    struct picture p = picture_make(W, H, 4);
    const struct refocus_image photo = picture_image(&p);
    uint16_t up[STRIDE * H];
    uint8_t bytes[STRIDE * H], expected[3 * W * H], out[3 * W * H];
    struct refocus_renderer *renderer;
    struct refocus_disparity map;

    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            const int v = p.disparity[y * W + x] / 257;

            p.disparity[y * W + x] = (uint16_t)(257 * v); /* v / 255 exactly */
            up[(H - 1 - y) * STRIDE + x] = (uint16_t)(257 * v);
            bytes[(H - 1 - y) * STRIDE + x] = (uint8_t)v;
        }
    }
    renderer = prepared(&p, 9, 1);
    render_style(renderer, &p, &styles[0], 0.5f, 9, expected);
    map = refocus_disparity16(up + (H - 1) * STRIDE, W, H, -2 * STRIDE);
    assert_int_equal(refocus_prepare(renderer, &photo, &map), 0);
    render_style(renderer, &p, &styles[0], 0.5f, 9, out);
    assert_same_pixels(out, expected, W, H, "negative stride of depth");
    map = refocus_disparity8(bytes + (H - 1) * STRIDE, W, H, -STRIDE);
    assert_int_equal(refocus_prepare(renderer, &photo, &map), 0);
    render_style(renderer, &p, &styles[0], 0.5f, 9, out);
    assert_same_pixels(out, expected, W, H, "8-bit depth");
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* A region is that part of the whole, to the bit. */
TEST(regions)
{
    static const int region[][4] = {{0, 0, 1, 1},   {76, 49, 1, 1}, {16, 16, 16, 16},
                                    {5, 9, 40, 17}, {0, 0, 77, 50}, {30, 0, 47, 50},
                                    {15, 15, 2, 2}, {0, 31, 77, 2}};
    enum { W = 77, H = 50 };
    struct picture p = picture_make(W, H, 8);
    struct refocus_renderer *renderer = prepared(&p, 8, 2), *fresh = prepared(&p, 8, 2);
    static uint8_t whole[3 * W * H], part[3 * W * H], crop[3 * W * H];

    for (int s = 0; s < style_count; s++) {
        struct refocus_settings params = style_params(&styles[s], 0.6f, 8);
        struct refocus_aperture *aperture = style_aperture(&styles[s]);

        params.render.aperture = aperture;
        render_style(renderer, &p, &styles[s], 0.6f, 8, whole);
        for (int i = 0; i < 8; i++) {
            const int x = region[i][0], y = region[i][1], w = region[i][2], h = region[i][3];
            const struct refocus_image image =
                refocus_image_packed(REFOCUS_FORMAT_RGB8, part, w, h, 3 * w);

            if (left_out(s + i, 3))
                continue;
            params.render.region_x = x, params.render.region_y = y;
            params.render.region_width = w, params.render.region_height = h;
            for (int row = 0; row < h; row++)
                memcpy(crop + 3 * row * w, whole + 3 * ((y + row) * W + x), 3 * (size_t)w);
            assert_int_equal(refocus_render_settings(i % 2 ? fresh : renderer, &params, &image), 0);
            assert_same_pixels(part, crop, w, h, styles[s].name);
        }
        refocus_aperture_destroy(&aperture);
    }
    refocus_renderer_destroy(&renderer);
    refocus_renderer_destroy(&fresh);
    picture_free(&p);
}

/* Odd sizes render, and a larger renderer gives the same bytes as one of that size. */
TEST(sizes)
{
    static const int size[][2] = {{1, 1},   {1, 2},   {2, 1},   {1, 100}, {100, 1}, {15, 15},
                                  {16, 16}, {17, 17}, {31, 16}, {16, 33}, {48, 7}};
    struct refocus_renderer_params limits = refocus_renderer_params_default(130, 110, 20);
    struct refocus_renderer *large;

    limits.threads = 2;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&large, &limits), 0);
    for (int i = 0; i < 11; i++) {
        struct picture p = picture_make(size[i][0], size[i][1], 50u + (uint32_t)i);
        const struct refocus_image photo = picture_image(&p);
        const struct refocus_disparity disparity = picture_disparity(&p);
        struct refocus_renderer *own = prepared(&p, 6.5f, 1);
        uint8_t a[3 * 600], b[3 * 600];

        assert_int_equal(refocus_prepare(large, &photo, &disparity), 0);
        for (int s = 0; s < style_count; s++) {
            if (left_out(s + i, 3))
                continue;
            render_style(own, &p, &styles[s], 0.9f, 6.5f, a);
            render_style(large, &p, &styles[s], 0.9f, 6.5f, b);
            assert_same_pixels(b, a, p.width, p.height, styles[s].name);
        }
        refocus_renderer_destroy(&own);
        picture_free(&p);
    }
    refocus_renderer_destroy(&large);
}

/* The longest rows and columns, with the largest blur. */
TEST(longest)
{
    for (int i = 0; i < 2; i++) {
        struct picture p = picture_make(i ? 1 : 65535, i ? 65535 : 1, 6);
        struct refocus_renderer *renderer = prepared(&p, 127, 2);
        uint8_t *out = malloc(3 * 65535);

        assert_non_null(out);
        if (!left_out(i, 2))
            render_style(renderer, &p, &styles[1], 0, 127, out);
        if (!left_out(i + 1, 2))
            render_style(renderer, &p, &styles[11], 1, 127, out);
        free(out);
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
}

/* Depth of other sizes than the photo: one sample, coarser, finer. */
TEST(other_depth_sizes)
{
    static const int size[][2] = {{1, 1}, {1, 9}, {12, 9}, {24, 18}, {97, 150}, {333, 1}};
    struct picture p = picture_make(48, 36, 2);
    const struct refocus_image photo = picture_image(&p);
    struct refocus_renderer *renderer = prepared(&p, 8, 2);
    uint8_t out[3 * 48 * 36];
    uint16_t view[48 * 36];

    for (int i = 0; i < 6; i++) {
        struct picture depth = picture_flat(size[i][0], size[i][1], (uint8_t[3]){0}, 30000);
        struct refocus_disparity map = picture_disparity(&depth);

        /* A map of one value everywhere keeps this value, so a lens focused there changes
         * nothing. */
        assert_int_equal(refocus_prepare(renderer, &photo, &map), 0);
        assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view, 96), 0);
        for (int k = 0; k < 48 * 36; k++)
            assert_int_equal(view[k], 30000);
        render_style(renderer, &p, &styles[0], 30000 / 65535.0f, 8, out);
        assert_same_pixels(out, p.rgb, 48, 36, "flat depth in focus");

        /* Left near, right far: values stay in range and the outer columns keep theirs. */
        for (int k = 0; k < depth.width * depth.height; k++)
            depth.disparity[k] = k % depth.width < depth.width / 2 ? 60000 : 5000;
        assert_int_equal(refocus_prepare(renderer, &photo, &map), 0);
        assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view, 96), 0);
        for (int k = 0; k < 48 * 36; k++) {
            assert_true(view[k] >= 5000 && view[k] <= 60000);
            if (k % 48 == 0)
                assert_int_equal(view[k], depth.width > 1 ? 60000 : 5000);
            if (k % 48 == 47)
                assert_int_equal(view[k], 5000);
        }
        picture_free(&depth);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
