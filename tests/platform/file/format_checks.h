/* format_checks.h: what the tests of picture formats share. */
#ifndef RF_TEST_FORMAT_CHECKS_H
#define RF_TEST_FORMAT_CHECKS_H

#include "check.h"

enum { W = 5, H = 4 };

static inline float light_at(const struct refocus_image *image, int x, int y, int c)
{
    float value;

    assert_int_equal(image->format, REFOCUS_FORMAT_RGB_FLOAT);
    memcpy(&value, image->plane[0] + y * image->stride[0] + 4 * (3 * x + c), 4);
    return value;
}

static inline unsigned deep_at(const struct refocus_image *image, int x, int y, int c)
{
    uint16_t value;

    assert_int_equal(image->format, REFOCUS_FORMAT_RGB16);
    memcpy(&value, image->plane[0] + y * image->stride[0] + 2 * (3 * x + c), 2);
    return value;
}

/* All that is shorter than the file is refused in words, or is a picture all the same where the
 * bytes at the end are none of it; a fifth less never is. */
static inline void refuse_cut(struct bytes file, bool depth)
{
    const size_t step = file.size > 300 ? file.size / 150 : 1;

    for (size_t size = 12; size < file.size; size += step) {
        struct refocus_photo *photo = NULL;
        struct refocus_reason reason;
        const int status =
            depth ? refocus_depth_read_memory(&photo, file.data, size, NULL, 0, 0, NULL, &reason)
                  : refocus_photo_read_memory(&photo, file.data, size, NULL, &reason);

        assert_true(status != REFOCUS_OK || size > file.size * 4 / 5);
        assert_true((status == REFOCUS_OK) == (photo != NULL));
        if (status != REFOCUS_OK) {
            check_status(status, status, reason.text, __FILE__, __LINE__);
            assert_true(status == REFOCUS_ERR_FORMAT || status == REFOCUS_ERR_UNSUPPORTED);
        }
        refocus_photo_free(&photo);
    }
}

static inline void refuse_large(struct bytes file)
{
    struct refocus_read_limits limits = refocus_read_limits_default();
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;

    limits.max_pixels = W * H - 1;
    check_status(refocus_photo_read_memory(&photo, file.data, file.size, &limits, &reason),
                 REFOCUS_ERR_SIZE, reason.text, __FILE__, __LINE__);
}

#endif
