/* stereo_views.c: a photo and its disparities are warped to the view of an eye beside the camera.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "views/stereo_views.h"

enum { ONE = 256, HOLE = -1 };

/* Rows of the two pictures. */
struct rows {
    const uint8_t *photo;
    const uint16_t *disparity;
    uint8_t *view;
    uint16_t *seen;
    int32_t *nearest; /* disparity of what is seen, or HOLE */
    int width;
    int32_t focus;       /* 65535 nearest */
    int64_t parallax_q8; /* shift of disparity 1 */
};

/* The place that pixel x moves to, in 1/256 pixel. */
static int32_t place(const struct rows *r, int x)
{
    const int64_t moved = (r->disparity[x] - r->focus) * r->parallax_q8;

    return x * ONE + (int32_t)((moved + (moved < 0 ? -32767 : 32767)) / 65535);
}

static int ceil_pixel(int32_t at)
{
    return at >= 0 ? (at + ONE - 1) / ONE : -(-at / ONE);
}

/* Pixel x of the view is part of the way from pixel a of the photo to pixel b. */
static void put(const struct rows *r, int x, int a, int b, int32_t part, int32_t whole)
{
    const int32_t d =
        (int32_t)(r->disparity[a] + ((int64_t)r->disparity[b] - r->disparity[a]) * part / whole);

    if (x < 0 || x >= r->width || d < r->nearest[x])
        return;
    r->nearest[x] = d;
    for (int c = 0; c < 3; c++)
        r->view[3 * x + c] = (uint8_t)((r->photo[3 * a + c] * (whole - part) +
                                        r->photo[3 * b + c] * part + whole / 2) /
                                       whole);
}

/* Neighbours less than a pixel of parallax apart are one surface, which stretches;
 * others have an edge between them, and each reaches half a pixel into it. */
static void warp_row(const struct rows *r)
{
    enum { HALF = ONE / 2 };

    for (int x = 0; x < r->width; x++)
        r->nearest[x] = HOLE;
    for (int x = -1; x < r->width; x++) {
        const int32_t from = x >= 0 ? place(r, x) : INT32_MIN / 2;
        const int32_t to = x + 1 < r->width ? place(r, x + 1) : INT32_MAX / 2;

        if (x >= 0 && x + 1 < r->width && abs(to - from - ONE) <= ONE) {
            for (int i = ceil_pixel(from); i * ONE < to; i++)
                put(r, i, x, x + 1, i * ONE - from, to - from);
            continue;
        }
        for (int i = x >= 0 ? ceil_pixel(from) : 0; x >= 0 && i * ONE < from + HALF; i++)
            put(r, i, x, x, 0, 1);
        for (int i = x + 1 < r->width ? ceil_pixel(to - HALF) : 0; x + 1 < r->width && i * ONE < to;
             i++)
            put(r, i, x + 1, x + 1, 0, 1);
    }
}

/* Fill pixels begin to end - 1 with the far side of the two, mirrored for as long as it
 * lies no nearer than its first pixel by 1/64, then with its last. */
static void fill_hole(const struct rows *r, int begin, int end)
{
    const int left = begin - 1, right = end;
    const bool from_left =
        right >= r->width || (left >= 0 && r->nearest[left] <= r->nearest[right]);
    const int edge = from_left ? left : right, step = from_left ? 1 : -1;
    const int32_t far = r->nearest[edge];
    int source = edge;

    for (int k = 0; k < end - begin; k++) {
        const int to = edge + step * (k + 1), mirrored = edge - step * k;

        if (mirrored >= 0 && mirrored < r->width && r->nearest[mirrored] != HOLE &&
            r->nearest[mirrored] <= far + 1024 && source == mirrored + (k > 0 ? step : 0))
            source = mirrored;
        memcpy(r->view + 3 * to, r->view + 3 * source, 3);
        r->seen[to] = (uint16_t)far;
    }
}

/* The whole row has moved out of the picture: the extension of its border is seen. */
static void fill_with_border(const struct rows *r)
{
    const int edge = place(r, 0) < 0 ? r->width - 1 : 0;

    for (int x = 0; x < r->width; x++) {
        memcpy(r->view + 3 * x, r->photo + 3 * edge, 3);
        r->seen[x] = r->disparity[edge];
    }
}

static void fill_row(const struct rows *r)
{
    for (int x = 0; x < r->width; x++) {
        int end = x;

        if (r->nearest[x] != HOLE) {
            r->seen[x] = (uint16_t)r->nearest[x];
            continue;
        }
        while (end < r->width && r->nearest[end] == HOLE)
            end++;
        if (end - x == r->width)
            fill_with_border(r);
        else
            fill_hole(r, x, end);
        x = end - 1;
    }
}

void stereo_warp(const struct refocus_image *photo, const uint16_t *disparity, double focus,
                 double parallax, const struct refocus_image *view, uint16_t *seen,
                 int32_t *nearest)
{
    const size_t width = (size_t)photo->width;

    for (int y = 0; y < photo->height; y++) {
        const struct rows rows = {.photo = photo->plane[0] + y * photo->stride[0],
                                  .disparity = disparity + (size_t)y * width,
                                  .view = view->plane[0] + y * view->stride[0],
                                  .seen = seen + (size_t)y * width,
                                  .nearest = nearest,
                                  .width = photo->width,
                                  .focus = (int32_t)floor(focus * 65535 + 0.5),
                                  .parallax_q8 = (int64_t)floor(parallax * ONE + 0.5)};

        warp_row(&rows);
        fill_row(&rows);
    }
}

int stereo_open(struct stereo *stereo, const struct shot *shot)
{
    const struct refocus_image *photo = shot->input.photo->image;
    const size_t pixels = (size_t)photo->width * (size_t)photo->height;

    stereo->view = refocus_image_packed(REFOCUS_FORMAT_RGB8, malloc(pixels * 3), photo->width,
                                        photo->height, (ptrdiff_t)photo->width * 3);
    stereo->disparity = malloc(pixels * sizeof *stereo->disparity);
    stereo->seen = malloc(pixels * sizeof *stereo->seen);
    stereo->nearest = malloc((size_t)photo->width * sizeof *stereo->nearest);
    if (!stereo->view.plane[0] || !stereo->disparity || !stereo->seen || !stereo->nearest ||
        refocus_get_view(shot->engine.renderer, REFOCUS_VIEW_DISPARITY, stereo->disparity,
                         (ptrdiff_t)photo->width * 2) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, shot->input.photo_name,
                              "not enough memory for a second eye");
    return EXIT_DONE;
}

int stereo_render(const struct stereo *stereo, struct shot *shot, double parallax,
                  const struct refocus_image *out)
{
    const struct refocus_image *photo = shot->input.photo->image;
    const struct refocus_disparity seen =
        refocus_disparity16(stereo->seen, photo->width, photo->height, (ptrdiff_t)photo->width * 2);
    const struct refocus_scene scene = refocus_scene_default(&stereo->view, &seen);
    int status;

    stereo_warp(photo, stereo->disparity, (double)shot->engine.params.render.focus_disparity,
                parallax, &stereo->view, stereo->seen, stereo->nearest);
    status = engine_prepare(&shot->engine, &scene);
    return status == EXIT_DONE ? engine_render(&shot->engine, out, 1) : status;
}

void stereo_close(struct stereo *stereo)
{
    free(stereo->view.plane[0]);
    free(stereo->disparity);
    free(stereo->seen);
    free(stereo->nearest);
}
