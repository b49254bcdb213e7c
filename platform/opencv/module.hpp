/* module.hpp: the module of contrib filters, if it is there. */
#ifndef RF_OPENCV_MODULE_HPP
#define RF_OPENCV_MODULE_HPP

#include "../ximgproc/ximgproc.h"

/* Loads it when first called; NULL: it is not there. Thread-safe. */
const rf_ximgproc *rf_opencv_ximgproc();

#endif
