/* stereo_exposure.hpp: the exposures of the two pictures of a stereo pair are made the same. */
#ifndef RF_OPENCV_STEREO_EXPOSURE_HPP
#define RF_OPENCV_STEREO_EXPOSURE_HPP

#include <opencv2/core.hpp>

namespace refocus_cv
{

/* Gives the darker picture the histogram of the brighter one, as matching compares codes. The other
 * way round it would lose contrast, and what only the brighter one has clipped would differ. */
void match_exposures(cv::Mat &first, cv::Mat &second);

} // namespace refocus_cv

#endif
