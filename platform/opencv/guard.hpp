/* guard.hpp: no exception gets out, and OpenCV keeps quiet. */
#ifndef RF_OPENCV_GUARD_HPP
#define RF_OPENCV_GUARD_HPP

#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <refocus/platform/opencv.h>

namespace refocus_cv
{

inline int fail(refocus_cv_reason *reason, int status, const char *words)
{
    if (reason) {
        std::snprintf(reason->text, sizeof reason->text, "%s", words);
        for (char *c = reason->text; *c; c++)
            if (*c < ' ' || *c > '~')
                *c = ' ';
    }
    return status;
}

/* OpenCV logs what it throws; the log level is put back. */
class Quiet
{
  public:
    Quiet() : level(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT))
    {
    }
    ~Quiet()
    {
        cv::utils::logging::setLogLevel(level);
    }
    Quiet(const Quiet &) = delete;
    Quiet &operator=(const Quiet &) = delete;

  private:
    cv::utils::logging::LogLevel level;
};

template <class Work> int guarded(refocus_cv_reason *reason, int status, Work work) noexcept
{
    try {
        if (reason)
            reason->text[0] = '\0';
        Quiet quiet;
        return work();
    } catch (const std::bad_alloc &) {
        return fail(reason, REFOCUS_ERR_MEMORY, "not enough memory");
    } catch (const cv::Exception &e) {
        if (e.code == cv::Error::StsNoMem)
            return fail(reason, REFOCUS_ERR_MEMORY, "not enough memory");
        return fail(reason, status, e.err.c_str());
    } catch (const std::exception &e) {
        return fail(reason, status, e.what());
    } catch (...) {
        return fail(reason, status, "OpenCV gave up");
    }
}

/* Whether rows of so many bytes lie so far apart: downwards, as cv::Mat has it, and so that the
 * place of each is a ptrdiff_t; rows >= 1. */
inline bool good_rows(ptrdiff_t stride, ptrdiff_t bytes, int rows)
{
    return stride >= bytes && stride <= PTRDIFF_MAX / rows;
}

inline bool good_photo(const refocus_image *image)
{
    return image && image->format == REFOCUS_FORMAT_RGB8 && image->plane[0] && image->width >= 1 &&
           image->height >= 1 && image->width <= REFOCUS_MAX_SIDE &&
           image->height <= REFOCUS_MAX_SIDE &&
           good_rows(image->stride[0], 3 * (ptrdiff_t)image->width, image->height);
}

inline cv::Mat view(const refocus_image *image)
{
    return cv::Mat(image->height, image->width, CV_8UC3, image->plane[0], (size_t)image->stride[0]);
}

} // namespace refocus_cv

#endif
