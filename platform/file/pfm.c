/* pfm.c: PFM, 32-bit floats of depth or of linear light in three colours, is read and written. Rows
 * run from the bottom up, and the sign of the scale says the byte order. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format.h"
#include "number.h"
#include "reason.h"

static bool recognise(struct rf_bytes file)
{
    return file.size >= 3 && file.data[0] == 'P' && (file.data[1] == 'f' || file.data[1] == 'F') &&
           file.data[2] != '\0' && strchr("\t\n\v\f\r #", file.data[2]);
}

static bool is_blank(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* The next word of the header; false when the file ends or the word is too long. */
static bool scan_word(struct rf_bytes file, size_t *position, char *word, size_t size)
{
    size_t n = 0;

    while (*position < file.size && is_blank(file.data[*position]))
        ++*position;
    while (*position < file.size && !is_blank(file.data[*position])) {
        if (n + 1 >= size)
            return false;
        word[n++] = (char)file.data[(*position)++];
    }
    word[n] = '\0';
    return n > 0;
}

static bool scan_side(struct rf_bytes file, size_t *position, uint64_t *side)
{
    char word[32];
    double value;

    if (!scan_word(file, position, word, sizeof word) || !rf_parse_number(word, &value) ||
        value < 0 || value > 4294967295.0 || value != floor(value))
        return false;
    *side = (uint64_t)value;
    return true;
}

static float load_float(const uint8_t *b, bool little_endian)
{
    const uint32_t bits = little_endian ? rf_little_endian(b, 4) : rf_big_endian(b, 4);
    float value;

    memcpy(&value, &bits, 4);
    return value;
}

static int read_pfm(struct rf_read *read, struct rf_bytes file)
{
    const bool colour = file.data[1] == 'F';
    struct rf_raster *const raster = colour ? &read->image : &read->samples;
    const size_t channels = colour ? 3 : 1;
    size_t position = 2, stride;
    uint64_t width, height;
    char word[32];
    double scale;
    int status;

    snprintf(read->info->container, sizeof read->info->container, "PFM");
    if (colour && !read->picture_always) {
        return rf_fail(read->reason, REFOCUS_ERR_NO_DEPTH,
                       "it is a PFM of three colours, not a depth map; give one of the "
                       "kind \"Pf\"");
    }
    if (!colour && read->picture_always) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is a depth map, not a photo; give it as the depth");
    }
    if (!scan_side(file, &position, &width) || !scan_side(file, &position, &height) ||
        !scan_word(file, &position, word, sizeof word) || !rf_parse_number(word, &scale) ||
        scale == 0.0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its PFM header holds no width, height and scale");
    }
    status = rf_check_size(read, width, height, 4 * channels);
    if (status != REFOCUS_OK)
        return status;
    /* One blank ends the header; programs of Windows end a line with two, where there is a byte
     * more for it. */
    if (position + 1 < file.size && memcmp(file.data + position, "\r\n", 2) == 0 &&
        file.size - position - 1 > width * height * 4 * channels)
        position++;
    if (position >= file.size || file.size - position - 1 < width * height * 4 * channels) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: it ends in the middle of the %s; copy it again",
                       colour ? "picture" : "map");
    }
    raster->width = (int32_t)width;
    raster->height = (int32_t)height;
    raster->channels = (int32_t)channels;
    raster->sample = REFOCUS_SAMPLE_F32;
    status = rf_raster_alloc(read, raster);
    if (status != REFOCUS_OK)
        return status;
    stride = (size_t)width * 4 * channels;
    for (size_t y = 0; y < height; y++) {
        const uint8_t *const from = file.data + position + 1 + (height - 1 - y) * stride;
        float *const to = (float *)(void *)(raster->pixels + y * stride);
        for (size_t x = 0; x < width * channels; x++)
            to[x] = load_float(from + 4 * x, scale < 0);
    }
    rf_note(read->info, "PFM: 32-bit floats, %s byte first, bottom row first",
            scale < 0 ? "low" : "high");
    if (fabs(scale) != 1.0)
        rf_note(read->info, "PFM: its scale factor %g is not applied", fabs(scale));
    return REFOCUS_OK;
}

/* Sample x of a row, in the order R, G, B where it is a picture. */
static float sample_of(const struct rf_rows *rows, const uint8_t *row, int64_t x)
{
    uint16_t sample;
    float value;

    if (rows->format == REFOCUS_FORMAT_RGB_FLOAT) {
        memcpy(&value, row + 4 * x, 4);
        return value;
    }
    if (rows->format == REFOCUS_FORMAT_NONE) {
        memcpy(&sample, row + 2 * x, 2);
        return (float)(sample / 65535.0);
    }
    if (rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8)
        x += 2 - 2 * (x % 3);
    value = (float)row[x / 3 * rf_format_bytes(rows->format) + x % 3] / 255;
    return value <= 0.04045f ? value / 12.92f : powf((value + 0.055f) / 1.055f, 2.4f);
}

static int write_pfm(struct rf_store *store, const struct rf_rows *rows,
                     const struct refocus_write_options *options, struct refocus_reason *reason)
{
    const bool grey = rows->format == REFOCUS_FORMAT_NONE;
    const int64_t n = (int64_t)rows->width * (grey ? 1 : 3);
    uint8_t *const row = malloc((size_t)n * 4);
    char header[64];
    int length;

    (void)options;
    if (!row)
        return rf_fail_memory(reason);
    length = snprintf(header, sizeof header, "P%c\n%d %d\n-1.0\n", grey ? 'f' : 'F',
                      (int)rows->width, (int)rows->height);
    rf_store_write(store, header, (size_t)length);
    for (int32_t y = rows->height - 1; y >= 0; y--) {
        const uint8_t *const from = rows->top + y * rows->stride;
        for (int64_t x = 0; x < n; x++) {
            const float value = sample_of(rows, from, x);
            uint32_t bits;

            memcpy(&bits, &value, 4);
            for (int i = 0; i < 4; i++)
                row[4 * x + i] = (uint8_t)(bits >> (8 * i));
        }
        rf_store_write(store, row, (size_t)n * 4);
    }
    free(row);
    return REFOCUS_OK;
}

const struct rf_format rf_format_pfm = {
    .name = "PFM",
    .endings = {".pfm"},
    .writes_pictures = true,
    .writes_depth = true,
    .deep = REFOCUS_FORMAT_RGB_FLOAT,
    .recognise = recognise,
    .read = read_pfm,
    .write = write_pfm,
};
