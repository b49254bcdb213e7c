/* compare_picture.c: labelled crops of all renderings are put into one picture. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "compare/compare_picture.h"
#include "outputs/text.h"

enum {
    CROPS = 3,
    CROP = 96,
    ZOOM = 2,
    GAP = 4,
    LINE = ZOOM * (GLYPH_HEIGHT + 2),
};

struct place {
    int x, y;
};

static uint32_t jump(const uint16_t *d, int width, int height, int x, int y)
{
    const size_t at = (size_t)y * (size_t)width + (size_t)x;
    const int right = x + 1 < width ? abs(d[at] - d[at + 1]) : 0;
    const int below = y + 1 < height ? abs(d[at] - d[at + (size_t)width]) : 0;

    return (uint32_t)((right > below ? right : below) >> 8);
}

static uint64_t jumps(const uint16_t *d, int width, int height, struct place at, int w, int h)
{
    uint64_t sum = 0;

    for (int y = at.y; y < at.y + h; y++)
        for (int x = at.x; x < at.x + w; x++)
            sum += jump(d, width, height, x, y);
    return sum;
}

/* The crops with the most depth edges in them that do not overlap. Returns how many. */
static int find_crops(const uint16_t *d, int width, int height, int w, int h,
                      struct place place[CROPS])
{
    enum { STEP = 16 };
    int count = 0;

    for (; count < CROPS; count++) {
        uint64_t most = 0;

        for (int y = 0; y + h <= height; y += STEP) {
            for (int x = 0; x + w <= width; x += STEP) {
                const struct place at = {x, y};
                uint64_t sum;
                bool free_here = true;

                for (int i = 0; i < count; i++)
                    free_here = free_here && (abs(place[i].x - x) >= w || abs(place[i].y - y) >= h);
                sum = free_here ? jumps(d, width, height, at, w, h) : 0;
                if (sum > most || (free_here && count == 0 && most == 0 && x == 0 && y == 0)) {
                    most = sum;
                    place[count] = at;
                }
            }
        }
        if (most == 0 && count > 0)
            break;
    }
    return count;
}

static void draw_crop(const struct refocus_image *image, int left, int top, const uint8_t *rgb,
                      int width, struct place at, int w, int h)
{
    for (int y = 0; y < h * ZOOM; y++) {
        uint8_t *row = image->plane[0] + (top + y) * image->stride[0] + 3 * left;

        for (int x = 0; x < w * ZOOM; x++)
            memcpy(row + 3 * x,
                   rgb +
                       3 * ((size_t)(at.y + y / ZOOM) * (size_t)width + (size_t)(at.x + x / ZOOM)),
                   3);
    }
}

/* Letters that fit into a line above a crop, one at least. */
static int letters_of(int w)
{
    const int letters = w / (GLYPH_WIDTH + 1);

    return letters > 0 ? letters : 1;
}

/* Lines that the options behind a method's name take, one at least. */
static int lines_of(const struct compared *item, int letters)
{
    const int length = (int)strlen(item->name + strcspn(item->name, ":"));

    return length > 1 ? (length - 2) / letters + 1 : 1;
}

/* The name of a method, its options in `lines` lines, and its score. */
static void label(const struct refocus_image *image, const struct compared *item, int left, int w,
                  int lines)
{
    const int letters = letters_of(w), length = (int)strcspn(item->name, ":");
    const char *options = item->name + length + (item->name[length] == ':');
    char text[64];

    snprintf(text, sizeof text, "%.*s", length, item->name);
    text_draw(image, left, GAP, ZOOM, w * ZOOM, text);
    for (int i = 1; *options; i++) {
        snprintf(text, sizeof text, "%.*s", letters, options);
        text_draw(image, left, GAP + i * LINE, ZOOM, w * ZOOM, text);
        options += strlen(text);
    }
    if (!item->scored)
        return;
    snprintf(text, sizeof text, "%.2f db", item->scores.psnr);
    text_draw(image, left, GAP + (lines + 1) * LINE, ZOOM, w * ZOOM, text);
}

struct refocus_image compare_picture(const struct comparison *c, const uint16_t *disparity)
{
    const int w = c->width < CROP ? c->width : CROP, h = c->height < CROP ? c->height : CROP;
    struct place place[CROPS];
    const int crops = find_crops(disparity, c->width, c->height, w, h, place);
    const int cell_w = w * ZOOM + GAP, cell_h = h * ZOOM + GAP;
    const int width = c->count * cell_w + GAP;
    int lines = 1, top, height;
    struct refocus_image image;

    for (int i = 0; i < c->count; i++)
        if (lines_of(&c->item[i], letters_of(w)) > lines)
            lines = lines_of(&c->item[i], letters_of(w));
    top = (lines + 2) * LINE + 2 * GAP;
    height = top + crops * cell_h + GAP;
    image = refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, width, height, (ptrdiff_t)width * 3);

    image.plane[0] = malloc((size_t)width * 3 * (size_t)height);
    if (!image.plane[0])
        return image;
    memset(image.plane[0], 16, (size_t)width * 3 * (size_t)height);
    for (int i = 0; i < c->count; i++) {
        const struct compared *item = &c->item[i];
        const int left = GAP + i * cell_w;

        label(&image, item, left, w, lines);
        for (int k = 0; k < crops; k++)
            draw_crop(&image, left, top + k * cell_h, item->rgb, c->width, place[k], w, h);
    }
    return image;
}
