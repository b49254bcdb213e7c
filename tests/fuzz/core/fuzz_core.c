/* fuzz_core.c: any parameters and any picture through the public API. Whatever comes in, the
 * status is a documented one, nothing outside the result is written, and rendering twice gives
 * the same bytes.
 * Most pictures are small, with one thread and one scene (draw.h). */
#include <string.h>
#include <refocus/refocus.h>

#include "apertures.h"
#include "blocks.h"
#include "draw.h"

enum { SMALL_SIDE = 12, MAX_SIDE = 48, GUARD = 64 };

/* The parts of an input that are drawn. */
static struct choice {
    int most_side; /* MAX_SIDE for one input of 16; blur is up to a quarter of it */
    int threads;   /* for one of 16 there are as many as the input says */
    int again;     /* for one of 8 there is a second scene, and each render is done twice */
    int few;       /* for one of 32 the aperture is any, which takes as long to make as many of
                    * these pictures; for the others one of a few */
} choice;

/* A side of a picture, or of a region. */
static int32_t take_side(struct input *in, int wild, int32_t least)
{
    const int32_t side = take_in(in, wild, least, MAX_SIDE);

    return wild || side <= choice.most_side ? side : side % (choice.most_side + 1 - least) + least;
}

/* Repeats the input's rest, which is not taken. */
static void take_pixels(struct input *in, uint8_t *to, size_t size)
{
    size_t n = in->size < size ? in->size : size;

    if (n > 0) {
        memcpy(to, in->data, n);
    } else {
        n = size < 256 ? size : 256;
        for (size_t i = 0; i < n; i++)
            to[i] = (uint8_t)(i * 37);
    }
    for (size_t more; n < size; n += more) {
        more = n < size - n ? n : size - n;
        memcpy(to + n, to, more);
    }
}

static void check_untouched(const uint8_t *at, size_t size)
{
    check(size == 0 || (at[0] == 0xa5 && memcmp(at, at + 1, size - 1) == 0));
}

/* Sets the parameters that single methods look at. */
static void take_extras(struct input *in, int wild, struct refocus_settings *p)
{
    p->jittered.cell = take_in(in, wild, 1, 16);
    p->jittered.seed = p->look.grain_seed = take(in, 4);
    p->scatter.spread = (uint32_t)take_in(in, wild, 0, 1);
    p->scatter.airy_radius = 0.25f + take_fraction(in, wild, 15.75f);
    p->scatter.depth_ratio = 1 + take_fraction(in, wild, 999);
    p->look.star_spikes = take_in(in, wild, 2, 16) & ~1;
    p->look.star_length = take_fraction(in, wild, 127);
    p->look.star_angle = take_fraction(in, wild, 360);
    p->look.star_strength = take_fraction(in, wild, 1);
    p->interpolated.sharp_radius = 0.5f + take_fraction(in, wild, 15.5f);
    p->interpolated.last_ratio = wild ? take_float(in) : 0;
    p->foveated.x = take_fraction(in, wild, 1);
    p->foveated.y = take_fraction(in, wild, 1);
    p->foveated.angle = take_fraction(in, wild, 170);
    p->foveated.depth = take_fraction(in, wild, 1);
    p->field.shape = (uint32_t)take_in(in, wild, 0, REFOCUS_FIELD_SPHERE);
    p->field.x = take_fraction(in, wild, 1);
    p->field.radius = take_fraction(in, wild, 4);
    p->field.falloff = 0.001f + take_fraction(in, wild, 3.9f);
    p->diffusion.layers = take_in(in, wild, 1, 8);
    p->diffusion.conductivity = 0.01f + take_fraction(in, wild, 0.99f);
}

/* Focus beyond a lens, and the look of the blur; `map` serves for all of its pictures. */
static void take_controls(struct input *in, int wild, const struct refocus_disparity *map,
                          struct refocus_settings *p)
{
    const uint32_t maps = take(in, 1);

    p->focus.tilt_across = take_fraction(in, wild, 128) - (wild ? 0 : 64);
    p->focus.tilt_down = take_fraction(in, wild, 3);
    p->focus.tilt_x = take_fraction(in, wild, 1);
    p->focus.depth_share = 1 - take_fraction(in, wild, 1);
    p->focus.half_width = take_fraction(in, wild, 0.3f);
    p->focus.transition = take_fraction(in, wild, 1);
    p->focus.bands = take_in(in, wild, 0, REFOCUS_MAX_BANDS - 1);
    for (int i = 0; i < p->focus.bands && i < REFOCUS_MAX_BANDS - 1; i++)
        p->focus.band[i] = (struct refocus_band){
            take_fraction(in, wild, 1), take_fraction(in, wild, 0.2f), take_fraction(in, wild, 1)};
    p->focus.map = maps & 1 ? map : NULL;
    p->focus.sharp_map = maps & 2 ? map : NULL;
    p->field.map = maps & 4 ? map : NULL;
    if (maps & 4)
        p->field.shape = REFOCUS_FIELD_PICTURE;
    p->focus.least_disparity = take_fraction(in, wild, 0.5f);
    p->focus.most_disparity = 1 - take_fraction(in, wild, 0.5f);
    p->focus.blur_limit = 127 - take_fraction(in, wild, 127);
    p->look.cat_eye = take_fraction(in, wild, 0.9f);
    p->look.fringe = take_fraction(in, wild, 1) - (wild ? 0 : 0.5f);
    p->look.grain = take_fraction(in, wild, 4);
    if (p->render.method != REFOCUS_METHOD_SWEEP && !wild)
        p->look.cat_eye = p->look.fringe = 0;
}

static struct refocus_settings take_lens(struct input *in, int wild, float most)
{
    struct refocus_settings p =
        refocus_settings_default(take_fraction(in, wild, 1), take_fraction(in, wild, most));

    p.render.method = (uint32_t)take_in(in, wild, 0, REFOCUS_METHOD_COUNT - 1);
    p.render.rays = take_in(in, wild, 0, 65);
    if (p.render.rays == 65)
        p.render.rays = REFOCUS_RAYS_FULL;
    p.render.blend = (uint32_t)take_in(in, wild, 0, 2);
    p.render.sigma = 1 + take_fraction(in, wild, 300);
    p.highlights.gain = 1 + take_fraction(in, wild, 15);
    p.highlights.estimate = p.highlights.gain > 8 ? take_fraction(in, wild, 4) : 0;
    p.search.iterations = take_in(in, wild, 1, 8);
    p.search.mirror = (uint8_t)take_in(in, wild, 0, 1);
    p.search.background = (uint8_t)take_in(in, wild, 0, 1);
    p.render.prefilter = (uint8_t)take_in(in, wild, 0, 1);
    p.render.region_x = take_in(in, wild, 0, 20);
    p.render.region_y = take_in(in, wild, 0, 20);
    p.render.region_width = take_side(in, wild, 0);
    p.render.region_height = take_side(in, wild, 0);
    return p;
}

/* Renders into a guarded picture of the region's size; the bytes go to @out. */
static int render(struct refocus_renderer *renderer, struct refocus_settings *p, int width,
                  int height, uint32_t format, uint8_t *out, size_t capacity)
{
    const int whole = !p->render.region_x && !p->render.region_y && !p->render.region_width &&
                      !p->render.region_height;
    const int w = whole ? width : p->render.region_width,
              h = whole ? height : p->render.region_height;
    const int possible = w > 0 && w <= MAX_SIDE && h > 0 && h <= MAX_SIDE;
    struct refocus_image image =
        refocus_image_planar(format, out + GUARD, possible ? w : 1, possible ? h : 1);
    int status;

    image.width = w;
    image.height = h;

    memset(out, 0xa5, capacity);
    status = refocus_render_settings(renderer, p, &image);
    check(status == REFOCUS_OK || status == REFOCUS_ERR_ARGUMENT || status == REFOCUS_ERR_STATE ||
          status == REFOCUS_ERR_UNSUPPORTED);
    const size_t written = status == REFOCUS_OK ? refocus_image_bytes(format, w, h) : 0;
    check_untouched(out, GUARD);
    check_untouched(out + GUARD + written, capacity - GUARD - written);
    return status;
}

/* A matte of the photo's size, or of 16 bits and any size. */
static const struct refocus_disparity *take_matte(struct input *in, int any,
                                                  const struct refocus_image *photo)
{
    static uint16_t deep[MAX_SIDE * MAX_SIDE];
    static struct refocus_disparity matte;
    uint8_t *const samples = (uint8_t *)deep;
    const int width = any ? take_side(in, 0, 1) : photo->width;
    const int height = any ? take_side(in, 0, 1) : photo->height;
    const size_t bytes = (size_t)(width * height) * (any ? 2 : 1);

    take_pixels(in, samples, bytes);
    for (size_t i = 0; i < bytes; i++) /* much is sure, as in true mattes */
        samples[i] = samples[i] < 100 ? 0 : samples[i] > 150 ? 255 : samples[i];
    matte = any ? refocus_disparity16(deep, width, height, 2 * (ptrdiff_t)width)
                : refocus_disparity8(samples, width, height, width);
    return &matte;
}

/* `deep`: photos have more than 8 bits, and may be rendered into any format. */
static void use(struct input *in, struct refocus_renderer *renderer, float most, int wild, int deep)
{
    static uint8_t photo[16 * MAX_SIDE * MAX_SIDE];
    static uint8_t out[2][16 * MAX_SIDE * MAX_SIDE + 2 * GUARD];
    static uint16_t disparity[MAX_SIDE * MAX_SIDE], view[MAX_SIDE * MAX_SIDE];
    static uint16_t farther[MAX_SIDE * MAX_SIDE];
    const int width = take_side(in, 0, 1), height = take_side(in, 0, 1);
    const uint32_t kind = take(in, 1), out_format = 1 + take(in, 1) % (deep ? 16 : 8);
    const uint32_t format =
        deep ? 9 + kind % 8
             : 1 + kind % 8; /* bits 3 and 4: matrix and range; 5: edges; 6, 7: matte */
    const int bits = take(in, 1) & 1 ? 16 : 8;
    const int dw = take_side(in, 0, 1), dh = take_side(in, 0, 1);
    const uint32_t shape = take(in, 1); /* bit 1: there is something behind; bit 2: texture */
    const int same = (int)shape & 1;
    struct refocus_image image = refocus_image_planar(format, photo, width, height);
    const struct refocus_disparity map = {
        sizeof map,         (uint32_t)bits, same ? width : dw,
        same ? height : dh, disparity,      (ptrdiff_t)(same ? width : dw) * bits / 8};
    struct refocus_scene scene = refocus_scene_default(&image, &map);
    struct refocus_disparity behind = map;
    struct refocus_settings lens = take_lens(in, wild, most);
    const struct refocus_aperture *aperture = take_aperture(in, wild, choice.few);
    const size_t capacity =
        2 * GUARD +
        16 * (size_t)(choice.most_side < MAX_SIDE ? SMALL_SIDE * SMALL_SIDE : MAX_SIDE * MAX_SIDE);
    int status;

    image.matrix = kind >> 3 & 1;
    image.range = kind >> 4 & 1;
    if (deep) {
        image.transfer = (kind >> 3 & 7) % 7;
        image.white = shape >> 3 & 1 ? 0.3f : 0;
    }
    for (int i = 0; i < refocus_format_planes(format); i++) { /* bottom-up */
        image.plane[i] += image.stride[i] * (refocus_plane_rows(format, i, height) - 1);
        image.stride[i] = -image.stride[i];
    }
    lens.render.inpaint = shape >> 2 & 1;
    take_extras(in, wild, &lens);
    lens.thin.enabled = kind >> 6 & 1;
    if (in->size > 0 && take(in, 1) & 1)
        take_controls(in, wild, &map, &lens);
    else if (!wild && lens.render.method != REFOCUS_METHOD_DIFFUSION)
        lens.field.shape = REFOCUS_FIELD_LENS;
    take_pixels(in, photo, (size_t)refocus_image_bytes(format, width, height));
    take_pixels(in, (uint8_t *)disparity, (size_t)map.height * (size_t)map.stride);
    for (int i = 0; i < (map.width * map.height * bits + 15) / 16; i++)
        farther[i] = disparity[i] / 2;
    behind.samples = farther;
    scene.depth_edges = (kind >> 5 & 1) * (1 + (kind & 1));
    if (kind >> 6 & 1)
        scene.matte = take_matte(in, kind >> 7 & 1, &image);
    scene.behind = shape & 2 ? &image : NULL; /* the picture itself */
    scene.behind_disparity = shape & 2 ? &behind : NULL;
    status = refocus_prepare_scene(renderer, &scene);
    check(status == REFOCUS_OK || status == REFOCUS_ERR_SIZE || status == REFOCUS_ERR_UNSUPPORTED ||
          (shape & 2 && status == REFOCUS_ERR_ARGUMENT));
    lens.render.aperture = aperture;
    status = render(renderer, &lens, width, height, out_format, out[0], capacity);
    if (status == REFOCUS_OK)
        check(refocus_get_view(renderer, REFOCUS_VIEW_BLUR, view, 2 * width) == 0);
    if (status == REFOCUS_OK && choice.again) {
        check(render(renderer, &lens, width, height, out_format, out[1], capacity) == 0);
        check(memcmp(out[0], out[1], capacity) == 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void render_input(struct input *in)
{
    const uint32_t flags = take(in, 1);
    const int wild_limits = flags & 1, wild = flags >> 1 & 1;
    const int32_t width = take_side(in, wild_limits, 1);
    const int32_t height = take_side(in, wild_limits, 1);
    struct refocus_renderer_params limits = refocus_renderer_params_default(
        width, height, take_fraction(in, wild_limits, (float)choice.most_side / 4));
    struct refocus_renderer *renderer;
    int status;

    limits.threads = take_in(in, wild_limits, 1, 3);
    if (!wild_limits && !choice.threads)
        limits.threads = 1;
    limits.papers = refocus_papers();
    limits.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    limits.methods = wild_limits ? take(in, 4) : REFOCUS_METHODS_ALL;
    limits.max_memory = 64 << 20;
    limits.allocator = keeping_allocator();
    limits.thin = flags >> 2 & 1;
    limits.behind = flags >> 3 & 1;
    limits.textured = flags >> 4 & 1;
    limits.deep = flags >> 5 & 1;
    status = refocus_renderer_create(&renderer, &limits);
    check((status == REFOCUS_OK) == (renderer != NULL));
    check(status == REFOCUS_OK || status == REFOCUS_ERR_ARGUMENT || status == REFOCUS_ERR_SIZE ||
          status == REFOCUS_ERR_THREAD);
    check((status == REFOCUS_ERR_ARGUMENT) == (refocus_renderer_memory(&limits) == 0));
    for (int i = 0; i < 1 + choice.again && renderer; i++)
        use(in, renderer, limits.max_blur_radius, wild, flags >> 5 & 1);
    refocus_renderer_destroy(&renderer);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint32_t drawn = draw(&data, &size);
    struct input in = {data, size};

    choice.most_side = drawn >> 28 ? SMALL_SIDE : MAX_SIDE;
    choice.threads = !(drawn >> 24 & 15);
    choice.again = !(drawn >> 21 & 7);
    choice.few = (drawn >> 16 & 31) != 0;
    render_input(&in);
    return 0;
}
