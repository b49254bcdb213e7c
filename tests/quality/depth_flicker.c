/* depth_flicker.c: refocus-depth-flicker: how much the depth of a video flickers, as it comes
 * and filtered.
 *
 *     refocus-depth-flicker MAP.png...           maps of a video, in order
 *     refocus-depth-flicker --scenes FOLDER...   videos made of reference scenes
 *
 * A video of a scene has 1 % noise and 3 % holes in each map of 160x120 samples, and stands, or
 * pans by one sample a frame. Prints a table in Markdown; tests/depth.md holds it. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "png_io.h"
#include "scene.h"

enum { FRAMES = 20, FROM = 5 /* frames that the filter may take to settle */ };

/* Sums over frames and samples. */
struct flicker {
    double change; /* |d - last d where it was| */
    double error;  /* |d - truth| */
    long flips;    /* changes by more than 1/24 of the range that the truth does not make */
    long ghosts;   /* errors of more than 1/12 */
    long samples;
};

static uint32_t seed = 1;

static double noise(void)
{
    double sum = -6;

    for (int i = 0; i < 12; i++) {
        seed = seed * 1664525u + 1013904223u;
        sum += (seed >> 8) / 16777216.0;
    }
    return sum;
}

static void count(struct flicker *f, const uint16_t *d, const uint16_t *last, const uint16_t *truth,
                  const uint16_t *last_truth, int w, int h, int moved)
{
    for (int y = 0; y < h; y++) {
        for (int x = 0; x + moved < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x, q = i + (size_t)moved;
            const int change = abs(d[i] - last[q]);

            f->change += change / 65535.0;
            f->samples++;
            if (!truth) {
                f->flips += change > 65535 / 24;
                continue;
            }
            f->flips += change > 65535 / 24 + abs(truth[i] - last_truth[q]);
            f->error += abs(d[i] - truth[i]) / 65535.0;
            f->ghosts += abs(d[i] - truth[i]) > 65535 / 12;
        }
    }
}

static void print(const char *name, const char *way, const struct flicker *f)
{
    const double n = (double)f->samples;

    printf("| %s | %s | %.2f | %.2f | %.2f | %.2f |\n", name, way, 1000 * f->change / n,
           100.0 * (double)f->flips / n, 1000 * f->error / n, 100.0 * (double)f->ghosts / n);
}

/* Simulates a sensor that sees the window at x: noise of 1 % of the distance, holes as zeros. */
static void look(const struct quality_scene *s, int from, int w, int h, int step, uint16_t *truth,
                 uint16_t *mm, uint8_t *rgb)
{
    const struct refocus_depth_range range = {s->near_m, s->far_m};

    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const size_t at = (size_t)(y * step + step / 2) * (size_t)s->width +
                              (size_t)((x + from) * step + step / 2);
            double z;

            truth[y * w + x] = s->disparity[at];
            z = refocus_depth_of_disparity(&range, s->disparity[at] / 65535.0);
            z = z < 60 ? z : 60;
            seed = seed * 1664525u + 1013904223u;
            z *= 1 + 0.01 * noise();
            mm[y * w + x] = (uint16_t)((seed >> 8) % 100 < 3 ? 0
                                       : z * 1000 < 65535    ? z * 1000
                                                             : 65535);
        }
    }
    for (int y = 0; y < h * step; y++)
        memcpy(rgb + 3 * (size_t)(y * w * step),
               s->photo + 3 * ((size_t)y * (size_t)s->width + (size_t)(from * step)),
               3 * (size_t)(w * step));
}

static int play(const struct quality_scene *s, int moved, bool with_photo, struct flicker *raw,
                struct flicker *calm)
{
    enum { W = 150, H = 120, STEP = 4 };
    static uint16_t truth[2][W * H], mm[W * H], in[2][W * H], out[2][W * H];
    static uint8_t rgb[3 * W * H * STEP * STEP];
    const struct refocus_temporal_params params = refocus_temporal_params_default(W, H);
    struct refocus_temporal *filter;
    int status = refocus_temporal_create(&filter, &params);

    seed = 1;
    memset(raw, 0, sizeof *raw);
    memset(calm, 0, sizeof *calm);
    for (int t = 0; t < FRAMES && !status; t++) {
        struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                        .samples = mm,
                                        .width = W,
                                        .height = H,
                                        .stride = 2 * W,
                                        .sample = REFOCUS_SAMPLE_U16,
                                        .meaning = REFOCUS_DEPTH_DISTANCE,
                                        .flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN,
                                        .metres_per_unit = 0.001,
                                        .near_m = s->near_m,
                                        .far_m = s->far_m};
        const struct refocus_image photo =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, W * STEP, H * STEP, 3 * W * STEP);
        const struct refocus_disparity disparity = refocus_disparity16(in[t & 1], W, H, 2 * W);

        look(s, moved * t, W, H, STEP, truth[t & 1], mm, rgb);
        status = refocus_depth_to_disparity(&map, in[t & 1], 2 * W, NULL);
        if (!status)
            status = refocus_temporal_run(filter, with_photo ? &photo : NULL, &disparity,
                                          out[t & 1], 2 * W);
        if (t < FROM || status)
            continue;
        count(raw, in[t & 1], in[~t & 1], truth[t & 1], truth[~t & 1], W, H, moved);
        count(calm, out[t & 1], out[~t & 1], truth[t & 1], truth[~t & 1], W, H, moved);
    }
    refocus_temporal_destroy(&filter);
    return status;
}

static int play_scene(const char *folder)
{
    struct quality_scene scene;
    int status = quality_scene_read(&scene, folder);

    for (int moved = 0; moved < 2 && !status; moved++) {
        struct flicker raw, alone, calm;
        char name[300];

        snprintf(name, sizeof name, "%s, %s", scene.name, moved ? "panning" : "standing");
        status = play(&scene, moved, false, &raw, &alone);
        if (!status)
            status = play(&scene, moved, true, &raw, &calm);
        print(name, "as it comes", &raw);
        print(name, "filtered, by depth alone", &alone);
        print(name, "filtered, with the photo", &calm);
    }
    quality_scene_free(&scene);
    return status;
}

static int play_maps(char **path, int n)
{
    uint16_t *in[2] = {NULL, NULL}, *out[2] = {NULL, NULL};
    struct refocus_temporal *filter = NULL;
    struct flicker raw = {0}, calm = {0};
    int width = 0, height = 0, status = 0;

    for (int t = 0; t < n && !status; t++) {
        struct refocus_disparity map;
        int w, h;

        free(in[t & 1]);
        in[t & 1] = png_io_read(path[t], 1, &w, &h);
        status = !in[t & 1] || (t && (w != width || h != height));
        width = w;
        height = h;
        if (!status && t == 0) {
            const struct refocus_temporal_params params = refocus_temporal_params_default(w, h);

            for (int i = 0; i < 2; i++)
                out[i] = malloc((size_t)w * (size_t)h * 2);
            status = !out[0] || !out[1] || refocus_temporal_create(&filter, &params);
        }
        if (status)
            break;
        map = refocus_disparity16(in[t & 1], w, h, 2 * (ptrdiff_t)w);
        status = refocus_temporal_run(filter, NULL, &map, out[t & 1], 2 * (ptrdiff_t)w);
        if (t) {
            count(&raw, in[t & 1], in[~t & 1], NULL, NULL, w, h, 0);
            count(&calm, out[t & 1], out[~t & 1], NULL, NULL, w, h, 0);
        }
    }
    if (!status) {
        print("maps", "as they come", &raw);
        print("maps", "filtered, by depth alone", &calm);
    }
    refocus_temporal_destroy(&filter);
    for (int i = 0; i < 2; i++) {
        free(in[i]);
        free(out[i]);
    }
    return status;
}

int main(int argc, char **argv)
{
    const bool scenes = argc > 2 && !strcmp(argv[1], "--scenes");
    int status = 0;

    if (argc < 3) {
        fputs("usage: refocus-depth-flicker MAP.png MAP.png... | --scenes FOLDER...\n", stderr);
        return 2;
    }
    puts("| video | depth | change a frame, 1/1000 | flips, % | error, 1/1000 | off by more than "
         "1/12, % |\n| --- | --- | --: | --: | --: | --: |");
    if (!scenes)
        return play_maps(argv + 1, argc - 1) ? 1 : 0;
    for (int i = 2; i < argc && !status; i++)
        status = play_scene(argv[i]);
    return status ? 1 : 0;
}
