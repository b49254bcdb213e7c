/* joint_bilateral.hpp: joint bilateral upsampling of a small map, by whole rows. */
#ifndef RF_OPENCV_JOINT_BILATERAL_HPP
#define RF_OPENCV_JOINT_BILATERAL_HPP

#include <cstdint>

#include <refocus/platform/opencv.h>

namespace refocus_cv
{

/* Takes the arguments of refocus_cv_upsample(), which are sound; throws what OpenCV throws. */
void joint_bilateral(const refocus_image &photo, const refocus_disparity &map, float sigma,
                     uint16_t *out);

} // namespace refocus_cv

#endif
