/** @file platform/opencv.hpp  cv::Mat as pictures and maps of the library, without copies.
 *
 *     cv::Mat out = refocus::render(photo, disparity, 0.8f, 20);
 *
 * Header only, C++11; needs the headers of OpenCV 3 or later and its module core, and nothing of
 * librefocus-opencv. What is made of a cv::Mat refers to its memory, which the caller keeps. Any
 * cv::Mat of two dimensions will do, parts of others too.
 */
#ifndef REFOCUS_PLATFORM_OPENCV_HPP
#define REFOCUS_PLATFORM_OPENCV_HPP

#include <opencv2/core.hpp>
#include <refocus/refocus.hpp>

namespace refocus
{

/** @cond */
inline refocus_image image_of(const cv::Mat &mat, uint32_t format)
{
    if (mat.dims != 2 || format == REFOCUS_FORMAT_NONE)
        throw error(REFOCUS_ERR_ARGUMENT, "this type of cv::Mat is no picture");
    return refocus_image_packed(format, mat.data, mat.cols, mat.rows,
                                static_cast<ptrdiff_t>(mat.step[0]));
}
/** @endcond */

/**
 * A cv::Mat in the order of OpenCV: B, G, R.
 *
 * @param mat  CV_8UC3 or CV_8UC4
 * @throws refocus::error of REFOCUS_ERR_ARGUMENT for another type
 */
inline refocus_image bgr_image(const cv::Mat &mat)
{
    switch (mat.type()) {
    case CV_8UC3:
        return image_of(mat, REFOCUS_FORMAT_BGR8);
    case CV_8UC4:
        return image_of(mat, REFOCUS_FORMAT_BGRA8);
    default:
        return image_of(mat, REFOCUS_FORMAT_NONE);
    }
}

/**
 * A cv::Mat in the order R, G, B, which deep pictures have: see cv::cvtColor().
 *
 * @param mat  CV_8U, CV_16U or CV_32F of 3 or 4 channels
 * @throws refocus::error of REFOCUS_ERR_ARGUMENT for another type
 */
inline refocus_image rgb_image(const cv::Mat &mat)
{
    switch (mat.type()) {
    case CV_8UC3:
        return image_of(mat, REFOCUS_FORMAT_RGB8);
    case CV_8UC4:
        return image_of(mat, REFOCUS_FORMAT_RGBA8);
    case CV_16UC3:
        return image_of(mat, REFOCUS_FORMAT_RGB16);
    case CV_16UC4:
        return image_of(mat, REFOCUS_FORMAT_RGBA16);
    case CV_32FC3:
        return image_of(mat, REFOCUS_FORMAT_RGB_FLOAT);
    case CV_32FC4:
        return image_of(mat, REFOCUS_FORMAT_RGBA_FLOAT);
    default:
        return image_of(mat, REFOCUS_FORMAT_NONE);
    }
}

/**
 * A cv::Mat of disparities, the greatest value nearest.
 *
 * @param mat  CV_8UC1 or CV_16UC1
 * @throws refocus::error of REFOCUS_ERR_ARGUMENT for another type
 */
inline refocus_disparity disparity(const cv::Mat &mat)
{
    if (mat.dims != 2 || (mat.type() != CV_8UC1 && mat.type() != CV_16UC1))
        throw error(REFOCUS_ERR_ARGUMENT, "disparities are CV_8UC1 or CV_16UC1");
    refocus_disparity map =
        refocus_disparity16(nullptr, mat.cols, mat.rows, static_cast<ptrdiff_t>(mat.step[0]));
    map.bits = mat.type() == CV_8UC1 ? 8 : 16;
    map.samples = mat.data;
    return map;
}

/**
 * Refocus a picture in one call; who has several of one size, or wants other settings, keeps a
 * refocus::renderer.
 *
 * @param photo      CV_8UC3 or CV_8UC4 in the order of OpenCV
 * @param disparity  CV_8UC1 or CV_16UC1 of any size
 * @param focus      df, 0 farthest to 1 nearest
 * @param blur       K in pixels, 0 to REFOCUS_MAX_BLUR_RADIUS
 * @return a new picture of the photo's type
 */
inline cv::Mat render(const cv::Mat &photo, const cv::Mat &disparity, float focus, float blur)
{
    const refocus_image from = bgr_image(photo);
    const refocus_disparity map = refocus::disparity(disparity);
    cv::Mat out(photo.size(), photo.type());
    renderer renderer(from.width, from.height, blur);

    renderer.prepare(from, map);
    renderer.render(refocus_settings_default(focus, blur), bgr_image(out));
    return out;
}

} // namespace refocus
#endif
