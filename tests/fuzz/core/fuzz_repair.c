/* fuzz_repair.c: refocus_depth_repair() of any map, with any photo: the status is a documented one,
 * nothing outside the results is written, memory of the caller gives the same bytes, a photo
 * changes nothing but what is filled, and the report counts that. */
#include <refocus/refocus.h>

#include "input.h"

enum { MAX_SIDE = 40, MOST = MAX_SIDE * MAX_SIDE, GUARD = 16, WRITTEN = 0xa5 };

struct job {
    struct refocus_depth_map map;
    struct refocus_repair_params params;
    struct refocus_image photo;
};

/* The bytes that a call leaves. */
struct result {
    uint16_t disparity[MOST + 2 * GUARD];
    uint8_t confidence[MOST + 2 * GUARD];
    struct refocus_depth_report report;
    int status;
};

static void take_map(struct input *in, int wild, struct refocus_depth_map *map)
{
    map->sample = (uint32_t)take_in(in, wild, 1, 3);
    map->width = take_in(in, 0, 1, MAX_SIDE);
    map->height = take_in(in, 0, 1, MAX_SIDE);
    map->meaning = (uint32_t)take_in(in, wild, 1, 2);
    map->flags = (uint32_t)take_in(in, wild, 0, 7);
    map->value_near = take_in(in, wild, 0, 255);
    map->value_far = take_in(in, wild, 0, 255);
    map->metres_per_unit = (double)take_fraction(in, wild, 1);
    map->metres_at_zero = (double)take_fraction(in, wild, 1);
    map->near_m = take_in(in, wild, 0, 3);
    map->far_m = map->near_m + take_in(in, wild, 0, 60);
    map->unknown_count = take_in(in, wild, 0, REFOCUS_DEPTH_MOST_UNKNOWN);
    for (int i = 0; i < REFOCUS_DEPTH_MOST_UNKNOWN; i++)
        map->unknown[i] = take_in(in, wild, 0, 255);
}

/* Rows of the photo, which has packed formats mostly, may go up. */
static void take_photo(struct input *in, int wild, struct refocus_image *photo, uint8_t *pixels)
{
    const uint32_t format = (uint32_t)take_in(in, 0, 1, wild ? REFOCUS_FORMAT_P016 : 4);
    const int width = take_in(in, 0, 1, MAX_SIDE), height = take_in(in, 0, 1, MAX_SIDE);

    *photo = refocus_image_planar(format, pixels, width, height);
    if (take_in(in, 0, 0, 1) && refocus_format_planes(format) == 1) {
        photo->plane[0] += photo->stride[0] * (height - 1);
        photo->stride[0] = -photo->stride[0];
    }
}

static void check_guards(const struct result *result, int samples)
{
    for (int i = 0; i < GUARD; i++) {
        check(result->disparity[i] == WRITTEN * 257);
        check(result->disparity[GUARD + samples + i] == WRITTEN * 257);
        check(result->confidence[i] == WRITTEN);
        check(result->confidence[GUARD + samples + i] == WRITTEN);
    }
}

static void check_report(const struct result *result, int samples)
{
    const struct refocus_depth_report *const report = &result->report;
    uint64_t filled = 0;

    for (int i = 0; i < samples; i++) {
        check(result->confidence[GUARD + i] % 255 == 0);
        filled += result->confidence[GUARD + i] == 0;
    }
    check(filled == report->unknown + report->specks + report->strays);
    check(filled < (uint64_t)samples);
}

static void run(const struct job *job, const struct refocus_image *photo, struct result *result)
{
    struct refocus_repair_params params = job->params;
    const int samples = job->map.width * job->map.height;

    memset(result, WRITTEN, sizeof *result);
    result->report = refocus_depth_report_default();
    params.confidence = result->confidence + GUARD;
    params.confidence_stride = job->map.width;
    params.photo = photo;
    result->status = refocus_depth_repair(&job->map, &params, result->disparity + GUARD,
                                          2 * (ptrdiff_t)job->map.width, &result->report);
    check(result->status == REFOCUS_OK || result->status == REFOCUS_ERR_ARGUMENT ||
          result->status == REFOCUS_ERR_UNSUPPORTED || result->status == REFOCUS_ERR_NO_DEPTH);
    check_guards(result, samples);
    if (result->status == REFOCUS_OK)
        check_report(result, samples);
}

/* Does the same in memory of its exact size, so that a sanitizer sees what is beyond. */
static void check_memory(struct job *job, const struct result *expected)
{
    static struct result again;
    const uint64_t bytes =
        refocus_repair_memory(job->map.width, job->map.height, job->params.speckle) +
        (uint64_t)job->map.width * (uint64_t)job->map.height * 6;

    job->params.memory_bytes = (size_t)bytes;
    job->params.memory = malloc(job->params.memory_bytes);
    check(job->params.memory != NULL);
    run(job, &job->photo, &again);
    free(job->params.memory);
    job->params.memory = NULL;
    check(memcmp(&again, expected, sizeof again) == 0);
}

static void check_known(const struct result *a, const struct result *b, int samples)
{
    check(memcmp(&a->report, &b->report, sizeof a->report) == 0);
    check(memcmp(a->confidence, b->confidence, sizeof a->confidence) == 0);
    for (int i = GUARD; i < GUARD + samples; i++)
        check(a->confidence[i] == 0 || a->disparity[i] == b->disparity[i]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static float samples[MOST];
    static uint8_t pixels[16 * MOST];
    static struct result with, without;
    struct input in = {data, size};
    const int wild = take(&in, 1) % 8 == 7;
    struct job job = {refocus_depth_map_default(), refocus_repair_params_default(), {0}};

    take_map(&in, wild, &job.map);
    job.params.speckle = take_in(&in, wild, 0, 30);
    take_photo(&in, wild, &job.photo, pixels);
    for (size_t i = 0; i < sizeof samples; i++)
        ((uint8_t *)samples)[i] = in.size ? in.data[i % in.size] : (uint8_t)(i * 37);
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = in.size ? in.data[(i / 5 + 1) % in.size] : (uint8_t)(i / 9);
    job.map.samples = samples;
    job.map.stride = 4 * (ptrdiff_t)job.map.width;
    run(&job, NULL, &without);
    run(&job, &job.photo, &with);
    if (with.status != REFOCUS_OK)
        return 0;
    check_known(&with, &without, job.map.width * job.map.height);
    check_memory(&job, &with);
    return 0;
}
