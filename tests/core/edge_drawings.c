/* edge_drawings.c: draws scenes of surfaces with known disparities, and makes their maps worse. */
#include "edge_drawings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t random_state;

uint32_t random_bits(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return random_state >> 8;
}

bool in_disc(double x, double y, double radius)
{
    return hypot(x - 110, y - 90) < radius;
}

struct seen disc(double x, double y)
{
    return in_disc(x, y, 50) ? (struct seen){0.8, 1} : (struct seen){0.2, 0};
}

/* The wire is two pixels wide. */
bool on_wire(double x, double y)
{
    (void)y;
    return fabs(x - 200) < 1;
}

struct seen disc_and_wire(double x, double y)
{
    return on_wire(x, y) ? (struct seen){0.7, 2} : disc(x, y);
}

/* A table before a wall that come nearer in different directions. */
struct seen planes(double x, double y)
{
    return y > 70 + 0.3 * x ? (struct seen){0.5 + 0.002 * (y - 70) + 0.0005 * x, 1}
                            : (struct seen){0.1 + 0.001 * x, 0};
}

/* Nearly upright at its silhouette. */
struct seen sphere(double x, double y)
{
    const double off = hypot(x - 110, y - 90) / 60;

    return off < 1 ? (struct seen){0.5 + 0.4 * sqrt(1 - off * off), 1} : (struct seen){0.15, 0};
}

struct seen paraboloid(double x, double y)
{
    const double off = hypot(x - 110, y - 90) / 60;

    return off < 1 ? (struct seen){0.9 - 0.3 * off * off, 1} : (struct seen){0.1 + 0.0004 * y, 0};
}

/* Steps of 0.01 to 0.2: of some it is hard to say whether they are edges. */
struct seen stairs(double x, double y)
{
    static const double height[] = {0.1, 0.11, 0.14, 0.2, 0.3, 0.45, 0.65, 0.85};
    const int step = (int)(x / 30);

    (void)y;
    return (struct seen){height[step], step % 4};
}

struct picture make(int width, int height)
{
    const size_t pixels = (size_t)width * (size_t)height;
    struct picture p = {width,
                        height,
                        malloc(3 * pixels),
                        malloc(2 * pixels),
                        malloc(2 * pixels),
                        malloc(2 * pixels)};

    assert_true(p.rgb && p.exact && p.map && p.out);
    return p;
}

void end(struct picture *p)
{
    free(p->rgb);
    free(p->exact);
    free(p->map);
    free(p->out);
}

/* Surfaces of different colours, all with a texture of spots and noise. */
void paint(uint8_t *pixel, int surface, int x, int y)
{
    static const uint8_t colour[4][3] = {
        {70, 100, 60}, {190, 150, 110}, {60, 50, 150}, {220, 215, 90}};
    const int spot = (x / 7 * 5 + y / 6 * 3) % 4 * 6 - 9;

    for (int c = 0; c < 3; c++)
        pixel[c] = (uint8_t)(colour[surface][c] + spot + (int)(random_bits() % 17) - 8);
}

/* Disparities are multiplied by `contrast`. */
void draw(struct picture *p, scene_fn *scene, double contrast)
{
    random_state = 11;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const int at = y * p->width + x;
            const struct seen seen = scene(x + 0.5, y + 0.5);

            p->exact[at] = (uint16_t)lrint(65535 * contrast * seen.disparity);
            paint(p->rgb + (ptrdiff_t)3 * at, seen.surface, x, y);
        }
    memcpy(p->map, p->exact, (size_t)p->width * (size_t)p->height * 2);
}

/* The map becomes that of the scene moved by (right, down). */
void displace(struct picture *p, scene_fn *scene, double right, double down)
{
    for (int i = 0; i < p->width * p->height; i++)
        p->map[i] = (uint16_t)lrint(
            65535 * scene(i % p->width + 0.5 - right, i / p->width + 0.5 - down).disparity);
}

static int inside(int i, int n)
{
    return i < 0 ? 0 : i < n ? i : n - 1;
}

/* A Gaussian, along rows or along columns. */
static void blur_lines(double *out, const double *in, int width, int height, double sigma, int down)
{
    const int reach = (int)(4 * sigma + 1);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0, weights = 0;

            for (int k = -reach; k <= reach; k++) {
                const double weight = exp(-k * k / (2 * sigma * sigma));
                const int u = inside(x + (down ? 0 : k), width);
                const int v = inside(y + (down ? k : 0), height);

                sum += weight * in[v * width + u];
                weights += weight;
            }
            out[y * width + x] = sum / weights;
        }
}

/* Blurs the map; overshoot > 0: and then sharpens it in part, as networks and cameras do. */
void soften(struct picture *p, double sigma, double overshoot)
{
    const int n = p->width * p->height;
    double *map = calloc((size_t)n, sizeof *map), *rows = malloc((size_t)n * sizeof *rows);
    double *soft = malloc((size_t)n * sizeof *soft);

    assert_true(map && rows && soft);
    for (int i = 0; i < n; i++)
        map[i] = p->map[i];
    blur_lines(rows, map, p->width, p->height, sigma, 0);
    blur_lines(soft, rows, p->width, p->height, sigma, 1);
    memcpy(map, soft, (size_t)n * sizeof *map);
    if (overshoot > 0) {
        blur_lines(rows, soft, p->width, p->height, sigma, 0);
        blur_lines(map, rows, p->width, p->height, sigma, 1);
    }
    for (int i = 0; i < n; i++) {
        const double value = soft[i] + overshoot * (soft[i] - map[i]);

        p->map[i] = (uint16_t)lrint(fmin(fmax(value, 0), 65535));
    }
    free(map);
    free(rows);
    free(soft);
}

struct refocus_image photo_of(const struct picture *p)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, p->rgb, p->width, p->height, 3 * p->width);
}

/* The map of the photo's size to p->out; the report. */
struct refocus_depth_edges_report place(const struct picture *p)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const struct refocus_image photo = photo_of(p);
    const struct refocus_disparity map =
        refocus_disparity16(p->map, p->width, p->height, 2 * (ptrdiff_t)p->width);
    struct refocus_depth_edges_report report = refocus_depth_edges_report_default();

    assert_int_equal(
        refocus_depth_edges(&photo, &map, &params, p->out, 2 * (ptrdiff_t)p->width, &report),
        REFOCUS_OK);
    return report;
}

/* The share of pixels whose disparity is within `off` of the exact one. */
double share_within(const struct picture *p, const uint16_t *map, double off)
{
    const int n = p->width * p->height;
    int good = 0;

    for (int i = 0; i < n; i++)
        good += abs(map[i] - p->exact[i]) <= 65535 * off;
    return (double)good / n;
}

void assert_same(const struct picture *p, const uint16_t *should, const char *what, int number)
{
    for (int i = 0; i < p->width * p->height; i++)
        if (p->out[i] != should[i])
            fail_msg("%s %d: pixel %d, %d is %d, should be %d", what, number, i % p->width,
                     i / p->width, p->out[i], should[i]);
}
