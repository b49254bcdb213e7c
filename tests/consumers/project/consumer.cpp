/* consumer.cpp: refocus.hpp and, where OpenCV is, opencv.hpp: handles, exceptions, views. */
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>
#include <refocus/refocus.hpp>
#ifdef WITH_OPENCV
#include <refocus/platform/opencv.hpp>
#endif

static void expect(bool good, const char *what)
{
    if (!good) {
        std::printf("FAILED %s\n", what);
        std::exit(1);
    }
}

/* The status of the exception that a function throws, and whether its words hold some. */
template <class Function> static int thrown(Function function, const char *words)
{
    try {
        function();
    } catch (const refocus::error &error) {
        expect(std::strstr(error.what(), words) != nullptr, error.what());
        return error.status();
    }
    return REFOCUS_OK;
}

static const int width = 48, height = 32;

static std::vector<uint8_t> pattern()
{
    std::vector<uint8_t> pixels(3 * width * height);

    for (size_t i = 0; i < pixels.size(); i++)
        pixels[i] = static_cast<uint8_t>(i * i % 251);
    return pixels;
}

static std::vector<uint16_t> depths()
{
    std::vector<uint16_t> map(width * height);

    for (size_t i = 0; i < map.size(); i++)
        map[i] = i % width > 20 ? 60000 : 9000;
    return map;
}

static std::vector<uint8_t> render(const refocus_renderer_params &params)
{
    std::vector<uint8_t> pixels = pattern(), out(pixels.size());
    const std::vector<uint16_t> map = depths();
    const refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_BGR8, pixels.data(), width, height, 3 * width);
    refocus::renderer first(params), renderer(std::move(first));

    expect(!first.get(), "a renderer that was moved");
    renderer.prepare(photo, refocus_disparity16(map.data(), width, height, 2 * width));
    renderer.render(
        refocus_settings_default(0.9f, 6),
        refocus_image_packed(REFOCUS_FORMAT_BGR8, out.data(), width, height, 3 * width));
    expect(renderer.info().memory > 0, "info");
    expect(thrown([&] { renderer.render(refocus_settings_default(1.5f, 6), photo); },
                  "focus_disparity is 1.5") == REFOCUS_ERR_ARGUMENT,
           "words of a render");
    first = std::move(renderer);
    expect(first.get() != nullptr, "a renderer that was given back");
    return out;
}

int main()
{
    const refocus_renderer_params params = refocus_renderer_params_default(width, height, 6);
    const std::vector<uint8_t> out = render(params);

    expect(out != pattern(), "a picture");
    expect(thrown([] { refocus::renderer(0, 10, 5); }, "max_width") == REFOCUS_ERR_ARGUMENT,
           "words of a creation");
    expect(thrown([] { refocus::aperture(2); }, "") == REFOCUS_ERR_ARGUMENT, "an aperture");
    expect(thrown([&] { refocus::renderer(params).render(refocus_settings_default(0, 0), {}); },
                  "") < 0,
           "nothing is prepared");
    {
        refocus::aperture heart(7);
        refocus::temporal filter(refocus_temporal_params_default(width, height));
        std::vector<uint16_t> map = depths();

        filter.run(nullptr, refocus_disparity16(map.data(), width, height, 2 * width), map.data(),
                   2 * width);
        expect(map == depths(), "the first map of a video");
    }
#ifdef WITH_OPENCV
    std::vector<uint8_t> pixels = pattern();
    std::vector<uint16_t> map = depths();
    const cv::Mat photo(height, width, CV_8UC3, pixels.data());
    const cv::Mat disparity(height, width, CV_16UC1, map.data());
    const cv::Mat blurred = refocus::render(photo, disparity, 0.9f, 6);

    expect(blurred.isContinuous() && std::memcmp(blurred.data, out.data(), out.size()) == 0,
           "the same picture as a cv::Mat");
    cv::Mat wide(height, width + 9, CV_8UC3), part = wide(cv::Rect(4, 0, width, height));
    photo.copyTo(part);
    const cv::Mat again = refocus::render(part, disparity, 0.9f, 6);
    expect(std::memcmp(again.data, out.data(), out.size()) == 0, "a part of a cv::Mat");
    expect(refocus::bgr_image(part).plane[0] == part.data, "no copy");
    expect(refocus::rgb_image(cv::Mat(4, 4, CV_32FC3)).format == REFOCUS_FORMAT_RGB_FLOAT, "deep");
    expect(thrown([] { refocus::bgr_image(cv::Mat(4, 4, CV_64FC3)); }, "cv::Mat") ==
               REFOCUS_ERR_ARGUMENT,
           "another type");
    expect(thrown([] { refocus::disparity(cv::Mat(4, 4, CV_32FC1)); }, "CV_16UC1") ==
               REFOCUS_ERR_ARGUMENT,
           "another type of disparities");
#endif
    std::puts("C++ is fine");
    return 0;
}
