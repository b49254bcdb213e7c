/* stereo_span.hpp: the disparities that are searched for are found from patches. */
#ifndef RF_OPENCV_STEREO_SPAN_HPP
#define RF_OPENCV_STEREO_SPAN_HPP

#include <opencv2/core.hpp>

namespace refocus_cv
{

/* `count` disparities from `least` on. */
struct span {
    int least, count;
};

/* The span to be searched in two small grey pictures whose rows lie up to `rows` apart: `usual`,
 * unless patches of the first that are found in the second lie beyond it. */
span find_span(const cv::Mat &first, const cv::Mat &second, int rows, const span &usual);

} // namespace refocus_cv

#endif
