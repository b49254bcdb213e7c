/* star.c: adds the spikes of a star filter to highlights.
 *
 * Each highlight has `star_spikes` spikes that together carry `star_strength` of its light,
 * on top of it. Along a spike of length L light falls by 3 / L (1 - l / L)^2, across it
 * by 3 / 4b (1 - (w / b)^2), b the highlight's blur radius, at least 3/4 pixel: the spike of
 * a highlight that is out of focus is as wide as its disc. The filter is before the lens:
 * nothing hides a spike.
 */
#include "look/look.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "aperture/aperture.h"

enum { LANES = RF_TILE * RF_TILE };
enum { LEAST_WIDE = 192 }; /* least half width of a spike, Q8 pixels */

/* The light of a star, Q12: that of 2^18 pixels at 16 times white. */
#define MOST_LIGHT (UINT64_C(1) << 34)
static_assert((uint64_t)3 * RF_LIGHT_MAX * (RF_MOST_GAIN * 256) <= UINT32_MAX,
              "what a pixel adds fits 32 bits before it is divided");

/* The density of a spike, Q16, is greatest at the end of one of 1/256 pixel and least width. All
 * spikes of a star share its light, so that is what they add up to where all of them meet. */
#define MOST_DENSITY ((3 * 256 * INT64_C(65536)) * (3 * 64 * INT64_C(65536) / LEAST_WIDE) >> 16)
static_assert(MOST_DENSITY < INT64_C(1) << 26, "times MOST_LIGHT it is below 2^60");
static_assert(MOST_DENSITY <= INT64_MAX / RF_MOST_STARS / (int64_t)(MOST_LIGHT >> 8),
              "the sum of all stars fits 64 bits");

/* The star that a pixel touches, of the last ones, as pixels come row by row; NULL: none. */
static struct rf_star *touched(const struct rf_stars *stars, int x, int y)
{
    enum { LOOK_BACK = 512 };

    for (int i = stars->count - 1; i >= 0 && i >= stars->count - LOOK_BACK; i--) {
        struct rf_star *star = &stars->star[i];

        if (x >= star->x0 - 1 && x <= star->x1 + 1 && y <= star->y1 + 1)
            return star;
    }
    return NULL;
}

static struct rf_star *new_star(struct rf_stars *stars, int x, int y)
{
    struct rf_star *star;

    if (stars->count == RF_MOST_STARS)
        return NULL;
    star = &stars->star[stars->count++];
    *star = (struct rf_star){.x0 = x, .x1 = x, .y1 = y};
    return star;
}

/* Adds pixel i of a highlight to a star, whose place becomes the middle of all its pixels. A third
 * of `boost` is the highlight's hue at white. */
static void add_pixel(const struct rf_look *look, const struct rf_highlight *run, int i,
                      struct rf_star *star)
{
    const uint32_t times = (uint32_t)floorf(look->params->highlight_gain * 256 + 0.5f);
    const int x = run->x + i;
    int16_t signed_blur;
    int blur;

    rf_blurs_at(look, x, run->y, 1, 1, &signed_blur);
    blur = rf_in_pixels(abs(signed_blur), look->plan->focus.unit);
    star->x0 = x < star->x0 ? x : star->x0;
    star->x1 = x > star->x1 ? x : star->x1;
    star->y1 = run->y;
    for (int c = 0; c < 3; c++) {
        const uint64_t sum = star->light[c] + run->boost[c] * times / (3 * 256);

        star->light[c] = sum < MOST_LIGHT ? sum : MOST_LIGHT;
    }
    star->blur = blur > star->blur ? blur : star->blur;
    star->x += x;
    star->y += run->y;
    star->pixels++;
}

void rf_find_stars(const struct rf_look *look)
{
    struct rf_stars *stars = look->stars;

    stars->count = 0;
    for (int part = 0; part < RF_HIGHLIGHT_PARTS; part++) {
        const struct rf_highlight_list *list = &look->highlights->part[part];

        for (uint32_t i = 0; i < list->count; i++) {
            const struct rf_highlight *run = &list->run[i];

            if (rf_cancelled_at(look->exec, i))
                return;
            for (int k = 0; k < run->count; k++) {
                struct rf_star *star = touched(stars, run->x + k, run->y);

                star = star ? star : new_star(stars, run->x + k, run->y);
                if (star)
                    add_pixel(look, run, k, star);
            }
        }
    }
    for (int i = 0; i < stars->count; i++) {
        struct rf_star *star = &stars->star[i];

        star->x = (16 * star->x + star->pixels / 2) / star->pixels;
        star->y = (16 * star->y + star->pixels / 2) / star->pixels;
    }
}

/* The spikes of one filter, Q15, and their length, Q8 pixels. */
struct spikes {
    int count;
    int64_t x[RF_MOST_SPIKES], y[RF_MOST_SPIKES], length;
    int64_t share; /* part of the light that goes into one spike, Q16 */
};

static struct spikes spikes_of(const struct rf_settings *p)
{
    struct spikes spikes = {
        .count = p->star_spikes,
        .length = (int64_t)floorf(p->star_length * 256 + 0.5f),
        .share = (int64_t)floorf(p->star_strength / (float)p->star_spikes * 65536 + 0.5f)};

    for (int i = 0; i < spikes.count; i++) {
        double sine, cosine;

        rf_sincos_turns(p->star_angle / 360.0 + (double)i / spikes.count, &sine, &cosine);
        spikes.x[i] = (int64_t)floor(cosine * 32768 + 0.5);
        spikes.y[i] = (int64_t)floor(-sine * 32768 + 0.5); /* y down */
    }
    return spikes;
}

/* How dense the light of a spike is at a place along and across it, Q8 pixels: Q16 of it. */
static int64_t density(int64_t along, int64_t across, int64_t length, int64_t wide)
{
    const int64_t left = ((length - along) << 16) / length; /* Q16 */
    const int64_t near = 65536 - ((across * across << 16) / (wide * wide));
    const int64_t a = (3 * 256 * (left * left >> 16)) / length; /* per pixel, Q16 */
    const int64_t b = (3 * 64 * near) / wide;

    return a * b >> 16;
}

static void add_star(const struct rf_star *star, const struct spikes *spikes, int x0, int y0,
                     int64_t sum[3][LANES])
{
    const int64_t wide = star->blur > LEAST_WIDE ? star->blur : LEAST_WIDE;

    for (int i = 0; i < LANES; i++) {
        const int64_t dx = 256 * (x0 + i % RF_TILE) - 16 * star->x;
        const int64_t dy = 256 * (y0 + i / RF_TILE) - 16 * star->y;
        int64_t share = 0;

        for (int k = 0; k < spikes->count; k++) {
            const int64_t along = (dx * spikes->x[k] + dy * spikes->y[k]) >> 15;
            const int64_t across = llabs((dy * spikes->x[k] - dx * spikes->y[k]) >> 15);

            if (along >= 0 && along < spikes->length && across < wide)
                share += density(along, across, spikes->length, wide);
        }
        if (share)
            for (int c = 0; c < 3; c++)
                sum[c][i] += ((int64_t)star->light[c] * spikes->share >> 16) * share >> 8;
    }
}

/* Adds Q20 light to encoded pixels. */
static void add_light(const struct rf_transfer *transfer, const struct rf_canvas *canvas,
                      struct rf_rect rect, int64_t sum[3][LANES])
{

    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            const int i = y % RF_TILE * RF_TILE + x % RF_TILE;
            uint8_t *code[3];

            rf_codes_at(canvas, x, y, code);
            for (int c = 0; c < 3; c++) {
                const int64_t mean =
                    4 * (int64_t)transfer->to_light[*code[c]] + ((sum[c][i] + (1 << 5)) >> 6);

                if (sum[c][i] >= 1 << 5)
                    *code[c] = transfer->to_code[mean < RF_MEAN_MAX ? mean : RF_MEAN_MAX];
            }
        }
    }
}

void rf_add_stars(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect)
{
    /* the tile's first pixel, in the photo */
    const int x0 = canvas->view->x0 + rect.x0 / RF_TILE * RF_TILE;
    const int y0 = canvas->view->y0 + rect.y0 / RF_TILE * RF_TILE;
    const struct spikes spikes = spikes_of(look->params);
    int64_t sum[3][LANES];
    bool any = false;

    if (spikes.length == 0)
        return;
    memset(sum, 0, sizeof sum);
    for (int i = 0; i < look->stars->count; i++) {
        const struct rf_star *star = &look->stars->star[i];
        const int reach = (int)(spikes.length + star->blur) / 256 + 2;
        const int x = (int)(star->x / 16), y = (int)(star->y / 16);

        if (x < x0 - reach || x >= x0 + RF_TILE + reach || y < y0 - reach ||
            y >= y0 + RF_TILE + reach)
            continue;
        add_star(star, &spikes, x0, y0, sum);
        any = true;
    }
    if (any)
        add_light(look->photo.transfer, canvas, rect, sum);
}
