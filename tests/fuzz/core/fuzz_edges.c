/* fuzz_edges.c: refocus_depth_edges() on any photo and map: the status is a documented one, the
 * findings are in their ranges, nothing outside the result is written, other processors and numbers
 * of threads give the same bytes, and a map that nothing was done to is as it was. Most pictures
 * are small, and seen by one processor (draw.h). */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "draw.h"

enum { SMALL_SIDE = 24, MAX_SIDE = 72, GUARD = 64, MOST = MAX_SIDE * MAX_SIDE };

/* Rest of the input; it reads as 0 for ever after its end. */
struct input {
    const uint8_t *data;
    size_t size;
};

static uint32_t take(struct input *in, int bytes)
{
    uint32_t value = 0;

    while (bytes-- > 0 && in->size > 0) {
        value = value << 8 | *in->data++;
        in->size--;
    }
    return value;
}

static int take_in(struct input *in, int low, int high)
{
    return low + (int)(take(in, 1) % (uint32_t)(high - low + 1));
}

static int take_side(struct input *in, int most)
{
    const int side = take_in(in, 1, MAX_SIDE);

    return side <= most ? side : 1 + (side - 1) % most;
}

static void check(int condition)
{
    if (!condition)
        abort();
}

/* Each cell of the view, of 256 x 256 at the finest, has a byte of the input. */
struct cells {
    const struct input *in;
    int side; /* a cell is so wide, in 1/256 of the view */
    int right, down;
};

static uint8_t cell_at(const struct cells *cells, int x, int y, int width, int height)
{
    const int u = (x * 256 / width + 256 - cells->right) / cells->side;
    const int v = (y * 256 / height + 256 - cells->down) / cells->side;
    const size_t i = (size_t)v * 37 + (size_t)u;

    return cells->in->size ? cells->in->data[i % cells->in->size] : (uint8_t)(i * 91);
}

/* Means of the sample and `reach` ones to its right: ramps. */
static void soften(uint16_t *map, int width, int height, int reach)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint32_t sum = 0;

            for (int k = 0; k <= reach; k++)
                sum += map[y * width + (x + k < width ? x + k : width - 1)];
            map[y * width + x] = (uint16_t)(sum / (uint32_t)(reach + 1));
        }
}

struct job {
    struct refocus_image photo;
    struct refocus_disparity map;
    struct refocus_depth_edges_params params;
};

/* The result goes behind GUARD elements of `out`. */
static int run(const struct job *job, uint16_t *out, struct refocus_depth_edges_report *report)
{
    const int pixels = job->photo.width * job->photo.height;
    int status;

    memset(out, 0xa5, (size_t)(pixels + 2 * GUARD) * sizeof *out);
    *report = refocus_depth_edges_report_default();
    status = refocus_depth_edges(&job->photo, &job->map, &job->params, out + GUARD,
                                 2 * (ptrdiff_t)job->photo.width, report);
    for (int i = 0; i < GUARD; i++)
        check(out[i] == 0xa5a5 && out[GUARD + pixels + i] == 0xa5a5);
    return status;
}

static void check_report(const struct refocus_depth_edges_report *report)
{
    check(report->struct_size == sizeof *report);
    check(report->softness >= 0 && report->softness <= 7 * MAX_SIDE);
    check(report->on_photo >= 0 && report->on_photo <= 1);
    check(fabsf(report->grown) <= 6 * MAX_SIDE && fabsf(report->shift_x) <= 5 * MAX_SIDE &&
          fabsf(report->shift_y) <= 5 * MAX_SIDE);
    check(report->bent <= 1 && report->parted <= 1);
    check(report->changed >= 0 && report->changed <= 1);
    check(report->noise >= 0 && report->noise <= 1);
    check(report->specks >= 0 && report->specks <= 1);
}

static uint16_t code_at(const struct refocus_disparity *map, int i)
{
    return (uint16_t)(map->bits == 16 ? ((const uint16_t *)map->samples)[i]
                                      : ((const uint8_t *)map->samples)[i] * 257);
}

static void check_untouched(const struct job *job, const struct refocus_depth_edges_report *report,
                            const uint16_t *out)
{
    if (job->map.width != job->photo.width || job->map.height != job->photo.height ||
        report->parted || report->bent || report->grown != 0 || report->shift_x != 0 ||
        report->shift_y != 0 || report->noise != 0 || report->specks != 0)
        return;
    check(report->changed == 0);
    for (int i = 0; i < job->map.width * job->map.height; i++)
        check(out[i] == code_at(&job->map, i));
}

/* Parameters of which each may be anything. */
static void run_wild(struct job *job, struct input *in, uint16_t *out)
{
    struct refocus_depth_edges_report report;
    const uint32_t which = take(in, 1);
    int status;

    job->params.threads = which & 1 ? (int32_t)take(in, 4) : 1;
    job->params.cpu = which & 2 ? take(in, 4) : 0;
    job->params.reserved = which & 4 ? take(in, 4) : 0;
    job->params.struct_size = which & 8 ? take(in, 1) : sizeof job->params;
    if (job->params.struct_size > sizeof job->params)
        job->params.struct_size = 0; /* nothing lies behind it here */
    if (job->params.threads > 8 && job->params.threads <= INT32_MAX - 64)
        job->params.threads += 64;
    status = run(job, out, &report);
    check(status == REFOCUS_OK || status == REFOCUS_ERR_ARGUMENT ||
          status == REFOCUS_ERR_UNSUPPORTED || status == REFOCUS_ERR_THREAD);
    job->params = refocus_depth_edges_params_default();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t pixels[4 * MOST], codes[MOST];
    static uint16_t map[MOST], out[2][MOST + 2 * GUARD];
    const uint32_t drawn = draw(&data, &size);
    const int most = drawn >> 28 ? SMALL_SIDE : MAX_SIDE, twice = !(drawn >> 25 & 7);
    struct input in = {data, size};
    const uint32_t flags = take(&in, 1);
    const int width = take_side(&in, most), height = take_side(&in, most);
    const int dw = take_side(&in, most), dh = take_side(&in, most);
    const int columns = flags & 1 ? width : dw, rows = flags & 1 ? height : dh;
    const int is_16 = flags >> 1 & 1, reach = take_in(&in, 0, 12), noise = take_in(&in, 0, 40);
    const struct cells surfaces = {&in, take_in(&in, 1, 128), 0, 0};
    const struct cells moved = {&in, surfaces.side, take_in(&in, 0, 32), take_in(&in, 0, 32)};
    const uint32_t format = 1 + (flags >> 2 & 3) + (flags >> 6 & 1) * 4;
    const int bytes = (int)refocus_image_bytes(format, width, height);
    const int per_pixel = refocus_format_is_yuv(format) ? 1 : refocus_format_bytes(format);
    struct refocus_depth_edges_report report[2];
    struct job job = {.params = refocus_depth_edges_params_default()};

    job.photo = refocus_image_planar(format, pixels, width, height);
    job.photo.matrix = flags >> 7 & 1;
    job.photo.range = flags >> 1 & 1;
    job.map = refocus_disparity16(map, columns, rows, (ptrdiff_t)columns * 2);
    if (flags >> 4 & 1)
        run_wild(&job, &in, out[0]);
    for (int i = 0; i < bytes; i++) {
        const int at = i / per_pixel % (width * height);
        const uint8_t cell = cell_at(&surfaces, at % width, at / width, width, height);

        pixels[i] = (uint8_t)(cell * (3 + 2 * (i % per_pixel)) + i * 29 % (noise + 1));
    }
    for (int i = 0; i < columns * rows; i++)
        map[i] = (uint16_t)(cell_at(&moved, i % columns, i / columns, columns, rows) * 257);
    soften(map, columns, rows, reach);
    for (int i = 0; i < columns * rows; i++)
        codes[i] = (uint8_t)(map[i] >> 8);
    if (!is_16) {
        job.map.samples = codes;
        job.map.bits = 8;
        job.map.stride = columns;
    }
    job.params.cpu = REFOCUS_CPU_AUTO;
    job.params.threads = 1;
    check(run(&job, out[0], &report[0]) == REFOCUS_OK);
    check_report(&report[0]);
    check_untouched(&job, &report[0], out[0] + GUARD);
    if (!twice)
        return 0;
    job.params.cpu = REFOCUS_CPU_C;
    job.params.threads = flags >> 5 & 1 ? 3 : 1;
    check(run(&job, out[1], &report[1]) == REFOCUS_OK);
    check(memcmp(out[0], out[1], (size_t)(width * height + 2 * GUARD) * sizeof **out) == 0);
    check(memcmp(&report[0], &report[1], sizeof report[0]) == 0);
    return 0;
}
