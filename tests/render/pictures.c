/* pictures.c: draws the pictures of the render tests, and lists the settings that they try. */
#include "pictures.h"

const struct style styles[] = {
    {"sweep", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"sweep 32", REFOCUS_METHOD_SWEEP, 32, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"sweep 1", REFOCUS_METHOD_SWEEP, 1, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"sweep 1024", REFOCUS_METHOD_SWEEP, 1024, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 0, 0, 0, 0},
    {"sweep full", REFOCUS_METHOD_SWEEP, REFOCUS_RAYS_FULL, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0,
     0, 0},
    {"sweep stored", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 128, 0, 0, 0},
    {"sweep gamma", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 1, REFOCUS_BLEND_GAMMA, 40, 0, 0, 0},
    {"sweep linear weighted", REFOCUS_METHOD_SWEEP, 48, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 1, 0, 0,
     0},
    {"sweep 5 blades", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 0, 5, 0, 0},
    {"sweep mask full", REFOCUS_METHOD_SWEEP, REFOCUS_RAYS_FULL, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR,
     0, -1, 0, 0},
    {"sweep lights", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 0, 0, 1, 0},
    {"sweep lights 5 blades", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 0, 5, 1,
     0},
    {"sweep 400", REFOCUS_METHOD_SWEEP, 64, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 400, 0, 1, 0},
    {"sweep 400 mask", REFOCUS_METHOD_SWEEP, 32, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 400, -1, 0, 0},
    {"sweep 500 lights", REFOCUS_METHOD_SWEEP, 96, 1, 0, 0, 1, REFOCUS_BLEND_LINEAR, 500, 5, 2, 0},
    {"sweep lights weighted", REFOCUS_METHOD_SWEEP, 32, 1, 0, 0, 0, REFOCUS_BLEND_GAMMA, 200, 6, 2,
     0},
    {"search T=1 full", REFOCUS_METHOD_SEARCH, REFOCUS_RAYS_FULL, 1, 0, 0, 0, REFOCUS_BLEND_STORED,
     128, 0, 0, 0},
    {"search T=2", REFOCUS_METHOD_SEARCH, 64, 2, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"search mirror", REFOCUS_METHOD_SEARCH, 64, 1, 1, 0, 0, REFOCUS_BLEND_LINEAR, 0, 6, 0, 0},
    {"search background", REFOCUS_METHOD_SEARCH, 64, 4, 0, 1, 0, REFOCUS_BLEND_GAMMA, 0, 0, 0, 0},
    {"search mask", REFOCUS_METHOD_SEARCH, 24, 64, 1, 1, 0, REFOCUS_BLEND_LINEAR, 2, -1, 0, 0},
    {"search weighted", REFOCUS_METHOD_SEARCH, 48, 2, 1, 0, 0, REFOCUS_BLEND_STORED, 40, 0, 0, 0},
    {"raytrace full", REFOCUS_METHOD_RAYTRACE, REFOCUS_RAYS_FULL, 1, 1, 0, 0, REFOCUS_BLEND_LINEAR,
     0, 0, 0, 0},
    {"raytrace plain", REFOCUS_METHOD_RAYTRACE, 32, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 96, 7, 0, 0},
    {"jittered", REFOCUS_METHOD_JITTERED, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"jittered a=4", REFOCUS_METHOD_JITTERED, 64, 1, 0, 0, 0, REFOCUS_BLEND_GAMMA, 50, -1, 1, 0},
    {"lightfield", REFOCUS_METHOD_LIGHTFIELD, 48, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"lightfield full", REFOCUS_METHOD_LIGHTFIELD, REFOCUS_RAYS_FULL, 1, 0, 0, 0,
     REFOCUS_BLEND_STORED, 64, -1, 0, 0},
    {"blur", REFOCUS_METHOD_BLUR, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"blur full", REFOCUS_METHOD_BLUR, REFOCUS_RAYS_FULL, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 5, 5, 0,
     0},
    {"scatter", REFOCUS_METHOD_SCATTER, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 1},
    {"scatter Lommel", REFOCUS_METHOD_SCATTER, 64, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 1, 0, 1, 1},
    {"scatter star", REFOCUS_METHOD_SCATTER, 64, 1, 0, 0, 0, REFOCUS_BLEND_GAMMA, 30, 0, 2, 2},
    {"foveated", REFOCUS_METHOD_FOVEATED, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"foveated exact", REFOCUS_METHOD_FOVEATED, 64, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 3, 0, 1, 0},
    {"foveated fast", REFOCUS_METHOD_FOVEATED, 64, 1, 0, 0, 0, REFOCUS_BLEND_GAMMA, 20, 0, 2, 0},
    {"interpolated", REFOCUS_METHOD_INTERPOLATED, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"interpolated 2 4", REFOCUS_METHOD_INTERPOLATED, 64, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 2, 0, 1,
     0},
    {"diffusion", REFOCUS_METHOD_DIFFUSION, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 0, 0},
    {"diffusion iterated", REFOCUS_METHOD_DIFFUSION, 64, 1, 0, 0, 0, REFOCUS_BLEND_STORED, 100, 0,
     1, 0},
    {"diffusion sphere", REFOCUS_METHOD_DIFFUSION, 64, 1, 0, 0, 0, REFOCUS_BLEND_GAMMA, 0, 0, 2, 2},
    {"diffusion plus", REFOCUS_METHOD_DIFFUSION, 64, 1, 0, 0, 0, REFOCUS_BLEND_LINEAR, 0, 0, 3, 2},
};
const int style_count = sizeof styles / sizeof styles[0];

uint32_t noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

bool left_out(int i, int n)
{
    return getenv("REFOCUS_BRIEF") && i % n;
}

static void pixel(struct picture *p, int x, int y, int r, int g, int b, int disparity)
{
    const size_t i = (size_t)y * (size_t)p->width + (size_t)x;

    p->rgb[3 * i] = (uint8_t)r;
    p->rgb[3 * i + 1] = (uint8_t)g;
    p->rgb[3 * i + 2] = (uint8_t)b;
    p->disparity[i] = (uint16_t)disparity;
}

static struct picture picture_new(int width, int height)
{
    struct picture p = {width, height, NULL, NULL};
    const size_t pixels = (size_t)width * (size_t)height;

    p.rgb = malloc(3 * pixels);
    p.disparity = malloc(2 * pixels);
    assert_non_null(p.rgb);
    assert_non_null(p.disparity);
    return p;
}

static void draw_slope(struct picture *p, uint32_t *state)
{
    for (int y = 0; y < p->height; y++) {
        for (int x = 0; x < p->width; x++) {
            const int texture = (int)(noise(state) % 64), light = noise(state) % 97 == 0;
            const int checker = ((x / 5 + y / 3) & 1) * 90;

            if (light)
                pixel(p, x, y, 255, 255, 250, 20000 * y / p->height);
            else
                pixel(p, x, y, 40 + texture + checker, 90 + texture, 30 + checker,
                      20000 * y / p->height);
        }
    }
}

static void draw_ball(struct picture *p, int cx, int cy, int radius, int disparity, uint32_t *state)
{
    const int red = (int)(noise(state) % 256), blue = (int)(noise(state) % 256);

    for (int y = cy - radius; y <= cy + radius; y++) {
        for (int x = cx - radius; x <= cx + radius; x++) {
            const int dx = x - cx, dy = y - cy;

            if (x < 0 || y < 0 || x >= p->width || y >= p->height ||
                dx * dx + dy * dy > radius * radius)
                continue;
            pixel(p, x, y, red, 128 + dx * dy * 100 / (radius * radius + 1), blue,
                  disparity - dx * 300 / (radius + 1));
        }
    }
}

struct picture picture_make(int width, int height, uint32_t seed)
{
    struct picture p = picture_new(width, height);
    uint32_t state = seed;

    draw_slope(&p, &state);
    for (int i = 0; i < 4; i++) {
        const int x = (int)(noise(&state) % (uint32_t)width);
        const int y = (int)(noise(&state) % (uint32_t)height);

        draw_ball(&p, x, y, 1 + width / 9, 24000 + 9000 * i, &state);
    }
    for (int y = 0; y < height; y++) {
        const int x = width / 4 + y / 3;

        if (x < width)
            pixel(&p, x, y, 10, 10, 200, 65535);
        if (x + 1 < width)
            pixel(&p, x + 1, y, 20, 200, 20, 65535);
    }
    return p;
}

struct picture picture_flat(int width, int height, const uint8_t rgb[3], uint16_t disparity)
{
    struct picture p = picture_new(width, height);

    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++)
            pixel(&p, x, y, rgb[0], rgb[1], rgb[2], disparity);
    }
    return p;
}

void picture_free(struct picture *picture)
{
    free(picture->rgb);
    free(picture->disparity);
}

double picture_light(int code)
{
    const double v = code / 255.0;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

uint8_t picture_code(double light)
{
    const double v = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;

    return (uint8_t)(255 * fmin(v, 1) + 0.5);
}

/* Share of a pixel in a line from (x0, y0), `wide` pixels wide. */
static double share_of(double x, double y, double x0, double y0, double dx, double dy, double wide)
{
    const double off = fabs((x - x0) * dy - (y - y0) * dx) / hypot(dx, dy);

    return fmin(fmax(wide / 2 + 0.5 - off, 0), 1);
}

void picture_line(struct picture *p, double x0, double y0, double dx, double dy, double wide,
                  int code)
{
    for (int i = 0; i < p->width * p->height; i++) {
        const double share = share_of(i % p->width, i / p->width, x0, y0, dx, dy, wide);

        for (int c = 0; c < 3; c++)
            p->rgb[3 * i + c] =
                (uint8_t)(p->rgb[3 * i + c] * (1 - share) + (code - 30 * c) * share + 0.5);
        if (share >= 0.5)
            p->disparity[i] = FENCE_NEAR;
    }
}

struct picture picture_fence(int width, int height, uint32_t seed)
{
    struct picture p = picture_flat(width, height, (uint8_t[3]){90, 70, 50}, FENCE_FAR);

    for (int i = 0; i < width * height; i++) {
        const int x = i % width, y = i / width;
        const bool box = x > 90 && x < 170 && y > 60 && y < 150;

        for (int c = 0; c < 3; c++)
            p.rgb[3 * i + c] = (uint8_t)((x / 9 + y / 7) % 3 * 40 + 20 * c + (box ? 70 : 20) +
                                         (int)(noise(&seed) % 12));
        p.disparity[i] = box ? 20000 : FENCE_FAR;
    }
    for (int i = -6; i < 14; i++) {
        picture_line(&p, 50 * i, 0, 1, 0.9, 1 + i % 4, 190);
        picture_line(&p, 50 * i, 0, -1, 0.8, 2.5, 80);
    }
    picture_line(&p, 300, 0, 0, 1, 24, 120);
    return p;
}

struct refocus_image picture_image(const struct picture *p)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, p->rgb, p->width, p->height,
                                3 * (ptrdiff_t)p->width);
}

struct refocus_disparity picture_disparity(const struct picture *p)
{
    return refocus_disparity16(p->disparity, p->width, p->height, 2 * (ptrdiff_t)p->width);
}

/* Settings that only one method looks at. */
static void set_variant(struct refocus_settings *params, int variant)
{
    params->highlights.gain = variant == 1 ? 4 : variant == 2 ? 2.5f : 1;
    params->jittered.seed = params->look.grain_seed = 7;
    params->jittered.cell = variant == 1 ? 4 : 2;
    params->scatter.spread = variant == 1 ? REFOCUS_SPREAD_LOMMEL : REFOCUS_SPREAD_UNIFORM;
    params->scatter.airy_radius = 1.5f;
    params->scatter.depth_ratio = variant == 1 ? 3 : 1;
    params->look.star_spikes =
        variant == 2 && params->render.method == REFOCUS_METHOD_SCATTER ? 6 : 0;
    params->look.star_length = 9;
    params->foveated.angle = variant == 1 ? 160 : variant == 2 ? 0 : 20;
    params->foveated.depth = variant == 1 ? 1 : 0.3f;
    params->interpolated.middle_ratio = variant == 1 ? 2 : 0;
    params->interpolated.last_ratio = variant == 1 ? 4 : 0;
    params->diffusion.solver = variant == 1 ? REFOCUS_SOLVER_ITERATED : REFOCUS_SOLVER_FAST;
    if (params->render.method == REFOCUS_METHOD_DIFFUSION)
        params->field.shape = variant == 2   ? REFOCUS_FIELD_SPHERE
                              : variant == 3 ? REFOCUS_FIELD_PLUS
                                             : REFOCUS_FIELD_LENS;
}

struct refocus_settings style_params(const struct style *style, float focus, float blur)
{
    struct refocus_settings params = refocus_settings_default(focus, blur);

    params.render.method = style->method;
    params.render.rays = style->rays;
    params.search.iterations = style->iterations;
    params.search.mirror = (uint8_t)style->mirror;
    params.search.background = (uint8_t)style->background;
    params.render.prefilter = (uint8_t)style->prefilter;
    params.render.blend = style->blend;
    params.render.sigma = style->sigma > 0 ? style->sigma : INFINITY;
    set_variant(&params, style->variant);
    return params;
}

/* A small map with all of 0 to 1 in it. */
static const struct refocus_disparity *ramp_map(void)
{
    static const uint8_t samples[3][5] = {
        {0, 30, 80, 160, 255}, {10, 255, 90, 0, 220}, {200, 120, 40, 60, 255}};
    static const struct refocus_disparity map = {sizeof map, 8, 5, 3, samples, 5};

    return &map;
}

enum { METHODS = 4 };

static void set_field(struct refocus_settings *params, uint32_t field)
{
    params->field.shape = field;
    params->field.map = ramp_map();
    params->field.x = 0.4f;
    params->field.y = 0.6f;
    params->field.disparity = 0.45f;
    params->field.angle = 30;
}

static void set_tilt(struct refocus_settings *params)
{
    params->focus.tilt_across = -0.5f;
    params->focus.tilt_down = 1.2f;
    params->focus.tilt_y = 0.35f;
}

static void set_bands(struct refocus_settings *params)
{
    params->focus.half_width = 0.03f;
    params->focus.transition = 0.05f;
    params->focus.bands = 2;
    params->focus.band[0] = (struct refocus_band){0.95f, 0.04f, 0};
    params->focus.band[1] = (struct refocus_band){0.1f, 0, 0};
}

/* Effects from here on are of the look of the blur. */
enum { FIRST_LOOK = 15, IRIS = FIRST_LOOK };

static void set_look(struct refocus_settings *params, int i)
{
    const bool all = i == IRIS + 14;
    const bool cut_off = i == IRIS + 15 || i == IRIS + 16;

    params->look.cat_eye = i == IRIS + 1 || all ? 0.6f : cut_off ? 0.85f : 0;
    params->render.rays = i == IRIS + 3 || i == IRIS + 7 || i == IRIS + 16 ? REFOCUS_RAYS_FULL : 64;
    params->render.sigma = i == IRIS + 5 || i == IRIS + 12 || all ? 200 : INFINITY;
    params->look.fringe = i == IRIS + 6 || all ? 0.2f : i == IRIS + 7 ? -0.3f : 0;
    params->look.star_spikes = i == IRIS + 8 || all ? 5 : 0;
    params->look.star_length = 15;
    params->look.star_angle = 10;
    params->look.star_strength = 0.5f;
    params->look.grain = i == IRIS + 9 || all ? 1.5f : 0;
    params->look.grain_seed = 99;
    params->highlights.gain = i == IRIS + 8 || all                                 ? 4
                              : i == IRIS + 10 || i == IRIS + 17 || i == IRIS + 18 ? 8
                              : i == IRIS + 11 || i == IRIS + 12                   ? 16
                                                                                   : 1;
}

bool effect_params(int i, float focus, float blur, struct refocus_settings *params,
                   const char **name)
{
    static const uint32_t method[METHODS] = {REFOCUS_METHOD_SWEEP, REFOCUS_METHOD_SEARCH,
                                             REFOCUS_METHOD_BLUR, REFOCUS_METHOD_DIFFUSION};
    static const char *const names[] = {
        "sweep, tilted",   "search, tilted", "blur, tilted",  "diffusion, tilted",
        "tilt, no depth",  "bands",          "focus map",     "sharp map",
        "clamps",          "cylinder",       "plus",          "plane",
        "sphere",          "field picture",  "all of focus",  "iris",
        "cat's eye",       "bubbles",        "rings full",    "squeezed star",
        "heart weighted",  "fringe",         "fringe full",   "star filter",
        "grain",           "highlights 8",   "highlights 16", "highlights 16 weighted",
        "mask, sides",     "all of bokeh",   "star cut off",  "blades cut off, full",
        "hearts of light", "stars of light"};
    const int count = sizeof names / sizeof *names;

    *params = refocus_settings_default(focus, blur);
    if (i >= count)
        return false;
    *name = names[i];
    params->render.method = i < METHODS ? method[i] : REFOCUS_METHOD_SWEEP;
    if (i < METHODS || i == 4 || i == 14)
        set_tilt(params);
    params->focus.depth_share = i == 4 ? 0 : i == 14 ? 0.75f : 1;
    if (i == 5 || i == 14)
        set_bands(params);
    if (i == 6 || i == 14)
        params->focus.map = ramp_map();
    if (i == 7 || i == 14)
        params->focus.sharp_map = ramp_map();
    if (i == 8 || i == 14) {
        params->focus.least_disparity = 0.2f;
        params->focus.most_disparity = 0.8f;
        params->focus.blur_limit = 0.6f * blur;
    }
    if (i >= 9 && i < 14)
        set_field(params, (uint32_t)(i - 8));
    set_look(params, i);
    return true;
}

struct refocus_aperture *effect_aperture(int i)
{
    static const uint8_t mask[3][3] = {{255, 0, 90}, {255, 255, 255}, {0, 255, 0}};
    struct refocus_aperture_params p = refocus_aperture_params_default();
    struct refocus_aperture *aperture;

    if (i < FIRST_LOOK)
        return NULL;
    p.blades = i == IRIS || i == IRIS + 14       ? 6
               : i == IRIS + 4 || i == IRIS + 15 ? 7
               : i == IRIS + 16                  ? 5
                                                 : 0;
    p.rotation_deg = p.blades ? 20 : i == IRIS + 17 || i == IRIS + 18 ? 25 : 0;
    p.curvature = i == IRIS ? 0.4 : 0;
    p.opening = i == IRIS ? 0.8 : 0;
    p.figure = i == IRIS + 4 || i == IRIS + 15 || i == IRIS + 18 ? REFOCUS_FIGURE_STAR
               : i == IRIS + 5 || i == IRIS + 17                 ? REFOCUS_FIGURE_HEART
                                                                 : REFOCUS_FIGURE_NONE;
    p.squeeze = i == IRIS + 4 || i == IRIS + 14 ? 0.6 : 1;
    p.hole = i == IRIS + 3 || i == IRIS + 14 ? 0.4 : 0;
    p.edge_behind = i == IRIS + 2 || i == IRIS + 14 ? 0.6 : i == IRIS + 3 ? -0.5 : 0;
    p.edge_before = i == IRIS + 3 ? -0.5 : -p.edge_behind;
    if (i == IRIS + 13) {
        p.mask = mask[0];
        p.mask_width = p.mask_height = p.mask_stride = 3;
        p.edge_before = 0.5;
    }
    assert_int_equal(refocus_aperture_create(&aperture, &p), REFOCUS_OK);
    return aperture;
}

struct refocus_aperture *style_aperture(const struct style *style)
{
    static const uint8_t letter[5][4] = {
        {255, 0, 0, 0}, {255, 0, 0, 0}, {128, 0, 0, 0}, {255, 0, 0, 0}, {255, 255, 255, 64}};
    struct refocus_aperture *aperture = NULL;

    if (style->blades > 0)
        assert_int_equal(refocus_aperture_create_polygon(&aperture, style->blades, 15), 0);
    else if (style->blades < 0)
        assert_int_equal(refocus_aperture_create_mask(&aperture, letter[0], 4, 5, 4), 0);
    return aperture;
}

struct refocus_renderer *prepared(const struct picture *picture, float blur, int threads)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(picture->width, picture->height, blur);
    const struct refocus_image photo = picture_image(picture);
    const struct refocus_disparity disparity = picture_disparity(picture);
    struct refocus_renderer *renderer;

    limits.threads = threads;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    return renderer;
}

void render_once(const struct refocus_renderer_params *limits, const struct picture *picture,
                 const struct refocus_settings *settings, uint8_t *out)
{
    const int width = picture->width;
    const struct refocus_image photo = picture_image(picture);
    const struct refocus_disparity disparity = picture_disparity(picture);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, width, picture->height, 3 * width);
    struct refocus_renderer *renderer;

    assert_int_equal(refocus_renderer_create(&renderer, limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, settings, &image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
}

void render_style(struct refocus_renderer *renderer, const struct picture *picture,
                  const struct style *style, float focus, float blur, uint8_t *out)
{
    struct refocus_settings params = style_params(style, focus, blur);
    struct refocus_aperture *aperture = style_aperture(style);
    const struct refocus_image image = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, out, picture->width, picture->height, 3 * (ptrdiff_t)picture->width);
    int status;

    params.render.aperture = aperture;
    status = refocus_render_settings(renderer, &params, &image);
    refocus_aperture_destroy(&aperture);
    if (status)
        fail_msg("%s, %d x %d, focus %g, blur %g: %s", style->name, picture->width, picture->height,
                 (double)focus, (double)blur, refocus_strerror(status));
}

void assert_same_pixels(const uint8_t *a, const uint8_t *b, int width, int height, const char *what)
{
    for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++) {
        if (a[i] != b[i])
            fail_msg("%s, %d x %d: channel %d of (%d, %d) is %d, should be %d", what, width, height,
                     (int)(i % 3), (int)(i / 3 % (size_t)width), (int)(i / 3 / (size_t)width), a[i],
                     b[i]);
    }
}
