/* misuse_strokes.c: misuse of depth by strokes. */
#include "misuse.h"

#include <refocus/platform/strokes.h>

static struct refocus_strokes *strokes;

static void create_photo(const struct refocus_image *photo)
{
    REFUSED(refocus_strokes_create, &strokes, photo, NULL);
    assert_null(strokes);
}

static void create_base(const struct refocus_disparity *base)
{
    const struct refocus_image photo = misuse_photo();

    if (base) /* there may be none */
        REFUSED(refocus_strokes_create, &strokes, &photo, base);
}

static void select_stride(ptrdiff_t stride)
{
    static uint8_t mask[W * H];

    REFUSED(refocus_strokes_selection, strokes, mask, W, H, stride);
}

static void without_painting(void)
{
    const struct refocus_stroke stroke = RETURNS(refocus_stroke_default, REFOCUS_STROKE_BRUSH, 2);
    const struct refocus_image photo = misuse_photo();
    static const float point[2] = {1, 1};
    static uint8_t samples[6 * W * H];
    const struct refocus_image deep =
        refocus_image_packed(REFOCUS_FORMAT_RGB16, samples, W, H, 6 * W);
    uint8_t mask[1];

    REFUSED(refocus_strokes_create, NULL, &photo, NULL);
    misuse_images(create_photo);
    create_photo(&deep);
    misuse_maps(create_base);
    RETURNS(refocus_strokes_destroy, NULL);
    RETURNS(refocus_strokes_destroy, &strokes);
    REFUSED(refocus_strokes_begin, NULL, &stroke, NULL);
    REFUSED(refocus_strokes_extend, NULL, point, 1, NULL);
    REFUSED(refocus_strokes_undo, NULL, NULL);
    GIVES(0, refocus_strokes_count, NULL);
    REFUSED(refocus_strokes_get, NULL, 0, NULL, NULL, NULL);
    GIVES_NULL(refocus_strokes_disparity, NULL);
    REFUSED(refocus_strokes_selection, NULL, mask, 1, 1, 1);
}

static void bad_strokes(void)
{
    const struct misuse bad[] = {
        BAD(refocus_stroke, struct_size, 0),   BAD(refocus_stroke, kind, UINT32_MAX),
        BAD(refocus_stroke, radius, 0),        BAD(refocus_stroke, radius, NAN),
        BAD(refocus_stroke, radius, INFINITY), BAD(refocus_stroke, reach, -1),
        BAD(refocus_stroke, reach, NAN),       BAD(refocus_stroke, fill.kind, UINT32_MAX)};

    REFUSED(refocus_strokes_begin, strokes, NULL, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_stroke stroke = refocus_stroke_default(REFOCUS_STROKE_OBJECT, 2);

        misuse_spoil(&stroke, &bad[i]);
        REFUSED(refocus_strokes_begin, strokes, &stroke, NULL);
    }
    misuse_spoil(NULL, NULL);
    ANSWERS(REFOCUS_ERR_STATE, refocus_strokes_undo, strokes, NULL);
}

static void bad_points(void)
{
    static const float points[][2] = {{NAN, 1}, {1, INFINITY}, {-1, 1}, {1, H}, {W, 1}};
    const struct misuse no_size = BAD(refocus_stroke, struct_size, 0);
    const struct refocus_stroke brush = refocus_stroke_default(REFOCUS_STROKE_BRUSH, 2);
    struct refocus_stroke unsized_stroke = brush;

    ANSWERS(REFOCUS_ERR_STATE, refocus_strokes_extend, strokes, points[0], 1, NULL);
    ANSWERS(REFOCUS_OK, refocus_strokes_begin, strokes, &brush, NULL);
    for (size_t i = 0; i < COUNT(points); i++)
        REFUSED(refocus_strokes_extend, strokes, points[i], 1, NULL);
    REFUSED(refocus_strokes_extend, strokes, NULL, 1, NULL);
    REFUSED(refocus_strokes_extend, strokes, points[0], 0, NULL);
    REFUSED(refocus_strokes_extend, strokes, points[0], INT32_MIN, NULL);
    /* Refused by the count, before the points are looked at. */
    ANSWERS(REFOCUS_ERR_SIZE, refocus_strokes_extend, strokes, points[0], INT32_MAX, NULL);
    REFUSED(refocus_strokes_get, strokes, -1, NULL, NULL, NULL);
    REFUSED(refocus_strokes_get, strokes, INT32_MIN, NULL, NULL, NULL);
    REFUSED(refocus_strokes_get, strokes, INT32_MAX, NULL, NULL, NULL);
    ANSWERS(REFOCUS_OK, refocus_strokes_get, strokes, 0, NULL, NULL, NULL);
    misuse_spoil(&unsized_stroke, &no_size);
    REFUSED(refocus_strokes_get, strokes, 0, &unsized_stroke, NULL, NULL);
    misuse_spoil(NULL, NULL);
}

static void bad_selections(void)
{
    static const int sides[] = {0, -1, INT32_MIN};
    uint8_t mask[W * H];

    misuse_strides(select_stride, W);
    REFUSED(refocus_strokes_selection, strokes, NULL, W, H, W);
    for (size_t i = 0; i < COUNT(sides); i++) {
        REFUSED(refocus_strokes_selection, strokes, mask, sides[i], H, W);
        REFUSED(refocus_strokes_selection, strokes, mask, W, sides[i], W);
    }
    REFUSED(refocus_strokes_selection, strokes, mask, INT32_MAX, H, W);
    REFUSED(refocus_strokes_selection, strokes, mask, W, INT32_MAX, PTRDIFF_MAX / INT32_MAX + 1);
}

static void bad_files(void)
{
    struct refocus_strokes_reason reason;
    char *text = NULL;
    size_t size = 0;
    /* Without jansson both are refused whatever they are given. */
    const int has_json = refocus_strokes_save(strokes, &text, &size) == REFOCUS_OK;
    const int expected = has_json ? REFOCUS_ERR_ARGUMENT : REFOCUS_ERR_UNSUPPORTED;

    free(text);
    ANSWERS(expected, refocus_strokes_load, NULL, "{}", 2, NULL);
    ANSWERS(expected, refocus_strokes_load, strokes, NULL, 2, &reason);
    ANSWERS(expected, refocus_strokes_load, strokes, NULL, SIZE_MAX, NULL);
    ANSWERS(has_json ? REFOCUS_ERR_FORMAT : expected, refocus_strokes_load, strokes, NULL, 0, NULL);
    ANSWERS(expected, refocus_strokes_save, NULL, &text, &size);
    ANSWERS(expected, refocus_strokes_save, strokes, NULL, &size);
    ANSWERS(expected, refocus_strokes_save, strokes, &text, NULL);
}

void misuse_strokes(void **state)
{
    const struct refocus_image photo = misuse_photo();

    (void)state;
    without_painting();
    ANSWERS(REFOCUS_OK, refocus_strokes_create, &strokes, &photo, NULL);
    bad_strokes();
    bad_points();
    bad_selections();
    bad_files();
    refocus_strokes_destroy(&strokes);
    misuse_done();
}
