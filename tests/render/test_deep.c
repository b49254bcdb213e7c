/* test_deep.c: photos of more than 8 bits: what nothing changes comes back in full, gradients keep
 * their steps, what is refused. */
#include "deep_pictures.h"

/* Any bits but alpha's come back where nothing is blurred, NaN, infinities and all that a format
 * can hold among them, whether all is in focus, or some tiles are mixed. */
TEST(in_focus)
{
    struct picture p = picture_make(97, 61, 3);
    const struct refocus_disparity map = picture_disparity(&p);
    struct refocus_renderer *renderer = deep_renderer(97, 61, 12, 2);

    for (uint32_t format = REFOCUS_FORMAT_RGB16; format <= REFOCUS_FORMAT_RGBA_FLOAT; format++) {
        struct deep photo = deep_make(format, 97, 61), out = deep_make(format, 97, 61);
        uint32_t seed = format;
        int same = 0;

        for (size_t i = 0; i < photo.size; i++)
            photo.memory[i] = (uint8_t)((seed = seed * 1664525 + 1013904223) >> 24);
        assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
        assert_int_equal(deep_render(renderer, 0.5f, 0, &out.image), REFOCUS_OK);
        for (int y = 0; y < 61; y++)
            assert_memory_equal(deep_at(&photo, 0, y, 0), deep_at(&out, 0, y, 0),
                                97 * (size_t)refocus_format_bytes(format));
        memset(out.memory, 0, out.size);
        assert_int_equal(deep_render(renderer, 0, 1, &out.image), REFOCUS_OK);
        for (int y = 0; y < 61; y++)
            for (int x = 0; x < 97; x++)
                same += !memcmp(deep_at(&photo, x, y, 0), deep_at(&out, x, y, 0),
                                (size_t)refocus_format_bytes(format));
        assert_in_range(same, 97 * 61 / 8, 97 * 61);
        free(photo.memory);
        free(out.memory);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* 512 steps of a slope of 16 bits are 512, in focus and blurred. */
TEST(gradients)
{
    static const uint32_t transfers[] = {REFOCUS_TRANSFER_SRGB,  REFOCUS_TRANSFER_BT709,
                                         REFOCUS_TRANSFER_PQ,    REFOCUS_TRANSFER_HLG,
                                         REFOCUS_TRANSFER_GAMMA, REFOCUS_TRANSFER_LINEAR};
    enum { STEPS = 512, WIDE = 4 };

    for (int t = 0; t < 6; t++)
        for (int blurred = 0; blurred < 2; blurred++) {
            struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, STEPS * WIDE, 32);
            struct deep out = deep_make(REFOCUS_FORMAT_RGB16, STEPS * WIDE, 32);
            struct refocus_renderer *renderer;
            int steps = 0;

            photo.image.transfer = out.image.transfer = transfers[t];
            for (int i = 0; i < 3 * 32 * STEPS * WIDE; i++)
                deep_put(&photo, i / 3 % (STEPS * WIDE), i / 3 / (STEPS * WIDE), i % 3,
                         (float)(i / 3 % (STEPS * WIDE) / WIDE) / (STEPS - 1));
            renderer = deep_prepare_flat(&photo.image, 10);
            assert_int_equal(deep_render(renderer, blurred, 10, &out.image), REFOCUS_OK);
            for (int i = 1; i < STEPS; i++)
                steps += deep_get(&out, WIDE * i + 1, 16, 0) >
                         deep_get(&out, WIDE * i + 1 - WIDE, 16, 0);
            /* The darkest steps of PQ are below those of means, and the brightest above them. */
            assert_in_range(steps, blurred && transfers[t] == REFOCUS_TRANSFER_PQ ? 350 : 500, 511);
            refocus_renderer_destroy(&renderer);
            free(photo.memory);
            free(out.memory);
        }
}

/* The steps of a slope over eleven codes of 8 bits are less than those of means are apart. */
TEST(shallow_gradients)
{
    static const double begins[] = {20000 / 65535.0, 30000 / 65535.0, 50000 / 65535.0};
    static const float blurs[] = {2, 6, 10};
    enum { STEPS = 512, WIDE = 2 };

    for (int k = 0; k < 9; k++) {
        struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, STEPS * WIDE, 32);
        struct deep out = deep_make(REFOCUS_FORMAT_RGB16, STEPS * WIDE, 32);
        struct refocus_renderer *renderer;
        int steps = 0;

        for (int i = 0; i < 3 * 32 * STEPS * WIDE; i++) {
            const int step = i / 3 % (STEPS * WIDE) / WIDE;

            deep_put(&photo, i / 3 % (STEPS * WIDE), i / 3 / (STEPS * WIDE), i % 3,
                     (float)(begins[k / 3] + 11 / 255.0 * step / (STEPS - 1)));
        }
        renderer = deep_prepare_flat(&photo.image, 10);
        assert_int_equal(deep_render(renderer, 1, blurs[k % 3], &out.image), REFOCUS_OK);
        for (int i = 1; i < STEPS; i++)
            steps += deep_get(&out, WIDE * i + 1, 16, 0) > deep_get(&out, WIDE * i - 1, 16, 0);
        assert_in_range(steps, 500, 511);
        refocus_renderer_destroy(&renderer);
        free(photo.memory);
        free(out.memory);
    }
}

/* Light of a code between whole ones. */
static double light_of(double code)
{
    const double v = code / 255;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* Whether the mean of Q14 nearest to this light may have the code. Where roundings of means are
 * made up for they were two at the most. */
static bool is_of_code(double value, int code, bool made_up)
{
    const double roundings = ((made_up ? 2 : 0) + 0.6) / 16380;

    return light_of(value) > light_of(code - 0.5) - roundings &&
           light_of(value) < light_of(code + 0.5) + roundings;
}

/* Each method that takes deep photos makes of one of 16 bits what it makes of the same in 8, with
 * finer steps, and writes it in either. What is in focus comes out as it went in. */
TEST(methods)
{
    enum { WIDE = 97, HIGH = 61 };
    struct picture p = picture_make(WIDE, HIGH, 3);
    const struct refocus_disparity map = picture_disparity(&p);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, WIDE, HIGH);
    struct deep out = deep_make(REFOCUS_FORMAT_RGB16, WIDE, HIGH);
    struct deep code = deep_make(REFOCUS_FORMAT_RGB8, WIDE, HIGH);
    struct deep plain = deep_make(REFOCUS_FORMAT_RGB8, WIDE, HIGH);
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDE, HIGH, 12);
    struct refocus_renderer *deep, *shallow;

    photo.image.transfer = out.image.transfer = REFOCUS_TRANSFER_SRGB;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        deep_put(&photo, i / 3 % WIDE, i / 3 / WIDE, i % 3, (float)p.rgb[i] / 255);
    for (int y = 0; y < HIGH; y++)
        memcpy(deep_at(&plain, 0, y, 0), p.rgb + 3 * WIDE * y, 3 * WIDE);
    limits.papers = refocus_papers();
    limits.methods = (1u << REFOCUS_METHOD_COUNT) - 1;
    assert_int_equal(refocus_renderer_create(&shallow, &limits), REFOCUS_OK);
    limits.deep = 1;
    assert_int_equal(refocus_renderer_create(&deep, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(shallow, &plain.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_prepare(deep, &photo.image, &map), REFOCUS_OK);
    for (uint32_t m = 0; m < REFOCUS_METHOD_COUNT; m++) {
        struct refocus_settings params = refocus_settings_default(0.4f, 12);
        const bool takes = refocus_method_traits(m) & REFOCUS_METHOD_TAKES_DEEP;
        int finer = 0;

        params.render.method = m;
        params.render.dither = REFOCUS_DITHER_OFF;
        params.highlights.gain = 1;
        if (!takes) {
            assert_int_equal(refocus_render_settings(deep, &params, &out.image),
                             REFOCUS_ERR_UNSUPPORTED);
            continue;
        }
        assert_int_equal(refocus_render_settings(shallow, &params, &plain.image), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(deep, &params, &out.image), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(deep, &params, &code.image), REFOCUS_OK);
        for (int i = 0; i < 3 * WIDE * HIGH; i++) {
            const int x = i / 3 % WIDE, y = i / 3 / WIDE, c = i % 3;
            uint16_t sample; /* at an odd place, perhaps */

            memcpy(&sample, deep_at(&out, x, y, c), sizeof sample);
            const double value = sample / 257.0;

            assert_true(is_of_code(value, *deep_at(&plain, x, y, c), m == REFOCUS_METHOD_SWEEP));
            assert_int_equal(*deep_at(&code, x, y, c), *deep_at(&plain, x, y, c));
            finer += fabs(value - floor(value + 0.5)) > 0.1;
        }
        assert_in_range(finer, WIDE * HIGH, 3 * WIDE * HIGH);
        params.render.max_blur_radius = 0;
        assert_int_equal(refocus_render_settings(deep, &params, &out.image), REFOCUS_OK);
        for (int y = 0; y < HIGH; y++)
            assert_memory_equal(deep_at(&out, 0, y, 0), deep_at(&photo, 0, y, 0), 6 * WIDE);
    }
    refocus_renderer_destroy(&shallow);
    refocus_renderer_destroy(&deep);
    free(photo.memory);
    free(out.memory);
    free(code.memory);
    free(plain.memory);
    picture_free(&p);
}

/* A slope of 8 codes over 512 pixels, in focus and blurred, becomes 8 bits whose mean over 8 x 8
 * pixels has no steps; codes stay codes; without dither there are 9 of them. */
TEST(dither)
{
    enum { WIDE = 512, HIGH = 32 };
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, WIDE, HIGH);
    struct deep out = deep_make(REFOCUS_FORMAT_BGRA8, WIDE, HIGH);
    struct refocus_renderer *renderer;

    photo.image.transfer = REFOCUS_TRANSFER_SRGB;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        deep_put(&photo, i / 3 % WIDE, i / 3 / WIDE, i % 3,
                 (40 + (float)(i / 3 % WIDE) / 64) / 255);
    renderer = deep_prepare_flat(&photo.image, 10);
    for (int kind = 0; kind < 4; kind++) {
        struct refocus_settings params = refocus_settings_default((float)(kind % 2), 10);
        double worst = 0;
        int changes = 0;

        params.render.dither = kind < 2 ? REFOCUS_DITHER_ORDERED : REFOCUS_DITHER_OFF;
        assert_int_equal(refocus_render_settings(renderer, &params, &out.image), REFOCUS_OK);
        for (int x = 16; x < WIDE - 24; x++) {
            const double expected = 40 + (x + 3.5) / 64;
            double sum = 0;

            for (int i = 0; i < 64; i++)
                sum += *deep_at(&out, x + i % 8, 8 + i / 8, kind % 3) / 64.0;
            worst = fmax(worst, fabs(sum - expected));
            changes += *deep_at(&out, x + 1, 8, 0) != *deep_at(&out, x, 8, 0);
        }
        if (kind < 2)
            assert_true(worst < 0.06 && changes > 50);
        else
            assert_true(worst > 0.3 && changes <= 8);
        assert_int_equal(*deep_at(&out, 3, 3, 3), 255);
    }
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        deep_put(&photo, i / 3 % WIDE, i / 3 / WIDE, i % 3, (float)(i / 3 % 256) / 255);
    refocus_renderer_destroy(&renderer);
    renderer = deep_prepare_flat(&photo.image, 10);
    assert_int_equal(deep_render(renderer, 1, 0, &out.image), REFOCUS_OK);
    for (int i = 0; i < 4 * WIDE * HIGH; i++)
        assert_int_equal(*deep_at(&out, i / 4 % WIDE, i / 4 / WIDE, i % 4),
                         i % 4 == 3 ? 255 : i / 4 % 256);
    refocus_renderer_destroy(&renderer);
    free(photo.memory);
    free(out.memory);
}

/* Every half is the float that IEEE 754 says, and comes back from it. */
TEST(halves)
{
    enum { SIDE = 148 };
    struct deep half = deep_make(REFOCUS_FORMAT_RGB_HALF, SIDE, SIDE);
    struct deep back = deep_make(REFOCUS_FORMAT_RGB_HALF, SIDE, SIDE);
    struct deep single = deep_make(REFOCUS_FORMAT_RGB_FLOAT, SIDE, SIDE);
    struct refocus_renderer *renderer;

    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        const uint16_t bits = (uint16_t)i;

        memcpy(deep_at(&half, i / 3 % SIDE, i / 3 / SIDE, i % 3), &bits, 2);
    }
    half.image.white = single.image.white = back.image.white =
        64; /* light is 1024 whites at most */
    renderer = deep_prepare_flat(&half.image, 5);
    assert_int_equal(deep_render(renderer, 1, 0, &single.image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        const int bits = i & 0xffff, exponent = bits >> 10 & 31, fraction = bits & 1023;
        const double value = exponent == 31 ? (fraction ? 0 : 65536)
                             : exponent     ? ldexp(1024 + fraction, exponent - 25)
                                            : ldexp(fraction, -24);

        assert_true((double)deep_get(&single, i / 3 % SIDE, i / 3 / SIDE, i % 3) ==
                    (bits >> 15 ? 0 : value));
    }
    renderer = deep_prepare_flat(&single.image, 5);
    assert_int_equal(deep_render(renderer, 1, 0, &back.image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        const int own = i & 0x7fff;
        const int expected = i & 0x8000 || own > 0x7c00 ? 0 : own == 0x7c00 ? 0x7bff : own;
        uint16_t bits;

        memcpy(&bits, deep_at(&back, i / 3 % SIDE, i / 3 / SIDE, i % 3), 2);
        assert_int_equal(bits, expected);
    }
    free(half.memory);
    free(single.memory);
    free(back.memory);
}

/* Threads and regions change no byte, nor does what was rendered before; 8-bit pictures of deep
 * photos and deep pictures of 8-bit photos are the same picture. */
TEST(same_bytes)
{
    struct picture p = picture_make(200, 150, 9);
    const struct refocus_disparity map = picture_disparity(&p);
    const struct refocus_image plain = picture_image(&p);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGBA_FLOAT, 200, 150);
    struct deep one = deep_make(REFOCUS_FORMAT_RGB16, 200, 150), other = one, part = one;
    struct refocus_renderer *single = deep_renderer(200, 150, 20, 1);
    struct refocus_renderer *many = deep_renderer(200, 150, 20, 4);
    struct refocus_settings region = refocus_settings_default(0.4f, 20);
    struct deep codes = deep_make(REFOCUS_FORMAT_BGRA8, 200, 150);

    other = deep_make(REFOCUS_FORMAT_RGB16, 200, 150);
    part = deep_make(REFOCUS_FORMAT_RGB16, 80, 50);
    for (int i = 0; i < 4 * 200 * 150; i++) {
        const int code = i % 4 == 3 ? i / 4 % 256 : p.rgb[i / 4 * 3 + i % 4];

        deep_put(&photo, i / 4 % 200, i / 800, i % 4,
                 i % 4 == 3
                     ? (float)code / 255
                     : (float)picture_light(code) * (code == 255 && i / 4 % 200 > 60 ? 5 : 1));
    }
    assert_int_equal(refocus_prepare(single, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_prepare(many, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(deep_render(single, 0.4f, 20, &one.image), REFOCUS_OK);
    assert_int_equal(deep_render(many, 0.9f, 13, &other.image), REFOCUS_OK);
    assert_int_equal(deep_render(many, 0.4f, 20, &other.image), REFOCUS_OK);
    assert_memory_equal(one.memory, other.memory, one.size);
    region.render.region_x = 64;
    region.render.region_y = 37;
    region.render.region_width = 80;
    region.render.region_height = 50;
    assert_int_equal(refocus_prepare(many, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(many, &region, &part.image), REFOCUS_OK);
    for (int y = 0; y < 50; y++)
        assert_memory_equal(deep_at(&one, 64, 37 + y, 0), deep_at(&part, 0, y, 0), 80 * 6);
    assert_int_equal(deep_render(single, 0.4f, 20, &codes.image), REFOCUS_OK);
    for (int i = 0; i < 3 * 200 * 150; i++)
        assert_in_range((int)(255 * deep_get(&one, i / 3 % 200, i / 600, i % 3) + 0.5f) + 1 -
                            *deep_at(&codes, i / 3 % 200, i / 600, 2 - i % 3),
                        0, 2);
    for (int i = 0; i < 200 * 150; i++)
        assert_int_equal(*deep_at(&codes, i % 200, i / 200, 3), i % 256);
    assert_int_equal(refocus_prepare(single, &plain, &map), REFOCUS_OK);
    assert_int_equal(deep_render(single, 0.4f, 0, &one.image), REFOCUS_OK);
    for (int i = 0; i < 3 * 200 * 150; i++)
        assert_int_equal((int)(255 * deep_get(&one, i / 3 % 200, i / 600, i % 3) + 0.5f), p.rgb[i]);
    refocus_renderer_destroy(&single);
    refocus_renderer_destroy(&many);
    free(photo.memory);
    free(one.memory);
    free(other.memory);
    free(part.memory);
    free(codes.memory);
    picture_free(&p);
}

/* Maps of another size, and edges that are placed, follow the photo: as they do that of 8 bits. */
TEST(maps)
{
    struct picture p = picture_make(160, 120, 5);
    const struct refocus_image plain = picture_image(&p);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, 160, 120);
    struct refocus_renderer *renderer = deep_renderer(160, 120, 10, 2);
    static uint16_t small[40 * 30], views[2][160 * 120];

    for (int i = 0; i < 3 * 160 * 120; i++)
        deep_put(&photo, i / 3 % 160, i / 480, i % 3, p.rgb[i] / 255.0f);
    for (int i = 0; i < 40 * 30; i++)
        small[i] = p.disparity[i / 40 * 4 * 160 + i % 40 * 4];
    for (int edges = 0; edges < 2; edges++) {
        const struct refocus_disparity full = picture_disparity(&p);
        const struct refocus_disparity map = edges ? full : refocus_disparity16(small, 40, 30, 80);

        for (int deep = 0; deep < 2; deep++) {
            struct refocus_scene scene = refocus_scene_default(deep ? &photo.image : &plain, &map);

            scene.depth_edges = edges ? REFOCUS_DEPTH_EDGES_AUTO : 0;
            assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
            assert_int_equal(
                refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, views[deep], 2 * 160),
                REFOCUS_OK);
        }
        assert_memory_equal(views[0], views[1], sizeof views[0]);
    }
    refocus_renderer_destroy(&renderer);
    free(photo.memory);
    picture_free(&p);
}

/* A deep photo is refused with what it cannot have. */
TEST(refusals)
{
    struct picture p = picture_make(40, 30, 1);
    const struct refocus_disparity map = picture_disparity(&p);
    const struct refocus_image plain = picture_image(&p);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB16, 40, 30);
    struct refocus_renderer *renderer = deep_renderer(40, 30, 5, 1), *shallow;
    struct refocus_renderer_params limits = refocus_renderer_params_default(40, 30, 5);
    struct refocus_settings s = refocus_settings_default(0.5f, 5);
    struct refocus_image bad;
    const uint32_t transfers[] = {7, UINT32_MAX};
    const float gammas[] = {0.5f, 6, -1, NAN, INFINITY},
                whites[] = {-1, 1e-6f, 1e6f, NAN, INFINITY};

#define REFUSED(status, call) assert_int_equal(call, REFOCUS_ERR_##status)
    for (int i = 0; i < 5; i++) {
        bad = photo.image;
        bad.transfer = transfers[i % 2];
        REFUSED(ARGUMENT, refocus_prepare(renderer, &bad, &map));
        bad = photo.image;
        bad.gamma = gammas[i];
        REFUSED(ARGUMENT, refocus_prepare(renderer, &bad, &map));
        bad = photo.image;
        bad.white = whites[i];
        REFUSED(ARGUMENT, refocus_prepare(renderer, &bad, &map));
    }
    bad = photo.image;
    bad.reserved = 1;
    REFUSED(ARGUMENT, refocus_prepare(renderer, &bad, &map));
    bad = plain;
    bad.transfer = REFOCUS_TRANSFER_LINEAR;
    REFUSED(ARGUMENT, refocus_prepare(renderer, &bad, &map));
    for (int k = 0; k < 2; k++) { /* renderers without memory for it */
        limits.in_place = k;
        limits.deep = k;
        assert_int_equal(refocus_renderer_create(&shallow, &limits), REFOCUS_OK);
        REFUSED(UNSUPPORTED, refocus_prepare(shallow, &photo.image, &map));
        assert_int_equal(refocus_prepare(shallow, &plain, &map), REFOCUS_OK);
        REFUSED(UNSUPPORTED, refocus_render_settings(shallow, &s, &photo.image));
        refocus_renderer_destroy(&shallow);
    }
    assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &s, &photo.image), REFOCUS_OK);
    s.render.blend = REFOCUS_BLEND_STORED;
    REFUSED(UNSUPPORTED, refocus_render_settings(renderer, &s, &plain));
    s = refocus_settings_default(0.5f, 5);
    s.render.sigma = 100;
    REFUSED(UNSUPPORTED, refocus_render_settings(renderer, &s, &plain));
    s = refocus_settings_default(0.5f, 5);
    s.look.grain = 1;
    REFUSED(UNSUPPORTED, refocus_render_settings(renderer, &s, &plain));
    s = refocus_settings_default(0.5f, 5);
    s.look.star_spikes = 6;
    REFUSED(UNSUPPORTED, refocus_render_settings(renderer, &s, &plain));
    refocus_renderer_destroy(&renderer);
    free(photo.memory);
    picture_free(&p);
}
