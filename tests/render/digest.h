/* digest.h: parts of render-digest that its files share. */
#ifndef RENDER_DIGEST_H
#define RENDER_DIGEST_H

#include "yuv_pictures.h"

/* FNV-1a of n bytes. */
uint64_t hash(const uint8_t *bytes, size_t n);

/* Compares a hash with the line of that name in the golden file, or writes that line. */
void check_golden(uint64_t is, const char *name);

/* The depth of a picture in samples as large as `coarse` pixels, to be freed by picture_free(). */
struct picture depth_of(int coarse, const struct picture *p);

/* A test: the styles of the methods that take Y, U and V. */
void yuv_views_same(void **state);

#endif
