#include "background/background.h"

#include <string.h>

/* Q7.8 pixels. The cone falls by half a pixel a pixel. */
enum { STEP = 128, DIAGONAL = 181, HALF = 128 };

static int max(int a, int b)
{
    return a > b ? a : b;
}

/* One direction of the two-pass distance transform: row y from the row before it (above
 * going down, below going up), then along the row. */
static void dilate_row(int16_t *m, const int16_t *before, int width, bool forward)
{
    if (before) {
        for (int x = 0; x < width; x++) {
            int v = max(m[x], before[x] - STEP);

            if (x > 0)
                v = max(v, before[x - 1] - DIAGONAL);
            if (x + 1 < width)
                v = max(v, before[x + 1] - DIAGONAL);
            m[x] = (int16_t)v;
        }
    }
    if (forward)
        for (int x = 1; x < width; x++)
            m[x] = (int16_t)max(m[x], m[x - 1] - STEP);
    else
        for (int x = width - 2; x >= 0; x--)
            m[x] = (int16_t)max(m[x], m[x + 1] - STEP);
}

static void dilate(const struct refocus_renderer *r, int16_t *m)
{
    for (int y = 0; y < r->height; y++) {
        int16_t *row = m + y * r->stride;

        memcpy(row, r->front.blur + y * r->stride, (size_t)r->width * 2);
        dilate_row(row, y ? row - r->stride : NULL, r->width, true);
        dilate_row(row, NULL, r->width, false);
    }
    for (int y = r->height - 2; y >= 0; y--) {
        int16_t *row = m + y * r->stride;

        dilate_row(row, row + r->stride, r->width, true);
        dilate_row(row, NULL, r->width, false);
    }
}

/* Level 0 of the pyramid is the padded layer itself. */
static struct rf_level base_level(const struct refocus_renderer *r)
{
    return (struct rf_level){
        .width = r->width,
        .height = r->height,
        .light = {r->behind.light[0], r->behind.light[1], r->behind.light[2]},
        .blur = r->behind.blur,
    };
}

/* A parent is the mean of those of its four children that are known. */
static void push(const struct rf_level *fine, ptrdiff_t fine_stride, struct rf_level *coarse)
{
    static const uint32_t share[5] = {0, 65536, 32768, 21845, 16384};

    for (int y = 0; y < coarse->height; y++) {
        for (int x = 0; x < coarse->width; x++) {
            const size_t at = (size_t)y * coarse->width + x;
            uint32_t sum[3] = {0, 0, 0}, n = 0;
            int blur = 0;

            for (int j = 0; j < 2; j++) {
                for (int i = 0; i < 2; i++) {
                    const ptrdiff_t child = (2 * y + j) * fine_stride + 2 * x + i;

                    if (2 * x + i >= fine->width || 2 * y + j >= fine->height ||
                        fine->blur[child] == RF_NO_BLUR)
                        continue;
                    n++;
                    blur += fine->blur[child];
                    for (int c = 0; c < 3; c++)
                        sum[c] += fine->light[c][child];
                }
            }
            coarse->blur[at] = (int16_t)(n ? blur / (int)n : RF_NO_BLUR);
            for (int c = 0; c < 3; c++)
                coarse->light[c][at] = (uint16_t)((sum[c] * share[n] + 32768) >> 16);
        }
    }
}

/* Unknown pixels take their parents' values, weighted 9, 3, 3, 1 by nearness. */
static void pull(struct rf_level *fine, ptrdiff_t fine_stride, const struct rf_level *coarse)
{
    for (int y = 0; y < fine->height; y++) {
        for (int x = 0; x < fine->width; x++) {
            const ptrdiff_t at = y * fine_stride + x;
            int px, py, ox, oy, blur;
            size_t p[4];

            if (fine->blur[at] != RF_NO_BLUR)
                continue;
            px = x / 2;
            py = y / 2;
            ox = x & 1 ? px + 1 : px - 1;
            oy = y & 1 ? py + 1 : py - 1;
            ox = ox < 0 || ox >= coarse->width ? px : ox;
            oy = oy < 0 || oy >= coarse->height ? py : oy;
            p[0] = (size_t)py * coarse->width + px;
            p[1] = (size_t)py * coarse->width + ox;
            p[2] = (size_t)oy * coarse->width + px;
            p[3] = (size_t)oy * coarse->width + ox;
            blur = 9 * coarse->blur[p[0]] + 3 * coarse->blur[p[1]] +
                   3 * coarse->blur[p[2]] + coarse->blur[p[3]] + 8;
            fine->blur[at] = (int16_t)(blur >> 4);
            for (int c = 0; c < 3; c++) {
                const uint16_t *light = coarse->light[c];

                fine->light[c][at] = (uint16_t)((9 * light[p[0]] + 3 * light[p[1]] +
                                                 3 * light[p[2]] + light[p[3]] + 8) >> 4);
            }
        }
    }
}

static void mark(const struct refocus_renderer *r, const int16_t *m)
{
    for (int y = 0; y < r->height; y++) {
        const ptrdiff_t at = y * r->stride;

        for (int x = 0; x < r->width; x++) {
            const int s = r->front.blur[at + x];
            const bool foreground = m[at + x] > s + HALF;

            r->behind.blur[at + x] = (int16_t)(foreground ? RF_NO_BLUR : s);
            for (int c = 0; c < 3; c++)
                r->behind.light[c][at + x] = r->smooth[c][at + x];
        }
    }
}

void rf_background(struct refocus_renderer *r)
{
    int16_t *m = r->behind.blur; /* read for a pixel before it is written */
    struct rf_level base = base_level(r);

    dilate(r, m);
    mark(r, m);
    for (int i = 0; i < r->levels; i++)
        push(i ? &r->level[i - 1] : &base, i ? r->level[i - 1].width : r->stride,
             &r->level[i]);
    for (int i = r->levels - 1; i >= 0; i--)
        pull(i ? &r->level[i - 1] : &base, i ? r->level[i - 1].width : r->stride,
             &r->level[i]);
}
