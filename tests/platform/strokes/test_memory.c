/* test_memory.c: every allocation fails once: REFOCUS_ERR_MEMORY, what was painted stays as it
 * was, and nothing is kept. The linker sends the library's calls here. */
#include "failing.h"
#include "picture.h"

#include <stdio.h>
#ifdef RF_HAVE_JANSSON
#include <jansson.h>
#endif

enum { W = 160, H = 120 };
static struct refocus_image photo;
static uint16_t base[W * H], before[W * H];

static const char file[] =
    "{\"refocus-strokes\": 1, \"width\": 160, \"height\": 120, \"strokes\": ["
    "{\"kind\": \"more\", \"radius\": 5, \"points\": [[70, 70], [90, 60]], "
    "\"disparity\": 0.3},"
    "{\"kind\": \"object\", \"radius\": 5, \"points\": [[20, 20], [9, 6]], "
    "\"disparity\": 0.3}]}";

/* Does all there is until something fails; what was there must be there then. */
static int paint_all(struct refocus_strokes *strokes, int *count)
{
    static const float points[] = {60, 60, 80, 45, 100, 60, 80, 75};
    const struct refocus_stroke ground = make_stroke(REFOCUS_STROKE_ALL, 1, 0.1f);
    const struct refocus_stroke object = make_stroke(REFOCUS_STROKE_OBJECT, 8, 0.5f);
    const struct refocus_stroke less = make_stroke(REFOCUS_STROKE_LESS, 3, -1);
    const struct refocus_stroke brush = make_stroke(REFOCUS_STROKE_BRUSH, 50, 1);
    int status;

    for (int step = 0; step < 10; step++) {
        *count = refocus_strokes_count(strokes);
        memcpy(before, refocus_strokes_disparity(strokes), sizeof before);
        status = step == 0   ? refocus_strokes_begin(strokes, &ground, NULL)
                 : step == 1 ? refocus_strokes_begin(strokes, &object, NULL)
                 : step == 2 ? refocus_strokes_extend(strokes, points, 2, NULL)
                 : step == 3 ? refocus_strokes_extend(strokes, points + 4, 2, NULL)
                 : step == 4 ? refocus_strokes_begin(strokes, &less, NULL)
                 : step == 5 ? refocus_strokes_extend(strokes, points, 1, NULL)
                 : step == 6 ? refocus_strokes_undo(strokes, NULL)
                 : step == 7 ? refocus_strokes_load(strokes, file, strlen(file), NULL)
                 : step == 8 ? refocus_strokes_begin(strokes, &brush, NULL)
                             : refocus_strokes_extend(strokes, points, 3, NULL);
        if (status == REFOCUS_ERR_UNSUPPORTED && step == 7)
            continue;
        /* jansson 2.14 takes a failure while it reads a word for a damaged file. */
        if (status == REFOCUS_ERR_FORMAT && step == 7)
            status = REFOCUS_ERR_MEMORY;
        if (status != REFOCUS_OK)
            return status;
    }
    return REFOCUS_OK;
}

TEST(test_every_allocation)
{
    const struct refocus_disparity map = refocus_disparity16(base, W, H, 2 * W);
    long fails = 0, before_live = failing.live;
    int status = REFOCUS_ERR_MEMORY;

    for (failing.fail_at = 1; status != REFOCUS_OK; failing.fail_at++) {
        struct refocus_strokes *strokes;
        int count = 0;

        failing.calls = 0;
        status = refocus_strokes_create(&strokes, &photo, &map);
        if (status == REFOCUS_OK) {
            status = paint_all(strokes, &count);
            if (status != REFOCUS_OK) {
                assert_int_equal(refocus_strokes_count(strokes), count);
                assert_memory_equal(refocus_strokes_disparity(strokes), before, sizeof before);
            }
        } else {
            assert_null(strokes);
        }
        refocus_strokes_destroy(&strokes);
        assert_int_equal(failing.live, before_live);
        fails += status == REFOCUS_ERR_MEMORY;
        assert_true(status == REFOCUS_OK || status == REFOCUS_ERR_MEMORY);
    }
    printf("%ld allocations failed\n", fails);
    assert_true(fails > 30);
}

/* The file written: NULL or whole. */
TEST(test_save)
{
    struct refocus_strokes *strokes;
    int status = REFOCUS_ERR_MEMORY, count;
    char *text;
    size_t size;

    failing.fail_at = 0;
    assert_int_equal(refocus_strokes_create(&strokes, &photo, NULL), REFOCUS_OK);
    assert_int_equal(paint_all(strokes, &count), REFOCUS_OK);
    for (failing.fail_at = 1; status == REFOCUS_ERR_MEMORY; failing.fail_at++) {
        failing.calls = 0;
        status = refocus_strokes_save(strokes, &text, &size);
        assert_true((status == REFOCUS_OK) == (text != NULL));
        __real_free(text);
    }
    assert_true(status == REFOCUS_OK || status == REFOCUS_ERR_UNSUPPORTED);
    failing.fail_at = 0;
    refocus_strokes_destroy(&strokes);
}

int main(void)
{
    int failed;

    photo = make_picture(W, H);
#ifdef RF_HAVE_JANSSON
    json_set_alloc_funcs(malloc, free);
#endif
    failed = unit_test_run(NULL, NULL);
    free(photo.plane[0]);
    return failed;
}
