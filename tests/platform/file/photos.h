/* photos.h: the photos of the project's developers, which are not part of it: the environment
 * variable REFOCUS_PHOTOS names their folder, else it is sought beside the source. */
#ifndef RF_TEST_PHOTOS_H
#define RF_TEST_PHOTOS_H

#include "check.h"

#include <sys/stat.h>

static char photos_folder[3000];

static inline const char *in_photos(const char *name)
{
    static char path[4096];

    snprintf(path, sizeof path, "%s/%s", photos_folder, name);
    return path;
}

static inline struct refocus_photo *photo_of(const char *name)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    const int status = refocus_photo_read(&photo, in_photos(name), NULL, &reason);

    check_status(status, REFOCUS_OK, reason.text, name, 0);
    for (int i = 0; i < photo->info->evidence_count; i++) {
        /* A position is nobody's business but the owner's. */
        assert_null(strstr(photo->info->evidence[i], "GPS"));
        assert_null(strstr(photo->info->evidence[i], "itude"));
    }
    return photo;
}

static inline struct refocus_photo *depth_of(const char *name, const char *unit)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    const int status = refocus_depth_read(&photo, in_photos(name), unit, 0, 0, NULL, &reason);

    check_status(status, REFOCUS_OK, reason.text, name, 0);
    assert_null(photo->image->plane[0]);
    return photo;
}

static inline void assert_sizes(const struct refocus_photo *photo, int width, int height,
                                int depth_width, int depth_height)
{
    assert_int_equal(photo->image->width, width);
    assert_int_equal(photo->image->height, height);
    assert_int_equal(photo->depth->width, depth_width);
    assert_int_equal(photo->depth->height, depth_height);
}

static inline void assert_samples(const struct refocus_depth_map *map, unsigned least,
                                  unsigned greatest)
{
    unsigned low = ~0u, high = 0;

    for (int y = 0; y < map->height; y++) {
        for (int x = 0; x < map->width; x++) {
            const unsigned v = sample_at(map, x, y);
            low = v < low ? v : low;
            high = v > high ? v : high;
        }
    }
    assert_int_equal(low, least);
    assert_int_equal(high, greatest);
}

static inline struct bytes load(const char *name)
{
    FILE *const file = fopen(in_photos(name), "rb");
    struct bytes bytes = {NULL, 0};
    char part[65536];
    size_t n;

    assert_non_null(file);
    while ((n = fread(part, 1, sizeof part, file)) > 0)
        bytes_add(&bytes, part, n);
    fclose(file);
    return bytes;
}

static inline bool find_photos(void)
{
    const char *const given = getenv("REFOCUS_PHOTOS");
    struct stat facts;

    snprintf(photos_folder, sizeof photos_folder, "%s",
             given ? given : REFOCUS_SOURCE "/../shared/photos");
    return stat(photos_folder, &facts) == 0;
}

#endif
