/* deep_pictures.c: pictures of more than 8 bits, and renderers for them. */
#include "deep_pictures.h"

struct deep deep_make(uint32_t format, int width, int height)
{
    const ptrdiff_t stride = refocus_format_bytes(format) * (ptrdiff_t)width + 3;
    struct deep deep = {.size = (size_t)stride * (size_t)height + 1};

    deep.memory = calloc(1, deep.size);
    assert_non_null(deep.memory);
    deep.image = refocus_image_packed(format, deep.memory + 1, width, height, stride);
    return deep;
}

static int channels_of(uint32_t format)
{
    return format % 2 ? 3 : 4;
}

uint8_t *deep_at(const struct deep *deep, int x, int y, int c)
{
    const int bytes = refocus_format_bytes(deep->image.format);

    return deep->image.plane[0] + y * deep->image.stride[0] + (ptrdiff_t)x * bytes +
           c * bytes / channels_of(deep->image.format);
}

void deep_put(const struct deep *deep, int x, int y, int c, float value)
{
    const uint16_t bits = (uint16_t)(65535 * value + 0.5f);

    if (deep->image.format <= REFOCUS_FORMAT_RGBA16)
        memcpy(deep_at(deep, x, y, c), &bits, 2);
    else
        memcpy(deep_at(deep, x, y, c), &value, 4);
}

float deep_get(const struct deep *deep, int x, int y, int c)
{
    uint16_t bits;
    float value;

    if (deep->image.format <= REFOCUS_FORMAT_RGBA16) {
        memcpy(&bits, deep_at(deep, x, y, c), 2);
        return (float)bits / 65535;
    }
    memcpy(&value, deep_at(deep, x, y, c), 4);
    return value;
}

void deep_fill(const struct deep *deep, float value)
{
    for (int y = 0; y < deep->image.height; y++)
        for (int x = 0; x < deep->image.width; x++)
            for (int c = 0; c < channels_of(deep->image.format); c++)
                deep_put(deep, x, y, c, value);
}

struct refocus_renderer *deep_renderer(int width, int height, float blur, int threads)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(width, height, blur);
    struct refocus_renderer *renderer;

    limits.threads = threads;
    limits.deep = 1;
    limits.textured = 1;
    limits.depth_edges = REFOCUS_DEPTH_EDGES_AUTO;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    return renderer;
}

struct refocus_renderer *deep_prepare_flat(const struct refocus_image *photo, float blur)
{
    uint16_t *const far = calloc((size_t)photo->width * (size_t)photo->height, 2);
    const struct refocus_disparity map =
        refocus_disparity16(far, photo->width, photo->height, 2 * photo->width);
    struct refocus_renderer *renderer = deep_renderer(photo->width, photo->height, blur, 2);

    assert_non_null(far);
    assert_int_equal(refocus_prepare(renderer, photo, &map), REFOCUS_OK);
    free(far);
    return renderer;
}

int deep_render(struct refocus_renderer *renderer, float focus, float blur,
                const struct refocus_image *out)
{
    struct refocus_settings params = refocus_settings_default(focus, blur);

    return refocus_render_settings(renderer, &params, out);
}
