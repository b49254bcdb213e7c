/* stereo_rectify.cpp: two pictures of a pair are turned, scaled and moved until rows meet rows.
 *
 * Cameras that are mounted by hand are turned about their axes by a degree or so, and two lenses,
 * or one that was focused again, differ in scale by up to a hundredth. Then a place lies lower in
 * one picture by
 *
 *     dy = down + turn x + grow y,
 *
 * small angles taken for their sines, and farther right by grow x - turn y, which would be taken
 * for depth. Both are undone by the similarity. Its three numbers are fitted to patches of the
 * first picture that are found in the second one near the place that their disparity says: least
 * squares, repeated with less weight for what does not fit (Tukey's biweight).
 */
#include "stereo_rectify.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace refocus_cv
{

namespace
{

enum {
    PATCH = 7,   /* pixels on either side of a place */
    ACROSS = 64, /* places along the width */
    ROUNDS = 10, /* rounds of weighted least squares */
    FEW = 40,    /* places that tell nothing */
};

const double like = 0.8;      /* correlation of a patch that is found */
const double distinct = 0.05; /* difference from the correlation two rows away */

/* Less than this at the corners is left alone: interpolation would cost more. */
const double least_reach = 0.25;

struct place {
    double x, y, lower; /* from the middle of the picture */
};

/* The row, to a part of it, at which a column of scores is greatest; false: at its ends, or flat.
 */
bool peak(const cv::Mat &score, int column, int row, double &at)
{
    if (row < 2 || row + 2 >= score.rows)
        return false;
    const double here = score.at<float>(row, column);
    const double up = score.at<float>(row - 1, column), down = score.at<float>(row + 1, column);
    const double beyond =
        std::max(score.at<float>(row - 2, column), score.at<float>(row + 2, column));
    const double bend = up + down - 2 * here;

    at = row + (bend < 0 ? 0.5 * (up - down) / bend : 0);
    return here >= like && here - beyond >= distinct;
}

/* How much lower the patch at a place lies in the second picture, if it is found there. */
bool find_lower(const cv::Mat &first, const cv::Mat &second, const cv::Point &at, double disparity,
                int reach, double &lower)
{
    const int side = 2 * PATCH + 1;
    const cv::Rect patch(at.x - PATCH, at.y - PATCH, side, side);
    const cv::Rect around(cvRound(at.x - disparity) - PATCH - reach, at.y - PATCH - reach - 2,
                          side + 2 * reach, side + 2 * reach + 4);
    cv::Mat score;
    cv::Point best;

    if ((around & cv::Rect(0, 0, second.cols, second.rows)) != around)
        return false;
    cv::matchTemplate(second(around), first(patch), score, cv::TM_CCOEFF_NORMED);
    cv::minMaxLoc(score, nullptr, nullptr, nullptr, &best);
    if (!peak(score, best.x, best.y, lower))
        return false;
    lower -= reach + 2;
    return true;
}

std::vector<place> find_places(const cv::Mat &first, const cv::Mat &second,
                               const cv::Mat &disparity, int reach)
{
    const int step = std::max(4, first.cols / ACROSS);
    std::vector<place> places;

    for (int y = PATCH; y + PATCH < first.rows; y += step)
        for (int x = PATCH; x + PATCH < first.cols; x += step) {
            const float d = disparity.at<float>(y, x);
            double lower;

            if (!std::isnan(d) && find_lower(first, second, cv::Point(x, y), d, reach, lower))
                places.push_back({x - 0.5 * (first.cols - 1), y - 0.5 * (first.rows - 1), lower});
        }
    return places;
}

double residual(const place &p, const cv::Vec3d &c)
{
    return p.lower - c[0] - c[1] * p.x - c[2] * p.y;
}

/* Three times the median of what is left, in pixels: beyond it a place does not count. */
double bound_of(const std::vector<place> &places, const cv::Vec3d &c)
{
    std::vector<double> left;

    for (const place &p : places)
        left.push_back(std::fabs(residual(p, c)));
    std::nth_element(left.begin(), left.begin() + (std::ptrdiff_t)(left.size() / 2), left.end());
    return std::max(0.5, 4.5 * left[left.size() / 2]);
}

/* One round of the fit; false: places do not tell. */
bool fit(const std::vector<place> &places, cv::Vec3d &c)
{
    const double bound = bound_of(places, c);
    cv::Matx33d left = cv::Matx33d::zeros();
    cv::Vec3d right(0, 0, 0);

    for (const place &p : places) {
        const double r = residual(p, c) / bound;
        const double root = std::max(0.0, 1 - r * r);
        const cv::Vec3d row(1, p.x, p.y);

        left += root * root * row * row.t();
        right += root * root * p.lower * row;
    }
    cv::Vec3d solved;
    if (!cv::solve(left, right, solved, cv::DECOMP_CHOLESKY))
        return false;
    c = solved;
    return true;
}

} // namespace

bool find_misalignment(const cv::Mat &first, const cv::Mat &second, const cv::Mat &disparity,
                       int reach, misalignment &m)
{
    const std::vector<place> places = find_places(first, straightened(second, m), disparity, reach);
    cv::Vec3d c(0, 0, 0);

    if (places.size() < FEW)
        return false;
    for (int i = 0; i < ROUNDS; i++)
        if (!fit(places, c))
            return false;
    m.down += c[0];
    m.turn += c[1];
    m.grow += c[2];
    if (std::fabs(m.down) + std::fabs(m.turn) * first.cols / 2 +
            std::fabs(m.grow) * std::max(first.cols, first.rows) / 2 <
        least_reach)
        m = misalignment();
    return true;
}

cv::Mat straightened(const cv::Mat &second, const misalignment &m)
{
    const double x = 0.5 * (second.cols - 1), y = 0.5 * (second.rows - 1);
    /* To places of the second picture, about its middle. */
    const cv::Matx23d to(1 + m.grow, -m.turn, -m.grow * x + m.turn * y, m.turn, 1 + m.grow,
                         m.down - m.turn * x - m.grow * y);
    cv::Mat out;

    cv::warpAffine(second, out, to, second.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    return out;
}

} // namespace refocus_cv
