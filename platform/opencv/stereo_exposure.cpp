/* stereo_exposure.cpp: the darker picture of a pair gets the histogram of the brighter one. */
#include "stereo_exposure.hpp"

#include <vector>

namespace refocus_cv
{

namespace
{

enum { CODES = 256 };

/* The share of pixels that are darker than each code, half of those that have it counted. */
std::vector<double> ranks_of(const cv::Mat &grey)
{
    std::vector<double> count(CODES), ranks(CODES);
    double below = 0;

    for (int y = 0; y < grey.rows; y++)
        for (int x = 0; x < grey.cols; x++)
            count[grey.at<uchar>(y, x)]++;
    for (int v = 0; v < CODES; v++) {
        ranks[v] = (below + count[v] / 2) / (double)grey.total();
        below += count[v];
    }
    return ranks;
}

} // namespace

void match_exposures(cv::Mat &first, cv::Mat &second)
{
    const bool turned = cv::mean(first)[0] < cv::mean(second)[0];
    cv::Mat &darker = turned ? first : second;
    const std::vector<double> from = ranks_of(darker), to = ranks_of(turned ? second : first);
    cv::Mat curve(1, CODES, CV_8U);

    for (int v = 0, code = 0; v < CODES; v++) {
        while (code + 1 < CODES && to[code + 1] <= from[v])
            code++;
        const bool next = code + 1 < CODES && to[code + 1] - from[v] < from[v] - to[code];

        curve.at<uchar>(v) = cv::saturate_cast<uchar>(code + next);
    }
    cv::LUT(darker, curve, darker);
}

} // namespace refocus_cv
