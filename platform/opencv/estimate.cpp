/* estimate.cpp: depth is estimated from one picture by a network that OpenCV runs. */
#include "guard.hpp"
#include "onnx.h"

#include <cmath>
#include <cstdlib>
#include <memory>
#include <unistd.h>

#include <opencv2/dnn.hpp>

struct refocus_estimator {
    cv::dnn::Net net;
    refocus_network network;
};

namespace
{

/* The least struct_size of each. */
const size_t network_first = REFOCUS_SIZE_TO(refocus_network, inverse);
const size_t estimate_first = REFOCUS_SIZE_TO(refocus_estimate, samples);

/* Mean and deviation of ImageNet, as MiDaS and its followers want them. */
const float mean_r = 0.485f * 255, mean_g = 0.456f * 255, mean_b = 0.406f * 255;
const float scale = 1 / (0.226f * 255);

const struct {
    const char *name;
    refocus_network network;
} presets[] = {
    {"tcmonodepth", {sizeof(refocus_network), 320, 192, {0, 0, 0}, 1, 0}},
    {"midas-small", {sizeof(refocus_network), 256, 256, {mean_r, mean_g, mean_b}, scale, 0}},
    {"depth-anything-small",
     {sizeof(refocus_network), 518, 518, {mean_r, mean_g, mean_b}, scale, 0}},
};

/* No samples. Fails when the caller's struct is of no known size. */
int clear(refocus_estimate *estimate, refocus_cv_reason *reason)
{
    const refocus_estimate none = refocus_estimate_default();

    if (refocus_struct_write(estimate, estimate_first, &none, sizeof none))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT,
                                "the estimate is not of a known size of struct");
    return REFOCUS_OK;
}

int read_network(refocus_network *own, const refocus_network *network, refocus_cv_reason *reason)
{
    const int status = refocus_struct_read(own, sizeof *own, network_first, network);

    if (status != REFOCUS_OK)
        return refocus_cv::fail(reason, status, "the network is not of a known size of struct");
    return REFOCUS_OK;
}

/* The last two sides of the output are rows and columns. */
int take(const cv::Mat &output, bool inverse, refocus_estimate *estimate, refocus_cv_reason *reason)
{
    const int n = output.dims;
    const int height = n >= 2 ? output.size[n - 2] : 0, width = n >= 2 ? output.size[n - 1] : 0;

    if (output.type() != CV_32F || width < 2 || height < 2 ||
        output.total() != (size_t)width * (size_t)height)
        return refocus_cv::fail(reason, REFOCUS_ERR_FORMAT,
                                "the network does not give one map; give a depth network");
    refocus_estimate own = refocus_estimate_default();
    own.samples = (float *)std::malloc(output.total() * sizeof(float));
    if (!own.samples)
        return refocus_cv::fail(reason, REFOCUS_ERR_MEMORY, "not enough memory");
    for (size_t i = 0; i < output.total(); i++)
        own.samples[i] = inverse ? -output.ptr<float>()[i] : output.ptr<float>()[i];
    own.width = width;
    own.height = height;
    return refocus_struct_write(estimate, estimate_first, &own, sizeof own);
}

} // namespace

const char *refocus_cv_network_name(uint32_t index)
{
    return index < sizeof presets / sizeof *presets ? presets[index].name : nullptr;
}

int refocus_cv_network(uint32_t index, struct refocus_network *network)
{
    if (index >= sizeof presets / sizeof *presets)
        return REFOCUS_ERR_ARGUMENT;
    return refocus_struct_write(network, network_first, &presets[index].network,
                                sizeof presets[index].network);
}

int refocus_cv_network_fit(struct refocus_network *network, const char *model,
                           struct refocus_cv_reason *reason)
{
    struct refocus_network own;
    int width = 0, height = 0, status;
    FILE *file;

    if (!network || !model)
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no network, or no file");
    if ((status = read_network(&own, network, reason)))
        return status;
    file = std::fopen(model, "rb");
    if (!file)
        return refocus_cv::fail(reason, REFOCUS_ERR_IO, "it cannot be read; give an ONNX file");
    if (rf_onnx_input_size(file, &width, &height))
        width = height = 0;
    std::fclose(file);
    if ((width && (width < 32 || width > 2048)) || (height && (height < 32 || height > 2048)))
        return refocus_cv::fail(reason, REFOCUS_ERR_FORMAT,
                                "its input is not of 32 to 2048 pixels a side; give a depth "
                                "network");
    network->width = width ? width : own.width;
    network->height = height ? height : own.height;
    return REFOCUS_OK;
}

/* OpenCV's own words for a file that it cannot use name its source lines. */
static int fail_format(int status, refocus_cv_reason *reason)
{
    return status != REFOCUS_ERR_FORMAT
               ? status
               : refocus_cv::fail(reason, status,
                                  "OpenCV finds no depth network with this input in it; give an "
                                  "ONNX file and its --network");
}

int refocus_cv_estimator_create(struct refocus_estimator **result, const char *model,
                                const struct refocus_network *network,
                                struct refocus_cv_reason *reason)
{
    struct refocus_network own;
    int status;

    if (!result)
        return REFOCUS_ERR_ARGUMENT;
    *result = nullptr;
    if ((status = read_network(&own, network, reason)))
        return status;
    network = &own;
    if (!model || network->width < 32 || network->width > 2048 || network->height < 32 ||
        network->height > 2048 || !std::isfinite(network->scale))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no file, or no such input");
    if (access(model, R_OK) != 0)
        return refocus_cv::fail(reason, REFOCUS_ERR_IO, "it cannot be read; give an ONNX file");
    return fail_format(refocus_cv::guarded(reason, REFOCUS_ERR_FORMAT,
                                           [&] {
                                               auto estimator =
                                                   std::make_unique<refocus_estimator>();

                                               estimator->network = *network;
                                               estimator->net = cv::dnn::readNetFromONNX(model);
                                               if (estimator->net.empty())
                                                   return (int)REFOCUS_ERR_FORMAT;
                                               *result = estimator.release();
                                               return (int)REFOCUS_OK;
                                           }),
                       reason);
}

int refocus_cv_estimator_run(struct refocus_estimator *estimator, const struct refocus_image *photo,
                             struct refocus_estimate *estimate, struct refocus_cv_reason *reason)
{
    struct refocus_image own;
    int status = clear(estimate, reason);

    if (status != REFOCUS_OK)
        return status;
    status = refocus_image_read(&own, photo);
    if (status != REFOCUS_OK)
        return refocus_cv::fail(reason, status, "no picture of a known size of struct");
    photo = &own;
    if (!estimator || !refocus_cv::good_photo(photo))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no picture, or no network");
    return fail_format(
        refocus_cv::guarded(
            reason, REFOCUS_ERR_FORMAT,
            [&] {
                const refocus_network &network = estimator->network;
                const cv::Scalar mean(network.mean[0], network.mean[1], network.mean[2]);

                estimator->net.setInput(
                    cv::dnn::blobFromImage(refocus_cv::view(photo), network.scale,
                                           cv::Size(network.width, network.height), mean, false));
                return take(estimator->net.forward(), network.inverse != 0, estimate, reason);
            }),
        reason);
}

void refocus_cv_estimator_destroy(struct refocus_estimator **estimator)
{
    if (!estimator)
        return;
    delete *estimator;
    *estimator = nullptr;
}

int refocus_cv_estimate(const struct refocus_image *photo, const char *model,
                        const struct refocus_network *network, struct refocus_estimate *estimate,
                        struct refocus_cv_reason *reason)
{
    struct refocus_estimator *estimator;
    struct refocus_image own;
    int status;

    if ((status = clear(estimate, reason)))
        return status;
    if ((status = refocus_image_read(&own, photo)))
        return refocus_cv::fail(reason, status, "no picture of a known size of struct");
    if (!refocus_cv::good_photo(&own))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no picture");
    status = refocus_cv_estimator_create(&estimator, model, network, reason);
    if (status == REFOCUS_OK)
        status = refocus_cv_estimator_run(estimator, photo, estimate, reason);
    refocus_cv_estimator_destroy(&estimator);
    return status;
}

void refocus_cv_estimate_free(struct refocus_estimate *estimate)
{
    if (!estimate || estimate->struct_size < estimate_first)
        return;
    float *const samples = estimate->samples;
    if (clear(estimate, nullptr) == REFOCUS_OK)
        std::free(samples);
}
