/* upsample.cpp: a small map is brought to the photo's size by a filter of OpenCV's parts. */
#include "guard.hpp"
#include "joint_bilateral.hpp"
#include "module.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace
{

int bilinear(const refocus_image *photo, const refocus_disparity *map, cv::Mat &depth)
{
    const cv::Mat samples(map->height, map->width, map->bits == 16 ? CV_16U : CV_8U,
                          const_cast<void *>(map->samples), (size_t)map->stride);
    cv::Mat coarse;

    samples.convertTo(coarse, CV_32F, map->bits == 16 ? 1 / 65535.0 : 1 / 255.0);
    cv::resize(coarse, depth, cv::Size(photo->width, photo->height), 0, 0, cv::INTER_LINEAR);
    return REFOCUS_OK;
}

int upsample_by(uint32_t filter, const refocus_image *photo, const refocus_disparity *map,
                uint16_t *out, refocus_cv_reason *reason)
{
    const rf_ximgproc *const contrib = filter >= REFOCUS_CV_GUIDED ? rf_opencv_ximgproc() : nullptr;
    const int reach = std::max(1, cvRound(photo->width / (double)map->width));
    cv::Mat depth, packed = refocus_cv::view(photo);

    if (filter >= REFOCUS_CV_GUIDED && !contrib)
        return refocus_cv::fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                "the module refocus-ximgproc.so is not there; build it with "
                                "-Dximgproc=enabled, or use another filter");
    bilinear(photo, map, depth);
    if (!packed.isContinuous())
        packed = packed.clone();
    if (contrib &&
        contrib->smooth(filter, packed.data, depth.ptr<float>(), depth.cols, depth.rows, 2 * reach))
        return refocus_cv::fail(reason, REFOCUS_ERR_UNSUPPORTED, "OpenCV gave up");
    depth.convertTo(cv::Mat(depth.size(), CV_16U, out), CV_16U, 65535);
    return REFOCUS_OK;
}

/* Whether both are of known sizes of struct; then the pointers point at copies. */
bool take(const refocus_image *&photo, const refocus_disparity *&map, refocus_image &own_photo,
          refocus_disparity &own_map)
{
    if (refocus_image_read(&own_photo, photo) || refocus_disparity_read(&own_map, map))
        return false;
    photo = &own_photo;
    map = &own_map;
    return true;
}

bool good(const refocus_image *photo, const refocus_disparity *map, const uint16_t *out)
{
    return refocus_cv::good_photo(photo) && map && map->samples && map->width >= 1 &&
           map->height >= 1 && map->width <= REFOCUS_MAX_SIDE && map->height <= REFOCUS_MAX_SIDE &&
           (map->bits == 8 || map->bits == 16) &&
           refocus_cv::good_rows(map->stride, (ptrdiff_t)map->width * (ptrdiff_t)(map->bits / 8),
                                 map->height) &&
           out;
}

const char *const names[] = {"bilinear", "joint-bilateral", "guided", "fast-global",
                             "joint-bilateral-full"};
enum { FILTERS = sizeof names / sizeof *names };

} // namespace

const char *refocus_cv_filter_name(uint32_t filter)
{
    return filter < FILTERS ? names[filter] : nullptr;
}

int refocus_cv_upsample_by(uint32_t filter, const struct refocus_image *photo,
                           const struct refocus_disparity *map, uint16_t *out,
                           struct refocus_cv_reason *reason)
{
    struct refocus_image own_photo;
    struct refocus_disparity own_map;

    if (filter >= FILTERS || !take(photo, map, own_photo, own_map) || !good(photo, map, out))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no photo, no map, or no filter");
    if (filter == REFOCUS_CV_JOINT_BILATERAL)
        return refocus_cv_upsample(photo, map, 25.5f, out, reason);
    return refocus_cv::guarded(reason, REFOCUS_ERR_UNSUPPORTED,
                               [&] { return upsample_by(filter, photo, map, out, reason); });
}

int refocus_cv_upsample(const struct refocus_image *photo, const struct refocus_disparity *map,
                        float sigma_range, uint16_t *out, struct refocus_cv_reason *reason)
{
    struct refocus_image own_photo;
    struct refocus_disparity own_map;

    if (!take(photo, map, own_photo, own_map) || !good(photo, map, out) || !(sigma_range > 0))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no photo, or no map");
    return refocus_cv::guarded(reason, REFOCUS_ERR_UNSUPPORTED, [&] {
        refocus_cv::joint_bilateral(*photo, *map, sigma_range, out);
        return REFOCUS_OK;
    });
}
