/* test_log.c: the line of words that each refused call says: the name of the function, the argument
 * and what it may be. */
#include "gather/method.h"
#include "pictures.h"

enum { W = 20, H = 12 };

/* The lines since the last look: how many, and the last one. */
static char said[256];
static int lines;

static void hear(void *user, const char *text)
{
    assert_ptr_equal(user, &lines);
    assert_true(strlen(text) < sizeof said && !strchr(text, '\n'));
    strcpy(said, text);
    lines++;
}

/* The call was refused with that status and said that line, once. */
#define SAYS(call, status, line)                                                                   \
    do {                                                                                           \
        lines = 0;                                                                                 \
        said[0] = 0;                                                                               \
        assert_int_equal(call, status);                                                            \
        assert_string_equal(said, line);                                                           \
        assert_int_equal(lines, 1);                                                                \
    } while (0)

static struct refocus_renderer_params limits_of(int width, int height)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(width, height, 5);

    limits.threads = 1;
    limits.log = (struct refocus_log){hear, &lines};
    return limits;
}

static struct refocus_renderer *renderer_of(const struct refocus_renderer_params *limits)
{
    struct refocus_renderer *renderer;

    assert_int_equal(refocus_renderer_create(&renderer, limits), REFOCUS_OK);
    return renderer;
}

static void *allocate_nothing(void *user, size_t size)
{
    (void)user;
    (void)size;
    return NULL;
}

static void release_nothing(void *user, void *memory)
{
    (void)user;
    (void)memory;
}

/* Creation with one limit spoilt. */
#define CREATE(field, value, line)                                                                 \
    do {                                                                                           \
        struct refocus_renderer_params limits = limits_of(W, H);                                   \
        struct refocus_renderer *renderer;                                                         \
                                                                                                   \
        limits.field = value;                                                                      \
        SAYS(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT,                    \
             "refocus_renderer_create: " line);                                                    \
        assert_null(renderer);                                                                     \
    } while (0)

TEST(ranges_of_limits)
{
    CREATE(max_width, 0, "max_width is 0, may be 1 to 65535");
    CREATE(max_width, 65536, "max_width is 65536, may be 1 to 65535");
    CREATE(max_height, -3, "max_height is -3, may be 1 to 65535");
    CREATE(max_blur_radius, -0.5f, "max_blur_radius is -0.5, may be 0 to 944");
    CREATE(max_blur_radius, 944.5f, "max_blur_radius is 944.5, may be 0 to 944");
    CREATE(max_blur_radius, INFINITY, "max_blur_radius is inf, may be 0 to 944");
    CREATE(threads, 65, "threads is 65, may be 0 to 64");
    CREATE(cpu, 6, "cpu is 6, may be 0 to 5");
    CREATE(methods, 1u << 10, "methods is 1024, may be 0 to 1023");
    CREATE(reserved, 7, "reserved is 7, may be 0");
    CREATE(in_place, 2, "in_place is 2, may be 0 to 1");
    CREATE(thin, 9, "thin is 9, may be 0 to 1");
}

TEST(limits_that_do_not_go_together)
{
    const struct refocus_papers other = {.version = "0.0.1", .frame_size = 1};

    CREATE(papers, &other, "papers is of another build than librefocus " REFOCUS_VERSION_STRING);
    CREATE(methods, REFOCUS_METHOD_BIT(REFOCUS_METHOD_LIGHTFIELD),
           "methods has lightfield, which needs papers");
    CREATE(papers = refocus_papers();
           limits.methods = REFOCUS_METHOD_BIT(REFOCUS_METHOD_LIGHTFIELD);
           limits.in_place, 1,
           "in_place is 1, may be 0 with method lightfield, which needs the whole photo");
    CREATE(allocator.allocate, allocate_nothing,
           "allocator has one function of two, may have both or none");
    CREATE(allocator.release, release_nothing,
           "allocator has one function of two, may have both or none");
}

/* Creation that is refused for what the machine has, not for its arguments. */
TEST(limits_of_the_machine)
{
    struct refocus_renderer_params limits = limits_of(W, H);
    const unsigned long long size = refocus_renderer_memory(&limits);
    struct refocus_renderer *renderer;
    char line[128];

    limits.max_memory = 1000;
    snprintf(line, sizeof line, "refocus_renderer_create: %llu bytes are needed, may be up to 1000",
             size);
    SAYS(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_SIZE, line);
    limits.max_memory = 0;
    limits.allocator = (struct refocus_allocator){allocate_nothing, release_nothing, NULL};
    snprintf(line, sizeof line, "refocus_renderer_create: the allocator has no %llu bytes", size);
    SAYS(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_MEMORY, line);
    limits = limits_of(W, H);
#if defined(__x86_64__)
    limits.cpu = REFOCUS_CPU_NEON;
    SAYS(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_UNSUPPORTED,
         "refocus_renderer_create: cpu is neon, which this build or processor does not have");
#elif defined(__aarch64__) || defined(__arm__)
    limits.cpu = REFOCUS_CPU_AVX2;
    SAYS(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_UNSUPPORTED,
         "refocus_renderer_create: cpu is avx2, which this build or processor does not have");
#endif
    SAYS(refocus_renderer_create(NULL, &limits), REFOCUS_ERR_ARGUMENT,
         "refocus_renderer_create: renderer is NULL");
}

/* A struct that ends after its log, but before the end of the first layout there was. */
TEST(size_of_limits)
{
    struct refocus_renderer_params limits = limits_of(W, H);
    struct refocus_renderer *renderer;
    char line[128];

    limits.struct_size = REFOCUS_SIZE_TO(struct refocus_renderer_params, log);
    snprintf(line, sizeof line,
             "refocus_renderer_create: the struct_size of params is %u, may be %zu to %d",
             (unsigned)limits.struct_size, REFOCUS_SIZE_TO(struct refocus_renderer_params, thin),
             REFOCUS_MAX_STRUCT_SIZE);
    SAYS(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT, line);
}

/* A struct that ends before its log has none, and a log without a function says nothing. */
TEST(silence)
{
    struct refocus_renderer_params limits = limits_of(0, H);
    struct refocus_renderer *renderer;

    lines = 0;
    limits.struct_size = offsetof(struct refocus_renderer_params, log);
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT);
    limits = limits_of(0, H);
    limits.log.message = NULL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT);
    limits = limits_of(0, H);
    assert_int_equal(refocus_renderer_memory(&limits), 0);
    assert_int_equal(lines, 0);
}

TEST(views)
{
    struct picture p = picture_make(W, H, 1);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    const struct refocus_renderer_params limits = limits_of(W, H);
    struct refocus_renderer *renderer = renderer_of(&limits);
    uint16_t out[W * H + 1], *const odd = (uint16_t *)(void *)((uint8_t *)out + 1);

#define VIEW(view, to, stride, status, line)                                                       \
    SAYS(refocus_get_view(renderer, view, to, stride), status, "refocus_get_view: " line)
    VIEW(REFOCUS_VIEW_DISPARITY, out, 2 * W, REFOCUS_ERR_STATE, "nothing is prepared yet");
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    VIEW(REFOCUS_VIEW_BLUR, out, 2 * W, REFOCUS_ERR_STATE, "nothing is rendered yet");
    VIEW(REFOCUS_VIEW_DISPARITY, NULL, 2 * W, REFOCUS_ERR_ARGUMENT,
         "out is NULL, must be at an even address");
    VIEW(REFOCUS_VIEW_DISPARITY, odd, 2 * W, REFOCUS_ERR_ARGUMENT,
         "out is odd, must be at an even address");
    VIEW(2, out, 2 * W, REFOCUS_ERR_ARGUMENT, "view is 2, may be 0 to 1");
    VIEW(UINT32_MAX, out, 2 * W, REFOCUS_ERR_ARGUMENT, "view is 4294967295, may be 0 to 1");
    VIEW(REFOCUS_VIEW_DISPARITY, out, 2 * W + 1, REFOCUS_ERR_ARGUMENT,
         "stride is 41, must be even");
    VIEW(REFOCUS_VIEW_DISPARITY, out, 2 * W - 2, REFOCUS_ERR_ARGUMENT,
         "stride is 38, may be 40 or more either way");
    VIEW(REFOCUS_VIEW_DISPARITY, out, -(2 * W - 2), REFOCUS_ERR_ARGUMENT,
         "stride is -38, may be 40 or more either way");
#undef VIEW
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Preparing with one member of the photo, or of the map, spoilt. */
#define PREPARE(what, field, value, status, line)                                                  \
    do {                                                                                           \
        struct refocus_image photo = picture_image(&p);                                            \
        struct refocus_disparity map = picture_disparity(&p);                                      \
                                                                                                   \
        (what).field = value;                                                                      \
        SAYS(refocus_prepare(renderer, &photo, &map), status, "refocus_prepare: " line);           \
    } while (0)

TEST(pictures_in)
{
    struct picture p = picture_make(W, H, 1);
    const struct refocus_image good = picture_image(&p);
    const struct refocus_disparity good_map = picture_disparity(&p);
    struct refocus_renderer_params limits = limits_of(W, H);
    struct refocus_renderer *renderer = renderer_of(&limits);

    SAYS(refocus_prepare(renderer, NULL, &good_map), REFOCUS_ERR_ARGUMENT,
         "refocus_prepare: photo is NULL");
    SAYS(refocus_prepare(renderer, &good, NULL), REFOCUS_ERR_ARGUMENT,
         "refocus_prepare: disparity is NULL");
    PREPARE(photo, format, 99, REFOCUS_ERR_ARGUMENT, "photo->format is 99, may be 1 to 16");
    PREPARE(photo, width, 0, REFOCUS_ERR_ARGUMENT, "photo->width is 0, may be 1 to 65535");
    PREPARE(photo, height, -1, REFOCUS_ERR_ARGUMENT, "photo->height is -1, may be 1 to 65535");
    PREPARE(photo, plane[0], NULL, REFOCUS_ERR_ARGUMENT, "photo->plane[0] is NULL");
    PREPARE(photo, stride[0], 59, REFOCUS_ERR_ARGUMENT,
            "photo->stride[0] is 59, may be 60 or more either way");
    PREPARE(photo, format = REFOCUS_FORMAT_YUYV;
            photo.matrix, 2, REFOCUS_ERR_ARGUMENT, "photo->matrix is 2, may be 0 to 1");
    PREPARE(photo, format = REFOCUS_FORMAT_YUYV;
            photo.range, 2, REFOCUS_ERR_ARGUMENT, "photo->range is 2, may be 0 to 1");
    PREPARE(map, bits, 12, REFOCUS_ERR_ARGUMENT, "disparity->bits is 12, may be 8 or 16");
    PREPARE(map, height, 65536, REFOCUS_ERR_ARGUMENT,
            "disparity->height is 65536, may be 1 to 65535");
    PREPARE(map, samples, NULL, REFOCUS_ERR_ARGUMENT, "disparity->samples is NULL");
    PREPARE(map, stride, 38, REFOCUS_ERR_ARGUMENT,
            "disparity->stride is 38, may be a row or more either way");
    PREPARE(map, stride, 41, REFOCUS_ERR_ARGUMENT,
            "disparity->samples or its stride is odd, must be even where bits is 16");
    refocus_renderer_destroy(&renderer);

    limits = limits_of(W - 1, H);
    renderer = renderer_of(&limits);
    SAYS(refocus_prepare(renderer, &good, &good_map), REFOCUS_ERR_SIZE,
         "refocus_prepare: photo is 20 x 12, may be up to 19 x 12");
    refocus_renderer_destroy(&renderer);
    limits = limits_of(W, H);
    limits.in_place = 1;
    renderer = renderer_of(&limits);
    PREPARE(map, width, W - 1, REFOCUS_ERR_UNSUPPORTED,
            "in_place needs a photo of R, G, B and a disparity of its size");
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Rendering with one setting spoilt. */
#define RENDER(field, value, line)                                                                 \
    do {                                                                                           \
        struct refocus_settings s = refocus_settings_default(0.5f, 5);                             \
                                                                                                   \
        s.field = value;                                                                           \
        SAYS(refocus_render_settings(renderer, &s, &out), REFOCUS_ERR_ARGUMENT,                    \
             "refocus_render: " line);                                                             \
    } while (0)

TEST(settings)
{
    struct picture p = picture_make(W, H, 1);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    const struct refocus_renderer_params limits = limits_of(W, H);
    const struct refocus_settings good = refocus_settings_default(0.5f, 5);
    struct refocus_renderer *renderer = renderer_of(&limits);
    static uint8_t pixels[3 * W * H];
    struct refocus_image out = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);

    SAYS(refocus_render_settings(renderer, &good, &out), REFOCUS_ERR_STATE,
         "refocus_render: nothing is prepared yet");
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    RENDER(render.focus_disparity, 1.5f, "focus_disparity is 1.5, may be 0 to 1");
    RENDER(render.max_blur_radius, 5.5f, "max_blur_radius is 5.5, may be 0 to the renderer's 5");
    RENDER(render.max_blur_radius, 945, "max_blur_radius is 945, may be 0 to 944");
    RENDER(render.rays, 0, "rays is 0, may be 1 to 1024, or -1");
    RENDER(render.sigma, 0.5f, "sigma is 0.5, may be 1 to inf");
    RENDER(highlights.gain, 17, "highlights->gain is 17, may be 1 to 16");
    RENDER(look.star_spikes, 1, "look->star_spikes is 1, may be 2 to 16, or 0");
    RENDER(interpolated.last_ratio, 1,
           "interpolated->last_ratio is 1, may be above 1 to 1000, or 0");
    RENDER(focus.bands = 2;
           s.focus.band[1].half_width, 2, "focus->band[1].half_width is 2, may be 0 to 1");
    RENDER(focus.least_disparity = 0.75f;
           s.focus.most_disparity, 0.5f,
           "focus->most_disparity is 0.5, may be focus->least_disparity, 0.75, to 1");
    RENDER(field.shape, REFOCUS_FIELD_PICTURE, "field->map is NULL, which field->shape 5 needs");
    RENDER(render.method, REFOCUS_METHOD_LIGHTFIELD,
           "method is 4, lightfield, which the renderer was not made for");
    RENDER(render.region_x = 5; s.render.region_width = W;
           s.render.region_height, H, "region is 20 x 12 at (5, 0), may be within 20 x 12");
    RENDER(render.method = REFOCUS_METHOD_SEARCH;
           s.look.cat_eye, 0.5f,
           "method is 1, search, which refuses look->cat_eye, which belongs to the sweep");
    out.width--;
    SAYS(refocus_render_settings(renderer, &good, &out), REFOCUS_ERR_ARGUMENT,
         "refocus_render: out is 19 x 12, may be 20 x 12, as the region");
    out.format = REFOCUS_FORMAT_YUYV;
    out.width++;
    SAYS(refocus_render_settings(renderer, &good, &out), REFOCUS_ERR_UNSUPPORTED,
         "refocus_render: out->format is 8, may be one of R, G and B");
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
