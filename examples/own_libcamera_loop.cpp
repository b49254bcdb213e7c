/* own_libcamera_loop.cpp: the library inside somebody else's libcamera program. The loop below is
 * theirs, and the three calls marked with arrows are all that is added. Frames are read where
 * libcamera put them. Prints the mean of each refocused frame.
 *
 *     own_libcamera_loop [FRAMES] */
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include <libcamera/libcamera.h>
#include <sys/mman.h>

#include <refocus/refocus.h>

using namespace libcamera;

static std::mutex lock;
static std::condition_variable arrived;
static std::deque<Request *> done;

static void completed(Request *request)
{
    std::lock_guard<std::mutex> guard(lock);
    if (request->status() == Request::RequestComplete)
        done.push_back(request);
    arrived.notify_one();
}

int main(int argc, char **argv)
{
    CameraManager manager;
    if (manager.start() != 0 || manager.cameras().empty()) {
        std::fprintf(stderr, "there is no camera\n");
        manager.stop();
        return 0;
    }
    {
        std::shared_ptr<Camera> camera = manager.cameras()[0];
        camera->acquire();
        auto config = camera->generateConfiguration({StreamRole::Viewfinder});
        StreamConfiguration &stream = config->at(0);
        stream.pixelFormat = formats::BGR888; /* bytes R, G, B */
        stream.size = Size(318, 240);
        config->validate();
        camera->configure(config.get());
        FrameBufferAllocator allocator(camera);
        allocator.allocate(stream.stream());
        std::vector<std::unique_ptr<Request>> requests;
        std::vector<uint8_t *> memory;
        for (const auto &buffer : allocator.buffers(stream.stream())) {
            const auto &plane = buffer->planes()[0];
            memory.push_back(static_cast<uint8_t *>(
                mmap(nullptr, plane.length, PROT_READ, MAP_SHARED, plane.fd.get(), 0)));
            requests.push_back(camera->createRequest(requests.size()));
            requests.back()->addBuffer(stream.stream(), buffer.get());
        }

        const int width = (int)stream.size.width, height = (int)stream.size.height;
        std::vector<uint16_t> samples((size_t)width * (size_t)height);
        for (int i = 0; i < width * height; i++) /* here: the lower, the nearer */
            samples[(size_t)i] = (uint16_t)(i / width * 65535 / height);
        std::vector<uint8_t> out(samples.size() * 3);
        struct refocus_renderer *renderer = nullptr;
        const auto make = refocus_renderer_params_default(width, height, 10);
        if (refocus_renderer_create(&renderer, &make) != REFOCUS_OK) /* <- */
            return 1;
        const auto disparity = refocus_disparity16(samples.data(), width, height, width * 2);
        const auto params = refocus_render_params_default(1, 10);
        const auto result =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, out.data(), width, height, width * 3);

        camera->requestCompleted.connect(completed);
        camera->start();
        for (auto &request : requests)
            camera->queueRequest(request.get());
        for (int n = argc > 1 ? std::atoi(argv[1]) : 10; n > 0; n--) {
            std::unique_lock<std::mutex> guard(lock);
            arrived.wait(guard, [] { return !done.empty(); });
            Request *request = done.front();
            done.pop_front();
            guard.unlock();
            const auto photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, memory[request->cookie()],
                                                    width, height, (ptrdiff_t)stream.stride);
            refocus_prepare(renderer, &photo, &disparity); /* <- */
            request->reuse(Request::ReuseBuffers);
            camera->queueRequest(request);
            refocus_render(renderer, &params, &result); /* <- */
            unsigned long sum = 0;
            for (const uint8_t v : out)
                sum += v;
            std::printf("%.2f\n", (double)sum / (double)out.size());
        }
        camera->stop();
        camera->requestCompleted.disconnect(completed);
        refocus_renderer_destroy(&renderer);
        camera->release();
    }
    manager.stop();
    return 0;
}
