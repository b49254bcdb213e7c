/* apng.c: an animated PNG is put together from pictures of the PNG writer. */
#include "outputs/apng.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "line/interrupt.h"

enum { SIGNATURE = 8, HEADER = 25, CHUNK_REST = 12 };

struct apng {
    FILE *file;
    char beside[PATH_MAX]; /* where frames lie on their way, as a picture's name */
    int width, height, frames, written;
    uint16_t delay[2]; /* seconds of a frame: numerator, denominator */
    uint32_t sequence;
    char *picture; /* the frame that is on its way, or NULL */
};

static void put32(uint8_t *to, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(v >> (24 - 8 * i));
}

static uint32_t get32(const uint8_t *from)
{
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

/* CRC-32 of PNG, a bit at a time. */
static uint32_t crc_of(uint32_t crc, const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (crc & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return crc;
}

static bool put(struct apng *a, const void *bytes, size_t size)
{
    return size == 0 || fwrite(bytes, 1, size, a->file) == size;
}

/* A chunk whose data are two runs of bytes. */
static bool put_chunk(struct apng *a, const char *type, const uint8_t *first, size_t first_size,
                      const uint8_t *second, size_t second_size)
{
    uint8_t head[8], tail[4];
    uint32_t crc;

    put32(head, (uint32_t)(first_size + second_size));
    memcpy(head + 4, type, 4);
    crc = crc_of(UINT32_MAX, head + 4, 4);
    crc = crc_of(crc, first, first_size);
    crc = crc_of(crc, second, second_size);
    put32(tail, ~crc);
    return put(a, head, 8) && put(a, first, first_size) && put(a, second, second_size) &&
           put(a, tail, 4);
}

static int cannot_write(struct refocus_reason *reason)
{
    snprintf(reason->text, sizeof reason->text, "cannot write it: %s",
             strerror(errno ? errno : EIO));
    return REFOCUS_ERR_IO;
}

/* The least fraction that is nearest to 1 / fps: 1001/30000 of 29.97002997. */
static void set_delay(struct apng *a, double fps)
{
    double best = INFINITY;

    for (int n = 1; n * fps + 0.5 < 65536; n++) {
        const double d = floor(n * fps + 0.5), off = fabs(d / n - fps);

        if (d >= 1 && off < best - 1e-12 * fps) {
            best = off;
            a->delay[0] = (uint16_t)n;
            a->delay[1] = (uint16_t)d;
        }
    }
}

int apng_open(struct apng **apng, const char *path, int width, int height, double fps, int frames,
              struct refocus_reason *reason)
{
    struct apng *a = calloc(1, sizeof *a);

    *apng = a;
    if (!a) {
        snprintf(reason->text, sizeof reason->text, "not enough memory");
        return REFOCUS_ERR_MEMORY;
    }
    a->width = width;
    a->height = height;
    a->frames = frames;
    set_delay(a, fps);
    if (snprintf(a->beside, sizeof a->beside, "%s.png", path) >= (int)sizeof a->beside) {
        snprintf(reason->text, sizeof reason->text, "the name is too long");
        return REFOCUS_ERR_ARGUMENT;
    }
    errno = 0;
    a->file = fopen(path, "wbe");
    return a->file ? REFOCUS_OK : cannot_write(reason);
}

/* Signature, header and how many frames there are, from the first picture. */
static bool begin(struct apng *a, const uint8_t *png)
{
    uint8_t control[8];

    put32(control, (uint32_t)a->frames);
    put32(control + 4, 0); /* repeated for ever */
    return put(a, png, SIGNATURE + HEADER) &&
           put_chunk(a, "acTL", control, sizeof control, NULL, 0);
}

static bool put_control(struct apng *a)
{
    uint8_t control[26] = {0};

    put32(control, a->sequence++);
    put32(control + 4, (uint32_t)a->width);
    put32(control + 8, (uint32_t)a->height);
    for (int i = 0; i < 2; i++) {
        control[20 + 2 * i] = (uint8_t)(a->delay[i] >> 8);
        control[21 + 2 * i] = (uint8_t)a->delay[i];
    }
    return put_chunk(a, "fcTL", control, sizeof control, NULL, 0);
}

/* The pixels of a whole PNG: IDAT of the first frame, fdAT with a number of the
 * others. */
static bool put_pixels(struct apng *a, const uint8_t *png, size_t size)
{
    for (size_t at = SIGNATURE; at + CHUNK_REST <= size;) {
        const size_t length = get32(png + at);
        uint8_t number[4];

        if (length > size - at - CHUNK_REST)
            return false;
        if (memcmp(png + at + 4, "IDAT", 4) == 0) {
            put32(number, a->sequence);
            if (a->written > 0)
                a->sequence++;
            if (!put_chunk(a, a->written > 0 ? "fdAT" : "IDAT", number, a->written > 0 ? 4 : 0,
                           png + at + 8, length))
                return false;
        }
        at += length + CHUNK_REST;
    }
    return true;
}

void apng_take_away(const struct apng *a)
{
    if (a && a->picture)
        unlink(a->picture);
}

int apng_write(struct apng *a, const struct refocus_image *image, struct refocus_reason *reason)
{
    struct refocus_blob png = {NULL, 0};
    const struct refocus_write_options options = {.struct_size =
                                                      sizeof(struct refocus_write_options),
                                                  .unsynced = 1,
                                                  .cancelled = interrupt_cancels};
    int status;

    interrupt_hold(true);
    status = refocus_file_temporary(a->beside, &a->picture, reason);
    interrupt_hold(false);
    if (status != REFOCUS_OK)
        return status;
    status = refocus_image_write(a->picture, image, &options, reason);
    if (status == REFOCUS_OK)
        status = refocus_file_read(a->picture, UINT32_MAX, &png, reason);
    interrupt_hold(true);
    apng_take_away(a);
    free(a->picture);
    a->picture = NULL;
    interrupt_hold(false);
    if (status != REFOCUS_OK)
        return status;
    errno = 0;
    if (png.size < SIGNATURE + HEADER || (a->written == 0 && !begin(a, png.data)) ||
        !put_control(a) || !put_pixels(a, png.data, png.size))
        status = cannot_write(reason);
    free(png.data);
    a->written++;
    return status;
}

int apng_close(struct apng *a, struct refocus_reason *reason)
{
    int status = REFOCUS_OK;

    if (!a)
        return REFOCUS_OK;
    errno = 0;
    if (a->file && !put_chunk(a, "IEND", NULL, 0, NULL, 0))
        status = cannot_write(reason);
    if (a->file && fclose(a->file) != 0 && status == REFOCUS_OK)
        status = cannot_write(reason);
    free(a);
    return status;
}
