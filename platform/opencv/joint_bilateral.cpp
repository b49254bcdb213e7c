/* joint_bilateral.cpp: joint bilateral upsampling: a pixel is the mean of the 5x5 samples around
 * it, weighted by nearness and likeness. What depends on its row or its column alone is computed
 * once; all else is a loop over a row, which compilers and OpenCV make vectors of. Rows are shared
 * out to OpenCV's threads. */
#include "joint_bilateral.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

namespace
{

enum { REACH = 2, TAPS = 2 * REACH + 1, CHANNELS = 3 };

/* Likeness is above 0: where no sample is like the pixel, nearness decides. */
const float least_likeness = 1e-9f;

/* Along one side of the photo: the samples around each pixel, clamped to the map, and how near
 * they are. */
struct Axis {
    cv::Mat1i sample;
    cv::Mat1f nearness;

    Axis(int pixels, int samples) : sample(TAPS, pixels), nearness(TAPS, pixels)
    {
        for (int tap = 0; tap < TAPS; tap++) {
            for (int x = 0; x < pixels; x++) {
                const double at = (x + 0.5) * samples / pixels - 0.5;
                const int around = (int)std::floor(at + 0.5) + tap - REACH;

                sample(tap, x) = std::min(std::max(around, 0), samples - 1);
                nearness(tap, x) = (float)std::exp(-(at - around) * (at - around) / 2);
            }
        }
    }
};

/* A row of the map, spread over the photo's width: for each tap a row of codes, and one of each
 * channel of the photo at the samples' middles. */
struct Spread {
    int y = -1;
    cv::Mat1s colour;
    cv::Mat1f codes;
};

class Upsampling
{
  public:
    Upsampling(const refocus_image &of, const refocus_disparity &by, float sigma)
        : photo(of), map(by), columns(of.width, by.width), rows(of.height, by.height),
          steepness((float)std::max(-1 / (2.0 * sigma * sigma), -1e30)), guide(CHANNELS, of.width),
          likeness(1, of.width), total(1, of.width), sum(1, of.width)
    {
        for (Spread &row : window) {
            row.colour.create(CHANNELS * TAPS, photo.width);
            row.codes.create(TAPS, photo.width);
        }
    }

    void make_row(int y, uint16_t *out)
    {
        const uint8_t *const rgb = pixels(y);

        for (int x = 0; x < photo.width; x++)
            for (int c = 0; c < CHANNELS; c++)
                guide(c, x) = rgb[CHANNELS * x + c];
        total = 0;
        sum = 0;
        for (int j = 0; j < TAPS; j++) {
            const Spread &row = meet(rows.sample(j, y));

            for (int i = 0; i < TAPS; i++)
                add(row, i, rows.nearness(j, y));
        }
        sum /= total;
        sum.convertTo(cv::Mat(1, photo.width, CV_16U, out), CV_16U);
    }

  private:
    const refocus_image &photo;
    const refocus_disparity &map;
    const Axis columns, rows;
    const float steepness;
    Spread window[TAPS]; /* row y of the map is at y mod TAPS */
    cv::Mat1s guide;
    cv::Mat1f likeness, total, sum;

    const uint8_t *pixels(int y) const
    {
        return static_cast<const uint8_t *>(photo.plane[0]) + y * photo.stride[0];
    }

    const Spread &meet(int y)
    {
        Spread &row = window[y % TAPS];

        if (row.y != y)
            spread(row, y);
        return row;
    }

    void spread(Spread &row, int y)
    {
        const uint8_t *const bytes = static_cast<const uint8_t *>(map.samples) + y * map.stride;
        const uint16_t *const words = reinterpret_cast<const uint16_t *>(bytes);
        const uint8_t *const rgb =
            pixels((int)((2 * y + 1) * (int64_t)photo.height / (2 * map.height)));

        row.y = y;
        for (int tap = 0; tap < TAPS; tap++) {
            for (int x = 0; x < photo.width; x++) {
                const int at = columns.sample(tap, x);
                const int64_t middle = (2 * at + 1) * (int64_t)photo.width / (2 * map.width);

                for (int c = 0; c < CHANNELS; c++)
                    row.colour(CHANNELS * tap + c, x) = rgb[CHANNELS * middle + c];
                row.codes(tap, x) = (float)(map.bits == 16 ? words[at] : 257 * bytes[at]);
            }
        }
    }

    /* Weigh one tap's samples for all pixels of the row. */
    void add(const Spread &row, int tap, float nearness_of_row)
    {
        const short *const r0 = guide[0], *const r1 = row.colour[CHANNELS * tap];
        const short *const g0 = guide[1], *const g1 = row.colour[CHANNELS * tap + 1];
        const short *const b0 = guide[2], *const b1 = row.colour[CHANNELS * tap + 2];
        const float *const nearness = columns.nearness[tap], *const codes = row.codes[tap];
        float *const like = likeness[0], *const weights = total[0], *const weighted = sum[0];

        for (int x = 0; x < photo.width; x++) {
            const short r = (short)(r0[x] - r1[x]), g = (short)(g0[x] - g1[x]);
            const short b = (short)(b0[x] - b1[x]);

            like[x] = (float)(r * r + g * g + b * b) * steepness;
        }
        cv::exp(likeness, likeness);
        for (int x = 0; x < photo.width; x++) {
            const float weight = nearness_of_row * nearness[x] * (like[x] + least_likeness);

            weights[x] += weight;
            weighted[x] += weight * codes[x];
        }
    }
};

} // namespace

void refocus_cv::joint_bilateral(const refocus_image &photo, const refocus_disparity &map,
                                 float sigma, uint16_t *out)
{
    const auto make_rows = [&](const cv::Range &range) {
        Upsampling upsampling(photo, map, sigma);

        for (int y = range.start; y < range.end; y++)
            upsampling.make_row(y, out + (size_t)y * (size_t)photo.width);
    };

    cv::parallel_for_(cv::Range(0, photo.height), make_rows, cv::getNumThreads());
}
