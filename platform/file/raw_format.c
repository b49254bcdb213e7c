/* raw_format.c: camera raw as a picture format: which files are raw, and the JPEG in them that the
 * camera made for its display, where it is asked for or nothing else can be had. */
#include <string.h>

#include "codec_format.h"
#include "jpeg_walk.h"
#include "part.h"
#include "reason.h"

/* Facts that the first directory of a TIFF says. */
struct first {
    bool reduced, parts, dng, mosaic;
    int orientation; /* 1 to 8 */
};

static void take_entry(struct rf_bytes file, size_t at, struct first *first)
{
    const uint32_t tag = rf_tiff_number(file, at, 2), type = rf_tiff_number(file, at + 2, 2);
    const uint32_t value = rf_tiff_number(file, at + 8, type == 3 ? 2 : 4);

    switch (tag) {
    case 254: /* NewSubfileType */
        first->reduced = value & 1;
        break;
    case 262: /* PhotometricInterpretation: a mosaic of colours, or linear samples of one */
        first->mosaic = value == 32803 || value == 34892;
        break;
    case 274: /* Orientation */
        if (value >= 1 && value <= 8)
            first->orientation = (int)value;
        break;
    case 330: /* SubIFDs */
        first->parts = true;
        break;
    case 50706: /* DNGVersion */
        first->dng = true;
        break;
    default:
        break;
    }
}

/* The first directory of a TIFF, or of the raws that differ by a number in its header. */
static struct first look(struct rf_bytes file)
{
    struct first first = {.orientation = 1};
    uint32_t at, count;

    if (file.size < 8 || (memcmp(file.data, "II", 2) != 0 && memcmp(file.data, "MM", 2) != 0))
        return first;
    at = rf_tiff_number(file, 4, 4);
    if (at > file.size || file.size - at < 2)
        return first;
    count = rf_tiff_number(file, at, 2);
    for (uint32_t i = 0; i < count && file.size - at - 2 >= 12 * ((size_t)i + 1); i++)
        take_entry(file, (size_t)at + 2 + 12 * (size_t)i, &first);
    return first;
}

/* Whether a file begins so; a dot stands for any byte. */
static bool begins(struct rf_bytes file, const char *text, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (i >= file.size || (text[i] != '.' && file.data[i] != (uint8_t)text[i]))
            return false;
    return true;
}

static bool recognise(struct rf_bytes file)
{
    struct first first;

    /* Fujifilm, Olympus, Panasonic, Sigma, Minolta and Canon's CR3 and CR2 */
    if (begins(file, "FUJIFILMCCD-RAW", 15) || begins(file, "IIRO", 4) || begins(file, "IIRS", 4) ||
        begins(file, "MMOR", 4) || begins(file, "IIU\0", 4) || begins(file, "FOVb", 4) ||
        begins(file, "\0MRM", 4) || begins(file, "....ftypcrx ", 12) ||
        begins(file, "II*\0....CR", 10))
        return true;
    if (!begins(file, "II*\0", 4) && !begins(file, "MM\0*", 4))
        return false;
    /* DNG, and those that have a thumbnail in front and the photo in a directory below */
    first = look(file);
    return first.dng || first.mosaic || (first.reduced && first.parts);
}

/* Pixels of a JPEG of 8 bits that can be decoded; 0 for others, such as raw samples in a lossless
 * one. Bytes that were gone over are taken from the budget, and with the last one it ends. */
static uint64_t jpeg_pixels(const struct rf_read *read, struct rf_bytes jpeg, size_t *budget)
{
    struct rf_jpeg_walk walk;
    uint64_t pixels = 0;

    if (!rf_jpeg_walk_begin(&walk, jpeg))
        return 0;
    for (uint32_t i = 0; i < read->limits.max_segments && walk.position < *budget &&
                         rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT;
         i++) {
        const uint8_t *const s = walk.segment.data;

        if (walk.marker >= 0xc0 && walk.marker <= 0xcf && walk.marker != 0xc4 &&
            walk.marker != 0xc8 && walk.marker != 0xcc) {
            pixels = walk.marker <= 0xc2 && walk.segment.size >= 5 && s[0] == 8
                         ? (uint64_t)(s[1] << 8 | s[2]) * (uint64_t)(s[3] << 8 | s[4])
                         : 0;
            break;
        }
    }
    *budget -= walk.position < *budget ? walk.position : *budget;
    return pixels;
}

/* The largest JPEG in the file; empty: none. More than some are not looked at, as their bytes come
 * by chance in samples, too; nor more bytes of their headers than the file has and a megabyte, as
 * one that begins in another goes over the same ones again. */
static struct rf_bytes find_preview(const struct rf_read *read, struct rf_bytes file)
{
    struct rf_bytes best = {NULL, 0};
    uint64_t most = 0;
    size_t at = 0, budget = file.size + (1u << 20);

    for (int tried = 0; tried < 64 && file.size - at > 3;) {
        const uint8_t *const next = memchr(file.data + at, 0xff, file.size - at - 2);

        if (!next || budget == 0)
            break;
        at = (size_t)(next - file.data) + 1;
        if (next[1] == 0xd8 && next[2] == 0xff) {
            const struct rf_bytes jpeg = {next, file.size - at + 1};
            const uint64_t pixels = jpeg_pixels(read, jpeg, &budget);

            tried += pixels > 0;
            if (pixels > most) {
                most = pixels;
                best = jpeg;
            }
        }
    }
    return best;
}

static int read_preview(struct rf_read *read, struct rf_bytes file)
{
    const struct rf_bytes jpeg = find_preview(read, file);
    int status;

    if (!jpeg.data) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "camera raw without a preview in it; develop it to a TIFF or JPEG");
    }
    status = rf_decode_part(read, jpeg, "preview", &read->image);
    if (status == REFOCUS_OK) {
        memcpy(read->info->container, "raw", 4);
        read->orientation = look(file).orientation;
        rf_note(read->info, "raw: the preview in it, %d x %d pixels as the camera shows them",
                (int)read->image.width, (int)read->image.height);
    }
    return status;
}

#ifdef RF_HAVE_RAW
RF_CODEC_READ(raw)

/* Developed, or else as the preview; of two errors the first is told. */
static int develop(struct rf_read *read, struct rf_bytes file)
{
    const int status = read_raw(read, file);
    struct refocus_reason first = *read->reason;

    if (status != REFOCUS_ERR_UNSUPPORTED && status != REFOCUS_ERR_FORMAT)
        return status;
    rf_raster_free(&read->image);
    if (read_preview(read, file) == REFOCUS_OK) {
        rf_note(read->info, "raw: it is not developed: %.120s", first.text);
        return REFOCUS_OK;
    }
    *read->reason = first;
    return status;
}
#else
static int develop(struct rf_read *read, struct rf_bytes file)
{
    return read_preview(read, file);
}
#endif

static int read_either(struct rf_read *read, struct rf_bytes file)
{
    return read->limits.raw_preview ? read_preview(read, file) : develop(read, file);
}

const struct rf_format rf_format_raw = {
    .name = "raw",
    .library = "libraw",
    .recognise = recognise,
    .read = read_either,
};
