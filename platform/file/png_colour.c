/* png_colour.c: what a PNG says about its colours beside an ICC profile: code points (cICP), or a
 * gamma and chromaticities (gAMA, cHRM). PNG specification, third edition, 11.3.2: cICP goes before
 * the profile, that before sRGB, and that before the other two. */
#include "png_colour.h"

#include <stdlib.h>
#include <string.h>

#include "light.h"
#include "png_chunks.h"

/* Gamma is stored times 100,000: 1/2.2 is 45455, and programs round it to three digits. */
static bool is_other_gamma(struct rf_bytes content)
{
    const int64_t gamma = content.size == 4 ? rf_big_endian(content.data, 4) : 45455;

    return llabs(gamma - 45455) > 500;
}

/* White and the three primaries, x and y of each, times 100,000; a thousandth is rounding. */
static bool are_other_primaries(struct rf_bytes content)
{
    static const int64_t srgb[] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    bool other = false;

    for (size_t i = 0; content.size == 32 && i < 8; i++)
        other |= llabs((int64_t)rf_big_endian(content.data + 4 * i, 4) - srgb[i]) > 100;
    return other;
}

static bool is(const struct rf_png_chunk *chunk, const char *type)
{
    return memcmp(chunk->type, type, 4) == 0;
}

struct rf_png_colour rf_png_colour_of(struct rf_bytes chunks, bool has_profile)
{
    struct rf_png_colour colour = {.by = NULL};
    bool other = false, is_srgb = false;
    struct rf_png_chunk chunk;

    while (rf_png_next_chunk(&chunks, &chunk)) {
        is_srgb |= is(&chunk, "sRGB");
        other |= is(&chunk, "gAMA") && is_other_gamma(chunk.content);
        other |= is(&chunk, "cHRM") && are_other_primaries(chunk.content);
        if (is(&chunk, "cICP") && chunk.content.size == 4) {
            const uint8_t *const b = chunk.content.data;

            colour.primaries = b[0];
            colour.curve = b[1];
            colour.whole_range = b[2] == 0 && b[3] == 1;
        }
    }
    if (colour.curve != 0) {
        const bool same = colour.primaries == RF_PRIMARIES_BT709 && colour.curve == RF_CURVE_SRGB;

        colour.by = same && colour.whole_range ? NULL : "cICP";
    } else if (other && !has_profile && !is_srgb) {
        colour.by = "gAMA and cHRM";
    }
    return colour;
}
