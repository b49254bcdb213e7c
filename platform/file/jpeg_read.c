/* jpeg_read.c: a JPEG photo is read: its segments are sorted, and its depth is looked for. */
#include "jpeg_read.h"

#include <stdlib.h>
#include <string.h>

#include "apple.h"
#include "dynamic.h"
#include "exif.h"
#include "gain_map_read.h"
#include "gdepth.h"
#include "icc.h"
#include "jpeg_decode.h"
#include "jpeg_walk.h"
#include "kept.h"
#include "mpf.h"
#include "own_xmp.h"
#include "reason.h"
#include "trailer.h"
#include "xmp_extended.h"
#include "xmp_parse.h"

enum { MARKER_APP1 = 0xe1, MARKER_APP2 = 0xe2, ICC_CHUNKS = 255 };

struct parts {
    struct rf_bytes exif, xmp, mpf;
    struct rf_bytes older_xmp; /* the packet in front of which our own was put */
    struct rf_bytes icc[ICC_CHUNKS];
    int icc_count; /* as the chunks say; -1: they disagree */
    size_t end;    /* the byte behind the main picture */
};

/* ICC.1, annex B.4: a chunk begins with its number, counted from 1, and the number of chunks. */
static void take_icc(struct parts *parts, struct rf_bytes chunk)
{
    int number, count;

    if (chunk.size < 2) {
        parts->icc_count = -1;
        return;
    }
    number = chunk.data[0];
    count = chunk.data[1];
    if (number < 1 || number > count || parts->icc[number - 1].data ||
        (parts->icc_count != 0 && parts->icc_count != count)) {
        parts->icc_count = -1;
        return;
    }
    parts->icc_count = count;
    parts->icc[number - 1] = (struct rf_bytes){chunk.data + 2, chunk.size - 2};
}

static void take_segment(struct parts *parts, int marker, struct rf_bytes segment)
{
    struct rf_bytes rest;

    if (marker == MARKER_APP1) {
        if (!parts->exif.data && rf_jpeg_after(segment, rf_jpeg_exif_signature, 6, &rest))
            parts->exif = rest;
        else if (!parts->xmp.data &&
                 rf_jpeg_after(segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature, &rest))
            parts->xmp = rest;
        else if (parts->xmp.data && !parts->older_xmp.data && rf_xmp_is_ours(parts->xmp) &&
                 rf_jpeg_after(segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature, &rest))
            parts->older_xmp = rest;
    } else if (marker == MARKER_APP2) {
        if (!parts->mpf.data &&
            rf_jpeg_after(segment, rf_jpeg_mpf_signature, sizeof rf_jpeg_mpf_signature, &rest))
            parts->mpf = rest;
        else if (parts->icc_count >= 0 &&
                 rf_jpeg_after(segment, rf_jpeg_icc_signature, sizeof rf_jpeg_icc_signature, &rest))
            take_icc(parts, rest);
    }
}

static int find_parts(const struct rf_read *read, struct rf_bytes file, struct parts *parts)
{
    struct rf_jpeg_walk walk;
    enum rf_jpeg_step step = RF_JPEG_DAMAGED;
    uint32_t segments = 0;

    memset(parts, 0, sizeof *parts);
    if (rf_jpeg_walk_begin(&walk, file)) {
        while ((step = rf_jpeg_walk_next(&walk)) == RF_JPEG_SEGMENT) {
            if (++segments > read->limits.max_segments) {
                return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                               "its segments are more than the limit of %u",
                               (unsigned)read->limits.max_segments);
            }
            take_segment(parts, walk.marker, walk.segment);
        }
    }
    parts->end = walk.position;
    return step == RF_JPEG_END
               ? REFOCUS_OK
               : rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                         "damaged JPEG: it ends in the middle of the picture; copy it again");
}

static int join_icc(struct rf_read *read, const struct parts *parts)
{
    struct refocus_blob profile = {NULL, 0};
    size_t position = 0;

    for (int i = 0; i < parts->icc_count; i++) {
        if (!parts->icc[i].data) {
            rf_note(read->info, "ICC profile: parts are missing, passed over");
            return REFOCUS_OK;
        }
        profile.size += parts->icc[i].size;
    }
    if (profile.size == 0) {
        if (parts->icc_count != 0)
            rf_note(read->info, "ICC profile: damaged, passed over");
        return REFOCUS_OK;
    }
    profile.data = malloc(profile.size);
    if (!profile.data)
        return rf_fail_memory(read->reason);
    for (int i = 0; i < parts->icc_count; i++) {
        memcpy(profile.data + position, parts->icc[i].data, parts->icc[i].size);
        position += parts->icc[i].size;
    }
    return rf_icc_take(read, &profile);
}

#ifdef RF_HAVE_XMP
static bool mentions(struct rf_bytes packet, const char *name)
{
    const size_t n = strlen(name);

    for (size_t i = 0; i + n <= packet.size; i++)
        if (packet.data[i] == (uint8_t)*name && memcmp(packet.data + i, name, n) == 0)
            return true;
    return false;
}

static bool mentions_depth(struct rf_bytes packet)
{
    return mentions(packet, "ns.google.com/photos/1.0/depthmap/") ||
           mentions(packet, "ns.google.com/photos/dd/1.0/depthmap/");
}

/* Editors leave XMP of hundreds of thousands of elements in photos: those without depth are as
 * good without it. */
static bool pass_over(struct rf_read *read, int status, struct rf_bytes standard,
                      struct rf_bytes packet)
{
    if ((status != REFOCUS_ERR_FORMAT && status != REFOCUS_ERR_SIZE) || mentions_depth(standard) ||
        mentions_depth(packet))
        return false;
    rf_note(read->info, "XMP: %s and without depth, passed over",
            status == REFOCUS_ERR_SIZE ? "beyond the limits" : "damaged");
    return true;
}

/* Read the standard packet and, when it names one, the extended packet. */
static int read_xmp(struct rf_read *read, struct rf_bytes file, struct rf_bytes packet,
                    struct rf_xmp *xmp)
{
    struct refocus_blob extended = {NULL, 0};
    int status = rf_xmp_parse(read, packet, xmp);

    if (pass_over(read, status, packet, packet))
        return REFOCUS_OK;
    if (status != REFOCUS_OK || !xmp->value[RF_XMP_EXTENDED])
        return status;
    status = rf_xmp_extended(read, file, xmp->value[RF_XMP_EXTENDED], xmp->length[RF_XMP_EXTENDED],
                             &extended);
    if (status == REFOCUS_OK)
        status = rf_xmp_parse(read, (struct rf_bytes){extended.data, extended.size}, xmp);
    if (status == REFOCUS_ERR_SIZE &&
        pass_over(read, status, packet, (struct rf_bytes){extended.data, extended.size}))
        status = REFOCUS_OK;
    free(extended.data);
    return status;
}

/* Take the all-in-focus original from the packet before ours, when its main picture is blurred. */
static int read_older(struct rf_read *read, struct rf_bytes file, struct rf_bytes packet,
                      struct rf_xmp *xmp)
{
    static const enum rf_xmp_key keys[] = {RF_XMP_IMAGE_MIME,    RF_XMP_IMAGE_DATA,
                                           RF_XMP_NOTE_ORIGINAL, RF_XMP_NOTE_FOCUS,
                                           RF_XMP_NOTE_BLUR,     RF_XMP_NOTE_MATTE};
    const int count = sizeof keys / sizeof *keys;
    struct rf_xmp older = {.items = 0};
    bool found;
    double blur;
    int status = read_xmp(read, file, packet, &older);

    if (status == REFOCUS_OK) {
        status =
            rf_xmp_number(read, &older, RF_XMP_FOCUS_BLUR, "GFocus:BlurAtInfinity", &found, &blur);
    }
    if (status == REFOCUS_OK && found && blur == 0.0 && !older.value[RF_XMP_NOTE_ORIGINAL]) {
        rf_xmp_free(&older);
        return REFOCUS_OK;
    }
    for (int i = 0; status == REFOCUS_OK && i < count; i++) {
        xmp->value[keys[i]] = older.value[keys[i]];
        xmp->length[keys[i]] = older.length[keys[i]];
        older.value[keys[i]] = NULL;
    }
    rf_xmp_free(&older);
    return status;
}

/* Take depth from the first container that holds some. */
static int read_depth(struct rf_read *read, struct rf_bytes file, const struct parts *parts)
{
    const struct rf_bytes main_picture = {file.data, parts->end};
    struct rf_xmp xmp = {.items = 0};
    int status = REFOCUS_OK;

    if (parts->xmp.data) {
        status = read_xmp(read, main_picture, parts->xmp, &xmp);
        if (status == REFOCUS_OK && parts->older_xmp.data)
            status = read_older(read, main_picture, parts->older_xmp, &xmp);
        if (status == REFOCUS_OK)
            status = rf_read_gdepth(read, &xmp);
        if (status == REFOCUS_OK)
            status = rf_read_dynamic(read, file, &xmp, parts->end);
    }
    rf_xmp_free(&xmp);
    if (status == REFOCUS_OK && parts->mpf.data)
        status = rf_read_apple(read, file, parts->mpf, parts->end);
    return status;
}
#else
static int read_depth(struct rf_read *read, struct rf_bytes file, const struct parts *parts)
{
    (void)file;
    if (parts->xmp.data || parts->mpf.data)
        rf_note(read->info, "XMP: passed over, this build has no expat");
    return REFOCUS_OK;
}
#endif

/* A JPEG right behind the main picture, or behind a few numbers, as Leia's tablets write. */
static struct rf_bytes find_behind(struct rf_bytes file, size_t end)
{
    enum { NUMBERS = 64 }; /* bytes */

    for (size_t begin = end; begin <= end + NUMBERS && begin < file.size; begin++) {
        const struct rf_bytes behind = {file.data + begin, file.size - begin};

        if (rf_is_jpeg(behind))
            return behind;
    }
    return (struct rf_bytes){NULL, 0};
}

/* Read the picture of an MPO that follows the first and is a whole JPEG. */
static int read_second(struct rf_read *read, struct rf_bytes file, const struct parts *parts)
{
    struct rf_mpf mpf;

    if (parts->mpf.data && rf_mpf_parse(parts->mpf, &mpf)) {
        const size_t base = (size_t)(parts->mpf.data - file.data);

        for (int i = 1; i < mpf.count; i++) {
            const uint64_t begin = base + mpf.image[i].offset;
            const uint64_t size = mpf.image[i].size;

            if (begin < parts->end || begin > file.size || size > file.size - begin || size < 4 ||
                !rf_is_jpeg((struct rf_bytes){file.data + begin, (size_t)size}))
                continue;
            read->view = RF_VIEW_PHOTO;
            return rf_read_jpeg(read, (struct rf_bytes){file.data + begin, (size_t)size});
        }
    }

    const struct rf_bytes behind = find_behind(file, parts->end);

    if (!parts->mpf.data && behind.data) {
        read->view = RF_VIEW_PHOTO;
        return rf_read_jpeg(read, behind);
    }
    return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                   "it holds one picture only; give an MPO, a stereo HEIC, or two pictures");
}

int rf_read_jpeg(struct rf_read *read, struct rf_bytes file)
{
    struct parts parts;
    int status;

    memcpy(read->info->container, "JPEG", 5);
    status = find_parts(read, file, &parts);
    if (status != REFOCUS_OK)
        return status;
    if (read->view == RF_VIEW_SECOND)
        return read_second(read, file, &parts);
    status = rf_exif_take(read, parts.exif, true);
    read->kept.original_orientation = read->kept.depth_orientation = read->orientation;
    if (status == REFOCUS_OK)
        status = join_icc(read, &parts);
    if (status == REFOCUS_OK)
        status = read_depth(read, file, &parts);
    if (status == REFOCUS_OK)
        status = rf_read_trailer(read, file, parts.end);
    if (status == REFOCUS_OK)
        status = rf_read_gain_map(read, file, parts.mpf, parts.end);
    /* A reader of depth may have put the all-in-focus original there already. */
    if (status == REFOCUS_OK && !read->image.pixels &&
        (read->picture_always || !read->samples.pixels))
        status = rf_jpeg_decode(read, (struct rf_bytes){file.data, parts.end}, &read->image);
    if (status == REFOCUS_OK)
        status = rf_keep(read, RF_KEPT_JPEG, (struct rf_bytes){file.data, parts.end});
    return status;
}
