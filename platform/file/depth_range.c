/* depth_range.c: what samples mean by Google's Format, Near, Far and Units. A normalised value v,
 * 0 near and 1 far, is linear in z (RangeLinear) or in 1/z (RangeInverse). */
#include "depth_range.h"

#include <math.h>
#include <stdio.h>

#include "letters.h"
#include "reason.h"

/* Metres in a unit of distance; 0: none that is known. */
static double metres_in(const char *units)
{
    if (units && (rf_same_word(units, "m") || rf_same_word(units, "meters")))
        return 1.0;
    return units && rf_same_word(units, "mm") ? 0.001 : 0.0;
}

static void note_range(const struct rf_read *read, const char *name, const char *units,
                       const struct rf_depth_range *range)
{
    if (!units) {
        rf_note(read->info, "%s: Near %g, Far %g without a unit: no metres", name, range->near,
                range->far);
    } else if (range->metres > 0.0) {
        rf_note(read->info, "%s: Near %g %.40s, Far %g %.40s", name, range->near, units, range->far,
                units);
    } else {
        rf_note(read->info, "%s: Near %g, Far %g in \"%.40s\": no metres", name, range->near,
                range->far, units);
    }
}

/* Near and Far in dioptres, of which the nearest has most, become metres. Some files have them the
 * other way round, and then it is not clear what they count. */
static bool take_dioptres(const struct rf_read *read, const char *name,
                          struct rf_depth_range *range)
{
    const double near = range->near, far = range->far;

    if (!(far >= 0.0 && near > far && isfinite(1.0 / near)))
        return false;
    rf_note(read->info, "%s: Near %g, Far %g in dioptres", name, near, far);
    *range = (struct rf_depth_range){1.0 / near, far > 0.0 ? 1.0 / far : (double)INFINITY, 1.0};
    return true;
}

static int read_range(const struct rf_read *read, const struct rf_xmp *xmp,
                      const struct rf_range_keys *keys, struct rf_depth_range *range)
{
    const char *const units = xmp->value[keys->units], *const name = keys->name;
    bool has_near, has_far;
    char property[32];
    int status;

    snprintf(property, sizeof property, "%s:Near", name);
    status = rf_xmp_number(read, xmp, keys->near, property, &has_near, &range->near);
    if (status == REFOCUS_OK) {
        snprintf(property, sizeof property, "%s:Far", name);
        status = rf_xmp_number(read, xmp, keys->far, property, &has_far, &range->far);
    }
    if (status != REFOCUS_OK)
        return status;
    range->metres = metres_in(units);
    if (!has_near || !has_far) {
        range->near = range->far = 0.0;
        rf_note(read->info, "%s: no Near and Far: distances are unknown", name);
        return REFOCUS_OK;
    }
    if (units && rf_same_word(units, "diopters") && take_dioptres(read, name, range))
        return REFOCUS_OK;
    if (range->near < 0.0 || range->far <= range->near) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its %s:Near %g and %s:Far %g are no range", name, range->near,
                       name, range->far);
    }
    note_range(read, name, units, range);
    return REFOCUS_OK;
}

/* Distances of an unknown unit as disparities, which need none: linear in 1/z, the nearest
 * 65535. */
static int linear_to_disparity(struct rf_read *read, const char *name,
                               const struct rf_depth_range *range)
{
    struct rf_raster disparity = read->samples;
    const size_t count = (size_t)disparity.width * (size_t)disparity.height;
    const double step = (range->far - range->near) / disparity.max_value;
    const double near = range->near > 0.0 ? range->near : step; /* 1/0 is no disparity */
    int status;

    disparity.sample = REFOCUS_SAMPLE_U16;
    disparity.max_value = 65535;
    status = rf_raster_alloc(read, &disparity);
    if (status != REFOCUS_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        const double z = fmax(range->near + rf_raster_sample(&read->samples, i) * step, near);
        const double d = (1.0 / z - 1.0 / range->far) / (1.0 / near - 1.0 / range->far);

        /* fmax() makes 0 of NaN, where 1 / Near is more than a double holds. */
        ((uint16_t *)(void *)disparity.pixels)[i] =
            (uint16_t)(fmin(fmax(d, 0.0), 1.0) * 65535.0 + 0.5);
    }
    rf_raster_free(&read->samples);
    read->samples = disparity;
    read->depth.meaning = REFOCUS_DEPTH_DISPARITY;
    read->depth.value_near = 65535.0;
    read->depth.value_far = 0.0;
    rf_note(read->info, "%s: RangeLinear without a unit: taken over as disparities", name);
    return REFOCUS_OK;
}

static int set_linear(struct rf_read *read, const struct rf_range_keys *keys,
                      const struct rf_depth_range *range)
{
    struct refocus_depth_map *const map = &read->depth;

    if (range->far <= 0.0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its %s is RangeLinear without Near and Far", keys->name);
    }
    if (range->metres == 0.0)
        return linear_to_disparity(read, keys->name, range);
    map->meaning = REFOCUS_DEPTH_DISTANCE;
    map->metres_at_zero = map->near_m;
    map->metres_per_unit = (map->far_m - map->near_m) / read->samples.max_value;
    rf_note(read->info, "%s: RangeLinear: linear in z, 0 is near, %g is far", keys->name,
            (double)read->samples.max_value);
    return REFOCUS_OK;
}

/* Values that are linear in 1/z already. */
static int set_inverse(struct rf_read *read, const char *name, const char *words)
{
    read->depth.meaning = REFOCUS_DEPTH_DISPARITY;
    read->depth.value_near = 0.0;
    read->depth.value_far = read->samples.max_value;
    rf_note(read->info, "%s: %s, 0 is near, %g is far", name, words, read->depth.value_far);
    return REFOCUS_OK;
}

int rf_set_range(struct rf_read *read, const struct rf_xmp *xmp, const struct rf_range_keys *keys,
                 struct rf_depth_range *range)
{
    const char *const units = xmp->value[keys->units];
    const char *format = xmp->value[keys->format];
    const int status = read_range(read, xmp, keys, range);

    if (status != REFOCUS_OK)
        return status;
    read->depth.near_m = range->metres > 0.0 ? range->near * range->metres : 0.0;
    read->depth.far_m = range->metres > 0.0 ? range->far * range->metres : 0.0;
    if (!format && keys->default_format) {
        format = keys->default_format;
        rf_note(read->info, "%s: no Format: read as %s", keys->name, format);
    }
    if (format && rf_same_word(format, "RangeInverse"))
        return set_inverse(read, keys->name, "RangeInverse: linear in 1/z");
    if (format && rf_same_word(format, "RangeLinear")) {
        return units && rf_same_word(units, "diopters") && range->metres > 0.0
                   ? set_inverse(read, keys->name, "RangeLinear: linear in dioptres")
                   : set_linear(read, keys, range);
    }
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: its %s:Format is neither RangeInverse nor RangeLinear", keys->name);
}
