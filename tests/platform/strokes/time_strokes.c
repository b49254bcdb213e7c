/* time_strokes.c: time_strokes PHOTO [STROKES.json]: how long each segment of a stroke takes.
 * Without a file one object is painted over, along a spiral around the middle. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <refocus/platform/file.h>
#include <refocus/platform/strokes.h>
#include "../../clock.h"

enum { MOST = 100000, SEGMENT = 2 };

static double times[MOST];
static int count;

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Draw the points as a finger does, a few at a time. */
static int draw(struct refocus_strokes *strokes, const struct refocus_stroke *stroke,
                const float *points, int n)
{
    int status = refocus_strokes_begin(strokes, stroke, NULL);

    for (int i = 0; i < n && status == REFOCUS_OK; i += SEGMENT) {
        const double start = clock_ms(CLOCK_THREAD_CPUTIME_ID);

        status = refocus_strokes_extend(strokes, points + 2 * i, n - i < SEGMENT ? n - i : SEGMENT,
                                        NULL);
        if (count < MOST)
            times[count++] = clock_ms(CLOCK_THREAD_CPUTIME_ID) - start;
    }
    return status;
}

/* Points a brush radius apart, as a screen reports them. */
static int densify(const float *points, int n, float step, float *out, int most)
{
    int made = 0;

    for (int i = 0; i < n; i++) {
        const float *const a = points + 2 * (i > 0 ? i - 1 : 0), *const b = points + 2 * i;
        const float dx = b[0] - a[0], dy = b[1] - a[1];
        const int parts = (int)ceilf(sqrtf(dx * dx + dy * dy) / step) + (i == 0);

        for (int p = 1; p <= parts && made < most; p++, made++) {
            out[2 * made] = a[0] + dx * (float)p / (float)parts;
            out[2 * made + 1] = a[1] + dy * (float)p / (float)parts;
        }
    }
    return made;
}

static int spiral(struct refocus_strokes *strokes, int width, int height)
{
    struct refocus_stroke stroke = refocus_stroke_default(REFOCUS_STROKE_OBJECT, (float)width / 60);
    static float points[2 * 200];

    stroke.fill.kind = REFOCUS_FILL_SOLID;
    stroke.fill.d0 = 1;
    for (int i = 0; i < 200; i++) {
        const float turn = (float)i / 10, radius = (float)height / 4 * (float)i / 200;

        points[2 * i] = (float)width / 2 + radius * cosf(turn);
        points[2 * i + 1] = (float)height / 2 + radius * sinf(turn);
    }
    return draw(strokes, &stroke, points, 200);
}

static int replay(struct refocus_strokes *strokes, const struct refocus_strokes *from)
{
    static float points[2 * MOST];
    int status = REFOCUS_OK;

    for (int i = 0; i < refocus_strokes_count(from) && status == REFOCUS_OK; i++) {
        struct refocus_stroke stroke = refocus_stroke_default(REFOCUS_STROKE_ALL, 1);
        const float *given;
        int n;

        refocus_strokes_get(from, i, &stroke, &given, &n);
        status = draw(strokes, &stroke, points, densify(given, n, stroke.radius, points, MOST));
    }
    return status;
}

static int load(struct refocus_strokes *strokes, const char *name)
{
    static char text[1 << 20];
    struct refocus_strokes_reason reason;
    FILE *const file = fopen(name, "rb");
    const size_t size = file ? fread(text, 1, sizeof text, file) : 0;
    const int status = refocus_strokes_load(strokes, text, size, &reason);

    if (file)
        fclose(file);
    if (status != REFOCUS_OK)
        fprintf(stderr, "%s: %s\n", name, reason.text);
    return status;
}

int main(int argc, char **argv)
{
    struct refocus_photo *photo = NULL;
    struct refocus_strokes *strokes = NULL, *from = NULL;
    struct refocus_reason reason;
    double start, created;
    int status;

    if (argc < 2 || refocus_photo_read(&photo, argv[1], NULL, &reason) != REFOCUS_OK)
        return 2;
    start = clock_ms(CLOCK_THREAD_CPUTIME_ID);
    status = refocus_strokes_create(&strokes, photo->image, NULL);
    created = clock_ms(CLOCK_THREAD_CPUTIME_ID) - start;
    if (status == REFOCUS_OK && argc > 2) {
        status = refocus_strokes_create(&from, photo->image, NULL);
        if (status == REFOCUS_OK)
            status = load(from, argv[2]);
        if (status == REFOCUS_OK)
            status = replay(strokes, from);
    } else if (status == REFOCUS_OK) {
        status = spiral(strokes, photo->image->width, photo->image->height);
    }
    if (status == REFOCUS_OK && count > 0) {
        qsort(times, (size_t)count, sizeof *times, by_size);
        printf("%dx%d: create %.1f ms; %d segments: min %.1f, median %.1f, 95 %% %.1f, "
               "max %.1f ms\n",
               photo->image->width, photo->image->height, created, count, times[0],
               times[count / 2], times[count * 95 / 100], times[count - 1]);
    }
    refocus_strokes_destroy(&strokes);
    refocus_strokes_destroy(&from);
    refocus_photo_free(&photo);
    return status != REFOCUS_OK;
}
