/* stereo_span.cpp: the disparities that are searched for are found from patches.
 *
 * Cameras that are turned towards each other, and pictures that were cut, are apart by any part of
 * their width, and what is very near by more than usual. So patches of the first picture are looked
 * for in whole rows of the second, and those that lead back to their place tell.
 *
 *     usual -32 to 96; patches at -80 to -48: -128 to 0 is searched
 *     usual -32 to 96; patches at 4 to 116: -12 to 132
 */
#include "stereo_span.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace refocus_cv
{

namespace
{

enum {
    PATCH = 7,   /* pixels on either side of a place */
    ACROSS = 24, /* places along the width */
    FEW = 40,    /* places that tell nothing */
    TAIL = 20,   /* 1 of so many at either end may be chance */
    MARGIN = 16, /* pixels beyond both ends */
    STEP = 16,   /* counts are multiples of it */
};

const double like = 0.8;  /* correlation of a patch that is found */
const double texture = 4; /* deviation of codes in a patch that can be found */

/* Where the patch of `from` at a place lies in `to`, in any column and up to `rows` lower or
 * higher. */
bool find(const cv::Mat &from, const cv::Mat &to, const cv::Point &at, int rows, cv::Point &found)
{
    const int side = 2 * PATCH + 1, top = std::max(0, at.y - PATCH - rows);
    const int bottom = std::min(to.rows, at.y + PATCH + rows + 1);
    const cv::Mat patch = from(cv::Rect(at.x - PATCH, at.y - PATCH, side, side));
    cv::Mat score, mean, deviation;
    double greatest;

    cv::meanStdDev(patch, mean, deviation);
    if (deviation.at<double>(0) < texture)
        return false;
    cv::matchTemplate(to.rowRange(top, bottom), patch, score, cv::TM_CCOEFF_NORMED);
    cv::minMaxLoc(score, nullptr, &greatest, nullptr, &found);
    found += cv::Point(PATCH, PATCH + top);
    return greatest >= like;
}

/* Disparities of patches that are found both ways, in order. */
std::vector<int> find_shifts(const cv::Mat &first, const cv::Mat &second, int rows)
{
    const int step = std::max(4, first.cols / ACROSS);
    std::vector<int> shifts;

    for (int y = PATCH; y + PATCH < first.rows; y += step)
        for (int x = PATCH; x + PATCH < first.cols; x += step) {
            cv::Point there, back;

            if (find(first, second, cv::Point(x, y), rows, there) &&
                find(second, first, there, rows, back) && std::abs(back.x - x) <= 1 &&
                std::abs(back.y - y) <= 1)
                shifts.push_back(x - there.x);
        }
    std::sort(shifts.begin(), shifts.end());
    return shifts;
}

} // namespace

span find_span(const cv::Mat &first, const cv::Mat &second, int rows, const span &usual)
{
    const std::vector<int> shifts = find_shifts(first, second, rows);
    const size_t tail = shifts.size() / TAIL;

    if (shifts.size() < FEW)
        return usual;
    const int low = shifts[tail], high = shifts[shifts.size() - 1 - tail];
    if (low >= usual.least && high <= usual.least + usual.count)
        return usual;
    const int wanted = (high - low + 2 * MARGIN + STEP - 1) / STEP * STEP;
    const int count = std::max(usual.count, wanted);

    return {(low + high - count) / 2, count};
}

} // namespace refocus_cv
