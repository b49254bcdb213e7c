/* test_memory.c: the renderer takes as much from its allocator as it says, at creation only.
 *
 * This program is linked with --wrap=malloc and so on, so that it also sees a call that
 * goes past the allocator. */
#include "pictures.h"

static int wrapped_calls; /* calls of malloc, calloc, realloc, aligned_alloc, posix_memalign */

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t align, size_t size);
void *__wrap_aligned_alloc(size_t align, size_t size);
int __real_posix_memalign(void **memory, size_t align, size_t size);
int __wrap_posix_memalign(void **memory, size_t align, size_t size);

void *__wrap_malloc(size_t size)
{
    __atomic_add_fetch(&wrapped_calls, 1, __ATOMIC_RELAXED);
    return __real_malloc(size);
}

void *__wrap_calloc(size_t n, size_t size)
{
    __atomic_add_fetch(&wrapped_calls, 1, __ATOMIC_RELAXED);
    return __real_calloc(n, size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    __atomic_add_fetch(&wrapped_calls, 1, __ATOMIC_RELAXED);
    return __real_realloc(memory, size);
}

void *__wrap_aligned_alloc(size_t align, size_t size)
{
    __atomic_add_fetch(&wrapped_calls, 1, __ATOMIC_RELAXED);
    return __real_aligned_alloc(align, size);
}

int __wrap_posix_memalign(void **memory, size_t align, size_t size)
{
    __atomic_add_fetch(&wrapped_calls, 1, __ATOMIC_RELAXED);
    return __real_posix_memalign(memory, align, size);
}

/* An allocator that counts, and fails once. */
struct counter {
    uint64_t bytes; /* ever taken */
    int calls;
    int held;    /* not yet released */
    int fail_at; /* the call that gets NULL; < 0: none */
};

static void *count_allocate(void *user, size_t size)
{
    struct counter *counter = user;

    if (counter->calls++ == counter->fail_at)
        return NULL;
    counter->bytes += size;
    counter->held++;
    return __real_malloc(size);
}

static void count_release(void *user, void *memory)
{
    struct counter *counter = user;

    counter->held -= memory != NULL;
    free(memory);
}

static struct refocus_renderer_params counted(struct counter *counter, int width, int height,
                                              float blur, int threads)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(width, height, blur);

    memset(counter, 0, sizeof *counter);
    counter->fail_at = -1;
    params.allocator.allocate = count_allocate;
    params.allocator.release = count_release;
    params.allocator.user = counter;
    params.threads = threads;
    return params;
}

TEST(every_failure)
{
    struct counter counter;
    struct refocus_renderer_params params = counted(&counter, 100, 70, 12, 2);
    struct refocus_renderer *renderer;
    int calls;

    assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
    calls = counter.calls;
    assert_true(calls > 0);
    refocus_renderer_destroy(&renderer);
    assert_null(renderer);
    assert_int_equal(counter.held, 0);
    for (int i = 0; i < calls; i++) {
        params = counted(&counter, 100, 70, 12, 2);
        counter.fail_at = i;
        renderer = (struct refocus_renderer *)&counter;
        assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_ERR_MEMORY);
        assert_null(renderer);
        assert_int_equal(counter.held, 0);
    }
}

/* Twice the margin of scratch rows, by the text of render.h. */
static double scratch(float blur)
{
    return blur <= 127 ? 512 : blur <= 236 ? 1024 : blur <= 472 ? 2048 : 4096;
}

/* render.h: 27 (W + 2P + 79)(H + 2P + 16) + 3 (W + 16)(H + 16) + 4 T (W + R) + 620000 T + 24 W
 * + 12 H + 2^20 */
static double stated(int width, int height, float blur, int threads)
{
    const double p = 2 * (ceil((double)blur) + 2);

    return 27 * (width + p + 79) * (height + p + 16) + 3.0 * (width + 16) * (height + 16) +
           4.0 * threads * (width + scratch(blur)) + 62e4 * threads + 24.0 * width + 12.0 * height +
           1048576.0;
}

TEST(formula)
{
    static const int sides[][2] = {{1, 1},     {1, 65535},   {65535, 1}, {16, 16},  {17, 33},
                                   {720, 540}, {1920, 1080}, {2, 40000}, {31, 5000}};
    static const float blurs[] = {0, 0.5f, 1, 20, 40.25f, 127, 128, 300, 944};
    static const int threads[] = {1, 2, 8, 64};

    for (int s = 0; s < 9; s++) {
        for (int k = 0; k < 9; k++) {
            for (int t = 0; t < 4; t++) {
                struct counter counter;
                struct refocus_renderer_params params =
                    counted(&counter, sides[s][0], sides[s][1], blurs[k], threads[t]);
                const uint64_t bytes = refocus_renderer_memory(&params);
                const double most = stated(sides[s][0], sides[s][1], blurs[k], threads[t]);
                double deep;

                if (bytes == 0 || (double)bytes > most)
                    fail_msg("%d x %d, K = %g, %d threads: says %llu bytes, header %.0f",
                             sides[s][0], sides[s][1], (double)blurs[k], threads[t],
                             (unsigned long long)bytes, most);
                params.deep = 1;
                deep = (double)refocus_renderer_memory(&params) - (double)bytes;
                if (deep <= 0 || deep > 7 * (sides[s][0] + 16.0) * (sides[s][1] + 64.0) + 65536)
                    fail_msg("%d x %d, K = %g, %d threads: deep photos take %.0f bytes",
                             sides[s][0], sides[s][1], (double)blurs[k], threads[t], deep);
            }
        }
    }
}

/* Returns the most memory that strip mode takes, by the text of render.h. */
static double stated_in_place(int width, int height, float blur, int threads)
{
    const double p = ceil((double)blur) + 2, filtered = blur > 127 ? 148 : blur > 54 ? 52 : 28;
    const double n = 16 * ceil(fmax(2 * p + 9, p + filtered) / 16), b = 128 + 2 * n;

    return 25 * (b + 64) * (b + 32) + 2.5 * (b + 2 * p + 64) * (b + 2 * p + 64) +
           0.78 * (width + 16.0) * (height + 64.0) + 4.0 * threads * (width + scratch(blur)) +
           62e4 * threads + 24 * fmin(p, 129) * fmin(p, 129) + 300000;
}

/* The figures that strip mode is for: of every blur, and of pictures smaller and larger than the
 * window of a block. */
TEST(formula_of_modes)
{
    static const int sides[][2] = {{1, 1},     {1, 65535},   {65535, 1},  {16, 16},   {17, 33},
                                   {720, 540}, {1920, 1080}, {2, 40000},  {31, 5000}, {263, 270},
                                   {358, 259}, {240, 1045},  {1195, 1348}};
    enum { SIDES = sizeof sides / sizeof *sides };
    struct refocus_renderer_params params = refocus_renderer_params_default(1920, 1080, 40);

    params.threads = 1;
    params.in_place = 1;
    assert_true(refocus_renderer_memory(&params) < 6000000);
    for (int s = 0; s < SIDES; s++) {
        for (int k = 0; k <= 2 * REFOCUS_MAX_BLUR_RADIUS; k++) {
            const int w = sides[s][0], h = sides[s][1], threads = k % 4 < 2 ? 64 : 1;
            const float blur = (float)k / 2;
            double bytes;

            params = refocus_renderer_params_default(w, h, blur);
            params.threads = threads;
            params.in_place = 1;
            bytes = (double)refocus_renderer_memory(&params);
            if (bytes <= 0 || bytes > stated_in_place(w, h, blur, threads))
                fail_msg("%d x %d, K = %g: strip mode takes %.0f bytes, header %.0f", w, h,
                         (double)blur, bytes, stated_in_place(w, h, blur, threads));
            params.highlights = 1;
            bytes = (double)refocus_renderer_memory(&params) - bytes;
            if (bytes < 0 || bytes > 24 * fmin(w, 512) * fmin(h, 512) + 65536)
                fail_msg("%d x %d, K = %g: the estimate takes %.0f bytes in strip mode", w, h,
                         (double)blur, bytes);
        }
    }
}

/* Returns how much each method of whole frames may add, by the text of render.h. */
static double extra(uint32_t method, int width, int height, float blur, int threads)
{
    const double w = width, h = height, p = ceil((double)blur) + 2, t = threads;

    switch (method) {
    case REFOCUS_METHOD_LIGHTFIELD:
        return 1200 * (w + 2 * p + 64) * t + 4096;
    case REFOCUS_METHOD_SCATTER:
        return 32 * w * h + 3 * (4 * p + 80) * p * p + 65536;
    case REFOCUS_METHOD_DIFFUSION:
        return 96 * (w + 16) * (h + 16) + 262144;
    case REFOCUS_METHOD_FOVEATED:
        return 96 * (w + 16) * (h + 16) + 262144;
    case REFOCUS_METHOD_INTERPOLATED:
        return 32 * (w + 16) * (h + 16) + 24 * (w + 64) * t + 65536;
    default:
        return 0;
    }
}

TEST(formula_of_methods)
{
    static const int sides[][2] = {{1, 1}, {1, 65535}, {65535, 1}, {17, 33}, {720, 540}};
    static const float blurs[] = {0, 1, 20, 127};

    for (uint32_t m = 0; m < REFOCUS_METHOD_COUNT; m++) {
        for (int i = 0; i < 5 * 4 * 2; i++) {
            const int w = sides[i % 5][0], h = sides[i % 5][1], threads = i < 20 ? 1 : 64;
            const float blur = blurs[i / 5 % 4];
            struct counter counter;
            struct refocus_renderer_params params = counted(&counter, w, h, blur, threads);
            const double without = (double)refocus_renderer_memory(&params);

            params.papers = refocus_papers();

            params.methods = REFOCUS_METHOD_BIT(m);
            const double with = (double)refocus_renderer_memory(&params);
            if (with < without || with - without > extra(m, w, h, blur, threads))
                fail_msg("%s, %d x %d, K = %g, %d threads: %.0f bytes more, header %.0f",
                         refocus_method_name(m), w, h, (double)blur, threads, with - without,
                         extra(m, w, h, blur, threads));
        }
    }
}

TEST(says_what_it_takes)
{
    static const int sides[][2] = {{1, 1}, {1, 65535}, {65535, 1}, {17, 33}, {720, 540}};
    static const float blurs[] = {0, 7.5f, 127};

    for (int s = 0; s < 5; s++) {
        for (int k = 0; k < 3; k++) {
            struct counter counter;
            struct refocus_renderer_params params =
                counted(&counter, sides[s][0], sides[s][1], blurs[k], 2);
            const uint64_t bytes = refocus_renderer_memory(&params);
            struct refocus_renderer_info info = refocus_renderer_info_default();
            struct refocus_renderer *renderer;

            assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
            if (counter.bytes > bytes)
                fail_msg("%d x %d, K = %g: says %llu bytes, takes %llu", sides[s][0], sides[s][1],
                         (double)blurs[k], (unsigned long long)bytes,
                         (unsigned long long)counter.bytes);
            refocus_renderer_get_info(renderer, &info);
            assert_int_equal(info.memory, counter.bytes);
            refocus_renderer_destroy(&renderer);

            params.max_memory = bytes - 1;
            assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_ERR_SIZE);
            assert_null(renderer);
            params.max_memory = bytes;
            assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
            refocus_renderer_destroy(&renderer);
            assert_int_equal(counter.held, 0);
        }
    }
}

/* The largest picture of all is refused or made, but its size does not overflow. */
TEST(largest)
{
    struct counter counter;
    struct refocus_renderer_params params = counted(&counter, 65535, 65535, 127, 1);
    struct refocus_renderer *renderer;
    const uint64_t bytes = refocus_renderer_memory(&params);

    assert_true((double)bytes <= stated(65535, 65535, 127, 1));
    assert_true((double)bytes > 10.0 * 65535 * 65535);
    counter.fail_at = 0;
    const int status = refocus_renderer_create(&renderer, &params);
    assert_true(status == REFOCUS_ERR_MEMORY || status == REFOCUS_ERR_SIZE);
    assert_null(renderer);
}

TEST(nothing_while_rendering)
{
    struct picture p = picture_make(120, 90, 9);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity disparity = picture_disparity(&p);
    uint8_t small[6] = {0, 50, 100, 150, 200, 250};
    const struct refocus_disparity coarse = refocus_disparity8(small, 3, 2, 3);
    struct counter counter;
    struct refocus_renderer_params limits = counted(&counter, 120, 90, 10, 2);
    struct refocus_renderer *renderer;
    uint8_t *out = malloc(3 * 120 * 90);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 120, 90, 360);

    assert_non_null(out);
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    const int calls = counter.calls;
    for (int i = 0; i < style_count; i++) {
        struct refocus_aperture *aperture = style_aperture(&styles[i]);
        struct refocus_settings params = style_params(&styles[i], 0.3f, 10);
        const int before = wrapped_calls;

        params.render.aperture = aperture;
        assert_int_equal(refocus_prepare(renderer, &photo, i % 2 ? &coarse : &disparity), 0);
        assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
        if (wrapped_calls != before || counter.calls != calls)
            fail_msg("%s: %d calls of malloc, %d of the allocator", styles[i].name,
                     wrapped_calls - before, counter.calls - calls);
        refocus_aperture_destroy(&aperture);
    }
    struct refocus_settings params;
    const char *name;
    for (int i = 0; effect_params(i, 0.3f, 10, &params, &name); i++) {
        struct refocus_aperture *aperture = effect_aperture(i);
        const int before = wrapped_calls;

        params.render.aperture = aperture;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
        if (wrapped_calls != before || counter.calls != calls)
            fail_msg("%s allocates", name);
        refocus_aperture_destroy(&aperture);
    }
    refocus_renderer_destroy(&renderer);
    assert_int_equal(counter.held, 0);
    free(out);
    picture_free(&p);
}
