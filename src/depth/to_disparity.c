/* to_disparity.c: converts depth maps of any unit to disparities, and repairs what they miss. */
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/depth.h>
#include <refocus/image.h>
#include "depth/holes.h"
#include "depth/samples.h"
#include "depth/speckle.h"
#include "depth/strays.h"
#include "image/format.h"
#include "image/read.h"

/* Each value of large maps of whole numbers is converted once. REFOCUS_MAX_SIDE is below 2^16, so
 * 32 bits hold their number. */
enum { VALUES = 65536, LARGE = VALUES };
struct values {
    uint32_t count[VALUES];
    uint16_t disparity[VALUES];
    uint8_t state[VALUES];
};

struct conversion {
    const struct refocus_depth_map *map;
    struct values *values;      /* NULL: of samples one by one */
    double rank_near, rank_far; /* ranks where d = 1 and d = 0 */
    double stray;               /* samples beyond this rank are strays; INFINITY: none are */
    double scale;               /* from ranks to 65535 d; 0 for a map of one depth */
    uint64_t unknown, clamped, specks, strays;
};

static int check(const struct refocus_depth_map *map, const uint16_t *disparity, ptrdiff_t stride)
{
    const int status = rf_check_map(map);

    if (status == REFOCUS_OK && (!disparity || ((uintptr_t)disparity & 1) || stride % 2 != 0 ||
                                 !rf_good_stride(stride, (ptrdiff_t)map->width * 2, map->height)))
        return REFOCUS_ERR_ARGUMENT;
    return status;
}

/* Counts so many samples of a value, as known ones of a rank or as unknown ones. */
static void note_value(struct conversion *conversion, double v, uint32_t count)
{
    const double rank = rf_rank_of(conversion->map, v);

    if (isnan(rank)) {
        conversion->unknown += count;
        return;
    }
    if (rank < conversion->rank_far)
        conversion->rank_far = rank;
    if (rank > conversion->rank_near)
        conversion->rank_near = rank;
}

static void count_values(struct values *values, const struct refocus_depth_map *map)
{
    memset(values->count, 0, sizeof values->count);
    for (int y = 0; y < map->height; y++) {
        const char *row = rf_row_of(map, y);

        for (int x = 0; x < map->width; x++)
            values->count[rf_whole_of(map, row, x)]++;
    }
}

/* Strays are left out of a range that is measured. */
static void leave_out_strays(struct conversion *conversion)
{
    const struct refocus_depth_map *map = conversion->map;
    const struct rf_ranks ranks = {
        map, conversion->values ? conversion->values->count : NULL,
        (uint64_t)map->width * (uint64_t)map->height - conversion->unknown, conversion->rank_far};

    conversion->stray = INFINITY;
    if (map->meaning != REFOCUS_DEPTH_DISTANCE || map->near_m > 0)
        return;
    conversion->strays = rf_find_strays(&ranks, &conversion->rank_near);
    if (conversion->strays > 0)
        conversion->stray = conversion->rank_near;
}

/* Count what is unknown and find the greatest and the least rank. */
static int measure(struct conversion *conversion)
{
    const struct refocus_depth_map *map = conversion->map;
    struct values *values = conversion->values;

    conversion->rank_near = -INFINITY;
    conversion->rank_far = INFINITY;
    if (values)
        count_values(values, map);
    for (int v = 0; values && v < VALUES; v++)
        if (values->count[v])
            note_value(conversion, v, values->count[v]);
    for (int y = 0; !values && y < map->height; y++)
        for (int x = 0; x < map->width; x++)
            note_value(conversion, rf_value_of(map, rf_row_of(map, y), x), 1);
    if (conversion->unknown == (uint64_t)map->width * (uint64_t)map->height)
        return REFOCUS_ERR_NO_DEPTH;
    leave_out_strays(conversion);
    return REFOCUS_OK;
}

/* The range that the map tells goes before the measured one. */
static void choose_range(struct conversion *conversion)
{
    const struct refocus_depth_map *map = conversion->map;

    if (map->meaning == REFOCUS_DEPTH_DISPARITY) {
        if (map->value_near != map->value_far) {
            conversion->rank_near = map->value_near;
            conversion->rank_far = map->value_far;
        }
    } else {
        if (map->near_m > 0)
            conversion->rank_near = 1 / map->near_m;
        if (map->far_m > 0)
            conversion->rank_far = 1 / map->far_m;
        /* All samples beyond the one end that is given: they lie on it. */
        if (conversion->rank_near < conversion->rank_far) {
            if (map->near_m > 0)
                conversion->rank_far = conversion->rank_near;
            else
                conversion->rank_near = conversion->rank_far;
        }
    }

    const double span = conversion->rank_near - conversion->rank_far;
    const double scale = 65535 / span;
    conversion->scale = span != 0 && isfinite(scale) ? scale : 0;
}

/* The disparity of a value that so many samples have; *state tells whether it is one. */
static uint16_t convert_value(struct conversion *conversion, double v, uint32_t count,
                              uint8_t *state)
{
    const double near = conversion->rank_near, far = conversion->rank_far;
    const double least = near < far ? near : far, greatest = near < far ? far : near;
    const double rank = rf_rank_of(conversion->map, v);
    double d;

    *state = isnan(rank) || rank > conversion->stray ? RF_SAMPLE_UNKNOWN : RF_SAMPLE_KNOWN;
    if (*state == RF_SAMPLE_UNKNOWN)
        return 0;
    if (rank < least || rank > greatest)
        conversion->clamped += count;
    d = (rank - far) * conversion->scale + 0.5;
    return d >= 65535 ? 65535 : d > 0 ? (uint16_t)d : 0;
}

/* Row y by the values, each of which is converted. */
static void look_up_row(const struct conversion *conversion, int y, uint16_t *out, uint8_t *state)
{
    const struct refocus_depth_map *map = conversion->map;
    const struct values *values = conversion->values;
    const char *row = rf_row_of(map, y);

    for (int x = 0; x < map->width; x++)
        out[x] = values->disparity[rf_whole_of(map, row, x)];
    for (int x = 0; state && x < map->width; x++)
        state[x] = values->state[rf_whole_of(map, row, x)];
}

/* Convert all rows; @p state tells known from unknown samples unless it is NULL. */
static void convert(struct conversion *conversion, uint16_t *disparity, ptrdiff_t stride,
                    uint8_t *state)
{
    const struct refocus_depth_map *map = conversion->map;
    struct values *values = conversion->values;
    uint8_t unasked;

    for (int v = 0; values && v < VALUES; v++)
        if (values->count[v])
            values->disparity[v] =
                convert_value(conversion, v, values->count[v], &values->state[v]);
    for (int y = 0; y < map->height; y++) {
        const char *row = rf_row_of(map, y);
        uint16_t *out = (uint16_t *)((char *)disparity + y * stride);
        uint8_t *known = state ? state + (size_t)y * (size_t)map->width : NULL;

        if (values)
            look_up_row(conversion, y, out, known);
        for (int x = 0; !values && x < map->width; x++)
            out[x] = convert_value(conversion, rf_value_of(map, row, x), 1,
                                   known ? known + x : &unasked);
    }
}

static struct refocus_depth_report report_of(const struct conversion *conversion)
{
    const struct refocus_depth_map *map = conversion->map;
    struct refocus_depth_report report = refocus_depth_report_default();

    report.near_m = map->near_m;
    report.far_m = map->far_m;
    if (map->meaning == REFOCUS_DEPTH_DISTANCE) {
        if (map->near_m == 0)
            report.near_m = 1 / conversion->rank_near;
        if (map->far_m == 0)
            report.far_m = 1 / conversion->rank_far;
    } else {
        report.value_near = conversion->rank_near;
        report.value_far = conversion->rank_far;
    }
    report.unknown = conversion->unknown;
    report.clamped = conversion->clamped;
    report.specks = conversion->specks;
    report.strays = conversion->strays;
    return report;
}

uint64_t refocus_repair_memory(int32_t width, int32_t height, int32_t speckle)
{
    if (width < 1 || height < 1 || width > REFOCUS_MAX_SIDE || height > REFOCUS_MAX_SIDE ||
        speckle < 0 || speckle > REFOCUS_MAX_SPECKLE)
        return 0;
    return sizeof(struct values) + (uint64_t)width * (uint64_t)height * (speckle > 1 ? 5 : 1);
}

static int take_values(struct conversion *conversion, const struct refocus_repair_params *params)
{
    const struct refocus_depth_map *map = conversion->map;

    if (map->sample == REFOCUS_SAMPLE_F32 || (int64_t)map->width * map->height < LARGE)
        return REFOCUS_OK;
    conversion->values = params->memory ? params->memory : malloc(sizeof *conversion->values);
    return conversion->values ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
}

/* Bytes of a sample's state, with those of its colours. */
static uint64_t state_bytes(const struct refocus_repair_params *params)
{
    return params->photo ? 1 + RF_HOLE_COLOUR_BYTES : 1;
}

/* Memory for the state of samples and their colours, and with specks for finding patches: behind
 * the values where the caller gives it. */
static int take_memory(const struct refocus_depth_map *map,
                       const struct refocus_repair_params *params, uint8_t **state, uint32_t **work)
{
    const uint64_t samples = (uint64_t)map->width * (uint64_t)map->height;
    const bool specks = params->speckle > 1;

    if (samples > SIZE_MAX / (1 + RF_HOLE_COLOUR_BYTES) || (specks && samples > INT32_MAX))
        return REFOCUS_ERR_MEMORY;
    if (params->memory) {
        uint8_t *const behind = (uint8_t *)params->memory + sizeof(struct values);

        *work = specks ? (uint32_t *)(void *)behind : NULL;
        *state = behind + (specks ? (size_t)samples * sizeof **work : 0);
        return REFOCUS_OK;
    }
    *state = malloc((size_t)(samples * state_bytes(params)));
    *work = specks && *state ? malloc((size_t)samples * sizeof **work) : NULL;
    if (*state && (*work || !specks))
        return REFOCUS_OK;
    free(*state);
    *state = NULL;
    return REFOCUS_ERR_MEMORY;
}

static void write_confidence(const struct refocus_depth_map *map, const uint8_t *state,
                             const struct refocus_repair_params *params)
{
    for (int y = 0; y < map->height; y++) {
        uint8_t *row = params->confidence + y * params->confidence_stride;

        for (int x = 0; x < map->width; x++)
            row[x] = !state || *state++ == RF_SAMPLE_KNOWN ? 255 : 0;
    }
}

static bool good_repair(const struct refocus_repair_params *params,
                        const struct refocus_depth_map *map)
{
    if (params->memory &&
        ((uintptr_t)params->memory % sizeof(uint32_t) ||
         params->memory_bytes <
             refocus_repair_memory(map->width, map->height, params->speckle) +
                 (state_bytes(params) - 1) * (uint64_t)map->width * (uint64_t)map->height))
        return false;
    return params->speckle >= 0 && params->speckle <= REFOCUS_MAX_SPECKLE &&
           (!params->confidence ||
            rf_good_stride(params->confidence_stride, map->width, map->height));
}

enum { FIRST_REPORT = REFOCUS_SIZE_TO(struct refocus_depth_report, specks) };

/* Read what the caller gives: the map and the parameters, each of its own size. A report that
 * cannot be written is refused here, before anything else is. */
static int read_arguments(struct refocus_depth_map *map, struct refocus_repair_params *params,
                          const struct refocus_depth_map *given_map,
                          const struct refocus_repair_params *given_params,
                          const struct refocus_depth_report *report)
{
    int status = refocus_struct_read(map, sizeof *map, RF_FIRST_MAP, given_map);

    if (status != REFOCUS_OK)
        return status;
    if (report &&
        (report->struct_size < FIRST_REPORT || report->struct_size > REFOCUS_MAX_STRUCT_SIZE))
        return REFOCUS_ERR_ARGUMENT;
    return refocus_struct_read(params, sizeof *params,
                               REFOCUS_SIZE_TO(struct refocus_repair_params, confidence_stride),
                               given_params);
}

/* Read the photo that the parameters point to: 8 bits, packed. */
static int read_photo(struct refocus_repair_params *params, struct refocus_image *own)
{
    const int status = rf_read_image(NULL, "photo", own, params->photo);

    params->photo = own;
    return status == REFOCUS_OK && !refocus_format_bytes(own->format) ? REFOCUS_ERR_ARGUMENT
                                                                      : status;
}

int refocus_depth_repair(const struct refocus_depth_map *given_map,
                         const struct refocus_repair_params *given_params, uint16_t *disparity,
                         ptrdiff_t stride, struct refocus_depth_report *report)
{
    struct refocus_depth_map own_map;
    struct refocus_image own_photo;
    struct refocus_repair_params own_params = {.memory = NULL};
    const struct refocus_depth_map *const map = &own_map;
    const struct refocus_repair_params *const params = &own_params;
    struct conversion conversion = {.map = map};
    struct refocus_depth_report found;
    uint8_t *state = NULL;
    uint32_t *work = NULL;
    int status;

    status = read_arguments(&own_map, &own_params, given_map, given_params, report);
    if (status == REFOCUS_OK && params->photo)
        status = read_photo(&own_params, &own_photo);
    if (status == REFOCUS_OK)
        status = check(map, disparity, stride);
    if (status == REFOCUS_OK && !good_repair(params, map))
        status = REFOCUS_ERR_ARGUMENT;
    if (status == REFOCUS_OK)
        status = take_values(&conversion, params);
    if (status == REFOCUS_OK && rf_greatest_is_below(map, RF_RARE_PERCENT))
        own_map.flags |= REFOCUS_DEPTH_MAX_IS_UNKNOWN;
    if (status == REFOCUS_OK)
        status = measure(&conversion);
    if (status != REFOCUS_OK)
        goto done;
    choose_range(&conversion);
    /* A map of one depth is all 0, holes and all. */
    if ((conversion.unknown + conversion.strays > 0 &&
         (conversion.scale != 0 || params->confidence)) ||
        params->speckle > 1) {
        status = take_memory(map, params, &state, &work);
        if (status != REFOCUS_OK)
            goto done;
    }
    convert(&conversion, disparity, stride, state);
    if (work)
        conversion.specks = rf_remove_specks(disparity, stride, map->width, map->height,
                                             params->speckle, state, work);
    /* All of it specks: then there is nothing to tell them by. */
    if (conversion.specks + conversion.unknown + conversion.strays ==
        (uint64_t)map->width * (uint64_t)map->height) {
        conversion.specks = 0;
        conversion.clamped = 0;
        convert(&conversion, disparity, stride, state);
    }
    if (params->confidence)
        write_confidence(map, state, params);
    if (state && conversion.scale != 0)
        rf_fill_holes(disparity, stride, map->width, map->height, state, params->photo);
    found = report_of(&conversion);
    if (report)
        status = refocus_struct_write(report, FIRST_REPORT, &found, sizeof found);
done:
    if (own_params.memory)
        return status;
    free(work);
    free(state);
    free(conversion.values);
    return status;
}

int refocus_depth_to_disparity(const struct refocus_depth_map *map, uint16_t *disparity,
                               ptrdiff_t stride, struct refocus_depth_report *report)
{
    const struct refocus_repair_params params = refocus_repair_params_default();

    return refocus_depth_repair(map, &params, disparity, stride, report);
}
