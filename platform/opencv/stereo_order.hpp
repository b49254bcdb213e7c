/* stereo_order.hpp: which picture of a stereo pair is the left one. */
#ifndef RF_OPENCV_STEREO_ORDER_HPP
#define RF_OPENCV_STEREO_ORDER_HPP

#include <opencv2/core.hpp>

namespace refocus_cv
{

/* Votes of what only one picture of a pair shows. */
struct order_votes {
    double sum = 0;
    int count = 0, rows = 0; /* rows of a picture */
};

/* Adds the votes of a picture, of 8 bits a channel, that is taken for the left one, and of its
 * disparities: NaN where they do not agree with those of the other picture. */
void add_order_votes(const cv::Mat &photo, const cv::Mat &disparity, order_votes &votes);

/* -1 to 1: above 0 if the picture is the left one; 0 where there are few votes. */
float order_of(const order_votes &votes);

} // namespace refocus_cv

#endif
