/* sheet_picture.c: the cells of a contact sheet are put into one picture, with captions. */
#include <stdlib.h>
#include <string.h>
#include "commands/sheet_picture.h"
#include "outputs/text.h"

enum { GAP = 4, PAPER = 16 };

/* Captions of some 25 letters fit over a cell of usual width. */
static int zoom_of(int cell_width)
{
    const int zoom = cell_width / (25 * (GLYPH_WIDTH + 1));

    return zoom > 1 ? zoom : 1;
}

static int caption_height(int cell_width)
{
    return zoom_of(cell_width) * (GLYPH_HEIGHT + 3);
}

struct refocus_image sheet_picture(const struct sheet *sheet, int cell_width, int cell_height,
                                   const char **why)
{
    const int rows = (sheet->count + sheet->columns - 1) / sheet->columns;
    const int64_t width = (int64_t)sheet->columns * (cell_width + GAP) + GAP;
    const int64_t height = (int64_t)rows * (cell_height + caption_height(cell_width) + GAP) + GAP;
    struct refocus_image image = {0};

    if (width > REFOCUS_MAX_SIDE || height > REFOCUS_MAX_SIDE) {
        *why = "the sheet would be too large; give a smaller --cell-width or fewer values";
        return image;
    }
    image = refocus_image_packed(REFOCUS_FORMAT_RGB8, NULL, (int)width, (int)height,
                                 (ptrdiff_t)width * 3);
    *why = "not enough memory for the sheet; give a smaller --cell-width or fewer values";
    if ((uint64_t)width * 3 * (uint64_t)height <= SIZE_MAX)
        image.plane[0] = malloc((size_t)width * 3 * (size_t)height);
    if (image.plane[0])
        memset(image.plane[0], PAPER, (size_t)width * 3 * (size_t)height);
    return image;
}

/* sqrt(value), rounded; value at most 255^2. */
static uint8_t root(uint32_t value)
{
    uint32_t r = 0;

    for (uint32_t bit = 128; bit > 0; bit /= 2) /* the largest r with (r - 1/2)^2 <= value */
        if ((r + bit) * (r + bit - 1) < value)
            r += bit;
    return (uint8_t)r;
}

/* How much of target pixel i lies over source pixel j, of `from` pixels made `to`; in
 * units of 1 / to source pixel. */
static int64_t overlap(int i, int j, int from, int to)
{
    const int64_t begin = (int64_t)i * from, end = begin + from;
    const int64_t a = (int64_t)j * to, b = a + to;

    return (end < b ? end : b) - (begin > a ? begin : a);
}

static void average(const struct refocus_image *full, int x, int y, int width, int height,
                    uint8_t *out)
{
    const int x0 = (int)((int64_t)x * full->width / width);
    const int x1 = (int)(((int64_t)(x + 1) * full->width + width - 1) / width);
    const int y0 = (int)((int64_t)y * full->height / height);
    const int y1 = (int)(((int64_t)(y + 1) * full->height + height - 1) / height);
    const uint64_t all = (uint64_t)full->width * (uint64_t)full->height;
    uint64_t sum[3] = {0, 0, 0}; /* below 2^16 * 2^32 */

    for (int j = y0; j < y1; j++) {
        const uint8_t *row = full->plane[0] + j * full->stride[0];
        const uint64_t down = (uint64_t)overlap(y, j, full->height, height);

        for (int i = x0; i < x1; i++) {
            const uint64_t weight = down * (uint64_t)overlap(x, i, full->width, width);

            for (int c = 0; c < 3; c++)
                sum[c] += weight * row[3 * i + c] * row[3 * i + c];
        }
    }
    for (int c = 0; c < 3; c++)
        out[c] = root((uint32_t)((sum[c] + all / 2) / all));
}

void sheet_picture_put(const struct refocus_image *picture, const struct sheet *sheet, int i,
                       const struct refocus_image *full, int cell_width, int cell_height)
{
    const int zoom = zoom_of(cell_width), below = caption_height(cell_width);
    const int left = GAP + i % sheet->columns * (cell_width + GAP);
    const int top = GAP + i / sheet->columns * (cell_height + below + GAP);

    for (int y = 0; y < cell_height; y++) {
        uint8_t *row = picture->plane[0] + (top + y) * picture->stride[0] + 3 * left;

        for (int x = 0; x < cell_width; x++)
            average(full, x, y, cell_width, cell_height, row + 3 * x);
    }
    text_draw(picture, left, top + cell_height + 2 * zoom, zoom, cell_width,
              sheet->cell[i].caption);
}
