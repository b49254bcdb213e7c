/* pnm.c: PPM and PGM, plain and raw, of 8 and 16 bits, are read; they are written raw. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format.h"
#include "reason.h"

/* "P", the digit of the kind, and a blank or a comment. */
static bool begins(struct rf_bytes file, uint8_t plain, uint8_t raw)
{
    return file.size >= 3 && file.data[0] == 'P' &&
           (file.data[1] == plain || file.data[1] == raw) && file.data[2] != '\0' &&
           strchr("\t\n\v\f\r #", file.data[2]);
}

static bool recognise_ppm(struct rf_bytes file)
{
    return begins(file, '3', '6');
}

static bool recognise_pgm(struct rf_bytes file)
{
    return begins(file, '2', '5');
}

struct scan {
    struct rf_bytes file;
    size_t position;
};

static bool is_blank(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static void skip_blanks(struct scan *scan)
{
    while (scan->position < scan->file.size) {
        const uint8_t c = scan->file.data[scan->position];
        if (c == '#')
            while (scan->position < scan->file.size && scan->file.data[scan->position] != '\n')
                scan->position++;
        else if (is_blank(c))
            scan->position++;
        else
            return;
    }
}

/* Read a decimal number, at most 2^32 - 1. */
static bool scan_number(struct scan *scan, uint64_t *value)
{
    size_t begin;

    skip_blanks(scan);
    begin = scan->position;
    for (*value = 0; scan->position < scan->file.size; scan->position++) {
        const uint8_t byte = scan->file.data[scan->position];
        if (byte < '0' || byte > '9')
            break;
        *value = *value * 10 + (uint8_t)(byte - '0');
        if (*value > UINT32_MAX)
            return false;
    }
    return scan->position > begin;
}

static int fail_short(const struct rf_read *read)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: it ends in the middle of the picture; copy it again");
}

static int scan_header(struct rf_read *read, struct scan *scan, struct rf_raster *raster, bool raw)
{
    uint64_t width, height, max;
    int status;

    if (!scan_number(scan, &width) || !scan_number(scan, &height) || !scan_number(scan, &max) ||
        max < 1 || max > 65535) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its PNM header holds no width, height and greatest value");
    }
    raster->sample = max > 255 ? REFOCUS_SAMPLE_U16 : REFOCUS_SAMPLE_U8;
    raster->max_value = (uint32_t)max;
    status = rf_check_size(read, width, height, (uint64_t)raster->channels * (max > 255 ? 2 : 1));
    if (status != REFOCUS_OK)
        return status;
    raster->width = (int32_t)width;
    raster->height = (int32_t)height;
    if (!raw)
        return REFOCUS_OK;
    if (scan->position >= scan->file.size || !is_blank(scan->file.data[scan->position++]))
        return fail_short(read);
    return REFOCUS_OK;
}

static void put_sample(struct rf_raster *raster, size_t index, uint32_t value)
{
    if (raster->sample == REFOCUS_SAMPLE_U8)
        raster->pixels[index] = (uint8_t)value;
    else
        ((uint16_t *)(void *)raster->pixels)[index] = (uint16_t)value;
}

static int fail_value(const struct rf_read *read)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: a sample is greater than its header allows");
}

static int scan_raw(struct rf_read *read, struct scan *scan, struct rf_raster *raster)
{
    const size_t count = (size_t)raster->width * (size_t)raster->height * (size_t)raster->channels;
    const size_t bytes = raster->sample == REFOCUS_SAMPLE_U8 ? 1 : 2;
    const uint8_t *from = scan->file.data + scan->position;
    int status;

    /* This comes before memory is asked for: a header alone must not cost a gigabyte. */
    if (scan->file.size - scan->position < count * bytes)
        return fail_short(read);
    status = rf_raster_alloc(read, raster);
    for (size_t i = 0; status == REFOCUS_OK && i < count; i++, from += bytes) {
        const uint32_t value = bytes == 1 ? from[0] : (uint32_t)(from[0] << 8 | from[1]);
        if (value > raster->max_value)
            return fail_value(read);
        put_sample(raster, i, value);
    }
    return status;
}

static int scan_plain(struct rf_read *read, struct scan *scan, struct rf_raster *raster)
{
    const size_t count = (size_t)raster->width * (size_t)raster->height * (size_t)raster->channels;
    int status;

    /* A sample takes a digit and a blank; only the last needs no blank. */
    if ((scan->file.size - scan->position + 1) / 2 < count)
        return fail_short(read);
    status = rf_raster_alloc(read, raster);
    for (size_t i = 0; status == REFOCUS_OK && i < count; i++) {
        uint64_t value;
        if (!scan_number(scan, &value))
            return fail_short(read);
        if (value > raster->max_value)
            return fail_value(read);
        put_sample(raster, i, (uint32_t)value);
    }
    return status;
}

static int read_pnm(struct rf_read *read, struct rf_bytes file)
{
    struct scan scan = {file, 2};
    struct rf_raster *const raster = &read->image;
    const bool raw = file.data[1] >= '5';
    int status;

    raster->channels = file.data[1] == '3' || file.data[1] == '6' ? 3 : 1;
    snprintf(read->info->container, sizeof read->info->container, "%s",
             raster->channels == 3 ? "PPM" : "PGM");
    status = scan_header(read, &scan, raster, raw);
    if (status != REFOCUS_OK)
        return status;
    return raw ? scan_raw(read, &scan, raster) : scan_plain(read, &scan, raster);
}

/* The file wants R, G, B, or 16 bits with the high byte first. */
static void pack_row(uint8_t *to, const uint8_t *from, const struct rf_rows *rows)
{
    const bool swap = rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8;
    const int step = rf_format_bytes(rows->format);

    for (int32_t x = 0; x < rows->width; x++) {
        if (rows->format == REFOCUS_FORMAT_NONE) {
            uint16_t value;
            memcpy(&value, from + 2 * x, 2);
            *to++ = (uint8_t)(value >> 8);
            *to++ = (uint8_t)value;
        } else {
            *to++ = from[swap ? 2 : 0];
            *to++ = from[1];
            *to++ = from[swap ? 0 : 2];
            from += step;
        }
    }
}

static int write_pnm(struct rf_store *store, const struct rf_rows *rows,
                     const struct refocus_write_options *options, struct refocus_reason *reason)
{
    const bool grey = rows->format == REFOCUS_FORMAT_NONE;
    const size_t row_bytes = (size_t)rows->width * (grey ? 2 : 3);
    uint8_t *const row = malloc(row_bytes);
    char header[64];
    int n;

    (void)options;
    if (!row)
        return rf_fail_memory(reason);
    n = snprintf(header, sizeof header, "P%d\n%d %d\n%d\n", grey ? 5 : 6, (int)rows->width,
                 (int)rows->height, grey ? 65535 : 255);
    rf_store_write(store, header, (size_t)n);
    for (int32_t y = 0; y < rows->height; y++) {
        pack_row(row, rows->top + y * rows->stride, rows);
        rf_store_write(store, row, row_bytes);
    }
    free(row);
    return REFOCUS_OK;
}

const struct rf_format rf_format_ppm = {
    .name = "PPM",
    .endings = {".ppm"},
    .writes_pictures = true,
    .recognise = recognise_ppm,
    .read = read_pnm,
    .write = write_pnm,
};

const struct rf_format rf_format_pgm = {
    .name = "PGM",
    .endings = {".pgm"},
    .writes_depth = true,
    .recognise = recognise_pgm,
    .read = read_pnm,
    .write = write_pnm,
};
