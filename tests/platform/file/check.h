/* check.h: short forms that the tests of this folder share. */
#ifndef RF_TEST_CHECK_H
#define RF_TEST_CHECK_H

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit_test.h"

#include <refocus/platform/file.h>
#include "make.h"

/* Files and folders in one, "." and ".." counted. */
static inline int entries(const char *path)
{
    DIR *const directory = opendir(path);
    int n = 0;

    assert_non_null(directory);
    while (readdir(directory))
        n++;
    closedir(directory);
    return n;
}

static inline void check_status(int status, int expected, const char *reason, const char *file,
                                int line)
{
    if (status != expected) {
        print_error("status %d (%s), expected %d\n", status, reason, expected);
        _fail(file, line);
    }
    /* An error has words, on one line and without a full stop. */
    if (expected != REFOCUS_OK) {
        const size_t length = strlen(reason);
        if (length < 8 || reason[length - 1] == '.' || strchr(reason, '\n')) {
            print_error("no good words for %d: \"%s\"\n", expected, reason);
            _fail(file, line);
        }
    }
}

/* Read from memory, free the bytes, check the status; NULL on an expected error. */
static inline struct refocus_photo *read_photo_at(struct bytes bytes, int expected,
                                                  const char *file, int line)
{
    struct refocus_photo *photo = (struct refocus_photo *)1;
    struct refocus_reason reason;
    const int status = refocus_photo_read_memory(&photo, bytes.data, bytes.size, NULL, &reason);

    bytes_free(&bytes);
    check_status(status, expected, reason.text, file, line);
    if ((photo == NULL) != (expected != REFOCUS_OK))
        _fail(file, line);
    return photo;
}

static inline struct refocus_photo *read_depth_at(struct bytes bytes, const char *unit,
                                                  int expected, const char *file, int line)
{
    struct refocus_photo *photo = (struct refocus_photo *)1;
    struct refocus_reason reason;
    const int status =
        refocus_depth_read_memory(&photo, bytes.data, bytes.size, unit, 0, 0, NULL, &reason);

    bytes_free(&bytes);
    check_status(status, expected, reason.text, file, line);
    if ((photo == NULL) != (expected != REFOCUS_OK))
        _fail(file, line);
    return photo;
}

#define read_photo(bytes, expected)       read_photo_at(bytes, expected, __FILE__, __LINE__)
#define read_depth(bytes, unit, expected) read_depth_at(bytes, unit, expected, __FILE__, __LINE__)

static inline unsigned sample_at(const struct refocus_depth_map *map, int x, int y)
{
    const uint8_t *const row = (const uint8_t *)map->samples + y * map->stride;

    return map->sample == REFOCUS_SAMPLE_U8 ? row[x] : ((const uint16_t *)(const void *)row)[x];
}

static inline double float_at(const struct refocus_depth_map *map, int x, int y)
{
    const uint8_t *const row = (const uint8_t *)map->samples + y * map->stride;

    return ((const float *)(const void *)row)[x];
}

static inline const uint8_t *pixel_at(const struct refocus_image *image, int x, int y)
{
    return image->plane[0] + y * image->stride[0] + 3 * x;
}

static inline int near_to(double a, double b)
{
    const double size = b < 0 ? -b : b;

    return a - b <= 1e-9 * size && b - a <= 1e-9 * size;
}
#define assert_near(a, b) assert_true(near_to(a, b))

/* EXIF 2.3, tag 274: which side of the upright picture row 0 and column 0 lie on. */
static const struct {
    char row, column; /* t, b, l, r */
} upright_sides[9] = {{0, 0},     {'t', 'l'}, {'t', 'r'}, {'b', 'r'}, {'b', 'l'},
                      {'l', 't'}, {'r', 't'}, {'r', 'b'}, {'l', 'b'}};

/* The place of the stored pixel (column, row) of a w x h picture in the upright one. */
static inline void upright_place(int orientation, int w, int h, int column, int row, int *x, int *y)
{
    const char r = upright_sides[orientation].row, c = upright_sides[orientation].column;

    *x = c == 'l' ? column : c == 'r' ? w - 1 - column : r == 'l' ? row : h - 1 - row;
    *y = r == 't' ? row : r == 'b' ? h - 1 - row : c == 't' ? column : w - 1 - column;
}

/* True when a line of evidence holds the text. */
static inline int has_evidence(const struct refocus_photo *photo, const char *text)
{
    for (int i = 0; i < photo->info->evidence_count; i++)
        if (strstr(photo->info->evidence[i], text))
            return 1;
    return 0;
}

#endif
