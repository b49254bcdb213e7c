/* Prints a hash of every kind of picture that the core makes: the same text is expected
 * from every compiler and processor. tests/run.sh compares them. */
#include "pictures.h"

static uint64_t hash(const uint8_t *bytes, size_t n)
{
    uint64_t h = 0xcbf29ce484222325; /* FNV-1a */

    for (size_t i = 0; i < n; i++)
        h = (h ^ bytes[i]) * 0x100000001b3;
    return h;
}

static void print_digests(void **state)
{
    static const struct {
        int width, height;
        float blur, focus;
    } views[] = {{83, 47, 9, 0.6f}, {64, 33, 14.5f, 0}, {31, 70, 5, 1}};
    const int count = sizeof views / sizeof views[0];

    (void)state;
    for (int v = 0; v < count; v++) {
        struct picture p = picture_make(views[v].width, views[v].height, 77u + (uint32_t)v);
        struct refocus_renderer *renderer = prepared(&p, views[v].blur, 2);
        const size_t size = 3 * (size_t)p.width * (size_t)p.height;
        uint8_t *out = malloc(size);

        assert_non_null(out);
        for (int i = 0; i < style_count; i++) {
            render_style(renderer, &p, &styles[i], views[v].focus, views[v].blur, out);
            printf("digest %016llx  %d x %d, K = %g, df = %g, %s\n",
                   (unsigned long long)hash(out, size), p.width, p.height,
                   (double)views[v].blur, (double)views[v].focus, styles[i].name);
        }
        free(out);
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
}

/* A coarse map brought to the photo's size. */
static void print_upsampled(void **state)
{
    static const int samples[][2] = {{20, 15}, {7, 31}, {1, 3}, {90, 4}};
    struct picture p = picture_make(83, 47, 99);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, p.rgb, p.width, p.height, 3 * p.width);
    const struct refocus_upsample_params params = refocus_upsample_params_default();
    uint16_t out[83 * 47];

    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct refocus_disparity map = refocus_disparity16(
            p.disparity + i * 100, samples[i][0], samples[i][1], 2 * samples[i][0]);

        assert_int_equal(refocus_upsample(&photo, &map, &params, out, 2 * 83), 0);
        printf("digest %016llx  upsampled from %d x %d\n",
               (unsigned long long)hash((const uint8_t *)out, sizeof out), samples[i][0],
               samples[i][1]);
    }
    picture_free(&p);
}

static void print_rays(void **state)
{
    static struct refocus_ray rays[REFOCUS_MAX_RAYS];
    static const int counts[] = {1, 7, 24, 64, 255, 1024};

    (void)state;
    memset(rays, 0, sizeof rays);
    for (int blades = 0; blades < 17; blades += blades ? 4 : 3) {
        struct refocus_aperture *aperture = NULL;

        if (blades)
            assert_int_equal(refocus_aperture_create_polygon(&aperture, blades, 11.5), 0);
        else
            assert_int_equal(refocus_aperture_create_disc(&aperture), 0);
        for (int i = 0; i < 6; i++) {
            assert_int_equal(refocus_aperture_rays(aperture, counts[i], rays), 0);
            printf("digest %016llx  %d rays, %d blades\n",
                   (unsigned long long)hash((const uint8_t *)rays,
                                            (size_t)counts[i] * sizeof rays[0]),
                   counts[i], blades);
        }
        refocus_aperture_destroy(&aperture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(print_digests),
                                       cmocka_unit_test(print_upsampled),
                                       cmocka_unit_test(print_rays)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
