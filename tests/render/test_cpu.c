/* Every instruction set that this processor has renders what plain C renders. */
#include "pictures.h"

static struct refocus_renderer *with_cpu(const struct picture *p, float blur, uint32_t cpu)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, blur);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    struct refocus_renderer_info info;
    struct refocus_renderer *renderer;
    int status;

    limits.threads = 1;
    limits.cpu = cpu;
    limits.methods = REFOCUS_METHODS_ALL;
    status = refocus_renderer_create(&renderer, &limits);
    if (status == REFOCUS_ERR_UNSUPPORTED) {
        assert_null(renderer);
        return NULL;
    }
    assert_int_equal(status, REFOCUS_OK);
    refocus_renderer_get_info(renderer, &info);
    assert_true(info.cpu == cpu || (cpu == REFOCUS_CPU_AUTO && info.cpu != cpu));
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    return renderer;
}

static void same_as_c(void **state)
{
    static const int sizes[][2] = {{97, 61}, {16, 16}, {1, 40}, {45, 2}, {150, 90}};
    static const float blurs[] = {8, 20, 1.5f, 40, 127};
    int sets = 0;

    (void)state;
    for (int s = 0; s < 5; s++) {
        struct picture p = picture_make(sizes[s][0], sizes[s][1], 91u + (uint32_t)s);
        struct refocus_renderer *plain = with_cpu(&p, blurs[s], REFOCUS_CPU_C);
        uint8_t *expected = malloc(3 * 150 * 90), *out = malloc(3 * 150 * 90);

        assert_true(plain && expected && out);
        for (uint32_t cpu = 0; cpu <= REFOCUS_CPU_AVX512; cpu++) {
            struct refocus_renderer *renderer = with_cpu(&p, blurs[s], cpu);

            for (int i = 0; i < style_count && renderer; i++) {
                char what[100];

                if (styles[i].method == REFOCUS_METHOD_RAYTRACE
                    || (styles[i].method >= REFOCUS_METHOD_JITTERED && blurs[s] > 20)
                    || (styles[i].rays == REFOCUS_RAYS_FULL && blurs[s] > 20))
                    continue; /* slow */
                snprintf(what, sizeof what, "%s, %s", refocus_cpu_name(cpu), styles[i].name);
                render_style(plain, &p, &styles[i], 0.45f, blurs[s], expected);
                render_style(renderer, &p, &styles[i], 0.45f, blurs[s], out);
                assert_same_pixels(out, expected, p.width, p.height, what);
            }
            if (renderer && s == 0) {
                printf("compared: %s\n", refocus_cpu_name(cpu));
                sets++;
            }
            refocus_renderer_destroy(&renderer);
        }
        refocus_renderer_destroy(&plain);
        free(expected);
        free(out);
        picture_free(&p);
    }
    assert_true(sets >= 2); /* auto and c at least */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_as_c)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
