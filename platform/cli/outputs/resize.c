/* resize.c: pictures are made smaller by the mean of areas, in linear light. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/status.h>
#include "outputs/resize.h"

/* A whole number of 1 to 65535 at *text, which moves behind it; 0: there is none. */
static int read_side(const char **text)
{
    int side = 0;

    for (; **text >= '0' && **text <= '9' && side <= REFOCUS_MAX_SIDE; (*text)++)
        side = 10 * side + (**text - '0');
    return side <= REFOCUS_MAX_SIDE ? side : 0;
}

bool resize_parse(const char *text, struct resize *size)
{
    const size_t digits = strspn(text, "0123456789.");

    memset(size, 0, sizeof *size);
    if (text[digits] == '%' && text[digits + 1] == '\0' && digits > 0) {
        char *end;

        size->part = strtod(text, &end) / 100;
        return end == text + digits && size->part > 0 && size->part <= 1;
    }
    size->width = read_side(&text);
    if (*text != 'x')
        return size->width > 0 && *text == '\0';
    text++;
    size->height = read_side(&text);
    return size->width > 0 && size->height > 0 && *text == '\0';
}

void resize_fit(const struct resize *size, int width, int height, int *new_width, int *new_height)
{
    double part = size->part > 0 ? size->part : 1;

    if (size->width > 0)
        part = fmin(part, (double)size->width / width);
    if (size->height > 0)
        part = fmin(part, (double)size->height / height);
    *new_width = (int)fmax(1, floor(width * part + 0.5));
    *new_height = (int)fmax(1, floor(height * part + 0.5));
}

/* How stored values become light and light becomes them again. */
struct curve {
    uint32_t transfer;
    double gamma;
};

static double to_light(const struct curve *curve, double value)
{
    if (curve->transfer == REFOCUS_TRANSFER_LINEAR)
        return value;
    if (curve->transfer == REFOCUS_TRANSFER_GAMMA)
        return pow(value, curve->gamma);
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static double from_light(const struct curve *curve, double light)
{
    if (curve->transfer == REFOCUS_TRANSFER_LINEAR)
        return light;
    if (curve->transfer == REFOCUS_TRANSFER_GAMMA)
        return pow(light, 1 / curve->gamma);
    return light <= 0.0031308 ? light * 12.92 : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

static int find_curve(const struct refocus_image *picture, struct curve *curve)
{
    const bool floats = picture->format == REFOCUS_FORMAT_RGB_FLOAT;

    curve->transfer = picture->transfer != REFOCUS_TRANSFER_DEFAULT ? picture->transfer
                      : floats                                      ? REFOCUS_TRANSFER_LINEAR
                                                                    : REFOCUS_TRANSFER_SRGB;
    curve->gamma = picture->gamma > 0 ? (double)picture->gamma : 2.2;
    if (picture->format != REFOCUS_FORMAT_RGB8 && picture->format != REFOCUS_FORMAT_RGB16 &&
        !floats)
        return REFOCUS_ERR_UNSUPPORTED;
    return curve->transfer == REFOCUS_TRANSFER_SRGB || curve->transfer == REFOCUS_TRANSFER_LINEAR ||
                   curve->transfer == REFOCUS_TRANSFER_GAMMA
               ? REFOCUS_OK
               : REFOCUS_ERR_UNSUPPORTED;
}

/* The whole work: light of each code, one row of sums, and the pictures. */
struct work {
    const struct refocus_image *from;
    struct refocus_image *to;
    struct curve curve;
    float *table; /* light of each code of 8 or 16 bits; NULL: of floats */
    double *sums; /* 3 a pixel of a row of `to` */
};

static double light_at(const struct work *work, const uint8_t *row, int sample)
{
    if (work->from->format == REFOCUS_FORMAT_RGB8)
        return (double)work->table[row[sample]];
    if (work->from->format == REFOCUS_FORMAT_RGB16)
        return (double)work->table[((const uint16_t *)(const void *)row)[sample]];
    return to_light(&work->curve, (double)((const float *)(const void *)row)[sample]);
}

/* How much of the pixel at `at` lies between two positions. */
static double covered(int at, double from, double to)
{
    return fmin(at + 1, to) - fmax(at, from);
}

static void add_row(struct work *work, int y, double weight)
{
    const struct refocus_image *from = work->from;
    const uint8_t *row = (const uint8_t *)from->plane[0] + y * from->stride[0];
    const double step = (double)from->width / work->to->width;

    for (int x = 0; x < work->to->width; x++) {
        const double begin = x * step, end = fmin((x + 1) * step, from->width);

        for (int i = (int)begin; i < end; i++) {
            const double share = weight * covered(i, begin, end);

            for (int c = 0; c < 3; c++)
                work->sums[3 * x + c] += share * light_at(work, row, 3 * i + c);
        }
    }
}

static void store_row(const struct work *work, int y, double area)
{
    uint8_t *row = (uint8_t *)work->to->plane[0] + y * work->to->stride[0];

    for (int i = 0; i < 3 * work->to->width; i++) {
        const double value = from_light(&work->curve, work->sums[i] / area);

        if (work->to->format == REFOCUS_FORMAT_RGB_FLOAT)
            ((float *)(void *)row)[i] = (float)value;
        else if (work->to->format == REFOCUS_FORMAT_RGB16)
            ((uint16_t *)(void *)row)[i] = (uint16_t)(fmin(value, 1) * 65535 + 0.5);
        else
            row[i] = (uint8_t)(fmin(value, 1) * 255 + 0.5);
    }
}

static void shrink(struct work *work)
{
    const double step = (double)work->from->height / work->to->height;
    const double area = step * work->from->width / work->to->width;

    for (int y = 0; y < work->to->height; y++) {
        const double begin = y * step, end = fmin((y + 1) * step, work->from->height);

        memset(work->sums, 0, (size_t)work->to->width * 3 * sizeof *work->sums);
        for (int i = (int)begin; i < end; i++)
            add_row(work, i, covered(i, begin, end));
        store_row(work, y, area);
    }
}

/* Light of each code; NULL without memory. */
static float *make_table(const struct curve *curve, uint32_t format)
{
    const int codes = format == REFOCUS_FORMAT_RGB8 ? 256 : 65536;
    float *table = malloc((size_t)codes * sizeof *table);

    for (int i = 0; table && i < codes; i++)
        table[i] = (float)to_light(curve, (double)i / (codes - 1));
    return table;
}

int resize_image(const struct refocus_image *picture, int width, int height,
                 struct refocus_image *small)
{
    struct work work = {.from = picture, .to = small};
    const int bytes = refocus_format_bytes(picture->format);
    const size_t size = (size_t)width * (size_t)height * (size_t)bytes;
    int status = find_curve(picture, &work.curve);

    if (status != REFOCUS_OK)
        return status;
    *small = *picture;
    small->width = width;
    small->height = height;
    small->stride[0] = (ptrdiff_t)width * bytes;
    small->plane[0] = malloc(size);
    work.sums = malloc((size_t)width * 3 * sizeof *work.sums);
    if (picture->format != REFOCUS_FORMAT_RGB_FLOAT)
        work.table = make_table(&work.curve, picture->format);
    if (small->plane[0] && work.sums && (work.table || picture->format == REFOCUS_FORMAT_RGB_FLOAT))
        shrink(&work);
    else
        status = REFOCUS_ERR_MEMORY;
    free(work.table);
    free(work.sums);
    if (status != REFOCUS_OK)
        free(small->plane[0]);
    return status;
}
