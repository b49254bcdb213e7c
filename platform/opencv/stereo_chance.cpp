/* stereo_chance.cpp: matches by chance, far from all others, are taken out. They are fewer than 1
 * of 500 matches, in patches too large for specks, and decide the range of the map. */
#include "stereo_chance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace refocus_cv
{

namespace
{

enum {
    SHARE = 500,  /* chance is less than 1 of so many matches */
    FAR_GAP = 16, /* the gap is more than 1 of so many of the range that is left */
    NEAR_GAP = 1,
    SIDES = 8, /* a patch is shorter than 1 of so many of the picture's smaller side, */
    LONG = 3,  /* no longer than so many times its width, and has 1 of so many of its box */
};

std::vector<float> known_values(const cv::Mat &disparity)
{
    std::vector<float> values;

    for (int y = 0; y < disparity.rows; y++)
        for (int x = 0; x < disparity.cols; x++)
            if (!std::isnan(disparity.at<float>(y, x)))
                values.push_back(disparity.at<float>(y, x));
    return values;
}

/* How many of the first values lie beyond a gap that is more than 1 of `parts` of the range behind
 * it, up to `last`; `most` of them are in order. */
size_t beyond_gap(const std::vector<float> &values, size_t most, float last, int parts)
{
    size_t beyond = 0;

    for (size_t i = 1; i <= most; i++)
        if (std::fabs(values[i] - values[i - 1]) * (float)parts > std::fabs(last - values[i]))
            beyond = i;
    return beyond;
}

/* Takes out what lies far behind all else, as filling, which takes the farther side, would spread
 * it over all that could not be matched: beyond a gap of 1/16 of what is left. */
void remove_far(cv::Mat &disparity)
{
    std::vector<float> values = known_values(disparity);
    const size_t most = values.size() / SHARE;

    if (most == 0)
        return;
    const float greatest = *std::max_element(values.begin(), values.end());
    std::partial_sort(values.begin(), values.begin() + (long)most + 1, values.end());
    const size_t far = beyond_gap(values, most, greatest, FAR_GAP);
    disparity.setTo(std::numeric_limits<float>::quiet_NaN(), disparity < values[far]);
}

/* Whether a part of the picture is a patch that stands alone: a post is long, upright or not, and
 * so is a branch, and most of what is near comes in from the border. */
bool is_patch(const cv::Mat &stats, int label, const cv::Size &size)
{
    const int *const part = stats.ptr<int>(label);
    const int left = part[cv::CC_STAT_LEFT], width = part[cv::CC_STAT_WIDTH];
    const int top = part[cv::CC_STAT_TOP], height = part[cv::CC_STAT_HEIGHT];

    return std::max(width, height) * SIDES < std::min(size.width, size.height) &&
           std::max(width, height) <= LONG * std::min(width, height) &&
           part[cv::CC_STAT_AREA] * LONG >= width * height && left > 0 && top > 0 &&
           left + width < size.width && top + height < size.height;
}

/* Takes out patches far before all else, which would take more than half of the range: beyond a gap
 * as wide as what is left. */
void remove_near(cv::Mat &disparity)
{
    std::vector<float> values = known_values(disparity);
    const size_t most = values.size() / SHARE;

    if (most == 0)
        return;
    const float least = *std::min_element(values.begin(), values.end());
    std::partial_sort(values.begin(), values.begin() + (long)most + 1, values.end(),
                      std::greater<float>());
    const size_t near = beyond_gap(values, most, least, NEAR_GAP);
    cv::Mat labels, stats, middles;
    const int count = cv::connectedComponentsWithStats(disparity > values[near], labels, stats,
                                                       middles, 8, CV_32S);

    for (int label = 1; near > 0 && label < count; label++)
        if (is_patch(stats, label, disparity.size()))
            disparity.setTo(std::numeric_limits<float>::quiet_NaN(), labels == label);
}

} // namespace

void remove_chance(cv::Mat &disparity)
{
    remove_far(disparity);
    remove_near(disparity);
}

} // namespace refocus_cv
