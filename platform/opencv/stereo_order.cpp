/* stereo_order.cpp: what only one picture of a stereo pair shows tells which one is the left one.
 *
 * Left of a nearer surface the left picture shows a stripe of what is behind that the right one
 * does not, as wide as disparities differ: along a row, they are low, then there are none, then
 * they are high. Pictures taken for each other have disparities of the other sign, and the same
 * low, none and high along a row; but then the stripe is right of the nearer surface, which has the
 * low ones, and belongs to what has the high ones. So with P, S and Q the mean colours of what is
 * left of a stripe, of the stripe and of what is right of it, a stripe votes
 *
 *     (|S - Q|^2 - |S - P|^2) / |P - Q|^2
 *
 * within -1 to 1 for the order to be right.
 */
#include "stereo_order.hpp"

#include <algorithm>
#include <cmath>

namespace refocus_cv
{

namespace
{

enum {
    BESIDE = 4,     /* pixels on either side whose colour and disparity are looked at */
    NARROWEST = 3,  /* pixels of a stripe */
    CONTRAST = 300, /* squared codes that the sides differ by at least */
    FEW = 100,      /* votes that tell nothing, as do fewer than half a row */
};

/* Disparities on either side differ by at least so much. */
const float least_step = 2;

/* Mean colour from column x to before `end`. */
cv::Vec3f mean_of(const cv::Vec3b *row, int x, int end)
{
    cv::Vec3f sum(0, 0, 0);

    for (int i = x; i < end; i++)
        sum += cv::Vec3f(row[i]);
    return sum / (float)(end - x);
}

/* The median disparity of BESIDE pixels from column x on; NaN where one has none. */
float disparity_from(const float *row, int x)
{
    float d[BESIDE];

    for (int i = 0; i < BESIDE; i++)
        if (std::isnan(d[i] = row[x + i]))
            return d[i];
    std::sort(d, d + BESIDE);
    return (d[BESIDE / 2 - 1] + d[BESIDE / 2]) / 2;
}

/* The vote of a stripe from column x to before `end`. */
void add_vote(const cv::Vec3b *photo, const float *disparity, int x, int end, order_votes &votes)
{
    const float step = disparity_from(disparity, end) - disparity_from(disparity, x - BESIDE);
    const int wide = end - x;

    if (!(step >= least_step) || (float)wide < step / 2 || (float)wide > 2 * step + 2)
        return;

    const cv::Vec3f left = mean_of(photo, x - BESIDE, x), right = mean_of(photo, end, end + BESIDE);
    const cv::Vec3f stripe = mean_of(photo, x + 1, end - 1);
    const double apart = cv::norm(left - right, cv::NORM_L2SQR);

    if (apart < CONTRAST)
        return;
    const double vote =
        (cv::norm(stripe - right, cv::NORM_L2SQR) - cv::norm(stripe - left, cv::NORM_L2SQR)) /
        apart;

    votes.sum += std::min(1.0, std::max(-1.0, vote));
    votes.count++;
}

} // namespace

void add_order_votes(const cv::Mat &photo, const cv::Mat &disparity, order_votes &votes)
{
    votes.rows = disparity.rows;
    for (int y = 0; y < disparity.rows; y++) {
        const float *row = disparity.ptr<float>(y);

        for (int x = BESIDE, end; x < disparity.cols; x = end + 1) {
            for (end = x; end < disparity.cols && std::isnan(row[end]);)
                end++;
            if (end - x >= NARROWEST && end + BESIDE <= disparity.cols)
                add_vote(photo.ptr<cv::Vec3b>(y), row, x, end, votes);
        }
    }
}

float order_of(const order_votes &votes)
{
    return votes.count < FEW || 2 * votes.count < votes.rows ? 0 : (float)(votes.sum / votes.count);
}

} // namespace refocus_cv
