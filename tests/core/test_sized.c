/* test_sized.c: structs of older and newer programs are read as sized.h says, and not a byte behind
 * their size. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include <stdint.h>

#include "unit_test.h"
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <refocus/refocus.h>

/* A struct of three releases. */
struct first {
    uint32_t struct_size;
    float a;
};
struct second {
    uint32_t struct_size;
    float a;
    uint32_t b;
};
struct third {
    uint32_t struct_size;
    float a;
    uint32_t b, c;
};
enum { FIRST = REFOCUS_SIZE_TO(struct second, a) };

TEST(older_and_newer)
{
    struct first old = {sizeof old, 2};
    struct first *volatile given = &old; /* the compiler does not know its size: no warning */
    struct third new = {sizeof new, 3, 4, 0};
    struct second own;

    memset(&own, 0xff, sizeof own);
    assert_int_equal(refocus_struct_read(&own, sizeof own, FIRST, given), REFOCUS_OK);
    assert_true(own.struct_size == sizeof own && own.a == 2 && own.b == 0);
    assert_int_equal(refocus_struct_read(&own, sizeof own, FIRST, &new), REFOCUS_OK);
    assert_true(own.struct_size == sizeof own && own.a == 3 && own.b == 4);
    new.c = 0x01000000; /* any byte of it */
    new.a = 9;
    assert_int_equal(refocus_struct_read(&own, sizeof own, FIRST, &new), REFOCUS_ERR_UNSUPPORTED);
    assert_true(own.a == 3);
}

TEST(filled)
{
    const struct second own = {sizeof own, 5, 6};
    struct first old = {sizeof old, 0};
    struct first *volatile given = &old;
    struct third new = {sizeof new, 0, 0, 7};

    assert_int_equal(refocus_struct_write(given, FIRST, &own, sizeof own), REFOCUS_OK);
    assert_true(old.struct_size == sizeof old && old.a == 5);
    assert_int_equal(refocus_struct_write(&new, FIRST, &own, sizeof own), REFOCUS_OK);
    assert_true(new.struct_size == sizeof new &&new.a == 5 && new.b == 6 && new.c == 0);
}

/* A struct that ends where memory does. */
TEST(not_a_byte_behind)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    unsigned char *pages =
        mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    struct third own;

    assert_true(pages != MAP_FAILED);
    assert_int_equal(mprotect(pages + page, page, PROT_NONE), 0);
    for (uint32_t size = 0; size <= 2 * sizeof own; size += 4) {
        void *const at = pages + page - size;
        const int expected = size < FIRST ? REFOCUS_ERR_ARGUMENT : REFOCUS_OK;

        if (size >= sizeof size)
            memcpy(at, &size, sizeof size);
        if (size >= sizeof size) {
            assert_int_equal(refocus_struct_read(&own, sizeof own, FIRST, at), expected);
            assert_int_equal(refocus_struct_write(at, FIRST, &own, sizeof own), expected);
        }
        memset(pages, 0, page);
    }
    munmap(pages, 2 * page);
}

/* A feature that is left out is one with its defaults, field by field. */
TEST(defaults)
{
    enum { W = 64, H = 48 };
    static uint8_t photo[3 * W * H], plain[3 * W * H], set[3 * W * H];
    static uint16_t depth[W * H];
    const struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 9);
    const struct refocus_image in = refocus_image_packed(REFOCUS_FORMAT_RGB8, photo, W, H, 3 * W);
    const struct refocus_image out = refocus_image_packed(REFOCUS_FORMAT_RGB8, plain, W, H, 3 * W);
    const struct refocus_image all = refocus_image_packed(REFOCUS_FORMAT_RGB8, set, W, H, 3 * W);
    const struct refocus_disparity map = refocus_disparity16(depth, W, H, 2 * W);
    struct refocus_settings settings = refocus_settings_default(0.7f, 8);
    struct refocus_renderer *renderer;

    for (int i = 0; i < W * H; i++) {
        depth[i] = (uint16_t)(i * 40503u >> 4);
        for (int c = 0; c < 3; c++)
            photo[3 * i + c] = (uint8_t)(i * (5 + c) % 253);
    }
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &in, &map), REFOCUS_OK);
    for (uint32_t m = REFOCUS_METHOD_SWEEP; m <= REFOCUS_METHOD_SEARCH; m++) {
        settings.render.method = m;
        assert_int_equal(refocus_render(renderer, &settings.render, &out), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &settings, &all), REFOCUS_OK);
        assert_memory_equal(plain, set, sizeof plain);
    }
    refocus_renderer_destroy(&renderer);
}
