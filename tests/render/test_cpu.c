/* test_cpu.c: every instruction set that this processor has renders what plain C renders. */
#include "pictures.h"

static struct refocus_renderer *with_cpu(const struct picture *p, float blur, uint32_t cpu)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, blur);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    struct refocus_renderer_info info = refocus_renderer_info_default();
    struct refocus_renderer *renderer;
    int status;

    limits.threads = 1;
    limits.cpu = cpu;
    limits.papers = refocus_papers();
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

static bool is_slow(const struct style *style, float blur)
{
    return style->method == REFOCUS_METHOD_RAYTRACE ||
           (style->method >= REFOCUS_METHOD_JITTERED && blur > 20) ||
           (style->rays == REFOCUS_RAYS_FULL && blur > 20);
}

TEST(same_as_c)
{
    enum { MOST_SETS = 16 };
    static const int sizes[][2] = {{97, 61}, {16, 16}, {1, 40}, {45, 2}, {150, 90}};
    static const float blurs[] = {8, 20, 1.5f, 40, 127};
    int sets = 0;

    assert_null(refocus_cpu_name(MOST_SETS));
    for (int s = 0; s < 5; s++) {
        struct picture p = picture_make(sizes[s][0], sizes[s][1], 91u + (uint32_t)s);
        uint8_t *expected = malloc(3 * 150 * 90), *out = malloc(3 * 150 * 90);
        struct refocus_renderer *renderer[MOST_SETS];

        assert_true(expected && out);
        for (uint32_t cpu = 0; refocus_cpu_name(cpu); cpu++) {
            renderer[cpu] = with_cpu(&p, blurs[s], cpu);
            if (renderer[cpu] && s == 0) {
                printf("compared: %s\n", refocus_cpu_name(cpu));
                sets++;
            }
        }
        assert_non_null(renderer[REFOCUS_CPU_C]);
        for (int i = 0; i < style_count; i++) {
            if (is_slow(&styles[i], blurs[s]))
                continue;
            render_style(renderer[REFOCUS_CPU_C], &p, &styles[i], 0.45f, blurs[s], expected);
            for (uint32_t cpu = 0; refocus_cpu_name(cpu); cpu++) {
                char what[100];

                if (!renderer[cpu] || cpu == REFOCUS_CPU_C)
                    continue;
                snprintf(what, sizeof what, "%s, %s", refocus_cpu_name(cpu), styles[i].name);
                render_style(renderer[cpu], &p, &styles[i], 0.45f, blurs[s], out);
                assert_same_pixels(out, expected, p.width, p.height, what);
            }
        }
        for (uint32_t cpu = 0; refocus_cpu_name(cpu); cpu++)
            refocus_renderer_destroy(&renderer[cpu]);
        free(expected);
        free(out);
        picture_free(&p);
    }
    assert_true(sets >= 2); /* auto and c at least */
}

/* `auto` is the last of the sets in enum refocus_cpu that work here. */
TEST(auto_is_the_best)
{
    struct picture p = picture_make(20, 20, 7);
    struct refocus_renderer_info info = refocus_renderer_info_default();
    uint32_t best = REFOCUS_CPU_AUTO, cpu = REFOCUS_CPU_AUTO;
    struct refocus_renderer *renderer;

    for (uint32_t i = REFOCUS_CPU_AUTO + 1; refocus_cpu_name(i); i++) {
        renderer = with_cpu(&p, 8, i);
        best = renderer ? i : best;
        refocus_renderer_destroy(&renderer);
    }
    renderer = with_cpu(&p, 8, REFOCUS_CPU_AUTO);
    refocus_renderer_get_info(renderer, &info);
    cpu = info.cpu;
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    assert_int_equal(cpu, best);
}
