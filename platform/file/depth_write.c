/* depth_write.c: depth is put into a JPEG that exists, as GDepth in a standard and an extended XMP
 * packet of our own, in front of the first segment that is neither JFIF nor EXIF. All other bytes
 * stay. */
#include <stdlib.h>
#include <string.h>

#include <refocus/platform/file.h>

#include "formats.h"
#include "gdepth_write.h"
#include "jpeg_segments.h"
#include "jpeg_walk.h"
#include "load.h"
#include "md5.h"
#include "own_xmp.h"
#include "reason.h"
#include "store.h"
#include "text.h"

#define RDF                                                                                        \
    "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"                          \
    "<rdf:Description rdf:about=\"\""
#define CLOSING "/></rdf:RDF></x:xmpmeta>"
#define GDEPTH  " xmlns:GDepth=\"http://ns.google.com/photos/1.0/depthmap/\""
#define NOTE                                                                                       \
    " xmlns:xmpNote=\"http://ns.adobe.com/xmp/note/\" "                                            \
    "xmpNote:HasExtendedXMP=\""

static void make_standard(struct rf_text *text, const struct refocus_depth_write *depth,
                          int orientation, const char *guid)
{
    rf_text_words(text, RF_XMP_OPENING RDF GDEPTH NOTE);
    rf_text_words(text, guid);
    rf_text_words(text, "\"");
    rf_gdepth_put(text, depth, orientation);
    rf_text_words(text, CLOSING);
}

/* Whether a segment is of a packet that an earlier writing left; its GUID comes
 * first. */
static bool is_old(struct rf_bytes segment, char guid[33])
{
    const size_t before = sizeof(RF_XMP_OPENING RDF GDEPTH NOTE) - 1;
    struct rf_bytes rest;

    if (rf_jpeg_after(segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature, &rest) &&
        rf_xmp_is_ours(rest)) {
        if (rest.size >= before + 32)
            memcpy(guid, rest.data + before, 32);
        return true;
    }
    return guid[0] &&
           rf_jpeg_after(segment, rf_jpeg_extended_signature, sizeof rf_jpeg_extended_signature,
                         &rest) &&
           rest.size >= 32 && memcmp(rest.data, guid, 32) == 0;
}

/* Copy the original and put the packets in. */
static int splice(struct rf_store *store, struct rf_bytes file, const struct rf_text *standard,
                  const struct rf_text *extended, const char *guid, struct refocus_reason *reason)
{
    struct rf_jpeg_walk walk;
    enum rf_jpeg_step step;
    char old[33] = "";
    size_t copied = 0;
    bool placed = false;

    if (!rf_jpeg_walk_begin(&walk, file)) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "depth is saved into JPEG photos; the photo is none");
    }
    while ((step = rf_jpeg_walk_next(&walk)) == RF_JPEG_SEGMENT) {
        const size_t begin = (size_t)(walk.segment.data - file.data) - 4;
        struct rf_bytes rest;
        const bool head = walk.marker == RF_JPEG_APP0 ||
                          (walk.marker == RF_JPEG_APP1 &&
                           rf_jpeg_after(walk.segment, rf_jpeg_exif_signature, 6, &rest));
        const bool skip = walk.marker == RF_JPEG_APP1 && is_old(walk.segment, old);

        if ((!head && !placed) || skip) {
            rf_store_write(store, file.data + copied, begin - copied);
            copied = begin;
        }
        if (!head && !placed) {
            rf_jpeg_put_xmp(store, rf_text_bytes(standard));
            rf_jpeg_put_extended(store, rf_text_bytes(extended), guid);
            placed = true;
        }
        if (skip)
            copied = walk.position;
    }
    if (step != RF_JPEG_END || !placed) {
        return rf_fail(reason, REFOCUS_ERR_FORMAT,
                       "damaged JPEG: it ends in the middle of the picture; copy it again");
    }
    rf_store_write(store, file.data + copied, file.size - copied);
    return REFOCUS_OK;
}

static int write_all(const char *path, struct rf_bytes file, int orientation,
                     const struct refocus_depth_write *depth, struct refocus_reason *reason)
{
    struct rf_text standard = {NULL, 0, 0, false}, extended = {NULL, 0, 0, false};
    struct rf_store store;
    char guid[33];
    int status;

    rf_text_words(&extended, RF_XMP_OPENING RDF GDEPTH);
    status = rf_gdepth_put_data(&extended, depth, orientation, reason);
    rf_text_words(&extended, CLOSING);
    if (status != REFOCUS_OK) {
        free(extended.data);
        return status;
    }
    if (!extended.failed) {
        rf_md5_hex(rf_text_bytes(&extended), guid);
        make_standard(&standard, depth, orientation, guid);
    }
    if (standard.failed || extended.failed)
        status = rf_fail_memory(reason);
    else if (extended.size > UINT32_MAX)
        status = rf_fail(reason, REFOCUS_ERR_SIZE, "the depth is too large for XMP");
    if (status == REFOCUS_OK) {
        status = rf_store_open(&store, path, reason);
        if (status == REFOCUS_OK) {
            status = splice(&store, file, &standard, &extended, guid, reason);
            status = rf_store_close(&store, status, reason);
        }
    }
    free(standard.data);
    free(extended.data);
    return status;
}

int refocus_photo_write_depth(const char *path, const char *original,
                              const struct refocus_depth_write *depth,
                              struct refocus_reason *reason)
{
    const struct rf_format *const jpeg = rf_format_of_name(".jpg"), *const png =
                                                                        rf_format_of_name(".png");
    struct refocus_reason unused;
    struct refocus_photo *photo = NULL;
    struct refocus_blob file = {NULL, 0};
    struct refocus_depth_write own;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if ((status = refocus_struct_read(&own, sizeof own,
                                      REFOCUS_SIZE_TO(struct refocus_depth_write, blur_at_infinity),
                                      depth)))
        return rf_fail(reason, status, "the depth is not of a known size of struct");
    depth = &own;
    if (!path || !original || !rf_gdepth_is_good(depth))
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "the depth is out of its range");
    if (!jpeg->read || !png->write) {
        return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                       "depth in JPEG needs TurboJPEG and libpng, which this build lacks");
    }
    status = rf_load(original, UINT32_MAX, NULL, reason, &file);
    if (status != REFOCUS_OK)
        return status;
    /* Read as a whole: no depth goes into what cannot be opened again. */
    status = refocus_photo_read_memory(&photo, file.data, file.size, NULL, reason);
    if (status == REFOCUS_OK) {
        status = write_all(path, (struct rf_bytes){file.data, file.size}, photo->info->orientation,
                           depth, reason);
    }
    refocus_photo_free(&photo);
    free(file.data);
    return status;
}
