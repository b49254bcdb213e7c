/* test_twin.c: measures what fixed point costs: whole pictures against equal algorithms in
 * double precision, all passes of them. Where a rounded blur takes a neighbouring pixel or slab,
 * single rays differ; the sum of all that stays above 50 dB.
 *
 * With the shipped scene if the test was built with PNG, and with drawn pictures. */
#include "twin.h"

#include "renderer/renderer.h"

#ifdef WITH_PNG
#include "../quality/png_io.h"
#endif

static const double bound_db = 50;
static const char *scene;

static double psnr(const uint8_t *a, const uint8_t *b, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum > 0 ? 10 * log10(255 * 255 * (double)n / sum) : 99;
}

static double compare(const struct picture *p, const char *name, const struct style *style,
                      float focus, float K)
{
    const size_t size = 3 * (size_t)p->width * (size_t)p->height;
    struct refocus_settings params = style_params(style, focus, K);
    struct refocus_aperture *aperture = style_aperture(style);
    struct refocus_renderer *renderer = prepared(p, K, 2);
    uint8_t *fixed = malloc(size), *exact = malloc(size);
    const struct rf_silhouettes *list = &renderer->photo.silhouettes;
    struct twin_silhouette *silhouette = calloc(list->count + 1, sizeof *silhouette);
    struct twin twin;
    double db;

    assert_true(fixed && exact && silhouette);
    for (uint32_t i = 0; i < list->count; i++)
        silhouette[i] =
            (struct twin_silhouette){list->pixel[i].x, list->pixel[i].y, list->pixel[i].disparity};
    params.render.aperture = aperture;
    render_style(renderer, p, style, focus, K, fixed);
    twin_create(&twin, p, &params, silhouette, (int)list->count);
    if (style->method == REFOCUS_METHOD_SWEEP)
        twin_sweep(&twin, exact);
    else
        twin_search(&twin, exact);
    db = psnr(fixed, exact, size);
    printf("%5.1f dB  %s, df = %.2f, K = %g, %s\n", db, name, (double)focus, (double)K,
           style->name);
    twin_destroy(&twin);
    free(silhouette);
    free(fixed);
    free(exact);
    refocus_renderer_destroy(&renderer);
    refocus_aperture_destroy(&aperture);
    return db;
}

/* Methods, rays, blends and weights that differ in their arithmetic. */
static const struct style ways[] = {
    {.name = "sweep",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 64,
     .iterations = 1,
     .prefilter = 1,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "sweep 32",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 32,
     .iterations = 1,
     .prefilter = 1,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "sweep 128, 5 blades",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 128,
     .iterations = 1,
     .prefilter = 1,
     .blades = 5,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "sweep full",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = REFOCUS_RAYS_FULL,
     .iterations = 1,
     .blend = REFOCUS_BLEND_GAMMA},
    {.name = "sweep stored 96",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 64,
     .iterations = 1,
     .prefilter = 1,
     .sigma = 96,
     .blend = REFOCUS_BLEND_STORED},
    {.name = "sweep stored 128",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 64,
     .iterations = 1,
     .prefilter = 1,
     .sigma = 128,
     .blend = REFOCUS_BLEND_STORED},
    {.name = "sweep linear 300",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 64,
     .iterations = 1,
     .prefilter = 1,
     .sigma = 300,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "sweep linear 400",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 64,
     .iterations = 1,
     .prefilter = 1,
     .sigma = 400,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "sweep linear 96",
     .method = REFOCUS_METHOD_SWEEP,
     .rays = 64,
     .iterations = 1,
     .sigma = 96,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "search T = 1",
     .method = REFOCUS_METHOD_SEARCH,
     .rays = 64,
     .iterations = 1,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "search T = 1 full, stored 128",
     .method = REFOCUS_METHOD_SEARCH,
     .rays = REFOCUS_RAYS_FULL,
     .iterations = 1,
     .sigma = 128,
     .blend = REFOCUS_BLEND_STORED},
    {.name = "search T = 2 mirror",
     .method = REFOCUS_METHOD_SEARCH,
     .rays = 64,
     .iterations = 2,
     .mirror = 1,
     .blend = REFOCUS_BLEND_LINEAR},
    {.name = "search T = 2 stored 96",
     .method = REFOCUS_METHOD_SEARCH,
     .rays = 64,
     .iterations = 2,
     .sigma = 96,
     .blend = REFOCUS_BLEND_STORED},
    {.name = "search T = 4 background 300",
     .method = REFOCUS_METHOD_SEARCH,
     .rays = 64,
     .iterations = 4,
     .background = 1,
     .prefilter = 1,
     .sigma = 300,
     .blades = 6,
     .blend = REFOCUS_BLEND_LINEAR},
};
enum { WAYS = sizeof ways / sizeof ways[0] };

static void check(const struct picture *p, const char *name, float focus, float K)
{
    int failed = 0;

    for (int i = 0; i < WAYS; i++)
        if (!left_out(i + (int)K, 3) && (K < 15 || ways[i].rays != REFOCUS_RAYS_FULL)) /* slow */
            failed += compare(p, name, &ways[i], focus, K) < bound_db;
    if (failed)
        fail_msg("%d below %g dB", failed, bound_db);
}

TEST(drawn)
{
    struct picture p = picture_make(113, 82, 5);

    check(&p, "drawn", 0.6f, 9);
    check(&p, "drawn", 0, 20);
    check(&p, "drawn", 1, 33);
    picture_free(&p);
}

/* Maps with noise, a little and nothing else, whose slabs are merged. Each pixel has a blur of its
 * own, and so more of them are rounded to the other side of an edge: with slabs of a pixel it is as
 * many. Without the merging that the twin has, it is below 40 dB. */
static const double noisy_db = 48;

/* A soft map, whose surfaces are as steep as they may be without gaps between slabs. Its pixels
 * have blurs of their own, too. */
TEST(steep)
{
    struct picture p = picture_make(113, 82, 5);

    for (int y = 0; y < p.height; y++)
        for (int x = 0; x < p.width; x++) {
            const int d = 65535 * abs(x + y / 3 - 60) / 50; /* 0.7 pixels of 35 a pixel */

            p.disparity[y * p.width + x] = (uint16_t)(65535 - (d < 65535 ? d : 65535));
        }
    for (int k = 0; k < 3; k += 2)
        if (compare(&p, "steep", &ways[k], k ? 0.3f : 0.7f, 35) < noisy_db)
            fail_msg("below %g dB", noisy_db);
    picture_free(&p);
}

/* Blurs in units of two and of four pixels. */
TEST(far_out)
{
    struct picture p = picture_make(420, 310, 6);
    static const float blurs[] = {200, 300};

    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 4; k += 2) /* 64 rays, and 128 of an iris */
            if (compare(&p, "drawn, large", &ways[k], i ? 0.4f : 0.9f, blurs[i]) < bound_db)
                fail_msg("below %g dB", bound_db);
    picture_free(&p);
}

TEST(noisy)
{
    static const int spread[] = {6000, 131072};
    uint32_t seed = 7;

    for (int i = 0; i < 2; i++) {
        struct picture p = picture_make(113, 82, 5);

        for (int k = 0; k < p.width * p.height; k++) {
            int d;

            seed = seed * 1664525 + 1013904223;
            d = p.disparity[k] + (int)((seed >> 8) % (uint32_t)spread[i]) - spread[i] / 2;
            p.disparity[k] = (uint16_t)(d < 0 ? 0 : d > 65535 ? 65535 : d);
        }
        for (int k = 0; k < 4; k++) /* not with all rays of the mask, which takes long */
            if (k != 3 && compare(&p, i ? "noise alone" : "noise", &ways[k], 0.5f, 40) < noisy_db)
                fail_msg("below %g dB", noisy_db);
        for (int k = 0; k < 2; k++) /* a blur where bins become wider, and one with a unit */
            if (compare(&p, i ? "noise alone" : "noise", &ways[0], 0.5f, k ? 200 : 127) < noisy_db)
                fail_msg("below %g dB", noisy_db);
        picture_free(&p);
    }
}

/* A part of the shipped scene with an edge of the subject in it. */
TEST(shipped)
{
#ifdef WITH_PNG
    enum { WIDTH = 176, HEIGHT = 144 };
    struct picture p = picture_flat(WIDTH, HEIGHT, (uint8_t[3]){0}, 0);
    char path[4096];
    uint8_t *photo;
    uint16_t *disparity;
    int w, h, x0, y0;

    snprintf(path, sizeof path, "%s/allfocus.png", scene);
    photo = png_io_read(path, 3, &w, &h);
    snprintf(path, sizeof path, "%s/disparity.png", scene);
    disparity = png_io_read(path, 1, &w, &h);
    assert_true(photo && disparity && w >= 2 * WIDTH && h >= 2 * HEIGHT);
    x0 = w / 2 - WIDTH;
    y0 = h / 2 - HEIGHT;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int from = (y0 + i / WIDTH) * w + x0 + i % WIDTH;

        memcpy(p.rgb + 3 * i, photo + 3 * from, 3);
        p.disparity[i] = disparity[from];
    }
    check(&p, "portrait", 0.69f, 20);
    check(&p, "portrait", 0.26f, 20);
    check(&p, "portrait", 0, 12.5f);
    picture_free(&p);
    free(photo);
    free(disparity);
#else
    (void)scene;
    printf("SKIP: built without PNG, the shipped scene is not compared\n");
#endif
}

int main(int argc, char **argv)
{
    scene = argc > 1 ? argv[1] : ".";
    return unit_test_run(NULL, NULL);
}
