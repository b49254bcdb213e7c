/* test_depth_edges_same.c: edges of disparity maps come to the same on every processor, with any
 * number of threads, in every format and layout; and what the report says of itself. */
#include "edge_drawings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

TEST(reports_by_size)
{
    struct {
        struct refocus_depth_edges_report report;
        unsigned char more[8], guard;
    } larger;
    struct picture p = make(WIDTH, HEIGHT);
    struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = photo_of(&p);
    const struct refocus_disparity map = refocus_disparity16(p.map, WIDTH, HEIGHT, 2 * WIDTH);
    uint16_t *other = malloc(2 * WIDTH * HEIGHT);
    struct refocus_depth_edges_report known, untouched;

    assert_non_null(other);
    draw(&p, disc, 1);
    soften(&p, 2, 0);
    known = place(&p);
    assert_int_equal(known.struct_size, sizeof known);
    assert_true(known.changed > 0);

    /* A larger struct of a later program: zeros beyond what is known, and nothing beyond it. */
    memset(&larger, 0xa5, sizeof larger);
    larger.report.struct_size = sizeof known + sizeof larger.more;
    assert_int_equal(refocus_depth_edges(&photo, &map, &params, other, 2 * WIDTH, &larger.report),
                     REFOCUS_OK);
    assert_int_equal(larger.report.struct_size, sizeof known + sizeof larger.more);
    larger.report.struct_size = sizeof known;
    assert_memory_equal(&larger.report, &known, sizeof known);
    for (size_t i = 0; i < sizeof larger.more; i++)
        assert_int_equal(larger.more[i], 0);
    assert_int_equal(larger.guard, 0xa5);
    assert_memory_equal(other, p.out, 2 * WIDTH * HEIGHT);

    /* Without one the map is the same. */
    memset(other, 0, 2 * WIDTH * HEIGHT);
    assert_int_equal(refocus_depth_edges(&photo, &map, &params, other, 2 * WIDTH, NULL),
                     REFOCUS_OK);
    assert_memory_equal(other, p.out, 2 * WIDTH * HEIGHT);

    /* After an error it is as it was. */
    memset(&untouched, 0xa5, sizeof untouched);
    untouched.struct_size = sizeof untouched;
    larger.report = untouched;
    params.threads = 65;
    assert_int_equal(refocus_depth_edges(&photo, &map, &params, other, 2 * WIDTH, &larger.report),
                     REFOCUS_ERR_ARGUMENT);
    assert_memory_equal(&larger.report, &untouched, sizeof untouched);
    free(other);
    end(&p);
}

/* Photos of width x height, maps of columns x rows. */
static const int sizes[][4] = {
    {1, 1, 1, 1},     {1, 40, 1, 40},  {40, 1, 40, 1},     {3, 3, 3, 3},        {17, 23, 17, 23},
    {1, 1, 5, 4},     {40, 30, 1, 1},  {97, 61, 13, 29},   {60, 45, 130, 90},   {5, 64, 2, 63},
    {300, 20, 3, 20}, {16, 16, 40, 9}, {240, 180, 48, 36}, {151, 130, 151, 130}};
enum { SIZES = sizeof sizes / sizeof *sizes };
enum { SOFT_SURFACES, SHIFTED_SURFACES, CODES, EXTREMES, KINDS };

/* The map lies in p->map, packed. */
static struct picture make_any(const int size[4], int kind)
{
    const int most = size[0] * size[1] > size[2] * size[3] ? 0 : 1;
    struct picture p = make(most ? size[2] : size[0], most ? size[3] : size[1]);

    draw(&p, disc_and_wire, 1);
    if (kind == SHIFTED_SURFACES)
        displace(&p, disc_and_wire, 3, 2);
    for (int i = 0; i < size[2] * size[3]; i++) {
        const double x = (i % size[2] + 0.5) * size[0] / size[2];
        const double y = (i / size[2] + 0.5) * size[1] / size[3];
        const uint32_t random = random_bits();
        const int off = kind == SHIFTED_SURFACES ? 3 : 0;

        p.map[i] = (uint16_t)lrint(65535 * disc_and_wire(x - off, y - off).disparity);
        if (kind == CODES)
            p.map[i] = (uint16_t)random;
        if (kind == EXTREMES)
            p.map[i] = random & 1 ? 65535 : 0;
    }
    p.width = size[2];
    p.height = size[3];
    if (kind == SOFT_SURFACES)
        soften(&p, 2, 0.5);
    p.width = size[0];
    p.height = size[1];
    for (int i = 0; i < 3 * size[0] * size[1] && kind >= CODES; i++)
        p.rgb[i] = (uint8_t)(kind == CODES ? random_bits() : random_bits() & 1 ? 255 : 0);
    return p;
}

struct result {
    int status;
    struct refocus_depth_edges_report report;
};

static struct result run(const struct picture *p, const int size[4], uint32_t cpu, int threads,
                         uint16_t *out)
{
    struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = photo_of(p);
    const struct refocus_disparity map =
        refocus_disparity16(p->map, size[2], size[3], 2 * (ptrdiff_t)size[2]);
    struct result result = {0, refocus_depth_edges_report_default()};

    params.cpu = cpu;
    params.threads = threads;
    memset(out, 0xa5, 2 * (size_t)p->width * (size_t)p->height);
    result.status =
        refocus_depth_edges(&photo, &map, &params, out, 2 * (ptrdiff_t)p->width, &result.report);
    return result;
}

/* Every instruction set and any number of threads give equal bits, of the report too. */
TEST(same_everywhere)
{
    static const int threads[] = {1, 2, 5};

    for (int i = 0; i < SIZES * KINDS; i++) {
        const int *size = sizes[i / KINDS];
        struct picture p = make_any(size, i % KINDS);
        const struct result plain = run(&p, size, REFOCUS_CPU_C, 1, p.exact);
        const size_t bytes = 2 * (size_t)p.width * (size_t)p.height;

        assert_int_equal(plain.status, REFOCUS_OK);
        for (uint32_t cpu = REFOCUS_CPU_AUTO; refocus_cpu_name(cpu); cpu++)
            for (int k = 0; k < 3; k++) {
                const struct result result = run(&p, size, cpu, threads[k], p.out);

                if (result.status == REFOCUS_ERR_UNSUPPORTED)
                    continue;
                assert_int_equal(result.status, REFOCUS_OK);
                if (memcmp(p.exact, p.out, bytes) ||
                    memcmp(&result.report, &plain.report, sizeof plain.report))
                    fail_msg("%s, %d threads, kind %d, %dx%d from %dx%d", refocus_cpu_name(cpu),
                             threads[k], i % KINDS, size[0], size[1], size[2], size[3]);
            }
        end(&p);
    }
}

/* Copies rows bottom-up and with a gap behind each; the first row is the last of the copy. */
static uint8_t *turn(const void *rows, size_t bytes, size_t gap, int height)
{
    const size_t stride = bytes + gap, n = (size_t)height;
    uint8_t *copy = malloc(stride * n);

    assert_non_null(copy);
    memset(copy, 0x5a, stride * n);
    for (size_t y = 0; y < n; y++)
        memcpy(copy + (n - 1 - y) * stride, (const uint8_t *)rows + y * bytes, bytes);
    return copy;
}

/* Rows that lie bottom-up and apart, in another order of colours, come to the same; what lies
 * between the rows of the result is left alone. */
TEST(same_by_other_ways)
{
    enum { GAP = 6 };
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();

    for (int i = 0; i < SIZES * KINDS; i++) {
        const int *size = sizes[i / KINDS];
        struct picture p = make_any(size, i % KINDS);
        const ptrdiff_t wide = 3 * size[0] + GAP, deep = 2 * size[2] + GAP, out = 2 * size[0] + GAP;
        uint8_t *rgb, *map, *turned;
        struct refocus_image photo;
        struct refocus_disparity disparity;

        assert_int_equal(run(&p, size, REFOCUS_CPU_AUTO, 2, p.out).status, REFOCUS_OK);
        for (int k = 0; k < size[0] * size[1]; k++) {
            const uint8_t red = p.rgb[3 * k];

            p.rgb[3 * k] = p.rgb[3 * k + 2];
            p.rgb[3 * k + 2] = red;
        }
        rgb = turn(p.rgb, 3 * (size_t)size[0], GAP, size[1]);
        map = turn(p.map, 2 * (size_t)size[2], GAP, size[3]);
        turned = turn(p.exact, 2 * (size_t)size[0], GAP, size[1]);
        photo = refocus_image_packed(REFOCUS_FORMAT_BGR8, rgb + wide * (size[1] - 1), size[0],
                                     size[1], -wide);
        disparity = refocus_disparity16((uint16_t *)(void *)(map + deep * (size[3] - 1)), size[2],
                                        size[3], -deep);
        assert_int_equal(refocus_depth_edges(&photo, &disparity, &params,
                                             (uint16_t *)(void *)(turned + out * (size[1] - 1)),
                                             -out, NULL),
                         REFOCUS_OK);
        for (int y = 0; y < size[1]; y++) {
            const uint8_t *row = turned + out * (size[1] - 1 - y);

            assert_memory_equal(row, p.out + y * size[0], 2 * (size_t)size[0]);
            for (int k = 0; k < GAP; k++)
                assert_int_equal(row[2 * size[0] + k], 0x5a);
        }
        free(rgb);
        free(map);
        free(turned);
        end(&p);
    }
}

/* ----- photos of Y, U and V ----- */

/* Y of each pixel, and U and V of the even ones. Full range, BT.601. */
static struct refocus_image codes_of(const struct picture *p, uint32_t format, uint8_t *codes)
{
    struct refocus_image photo = refocus_image_planar(format, codes, p->width, p->height);
    const int down = format == REFOCUS_FORMAT_YUYV ? 0 : 1;

    photo.range = REFOCUS_RANGE_FULL;
    for (int i = 0; i < p->width * p->height; i++) {
        const int x = i % p->width, y = i / p->width, pair = x / 2;
        const uint8_t *rgb = p->rgb + (ptrdiff_t)3 * ((y & ~down) * p->width + (x & ~1));
        const double luma = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
        const double u = 128 + (rgb[2] - luma) / 1.772, v = 128 + (rgb[0] - luma) / 1.402;
        const uint8_t code[2] = {(uint8_t)lrint(u), (uint8_t)lrint(v)};
        uint8_t *row[3];

        for (int k = 0; k < 3; k++)
            row[k] = photo.plane[k] ? photo.plane[k] + (k ? y >> down : y) * photo.stride[k] : NULL;
        row[0][format == REFOCUS_FORMAT_YUYV ? 2 * x : x] = (uint8_t)lrint(
            0.299 * p->rgb[3 * i] + 0.587 * p->rgb[3 * i + 1] + 0.114 * p->rgb[3 * i + 2]);
        for (int k = 0; k < 2; k++) {
            if (format == REFOCUS_FORMAT_YUYV)
                row[0][4 * pair + 1 + 2 * k] = code[k];
            else if (format == REFOCUS_FORMAT_I420)
                row[1 + k][pair] = code[k];
            else
                row[1][2 * pair + (format == REFOCUS_FORMAT_NV12 ? k : 1 - k)] = code[k];
        }
    }
    return photo;
}

static void place_by_codes(const struct picture *p, uint32_t format, uint16_t *out)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    uint8_t *codes = calloc((size_t)p->width + 1, (size_t)p->height * 3);
    struct refocus_disparity map =
        refocus_disparity16(p->map, p->width, p->height, 2 * (ptrdiff_t)p->width);
    struct refocus_image photo;

    assert_non_null(codes);
    photo = codes_of(p, format, codes);
    assert_int_equal(refocus_depth_edges(&photo, &map, &params, out, 2 * (ptrdiff_t)p->width, NULL),
                     REFOCUS_OK);
    free(codes);
}

/* Formats that share chroma alike come to the same; grey ones to that of R, G and B. */
TEST(luma_and_chroma)
{
    for (int i = 0; i < 2; i++) {
        struct picture p = make(WIDTH - i, HEIGHT - i);
        const size_t bytes = 2 * (size_t)p.width * (size_t)p.height;
        uint16_t *first = malloc(bytes);

        assert_non_null(first);
        draw(&p, disc, 1);
        soften(&p, 2, 0);
        place_by_codes(&p, REFOCUS_FORMAT_NV12, first);
        assert_true(share_within(&p, first, 0.02) >= 0.995);
        place_by_codes(&p, REFOCUS_FORMAT_NV21, p.out);
        assert_memory_equal(p.out, first, bytes);
        place_by_codes(&p, REFOCUS_FORMAT_I420, p.out);
        assert_memory_equal(p.out, first, bytes);
        place_by_codes(&p, REFOCUS_FORMAT_YUYV, p.out);
        assert_true(share_within(&p, p.out, 0.02) >= 0.995);
        for (int k = 0; k < p.width * p.height; k++)
            p.rgb[3 * k] = p.rgb[3 * k + 2] = p.rgb[3 * k + 1];
        place(&p);
        memcpy(first, p.out, bytes);
        for (uint32_t format = REFOCUS_FORMAT_NV12; format <= REFOCUS_FORMAT_YUYV; format++) {
            place_by_codes(&p, format, p.out);
            assert_memory_equal(p.out, first, bytes);
        }
        free(first);
        end(&p);
    }
}
