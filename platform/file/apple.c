/* apple.c: the depth of Apple's portrait JPEGs is found. Behind the main picture lie others, which
 * an MPF index names. The one whose own XMP says "disparity" is the depth; the HDR gain map
 * looks alike but is not, and the portrait matte says what is subject. */
#include "apple.h"

#include <string.h>

#include "depth_part.h"
#include "depth_values.h"
#include "gain_map_read.h"
#include "jpeg_walk.h"
#include "kept.h"
#include "mpf.h"
#include "reason.h"
#include "xmp_parse.h"

struct auxiliary {
    struct rf_bytes file;
    const char *place; /* "MPF", or "GImage" when it lies behind an original */
    int number;        /* as MPF counts, the main picture being 1 */
    struct rf_xmp xmp;
};

static struct rf_bytes find_xmp(struct rf_bytes file)
{
    struct rf_bytes packet = {NULL, 0};
    struct rf_jpeg_walk walk;

    if (rf_jpeg_walk_begin(&walk, file)) {
        while (!packet.data && rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT) {
            if (walk.marker == 0xe1) {
                rf_jpeg_after(walk.segment, rf_jpeg_xmp_signature, sizeof rf_jpeg_xmp_signature,
                              &packet);
            }
        }
    }
    return packet;
}

static int set_meaning(struct rf_read *read, const struct auxiliary *auxiliary, bool disparity)
{
    const struct rf_xmp *const xmp = &auxiliary->xmp;
    struct refocus_depth_map *const map = &read->depth;
    const char *const accuracy = xmp->value[RF_XMP_APPLE_ACCURACY];
    double low, high, code_low, code_high;
    bool has_low, has_high, has_code_low, has_code_high;
    int status;

    status = rf_xmp_number(read, xmp, RF_XMP_APPLE_FLOAT_MIN, "FloatMinValue", &has_low, &low);
    if (status == REFOCUS_OK) {
        status =
            rf_xmp_number(read, xmp, RF_XMP_APPLE_FLOAT_MAX, "FloatMaxValue", &has_high, &high);
    }
    if (status == REFOCUS_OK) {
        status =
            rf_xmp_number(read, xmp, RF_XMP_APPLE_INT_MIN, "IntMinValue", &has_code_low, &code_low);
    }
    if (status == REFOCUS_OK) {
        status = rf_xmp_number(read, xmp, RF_XMP_APPLE_INT_MAX, "IntMaxValue", &has_code_high,
                               &code_high);
    }
    if (status != REFOCUS_OK)
        return status;
    code_low = has_code_low ? code_low : 0.0;
    code_high = has_code_high ? code_high : read->samples.max_value;
    if (code_low >= code_high || (has_low && has_high && low >= high) ||
        (!disparity && !(has_low && has_high))) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: the range of its depth image is empty");
    }
    if (!disparity) {
        map->meaning = REFOCUS_DEPTH_DISTANCE;
        map->metres_per_unit = (high - low) / (code_high - code_low);
        map->metres_at_zero = low - code_low * map->metres_per_unit;
        rf_note(read->info, "Apple: distances from %g to %g m, bright is far", low, high);
        return REFOCUS_OK;
    }
    if (has_low && has_high) {
        rf_depth_from_disparity(map, code_low, code_high, low, high);
        rf_note(read->info, "Apple: disparity from %g to %g per metre, bright is near", low, high);
    } else {
        rf_depth_from_disparity(map, code_low, code_high, 0.0, 0.0);
        rf_note(read->info, "Apple: disparity without a range, bright is near");
    }
    if (accuracy)
        rf_note(read->info, "Apple: accuracy of the distances: %.60s", accuracy);
    return REFOCUS_OK;
}

static int take_depth(struct rf_read *read, const struct auxiliary *auxiliary, bool disparity)
{
    int status = rf_take_samples(read, auxiliary->file, "depth image");

    if (status == REFOCUS_OK) {
        rf_note(read->info, "MPF: image %d is %s by its own XMP, %d x %d samples",
                auxiliary->number, disparity ? "disparity" : "depth", (int)read->samples.width,
                (int)read->samples.height);
        status = set_meaning(read, auxiliary, disparity);
    }
    if (status == REFOCUS_OK) {
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_APPLE_MPF;
        read->info->simulated_f_number = rf_xmp_simulated_f_number(&auxiliary->xmp);
    }
    return status;
}

/* The type of iOS 12 is "depth" for mattes, too. */
static int judge(struct rf_read *read, const struct auxiliary *auxiliary)
{
    const char *const subtype = auxiliary->xmp.value[RF_XMP_APPLE_SUBTYPE];
    const char *const type = subtype ? subtype : auxiliary->xmp.value[RF_XMP_APPLE_TYPE];

    if (type && (strcmp(type, "disparity") == 0 || strcmp(type, "depth") == 0)) {
        if (!read->samples.pixels)
            return take_depth(read, auxiliary, type[1] == 'i');
        rf_note(read->info, "%s: image %d, a second depth image, passed over", auxiliary->place,
                auxiliary->number);
    } else if (type && rf_is_matte(type) && read->picture_always && !read->matte.pixels) {
        rf_note(read->info, "%s: image %d is the portrait matte: how much of a pixel is subject",
                auxiliary->place, auxiliary->number);
        rf_keep_companion(read, auxiliary->file);
        return rf_take_matte(read, auxiliary->file, "portrait matte");
    } else if (type || auxiliary->xmp.value[RF_XMP_GAIN_MAP]) {
        read->kept.gain_map |= !type || strstr(type, "hdrgainmap");
        rf_note(read->info, "%s: image %d passed over, it is no depth but \"%.80s\"",
                auxiliary->place, auxiliary->number, type ? type : "HDR gain map");
    } else {
        rf_note(read->info, "%s: image %d passed over, it says nothing of depth", auxiliary->place,
                auxiliary->number);
    }
    return REFOCUS_OK;
}

static int read_image(struct rf_read *read, struct rf_bytes file, const char *place, int number)
{
    struct auxiliary auxiliary = {.file = file, .place = place, .number = number};
    const struct rf_bytes packet = find_xmp(file);
    int status = REFOCUS_OK;

    if (packet.data)
        status = rf_xmp_parse(read, packet, &auxiliary.xmp);
    if (status == REFOCUS_OK)
        status = judge(read, &auxiliary);
    rf_xmp_free(&auxiliary.xmp);
    return status;
}

int rf_read_apple(struct rf_read *read, struct rf_bytes file, struct rf_bytes mpf_tiff,
                  size_t main_end)
{
    const size_t base = (size_t)(mpf_tiff.data - file.data);
    struct rf_mpf mpf;
    int status = REFOCUS_OK;

    if (read->samples.pixels)
        return REFOCUS_OK;
    if (!rf_mpf_parse(mpf_tiff, &mpf)) {
        rf_note(read->info, "MPF: damaged, passed over");
        return REFOCUS_OK;
    }
    for (int i = 1; i < mpf.count && status == REFOCUS_OK; i++) {
        const uint64_t begin = base + mpf.image[i].offset;
        const uint64_t end = begin + mpf.image[i].size;

        if (end > file.size && file.size > main_end) {
            return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                           "damaged: it ends before image %d of those it announces; copy it again",
                           i + 1);
        }
        if (begin < main_end || end > file.size || begin == end) {
            /* An editor that kept the index and dropped or moved the images. */
            rf_note(read->info, "MPF: image %d is not where the index says, passed over", i + 1);
            continue;
        }
        if (mpf.image[i].type == RF_MPF_VIEW) {
            rf_note_view(read->info, "MPF", i + 1);
            continue;
        }
        status =
            read_image(read, (struct rf_bytes){file.data + begin, mpf.image[i].size}, "MPF", i + 1);
    }
    return status;
}

/* The bytes of the JPEG that begins there; 0: there is no whole one. */
static size_t jpeg_size(const struct rf_read *read, struct rf_bytes file)
{
    enum rf_jpeg_step step = RF_JPEG_DAMAGED;
    struct rf_jpeg_walk walk;
    uint32_t segments = 0;

    if (!rf_is_jpeg(file) || !rf_jpeg_walk_begin(&walk, file))
        return 0;
    do {
        step = rf_jpeg_walk_next(&walk);
    } while (step == RF_JPEG_SEGMENT && ++segments <= read->limits.max_segments);
    return step == RF_JPEG_END ? walk.position : 0;
}

int rf_read_companions(struct rf_read *read, struct rf_bytes original)
{
    const size_t main_end = jpeg_size(read, original);
    size_t at = main_end, size = main_end;
    int status = REFOCUS_OK;

    if (main_end > 0)
        status = rf_read_gain_map(read, original, (struct rf_bytes){NULL, 0}, main_end);
    for (int number = 2; status == REFOCUS_OK && size > 0 && number <= RF_MPF_MAX; number++) {
        struct rf_bytes picture = {original.data + at, original.size - at};

        size = picture.size = jpeg_size(read, picture);
        if (size > 0) {
            status = read_image(read, picture, "GImage", number);
            at += size;
        }
    }
    read->companions = 0; /* the original that is kept already has them */
    return status;
}
