/* test_deep_yuv.c: photos of P010 and P016: what nothing changes comes back in full, colours are
 * what the standards say, light above white is drawn with all it has, what is refused. */
#include "deep_pictures.h"

static const double kr[] = {0.299, 0.2126, 0.2627}, kb[] = {0.114, 0.0722, 0.0593};

struct p016 {
    struct refocus_image image;
    uint8_t *memory;
    size_t size;
};

static struct p016 p016_make(uint32_t format, int width, int height)
{
    struct p016 p = {.size = (size_t)refocus_image_bytes(format, width, height)};

    p.memory = calloc(1, p.size + 1);
    assert_non_null(p.memory);
    p.image = refocus_image_planar(format, p.memory + 1, width, height); /* at an odd address */
    return p;
}

/* Codes of a plane: Y, or U and V of a pair. */
static uint16_t code_at(const struct p016 *p, int plane, int x, int y, int i)
{
    uint16_t code;

    memcpy(&code,
           p->image.plane[plane] + y * p->image.stride[plane] + (plane ? 4 : 2) * (ptrdiff_t)x +
               2 * (ptrdiff_t)i,
           2);
    return code;
}

static void put_code(const struct p016 *p, int plane, int x, int y, int i, double code)
{
    const int step = p->image.format == REFOCUS_FORMAT_P010 ? 64 : 1;
    const uint16_t bits = (uint16_t)(step * (int)fmin(fmax(code, 0) / step + 0.5, 65535 / step));

    memcpy(p->image.plane[plane] + y * p->image.stride[plane] + (plane ? 4 : 2) * (ptrdiff_t)x +
               2 * (ptrdiff_t)i,
           &bits, 2);
}

/* BT.2100: codes Y, U, V of values of R, G and B. */
static void codes_of(const struct refocus_image *image, const double rgb[3], double yuv[3])
{
    const bool full = image->range == REFOCUS_RANGE_FULL;
    const double most = image->format == REFOCUS_FORMAT_P010 ? 65472 : 65535;
    const double r = kr[image->matrix], b = kb[image->matrix];
    const double y = r * rgb[0] + (1 - r - b) * rgb[1] + b * rgb[2];

    yuv[0] = full ? y * most : 256 * (219 * y + 16);
    yuv[1] = (rgb[2] - y) / (2 - 2 * b) * (full ? most : 256 * 224) + 256 * 128;
    yuv[2] = (rgb[0] - y) / (2 - 2 * r) * (full ? most : 256 * 224) + 256 * 128;
}

/* Fills the pixels x0 <= x < x1 of rows y0 <= y < y1, all even. */
static void fill(const struct p016 *p, int x0, int y0, int x1, int y1, const double rgb[3])
{
    double yuv[3];

    codes_of(&p->image, rgb, yuv);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            put_code(p, 0, x, y, 0, yuv[0]);
            put_code(p, 1, x / 2, y / 2, 0, yuv[1]);
            put_code(p, 1, x / 2, y / 2, 1, yuv[2]);
        }
}

static void randomise(const struct p016 *p, uint32_t seed)
{
    for (size_t i = 0; i < p->size; i++)
        p->memory[1 + i] = (uint8_t)((seed = seed * 1664525 + 1013904223) >> 24);
}

/* Any bits come back where nothing is blurred, and most of them where little is; of odd sizes, too.
 */
TEST(in_focus)
{
    struct picture p = picture_make(97, 61, 3);
    const struct refocus_disparity map = picture_disparity(&p);
    struct refocus_renderer *renderer = deep_renderer(97, 61, 12, 2);

    for (uint32_t format = REFOCUS_FORMAT_P010; format <= REFOCUS_FORMAT_P016; format++)
        for (uint32_t kind = 0; kind < 6; kind++) {
            struct p016 photo = p016_make(format, 97, 61), out = p016_make(format, 97, 61);
            int same = 0;

            photo.image.matrix = out.image.matrix = kind % 3;
            photo.image.range = out.image.range = kind / 3;
            photo.image.transfer = out.image.transfer = 1 + kind;
            randomise(&photo, format + kind);
            assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
            assert_int_equal(deep_render(renderer, 0.5f, 0, &out.image), REFOCUS_OK);
            assert_memory_equal(photo.memory, out.memory, photo.size);
            memset(out.memory, 0, out.size);
            assert_int_equal(deep_render(renderer, 0, 1, &out.image), REFOCUS_OK);
            for (int i = 0; i < 97 * 61; i++)
                same +=
                    code_at(&photo, 0, i % 97, i / 97, 0) == code_at(&out, 0, i % 97, i / 97, 0);
            assert_in_range(same, 97 * 61 / 8, 97 * 61);
            free(photo.memory);
            free(out.memory);
        }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Colours become R, G and B of the standards, and come from them; also in the corner of an odd
 * picture, where a sample of chroma has one pixel. */
TEST(colours)
{
    enum { SIDE = 15 };
    static const double rgb[][3] = {{0, 0, 0}, {1, 1, 1},       {1, 0, 0},      {0, 1, 0},
                                    {0, 0, 1}, {0.2, 0.6, 0.4}, {0.9, 0.5, 0.1}};

    for (int kind = 0; kind < 12; kind++)
        for (size_t i = 0; i < sizeof rgb / sizeof *rgb; i++) {
            const uint32_t format = kind % 2 ? REFOCUS_FORMAT_P010 : REFOCUS_FORMAT_P016;
            const double within = format == REFOCUS_FORMAT_P010 ? 2.5 / 876 : 1e-3;
            struct p016 photo = p016_make(format, SIDE, SIDE);
            struct p016 back = p016_make(format, SIDE, SIDE);
            float values[SIDE * SIDE * 3];
            struct refocus_image floats =
                refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, values, SIDE, SIDE, 12 * SIDE);
            struct refocus_renderer *renderer;

            photo.image.matrix = back.image.matrix = (uint32_t)(kind / 2 % 3);
            photo.image.range = back.image.range = (uint32_t)(kind / 6);
            photo.image.transfer = back.image.transfer = REFOCUS_TRANSFER_LINEAR;
            fill(&photo, 0, 0, SIDE, SIDE, rgb[i]);
            renderer = deep_prepare_flat(&photo.image, 5);
            assert_int_equal(deep_render(renderer, 1, 0, &floats), REFOCUS_OK);
            refocus_renderer_destroy(&renderer);
            for (int c = 0; c < 3; c++)
                if (fabs((double)values[3 * 100 + c] - rgb[i][c]) > within)
                    fail_msg("kind %d, colour %zu: channel %d is %g", kind, i, c,
                             (double)values[3 * 100 + c]);
            renderer = deep_prepare_flat(&floats, 5);
            assert_int_equal(deep_render(renderer, 1, 0, &back.image), REFOCUS_OK);
            refocus_renderer_destroy(&renderer);
            for (int k = 0; k < 6; k++) { /* Y, U and V, inside and in the corner */
                const int plane = k / 2 > 0, j = k / 2 == 2, at = k % 2 == 0 ? 3 : SIDE >> plane;

                assert_in_range(code_at(&back, plane, at - !plane, at - !plane, j) + 128 -
                                    code_at(&photo, plane, at - !plane, at - !plane, j),
                                128 - (kind % 2 ? 64 : 16), 128 + (kind % 2 ? 64 : 16));
            }
            free(photo.memory);
            free(back.memory);
        }
}

/* A lamp in PQ, some 16 times white, has all its light out of focus, and none is lost on the way
 * back into codes. */
TEST(lamp)
{
    enum { W = 160, H = 160, SIDE = 8 };

    for (uint32_t format = REFOCUS_FORMAT_P010; format <= REFOCUS_FORMAT_P016; format++) {
        const double dim[3] = {0.3, 0.3, 0.3}, bright[3] = {0.86, 0.86, 0.86};
        struct p016 photo = p016_make(format, W, H), out = p016_make(format, W, H);
        struct refocus_image floats = refocus_image_packed(
            REFOCUS_FORMAT_RGB_FLOAT, calloc(W * H, 12), W, H, 12 * (ptrdiff_t)W);
        double light[2] = {0, 0}, sum = 0, codes = 0;
        struct refocus_renderer *renderer;

        photo.image.transfer = out.image.transfer = REFOCUS_TRANSFER_PQ;
        photo.image.matrix = out.image.matrix = REFOCUS_MATRIX_BT2020;
        fill(&photo, 0, 0, W, H, dim);
        fill(&photo, 76, 76, 76 + SIDE, 76 + SIDE, bright);
        renderer = deep_prepare_flat(&photo.image, 20);
        for (int blurred = 0; blurred < 2; blurred++) {
            float *const values = (float *)(void *)floats.plane[0];

            assert_int_equal(deep_render(renderer, blurred ? 1 : 0, 20, &floats), REFOCUS_OK);
            light[0] = (double)values[3 * (W + 1)];
            light[1] = blurred ? light[1] : (double)values[3 * (80 * W + 80)];
            sum = 0;
            for (int i = 0; i < W * H; i++)
                sum += (double)values[3 * i + 1] - light[0];
            if (fabs(sum / (SIDE * SIDE * (light[1] - light[0])) - 1) > 0.01)
                fail_msg("format %u has %.4f of its light", (unsigned)format,
                         sum / (SIDE * SIDE * (light[1] - light[0])));
        }
        assert_true(light[1] > 10);
        assert_int_equal(deep_render(renderer, 1, 20, &out.image), REFOCUS_OK);
        refocus_renderer_destroy(&renderer);
        renderer = deep_prepare_flat(&out.image, 20);
        assert_int_equal(deep_render(renderer, 0, 20, &floats), REFOCUS_OK);
        refocus_renderer_destroy(&renderer);
        for (int i = 0; i < W * H; i++)
            codes += (double)((float *)(void *)floats.plane[0])[3 * i + 1] - light[0];
        assert_true(fabs(codes / sum - 1) < 0.02);
        free(floats.plane[0]);
        free(photo.memory);
        free(out.memory);
    }
}

/* Threads and regions change no byte. */
TEST(same_bytes)
{
    struct picture p = picture_make(120, 90, 9);
    const struct refocus_disparity map = picture_disparity(&p);
    struct p016 photo = p016_make(REFOCUS_FORMAT_P010, 120, 90);
    struct p016 one = p016_make(REFOCUS_FORMAT_P010, 120, 90);
    struct p016 other = p016_make(REFOCUS_FORMAT_P010, 120, 90);
    struct p016 part = p016_make(REFOCUS_FORMAT_P010, 60, 44);
    struct refocus_renderer *single = deep_renderer(120, 90, 20, 1);
    struct refocus_renderer *many = deep_renderer(120, 90, 20, 4);
    struct refocus_settings region = refocus_settings_default(0.4f, 20);

    randomise(&photo, 4);
    assert_int_equal(refocus_prepare(single, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_prepare(many, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(deep_render(single, 0.4f, 20, &one.image), REFOCUS_OK);
    assert_int_equal(deep_render(many, 0.4f, 20, &other.image), REFOCUS_OK);
    assert_memory_equal(one.memory, other.memory, one.size);
    region.render.region_x = 38;
    region.render.region_y = 22;
    region.render.region_width = 60;
    region.render.region_height = 44;
    assert_int_equal(refocus_render_settings(many, &region, &part.image), REFOCUS_OK);
    for (int y = 0; y < 44; y++)
        for (int plane = 0; plane <= y % 2; plane++)
            assert_memory_equal(part.image.plane[plane] + (y >> plane) * part.image.stride[plane],
                                one.image.plane[plane] +
                                    ((22 + y) >> plane) * one.image.stride[plane] + 2 * 38,
                                120);
    region.render.region_x = 37;
    assert_int_equal(refocus_render_settings(many, &region, &part.image), REFOCUS_ERR_ARGUMENT);
    region.render.region_x = 38;
    region.render.region_y = 21;
    assert_int_equal(refocus_render_settings(many, &region, &part.image), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(&single);
    refocus_renderer_destroy(&many);
    free(photo.memory);
    free(one.memory);
    free(other.memory);
    free(part.memory);
    picture_free(&p);
}

/* Sizes, and what is refused. */
TEST(refusals)
{
    struct picture p = picture_make(40, 30, 1);
    const struct refocus_disparity map = picture_disparity(&p);
    const struct refocus_image plain = picture_image(&p);
    struct p016 photo = p016_make(REFOCUS_FORMAT_P010, 40, 30);
    struct p016 nv12 = p016_make(REFOCUS_FORMAT_NV12, 40, 30);
    struct refocus_renderer *renderer = deep_renderer(40, 30, 5, 1);
    struct refocus_image bad;

    assert_int_equal(refocus_image_bytes(REFOCUS_FORMAT_P010, 5, 3), 2 * 5 * 3 + 4 * 3 * 2);
    assert_int_equal(refocus_format_is_yuv(REFOCUS_FORMAT_P016), 1);
    for (int i = 0; i < 6; i++) {
        bad = photo.image;
        *(i == 0   ? &bad.matrix
          : i == 1 ? &bad.range
          : i == 2 ? &bad.transfer
                   : &bad.reserved) = i == 0   ? 3
                                      : i == 1 ? 2
                                      : i == 2 ? 7
                                               : 1;
        if (i == 4)
            bad.plane[1] = NULL;
        if (i == 5)
            bad.stride[1] = 79;
        bad.reserved = i == 3;
        assert_int_equal(refocus_prepare(renderer, &bad, &map), REFOCUS_ERR_ARGUMENT);
    }
    nv12.image.matrix = REFOCUS_MATRIX_BT2020;
    assert_int_equal(refocus_prepare(renderer, &nv12.image, &map), REFOCUS_ERR_ARGUMENT);
    nv12.image.matrix = REFOCUS_MATRIX_BT709;
    assert_int_equal(refocus_prepare(renderer, &nv12.image, &map), REFOCUS_OK);
    assert_int_equal(deep_render(renderer, 0.5f, 5, &photo.image), REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
    assert_int_equal(deep_render(renderer, 0.5f, 5, &nv12.image), REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(deep_render(renderer, 0.5f, 5, &plain), REFOCUS_OK);
    assert_int_equal(deep_render(renderer, 0.5f, 5, &photo.image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    free(photo.memory);
    free(nv12.memory);
    picture_free(&p);
}
