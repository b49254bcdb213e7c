/* misuse.h: calls with arguments that no function may take: what each must answer. */
#ifndef MISUSE_H
#define MISUSE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <refocus/refocus.h>

/* Notes the function as covered, and the call for the message should it not come back. */
void misuse_calling(const char *function, const char *arguments);
void misuse_status(int status, int expected);
void misuse_number(double value, double expected);      /* NAN expects NAN */
void misuse_pointer(const void *pointer, int expected); /* whether there is to be one */

#define ANSWERS(expected, function, ...)                                                           \
    (misuse_calling(#function, #__VA_ARGS__), misuse_status(function(__VA_ARGS__), expected))
#define REFUSED(...) ANSWERS(REFOCUS_ERR_ARGUMENT, __VA_ARGS__)
#define GIVES(expected, function, ...)                                                             \
    (misuse_calling(#function, #__VA_ARGS__),                                                      \
     misuse_number((double)function(__VA_ARGS__), expected))
#define GIVES_NULL(function, ...)                                                                  \
    (misuse_calling(#function, #__VA_ARGS__), misuse_pointer(function(__VA_ARGS__), 0))
#define GIVES_POINTER(function, ...)                                                               \
    (misuse_calling(#function, #__VA_ARGS__), misuse_pointer(function(__VA_ARGS__), 1))
/* Functions without a status just come back; the caller looks at the results. */
#define RETURNS(function, ...) (misuse_calling(#function, #__VA_ARGS__), function(__VA_ARGS__))
/* Functions that take nothing cannot be misused. */
#define TAKES_NOTHING(function) (misuse_calling(#function, ""), function())

/* A field of a struct and a value that it must not have. */
struct misuse {
    const char *what;
    size_t offset, size;
    const void *value;
};
#define BAD(type, field, value)                                                                    \
    {                                                                                              \
#field " = " #value, offsetof(struct type, field), sizeof((struct type *)0)->field,        \
            &(__typeof__(((struct type *)0)->field))                                               \
        {                                                                                          \
            value                                                                                  \
        }                                                                                          \
    }
#define COUNT(list) (sizeof(list) / sizeof *(list))

/* Spoils one field, and names it in messages until the next one or NULL. */
void misuse_spoil(void *params, const struct misuse *bad);

/* The picture, map and strides that all of these begin with. */
enum { W = 20, H = 12 };
struct refocus_image misuse_photo(void);
struct refocus_disparity misuse_map(void);

/* Calls `use` with NULL and with pictures, maps and strides of which each has one fault.
 * Of strides: even ones, which are no rows of `bytes` bytes or reach beyond memory. */
void misuse_images(void (*use)(const struct refocus_image *image));
void misuse_maps(void (*use)(const struct refocus_disparity *map));
void misuse_strides(void (*use)(ptrdiff_t stride), ptrdiff_t bytes);

/* The last line of each group. */
void misuse_done(void);

void misuse_core(void **state);
void misuse_depth(void **state);
void misuse_render(void **state);
void misuse_files(void **state);
void misuse_strokes(void **state);
void misuse_opencv(void **state);

#endif
