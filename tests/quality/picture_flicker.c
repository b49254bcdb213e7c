/* picture_flicker.c: refocus-picture-flicker SCENE...: how much pictures flicker beside the edges
 * of a depth that a sensor sees anew in each frame.
 *
 * Videos of 30 frames are made of reference scenes, and stand, or pan by 2 or 3 pixels a frame. The
 * sensor has 150x120 samples for 600x480 pixels, 1 % noise, 3 % holes, and flying pixels: of the
 * samples beside an edge half lie at any distance between both surfaces, others in each frame. The
 * photo is rendered without noise, so that all that flickers is the depth's; the filter sees it
 * with noise of 1.5 codes. Prints a table in Markdown; tests/depth.md holds it. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "scene.h"

enum {
    W = 150,
    H = 120,
    STEP = 4,
    WIDTH = W * STEP,
    HEIGHT = H * STEP,
    FRAMES = 30,
    FROM = 16,
    NEAR_EDGE = 6 /* pixels */
};

static uint32_t seed;

static double uniform(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
}

static double noise(void)
{
    double sum = -6;

    for (int i = 0; i < 12; i++)
        sum += uniform();
    return sum;
}

/* Sums over frames of each pixel of the scene. */
static float sum[HEIGHT][WIDTH], squares[HEIGHT][WIDTH];
static uint8_t photo[HEIGHT][3 * WIDTH], noisy[HEIGHT][3 * WIDTH], out[HEIGHT][3 * WIDTH];
static uint16_t truth[HEIGHT][WIDTH], mm[H][W], disparity[H][W];
static bool edge[HEIGHT][WIDTH];

static void take_photo(const struct quality_scene *s, int from)
{
    for (int y = 0; y < HEIGHT; y++) {
        const size_t row = (size_t)y * (size_t)s->width + (size_t)from;

        memcpy(photo[y], s->photo + 3 * row, sizeof photo[y]);
        memcpy(truth[y], s->disparity + row, sizeof truth[y]);
        for (int i = 0; i < 3 * WIDTH; i++) {
            const double code = photo[y][i] + 1.5 * noise();

            noisy[y][i] = (uint8_t)lrint(fmin(fmax(code, 0), 255));
        }
    }
}

static double metres_at(const struct quality_scene *s, int x, int y)
{
    const struct refocus_depth_range range = {s->near_m, s->far_m};

    return refocus_depth_of_disparity(&range, truth[y][x] / 65535.0);
}

static void sense(const struct quality_scene *s)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int px = x * STEP + STEP / 2, py = y * STEP + STEP / 2;
            double z = metres_at(s, px, py), least = z, most = z;

            for (int j = -STEP / 2; j < STEP / 2; j++)
                for (int i = -STEP / 2; i < STEP / 2; i++) {
                    const double other = metres_at(s, px + i, py + j);

                    least = fmin(least, other);
                    most = fmax(most, other);
                }
            if (most > 1.05 * least && uniform() < 0.5)
                z = least + uniform() * (fmin(most, 60) - least);
            z = fmin(z, 60) * (1 + 0.01 * noise());
            mm[y][x] = (uint16_t)(uniform() < 0.03 ? 0 : fmin(z * 1000, 65535));
        }
}

/* Marks pixels beside a step of 1/20 of the range. */
static void find_edges(void)
{
    memset(edge, 0, sizeof edge);
    for (int y = 0; y < HEIGHT - 1; y++)
        for (int x = 0; x < WIDTH - 1; x++)
            if (abs(truth[y][x] - truth[y][x + 1]) > 65535 / 20 ||
                abs(truth[y][x] - truth[y + 1][x]) > 65535 / 20)
                for (int j = -NEAR_EDGE; j <= NEAR_EDGE; j++)
                    for (int i = -NEAR_EDGE; i <= NEAR_EDGE; i++)
                        if (y + j >= 0 && y + j < HEIGHT && x + i >= 0 && x + i < WIDTH)
                            edge[y + j][x + i] = true;
}

/* Pixels of the scene that are in all frames that count, away from the border. */
static void add_up(int moved)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const uint8_t *const p = out[y] + 3 * x;
            const int at = x + moved;
            const float v = 0.25f * (float)(p[0] + 2 * p[1] + p[2]);

            if (at < WIDTH) {
                sum[y][at] += v;
                squares[y][at] += v * v;
            }
        }
}

/* The mean over pixels beside edges of the standard deviation over frames. */
static double flicker(int pan)
{
    const int n = FRAMES - FROM;
    double total = 0;
    long count = 0;

    for (int y = 20; y < HEIGHT - 20; y++)
        for (int x = 20 + (n - 1) * pan; x < WIDTH - 20; x++)
            if (edge[y][x]) {
                const double mean = sum[y][x] / n;

                total += sqrt(fmax(0, squares[y][x] / n - mean * mean));
                count++;
            }
    return count ? total / count : 0;
}

static int play(const struct quality_scene *s, int pan, bool filtered, double *result)
{
    const struct quality_view *view = &s->view[0];
    const struct refocus_temporal_params calm = refocus_temporal_params_default(W, H);
    struct refocus_renderer_params params =
        refocus_renderer_params_default(WIDTH, HEIGHT, (float)view->blur);
    struct refocus_settings settings =
        refocus_settings_default((float)view->focus, (float)view->blur);
    struct refocus_renderer *renderer;
    struct refocus_temporal *filter;
    int status = refocus_temporal_create(&filter, &calm);

    seed = 1;
    memset(sum, 0, sizeof sum);
    memset(squares, 0, sizeof squares);
    settings.highlights.steady = 0.8f;
    status = status ? status : refocus_renderer_create(&renderer, &params);
    for (int t = 0; t < FRAMES && !status; t++) {
        struct refocus_depth_map map = refocus_depth_map_default();
        const struct refocus_image in =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, photo, WIDTH, HEIGHT, 3 * WIDTH);
        const struct refocus_image seen =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, noisy, WIDTH, HEIGHT, 3 * WIDTH);
        const struct refocus_image to =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, out, WIDTH, HEIGHT, 3 * WIDTH);
        const struct refocus_disparity d = refocus_disparity16(disparity[0], W, H, 2 * W);

        map.samples = mm;
        map.width = W;
        map.height = H;
        map.stride = 2 * W;
        map.sample = REFOCUS_SAMPLE_U16;
        map.meaning = REFOCUS_DEPTH_DISTANCE;
        map.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
        map.metres_per_unit = 0.001;
        map.near_m = s->near_m;
        map.far_m = s->far_m;
        take_photo(s, pan * t);
        if (t == FROM)
            find_edges();
        sense(s);
        status = refocus_depth_to_disparity(&map, disparity[0], 2 * W, NULL);
        if (!status && filtered)
            status = refocus_temporal_run(filter, &seen, &d, disparity[0], 2 * W);
        if (!status)
            status = refocus_prepare(renderer, &in, &d);
        if (!status)
            status = refocus_render_settings(renderer, &settings, &to);
        if (t >= FROM)
            add_up(pan * (t - FROM));
    }
    *result = flicker(pan);
    refocus_renderer_destroy(&renderer);
    refocus_temporal_destroy(&filter);
    return status;
}

int main(int argc, char **argv)
{
    static const int pans[] = {0, 2, 3};
    int status = 0;

    puts("| scene | pan, pixels a frame | as it comes | filtered |\n"
         "| --- | --: | --: | --: |");
    for (int i = 1; i < argc && !status; i++) {
        struct quality_scene scene;

        status = quality_scene_read(&scene, argv[i]);
        for (int k = 0; k < 3 && !status; k++) {
            double raw, calm;

            status = play(&scene, pans[k], false, &raw);
            status = status ? status : play(&scene, pans[k], true, &calm);
            if (!status)
                printf("| %s | %d | %.2f | %.2f |\n", scene.name, pans[k], raw, calm);
        }
        if (!status)
            quality_scene_free(&scene);
    }
    return status ? 1 : 0;
}
