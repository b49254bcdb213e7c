/* lightfield_truth.c: lightfield-truth FOLDER OUT FOCUS RADIUS: ground truth from a light field.
 *
 * FOLDER holds the views of a 9 x 9 camera array, input_CamNNN.png with NNN = 9 row + column, at
 * least those inside a circle, and the disparity of the centre view in gt_disp_lowres.pfm. A
 * point of disparity g (pixels from one view to the next) seen at (x, y) in the centre is at
 * (x - g (c - 4), y - g (r - 4)) in view (r, c). Writes OUT/photo.png (the centre),
 * OUT/disparity.png (d = (g - least) / (most - least)) and OUT/truth.png: the mean, in linear
 * light, of the views within RADIUS of the centre, shifted so that d = FOCUS stays. Prints
 * "K focus views": blur radius of a point is RADIUS |g - gf|, so K = RADIUS (most - least). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>
#include <refocus/platform/file.h>

static double to_light(uint8_t code)
{
    const double x = code / 255.0;
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static uint8_t to_code(double light)
{
    const double x = light <= 0.0031308 ? light * 12.92 : 1.055 * pow(light, 1 / 2.4) - 0.055;
    return (uint8_t)(255 * fmin(1, x) + 0.5);
}

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

/* Adds a view shifted by (dx, dy), between pixels by its four nearest. */
static void add_view(const struct refocus_image *view, double dx, double dy,
                     const double light[256], double *sum)
{
    const int ix = (int)floor(dx), iy = (int)floor(dy);

    for (int y = 0; y < view->height; y++) {
        for (int x = 0; x < view->width; x++, sum += 3) {
            for (int i = 0; i < 4; i++) {
                const int qx = clamp(x + ix + i % 2, view->width - 1);
                const int qy = clamp(y + iy + i / 2, view->height - 1);
                const double w = (i % 2 ? dx - ix : 1 - dx + ix) * (i / 2 ? dy - iy : 1 - dy + iy);
                const uint8_t *from = view->plane[0] + qy * view->stride[0] + 3 * qx;

                for (int c = 0; c < 3; c++)
                    sum[c] += w * light[from[c]];
            }
        }
    }
}

static int fail(const char *what, const struct refocus_reason *reason)
{
    fprintf(stderr, "lightfield-truth: %s: %s\n", what, reason->text);
    return 1;
}

int main(int argc, char **argv)
{
    static double light[256];
    struct refocus_reason reason = {""};
    struct refocus_photo *depth = NULL, *centre = NULL;
    struct refocus_depth_report report = refocus_depth_report_default();
    char path[2048];
    int views = 0, status = 1;

    if (argc != 5 || strlen(argv[1]) > 1900 || strlen(argv[2]) > 1900) {
        fputs("usage: lightfield-truth FOLDER OUT FOCUS RADIUS\n", stderr);
        return 2;
    }
    const double focus = atof(argv[3]), radius = atof(argv[4]);
    for (int i = 0; i < 256; i++)
        light[i] = to_light((uint8_t)i);
    snprintf(path, sizeof path, "%s/gt_disp_lowres.pfm", argv[1]);
    if (refocus_depth_read(&depth, path, "disparity", 0, 0, NULL, &reason))
        return fail(path, &reason);
    const int w = depth->depth->width, h = depth->depth->height;
    uint16_t *disparity = malloc((size_t)w * (size_t)h * 2);
    double *sum = calloc((size_t)w * (size_t)h * 3, sizeof *sum);
    uint8_t *rgb = malloc((size_t)w * (size_t)h * 3);
    if (!disparity || !sum || !rgb ||
        refocus_depth_to_disparity(depth->depth, disparity, 2 * (ptrdiff_t)w, &report))
        goto done;
    const double gf = report.value_far + focus * (report.value_near - report.value_far);
    for (int r = 0; r < 9; r++) {
        for (int c = 0; c < 9; c++) {
            struct refocus_photo *view = NULL;

            if (hypot(r - 4, c - 4) > radius + 1e-9)
                continue;
            snprintf(path, sizeof path, "%s/input_Cam%03d.png", argv[1], 9 * r + c);
            if (refocus_photo_read(&view, path, NULL, &reason) || view->image->width != w ||
                view->image->height != h) {
                fail(path, &reason);
                refocus_photo_free(&view);
                goto done;
            }
            add_view(view->image, -gf * (c - 4), -gf * (r - 4), light, sum);
            views++;
            if (r == 4 && c == 4)
                centre = view;
            else
                refocus_photo_free(&view);
        }
    }
    for (size_t i = 0; i < 3 * (size_t)w * (size_t)h; i++)
        rgb[i] = to_code(sum[i] / views);
    const struct refocus_image truth =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, w, h, 3 * (ptrdiff_t)w);
    snprintf(path, sizeof path, "%s/truth.png", argv[2]);
    if (refocus_image_write(path, &truth, NULL, &reason)) {
        fail(path, &reason);
        goto done;
    }
    snprintf(path, sizeof path, "%s/photo.png", argv[2]);
    if (!centre || refocus_image_write(path, centre->image, NULL, &reason)) {
        fail(path, &reason);
        goto done;
    }
    snprintf(path, sizeof path, "%s/disparity.png", argv[2]);
    if (refocus_gray16_write(path, disparity, w, h, 2 * (ptrdiff_t)w, &reason)) {
        fail(path, &reason);
        goto done;
    }
    printf("%.6g %.6g %d\n", radius * (report.value_near - report.value_far), focus, views);
    status = 0;
done:
    free(disparity);
    free(sum);
    free(rgb);
    refocus_photo_free(&centre);
    refocus_photo_free(&depth);
    return status;
}
