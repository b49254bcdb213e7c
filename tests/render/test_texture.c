/* test_texture.c: the texture of the background is continued behind what is blurred before it. */
#include "pictures.h"

#include "canceller.h"

enum { W = 201, H = 150, MOST = 3 * W * H, FAR = 5000, NEAR = 60000 };
static const float K = 14;

/* Tiles with grooves, and leaning bars of 6 pixels before them; `wall`: the tiles alone. */
static struct picture make(bool wall)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, FAR);
    uint32_t seed = 9;

    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W, grain = (int)(noise(&seed) >> 8) % 12;
        const bool groove = y % 10 < 2 || (x + y / 10 * 9) % 18 < 2;
        const bool bar = !wall && (x + y / 3) % 34 < 6;

        for (int c = 0; c < 3; c++)
            p.rgb[3 * i + c] = (uint8_t)(bar ? 130 - 20 * c : groove ? 40 : 170 + 10 * c + grain);
        p.disparity[i] = bar ? NEAR : FAR;
    }
    return p;
}

static struct refocus_renderer *create(const struct picture *p, uint32_t cpu, int threads,
                                       bool memory)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, K);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity map = picture_disparity(p);
    struct refocus_renderer *renderer;

    limits.cpu = cpu;
    limits.threads = threads;
    limits.thin = 1;
    limits.textured = memory;
    if (refocus_renderer_create(&renderer, &limits) == REFOCUS_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(refocus_prepare(renderer, &photo, &map), REFOCUS_OK);
    return renderer;
}

static int render(struct refocus_renderer *renderer, float focus, bool thin, bool textured,
                  uint8_t *out)
{
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_settings params = refocus_settings_default(focus, K);

    params.thin.enabled = thin;
    params.render.inpaint = textured ? REFOCUS_INPAINT_TEXTURED : REFOCUS_INPAINT_SMOOTH;
    return refocus_render_settings(renderer, &params, &image);
}

/* A blurred bar covers a fifth of the wall or so, whose texture stays. So where a bar was, the
 * differences of neighbours are compared with those of the wall alone. */
static double off(const struct picture *bars, const struct picture *wall, const uint8_t *out)
{
    double sum = 0;
    int count = 0;

    for (int y = 20; y < H - 20; y++) {
        for (int x = 20; x < W - 20; x++) {
            const int i = y * W + x;

            if (bars->disparity[i] == FAR)
                continue;
            for (int c = 0; c < 3; c++) {
                const double is =
                    picture_light(out[3 * i + c]) - picture_light(out[3 * (i - W) + c]);
                const double was =
                    picture_light(wall->rgb[3 * i + c]) - picture_light(wall->rgb[3 * (i - W) + c]);

                sum += fabs(is - 0.8 * was);
                count++;
            }
        }
    }
    return sum / count;
}

TEST(continued)
{
    static uint8_t out[MOST];
    struct picture bars = make(false), wall = make(true);
    struct refocus_renderer *renderer = create(&bars, REFOCUS_CPU_AUTO, 2, true);

    for (int thin = 0; thin < 2; thin++) {
        double smooth, textured;

        assert_int_equal(render(renderer, FAR / 65535.0f, thin, false, out), REFOCUS_OK);
        smooth = off(&bars, &wall, out);
        assert_int_equal(render(renderer, FAR / 65535.0f, thin, true, out), REFOCUS_OK);
        textured = off(&bars, &wall, out);
        printf("%s: %.4f off, smooth %.4f\n", thin ? "thin" : "rays", textured, smooth);
        assert_true(textured < 0.7 * smooth);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&bars);
    picture_free(&wall);
}

/* All of it is the same bytes from every instruction set, by one thread and five. */
TEST(same_everywhere)
{
    static uint8_t out[MOST], expected[MOST];
    struct picture p = make(false);
    bool first = true;

    for (uint32_t cpu = REFOCUS_CPU_COUNT; cpu-- > 0;) {
        struct refocus_renderer *renderer = create(&p, cpu, cpu == REFOCUS_CPU_AUTO ? 5 : 1, true);

        if (!renderer)
            continue;
        assert_int_equal(render(renderer, 0.1f, true, true, out), REFOCUS_OK);
        if (first)
            memcpy(expected, out, MOST);
        first = false;
        assert_same_pixels(out, expected, W, H, refocus_cpu_name(cpu));
        refocus_renderer_destroy(&renderer);
    }
    picture_free(&p);
}

/* Nothing is left of what was rendered before, cancelled or not; a region is that part. */
TEST(sequence)
{
    static uint8_t out[MOST], expected[MOST];
    static const float focus[] = {FAR / 65535.0f, 0.12f, 0.6f, 0.92f};
    struct picture p = make(false);
    struct refocus_renderer *renderer = create(&p, REFOCUS_CPU_AUTO, 2, true), *fresh;
    const struct refocus_image part = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 50, 40, 150);
    struct refocus_render_params params = refocus_render_params_default(focus[0], K);
    uint32_t seed = 4;

    for (int i = 0; i < (left_out(1, 2) ? 6 : 16); i++) {
        const float df = focus[noise(&seed) >> 8 & 3];
        const bool thin = noise(&seed) >> 8 & 1, textured = noise(&seed) >> 8 & 1;

        assert_int_equal(render(renderer, df, thin, textured, out), REFOCUS_OK);
        fresh = create(&p, REFOCUS_CPU_AUTO, 1, true);
        assert_int_equal(render(fresh, df, thin, textured, expected), REFOCUS_OK);
        assert_same_pixels(out, expected, W, H, "sequence");
        refocus_renderer_destroy(&fresh);
    }
    params.inpaint = REFOCUS_INPAINT_TEXTURED;
    assert_int_equal(render(renderer, focus[0], false, true, expected), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    renderer = create(&p, REFOCUS_CPU_AUTO, 2, true);
    params.region_x = 70;
    params.region_y = 60;
    params.region_width = 50;
    params.region_height = 40;
    assert_int_equal(refocus_render(renderer, &params, &part), REFOCUS_OK);
    for (int y = 0; y < 40; y++)
        assert_memory_equal(out + 150 * y, expected + 3 * ((60 + y) * W + 70), 150);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Other renderers, and pictures too small for any texture, take it as smooth. */
TEST(as_smooth)
{
    static uint8_t out[MOST], expected[MOST];
    struct picture p = make(false), flat = picture_flat(W, H, (uint8_t[3]){90, 80, 70}, FAR);
    struct refocus_renderer *renderer = create(&p, REFOCUS_CPU_AUTO, 1, false);

    assert_int_equal(render(renderer, 0.1f, true, true, out), REFOCUS_OK);
    assert_int_equal(render(renderer, 0.1f, true, false, expected), REFOCUS_OK);
    assert_same_pixels(out, expected, W, H, "no memory");
    refocus_renderer_destroy(&renderer);
    memcpy(flat.disparity, p.disparity, sizeof *p.disparity * W * H);
    renderer = create(&flat, REFOCUS_CPU_AUTO, 1, true);
    assert_int_equal(render(renderer, 0.1f, true, true, out), REFOCUS_OK);
    for (int i = 0; i < MOST; i++)
        assert_int_equal(out[i], 90 - 10 * (i % 3));
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    picture_free(&flat);
}

/* A run that is cancelled anywhere leaves nothing behind. */
TEST(cancelled)
{
    static uint8_t out[MOST], expected[MOST];
    struct picture p = make(false);
    struct refocus_renderer *renderer = create(&p, REFOCUS_CPU_AUTO, 1, true);
    struct canceller canceller = {renderer, 0, 0};
    int count = 0, status = REFOCUS_ERR_CANCELLED;

    assert_int_equal(render(renderer, 0.08f, true, true, expected), REFOCUS_OK);
    for (int after = 1; status == REFOCUS_ERR_CANCELLED; after += after / 4 + 1) {
        renderer->run.user = &canceller;
        renderer->run.looked_at = cancel_later;
        atomic_store(&canceller.left, after);
        status = render(renderer, 0.1f, true, true, out);
        renderer->run.looked_at = NULL;
        count += status == REFOCUS_ERR_CANCELLED;
        assert_int_equal(render(renderer, 0.08f, true, true, out), REFOCUS_OK);
        assert_same_pixels(out, expected, W, H, "after a cancelled run");
    }
    assert_true(count > 10);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* The text of render.h. */
TEST(memory)
{
    for (int threads = 1; threads <= 64; threads *= 4) {
        struct refocus_renderer_params params = refocus_renderer_params_default(W, H, K);
        double bytes;

        params.threads = threads;
        bytes = -(double)refocus_renderer_memory(&params);
        params.textured = 1;
        bytes += (double)refocus_renderer_memory(&params);
        if (bytes < 1 || bytes > 80000.0 * threads)
            fail_msg("%d threads: %.0f bytes", threads, bytes);
    }
}
