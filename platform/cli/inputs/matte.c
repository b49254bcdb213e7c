/* matte.c: the matte of a photo, out of a file of its own or the photo itself. */
#include <stdlib.h>
#include <string.h>
#include <refocus/platform/file.h>
#include "inputs/limits.h"
#include "inputs/matte.h"
#include "inputs/map_shape.h"
#include "line/report.h"

bool matte_is_none(const char *matte)
{
    return matte && strcmp(matte, "none") == 0;
}

int matte_take(const struct refocus_depth_map *map, const char *name,
               const struct refocus_image *photo, uint16_t **samples,
               struct refocus_disparity *matte)
{
    const uint64_t bytes = (uint64_t)map->width * (uint64_t)map->height * 2;
    const int status = shape_check(name, map->width, map->height, photo, "matte");

    if (status != EXIT_DONE)
        return status;
    *samples = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    *matte = refocus_disparity16(*samples, map->width, map->height, (ptrdiff_t)map->width * 2);
    if (!*samples || refocus_depth_to_disparity(map, *samples, matte->stride, NULL))
        return report_failure(EXIT_FAILED, name, "not enough memory for the matte");
    return EXIT_DONE;
}

int matte_read(const char *file, const struct refocus_image *photo, uint16_t **samples,
               struct refocus_disparity *matte)
{
    struct refocus_photo *read = NULL;
    struct refocus_reason reason = {""};
    struct refocus_depth_map map;
    int status = refocus_depth_read(&read, file, NULL, 0, 0, limits_taken(), &reason);

    if (status != REFOCUS_OK)
        return report_failure(status == REFOCUS_ERR_ARGUMENT ? EXIT_WRONG : EXIT_FAILED, file, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    map = *read->depth;
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    map.flags = 0;
    map.near_m = map.far_m = map.value_far = 0;
    map.value_near = map.sample == REFOCUS_SAMPLE_U8    ? 255
                     : map.sample == REFOCUS_SAMPLE_U16 ? 65535
                                                        : 1;
    status = matte_take(&map, file, photo, samples, matte);
    refocus_photo_free(&read);
    return status;
}

json_t *matte_json(const char *name, const struct refocus_disparity *matte)
{
    const uint16_t *const codes = matte->samples;
    const int64_t samples = (int64_t)matte->width * matte->height;
    int64_t subject = 0, mixed = 0;

    if (!codes)
        return json_null();
    for (int64_t i = 0; i < samples; i++) {
        subject += codes[i] == 65535;
        mixed += codes[i] > 0 && codes[i] < 65535;
    }
    return json_pack("{s:o, s:i, s:i, s:f, s:f}", "file", report_text_json(name), "width",
                     (int)matte->width, "height", (int)matte->height, "subject",
                     (double)subject / (double)samples, "mixed", (double)mixed / (double)samples);
}
