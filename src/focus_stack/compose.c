/* compose.c: the photo of a focus stack that is in focus everywhere, and its depth, row by row. */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <string.h>

#define ONE_Q32 4294967296.0

enum { FADE = 128 }; /* frames fade over this part of the longer side where they end */

struct rf_stack_line rf_stack_line(const struct refocus_stack *s,
                                   const struct rf_stack_frame *frame, double x, double y,
                                   double step)
{
    const struct rf_similarity *m = &frame->from_reference;
    const double mx = 0.5 * (s->width - 1), my = 0.5 * (s->height - 1);
    const double u = x - mx, v = y - my;
    const struct rf_stack_line line = {
        .x = llrint((m->c[0] * u - m->c[1] * v + m->t[0] + mx) * ONE_Q32),
        .y = llrint((m->c[1] * u + m->c[0] * v + m->t[1] + my) * ONE_Q32),
        .dx = llrint(m->c[0] * step * ONE_Q32),
        .dy = llrint(m->c[1] * step * ONE_Q32),
    };

    return line;
}

/* Weights of four pixels by the cubic of Catmull and Rom, Q9; their sum is 512. */
static void cubic(int weight[4], int t)
{
    /* t is Q6. */
    const int t2 = t * t, t3 = t2 * t;

    weight[0] = (-4096 * t + 128 * t2 - t3 + 512) >> 10;
    weight[2] = (4096 * t + 256 * t2 - 3 * t3 + 512) >> 10;
    weight[3] = (t3 - 64 * t2 + 512) >> 10;
    weight[1] = 512 - weight[0] - weight[2] - weight[3];
}

static uint8_t code_of(int v)
{
    return (uint8_t)rf_stack_clamp(v, 255);
}

/* The pixel of a frame at a place, Q32. */
static void pixel_at(const struct refocus_stack *s, const struct rf_stack_frame *frame,
                     uint8_t out[3], int64_t x, int64_t y)
{
    const int64_t px = (x + (1 << 25)) >> 26, py = (y + (1 << 25)) >> 26; /* Q6 */
    const int column = (int)(px >> 6), row = (int)(py >> 6);
    const int u = (int)(px & 63), v = (int)(py & 63);
    const size_t stride = 3 * (size_t)s->width;
    int across[4], down[4], sum[3] = {0};

    if (!u && !v) {
        memcpy(out,
               frame->rgb + (size_t)rf_stack_clamp(row, s->height - 1) * stride +
                   3 * (size_t)rf_stack_clamp(column, s->width - 1),
               3);
        return;
    }
    cubic(across, u);
    cubic(down, v);
    for (int j = 0; j < 4; j++) {
        const uint8_t *in =
            frame->rgb + (size_t)rf_stack_clamp(row + j - 1, s->height - 1) * stride;
        int line[3] = {0};

        for (int i = 0; i < 4; i++) {
            const uint8_t *p = in + 3 * rf_stack_clamp(column + i - 1, s->width - 1);

            for (int c = 0; c < 3; c++)
                line[c] += across[i] * p[c];
        }
        for (int c = 0; c < 3; c++)
            sum[c] += down[j] * line[c];
    }
    for (int c = 0; c < 3; c++)
        out[c] = code_of((sum[c] + (1 << 17)) >> 18);
}

/* The share of the farther frame, Q8: 3 t^2 - 2 t^3, so that each counts most where it is sharp. */
static int share_of(int t)
{
    return (3 * 256 * t * t - 2 * t * t * t + 32768) >> 16;
}

uint16_t rf_stack_focus(const struct refocus_stack *s, uint16_t depth)
{
    const int k = rf_stack_clamp(depth >> 8, s->count - 2);

    return (uint16_t)(256 * k + share_of(depth - 256 * k));
}

/* Where a row of the photo lies in a frame, and what moves there. */
struct line {
    struct rf_stack_line at;
    struct rf_stack_mask moving;
};

bool rf_stack_reaches(const struct refocus_stack *s, const struct rf_stack_line *line, int x)
{
    const int64_t half = INT64_C(1) << 31, one = INT64_C(1) << 32;
    const int64_t px = line->x + x * line->dx + half, py = line->y + x * line->dy + half;

    return px >= 0 && py >= 0 && px < s->width * one && py < s->height * one;
}

/* The share of a pixel that a side of a frame leaves to it: the frame ends `here` pixels away, the
 * photo `there`, Q8 each. Where both end together all is left. */
static int share_beside(int64_t here, int64_t there, int64_t most)
{
    const int64_t gap = there - here < most ? there - here : most;

    return here < gap ? (int)(here > 0 ? 256 * here / gap : 0) : 256;
}

/* The share of pixel (x, y) that is of a frame, Q8: the focus breathes and hands shake, so some do
 * not reach the border of the photo, and things move. It fades towards either. */
static int share_of_frame(const struct refocus_stack *s, const struct line *line, int x, int y)
{
    const int64_t longer = s->width > s->height ? s->width : s->height;
    const int64_t most = (longer + FADE - 1) / FADE * 256;
    const int64_t right = s->width * INT64_C(256), below = s->height * INT64_C(256);
    const int64_t px = ((line->at.x + x * line->at.dx) >> 24) + 128;
    const int64_t py = ((line->at.y + x * line->at.dy) >> 24) + 128;
    const int64_t ux = 256 * (int64_t)x + 128, uy = 256 * (int64_t)y + 128;
    int share = 256 - rf_stack_moving_share(s, &line->moving, x);

    if (px < most || py < most || px > right - most || py > below - most) {
        share = share * share_beside(px, ux, most) >> 8;
        share = share * share_beside(py, uy, most) >> 8;
        share = share * share_beside(right - px, right - ux, most) >> 8;
        share = share * share_beside(below - py, below - uy, most) >> 8;
    }
    return share;
}

/* Takes a pixel from frame k and, where that leaves a share, from those next to it towards the
 * reference, which has all. */
static void pixel_of(const struct refocus_stack *s, const struct line *line, int k, int x, int y,
                     uint8_t out[3])
{
    int left = 256;

    for (;; k += k < s->still ? 1 : -1) {
        const struct rf_stack_line *at = &line[k].at;
        const int share = k == s->still ? 256 : share_of_frame(s, &line[k], x, y);
        const int now = (left * share + 128) >> 8, before = 256 - left;
        uint8_t pixel[3];

        if (now) {
            pixel_at(s, &s->frame[k], pixel, at->x + x * at->dx, at->y + x * at->dy);
            for (int c = 0; c < 3; c++)
                out[c] = before
                             ? (uint8_t)((out[c] * before + pixel[c] * now + (before + now) / 2) /
                                         (before + now))
                             : pixel[c];
        }
        left -= now;
        if (left == 0)
            return;
    }
}

bool rf_stack_pixel(const struct refocus_stack *s, int k, int x, int y, uint8_t out[3])
{
    const struct rf_stack_line at = rf_stack_line(s, &s->frame[k], x, y, 1);

    if (!rf_stack_reaches(s, &at, 0) ||
        rf_stack_moves(rf_stack_moving_row(s, k, y), rf_stack_moving_column(s, x)))
        return false;
    pixel_at(s, &s->frame[k], out, at.x, at.y);
    return true;
}

void rf_stack_compose_row(const struct refocus_stack *s, uint8_t *out, const uint16_t *depth, int y)
{
    struct line line[REFOCUS_STACK_MOST_FRAMES];

    for (int k = 0; k < s->count; k++) {
        line[k].at = rf_stack_line(s, &s->frame[k], 0, y, 1);
        line[k].moving = rf_stack_moving_mask(s, k, y);
    }
    for (int x = 0; x < s->width; x++, out += 3) {
        const int k = rf_stack_clamp(depth[x] >> 8, s->count - 2);
        const int share = share_of(depth[x] - 256 * k);
        uint8_t a[3] = {0}, b[3] = {0};

        if (share < 256)
            pixel_of(s, line, k, x, y, a);
        if (share > 0)
            pixel_of(s, line, k + 1, x, y, b);
        for (int c = 0; c < 3; c++)
            out[c] = share == 0     ? a[c]
                     : share == 256 ? b[c]
                                    : (uint8_t)((a[c] * (256 - share) + b[c] * share + 128) >> 8);
    }
}

/* The frame that shows a sample in focus. */
static int frame_of(const struct refocus_stack *s, size_t at)
{
    return s->kind == REFOCUS_STACK_FOCUS ? (s->depth[at] / s->sub + 128) >> 8 : s->still;
}

/* How much a pixel has of the depth of each of the four samples around it, which are fewer than
 * pixels: by how near they are and how alike in colour (Kopf et al. 2007). */
static void weigh(const struct refocus_stack *s, int x, int y, size_t at[4], uint64_t weight[4])
{
    enum { EDGE = 8 * 8, MOST = 1 << 12 }; /* squared codes that halve a weight; the greatest */
    const int px = (2 * x + 1) * 128 / s->reduced - 128; /* Q8 samples */
    const int py = (2 * y + 1) * 128 / s->reduced - 128;
    uint8_t pixel[3];
    int shown = -1;

    for (int i = 0; i < 4; i++) {
        const int u = i & 1 ? px & 255 : 256 - (px & 255);
        const int v = i & 2 ? py & 255 : 256 - (py & 255);
        const int column = rf_stack_clamp((px >> 8) + (i & 1), s->columns - 1);
        const int row = rf_stack_clamp((py >> 8) + (i >> 1), s->rows - 1);

        at[i] = (size_t)row * (size_t)s->columns + (size_t)column;

        const int k = frame_of(s, at[i]);

        if (k != shown && !rf_stack_pixel(s, k, x, y, pixel))
            rf_stack_pixel(s, s->still, x, y, pixel);
        shown = k;

        const int d = rf_stack_difference(pixel, s->guide + 3 * at[i]);

        weight[i] = (uint64_t)(u * v + 1) * (uint64_t)(MOST * EDGE / (EDGE + d * d));
    }
}

/* A pixel of a focus stack is on one surface: between two, other frames would be in focus. */
static void upsample_row(const struct refocus_stack *s, uint16_t *depth, int y)
{
    const int near = s->kind == REFOCUS_STACK_FOCUS ? 256 * s->sub : UINT16_MAX;

    for (int x = 0; x < s->width; x++) {
        uint64_t weight[4], sum = 0, weights = 0;
        size_t at[4];
        int best = 0;

        weigh(s, x, y, at, weight);
        for (int i = 1; i < 4; i++)
            best = weight[i] > weight[best] ? i : best;
        for (int i = 0; i < 4; i++)
            if (abs(s->depth[at[i]] - s->depth[at[best]]) <= near) {
                sum += weight[i] * s->depth[at[i]];
                weights += weight[i];
            }
        depth[x] = (uint16_t)(sum / weights / (uint64_t)s->sub);
    }
}

void rf_stack_depth_row(const struct refocus_stack *s, uint16_t *depth, uint8_t *sure, int y)
{
    const int row = rf_stack_clamp(y / s->reduced, s->rows - 1);
    const uint16_t *in = s->depth + (size_t)row * (size_t)s->columns;

    for (int x = 0; x < s->width; x++) {
        const int column = rf_stack_clamp(x / s->reduced, s->columns - 1);

        depth[x] = (uint16_t)(in[column] / s->sub);
        sure[x] = s->sure[(size_t)row * (size_t)s->columns + (size_t)column];
    }
    if (s->reduced > 1)
        upsample_row(s, depth, y);
}
