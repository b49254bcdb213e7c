/* no_value.c: matchers of stereo pairs write a number where they found nothing, -1, -16 or 0, which
 * then is an end of the map's range; and they write whole numbers of parts of a pixel, which are
 * few of what their type has. Both leave little blur to the rest. */
#include "inputs/no_value.h"

#include <math.h>
#include <stdio.h>
#include "inputs/samples.h"

/* The range of a map is looked at in BINS parts. */
enum { BINS = 4096, LAST = BINS - 1 };

/* A code for no value is an end of a map of DISTINCT parts at least, which is no drawing of a few
 * surfaces, and a hundredth of the samples has it. The least one is beyond infinity, or 0 of whole
 * numbers, which have no NaN; it lies from the others six times as far as the next DISTINCT of them
 * lie from each other, and six parts at least: 0, 144, 160, 176 ... of KITTI, but not 0, 158, 181,
 * 273 of a sky. The greatest lies farther from them than they lie from the least. */
enum { DISTINCT = 16, OF_SAMPLES = 100, SPACINGS = 6 };

/* Codes below a tenth of the greatest one leave less than a tenth of the blur. */
enum { SMALL_PART = 10 };

struct ends {
    double least, greatest;
    uint64_t at_least, at_greatest, known; /* samples */
    bool is_used[BINS];
    int low, low_next, high; /* the first, the DISTINCT-th and the last bin that is used between */
    int used;                /* bins that are used between */
};

static void measure(struct ends *ends, const struct refocus_depth_map *map)
{
    ends->least = INFINITY;
    ends->greatest = -INFINITY;
    for (int32_t y = 0; y < map->height; y++)
        for (int32_t x = 0; x < map->width; x++) {
            const double v = sample_value(map, x, y);

            if (v < ends->least) {
                ends->least = v;
                ends->at_least = 0;
            }
            if (v > ends->greatest) {
                ends->greatest = v;
                ends->at_greatest = 0;
            }
            ends->at_least += v == ends->least;
            ends->at_greatest += v == ends->greatest;
            ends->known += !isnan(v);
        }
}

/* Finds out where the samples between the two ends lie. */
static void sort(struct ends *ends, const struct refocus_depth_map *map)
{
    const double range = ends->greatest - ends->least;

    for (int32_t y = 0; y < map->height; y++)
        for (int32_t x = 0; x < map->width; x++) {
            const double v = sample_value(map, x, y);

            if (v > ends->least && v < ends->greatest)
                ends->is_used[(int)((v - ends->least) / range * LAST)] = true;
        }
    ends->low = BINS;
    for (int i = 0; i < BINS; i++)
        if (ends->is_used[i]) {
            ends->low = i < ends->low ? i : ends->low;
            ends->high = i;
            ends->used++;
            ends->low_next = ends->used <= DISTINCT ? i : ends->low_next;
        }
}

static bool is_least_apart(const struct ends *ends, bool floats)
{
    return (floats ? ends->least < 0 : ends->least == 0) &&
           OF_SAMPLES * ends->at_least >= ends->known && ends->low >= SPACINGS &&
           ends->low * (DISTINCT - 1) >= SPACINGS * (ends->low_next - ends->low);
}

/* Whether the greatest stands for no value. Of whole numbers it is the last one or, where OpenCV's
 * negative one was wrapped, hardly before it: what lies elsewhere is a near surface. */
static bool is_greatest_apart(const struct ends *ends, uint32_t sample)
{
    const double last = sample == REFOCUS_SAMPLE_U8    ? UINT8_MAX
                        : sample == REFOCUS_SAMPLE_U16 ? UINT16_MAX
                                                       : ends->greatest;

    return ends->greatest >= last * 1023 / 1024 && OF_SAMPLES * ends->at_greatest >= ends->known &&
           LAST - ends->high > ends->high;
}

static void tell_code(const struct ends *ends, const struct refocus_depth_map *map, bool least,
                      char line[ENDS_LINE])
{
    const double value = least ? ends->least : ends->greatest;
    const bool inverse = map->value_near < map->value_far;

    snprintf(line, ENDS_LINE,
             "%.0f %% of its samples are %.9g, apart from all others, and taken for what is %s; if "
             "they hold no value, give --invalid=%.9g",
             100.0 * (double)(least ? ends->at_least : ends->at_greatest) / (double)ends->known,
             value, least == inverse ? "nearest" : "farthest", value);
}

/* Whether whole numbers from `low` to `high` use little of their type. */
static bool are_few(const struct refocus_depth_map *map, double low, double high,
                    char line[ENDS_LINE])
{
    const double most = fabs(map->value_near - map->value_far);

    if (map->sample == REFOCUS_SAMPLE_F32 || SMALL_PART * high >= most)
        return false;
    snprintf(line, ENDS_LINE,
             "its samples from %.0f to %.0f use %.1f %% of their range, and leave as little of the "
             "blur; if they are parts of a pixel, give --depth-unit disparity/16 (OpenCV) or /256 "
             "(KITTI), by which the range is measured",
             low, high, 100.0 * (high - low) / most);
    return true;
}

bool ends_are_doubtful(const struct refocus_depth_map *map, bool codes_given, char line[ENDS_LINE])
{
    struct ends ends = {.known = 0};
    bool least;

    measure(&ends, map);
    if (!(ends.greatest > ends.least))
        return false;
    sort(&ends, map);
    least = is_least_apart(&ends, map->sample == REFOCUS_SAMPLE_F32);
    if (ends.used < DISTINCT)
        return false;
    if (!codes_given && (least || is_greatest_apart(&ends, map->sample))) {
        tell_code(&ends, map, least, line);
        return true;
    }
    return are_few(map, ends.least, ends.greatest, line);
}
