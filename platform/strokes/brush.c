/* brush.c: distances from the path of a stroke, and the pixels under its brush. */
#include <math.h>
#include <string.h>
#include "brush.h"

struct rf_area rf_brush_area(const struct rf_stroke *stroke, double margin, int32_t width,
                             int32_t height)
{
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    struct rf_area area;

    for (int32_t i = 0; i < stroke->count; i++) {
        const double x = (double)stroke->points[2 * i], y = (double)stroke->points[2 * i + 1];

        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
    }
    x0 = floor(x0 - margin);
    y0 = floor(y0 - margin);
    x1 = ceil(x1 + margin) + 1;
    y1 = ceil(y1 + margin) + 1;
    area.x = x0 > 0 ? (int32_t)x0 : 0;
    area.y = y0 > 0 ? (int32_t)y0 : 0;
    area.width = (x1 < width ? (int32_t)x1 : width) - area.x;
    area.height = (y1 < height ? (int32_t)y1 : height) - area.y;
    return area;
}

/* A point on the right or lower side of the picture is of its last pixels. */
static void mark(struct rf_area area, uint16_t *distance, double x, double y)
{
    int32_t column = (int32_t)x - area.x, row = (int32_t)y - area.y;

    column = column < area.width ? column : area.width - 1;
    row = row < area.height ? row : area.height - 1;
    if (column >= 0 && row >= 0)
        distance[(size_t)row * (size_t)area.width + (size_t)column] = 0;
}

/* The path as pixels that touch each other, 0 in a field of RF_FAR. */
static void draw_path(const struct rf_stroke *stroke, int level, struct rf_area area,
                      uint16_t *distance)
{
    const double scale = ldexp(1, -level);
    const float *const p = stroke->points;

    for (int32_t i = 0; i < stroke->count; i++) {
        const int32_t before = i > 0 ? i - 1 : 0;
        const double x0 = ((double)p[2 * before] + 0.5) * scale;
        const double y0 = ((double)p[2 * before + 1] + 0.5) * scale;
        const double x1 = ((double)p[2 * i] + 0.5) * scale;
        const double y1 = ((double)p[2 * i + 1] + 0.5) * scale;
        const int32_t steps = (int32_t)ceil(fmax(fabs(x1 - x0), fabs(y1 - y0))) + 1;

        for (int32_t s = 0; s <= steps; s++)
            mark(area, distance, x0 + (x1 - x0) * s / steps, y0 + (y1 - y0) * s / steps);
    }
}

static inline void reach(uint16_t *at, uint32_t other, uint32_t step)
{
    if (other + step < *at)
        *at = (uint16_t)(other + step);
}

/* Chamfer distance: 5 to the side, 7 across; within 4 % of 5 pixels. */
static void spread(uint16_t *distance, int32_t width, int32_t height)
{
    for (int32_t y = 0; y < height; y++) {
        uint16_t *const row = distance + (size_t)y * (size_t)width;
        const uint16_t *const above = row - width;

        for (int32_t x = 0; x < width; x++) {
            if (x > 0)
                reach(row + x, row[x - 1], 5);
            if (y == 0)
                continue;
            reach(row + x, above[x], 5);
            if (x > 0)
                reach(row + x, above[x - 1], 7);
            if (x + 1 < width)
                reach(row + x, above[x + 1], 7);
        }
    }
    for (int32_t y = height - 1; y >= 0; y--) {
        uint16_t *const row = distance + (size_t)y * (size_t)width;
        const uint16_t *const below = row + width;

        for (int32_t x = width - 1; x >= 0; x--) {
            if (x + 1 < width)
                reach(row + x, row[x + 1], 5);
            if (y + 1 == height)
                continue;
            reach(row + x, below[x], 5);
            if (x > 0)
                reach(row + x, below[x - 1], 7);
            if (x + 1 < width)
                reach(row + x, below[x + 1], 7);
        }
    }
}

void rf_brush_distance(const struct rf_stroke *stroke, int level, struct rf_area area,
                       uint16_t *distance)
{
    const int64_t pixels = rf_area_pixels(area);
    /* Chamfer units to sixteenths of a radius, 16 bits after the point. */
    const double radius = ldexp((double)stroke->stroke.radius, -level);
    const uint64_t scale = (uint64_t)(65536.0 * RF_RADIUS / (5 * radius) + 0.5);

    for (int64_t i = 0; i < pixels; i++)
        distance[i] = RF_FAR;
    draw_path(stroke, level, area, distance);
    spread(distance, area.width, area.height);
    for (int64_t i = 0; i < pixels; i++) {
        const uint64_t scaled = (distance[i] * scale) >> 16;

        distance[i] = distance[i] == RF_FAR || scaled > RF_FAR ? RF_FAR : (uint16_t)scaled;
    }
}

struct span {
    double from, to;
};

static void widen(struct span *span, double x)
{
    span->from = x < span->from ? x : span->from;
    span->to = x > span->to ? x : span->to;
}

static void widen_by_disc(struct span *span, double x, double dy, double radius)
{
    const double half = radius * radius - dy * dy;

    if (half >= 0) {
        widen(span, x - sqrt(half));
        widen(span, x + sqrt(half));
    }
}

/* The place where row y meets the line between two points, if it does. */
static void widen_by_line(struct span *span, double y, double x0, double y0, double x1, double y1)
{
    if ((y0 <= y && y <= y1) || (y1 <= y && y <= y0)) {
        widen(span, y0 < y1 || y1 < y0 ? x0 + (x1 - x0) * ((y - y0) / (y1 - y0)) : x0);
        if (!(y0 < y1 || y1 < y0))
            widen(span, x1);
    }
}

/* The pixels within the radius of the line between two points are convex, so a span in every row.
 */
static void cover_segment(const float *a, const float *b, double radius, struct rf_area area,
                          uint8_t *mask)
{
    const double x0 = (double)a[0], y0 = (double)a[1], x1 = (double)b[0], y1 = (double)b[1];
    const double length = sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0));
    const double nx = length > 0 ? (y0 - y1) / length * radius : 0;
    const double ny = length > 0 ? (x1 - x0) / length * radius : 0;
    const double top = ceil(fmin(y0, y1) - radius), bottom = floor(fmax(y0, y1) + radius);
    const int32_t first = top > area.y ? (int32_t)top : area.y;
    const int32_t last =
        bottom < area.y + area.height - 1 ? (int32_t)bottom : area.y + area.height - 1;

    for (int32_t y = first; y <= last; y++) {
        struct span span = {INFINITY, -INFINITY};
        int32_t from, to;

        widen_by_disc(&span, x0, y - y0, radius);
        widen_by_disc(&span, x1, y - y1, radius);
        widen_by_line(&span, y, x0 + nx, y0 + ny, x1 + nx, y1 + ny);
        widen_by_line(&span, y, x0 - nx, y0 - ny, x1 - nx, y1 - ny);
        if (!(span.from <= area.x + area.width && span.to >= area.x))
            continue;
        from = span.from > area.x ? (int32_t)ceil(span.from) : area.x;
        to = span.to < area.x + area.width - 1 ? (int32_t)floor(span.to) + 1 : area.x + area.width;
        if (from < to)
            memset(mask + (size_t)(y - area.y) * (size_t)area.width + (size_t)(from - area.x), 1,
                   (size_t)(to - from));
    }
}

void rf_brush_cover(const struct rf_stroke *stroke, struct rf_area area, uint8_t *mask)
{
    for (int32_t i = 0; i < stroke->count; i++) {
        const float *const p = stroke->points + 2 * (size_t)i;

        cover_segment(i > 0 ? p - 2 : p, p, (double)stroke->stroke.radius, area, mask);
    }
}
