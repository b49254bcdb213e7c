/* digest.c: golden pictures: hashes of every kind of picture that the core makes, on every
 * instruction set of this processor and by 1, 2, 3 and 8 threads. The same are expected from
 * every compiler and processor.
 *
 * usage: render-digest golden.txt            compares with the file
 *        render-digest golden.txt --update   writes it: after a change of the arithmetic
 *
 * Prints them too; tests/run.sh compares what its builds print. */
#include "digest.h"

static const char *golden_path;
static FILE *golden_new; /* being written, else NULL */

/* FNV-1a: where it begins, and how it goes on by a byte. */
static const uint64_t hash_begin = 0xcbf29ce484222325;

static uint64_t hash_byte(uint64_t h, unsigned byte)
{
    return (h ^ byte) * 0x100000001b3;
}

uint64_t hash(const uint8_t *bytes, size_t n)
{
    uint64_t h = hash_begin;

    for (size_t i = 0; i < n; i++)
        h = hash_byte(h, bytes[i]);
    return h;
}

/* Hashes 16-bit values, low byte first on every processor. */
static uint64_t hash_words(const uint16_t *words, size_t n)
{
    uint64_t h = hash_begin;

    for (size_t i = 0; i < n; i++)
        h = hash_byte(hash_byte(h, words[i] & 0xffu), words[i] >> 8);
    return h;
}

void check_golden(uint64_t is, const char *name)
{
    char line[200], wanted[200];
    FILE *file;

    snprintf(wanted, sizeof wanted, "%016llx  %s\n", (unsigned long long)is, name);
    printf("digest %s", wanted);
    if (golden_new) {
        fputs(wanted, golden_new);
        return;
    }
    file = fopen(golden_path, "r");
    if (!file)
        fail_msg("%s cannot be read", golden_path);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        if (strlen(line) > 18 && !strcmp(line + 18, name)) {
            fclose(file);
            if (strncmp(line, wanted, 16))
                fail_msg("%s: is %.16s, should be %.16s", name, wanted, line);
            return;
        }
    }
    fclose(file);
    fail_msg("%s: not in %s", name, golden_path);
}

/* Views to render: a picture, its depth in samples as large as `coarse` pixels, a lens, and the
 * formats of the photo and of the result. */
static const struct view {
    int width, height, coarse;
    float blur, focus;
    uint32_t in, out;
    bool all_styles;
    float gain; /* gain of highlights; 0: none, else the photo is darkened but for its lights */
} views[] = {
    {83, 47, 1, 9, 0.6f, REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8, true, 0},
    {64, 33, 1, 14.5f, 0, REFOCUS_FORMAT_BGR8, REFOCUS_FORMAT_RGBA8, true, 0},
    {31, 70, 1, 5, 1, REFOCUS_FORMAT_RGBA8, REFOCUS_FORMAT_BGR8, true, 0},
    {1, 1, 1, 20, 0.5f, REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_BGRA8, false, 0},
    {40, 17, 1, 0, 0.25f, REFOCUS_FORMAT_BGRA8, REFOCUS_FORMAT_RGB8, false, 0},
    {53, 38, 1, 1.25f, 0.3f, REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8, false, 0},
    {96, 80, 4, 20, 0.45f, REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8, false, 4},
    {90, 61, 1, 31.5f, 0.8f, REFOCUS_FORMAT_BGR8, REFOCUS_FORMAT_RGB8, false, 2.5f},
    {61, 44, 3, 32, 0.25f, REFOCUS_FORMAT_BGRA8, REFOCUS_FORMAT_BGRA8, false, 0},
    {97, 54, 1, 63.5f, 0.5f, REFOCUS_FORMAT_RGBA8, REFOCUS_FORMAT_RGBA8, false, 0},
    {48, 65, 1, 100, 1, REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGB8, false, 0},
    {70, 41, 1, 127, 0, REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_BGR8, false, 0},
};

/* All of them, or those that take little time at any K; of the lesser methods one in four. */
static bool takes(const struct view *view, const struct style *style)
{
    if (style->method > REFOCUS_METHOD_RAYTRACE)
        return view->all_styles && view->blur < 10; /* the others take long */
    return view->all_styles ||
           (style->rays != REFOCUS_RAYS_FULL && style->rays <= 64 && style->rays >= 32);
}

enum { MOST_BYTES = 4 * 100 * 100 };

/* The photo in the format of the view, the alpha not all the same. */
static struct refocus_image photo_of(const struct view *view, const struct picture *p,
                                     uint8_t memory[MOST_BYTES])
{
    const int bytes = refocus_format_bytes(view->in);
    const bool bgr = view->in == REFOCUS_FORMAT_BGR8 || view->in == REFOCUS_FORMAT_BGRA8;

    for (int i = 0; i < p->width * p->height; i++) {
        for (int c = 0; c < 3; c++) {
            const uint8_t code = p->rgb[3 * i + c];
            const bool dark = view->gain > 0 && code < 250;

            memory[i * bytes + (bgr ? 2 - c : c)] = dark ? code / 4 : code;
        }
        if (bytes == 4)
            memory[i * 4 + 3] = (uint8_t)(i * 37);
    }
    return refocus_image_packed(view->in, memory, p->width, p->height, (ptrdiff_t)p->width * bytes);
}

struct picture depth_of(int coarse, const struct picture *p)
{
    const int n = coarse;
    struct picture depth =
        picture_flat((p->width + n - 1) / n, (p->height + n - 1) / n, (uint8_t[3]){0}, 0);

    for (int y = 0; y < depth.height; y++)
        for (int x = 0; x < depth.width; x++)
            depth.disparity[y * depth.width + x] = p->disparity[y * n * p->width + x * n];
    return depth;
}

/* Renders the styles of a view up to a method; false: there is no such instruction set here. */
static bool hash_view(const struct view *view, const struct picture *p, uint32_t cpu, int threads,
                      uint32_t last_method, uint64_t *hashes)
{
    static uint8_t in[MOST_BYTES], out[MOST_BYTES];
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, view->blur);
    const struct refocus_image photo = photo_of(view, p, in);
    const int stride = refocus_format_bytes(view->out) * p->width;
    const struct refocus_image image =
        refocus_image_packed(view->out, out, p->width, p->height, stride);
    struct picture depth = depth_of(view->coarse, p);
    const struct refocus_disparity disparity = picture_disparity(&depth);
    struct refocus_renderer *renderer;
    int status;

    limits.papers = refocus_papers();

    limits.methods = REFOCUS_METHODS_ALL;
    limits.cpu = cpu;
    limits.threads = threads;
    status = refocus_renderer_create(&renderer, &limits);
    if (status != REFOCUS_ERR_UNSUPPORTED) {
        assert_int_equal(status, REFOCUS_OK);
        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
        for (int i = 0; i < style_count; i++) {
            struct refocus_settings params = style_params(&styles[i], view->focus, view->blur);
            struct refocus_aperture *aperture = style_aperture(&styles[i]);

            params.render.aperture = aperture;
            if (view->gain > 0)
                params.highlights.gain = view->gain;
            memset(out, 0xaa, sizeof out);
            if (takes(view, &styles[i]) && styles[i].method <= last_method) {
                assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
                hashes[i] = hash(out, (size_t)stride * (size_t)p->height);
            }
            refocus_aperture_destroy(&aperture);
        }
        refocus_renderer_destroy(&renderer);
    }
    picture_free(&depth);
    return status == REFOCUS_OK;
}

/* Another instruction set or number of threads: the same hashes. */
static void check_same(const struct view *view, const struct picture *p, uint32_t cpu, int threads,
                       uint32_t last_method, const uint64_t *expected)
{
    uint64_t hashes[64] = {0};

    if (!hash_view(view, p, cpu, threads, last_method, hashes))
        return;
    for (int i = 0; i < style_count; i++)
        if (takes(view, &styles[i]) && styles[i].method <= last_method && hashes[i] != expected[i])
            fail_msg("%d x %d, K = %g, %s: %s with %d threads differs from plain C with one",
                     view->width, view->height, (double)view->blur, styles[i].name,
                     refocus_cpu_name(cpu), threads);
}

static void pictures(void **state)
{
    const int count = sizeof views / sizeof views[0];

    (void)state;
    assert_true(style_count <= 64);
    for (int v = 0; v < count; v++) {
        const struct view *view = &views[v];
        struct picture p = picture_make(view->width, view->height, 77u + (uint32_t)v);
        uint64_t plain[64] = {0};

        assert_true(hash_view(view, &p, REFOCUS_CPU_C, 1, REFOCUS_METHOD_COUNT, plain));
        for (uint32_t cpu = REFOCUS_CPU_C; refocus_cpu_name(cpu); cpu++)
            if (cpu != REFOCUS_CPU_C || !left_out(v + 1, 4))
                check_same(view, &p, cpu, 2, REFOCUS_METHOD_RAYTRACE, plain);
        if (!left_out(v + 2, 4))
            check_same(view, &p, REFOCUS_CPU_AUTO, 1, REFOCUS_METHOD_RAYTRACE, plain);
        check_same(view, &p, REFOCUS_CPU_AUTO, 3, REFOCUS_METHOD_COUNT, plain);
        if (!left_out(v + 3, 4))
            check_same(view, &p, REFOCUS_CPU_AUTO, 8, REFOCUS_METHOD_RAYTRACE, plain);
        for (int i = 0; i < style_count; i++) {
            char name[120];

            if (!takes(view, &styles[i]))
                continue;
            snprintf(name, sizeof name,
                     "%d x %d, depth / %d, K = %g, df = %g, gain %g, %d to %d, %s", p.width,
                     p.height, view->coarse, (double)view->blur, (double)view->focus,
                     (double)view->gain, (int)view->in, (int)view->out, styles[i].name);
            check_golden(plain[i], name);
        }
        picture_free(&p);
    }
}

/* A dark picture with highlights of 4 x 4 pixels. */
static struct picture night(int width, int height)
{
    struct picture p = picture_make(width, height, 123);

    for (int i = 0; i < width * height; i++) {
        const bool highlight = i % width % 17 < 4 && i / width % 19 < 4;

        for (int c = 0; c < 3; c++)
            p.rgb[3 * i + c] = highlight ? (c == 2 ? 200 : 255) : p.rgb[3 * i + c] / 5;
    }
    return p;
}

/* Effects: the same on every instruction set and with any number of threads. */
static void effects(void **state)
{
    enum { W = 83, H = 61 };
    static uint8_t out[3 * W * H];
    const float focus = 0.4f, blur = 11;
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct picture p = night(W, H);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    struct refocus_settings params;
    uint64_t plain[64];
    const char *name;

    (void)state;
    for (uint32_t cpu = REFOCUS_CPU_C; refocus_cpu_name(cpu); cpu++) {
        struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, blur);
        struct refocus_renderer *renderer;

        limits.papers = refocus_papers();

        limits.methods = REFOCUS_METHODS_ALL;
        limits.cpu = cpu;
        limits.threads = (int32_t)cpu;
        if (refocus_renderer_create(&renderer, &limits) != REFOCUS_OK)
            continue;
        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
        for (int i = 0; effect_params(i, focus, blur, &params, &name); i++) {
            struct refocus_aperture *aperture = effect_aperture(i);
            uint64_t is;

            params.render.aperture = aperture;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            refocus_aperture_destroy(&aperture);
            is = hash(out, sizeof out);
            if (cpu == REFOCUS_CPU_C) {
                char line[80];

                plain[i] = is;
                snprintf(line, sizeof line, "effect: %s", name);
                check_golden(is, line);
            } else if (is != plain[i]) {
                fail_msg("effect %s: %s differs from plain C", name, refocus_cpu_name(cpu));
            }
        }
        refocus_renderer_destroy(&renderer);
    }
    picture_free(&p);
}

/* Thin things that are drawn, before a background whose texture goes on behind them or not. */
static void thin(void **state)
{
    static const struct {
        int width, height, rays, blades;
        float blur, focus, sigma;
        uint32_t blend, inpaint;
    } shots[] = {{150, 101, 64, 0, 15, 0.03f, 400, REFOCUS_BLEND_LINEAR, REFOCUS_INPAINT_SMOOTH},
                 {97, 130, 64, 6, 40, 0.2f, INFINITY, REFOCUS_BLEND_STORED, REFOCUS_INPAINT_SMOOTH},
                 {160, 64, 32, 0, 9.5f, 0, 200, REFOCUS_BLEND_GAMMA, REFOCUS_INPAINT_SMOOTH},
                 {151, 102, 64, 0, 15, 0.03f, 400, REFOCUS_BLEND_LINEAR, REFOCUS_INPAINT_TEXTURED},
                 {98, 131, 48, 6, 30, 0, INFINITY, REFOCUS_BLEND_GAMMA, REFOCUS_INPAINT_TEXTURED}};

    (void)state;
    for (int i = 0; i < 5; i++) {
        const int w = shots[i].width, h = shots[i].height;
        struct picture p = picture_fence(w, h, 31u + (uint32_t)i);
        const struct refocus_image photo = picture_image(&p);
        const struct refocus_disparity disparity = picture_disparity(&p);
        uint8_t *out = calloc((size_t)w * (size_t)h, 3);
        const struct refocus_image image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, out, w, h, 3 * (ptrdiff_t)w);
        struct refocus_renderer_params limits =
            refocus_renderer_params_default(w, h, shots[i].blur);
        struct refocus_settings params = refocus_settings_default(shots[i].focus, shots[i].blur);
        struct refocus_aperture *aperture = NULL;
        struct refocus_renderer *renderer;
        char name[80];

        limits.thin = params.thin.enabled = 1;
        limits.textured = shots[i].inpaint == REFOCUS_INPAINT_TEXTURED;
        params.render.inpaint = shots[i].inpaint;
        params.render.rays = shots[i].rays;
        params.render.blend = shots[i].blend;
        params.render.sigma = shots[i].sigma;
        assert_non_null(out);
        if (shots[i].blades)
            assert_int_equal(refocus_aperture_create_polygon(&aperture, shots[i].blades, 20), 0);
        params.render.aperture = aperture;
        assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        snprintf(name, sizeof name, "thin: %d x %d, K = %g%s", w, h, (double)shots[i].blur,
                 limits.textured ? ", textured" : "");
        check_golden(hash(out, 3 * (size_t)w * (size_t)h), name);
        refocus_renderer_destroy(&renderer);
        refocus_aperture_destroy(&aperture);
        free(out);
        picture_free(&p);
    }
}

/* A coarse map brought to the photo's size. */
static void upsampled(void **state)
{
    static const int samples[][2] = {{20, 15}, {7, 31}, {1, 3}, {90, 4}};
    struct picture p = picture_make(83, 47, 99);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, p.rgb, p.width, p.height, 3 * p.width);
    const struct refocus_upsample_params params = refocus_upsample_params_default();
    uint16_t out[83 * 47];
    char name[64];

    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct refocus_disparity map = refocus_disparity16(
            p.disparity + i * 100, samples[i][0], samples[i][1], 2 * samples[i][0]);

        assert_int_equal(refocus_upsample(&photo, &map, &params, out, 2 * 83), 0);
        snprintf(name, sizeof name, "upsampled from %d x %d", samples[i][0], samples[i][1]);
        check_golden(hash_words(out, sizeof out / sizeof out[0]), name);
    }
    picture_free(&p);
}

static void ray_sets(void **state)
{
    static struct refocus_ray rays[REFOCUS_MAX_RAYS];
    static uint16_t words[3 * REFOCUS_MAX_RAYS];
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
            char name[60];

            assert_int_equal(refocus_aperture_rays(aperture, counts[i], rays), 0);
            snprintf(name, sizeof name, "%d rays, %d blades", counts[i], blades);
            for (int k = 0; k < counts[i]; k++) {
                words[3 * k] = (uint16_t)rays[k].u;
                words[3 * k + 1] = (uint16_t)rays[k].v;
                words[3 * k + 2] = rays[k].weight;
            }
            check_golden(hash_words(words, 3 * (size_t)counts[i]), name);
        }
        refocus_aperture_destroy(&aperture);
    }
}

/* A dark picture with lamps that light what is around them, in two hues. */
static struct picture lamps(int width, int height)
{
    static const uint8_t dark[3] = {9, 8, 10};
    struct picture p = picture_make(width, height, 321);

    for (int i = 0; i < width * height; i++) {
        const int dx = i % width % 40 - 20, dy = i / width % 40 - 20;
        const int skirt = 4000 / (1 + dx * dx + dy * dy);
        const bool orange = i / width / 40 % 2;

        for (int c = 0; c < 3; c++) {
            const int code = dark[c] + (orange ? skirt / (c + 1) : skirt);

            p.rgb[3 * i + c] = (uint8_t)(code < 255 ? code : 255);
        }
    }
    return p;
}

/* Light that is estimated, drawn as sprites and gathered by rays: the same on every instruction set
 * and with any number of threads, and more than there is without. */
static void estimates(void **state)
{
    enum { W = 163, H = 121 };
    static uint8_t out[3 * W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct picture p = lamps(W, H);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    struct refocus_settings params = refocus_settings_default(0.4f, 11);
    struct refocus_aperture_params ring = refocus_aperture_params_default();
    struct refocus_aperture *aperture;
    uint64_t plain[4];

    (void)state;
    ring.hole = 0.2;
    assert_int_equal(refocus_aperture_create(&aperture, &ring), REFOCUS_OK);
    for (uint32_t cpu = REFOCUS_CPU_C; refocus_cpu_name(cpu); cpu++) {
        struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 11);
        struct refocus_renderer *renderer;

        limits.cpu = cpu;
        limits.threads = (int32_t)cpu;
        if (refocus_renderer_create(&renderer, &limits) != REFOCUS_OK)
            continue;
        assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
        for (int i = 0; i < 4; i++) {
            static const char *const line[] = {NULL, NULL, "estimate: splatted",
                                               "estimate: gathered"};
            uint64_t is;

            params.look.cat_eye = i % 2 ? 0.6f : 0;
            params.render.aperture = i % 2 ? aperture : NULL;
            params.highlights.estimate = i < 2 ? 0 : 1;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            is = hash(out, sizeof out);
            if (cpu != REFOCUS_CPU_C && is != plain[i])
                fail_msg("estimate %d: %s differs from plain C", i, refocus_cpu_name(cpu));
            plain[i] = is;
            if (i >= 2)
                assert_true(is != plain[i - 2]);
            if (cpu == REFOCUS_CPU_C && i >= 2)
                check_golden(is, line[i]);
        }
        refocus_renderer_destroy(&renderer);
    }
    refocus_aperture_destroy(&aperture);
    picture_free(&p);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures), cmocka_unit_test(yuv_views_same),
                                       cmocka_unit_test(effects),  cmocka_unit_test(estimates),
                                       cmocka_unit_test(thin),     cmocka_unit_test(upsampled),
                                       cmocka_unit_test(ray_sets)};
    const bool update = argc == 3 && !strcmp(argv[2], "--update");
    int failed;

    if (argc != 2 && !update) {
        fprintf(stderr, "usage: render-digest GOLDEN [--update]\n");
        return 2;
    }
    golden_path = argv[1];
    if (update && !(golden_new = fopen(golden_path, "w"))) {
        perror(golden_path);
        return 1;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (golden_new)
        fclose(golden_new);
    return failed;
}
