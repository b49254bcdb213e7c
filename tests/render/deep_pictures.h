/* deep_pictures.h: pictures of more than 8 bits, and renderers for them. */
#ifndef DEEP_PICTURES_H
#define DEEP_PICTURES_H

#include "pictures.h"

/* A deep picture; rows have a gap, and begin at odd addresses. */
struct deep {
    struct refocus_image image;
    uint8_t *memory;
    size_t size;
};

struct deep deep_make(uint32_t format, int width, int height);

/* A stored value of a picture of 16 bits or of floats, 0 to 1 as white. */
uint8_t *deep_at(const struct deep *deep, int x, int y, int c);
void deep_put(const struct deep *deep, int x, int y, int c, float value);
float deep_get(const struct deep *deep, int x, int y, int c);
void deep_fill(const struct deep *deep, float value);

struct refocus_renderer *deep_renderer(int width, int height, float blur, int threads);
/* Prepares a photo all of which lies at disparity 0. */
struct refocus_renderer *deep_prepare_flat(const struct refocus_image *photo, float blur);
int deep_render(struct refocus_renderer *renderer, float focus, float blur,
                const struct refocus_image *out);

#endif
