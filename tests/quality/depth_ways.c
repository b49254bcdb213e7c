/* depth_ways.c: ways to bring coarse depth to the size of a photo, simple ones beside the
 * library's. */
#include "depth_ways.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#ifdef RF_HAVE_OPENCV
#include <refocus/platform/opencv.h>
#endif

static double sample(const struct depth_coarse *c, int x, int y)
{
    x = x < 0 ? 0 : x >= c->width ? c->width - 1 : x;
    y = y < 0 ? 0 : y >= c->height ? c->height - 1 : y;
    return c->disparity[(size_t)y * (size_t)c->width + (size_t)x];
}

static int exact(const struct quality_scene *scene, const struct depth_coarse *coarse,
                 uint16_t *out)
{
    (void)coarse;
    memcpy(out, scene->disparity, (size_t)scene->width * (size_t)scene->height * sizeof *out);
    return 0;
}

static int nearest(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    for (int y = 0; y < scene->height; y++)
        for (int x = 0; x < scene->width; x++)
            *out++ = (uint16_t)sample(c, (2 * x + 1) * c->width / (2 * scene->width),
                                      (2 * y + 1) * c->height / (2 * scene->height));
    return 0;
}

static int bilinear(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    for (int y = 0; y < scene->height; y++) {
        const double v = (y + 0.5) * c->height / scene->height - 0.5, fy = v - floor(v);

        for (int x = 0; x < scene->width; x++) {
            const double u = (x + 0.5) * c->width / scene->width - 0.5, fx = u - floor(u);
            const int i = (int)floor(u), j = (int)floor(v);

            *out++ = (uint16_t)lrint(
                (1 - fy) * ((1 - fx) * sample(c, i, j) + fx * sample(c, i + 1, j)) +
                fy * ((1 - fx) * sample(c, i, j + 1) + fx * sample(c, i + 1, j + 1)));
        }
    }
    return 0;
}

/* Joint bilateral: the mean over 5 x 5 samples by nearness and likeness (Kopf et al. 2007). */
static int joint_bilateral(const struct quality_scene *scene, const struct depth_coarse *c,
                           uint16_t *out)
{
    const int w = scene->width, h = scene->height;

    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            const double u = (x + 0.5) * c->width / w - 0.5, v = (y + 0.5) * c->height / h - 0.5;
            const uint8_t *p = scene->photo + 3 * ((size_t)y * (size_t)w + (size_t)x);
            double sum = 0, total = 0;

            for (int j = (int)floor(v) - 2; j <= (int)floor(v) + 2; j++) {
                for (int i = (int)floor(u) - 2; i <= (int)floor(u) + 2; i++) {
                    const int ci = i < 0 ? 0 : i >= c->width ? c->width - 1 : i;
                    const int cj = j < 0 ? 0 : j >= c->height ? c->height - 1 : j;
                    const uint8_t *q =
                        scene->photo +
                        3 * ((size_t)((2 * cj + 1) * h / (2 * c->height)) * (size_t)w +
                             (size_t)((2 * ci + 1) * w / (2 * c->width)));
                    double apart = 0, weight;

                    for (int k = 0; k < 3; k++)
                        apart += (p[k] - q[k]) * (p[k] - q[k]);
                    weight = exp(-((u - i) * (u - i) + (v - j) * (v - j)) / 2 -
                                 apart / (2 * 0.1 * 0.1 * 255 * 255)) +
                             1e-12;
                    total += weight;
                    sum += weight * sample(c, ci, cj);
                }
            }
            *out++ = (uint16_t)lrint(sum / total);
        }
    }
    return 0;
}

static int upsample(const struct quality_scene *scene, const struct depth_coarse *c,
                    const uint8_t *confidence, uint16_t *out)
{
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const struct refocus_disparity map =
        refocus_disparity16(c->disparity, c->width, c->height, 2 * c->width);
    struct refocus_upsample_params params = refocus_upsample_params_default();

    params.confidence = confidence;
    params.confidence_stride = c->width;
    return refocus_upsample(&photo, &map, &params, out, 2 * (ptrdiff_t)scene->width);
}

static int cluster(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    return upsample(scene, c, NULL, out);
}

static int trusting(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    return upsample(scene, c, c->confidence, out);
}

#ifdef RF_HAVE_OPENCV
int depth_by_opencv(uint32_t filter, const struct quality_scene *scene,
                    const struct depth_coarse *c, uint16_t *out)
{
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene->photo, scene->width, scene->height, 3 * scene->width);
    const struct refocus_disparity map =
        refocus_disparity16(c->disparity, c->width, c->height, 2 * c->width);

    return refocus_cv_upsample_by(filter, &photo, &map, out, NULL);
}

static int cv_bilinear(const struct quality_scene *scene, const struct depth_coarse *c,
                       uint16_t *out)
{
    return depth_by_opencv(REFOCUS_CV_BILINEAR, scene, c, out);
}

static int cv_joint(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    return depth_by_opencv(REFOCUS_CV_JOINT_BILATERAL, scene, c, out);
}

static int cv_guided(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    return depth_by_opencv(REFOCUS_CV_GUIDED, scene, c, out);
}

static int cv_fast(const struct quality_scene *scene, const struct depth_coarse *c, uint16_t *out)
{
    return depth_by_opencv(REFOCUS_CV_FAST_GLOBAL, scene, c, out);
}

static int cv_joint_full(const struct quality_scene *scene, const struct depth_coarse *c,
                         uint16_t *out)
{
    return depth_by_opencv(REFOCUS_CV_JOINT_BILATERAL_FULL, scene, c, out);
}
#endif

const struct depth_way depth_ways[] = {
    {"exact disparity", exact, IN_SCENES},
    {"nearest", nearest, IN_SCENES | IN_TRUTH},
    {"bilinear", bilinear, IN_SCENES | IN_TRUTH},
    {"joint bilateral mean", joint_bilateral, IN_SCENES | IN_TRUTH},
#ifdef RF_HAVE_OPENCV
    {"OpenCV bilinear", cv_bilinear, IN_SCENES},
    {"OpenCV joint bilateral", cv_joint, IN_SCENES},
    {"OpenCV guided", cv_guided, IN_SCENES},
    {"OpenCV fast global smoother", cv_fast, IN_SCENES},
    {"OpenCV joint bilateral, full size", cv_joint_full, IN_SCENES},
#endif
    {"refocus_upsample, holes filled", cluster, IN_SCENES | IN_TRUTH},
    {"refocus_upsample, holes as confidence", trusting, IN_SCENES | IN_TRUTH},
    {NULL, NULL, 0},
};
