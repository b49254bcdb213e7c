/* stereo.cpp: depth is computed from two pictures by OpenCV's semi-global matching, both ways. */
#include "guard.hpp"
#include "module.hpp"
#include "stereo_chance.hpp"
#include "stereo_exposure.hpp"
#include "stereo_order.hpp"
#include "stereo_rectify.hpp"
#include "stereo_span.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace
{

const float none = std::numeric_limits<float>::quiet_NaN();

/* Matches of a to b with a[x] ~ b[x - d], d from least on; NaN where there is none. */
cv::Mat match(const cv::Mat &a, const cv::Mat &b, int least, int count)
{
    enum { BLOCK = 3 };
    const int area = BLOCK * BLOCK;
    const cv::Ptr<cv::StereoSGBM> sgbm = cv::StereoSGBM::create(
        least, count, BLOCK, 8 * area, 32 * area, -1, 63, 5, 0, 0, cv::StereoSGBM::MODE_SGBM_3WAY);
    /* Pixels near the border would not be matched, so a margin of repeated pixels is added. */
    const int left = std::max(0, least + count), right = std::max(0, -least);
    cv::Mat wide_a, wide_b, raw, out;

    cv::copyMakeBorder(a, wide_a, 0, 0, left, right, cv::BORDER_REPLICATE);
    cv::copyMakeBorder(b, wide_b, 0, 0, left, right, cv::BORDER_REPLICATE);
    sgbm->compute(wide_a, wide_b, raw);
    raw.colRange(left, left + a.cols).convertTo(out, CV_32F, 1 / 16.0);
    out.setTo(none, out < least);
    return out;
}

/* Patches too small to be seen by both cameras by anything but chance: those in occlusions, from
 * which filling would spread. Returns the share that is left. */
float remove_specks(cv::Mat &disparity)
{
    const int least = std::max(16, disparity.rows * disparity.cols / 4000);
    const short gone = -32768;
    cv::Mat fixed(disparity.size(), CV_16S);
    long left = 0;

    for (int y = 0; y < disparity.rows; y++)
        for (int x = 0; x < disparity.cols; x++) {
            const float d = disparity.at<float>(y, x);

            fixed.at<short>(y, x) = std::isnan(d) ? gone : cv::saturate_cast<short>(d * 16);
        }
    cv::filterSpeckles(fixed, gone, least, 16);
    for (int y = 0; y < disparity.rows; y++)
        for (int x = 0; x < disparity.cols; x++) {
            if (fixed.at<short>(y, x) == gone)
                disparity.at<float>(y, x) = none;
            else
                left++;
        }
    return (float)left / (float)disparity.total();
}

/* Disparities of left from left to right and from right to left, each at its own pixels. */
void match_pair(const cv::Mat &left, const cv::Mat &right, int least, int count, cv::Mat &out,
                cv::Mat &back)
{
    cv::Mat flipped_left, flipped_right;

    out = match(left, right, least, count);
    cv::flip(left, flipped_left, 1);
    cv::flip(right, flipped_right, 1);
    cv::flip(match(flipped_right, flipped_left, least, count), back, 1);
}

/* Values that disagree by more than a pixel are taken out. Returns the share that is left. */
float check(cv::Mat &out, const cv::Mat &back)
{
    for (int y = 0; y < out.rows; y++) {
        float *row = out.ptr<float>(y);
        const float *other = back.ptr<float>(y);

        for (int x = 0; x < out.cols; x++) {
            const int at = std::isnan(row[x]) ? -1 : cvRound(x - row[x]);

            if (at < 0 || at >= out.cols || !(std::fabs(other[at] - row[x]) <= 1))
                row[x] = none;
        }
    }
    return remove_specks(out);
}

float match_both(const cv::Mat &left, const cv::Mat &right, int least, int count, cv::Mat &out)
{
    cv::Mat back;

    match_pair(left, right, least, count, out, back);
    return check(out, back);
}

/* The range to search at full size is found at a reduced one. */
struct search {
    refocus_cv::misalignment apart;
    int least = 0, count = 0;
    double from = 0, to = 0; /* the range of the reduced size, in parts of the width */
    float matched = -1;
    cv::Mat disparity;
};

/* Ends of the range that holds all but the outermost thousandth. */
void find_range(const cv::Mat &disparity, double scale, search &s)
{
    std::vector<float> values;

    for (int y = 0; y < disparity.rows; y++)
        for (int x = 0; x < disparity.cols; x++)
            if (!std::isnan(disparity.at<float>(y, x)))
                values.push_back(disparity.at<float>(y, x));
    std::sort(values.begin(), values.end());
    const size_t tail = values.size() / 1000;
    const double low = values[tail] * scale, high = values[values.size() - 1 - tail] * scale;
    const double margin = 4 + (high - low) / 20;
    s.least = (int)std::floor(low - margin);
    s.count = ((int)std::ceil(high + margin) - s.least + 15) / 16 * 16;
}

search look(const cv::Mat &left, const cv::Mat &right)
{
    enum { WIDTH = 400, ROWS = 5 };
    const double scale = std::max(1.0, left.cols / (double)WIDTH);
    const int width = cvRound(left.cols / scale), count = std::max(32, width / 3 / 16 * 16);
    search best;
    cv::Mat a, b, disparity;

    cv::resize(left, a, cv::Size(width, cvRound(left.rows / scale)), 0, 0, cv::INTER_AREA);
    cv::resize(right, b, a.size(), 0, 0, cv::INTER_AREA);
    const refocus_cv::span span = refocus_cv::find_span(a, b, ROWS, {-count / 3 / 16 * 16, count});
    best.from = span.least / (double)width;
    best.to = (span.least + span.count) / (double)width;
    for (int i = 0; i <= 2 * ROWS + 1; i++) { /* 0, 1, -1, 2, -2, ...; then turned and scaled */
        refocus_cv::misalignment apart = best.apart;

        if (i > 2 * ROWS && !find_misalignment(a, b, best.disparity, 3, apart))
            break;
        if (i <= 2 * ROWS)
            apart.down = i % 2 ? (i + 1) / 2 : -i / 2;
        const float matched =
            match_both(a, straightened(b, apart), span.least, span.count, disparity);

        if (matched > best.matched + 0.01f) {
            best.matched = matched;
            best.apart = apart;
            best.disparity = disparity.clone();
        }
    }
    best.apart.down *= scale;
    if (best.matched > 0)
        find_range(best.disparity, scale, best);
    cv::resize(best.disparity * scale, best.disparity, left.size(), 0, 0, cv::INTER_NEAREST);
    return best;
}

/* Two pictures as they are matched. */
struct pair {
    cv::Mat photo[2], grey[2]; /* 8 bits a channel */
};

pair load(const refocus_image *first, const refocus_image *second, const cv::Size &size)
{
    const refocus_image *const image[] = {first, second};
    pair p;

    for (int i = 0; i < 2; i++) {
        cv::cvtColor(refocus_cv::view(image[i]), p.grey[i], cv::COLOR_RGB2GRAY);
        if (p.grey[i].size() != size)
            cv::resize(p.grey[i], p.grey[i], size, 0, 0, cv::INTER_AREA);
        cv::resize(refocus_cv::view(image[i]), p.photo[i], size, 0, 0, cv::INTER_AREA);
    }
    refocus_cv::match_exposures(p.grey[0], p.grey[1]);
    return p;
}

/* A right picture and its left one become a left one and its right one. */
pair mirrored(const pair &p)
{
    pair out;

    for (int i = 0; i < 2; i++) {
        cv::flip(p.photo[i], out.photo[i], 1);
        cv::flip(p.grey[i], out.grey[i], 1);
    }
    return out;
}

/* Disparities of a pair whose first picture is taken for the left one. */
struct matches {
    cv::Mat disparity;
    refocus_cv::misalignment apart;
    float matched = 0, order = 0; /* as in refocus_stereo_report */
    int status = REFOCUS_OK;      /* an error where there are none */
    std::string why;              /* the reason of an error */
};

/* Votes of both pictures: disparities of the first one have been checked, and those of the second
 * one are now. It is a first one when it is mirrored. */
float find_order(const pair &p, const matches &m, const cv::Mat &back, const cv::Mat &raw)
{
    refocus_cv::order_votes votes;
    cv::Mat second, disparity, other;

    refocus_cv::add_order_votes(p.photo[0], m.disparity, votes);
    cv::flip(straightened(p.photo[1], m.apart), second, 1);
    cv::flip(back, disparity, 1);
    cv::flip(raw, other, 1);
    check(disparity, other);
    refocus_cv::add_order_votes(second, disparity, votes);
    return refocus_cv::order_of(votes);
}

/* The reason of an error: it says which pairs are matched. */
std::string unlike(const char *what, const search &s)
{
    return cv::format("%s, whose rows may lie a fiftieth of the width apart, and disparities from "
                      "%.0f to %.0f %% of it; give a rectified pair, left before right",
                      what, 100 * s.from, 100 * s.to);
}

matches match_in_order(const pair &p, const refocus_stereo_params *params,
                       const rf_ximgproc *contrib)
{
    enum { ROUNDS = 2 };
    const cv::Mat &a = p.grey[0];
    search s = look(a, p.grey[1]);
    cv::Mat back, raw;
    matches m;

    if (s.matched < params->least_match / 2) {
        m.status = REFOCUS_ERR_NO_DEPTH;
        m.why = unlike("the two pictures do not match", s);
        return m;
    }
    for (int i = 0; i < ROUNDS; i++)
        find_misalignment(a, p.grey[1], s.disparity, 2 + a.cols / 400, s.apart);
    m.apart = s.apart;
    match_pair(a, straightened(p.grey[1], m.apart), s.least, s.count, m.disparity, back);
    raw = m.disparity.clone();
    m.matched = check(m.disparity, back);
    m.order = find_order(p, m, back, raw);
    refocus_cv::remove_chance(m.disparity);
    m.status = m.matched < params->least_match ? (int)REFOCUS_ERR_NO_DEPTH : (int)REFOCUS_OK;
    if (m.status != REFOCUS_OK)
        m.why = unlike("too few pixels of the two pictures match", s);
    else if (params->method == REFOCUS_STEREO_PLAIN)
        m.disparity = raw;
    else if (params->method == REFOCUS_STEREO_WLS) {
        cv::Mat filled = m.disparity.clone();

        if (contrib->wls(p.photo[0].data, raw.ptr<float>(), back.ptr<float>(), filled.ptr<float>(),
                         a.cols, a.rows)) {
            m.status = REFOCUS_ERR_UNSUPPORTED;
            m.why = "OpenCV gave up";
        }
        /* It smooths over edges: what has been confirmed stays. */
        filled.copyTo(m.disparity, ~(m.disparity == m.disparity) & (filled >= s.least) &
                                       (filled <= s.least + s.count));
    }
    return m;
}

/* In the order that is asked for, or seen: a pair that does not match, or whose votes say so, is
 * tried the other way round. */
matches match_in_any(const pair &p, const refocus_stereo_params *params, const rf_ximgproc *contrib)
{
    bool turned = params->order == REFOCUS_STEREO_RIGHT_FIRST;
    matches m = match_in_order(turned ? mirrored(p) : p, params, contrib);

    if (params->order == REFOCUS_STEREO_ORDER_SEEN &&
        (m.status || m.order <= -REFOCUS_STEREO_ORDER_SURE)) {
        const matches other = match_in_order(mirrored(p), params, contrib);

        turned = !other.status && other.order >= REFOCUS_STEREO_ORDER_SURE;
        if (turned)
            m = other;
        else
            m.order = 0; /* neither order is confirmed */
    }
    if (turned && !m.status) {
        cv::flip(m.disparity, m.disparity, 1);
        m.apart.turn = -m.apart.turn;
        m.order = -m.order;
    }
    return m;
}

/* As far as the caller's struct goes; there may be none. */
int write_report(refocus_stereo_report *report, const refocus_stereo_report *own)
{
    return report ? refocus_struct_write(report, REFOCUS_SIZE_TO(refocus_stereo_report, matched),
                                         own, sizeof *own)
                  : (int)REFOCUS_OK;
}

int stereo(const refocus_image *left, const refocus_image *right,
           const refocus_stereo_params *params, float *out, refocus_stereo_report *report,
           refocus_cv_reason *reason)
{
    const double scale =
        std::max(1.0, std::max(left->width, left->height) / (double)params->max_side);
    const cv::Size size(std::max(1, cvRound(left->width / scale)),
                        std::max(1, cvRound(left->height / scale)));
    const rf_ximgproc *const contrib =
        params->method == REFOCUS_STEREO_WLS ? rf_opencv_ximgproc() : nullptr;
    cv::Mat full;

    if (params->method == REFOCUS_STEREO_WLS && !contrib)
        return refocus_cv::fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                "the module refocus-ximgproc.so is not there; build it with "
                                "-Dximgproc=enabled, or match without it");
    const matches m = match_in_any(load(left, right, size), params, contrib);
    if (m.status)
        return refocus_cv::fail(reason, m.status, m.why.c_str());
    cv::resize(m.disparity * scale, full, cv::Size(left->width, left->height), 0, 0,
               cv::INTER_NEAREST);
    double least = 0, greatest = 0;
    cv::minMaxLoc(full, &least, &greatest, nullptr, nullptr, full == full);
    if (greatest - least < 1)
        return refocus_cv::fail(reason, REFOCUS_ERR_NO_DEPTH,
                                "nothing lies nearer than anything else: the two pictures show no "
                                "more than one shift; give a left and a right one");
    for (int y = 0; y < full.rows; y++)
        std::copy_n(full.ptr<float>(y), full.cols, out + (size_t)y * (size_t)full.cols);
    const refocus_stereo_report found = {
        sizeof found, (float)(m.apart.down * scale), (float)least,       (float)greatest, m.matched,
        m.order,      (float)m.apart.turn,           (float)m.apart.grow};
    write_report(report, &found);
    return REFOCUS_OK;
}

} // namespace

int refocus_cv_stereo(const struct refocus_image *left, const struct refocus_image *right,
                      const struct refocus_stereo_params *params, float *disparity,
                      struct refocus_stereo_report *report, struct refocus_cv_reason *reason)
{
    struct refocus_image own_left, own_right;
    struct refocus_stereo_params own;
    const struct refocus_stereo_report none = refocus_stereo_report_default();
    int status = refocus_image_read(&own_left, left);

    if (status == REFOCUS_OK)
        status = refocus_image_read(&own_right, right);
    if (status == REFOCUS_OK)
        status = refocus_struct_read(&own, sizeof own,
                                     REFOCUS_SIZE_TO(struct refocus_stereo_params, method), params);
    if (status != REFOCUS_OK)
        return refocus_cv::fail(reason, status, "not two pictures of a known size of struct");
    if (write_report(report, &none) != REFOCUS_OK)
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT,
                                "the report is not of a known size of struct");
    left = &own_left;
    right = &own_right;
    params = &own;
    if (!refocus_cv::good_photo(left) || !refocus_cv::good_photo(right) || params->max_side < 64 ||
        params->method > REFOCUS_STEREO_WLS || params->order > REFOCUS_STEREO_ORDER_SEEN ||
        !disparity)
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "not two pictures");
    if (left->width != right->width || left->height != right->height)
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT,
                                "the two pictures differ in size; give a rectified pair");
    if (left->width < 64 || left->height < 32)
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT,
                                "the pictures are too small to be matched; give 64x32 or more");
    return refocus_cv::guarded(reason, REFOCUS_ERR_UNSUPPORTED, [&] {
        return stereo(left, right, params, disparity, report, reason);
    });
}
