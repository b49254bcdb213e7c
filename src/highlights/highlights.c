#include "highlights/highlights.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "renderer/bands.h"
#include "renderer/renderer.h"

enum {
    AROUND = 12,                      /* surroundings: 25 x 25 pixels */
    AREA = (2 * AROUND + 1) * (2 * AROUND + 1),
    RIM = 3,                          /* pixels around that tell the hue */
    LEVEL = RF_LIGHT_MAX * 94 / 100,  /* where clipping begins to count */
    GAIN = 3,                         /* full gain of 4 adds three times white */
};

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Rec. 709 luminance of linear light, Q12. */
static int luminance(const struct refocus_renderer *r, int x, int y)
{
    const ptrdiff_t at = y * r->stride + x;

    return (218 * r->front.light[0][at] + 732 * r->front.light[1][at] +
            74 * r->front.light[2][at] + 512) >> 10;
}

static int brightest(const struct refocus_renderer *r, ptrdiff_t at)
{
    int most = r->front.light[0][at];

    most = r->front.light[1][at] > most ? r->front.light[1][at] : most;
    return r->front.light[2][at] > most ? r->front.light[2][at] : most;
}

/* Mean colour of the surroundings, from a sparse grid: every third pixel of 25 x 25. */
static void surroundings(const struct refocus_renderer *r, int x, int y, int mean[3])
{
    int sum[3] = {0, 0, 0}, n = 0;

    for (int j = -AROUND; j <= AROUND; j += 3) {
        for (int i = -AROUND; i <= AROUND; i += 3) {
            const ptrdiff_t at =
                clamp(y + j, r->height - 1) * r->stride + clamp(x + i, r->width - 1);

            for (int c = 0; c < 3; c++)
                sum[c] += r->front.light[c][at];
            n++;
        }
    }
    for (int c = 0; c < 3; c++)
        mean[c] = sum[c] / n;
}

/* Colour of the lamp's rim, its largest channel RF_LIGHT_MAX; white if it has none. */
static void rim_hue(const struct refocus_renderer *r, int x, int y, const int around[3],
                    int hue[3])
{
    int64_t sum[3] = {0, 0, 0}, most;

    for (int j = -RIM; j <= RIM; j++) {
        for (int i = -RIM; i <= RIM; i++) {
            const int qx = clamp(x + i, r->width - 1), qy = clamp(y + j, r->height - 1);
            const ptrdiff_t at = qy * r->stride + qx;

            if (brightest(r, at) >= LEVEL) /* a clipped channel has lost the hue */
                continue;
            for (int c = 0; c < 3; c++)
                if (r->front.light[c][at] > around[c])
                    sum[c] += r->front.light[c][at] - around[c];
        }
    }
    most = sum[0] > sum[1] ? sum[0] : sum[1];
    most = sum[2] > most ? sum[2] : most;
    for (int c = 0; c < 3; c++)
        hue[c] = most < RF_LIGHT_MAX / 4 ? RF_LIGHT_MAX : (int)(sum[c] * RF_LIGHT_MAX / most);
}

/* 0 to 256 as v goes from a to b. */
static int ramp(int64_t v, int64_t a, int64_t b)
{
    return v <= a ? 0 : v >= b ? 256 : (int)(256 * (v - a) / (b - a));
}

/* Whether pixel (x, y), whose surroundings have this sum of luminance, is a clipped lamp. */
static bool is_lamp(const struct refocus_renderer *r, int x, int y, int64_t sum,
                    struct rf_highlight *lamp)
{
    const ptrdiff_t at = y * r->stride + x;
    const int64_t own = (int64_t)luminance(r, x, y) * AREA;
    const int level = ramp(brightest(r, at), LEVEL, RF_LIGHT_MAX);
    const int alone = ramp(own, 3 * sum, 6 * sum);
    const int strength = level * alone / 256;
    int around[3], hue[3];

    if (!strength)
        return false;
    surroundings(r, x, y, around);
    rim_hue(r, x, y, around, hue);
    lamp->x = (uint16_t)(x + r->origin_x);
    lamp->y = (uint16_t)(y + r->origin_y);
    for (int c = 0; c < 3; c++)
        lamp->added[c] = (uint16_t)(GAIN * hue[c] * strength / 256);
    return true;
}

/* Sum of the luminances of the surroundings, kept up to date along a row. */
void rf_find_highlights(struct refocus_renderer *r, struct rf_rect part)
{
    struct rf_photo *photo = &r->photo[r->used];

    for (int y = part.y0; y < part.y1; y++) {
        int64_t sum = -1; /* not known here */
        int last = 0;

        for (int x = part.x0; x < part.x1; x++) {
            if (x % 64 == 0 && rf_cancelled(r))
                return;
            if (brightest(r, y * r->stride + x) <= LEVEL)
                continue;
            if (sum < 0 || x - last > AROUND) {
                sum = 0;
                for (int i = -AROUND; i <= AROUND; i++)
                    for (int j = -AROUND; j <= AROUND; j++)
                        sum += luminance(r, clamp(x + i, r->width - 1),
                                         clamp(y + j, r->height - 1));
            } else {
                for (int from = last; from < x; from++)
                    for (int j = -AROUND; j <= AROUND; j++)
                        sum += luminance(r, clamp(from + 1 + AROUND, r->width - 1),
                                         clamp(y + j, r->height - 1)) -
                               luminance(r, clamp(from - AROUND, r->width - 1),
                                         clamp(y + j, r->height - 1));
            }
            last = x;
            if (photo->highlights < photo->capacity &&
                is_lamp(r, x, y, sum, &photo->highlight[photo->highlights]))
                photo->highlights++;
        }
    }
}

/* Whether a bright pixel of another depth is beside (x, y): then this one is the edge of that,
 * and only its depth says otherwise. */
static bool is_edge(const struct refocus_renderer *r, int x, int y)
{
    const int own = abs(r->front.blur[y * r->stride + x]);

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const ptrdiff_t at =
                clamp(y + j, r->height - 1) * r->stride + clamp(x + i, r->width - 1);

            if (abs(r->front.blur[at]) < own - 256 && brightest(r, at) >= LEVEL)
                return true;
        }
    }
    return false;
}

/* Where in the window a highlight is; false: not in it. */
static bool place_of(const struct refocus_renderer *r, const struct rf_highlight *lamp, int *x,
                     int *y)
{
    *x = lamp->x - r->origin_x;
    *y = lamp->y - r->origin_y;
    return *x >= 0 && *y >= 0 && *x < r->width && *y < r->height;
}

void rf_mark_highlights(struct refocus_renderer *r)
{
    struct rf_photo *photo = &r->photo[r->used];

    for (uint64_t i = 0; i < photo->highlights; i++) {
        struct rf_highlight *lamp = &photo->highlight[i];
        struct rf_bins *bins;
        int x, y, blur;

        if (i % 1024 == 0 && rf_cancelled(r))
            return;
        if (!place_of(r, lamp, &x, &y))
            continue;
        bins = &r->bins[(size_t)(y / RF_TILE) * r->tiles_x + x / RF_TILE];
        blur = abs(r->front.blur[y * r->stride + x]);
        lamp->is_edge = is_edge(r, x, y);
        if (!lamp->is_edge && blur > bins->lamp)
            bins->lamp = (int16_t)blur;
    }
}

/* Add (sign 1) or take away again (-1) what highlights from .. to - 1 lost. */
static void change(struct refocus_renderer *r, float gain, int sign, uint64_t from, uint64_t to)
{
    const int share = (int)((gain - 1) * (256 / GAIN) + 0.5f);

    for (uint64_t i = from; i < to; i++) {
        const struct rf_highlight *lamp = &r->photo[r->used].highlight[i];
        ptrdiff_t at;
        int x, y, blurred;

        if (!place_of(r, lamp, &x, &y))
            continue;
        at = y * r->stride + x;
        /* from half a pixel of blur on, all of it from one pixel and a half on */
        blurred = lamp->is_edge ? 0 : ramp(abs(r->front.blur[at]), 128, 384);
        for (int c = 0; c < 3; c++)
            r->front.light[c][at] =
                (uint16_t)(r->front.light[c][at] +
                           sign * ((((lamp->added[c] * share) >> 8) * blurred) >> 8));
    }
}

uint64_t rf_add_highlights(struct refocus_renderer *r, float gain)
{
    const uint64_t count = r->photo[r->used].highlights;

    for (uint64_t i = 0; i < count; i += 1024) {
        if (rf_cancelled(r))
            return i;
        change(r, gain, 1, i, i + 1024 < count ? i + 1024 : count);
    }
    return count;
}

void rf_remove_highlights(struct refocus_renderer *r, float gain, uint64_t count)
{
    change(r, gain, -1, 0, count);
}
