/* ximgproc.cpp: the filters of OpenCV contrib. They come with 144 shared libraries, so this is a
 * module of its own, which is loaded when it is asked for (platform/opencv/module.cpp). */
#include "ximgproc.h"

#include <cmath>
#include <exception>

#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc.hpp>
#include <opencv2/ximgproc/disparity_filter.hpp>
#include <refocus/platform/opencv.h>

namespace
{

void smooth(uint32_t filter, const cv::Mat &photo, cv::Mat &depth, int reach)
{
    cv::Mat out, guide;

    switch (filter) {
    case REFOCUS_CV_GUIDED:
        cv::ximgproc::guidedFilter(photo, depth, out, reach, 0.02 * 255 * 0.02 * 255);
        break;
    case REFOCUS_CV_FAST_GLOBAL:
        cv::ximgproc::fastGlobalSmootherFilter(photo, depth, out, reach * (double)reach, 12);
        break;
    default:
        photo.convertTo(guide, CV_32F, 1 / 255.0);
        cv::ximgproc::jointBilateralFilter(guide, depth, out, 2 * reach + 1, 0.1, reach);
    }
    out.copyTo(depth);
}

int try_smooth(uint32_t filter, const uint8_t *rgb, float *depth, int width, int height, int reach)
{
    try {
        const cv::Mat photo(height, width, CV_8UC3, const_cast<uint8_t *>(rgb));
        cv::Mat map(height, width, CV_32F, depth);

        smooth(filter, photo, map, reach);
        return 0;
    } catch (...) {
        return -1;
    }
}

/* Disparities as SGBM gives them: 1/16 pixel, what is unknown a pixel below all others. The filter
 * takes confidence from how much they vary: much farther below, and few would be left around. */
cv::Mat fixed(const float *d, int width, int height)
{
    cv::Mat out(height, width, CV_16S);
    float least = 0;

    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        least = d[i] < least ? d[i] : least;

    const short unknown = cv::saturate_cast<short>(least * 16 - 16);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float v = d[(size_t)y * (size_t)width + (size_t)x];

            out.at<short>(y, x) = std::isnan(v) ? unknown : cv::saturate_cast<short>(v * 16);
        }
    return out;
}

int try_wls(const uint8_t *rgb, const float *left, const float *right, float *out, int width,
            int height)
{
    try {
        const cv::Mat photo(height, width, CV_8UC3, const_cast<uint8_t *>(rgb));
        const auto filter = cv::ximgproc::createDisparityWLSFilterGeneric(true);
        cv::Mat result, back = fixed(right, width, height), map(height, width, CV_32F, out);

        back = -back; /* disparities of the right picture are negative there */
        filter->setLambda(8000);
        filter->setSigmaColor(1.2);
        filter->setLRCthresh(24);
        filter->setDepthDiscontinuityRadius(3);
        filter->filter(fixed(left, width, height), photo, result, back,
                       cv::Rect(0, 0, width, height));
        result.convertTo(map, CV_32F, 1 / 16.0);
        return 0;
    } catch (...) {
        return -1;
    }
}

} // namespace

extern "C" __attribute__((visibility("default")))
const rf_ximgproc rf_ximgproc_filters = {RF_XIMGPROC_VERSION, try_smooth, try_wls};
