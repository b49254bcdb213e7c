/* gain_values.c: what the metadata of gain maps says: ISO 21496-1, the XMP of Ultra HDR, and the
 * headroom of Apple's photos. */
#include "gain_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "number.h"

enum {
    MOST_OFFSET = 256, /* times white, either way; Adobe's programs write up to 10 and more */
};

static bool is_within(double value, double least, double most)
{
    return value >= least && value <= most; /* false of NaN */
}

static const char *check(const struct rf_gain_values *v)
{
    for (int c = 0; c < 3; c++) {
        if (!is_within(v->least[c], -RF_GAIN_MOST_STOPS, RF_GAIN_MOST_STOPS) ||
            !is_within(v->greatest[c], v->least[c], RF_GAIN_MOST_STOPS))
            return "its range of gains is out of bounds";
        if (!is_within(v->gamma[c], 1.0 / 64, 64))
            return "its gamma is out of bounds";
        if (!is_within(v->base_offset[c], -MOST_OFFSET, MOST_OFFSET) ||
            !is_within(v->other_offset[c], -MOST_OFFSET, MOST_OFFSET))
            return "its offsets are out of bounds";
    }
    return is_within(v->base_headroom, 0, v->other_headroom) &&
                   is_within(v->other_headroom, 0, RF_GAIN_MOST_STOPS)
               ? NULL
               : "its photo is not the darker rendition";
}

enum { THREE_CHANNELS = 0x80, COMMON_DENOMINATOR = 8 }; /* flags of ISO's metadata */

struct reading {
    struct rf_bytes left;
    bool short_of; /* bytes were missing, or a denominator was 0 */
    bool common;   /* one denominator for all fractions was read */
    uint32_t denominator;
};

static uint32_t get(struct reading *r, size_t bytes)
{
    uint32_t value = 0;

    if (r->left.size < bytes) {
        r->short_of = true;
        return 0;
    }
    for (size_t i = 0; i < bytes; i++)
        value = value << 8 | r->left.data[i];
    r->left.data += bytes;
    r->left.size -= bytes;
    return value;
}

/* A fraction; its numerator may be negative. */
static double get_fraction(struct reading *r, bool is_signed)
{
    const uint32_t above = get(r, 4), below = r->common ? r->denominator : get(r, 4);
    const double value = is_signed ? (double)(int32_t)above : (double)above;

    r->short_of |= below == 0;
    return below ? value / (double)below : 0;
}

const char *rf_gain_from_iso(struct rf_bytes metadata, struct rf_gain_values *values)
{
    struct reading r = {.left = metadata};
    const uint32_t least_version = get(&r, 2);
    uint32_t flags;
    int channels;

    memset(values, 0, sizeof *values);
    get(&r, 2); /* version of the writer */
    flags = get(&r, 1);
    channels = flags & THREE_CHANNELS ? 3 : 1;
    if (!r.short_of && least_version != 0)
        return "its metadata is of a version that is not known";
    if (flags & COMMON_DENOMINATOR) {
        r.denominator = get(&r, 4);
        r.common = true;
    }
    values->base_headroom = get_fraction(&r, false);
    values->other_headroom = get_fraction(&r, false);
    for (int c = 0; c < 3; c++) {
        const int from = c < channels ? c : 0;

        if (from == c) {
            values->least[c] = get_fraction(&r, true);
            values->greatest[c] = get_fraction(&r, true);
            values->gamma[c] = get_fraction(&r, false);
            values->base_offset[c] = get_fraction(&r, true);
            values->other_offset[c] = get_fraction(&r, true);
        }
        values->least[c] = values->least[from];
        values->greatest[c] = values->greatest[from];
        values->gamma[c] = values->gamma[from];
        values->base_offset[c] = values->base_offset[from];
        values->other_offset[c] = values->other_offset[from];
    }
    return r.short_of ? "its metadata is damaged" : check(values);
}

/* One number for all channels, or one for each, with blanks between them. False: neither. */
static bool get_numbers(const char *text, double fallback, double value[3])
{
    enum { LONGEST = 64 };
    int count = 0;

    for (int c = 0; c < 3; c++)
        value[c] = fallback;
    if (!text)
        return isfinite(fallback);
    for (text += strspn(text, " \t\r\n"); *text; text += strspn(text, " \t\r\n")) {
        const size_t length = strcspn(text, " \t\r\n");
        char word[LONGEST];

        if (length >= LONGEST || count == 3)
            return false;
        memcpy(word, text, length);
        word[length] = '\0';
        if (!rf_parse_number(word, &value[count++]))
            return false;
        text += length;
    }
    if (count == 1)
        value[1] = value[2] = value[0];
    return count == 1 || count == 3;
}

const char *rf_gain_from_xmp(const struct rf_xmp *xmp, struct rf_gain_values *values)
{
    const char *const turned = xmp->value[RF_XMP_GAIN_BASE_IS_HDR];
    double low[3], high[3];

    memset(values, 0, sizeof *values);
    if (!get_numbers(xmp->value[RF_XMP_GAIN_MIN], 0, values->least) ||
        !get_numbers(xmp->value[RF_XMP_GAIN_MAX], NAN, values->greatest) ||
        !get_numbers(xmp->value[RF_XMP_GAIN_GAMMA], 1, values->gamma) ||
        !get_numbers(xmp->value[RF_XMP_GAIN_OFFSET_SDR], 1 / 64.0, values->base_offset) ||
        !get_numbers(xmp->value[RF_XMP_GAIN_OFFSET_HDR], 1 / 64.0, values->other_offset) ||
        !get_numbers(xmp->value[RF_XMP_GAIN_CAPACITY_MIN], 0, low) ||
        !get_numbers(xmp->value[RF_XMP_GAIN_CAPACITY_MAX], NAN, high))
        return "its metadata is damaged";
    values->base_headroom = low[0];
    values->other_headroom = high[0];
    return turned && (turned[0] == 'T' || turned[0] == 't')
               ? "its photo is not the darker rendition"
               : check(values);
}

void rf_gain_make_curves(struct rf_gain_map *map)
{
    const struct rf_gain_values *const v = &map->values;

    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 256; i++) {
            map->gain[c][i] = (float)(v->least[c] + (v->greatest[c] - v->least[c]) *
                                                        pow(i / 255.0, 1 / v->gamma[c]));
        }
    }
}

/* Apple, "Applying Apple HDR effect to your photos": H = S (1 + (headroom - 1) light of the
 * sample), which is stored by the curve of BT.709. */
void rf_gain_make_apple(struct rf_gain_map *map, double headroom)
{
    struct rf_gain_values *const v = &map->values;

    memset(v, 0, sizeof *v);
    v->other_headroom = log2(headroom);
    for (int c = 0; c < 3; c++) {
        v->gamma[c] = 1;
        v->greatest[c] = v->other_headroom;
        for (int i = 0; i < 256; i++) {
            const double x = i / 255.0;
            const double light = x < 0.081 ? x / 4.5 : pow((x + 0.099) / 1.099, 1 / 0.45);

            map->gain[c][i] = (float)log2(1 + (headroom - 1) * light);
        }
    }
}
