/* Depth from one picture: a network that OpenCV runs. */
#include "guard.hpp"

#include <cmath>
#include <cstdlib>
#include <unistd.h>

#include <opencv2/dnn.hpp>

namespace {

/* Mean and deviation of ImageNet, as MiDaS and its followers want them. */
const float mean_r = 0.485f * 255, mean_g = 0.456f * 255, mean_b = 0.406f * 255;
const float scale = 1 / (0.226f * 255);

const struct {
    const char *name;
    refocus_network network;
} presets[] = {
    {"tcmonodepth", {320, 192, {0, 0, 0}, 1, 0}},
    {"midas-small", {256, 256, {mean_r, mean_g, mean_b}, scale, 0}},
    {"depth-anything-small", {518, 518, {mean_r, mean_g, mean_b}, scale, 0}},
};

/* The last two sides of the output are rows and columns. */
int take(const cv::Mat &output, bool inverse, refocus_estimate *estimate,
         refocus_cv_reason *reason)
{
    const int n = output.dims;
    const int height = n >= 2 ? output.size[n - 2] : 0, width = n >= 2 ? output.size[n - 1] : 0;

    if (output.type() != CV_32F || width < 2 || height < 2 ||
        output.total() != (size_t)width * (size_t)height)
        return refocus_cv::fail(reason, REFOCUS_ERR_FORMAT,
                                "the network does not give one map; give a depth network");
    estimate->samples = (float *)std::malloc(output.total() * sizeof(float));
    if (!estimate->samples)
        return refocus_cv::fail(reason, REFOCUS_ERR_MEMORY, "not enough memory");
    for (size_t i = 0; i < output.total(); i++)
        estimate->samples[i] = inverse ? -output.ptr<float>()[i] : output.ptr<float>()[i];
    estimate->width = width;
    estimate->height = height;
    return REFOCUS_OK;
}

int run(const refocus_image *photo, const char *model, const refocus_network *network,
        refocus_estimate *estimate, refocus_cv_reason *reason)
{
    cv::dnn::Net net = cv::dnn::readNetFromONNX(model);
    const cv::Scalar mean(network->mean[0], network->mean[1], network->mean[2]);

    if (net.empty())
        return refocus_cv::fail(reason, REFOCUS_ERR_FORMAT, "it holds no network");
    net.setInput(cv::dnn::blobFromImage(refocus_cv::view(photo), network->scale,
                                        cv::Size(network->width, network->height), mean, false));
    return take(net.forward(), network->inverse != 0, estimate, reason);
}

} // namespace

const char *refocus_cv_network_name(uint32_t index)
{
    return index < sizeof presets / sizeof *presets ? presets[index].name : nullptr;
}

int refocus_cv_network(uint32_t index, struct refocus_network *network)
{
    if (index >= sizeof presets / sizeof *presets || !network)
        return REFOCUS_ERR_ARGUMENT;
    *network = presets[index].network;
    return REFOCUS_OK;
}

int refocus_cv_estimate(const struct refocus_image *photo, const char *model,
                        const struct refocus_network *network, struct refocus_estimate *estimate,
                        struct refocus_cv_reason *reason)
{
    if (!estimate)
        return REFOCUS_ERR_ARGUMENT;
    *estimate = {nullptr, 0, 0};
    if (!refocus_cv::good_photo(photo) || !model || !network || network->width < 32 ||
        network->width > 2048 || network->height < 32 || network->height > 2048 ||
        !std::isfinite(network->scale))
        return refocus_cv::fail(reason, REFOCUS_ERR_ARGUMENT, "no picture, or no such input");
    if (access(model, R_OK) != 0)
        return refocus_cv::fail(reason, REFOCUS_ERR_IO, "it cannot be read; give an ONNX file");
    const int status = refocus_cv::guarded(
        reason, REFOCUS_ERR_FORMAT, [&] { return run(photo, model, network, estimate, reason); });
    if (status == REFOCUS_ERR_FORMAT)
        return refocus_cv::fail(reason, status,
                                "OpenCV finds no depth network with this input in it; give an "
                                "ONNX file and its --preset");
    return status;
}

void refocus_cv_estimate_free(struct refocus_estimate *estimate)
{
    if (!estimate)
        return;
    std::free(estimate->samples);
    *estimate = {nullptr, 0, 0};
}
