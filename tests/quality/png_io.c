/* png_io.c: reads and writes PNG files for the quality tool. */
#include "png_io.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX_SIDE = 16384 };

static void refuse(png_structp png, png_const_charp why)
{
    fprintf(stderr, "refocus-quality: %s: %s\n", (const char *)png_get_error_ptr(png), why);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp why)
{
    (void)png, (void)why;
}

static void set_transforms(png_structp png, png_infop info, int channels)
{
    const int type = png_get_color_type(png, info);

    if (channels == 3) {
        png_set_expand(png);
        png_set_scale_16(png);
        png_set_strip_alpha(png);
        if (type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_GRAY_ALPHA)
            png_set_gray_to_rgb(png);
    } else {
        const uint16_t one = 1;

        if (type != PNG_COLOR_TYPE_GRAY)
            png_error(png, "not a greyscale picture");
        png_set_expand_16(png);
        if (*(const uint8_t *)&one == 1)
            png_set_swap(png);
    }
    png_read_update_info(png, info);
}

void *png_io_read(const char *path, int channels, int *width, int *height)
{
    FILE *file = fopen(path, "rb");
    png_structp png = NULL;
    png_infop info = NULL;
    uint8_t *volatile pixels = NULL;
    png_bytep *volatile rows = NULL;

    if (!file) {
        perror(path);
        return NULL;
    }
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, (void *)path, refuse, ignore);
    info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png)))
        goto fail;
    png_set_user_limits(png, MAX_SIDE, MAX_SIDE);
    png_init_io(png, file);
    png_read_info(png, info);
    set_transforms(png, info, channels);

    const size_t w = png_get_image_width(png, info), h = png_get_image_height(png, info);
    const size_t pixel = channels == 3 ? 3 : 2;
    if (png_get_rowbytes(png, info) != w * pixel)
        png_error(png, "an unexpected pixel format");
    pixels = malloc(w * h * pixel);
    rows = malloc(h * sizeof *rows);
    if (!pixels || !rows)
        png_error(png, "not enough memory");
    for (size_t y = 0; y < h; y++)
        rows[y] = pixels + y * w * pixel;
    png_read_image(png, rows);
    png_read_end(png, NULL);
    *width = (int)w;
    *height = (int)h;
    goto done;
fail:
    free(pixels);
    pixels = NULL;
done:
    free(rows);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    return pixels;
}

int png_io_write(const char *path, const uint8_t *rgb, int width, int height)
{
    FILE *file = fopen(path, "wb");
    png_structp png = NULL;
    png_infop info = NULL;
    volatile int result = -1;

    if (!file) {
        perror(path);
        return -1;
    }
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, (void *)path, refuse, ignore);
    info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png)))
        goto done;
    png_init_io(png, file);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < height; y++)
        png_write_row(png, rgb + 3 * (size_t)y * (size_t)width);
    png_write_end(png, NULL);
    result = 0;
done:
    png_destroy_write_struct(&png, &info);
    if (fclose(file) != 0 && result == 0) {
        perror(path);
        result = -1;
    }
    return result;
}
