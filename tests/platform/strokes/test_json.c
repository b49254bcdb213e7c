/* test_json.c: the file of strokes: round trips, and every way to be refused, in its words. */
#include "picture.h"

#include <stdio.h>

enum { W = 320, H = 240 };
static struct refocus_image photo;

static struct refocus_strokes *begin(void)
{
    struct refocus_strokes *strokes;

    assert_int_equal(refocus_strokes_create(&strokes, &photo, NULL), REFOCUS_OK);
    return strokes;
}

TEST(test_round_trip)
{
    const float points[] = {120, 120, 160.123456f, 90, 200, 120, 159.9f, 150, 0.1f, -0.5f};
    struct refocus_strokes *strokes = begin(), *again = begin();
    struct refocus_stroke ground = make_stroke(REFOCUS_STROKE_ALL, 1, 0);
    char *text, *second;
    size_t size, second_size;

    ground.fill = (struct refocus_fill){REFOCUS_FILL_GRADIENT, 1, 0.1f, 160, 239, 160.7f, 3.3f};
    assert_int_equal(refocus_strokes_begin(strokes, &ground, NULL), REFOCUS_OK);
    paint(strokes, REFOCUS_STROKE_OBJECT, 10.7f, 0.3f, points, 4);
    paint(strokes, REFOCUS_STROKE_MORE, 3, -1, points, 5);
    paint(strokes, REFOCUS_STROKE_LESS, 3, -1, points + 8, 1);
    paint(strokes, REFOCUS_STROKE_FILL, 1, 0.7f, NULL, 0);
    paint(strokes, REFOCUS_STROKE_BRUSH, 5, -1, points + 8, 1);
    assert_int_equal(refocus_strokes_save(strokes, &text, &size), REFOCUS_OK);
    assert_int_equal(refocus_strokes_load(again, text, size, NULL), REFOCUS_OK);
    assert_int_equal(refocus_strokes_count(again), 6);
    assert_memory_equal(refocus_strokes_disparity(again), refocus_strokes_disparity(strokes),
                        2 * W * H);
    assert_int_equal(refocus_strokes_save(again, &second, &second_size), REFOCUS_OK);
    assert_string_equal(text, second);
    assert_int_equal(strlen(second), second_size);
    for (int i = 0; i < 6; i++) {
        struct refocus_stroke a = refocus_stroke_default(REFOCUS_STROKE_ALL, 1), b = a;
        const float *p, *q;
        int m, n;

        assert_int_equal(refocus_strokes_get(strokes, i, &a, &p, &m), REFOCUS_OK);
        assert_int_equal(refocus_strokes_get(again, i, &b, &q, &n), REFOCUS_OK);
        assert_int_equal(m, n);
        assert_int_equal(a.kind, b.kind);
        assert_true(m == 0 || (a.radius <= b.radius && a.radius >= b.radius));
        assert_memory_equal(&a.fill, &b.fill, sizeof a.fill);
        if (m > 0)
            assert_memory_equal(p, q, 2 * sizeof *p * (size_t)m);
    }
    free(text);
    free(second);
    refocus_strokes_destroy(&strokes);
    refocus_strokes_destroy(&again);
}

#define HEAD "{\"refocus-strokes\": 1, \"width\": 320, \"height\": 240, \"strokes\": ["
#define OBJECT                                                                                     \
    "{\"kind\": \"object\", \"radius\": 9, \"points\": [[160, 120]], \"disparity\": "              \
    "1}"

TEST(test_refusals)
{
    static const struct {
        const char *text;
        int status;
        const char *why;
    } cases[] = {
        {"", REFOCUS_ERR_FORMAT, "it is empty"},
        {"{", REFOCUS_ERR_FORMAT, "line 1 is no JSON: string or '}' expected near end of file"},
        {"[1]", REFOCUS_ERR_FORMAT, "no file of strokes: it has no key 'refocus-strokes'"},
        {"{\"refocus-strokes\": 2}", REFOCUS_ERR_FORMAT,
         "'refocus-strokes' must be 1, the version that is known here"},
        {"{\"refocus-strokes\": 1, \"strokes\": []}", REFOCUS_ERR_FORMAT,
         "width and height must be those of the photo, 320x240"},
        {"{\"refocus-strokes\": 1, \"width\": 640, \"height\": 480, \"strokes\": []}",
         REFOCUS_ERR_SIZE, "its strokes are of a picture of 640x480, the photo has 320x240"},
        {"{\"refocus-strokes\": 1, \"width\": 320, \"height\": 240, \"author\": 1}",
         REFOCUS_ERR_FORMAT, "it has an unknown key 'author'"},
        {"{\"refocus-strokes\": 1, \"width\": 320, \"height\": 240}", REFOCUS_ERR_FORMAT,
         "'strokes' must be a list"},
        {HEAD "3]}", REFOCUS_ERR_FORMAT, "strokes[0] must be an object"},
        {HEAD "{\"kind\": \"line\"}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].kind must be all, object, more, less, brush or fill"},
        {HEAD "{\"kind\": \"all\", \"radius\": 3}]}", REFOCUS_ERR_FORMAT,
         "strokes[0] has a key 'radius', which 'all' does not take"},
        {HEAD "{\"kind\": \"brush\", \"reach\": 3}]}", REFOCUS_ERR_FORMAT,
         "strokes[0] has a key 'reach', which 'brush' does not take"},
        {HEAD "{\"kind\": \"all\", \"disparity\": 1.5}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].disparity must be a number from 0 to 1"},
        {HEAD "{\"kind\": \"all\", \"disparity\": \"far\"}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].disparity must be a number from 0 to 1"},
        {HEAD "{\"kind\": \"all\", \"disparity\": 1, \"gradient\": []}]}", REFOCUS_ERR_FORMAT,
         "strokes[0] has both a disparity and a gradient; give one"},
        {HEAD "{\"kind\": \"all\", \"gradient\": [[0, 0], [1, 1]]}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].gradient must be [[X, Y, D], [X, Y, D]] with D from 0 to 1"},
        {HEAD "{\"kind\": \"all\", \"gradient\": [[5, 5, 0], [5, 5.5, 1]]}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].gradient must go from one pixel to another"},
        {HEAD OBJECT ", {\"kind\": \"object\"}]}", REFOCUS_ERR_FORMAT,
         "strokes[1] must have a radius, 0.5 to 4096 pixels"},
        {HEAD "{\"kind\": \"object\", \"radius\": 0}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].radius must be a number from 0.5 to 4096"},
        {HEAD "{\"kind\": \"object\", \"radius\": 3}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].points must be a list of [X, Y], one at least"},
        {HEAD "{\"kind\": \"object\", \"radius\": 3, \"points\": []}]}", REFOCUS_ERR_FORMAT,
         "strokes[0].points must be a list of [X, Y], one at least"},
        {HEAD OBJECT ", {\"kind\": \"less\", \"radius\": 3, \"points\": [[3, 4], [320, 4]]}]}",
         REFOCUS_ERR_FORMAT, "strokes[1].points[1] must be a pixel, 0 to 319 and 0 to 239"},
        {HEAD "{\"kind\": \"more\", \"radius\": 3, \"points\": [[3, 4]]}]}", REFOCUS_ERR_FORMAT,
         "strokes[0] is 'more', which needs an object before it"},
        {HEAD "{\"kind\": \"fill\", \"disparity\": 1}]}", REFOCUS_ERR_FORMAT,
         "strokes[0] is 'fill', which needs a layer before it"},
        {HEAD OBJECT ", {\"kind\": \"fill\"}]}", REFOCUS_ERR_FORMAT,
         "strokes[1] must have a disparity or a gradient to fill with"},
        {HEAD "{\"kind\": \"all\", \"\x1b[31m\\u00e9\": 1}]}", REFOCUS_ERR_FORMAT, NULL},
    };
    static uint16_t before[W * H];
    struct refocus_strokes *strokes = begin();

    memcpy(before, refocus_strokes_disparity(strokes), sizeof before);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct refocus_strokes_reason reason;

        assert_int_equal(
            refocus_strokes_load(strokes, cases[i].text, strlen(cases[i].text), &reason),
            cases[i].status);
        for (const char *c = reason.text; *c; c++)
            assert_true(*c >= ' ' && *c <= '~');
        if (cases[i].why)
            assert_string_equal(reason.text, cases[i].why);
        assert_int_equal(refocus_strokes_count(strokes), 0);
        assert_memory_equal(refocus_strokes_disparity(strokes), before, sizeof before);
    }
    refocus_strokes_destroy(&strokes);
}

/* Strokes after those that there are; and when it fails in the middle, they are as
 * before. */
TEST(test_appended)
{
    static const char good[] = HEAD "{\"kind\": \"more\", \"radius\": 9, \"points\": "
                                    "[[10, 10]]}, {\"kind\": \"fill\", \"disparity\": 0.1}]}";
    static const char bad[] = HEAD "{\"kind\": \"more\", \"radius\": 9, \"points\": "
                                   "[[10, 10]]}, {\"kind\": \"fill\"}]}";
    static uint16_t before[W * H];
    struct refocus_strokes *strokes = begin();
    const float over[] = {120, 120, 200, 120};

    paint(strokes, REFOCUS_STROKE_OBJECT, 16, 0.5f, over, 2);
    memcpy(before, refocus_strokes_disparity(strokes), sizeof before);
    assert_int_equal(refocus_strokes_load(strokes, bad, strlen(bad), NULL), REFOCUS_ERR_FORMAT);
    assert_int_equal(refocus_strokes_count(strokes), 1);
    assert_memory_equal(refocus_strokes_disparity(strokes), before, sizeof before);
    assert_int_equal(refocus_strokes_load(strokes, good, strlen(good), NULL), REFOCUS_OK);
    assert_int_equal(refocus_strokes_count(strokes), 3);
    assert_int_equal(refocus_strokes_disparity(strokes)[10 * W + 10], 6554);
    refocus_strokes_destroy(&strokes);
}

TEST(test_too_many)
{
    enum { ROOM = 1 << 20 };
    struct refocus_strokes *strokes = begin();
    struct refocus_strokes_reason reason;
    char *const text = malloc(ROOM);
    size_t size;

    assert_non_null(text);
    size = (size_t)snprintf(text, ROOM, HEAD);
    for (int i = 0; i <= REFOCUS_MAX_STROKES; i++)
        size +=
            (size_t)snprintf(text + size, ROOM - size, "%s{\"kind\": \"all\"}", i > 0 ? ", " : "");
    size += (size_t)snprintf(text + size, ROOM - size, "]}");
    assert_int_equal(refocus_strokes_load(strokes, text, size, &reason), REFOCUS_ERR_SIZE);
    assert_string_equal(reason.text, "more than 4096 strokes or 1048576 points");
    assert_int_equal(refocus_strokes_count(strokes), 0);
    free(text);
    refocus_strokes_destroy(&strokes);
}

/* Load so many copies of a text between a beginning and an end. */
static int load_copies(struct refocus_strokes *strokes, const char *beginning, const char *copy,
                       int count, const char *end)
{
    const size_t room = strlen(beginning) + strlen(end) + (size_t)count * (strlen(copy) + 2) + 1;
    char *const text = malloc(room);
    size_t size;
    int status;

    assert_non_null(text);
    size = (size_t)snprintf(text, room, "%s", beginning);
    for (int i = 0; i < count; i++)
        size += (size_t)snprintf(text + size, room - size, "%s%s", i > 0 ? ", " : "", copy);
    size += (size_t)snprintf(text + size, room - size, "%s", end);
    status = refocus_strokes_load(strokes, text, size, NULL);
    free(text);
    return status;
}

/* Files of some kilobytes that would take minutes are refused, and nothing has changed. */
TEST(test_too_much_work)
{
    static const char object[] = "{\"kind\": \"object\", \"radius\": 99, \"points\": [[9, 9]]}";
    static const char brush[] = HEAD "{\"kind\": \"brush\", \"radius\": 4096, \"points\": [";
    static uint16_t before[W * H];
    /* All of the picture is within reach of an object; on a quarter of each side it is cut, and
     * its colours are counted. */
    const int objects = REFOCUS_MAX_STROKE_WORK / (W * H + 100 * (W / 4) * (H / 4) + 65536 + 8192);
    const float over[] = {120, 120, 200, 120};
    struct refocus_strokes *strokes = begin();

    paint(strokes, REFOCUS_STROKE_OBJECT, 16, 0.5f, over, 2);
    memcpy(before, refocus_strokes_disparity(strokes), sizeof before);
    assert_int_equal(load_copies(strokes, HEAD, object, objects + 1, "]}"), REFOCUS_ERR_SIZE);
    assert_int_equal(load_copies(strokes, brush, "[9, 9]", 80000, "]}]}"), REFOCUS_ERR_SIZE);
    assert_int_equal(refocus_strokes_count(strokes), 1);
    assert_memory_equal(refocus_strokes_disparity(strokes), before, sizeof before);
    assert_int_equal(load_copies(strokes, HEAD, object, objects / 20, "]}"), REFOCUS_OK);
    assert_int_equal(load_copies(strokes, brush, "[9, 9]", 40000, "]}]}"), REFOCUS_OK);
    refocus_strokes_destroy(&strokes);
}

int main(void)
{
    int failed;

    photo = make_picture(W, H);
    failed = unit_test_run(NULL, NULL);
    free(photo.plane[0]);
    return failed;
}
