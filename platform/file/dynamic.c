/* dynamic.c: Dynamic Depth 1.0 is read, which Android phones write, and the container directory
 * that it shares with Ultra HDR and motion photos: pictures lie behind the main one, in the order
 * of the directory. https://developer.android.com/static/training/camera2/Dynamic-depth-v1.0.pdf */
#include "dynamic.h"

#include <string.h>

#include "depth_part.h"
#include "depth_range.h"
#include "jpeg_walk.h"
#include "png_format.h"
#include "letters.h"
#include "reason.h"

enum { NONE = -1 };

/* The item that a camera names by its URI, else the one that says what it is; NONE, when there is
 * none. */
static int find_item(const struct rf_xmp *xmp, const char *uri, const char *semantic)
{
    int found = NONE;

    for (int i = xmp->items - 1; i > 0; i--) {
        const struct rf_xmp_item *const item = &xmp->item[i];
        const bool behind = item->directory == xmp->item[i - 1].directory;

        if (behind && uri && strcmp(item->uri, uri) == 0)
            return i;
        if (behind && strcmp(item->semantic, semantic) == 0)
            found = i;
    }
    return found;
}

static uint64_t bytes_of(const struct rf_xmp_item *item)
{
    return item->length + item->padding;
}

static bool is_picture(struct rf_bytes file, uint64_t begin, uint64_t size)
{
    const struct rf_bytes part = {file.data + begin, (size_t)size};

    return begin <= file.size && size <= file.size - begin && (rf_is_jpeg(part) || rf_is_png(part));
}

/* Items follow each other from the end of the main picture on, which says no length itself. Where
 * an editor put something between, they are found from the end of the file. */
static int locate(const struct rf_read *read, struct rf_bytes file, const struct rf_xmp *xmp,
                  int index, size_t main_end, struct rf_bytes *part)
{
    const struct rf_xmp_item *const item = &xmp->item[index];
    uint64_t begin = main_end, behind = 0; /* sums of 32 items below 2^53 */
    int first = index, last = index;

    while (first > 0 && xmp->item[first - 1].directory == item->directory)
        first--;
    while (last + 1 < xmp->items && xmp->item[last + 1].directory == item->directory)
        last++;
    begin += xmp->item[first].padding;
    for (int i = first + 1; i < index; i++)
        begin += bytes_of(&xmp->item[i]);
    for (int i = index; i <= last; i++)
        behind += bytes_of(&xmp->item[i]);
    if (!is_picture(file, begin, item->length) && begin + behind <= file.size &&
        is_picture(file, file.size - behind, item->length)) {
        rf_note(read->info, "Dynamic Depth: item %d is found from the end of the file", index + 1);
        begin = file.size - behind;
    }
    if (begin > file.size || item->length > file.size - begin) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: it ends before item %d of those its Dynamic Depth announces; copy "
                       "it again",
                       index - first + 1);
    }
    *part = (struct rf_bytes){file.data + begin, (size_t)item->length};
    return REFOCUS_OK;
}

/* The numbers of the items that belong to a depth map. */
struct found {
    int depth, confidence, original;
};

static struct found find_items(const struct rf_read *read, const struct rf_xmp *xmp)
{
    const char *const uri = xmp->value[RF_XMP_MAP_URI];
    const char *const image = xmp->value[RF_XMP_CAMERA_IMAGE_SEMANTIC];
    const bool is_original = image && rf_same_word(image, "Original");
    struct found found;

    found.depth = find_item(xmp, uri, "Depth");
    found.confidence =
        find_item(xmp, uri ? xmp->value[RF_XMP_MAP_CONFIDENCE_URI] : NULL, "Confidence");
    found.original =
        read->picture_always
            ? find_item(xmp, is_original ? xmp->value[RF_XMP_CAMERA_IMAGE_URI] : NULL, "Original")
            : NONE;
    return found;
}

static int set_meaning(struct rf_read *read, const struct rf_xmp *xmp)
{
    static const struct rf_range_keys keys = {
        "DepthMap",      "RangeInverse", RF_XMP_MAP_FORMAT,
        RF_XMP_MAP_NEAR, RF_XMP_MAP_FAR, RF_XMP_MAP_UNITS,
    };
    const char *const semantic = xmp->value[RF_XMP_MAP_SEMANTIC];
    struct rf_depth_range range = {0.0, 0.0, 0.0};

    if (semantic && rf_same_word(semantic, "Segmentation")) {
        read->depth.meaning = REFOCUS_DEPTH_DISPARITY;
        read->depth.value_near = 0.0;
        read->depth.value_far = read->samples.max_value;
        rf_note(read->info, "DepthMap: Segmentation: subject and background, 0 is near; no metres");
        return REFOCUS_OK;
    }
    return rf_set_range(read, xmp, &keys, &range);
}

static int decode(struct rf_read *read, const struct rf_xmp *xmp, const struct rf_bytes parts[3])
{
    int status = rf_take_samples(read, parts[0], "Dynamic Depth map");

    if (status == REFOCUS_OK) {
        rf_note(read->info, "Dynamic Depth: %d x %d samples of %d bits behind the main picture",
                (int)read->samples.width, (int)read->samples.height,
                read->samples.sample == REFOCUS_SAMPLE_U16 ? 16 : 8);
        status = set_meaning(read, xmp);
    }
    if (status == REFOCUS_OK && parts[1].data)
        status = rf_take_confidence(read, parts[1], "confidence map");
    if (status == REFOCUS_OK && parts[2].data)
        status = rf_take_original(read, parts[2], "Dynamic Depth");
    return status;
}

int rf_read_dynamic(struct rf_read *read, struct rf_bytes file, const struct rf_xmp *xmp,
                    size_t main_end)
{
    const struct found found = find_items(read, xmp);
    const int items[3] = {found.depth, found.confidence, found.original};
    struct rf_bytes parts[3] = {{NULL, 0}, {NULL, 0}, {NULL, 0}};
    int status = REFOCUS_OK;

    if (read->samples.pixels || (found.depth == NONE && !xmp->value[RF_XMP_MAP_URI]))
        return REFOCUS_OK;
    if (file.size == main_end) {
        rf_note(read->info, "Dynamic Depth: nothing is behind the main picture any more, the depth "
                            "is lost");
        return REFOCUS_OK;
    }
    if (found.depth == NONE) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged: its Dynamic Depth map \"%.60s\" is in no container directory",
                       xmp->value[RF_XMP_MAP_URI]);
    }
    for (int i = 0; i < 3 && status == REFOCUS_OK; i++)
        if (items[i] != NONE)
            status = locate(read, file, xmp, items[i], main_end, &parts[i]);
    if (status == REFOCUS_OK)
        status = rf_check_parts(read, parts, 3, "Dynamic Depth pictures");
    if (status == REFOCUS_OK)
        status = decode(read, xmp, parts);
    if (status == REFOCUS_OK)
        read->info->depth_source = REFOCUS_DEPTH_SOURCE_DYNAMIC;
    return status;
}
