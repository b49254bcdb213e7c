/* misuse_opencv.c: misuse of depth by OpenCV. */
#include "misuse.h"

#include <refocus/platform/opencv.h>

static uint16_t out[W * H];
static const char *const no_model = "misuse-of-opencv.onnx";

static struct refocus_network network_of(void)
{
    struct refocus_network network = TAKES_NOTHING(refocus_network_default);

    ANSWERS(REFOCUS_OK, refocus_cv_network, 0, &network);
    return network;
}

static void use_photo(const struct refocus_image *photo)
{
    const struct refocus_stereo_params stereo = refocus_stereo_params_default();
    const struct refocus_network network = network_of();
    const struct refocus_image good = misuse_photo();
    const struct refocus_disparity map = misuse_map();
    struct refocus_estimate estimate = refocus_estimate_default();
    float disparity[1];

    REFUSED(refocus_cv_stereo, photo, &good, &stereo, disparity, NULL, NULL);
    REFUSED(refocus_cv_stereo, &good, photo, &stereo, disparity, NULL, NULL);
    REFUSED(refocus_cv_estimate, photo, no_model, &network, &estimate, NULL);
    REFUSED(refocus_cv_upsample, photo, &map, 25, out, NULL);
    REFUSED(refocus_cv_upsample_by, REFOCUS_CV_BILINEAR, photo, &map, out, NULL);
}

static void use_map(const struct refocus_disparity *map)
{
    const struct refocus_image photo = misuse_photo();

    REFUSED(refocus_cv_upsample, &photo, map, 25, out, NULL);
    REFUSED(refocus_cv_upsample_by, REFOCUS_CV_BILINEAR, &photo, map, out, NULL);
}

static void stereo_pairs(void)
{
    const struct misuse bad[] = {
        BAD(refocus_stereo_params, struct_size, 0), BAD(refocus_stereo_params, max_side, INT32_MIN),
        BAD(refocus_stereo_params, max_side, 0), BAD(refocus_stereo_params, method, UINT32_MAX),
        BAD(refocus_stereo_params, order, 3)};
    static uint8_t pixels[3 * 64 * 32];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, 64, 32, 3 * 64);
    const struct refocus_stereo_params good = TAKES_NOTHING(refocus_stereo_params_default);
    const struct misuse no_size = BAD(refocus_stereo_report, struct_size, 0);
    struct refocus_stereo_report report = TAKES_NOTHING(refocus_stereo_report_default);
    static float disparity[64 * 32];

    misuse_spoil(&report, &no_size);
    REFUSED(refocus_cv_stereo, &photo, &photo, &good, disparity, &report, NULL);
    misuse_spoil(NULL, NULL);
    REFUSED(refocus_cv_stereo, &photo, &photo, NULL, disparity, NULL, NULL);
    REFUSED(refocus_cv_stereo, &photo, &photo, &good, NULL, NULL, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct refocus_stereo_params params = good;

        misuse_spoil(&params, &bad[i]);
        REFUSED(refocus_cv_stereo, &photo, &photo, &params, disparity, NULL, NULL);
    }
    misuse_spoil(NULL, NULL);
}

static void networks(void)
{
    const struct misuse bad[] = {
        BAD(refocus_network, width, 0), BAD(refocus_network, width, INT32_MAX),
        BAD(refocus_network, height, INT32_MIN), BAD(refocus_network, scale, NAN),
        BAD(refocus_network, struct_size, 0)};
    const struct misuse no_size = BAD(refocus_estimate, struct_size, 0);
    struct refocus_network network = network_of();
    const struct refocus_image photo = misuse_photo();
    struct refocus_network unsized_network;
    struct refocus_estimator *estimator = NULL;
    struct refocus_estimate estimate = TAKES_NOTHING(refocus_estimate_default);
    struct refocus_estimate unsized_estimate = estimate;

    GIVES_NULL(refocus_cv_network_name, UINT32_MAX);
    REFUSED(refocus_cv_network, UINT32_MAX, &network);
    REFUSED(refocus_cv_network, 0, NULL);
    REFUSED(refocus_cv_network_fit, NULL, no_model, NULL);
    REFUSED(refocus_cv_network_fit, &network, NULL, NULL);
    ANSWERS(REFOCUS_ERR_IO, refocus_cv_network_fit, &network, no_model, NULL);
    REFUSED(refocus_cv_estimate, &photo, NULL, &network, &estimate, NULL);
    REFUSED(refocus_cv_estimate, &photo, no_model, NULL, &estimate, NULL);
    REFUSED(refocus_cv_estimate, &photo, no_model, &network, NULL, NULL);
    REFUSED(refocus_cv_estimator_create, NULL, no_model, &network, NULL);
    REFUSED(refocus_cv_estimator_create, &estimator, NULL, &network, NULL);
    REFUSED(refocus_cv_estimator_create, &estimator, no_model, NULL, NULL);
    for (size_t i = 0; i < COUNT(bad); i++) {
        network = network_of();
        misuse_spoil(&network, &bad[i]);
        REFUSED(refocus_cv_estimator_create, &estimator, no_model, &network, NULL);
    }
    misuse_spoil(NULL, NULL);
    REFUSED(refocus_cv_estimator_run, NULL, &photo, &estimate, NULL);
    REFUSED(refocus_cv_estimator_run, NULL, &photo, NULL, NULL);
    network = network_of();
    unsized_network = network;
    unsized_network.struct_size = 0;
    REFUSED(refocus_cv_network, 0, &unsized_network);
    REFUSED(refocus_cv_network_fit, &unsized_network, no_model, NULL);
    misuse_spoil(&unsized_estimate, &no_size);
    REFUSED(refocus_cv_estimate, &photo, no_model, &network, &unsized_estimate, NULL);
    REFUSED(refocus_cv_estimator_run, NULL, &photo, &unsized_estimate, NULL);
    RETURNS(refocus_cv_estimate_free, &unsized_estimate);
    misuse_spoil(NULL, NULL);
    RETURNS(refocus_cv_estimator_destroy, NULL);
    RETURNS(refocus_cv_estimator_destroy, &estimator);
    RETURNS(refocus_cv_estimate_free, NULL);
    RETURNS(refocus_cv_estimate_free, &estimate);
}

void misuse_opencv(void **state)
{
    const struct refocus_image photo = misuse_photo();
    const struct refocus_disparity map = misuse_map();

    (void)state;
    misuse_images(use_photo);
    misuse_maps(use_map);
    stereo_pairs();
    networks();
    REFUSED(refocus_cv_upsample, &photo, &map, 0, out, NULL);
    REFUSED(refocus_cv_upsample, &photo, &map, NAN, out, NULL);
    REFUSED(refocus_cv_upsample, &photo, &map, 25, NULL, NULL);
    GIVES_NULL(refocus_cv_filter_name, UINT32_MAX);
    REFUSED(refocus_cv_upsample_by, UINT32_MAX, &photo, &map, out, NULL);
    REFUSED(refocus_cv_upsample_by, REFOCUS_CV_BILINEAR, &photo, &map, NULL, NULL);
    misuse_done();
}
