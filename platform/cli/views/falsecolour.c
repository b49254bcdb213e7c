/* falsecolour.c: disparities and blur radii are shown in colours, with a legend. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "views/falsecolour.h"
#include "views/peaking.h"
#include "outputs/text.h"

enum {
    LEGEND_HEIGHT = 34, /* a bar and two lines of text, */
    LEGEND_WIDTH = 320, /* laid out for this width and enlarged by whole numbers */
    BAR_TOP = 4,
    BAR_HEIGHT = 8,
    TICKS = 5,
};

struct colour {
    uint8_t r, g, b;
};

static const struct colour paper = {16, 16, 16}, ink = {240, 240, 240}, sharp = {0, 255, 120},
                           near_line = {255, 0, 200}, far_line = {255, 255, 255};

/* Equal steps from 0 to 1, dark to light so that it reads in grey too. */
static const struct colour ramp[] = {{24, 16, 64},   {38, 80, 180},  {28, 150, 160},
                                     {130, 190, 70}, {248, 170, 40}, {255, 245, 205}};

static struct colour colour_at(double t)
{
    enum { STEPS = sizeof ramp / sizeof *ramp - 1 };
    const double at = (t > 0 ? t < 1 ? t : 1 : 0) * STEPS;
    const int i = at < STEPS ? (int)at : STEPS - 1;
    const double part = at - i;
    const struct colour a = ramp[i], b = ramp[i + 1];

    return (struct colour){(uint8_t)(a.r + (b.r - a.r) * part + 0.5),
                           (uint8_t)(a.g + (b.g - a.g) * part + 0.5),
                           (uint8_t)(a.b + (b.b - a.b) * part + 0.5)};
}

/* A rectangle in legend units, from the corner of the legend. */
static void fill(const struct refocus_image *image, int top, int scale, int x, int y, int width,
                 int height, struct colour colour)
{
    for (int j = top + y * scale; j < top + (y + height) * scale; j++) {
        if (j < 0 || j >= image->height)
            continue;
        uint8_t *row = image->plane[0] + j * image->stride[0];
        for (int i = x * scale; i < (x + width) * scale; i++)
            if (i >= 0 && i < image->width)
                memcpy(row + 3 * i, &colour, 3);
    }
}

/* Text centred about x, but within the picture. */
static void write_text(const struct refocus_image *image, int top, int scale, int x, int y,
                       const char *text)
{
    const int width = (int)strlen(text) * (GLYPH_WIDTH + 1) - 1;
    const int room = image->width / scale - 1;

    x -= width / 2;
    x = x + width > room ? room - width : x;
    x = x < 1 ? 1 : x;
    for (; *text; text++, x += GLYPH_WIDTH + 1)
        for (int row = 0; row < GLYPH_HEIGHT; row++)
            for (int dot = 0; dot < GLYPH_WIDTH; dot++)
                if (text_dot(*text, dot, row))
                    fill(image, top, scale, x + dot, y + row, 1, 1, ink);
}

/* The picture with room for the legend; *scale is 0 where the legend does not fit. */
static struct refocus_image make_picture(int width, int height, int *scale)
{
    struct refocus_image image;
    int rows;

    *scale = width > LEGEND_WIDTH ? width / LEGEND_WIDTH : 1;
    if (height > REFOCUS_MAX_SIDE - LEGEND_HEIGHT * *scale)
        *scale = 0;
    rows = height + LEGEND_HEIGHT * *scale;
    image = refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, rows, (ptrdiff_t)width * 3);
    if ((uint64_t)width * 3 * (uint64_t)rows <= SIZE_MAX)
        image.plane[0] = malloc((size_t)width * 3 * (size_t)rows);
    return image;
}

static void paint(const struct refocus_image *image, const uint16_t *values, int height,
                  const struct colour *colours)
{
    for (int y = 0; y < height; y++) {
        uint8_t *row = image->plane[0] + y * image->stride[0];
        for (int x = 0; x < image->width; x++)
            memcpy(row + 3 * x, colours + *values++, 3);
    }
}

/* Colour bar from t = 0 to 1 over the width, with marks where the ticks are. */
static void draw_bar(const struct refocus_image *image, int top, int scale)
{
    const int width = image->width / scale;

    fill(image, top, scale, 0, 0, width + 1, LEGEND_HEIGHT, paper);
    for (int x = 4; x < width - 4; x++)
        fill(image, top, scale, x, BAR_TOP, 1, BAR_HEIGHT, colour_at((x - 4 + 0.5) / (width - 8)));
    for (int i = 0; i < TICKS; i++)
        fill(image, top, scale, 4 + i * (width - 9) / (TICKS - 1), BAR_TOP + BAR_HEIGHT, 1, 2, ink);
}

static int tick_x(const struct refocus_image *image, int scale, int i)
{
    return 4 + i * (image->width / scale - 9) / (TICKS - 1);
}

static void draw_depth_legend(const struct refocus_image *image, int top, int scale,
                              const struct refocus_depth_range *range)
{
    char text[32];

    draw_bar(image, top, scale);
    for (int i = 0; i < TICKS; i++) {
        const double d = (double)i / (TICKS - 1);

        snprintf(text, sizeof text, "%s%.4g",
                 i == 0           ? "far d "
                 : i == TICKS - 1 ? "near d "
                                  : "",
                 d);
        write_text(image, top, scale, tick_x(image, scale, i), 16, text);
        if (range) {
            snprintf(text, sizeof text, "%.3g m", refocus_depth_of_disparity(range, d));
            write_text(image, top, scale, tick_x(image, scale, i), 25, text);
        }
    }
}

/* A sample of a colour and what it stands for, which begins behind it. */
static void write_key(const struct refocus_image *image, int top, int scale, int x,
                      struct colour colour, const char *text)
{
    fill(image, top, scale, x, 25, GLYPH_HEIGHT, GLYPH_HEIGHT, colour);
    write_text(image, top, scale, x + 10 + (int)strlen(text) * (GLYPH_WIDTH + 1) / 2, 25, text);
}

/* "near 0.552 1.23 m" */
static void write_limit(char text[32], const char *name, double d,
                        const struct refocus_depth_range *range)
{
    if (d < 0 || d > 1)
        snprintf(text, 32, "%s all", name);
    else if (range)
        snprintf(text, 32, "%s %.3f %.3g m", name, d, refocus_depth_of_disparity(range, d));
    else
        snprintf(text, 32, "%s %.3f", name, d);
}

static void draw_blur_legend(const struct refocus_image *image, int top, int scale, double greatest,
                             const struct refocus_depth_range *range,
                             const struct blur_limits *limits)
{
    char text[32];

    draw_bar(image, top, scale);
    for (int i = 0; i < TICKS; i++) {
        snprintf(text, sizeof text, "%.3g px", greatest * i / (TICKS - 1));
        write_text(image, top, scale, tick_x(image, scale, i), 16, text);
    }
    write_key(image, top, scale, 4, sharp, "sharp");
    if (!limits || image->width / scale < LEGEND_WIDTH)
        return;
    write_limit(text, "near", limits->near_disparity, range);
    write_key(image, top, scale, 54, near_line, text);
    write_limit(text, "far", limits->far_disparity, range);
    write_key(image, top, scale, 184, far_line, text);
}

/* Over the sharp pixels that have one of the others within `reach` in a row or
 * column. */
static void draw_limits(const struct refocus_image *image, const uint16_t *blur,
                        const uint16_t *disparity, int height, int reach)
{
    enum { HALF_PIXEL = 128 };
    const int width = image->width;

    for (int y = 0; y < height; y++) {
        uint8_t *row = image->plane[0] + y * image->stride[0];

        for (int x = 0; x < width; x++) {
            const size_t here = (size_t)y * (size_t)width + (size_t)x;
            bool found = false;

            for (int k = 0; k < 4 * reach && blur[here] < HALF_PIXEL && !found; k++) {
                const int far = k / 4 + 1;
                const int i = x + (k % 4 == 0 ? far : k % 4 == 1 ? -far : 0);
                const int j = y + (k % 4 == 2 ? far : k % 4 == 3 ? -far : 0);
                const size_t there = (size_t)j * (size_t)width + (size_t)i;

                found = i >= 0 && i < width && j >= 0 && j < height && blur[there] >= HALF_PIXEL;
                if (found)
                    memcpy(row + 3 * x, disparity[there] > disparity[here] ? &near_line : &far_line,
                           3);
            }
        }
    }
}

static void lay_over(const struct refocus_image *image, const struct refocus_image *photo)
{
    for (int y = 0; y < photo->height; y++) {
        const uint8_t *from = photo->plane[0] + y * photo->stride[0];
        uint8_t *row = image->plane[0] + y * image->stride[0];

        for (int x = 0; x < 3 * photo->width; x++)
            row[x] = (uint8_t)((row[x] + peaking_luma(from + x - x % 3) + 1) / 2);
    }
}

/* A picture and the colours of 65536 values, or neither. */
static struct refocus_image begin(int width, int height, int *scale, struct colour **colours)
{
    struct refocus_image image = make_picture(width, height, scale);

    *colours = image.plane[0] ? malloc(65536 * sizeof **colours) : NULL;
    if (!*colours) {
        free(image.plane[0]);
        image.plane[0] = NULL;
    }
    return image;
}

struct refocus_image falsecolour_depth(const uint16_t *values, int width, int height,
                                       const struct refocus_depth_range *range,
                                       const struct refocus_image *photo)
{
    struct colour *colours;
    int scale;
    struct refocus_image image = begin(width, height, &scale, &colours);

    if (!colours)
        return image;
    for (int v = 0; v < 65536; v++)
        colours[v] = colour_at(v / 65535.0);
    paint(&image, values, height, colours);
    if (photo)
        lay_over(&image, photo);
    if (scale > 0)
        draw_depth_legend(&image, height, scale, range);
    free(colours);
    return image;
}

struct refocus_image falsecolour_blur(const uint16_t *values, const uint16_t *disparity, int width,
                                      int height, double greatest,
                                      const struct refocus_depth_range *range,
                                      const struct blur_limits *limits)
{
    struct colour *colours;
    int scale;
    struct refocus_image image = begin(width, height, &scale, &colours);

    if (!colours)
        return image;
    for (int v = 0; v < 65536; v++)
        colours[v] = v < 128 || greatest <= 0 ? sharp : colour_at(v / 256.0 / greatest);
    paint(&image, values, height, colours);
    draw_limits(&image, values, disparity, height, scale > 1 ? scale : 1);
    if (scale > 0)
        draw_blur_legend(&image, height, scale, greatest, range, limits);
    free(colours);
    return image;
}
