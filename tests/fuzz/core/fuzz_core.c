/* fuzz_core.c: any parameters and any picture through the public API. Whatever comes in, the
 * status is a documented one, nothing outside the result is written, and rendering twice gives
 * the same bytes. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

enum { MAX_SIDE = 48, GUARD = 64 };

/* Rest of the input; it reads as 0 for ever after its end. */
struct input {
    const uint8_t *data;
    size_t size;
};

static uint32_t take(struct input *in, int bytes)
{
    uint32_t value = 0;

    while (bytes-- > 0 && in->size > 0) {
        value = value << 8 | *in->data++;
        in->size--;
    }
    return value;
}

static float take_float(struct input *in)
{
    const uint32_t bits = take(in, 4);
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* A value in its range mostly; of all 32 bits when `wild`. */
static int32_t take_in(struct input *in, int wild, int32_t low, int32_t high)
{
    if (wild)
        return (int32_t)take(in, 4);
    return low + (int32_t)(take(in, 2) % (uint32_t)(high - low + 1));
}

static float take_fraction(struct input *in, int wild, float high)
{
    return wild ? take_float(in) : high * (float)take(in, 2) / 65535;
}

/* Not one of the documented ones: end the program, that is what a fuzzer looks for. */
static void check(int condition)
{
    if (!condition)
        abort();
}

static void take_pixels(struct input *in, uint8_t *to, size_t size)
{
    for (size_t i = 0; i < size; i++)
        to[i] = in->size > 0 ? in->data[i % in->size] : (uint8_t)(i * 37);
}

static struct refocus_aperture_params take_opening(struct input *in, int wild)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();

    p.figure = (uint32_t)take_in(in, wild, 0, REFOCUS_FIGURE_COUNT - 1);
    p.blades = take_in(in, wild, 2, 16);
    if (p.blades == 2)
        p.blades = 0;
    p.rotation_deg = (double)take_fraction(in, wild, 360);
    p.curvature = p.figure ? 0 : (double)take_fraction(in, wild, 1);
    p.opening = p.figure ? 0 : (double)take_fraction(in, wild, 1);
    p.squeeze = 0.5 + (double)take_fraction(in, wild, 1.5f);
    p.hole = (double)take_fraction(in, wild, 0.9f);
    p.edge_behind = 1 - (double)take_fraction(in, wild, 2);
    p.edge_before = take(in, 1) & 1 ? p.edge_behind : -p.edge_behind;
    return p;
}

static struct refocus_aperture *take_aperture(struct input *in, int wild)
{
    struct refocus_aperture *aperture = NULL;
    uint8_t mask[16];
    int status = REFOCUS_OK;

    switch (take(in, 1) % 5) {
    case 1:
        status = refocus_aperture_create_disc(&aperture);
        break;
    case 2: {
        const int blades = take_in(in, wild, 3, 16);
        status = refocus_aperture_create_polygon(&aperture, blades,
                                                 (double)take_fraction(in, wild, 360));
        break;
    }
    case 3:
        for (int i = 0; i < 16; i++)
            mask[i] = (uint8_t)take(in, 1);
        status = refocus_aperture_create_mask(&aperture, mask, 4, 4, 4);
        break;
    case 4: {
        const struct refocus_aperture_params params = take_opening(in, wild);
        status = refocus_aperture_create(&aperture, &params);
        break;
    }
    }
    check(status == REFOCUS_OK || status == REFOCUS_ERR_ARGUMENT);
    check(status == REFOCUS_OK || !aperture);
    return aperture;
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
    p.render.region_width = take_in(in, wild, 0, MAX_SIDE);
    p.render.region_height = take_in(in, wild, 0, MAX_SIDE);
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
    for (size_t i = 0; i < capacity; i++)
        check((i >= GUARD && i < GUARD + written) || out[i] == 0xa5);
    return status;
}

/* A matte of the photo's size, or of 16 bits and any size. */
static const struct refocus_disparity *take_matte(struct input *in, int any,
                                                  const struct refocus_image *photo)
{
    static uint16_t deep[MAX_SIDE * MAX_SIDE];
    static struct refocus_disparity matte;
    uint8_t *const samples = (uint8_t *)deep;
    const int width = any ? take_in(in, 0, 1, MAX_SIDE) : photo->width;
    const int height = any ? take_in(in, 0, 1, MAX_SIDE) : photo->height;

    take_pixels(in, samples, sizeof deep);
    for (size_t i = 0; i < sizeof deep; i++) /* much is sure, as in true mattes */
        samples[i] = samples[i] < 100 ? 0 : samples[i] > 150 ? 255 : samples[i];
    matte = any ? refocus_disparity16(deep, width, height, 2 * (ptrdiff_t)width)
                : refocus_disparity8(samples, width, height, width);
    return &matte;
}

/* `deep`: photos have more than 8 bits, and may be rendered into any format. */
static void use(struct input *in, struct refocus_renderer *renderer, float most, int wild, int deep)
{
    enum { CAPACITY = 16 * MAX_SIDE * MAX_SIDE + 2 * GUARD };
    static uint8_t photo[16 * MAX_SIDE * MAX_SIDE], out[2][CAPACITY];
    static uint16_t disparity[MAX_SIDE * MAX_SIDE], view[MAX_SIDE * MAX_SIDE];
    static uint16_t farther[MAX_SIDE * MAX_SIDE];
    const int width = take_in(in, 0, 1, MAX_SIDE), height = take_in(in, 0, 1, MAX_SIDE);
    const uint32_t kind = take(in, 1), out_format = 1 + take(in, 1) % (deep ? 16 : 8);
    const uint32_t format =
        deep ? 9 + kind % 8
             : 1 + kind % 8; /* bits 3 and 4: matrix and range; 5: edges; 6, 7: matte */
    const int bits = take(in, 1) & 1 ? 16 : 8;
    const int dw = take_in(in, 0, 1, MAX_SIDE), dh = take_in(in, 0, 1, MAX_SIDE);
    const uint32_t shape = take(in, 1); /* bit 1: there is something behind; bit 2: texture */
    const int same = (int)shape & 1;
    struct refocus_image image = refocus_image_planar(format, photo, width, height);
    const struct refocus_disparity map = {
        sizeof map,         (uint32_t)bits, same ? width : dw,
        same ? height : dh, disparity,      (ptrdiff_t)(same ? width : dw) * bits / 8};
    struct refocus_scene scene = refocus_scene_default(&image, &map);
    struct refocus_disparity behind = map;
    struct refocus_settings lens = take_lens(in, wild, most);
    struct refocus_aperture *aperture = take_aperture(in, wild);
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
    take_pixels(in, photo, sizeof photo);
    take_pixels(in, (uint8_t *)disparity, sizeof disparity);
    for (int i = 0; i < MAX_SIDE * MAX_SIDE; i++)
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
    status = render(renderer, &lens, width, height, out_format, out[0], CAPACITY);
    if (status == REFOCUS_OK) {
        check(refocus_get_view(renderer, REFOCUS_VIEW_BLUR, view, 2 * width) == 0);
        check(render(renderer, &lens, width, height, out_format, out[1], CAPACITY) == 0);
        check(memcmp(out[0], out[1], CAPACITY) == 0);
    }
    refocus_aperture_destroy(&aperture);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct input in = {data, size};
    const uint32_t flags = take(&in, 1);
    const int wild_limits = flags & 1, wild = flags >> 1 & 1;
    struct refocus_renderer_params limits = refocus_renderer_params_default(
        take_in(&in, wild_limits, 1, MAX_SIDE), take_in(&in, wild_limits, 1, MAX_SIDE),
        take_fraction(&in, wild_limits, 12));
    struct refocus_renderer *renderer;
    int status;

    limits.threads = take_in(&in, wild_limits, 1, 3);
    limits.papers = refocus_papers();
    limits.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    limits.methods = wild_limits ? take(&in, 4) : REFOCUS_METHODS_ALL;
    limits.max_memory = 64 << 20;
    limits.thin = flags >> 2 & 1;
    limits.behind = flags >> 3 & 1;
    limits.textured = flags >> 4 & 1;
    limits.deep = flags >> 5 & 1;
    status = refocus_renderer_create(&renderer, &limits);
    check((status == REFOCUS_OK) == (renderer != NULL));
    check(status == REFOCUS_OK || status == REFOCUS_ERR_ARGUMENT || status == REFOCUS_ERR_SIZE ||
          status == REFOCUS_ERR_THREAD);
    check((status == REFOCUS_ERR_ARGUMENT) == (refocus_renderer_memory(&limits) == 0));
    for (int i = 0; i < 2 && renderer; i++)
        use(&in, renderer, limits.max_blur_radius, wild, flags >> 5 & 1);
    refocus_renderer_destroy(&renderer);
    return 0;
}
