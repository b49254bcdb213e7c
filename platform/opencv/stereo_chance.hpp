/* stereo_chance.hpp: matches by chance, far from all others, are taken out. */
#ifndef RF_OPENCV_STEREO_CHANCE_HPP
#define RF_OPENCV_STEREO_CHANCE_HPP

#include <opencv2/core.hpp>

namespace refocus_cv
{

/* Disparities that are NaN where there is none lose those that a few patches have alone. */
void remove_chance(cv::Mat &disparity);

} // namespace refocus_cv

#endif
