/* test_discs.c: bokeh against the path tracer's: discs of highlights as bright as behind a real
 * lens, six blades scored as well as the round aperture.
 *
 *     test-discs SCENES    the folder of the reference scenes
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <refocus/refocus.h>

#include "png_io.h"

enum { K = 20, MOST_HIGHLIGHTS = 400 };

struct view {
    int width, height;
    uint8_t *photo, *reference, *out;
    uint16_t *disparity;
    double df;
};

static void *read_in(const char *scenes, const char *scene, const char *file, int channels,
                     struct view *view)
{
    char path[1200];
    void *picture;

    snprintf(path, sizeof path, "%s/%s/%s", scenes, scene, file);
    picture = png_io_read(path, channels, &view->width, &view->height);
    if (!picture)
        exit(1);
    return picture;
}

static struct view view_read(const char *scenes, const char *scene, const char *reference,
                             double df)
{
    struct view view = {.df = df};

    view.photo = read_in(scenes, scene, "allfocus.png", 3, &view);
    view.disparity = read_in(scenes, scene, "disparity.png", 1, &view);
    view.reference = read_in(scenes, scene, reference, 3, &view);
    view.out = malloc(3 * (size_t)view.width * (size_t)view.height);
    if (!view.out)
        exit(1);
    return view;
}

static void view_free(struct view *view)
{
    free(view->photo);
    free(view->disparity);
    free(view->reference);
    free(view->out);
}

/* Renders as --quality best does, with the light that highlights of the night scene have lost:
 * their edges, where one channel alone is clipped, get none of it. */
static void render(struct view *view, const struct refocus_aperture *aperture)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(view->width, view->height, K);
    struct refocus_settings params = refocus_settings_default((float)view->df, K);
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, view->photo, view->width, view->height, 3 * view->width);
    const struct refocus_image out = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, view->out, view->width, view->height, 3 * view->width);
    const struct refocus_disparity disparity =
        refocus_disparity16(view->disparity, view->width, view->height, 2 * view->width);
    struct refocus_renderer *renderer;

    params.render.rays = 128;
    params.highlights.gain = 10;
    params.render.aperture = aperture;
    if (refocus_renderer_create(&renderer, &limits) ||
        refocus_prepare(renderer, &photo, &disparity) ||
        refocus_render_settings(renderer, &params, &out))
        exit(1);
    refocus_renderer_destroy(&renderer);
}

static double psnr(const struct view *view)
{
    double sum = 0;
    int n = 0;

    for (int y = K; y < view->height - K; y++) {
        for (int i = 3 * (y * view->width + K); i < 3 * ((y + 1) * view->width - K); i++, n++) {
            const double e = view->out[i] - view->reference[i];

            sum += e * e;
        }
    }
    return 10 * log10(255.0 * 255 * n / sum);
}

static int six_blades(const char *scenes)
{
    static const struct {
        const char *scene, *round, *six;
        double df, corner;
    } views[] = {{"portrait", "gt_df0.689_K20.png", "gt_df0.689_K20_b6.png", 0.6886, 45},
                 {"tabletop", "gt_df0.347_K20.png", "gt_df0.347_K20_b6.png", 0.3470, 45},
                 {"fence", "gt_df0.243_K20.png", "gt_df0.243_K20_b6.png", 0.2432, 45},
                 {"nightlights", "gt_df0.294_K20.png", "gt_df0.294_K20_b6.png", 0.2937, 45}};
    int bad = 0;

    for (int i = 0; i < 4; i++) {
        struct refocus_aperture *aperture;
        double score[2];

        if (refocus_aperture_create_polygon(&aperture, 6, views[i].corner))
            exit(1);
        for (int six = 0; six < 2; six++) {
            struct view view =
                view_read(scenes, views[i].scene, six ? views[i].six : views[i].round, views[i].df);

            render(&view, six ? aperture : NULL);
            score[six] = psnr(&view);
            view_free(&view);
        }
        refocus_aperture_destroy(&aperture);
        printf("%s: six blades %.2f dB, round %.2f dB\n", views[i].scene, score[1], score[0]);
        bad += score[1] < score[0] - 0.3;
    }
    return bad;
}

static double light_of(uint8_t code)
{
    const double v = code / 255.0;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

struct highlight {
    double x, y;
    int pixels;
};

/* In two channels at least: where one alone is clipped no light is given back. */
static bool is_clipped(const uint8_t *p)
{
    return (p[0] == 255) + (p[1] == 255) + (p[2] == 255) >= 2;
}

/* Clipped pixels that touch, all of them marked as seen. */
static struct highlight flood(const struct view *view, uint8_t *seen, int *stack, int at)
{
    struct highlight highlight = {0, 0, 0};
    int count = 0;

    stack[count++] = at;
    seen[at] = 1;
    while (count > 0) {
        const int p = stack[--count], x = p % view->width, y = p / view->width;

        highlight.x += x;
        highlight.y += y;
        highlight.pixels++;
        for (int j = -1; j <= 1; j++) {
            for (int i = -1; i <= 1; i++) {
                const int q = p + j * view->width + i;

                if (x + i < 0 || y + j < 0 || x + i >= view->width || y + j >= view->height ||
                    seen[q] || !is_clipped(view->photo + 3 * q))
                    continue;
                seen[q] = 1;
                stack[count++] = q;
            }
        }
    }
    highlight.x /= highlight.pixels;
    highlight.y /= highlight.pixels;
    return highlight;
}

static int find_highlights(const struct view *view, struct highlight highlights[MOST_HIGHLIGHTS])
{
    const int pixels = view->width * view->height;
    uint8_t *seen = calloc((size_t)pixels, 1);
    int *stack = malloc((size_t)pixels * sizeof *stack), count = 0;

    if (!seen || !stack)
        exit(1);
    for (int i = 0; i < pixels && count < MOST_HIGHLIGHTS; i++)
        if (!seen[i] && is_clipped(view->photo + 3 * i))
            highlights[count++] = flood(view, seen, stack, i);
    free(seen);
    free(stack);
    return count;
}

/* Adds the light in the inner 0.6 of a highlight's disc, ours and the reference's; false: the
 * reference is clipped itself. */
static bool add_disc(const struct view *view, const struct highlight *highlight, double radius,
                     double sum[2])
{
    double own[2] = {0, 0};
    int n = 0, clipped = 0;

    for (int y = 0; y < view->height; y++) {
        for (int x = 0; x < view->width; x++) {
            const int i = 3 * (y * view->width + x);

            if (hypot(x - highlight->x, y - highlight->y) > 0.6 * radius)
                continue;
            n++;
            clipped += view->reference[i] > 253 || view->reference[i + 1] > 253 ||
                       view->reference[i + 2] > 253;
            for (int c = 0; c < 3; c++) {
                own[0] += light_of(view->out[i + c]);
                own[1] += light_of(view->reference[i + c]);
            }
        }
    }
    if (20 * clipped > n)
        return false;
    sum[0] += own[0];
    sum[1] += own[1];
    return true;
}

static int disc_brightness(const char *scenes)
{
    struct view view = view_read(scenes, "nightlights", "gt_df0.966_K20.png", 0.96635);
    static struct highlight highlights[MOST_HIGHLIGHTS];
    const int count = find_highlights(&view, highlights);
    double sum[2] = {0, 0};
    int measured = 0;

    render(&view, NULL);
    for (int i = 0; i < count; i++) {
        const struct highlight *highlight = &highlights[i];
        const int at = (int)(highlight->y + 0.5) * view.width + (int)(highlight->x + 0.5);
        const double radius = K * fabs(view.disparity[at] / 65535.0 - view.df);

        if (highlight->pixels >= 10 && highlight->pixels <= 130 && radius >= 4)
            measured += add_disc(&view, highlight, radius, sum);
    }
    view_free(&view);
    printf("nightlights: %d discs, %.3f of the reference's light\n", measured, sum[0] / sum[1]);
    return measured < 20 || fabs(sum[0] / sum[1] - 1) > 0.05;
}

int main(int argc, char **argv)
{
    int bad;

    if (argc != 2)
        return 2;
    bad = disc_brightness(argv[1]);
    bad += six_blades(argv[1]);
    return bad > 0;
}
