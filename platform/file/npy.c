/* npy.c: NumPy's arrays (.npy, versions 1 to 3), which programs around depth networks write, are
 * read as depth. Behind the header the samples follow each other from the top left on, row by row
 * or column by column. Integers of 8 and of 16 bits without a sign stay what they are, all others
 * become floats.
 */
#include "npy.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "half.h"
#include "npy_header.h"
#include "reason.h"

/* Leave two sides: batches of one map and maps of one channel have more. */
static void drop_ones(struct rf_npy_header *header)
{
    while (header->sides > 2 && header->side[0] == 1)
        memmove(header->side, header->side + 1, (size_t)--header->sides * sizeof *header->side);
    while (header->sides > 2 && header->side[header->sides - 1] == 1)
        header->sides--;
}

/* Bytes of a sample; 0: it is no number. */
static size_t bytes_of(const struct rf_npy_header *header)
{
    static const char *const numbers[] = {"u1", "i1", "u2", "i2", "f2", "u4",
                                          "i4", "f4", "u8", "i8", "f8"};

    for (size_t i = 0; strchr("<>|", header->descr[0]) && i < sizeof numbers / sizeof *numbers; i++)
        if (strcmp(header->descr + 1, numbers[i]) == 0)
            return (size_t)(numbers[i][1] - '0');
    return 0;
}

static float float_of(double value)
{
    return fabs(value) <= FLT_MAX ? (float)value
           : value > 0            ? INFINITY
           : value < 0            ? -INFINITY
                                  : NAN;
}

static float half_of(uint16_t bits)
{
    const uint16_t half = bits & 0x7fff;
    const float value = half <= RF_HALF_MOST       ? rf_half_value(half)
                        : half == RF_HALF_MOST + 1 ? INFINITY
                                                   : NAN;

    return bits > 0x7fff ? -value : value;
}

static float value_of(char kind, size_t bytes, uint64_t bits)
{
    const uint32_t low = (uint32_t)bits;
    double eight;
    float four;

    if (kind == 'u')
        return (float)bits;
    if (kind == 'i') {
        const unsigned unused = 64 - 8 * (unsigned)bytes;
        return (float)((int64_t)(bits << unused) / (INT64_C(1) << unused));
    }
    if (bytes == 2)
        return half_of((uint16_t)bits);
    if (bytes == 4) {
        memcpy(&four, &low, sizeof four);
        return four;
    }
    memcpy(&eight, &bits, sizeof eight);
    return float_of(eight);
}

static void put_sample(struct rf_raster *raster, size_t index, const struct rf_npy_header *header,
                       size_t bytes, const uint8_t *from)
{
    const bool high_first = header->descr[0] == '>';
    uint64_t bits = 0;

    for (size_t i = 0; i < bytes; i++)
        bits = bits << 8 | from[high_first ? i : bytes - 1 - i];
    if (raster->sample == REFOCUS_SAMPLE_U8)
        raster->pixels[index] = (uint8_t)bits;
    else if (raster->sample == REFOCUS_SAMPLE_U16)
        ((uint16_t *)(void *)raster->pixels)[index] = (uint16_t)bits;
    else
        ((float *)(void *)raster->pixels)[index] = value_of(header->descr[1], bytes, bits);
}

static int fail_short(const struct rf_read *read)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: it ends in the middle of the map; copy it again");
}

static int fail_header(const struct rf_read *read)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                   "damaged: its NPY header holds no type, order and shape");
}

/* The header's text. */
static int pull_header(struct rf_read *read, rf_npy_pull pull, void *from, char **text,
                       uint64_t *bytes)
{
    uint8_t begin[12];
    size_t length, given;
    int status;

    if (!pull(from, begin, 8) || !rf_is_npy((struct rf_bytes){begin, 8}))
        return fail_header(read);
    if (begin[6] < 1 || begin[6] > 3) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is NPY of version %d; 1 to 3 are read", begin[6]);
    }
    given = begin[6] == 1 ? 2 : 4;
    if (!pull(from, begin + 8, given))
        return fail_header(read);
    length = rf_little_endian(begin + 8, given);
    status = rf_check_metadata(read, length, "its header");
    if (status != REFOCUS_OK)
        return status;
    if (8 + given + length > *bytes)
        return fail_header(read);
    *bytes -= 8 + given + length;
    *text = calloc(1, length + 1);
    if (!*text)
        return rf_fail_memory(read->reason);
    return pull(from, (uint8_t *)*text, length) ? REFOCUS_OK : fail_header(read);
}

static int fail_sides(const struct rf_read *read, const struct rf_npy_header *header)
{
    return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                   "its array has %d sides%s; a depth map has two, height and width", header->sides,
                   header->sides > 2 ? " that are longer than 1" : "");
}

/* Lines of samples, rows or columns, as they come. */
static int pull_samples(struct rf_read *read, rf_npy_pull pull, void *from,
                        const struct rf_npy_header *header)
{
    struct rf_raster *const raster = &read->samples;
    const size_t width = (size_t)raster->width, height = (size_t)raster->height;
    const size_t lines = header->columns ? width : height,
                 length = header->columns ? height : width;
    const size_t bytes = bytes_of(header), to_next = header->columns ? width : 1;
    uint8_t *const line = malloc(length * bytes);
    size_t done = 0;

    if (!line)
        return rf_fail_memory(read->reason);
    for (; done < lines && pull(from, line, length * bytes); done++) {
        const size_t first = header->columns ? done : done * width;

        for (size_t i = 0; i < length; i++)
            put_sample(raster, first + i * to_next, header, bytes, line + i * bytes);
    }
    free(line);
    return done == lines ? REFOCUS_OK : fail_short(read);
}

static int read_samples(struct rf_read *read, rf_npy_pull pull, void *from,
                        struct rf_npy_header *header, uint64_t left)
{
    struct rf_raster *const raster = &read->samples;
    const size_t bytes = bytes_of(header);
    int status;

    if (bytes == 0) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "its array holds neither integers nor floats of 16 to 64 bits");
    }
    drop_ones(header);
    if (header->sides != 2)
        return fail_sides(read, header);
    status = rf_check_size(read, header->side[1], header->side[0], bytes);
    if (status != REFOCUS_OK)
        return status;
    if (left < header->side[0] * header->side[1] * bytes)
        return fail_short(read);
    raster->width = (int32_t)header->side[1];
    raster->height = (int32_t)header->side[0];
    raster->channels = 1;
    raster->sample = strcmp(header->descr + 1, "u1") == 0   ? REFOCUS_SAMPLE_U8
                     : strcmp(header->descr + 1, "u2") == 0 ? REFOCUS_SAMPLE_U16
                                                            : REFOCUS_SAMPLE_F32;
    raster->max_value = raster->sample == REFOCUS_SAMPLE_U8    ? 255
                        : raster->sample == REFOCUS_SAMPLE_U16 ? 65535
                                                               : 0;
    status = rf_raster_alloc(read, raster);
    return status == REFOCUS_OK ? pull_samples(read, pull, from, header) : status;
}

int rf_npy_read(struct rf_read *read, rf_npy_pull pull, void *from, uint64_t bytes)
{
    struct rf_npy_header header;
    char *text = NULL;
    int status;

    if (read->picture_always) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is a depth map, not a photo; give it as the depth");
    }
    status = pull_header(read, pull, from, &text, &bytes);
    if (status == REFOCUS_OK && !rf_npy_scan(text, &header))
        status = fail_header(read);
    free(text);
    if (status == REFOCUS_OK)
        status = read_samples(read, pull, from, &header, bytes);
    if (status == REFOCUS_OK) {
        rf_note(read->info, "NPY: samples %s, %s by %s", header.descr,
                header.columns ? "column" : "row", header.columns ? "column" : "row");
    }
    return status;
}

bool rf_is_npy(struct rf_bytes file)
{
    return file.size >= 6 && memcmp(file.data, "\x93NUMPY", 6) == 0;
}
