/* gain_light.c: a photo with a gain map becomes linear light, and light that was refocused becomes
 * 8 bits again, in the tones that the photo's base rendition has. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert.h"
#include "gain_apply.h"
#include "read.h"
#include "tone.h"

struct refocus_light {
    const struct refocus_photo *photo;
    struct refocus_image image;
    struct rf_tone tone;
    uint16_t pixels[];
};

int refocus_light_create(struct refocus_light **light, const struct refocus_photo *photo)
{
    const struct rf_gain_map *map;
    struct refocus_light *made;
    size_t samples;
    int status;

    if (!light)
        return REFOCUS_ERR_ARGUMENT;
    *light = NULL;
    if (!photo)
        return REFOCUS_ERR_ARGUMENT;
    map = rf_photo_gain_map(photo);
    if (!map || !photo->image->plane[0])
        return REFOCUS_ERR_UNSUPPORTED;
    /* A photo has 2^32 pixels at the most. */
    if ((uint64_t)photo->image->width * (uint64_t)photo->image->height >
        (PTRDIFF_MAX - sizeof(struct refocus_light)) / 6)
        return REFOCUS_ERR_MEMORY;
    samples = 3 * (size_t)photo->image->width * (size_t)photo->image->height;
    made = malloc(sizeof *made + samples * sizeof *made->pixels);
    if (!made)
        return REFOCUS_ERR_MEMORY;
    made->photo = photo;
    made->image = refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, made->pixels, photo->image->width,
                                       photo->image->height, 6 * (ptrdiff_t)photo->image->width);
    status = rf_gain_apply(map, photo->image, made->pixels);
    if (status == REFOCUS_OK)
        status = rf_tone_fit(&made->tone, photo->image, &made->image, map->samples.channels == 1);
    if (status != REFOCUS_OK) {
        free(made);
        return status;
    }
    *light = made;
    return REFOCUS_OK;
}

const struct refocus_image *refocus_light_image(const struct refocus_light *light)
{
    return light ? &light->image : NULL;
}

void refocus_light_destroy(struct refocus_light **light)
{
    if (light) {
        free(*light);
        *light = NULL;
    }
}

static bool is_part(const struct refocus_image *whole, const struct refocus_image *part, int32_t x,
                    int32_t y)
{
    return part->width >= 1 && part->height >= 1 && x >= 0 && y >= 0 && x < whole->width &&
           y < whole->height && part->width <= whole->width - x &&
           part->height <= whole->height - y;
}

int refocus_light_to_base(const struct refocus_light *light, const struct refocus_image *refocused,
                          int32_t x, int32_t y, uint32_t dither, const struct refocus_image *out)
{
    struct refocus_image from, to;
    uint8_t thresholds[64];

    if (!light || refocus_image_read(&from, refocused) || refocus_image_read(&to, out) ||
        from.format != REFOCUS_FORMAT_RGB_HALF || to.format != REFOCUS_FORMAT_RGB8 ||
        from.width != to.width || from.height != to.height || !from.plane[0] || !to.plane[0] ||
        dither > 1 || !is_part(&light->image, &from, x, y))
        return REFOCUS_ERR_ARGUMENT;
    if (dither)
        memset(thresholds, 32, sizeof thresholds); /* half a code */
    else
        rf_dither_thresholds(thresholds);
    rf_tone_encode(&light->tone, &(struct rf_tone_part){.own = &light->image,
                                                        .base = light->photo->image,
                                                        .light = &from,
                                                        .out = &to,
                                                        .x = x,
                                                        .y = y,
                                                        .thresholds = thresholds});
    return REFOCUS_OK;
}
