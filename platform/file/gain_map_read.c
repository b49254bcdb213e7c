/* gain_map_read.c: the gain map of a JPEG is found among the pictures behind the main one, which an
 * MPF index names, or which follow it at once as containers list them. */
#include "gain_map_read.h"

#include <math.h>
#include <string.h>

#include "gain_values.h"
#include "jpeg_walk.h"
#include "kept.h"
#include "mpf.h"
#include "part.h"
#include "reason.h"
#ifdef RF_HAVE_XMP
#include "xmp_parse.h"
#endif

/* The metadata of one of the pictures, and its bytes. */
struct candidate {
    struct rf_bytes file, xmp, iso;
};

/* Sort its segments; false when it is no whole JPEG. file.size becomes that of the picture. */
static bool sort_segments(const struct rf_read *read, struct candidate *candidate)
{
    enum rf_jpeg_step step = RF_JPEG_DAMAGED;
    struct rf_jpeg_walk walk;
    uint32_t segments = 0;

    if (!rf_is_jpeg(candidate->file) || !rf_jpeg_walk_begin(&walk, candidate->file))
        return false;
    while ((step = rf_jpeg_walk_next(&walk)) == RF_JPEG_SEGMENT &&
           ++segments <= read->limits.max_segments) {
        if (walk.marker == 0xe1 && !candidate->xmp.data) {
            rf_jpeg_after(walk.segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature,
                          &candidate->xmp);
        } else if (walk.marker == 0xe2 && !candidate->iso.data) {
            rf_jpeg_after(walk.segment, rf_jpeg_gain_signature, sizeof rf_jpeg_gain_signature,
                          &candidate->iso);
        }
    }
    candidate->file.size = walk.position;
    return step == RF_JPEG_END;
}

const char *rf_gain_from_apple(const struct rf_read *read, const struct rf_xmp *xmp,
                               double *headroom)
{
    struct refocus_reason unused = {""};
    struct rf_read quiet = *read;
    bool found;

    quiet.reason = &unused;
    if (rf_xmp_number(&quiet, xmp, RF_XMP_APPLE_HEADROOM, "headroom", &found, headroom) || !found)
        *headroom = read->apple_headroom;
    return *headroom >= 1 && *headroom <= 65536 ? NULL : "the photo does not say its headroom";
}

/* Reads its XMP. *is_map: whether it says that this is a gain map at all. */
static int judge_xmp(struct rf_read *read, const struct candidate *candidate, bool *is_map,
                     const char **why, double *headroom)
{
#ifdef RF_HAVE_XMP
    struct rf_xmp xmp = {.items = 0};
    const char *type;
    int status = rf_xmp_parse(read, candidate->xmp, &xmp);

    if (status == REFOCUS_OK && xmp.value[RF_XMP_GAIN_MAP]) {
        *is_map = true;
        *why = rf_gain_from_xmp(&xmp, &read->gain->values);
    }
    type = xmp.value[RF_XMP_APPLE_TYPE];
    if (status == REFOCUS_OK && type &&
        strcmp(type, "urn:com:apple:photo:2020:aux:hdrgainmap") == 0) {
        *is_map = true;
        *why = rf_gain_from_apple(read, &xmp, headroom);
    }
    rf_xmp_free(&xmp);
    return status == REFOCUS_ERR_MEMORY ? status : REFOCUS_OK;
#else
    (void)read;
    (void)candidate;
    (void)is_map;
    (void)why;
    (void)headroom;
    return REFOCUS_OK;
#endif
}

void rf_gain_settle(struct rf_read *read, const char *why, double headroom)
{
    struct rf_gain_map *const map = read->gain;
    double stops = 0, most = 0;

    if (!why && (map->samples.sample != REFOCUS_SAMPLE_U8 || map->samples.max_value != 255))
        why = "its samples are not of 8 bits";
    if (why) {
        rf_note(read->info, "gain map: passed over, %s", why);
        rf_raster_free(&map->samples);
        return;
    }
    if (headroom > 0)
        rf_gain_make_apple(map, headroom);
    else
        rf_gain_make_curves(map);
    for (int c = 0; c < 3; c++) {
        const struct rf_gain_values *const v = &map->values;

        stops = fmax(stops, v->greatest[c]);
        most = fmax(most, (1 + v->base_offset[c]) * exp2(v->greatest[c]) - v->other_offset[c]);
    }
    read->info->gain_map_stops = stops;
    rf_note(read->info, "gain map: %d x %d samples, up to %.3g times white",
            (int)map->samples.width, (int)map->samples.height, most);
}

/* Metadata of ISO 21496-1, else the XMP beside it, which says the same in more files. */
static int judge(struct rf_read *read, const struct candidate *candidate, bool *is_map,
                 const char **why, double *headroom)
{
    if (candidate->iso.data) {
        *is_map = true;
        *why = rf_gain_from_iso(candidate->iso, &read->gain->values);
    }
    return candidate->xmp.data && (!candidate->iso.data || *why)
               ? judge_xmp(read, candidate, is_map, why, headroom)
               : REFOCUS_OK;
}

static int try_picture(struct rf_read *read, struct candidate *candidate)
{
    struct refocus_reason unused = {""};
    struct rf_read quiet = *read;
    const char *why = NULL;
    bool is_map = false;
    double headroom = 0;
    int status = REFOCUS_OK;

    quiet.reason = &unused;
    if (!sort_segments(read, candidate))
        return REFOCUS_OK;
    status = judge(&quiet, candidate, &is_map, &why, &headroom);
    if (status == REFOCUS_OK && is_map && !why) {
        status = rf_decode_part(&quiet, candidate->file, "gain map", &read->gain->samples);
        if (status != REFOCUS_OK && status != REFOCUS_ERR_MEMORY) {
            why = status == REFOCUS_ERR_SIZE ? "it is beyond the limits" : "it is damaged";
            status = REFOCUS_OK;
        }
    }
    if (status != REFOCUS_OK)
        return rf_fail_memory(read->reason);
    if (is_map) {
        rf_gain_settle(read, why, headroom);
        if (read->gain->samples.pixels)
            rf_keep_companion(read, candidate->file);
    }
    return REFOCUS_OK;
}

int rf_read_gain_map(struct rf_read *read, struct rf_bytes file, struct rf_bytes mpf_tiff,
                     size_t main_end)
{
    struct rf_mpf mpf = {0};
    size_t next = main_end;
    int status = REFOCUS_OK;
    bool indexed;

    if (!read->gain || read->info->original_used)
        return REFOCUS_OK;
    indexed = mpf_tiff.data && rf_mpf_parse(mpf_tiff, &mpf);
    for (int i = 1; i < (indexed ? mpf.count : RF_MPF_MAX) && status == REFOCUS_OK &&
                    !read->gain->samples.pixels;
         i++) {
        struct candidate candidate = {{NULL, 0}, {NULL, 0}, {NULL, 0}};
        const uint64_t base = indexed ? (uint64_t)(mpf_tiff.data - file.data) : next;
        const uint64_t begin = base + (indexed ? mpf.image[i].offset : 0);

        if (begin >= main_end && begin < file.size) {
            const uint64_t room = file.size - begin;
            const uint64_t size = indexed ? mpf.image[i].size : room;

            candidate.file.data = file.data + begin;
            candidate.file.size = (size_t)(size < room ? size : room);
            status = try_picture(read, &candidate);
        } else if (!indexed) {
            break;
        }
        next = (size_t)begin + candidate.file.size;
    }
    return status;
}
