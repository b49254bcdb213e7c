/* Words for errors and evidence, and the limits that every reader keeps. */
#include "internal.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void rf_clean_text(char *text)
{
    for (; *text; text++) {
        if (*text < 0x20 || *text > 0x7e) {
            *text = '?';
        }
    }
}

static void write_line(char *line, size_t size, const char *format, va_list arguments)
{
    vsnprintf(line, size, format, arguments);
    rf_clean_text(line);
}

int rf_fail(struct refocus_reason *reason, int status, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    write_line(reason->text, sizeof reason->text, format, arguments);
    va_end(arguments);
    return status;
}

int rf_fail_memory(struct refocus_reason *reason)
{
    return rf_fail(reason, REFOCUS_ERR_MEMORY,
                   "not enough memory; use a smaller picture or free some memory");
}

int rf_fail_errno(struct refocus_reason *reason, int error, const char *what)
{
    char words[128];

    if (error == ENOMEM) {
        return rf_fail_memory(reason);
    }
    if (strerror_r(error, words, sizeof words) != 0) {
        snprintf(words, sizeof words, "error %d", error);
    }
    return rf_fail(reason, REFOCUS_ERR_IO, "%s: %s", what, words);
}

void rf_note(struct refocus_photo_info *info, const char *format, ...)
{
    va_list arguments;

    if (info->evidence_count >= REFOCUS_INFO_LINES) {
        return;
    }
    va_start(arguments, format);
    write_line(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH, format, arguments);
    va_end(arguments);
}

size_t rf_sample_bytes(uint32_t sample)
{
    return sample == REFOCUS_SAMPLE_F32 ? 4 : sample == REFOCUS_SAMPLE_U16 ? 2 : 1;
}

int rf_format_bytes(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_RGB8:
    case REFOCUS_FORMAT_BGR8:
        return 3;
    case REFOCUS_FORMAT_RGBA8:
    case REFOCUS_FORMAT_BGRA8:
        return 4;
    default:
        return 0;
    }
}

int rf_check_size(const struct rf_read *read, uint64_t width, uint64_t height, uint64_t pixel_bytes)
{
    if (width == 0 || height == 0) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: it claims a picture without pixels");
    }
    if (width > REFOCUS_MAX_SIDE || height > REFOCUS_MAX_SIDE) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %llu x %llu pixels are more than %d a side; scale it down",
                       (unsigned long long)width, (unsigned long long)height, REFOCUS_MAX_SIDE);
    }
    if (width * height > read->limits.max_pixels) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %llu x %llu pixels are more than the limit of %llu pixels",
                       (unsigned long long)width, (unsigned long long)height,
                       (unsigned long long)read->limits.max_pixels);
    }
    return rf_check_bytes(read, width * height * pixel_bytes, "its picture");
}

int rf_check_bytes(const struct rf_read *read, uint64_t bytes, const char *what)
{
    if (bytes > read->limits.max_bytes || bytes > PTRDIFF_MAX) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "%s needs %llu bytes, more than the limit of %llu", what,
                       (unsigned long long)bytes, (unsigned long long)read->limits.max_bytes);
    }
    return REFOCUS_OK;
}

size_t rf_raster_stride(const struct rf_raster *raster)
{
    return (size_t)raster->width * (size_t)raster->channels * rf_sample_bytes(raster->sample);
}

int rf_raster_alloc(const struct rf_read *read, struct rf_raster *raster)
{
    const size_t bytes = (size_t)raster->channels * rf_sample_bytes(raster->sample);
    const int status =
        rf_check_size(read, (uint64_t)raster->width, (uint64_t)raster->height, bytes);

    raster->pixels = NULL;
    if (status != REFOCUS_OK) {
        return status;
    }
    raster->pixels = malloc((size_t)raster->width * (size_t)raster->height * bytes);
    return raster->pixels ? REFOCUS_OK : rf_fail_memory(read->reason);
}

void rf_raster_free(struct rf_raster *raster)
{
    free(raster->pixels);
    raster->pixels = NULL;
}
