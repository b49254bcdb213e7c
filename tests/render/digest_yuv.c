/* digest_yuv.c: golden pictures of photos of Y, U and V. */
#include "digest.h"

/* Photos of Y, U and V: as `views` of digest.c, in the styles of the methods that take them. */
static const struct yuv_view {
    int width, height, coarse;
    float blur, focus, gain;
    uint32_t format, matrix, range;
    bool night; /* all but white is so dark that highlights are given light */
} yuv_views[] = {
    {83, 47, 1, 9, 0.6f, 1, REFOCUS_FORMAT_NV12, 0, 0, false},
    {64, 33, 1, 14.5f, 0, 1, REFOCUS_FORMAT_I420, 1, 0, false},
    {31, 70, 1, 5, 1, 3, REFOCUS_FORMAT_YUYV, 0, 1, false},
    {45, 34, 3, 31.5f, 0.8f, 4, REFOCUS_FORMAT_NV21, 1, 1, false},
    {25, 19, 1, 100, 0.5f, 1, REFOCUS_FORMAT_YUYV, 0, 0, false},
    {74, 66, 1, 17, 0.9f, 7, REFOCUS_FORMAT_NV12, 0, 0, true},
    {58, 71, 1, 17, 0.9f, 7, REFOCUS_FORMAT_YUYV, 1, 0, true},
};

static bool takes_yuv(int style)
{
    return refocus_method_traits(styles[style].method) & REFOCUS_METHOD_TAKES_YUV;
}

static uint64_t hash_samples(const struct refocus_image *image)
{
    static uint8_t samples[3 * 100 * 100];
    size_t n = 0;

    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int i = 0; i < 3; i++)
                samples[n++] = *yuv_sample(image, i, x, y);
    return hash(samples, n);
}

/* Renders the styles of a view; false: there is no such instruction set here. */
static bool hash_yuv_view(const struct yuv_view *view, const struct picture *p, uint32_t cpu,
                          int threads, uint64_t *hashes)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, view->blur);
    struct yuv_picture photo = yuv_make(view->format, p->width, p->height, 1);
    struct yuv_picture out = yuv_make(view->format, p->width, p->height, 2);
    struct picture depth = depth_of(view->coarse, p);
    const struct refocus_disparity map = picture_disparity(&depth);
    struct refocus_renderer *renderer;
    int status;

    photo.image.matrix = view->matrix;
    photo.image.range = view->range;
    yuv_from_picture(&photo, p);
    limits.cpu = cpu;
    limits.threads = threads;
    status = refocus_renderer_create(&renderer, &limits);
    if (status == REFOCUS_OK) {
        assert_int_equal(refocus_prepare(renderer, &photo.image, &map), REFOCUS_OK);
        for (int i = 0; i < style_count; i++) {
            struct refocus_settings params = style_params(&styles[i], view->focus, view->blur);
            struct refocus_aperture *aperture = style_aperture(&styles[i]);

            params.render.aperture = aperture;
            params.highlights.gain = view->gain;
            if (takes_yuv(i)) {
                assert_int_equal(refocus_render_settings(renderer, &params, &out.image),
                                 REFOCUS_OK);
                hashes[i] = hash_samples(&out.image);
            }
            refocus_aperture_destroy(&aperture);
        }
        refocus_renderer_destroy(&renderer);
    } else {
        assert_int_equal(status, REFOCUS_ERR_UNSUPPORTED);
    }
    yuv_free(&photo);
    yuv_free(&out);
    picture_free(&depth);
    return status == REFOCUS_OK;
}

static void check_yuv_view(const struct yuv_view *view, const struct picture *p, uint32_t cpu,
                           int threads, const uint64_t plain[64])
{
    uint64_t hashes[64] = {0};

    if (hash_yuv_view(view, p, cpu, threads, hashes) && memcmp(hashes, plain, sizeof hashes))
        fail_msg("format %d: %s with %d threads differs from plain C with one", (int)view->format,
                 refocus_cpu_name(cpu), threads);
}

static void darken(struct picture *p)
{
    for (int i = 0; i < 3 * p->width * p->height; i++)
        p->rgb[i] = p->rgb[i] < 250 ? p->rgb[i] / 4 : p->rgb[i];
}

void yuv_views_same(void **state)
{
    static const int auto_threads[] = {3, 8};

    (void)state;
    for (int v = 0; v < (int)(sizeof yuv_views / sizeof yuv_views[0]); v++) {
        const struct yuv_view *view = &yuv_views[v];
        struct picture p = picture_make(view->width, view->height, 177u + (uint32_t)v);
        uint64_t plain[64] = {0};

        if (view->night)
            darken(&p);
        assert_true(hash_yuv_view(view, &p, REFOCUS_CPU_C, 1, plain));
        for (uint32_t cpu = REFOCUS_CPU_C + 1; refocus_cpu_name(cpu); cpu++)
            check_yuv_view(view, &p, cpu, 1 + (int)cpu % 2, plain);
        for (int i = 0; i < 2; i++)
            check_yuv_view(view, &p, REFOCUS_CPU_AUTO, auto_threads[i], plain);
        for (int i = 0; i < style_count; i++) {
            char name[120];

            if (!takes_yuv(i))
                continue;
            snprintf(name, sizeof name,
                     "%d x %d, depth / %d, K = %g, df = %g, gain %g, format %d %d %d, %s", p.width,
                     p.height, view->coarse, (double)view->blur, (double)view->focus,
                     (double)view->gain, (int)view->format, (int)view->matrix, (int)view->range,
                     styles[i].name);
            check_golden(plain[i], name);
        }
        picture_free(&p);
    }
}
