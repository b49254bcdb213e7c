/* stereo_rectify.hpp: two pictures of a pair are turned, scaled and moved until rows meet rows. */
#ifndef RF_OPENCV_STEREO_RECTIFY_HPP
#define RF_OPENCV_STEREO_RECTIFY_HPP

#include <opencv2/core.hpp>

namespace refocus_cv
{

/* A place (x, y) of the first picture, from its middle, lies this many pixels lower in the second
 * one: down + turn x + grow y. */
struct misalignment {
    double down = 0, turn = 0, grow = 0;
};

/* Finds it in grey pictures of one size, around `m`, whose pixels may lie `reach` off the rows that
 * it says. Disparities are those of the first picture, NaN where there are none. Returns false and
 * leaves `m` where too few places tell. */
bool find_misalignment(const cv::Mat &first, const cv::Mat &second, const cv::Mat &disparity,
                       int reach, misalignment &m);

/* The second picture as it would be without it. */
cv::Mat straightened(const cv::Mat &second, const misalignment &m);

} // namespace refocus_cv

#endif
