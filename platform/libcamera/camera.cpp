/* Cameras by libcamera, behind the C face of a source. No exception gets out.
 *
 * Written for 0.0.3 and newer in the words that all of them understand; what a release cannot
 * do without is chosen here and nowhere else. */
#include <cerrno>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <vector>

#include <linux/dma-buf.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <libcamera/libcamera.h>
#include <libcamera/logging.h>

#include "backend.h"

#define RF_LIBCAMERA_VERSION                                                                \
    (LIBCAMERA_VERSION_MAJOR * 10000 + LIBCAMERA_VERSION_MINOR * 100 +                      \
     LIBCAMERA_VERSION_PATCH)
#if RF_LIBCAMERA_VERSION < 3
#error "libcamera 0.0.3 or newer is needed"
#endif

namespace {

using namespace libcamera;

/* libcamera allows one manager in a process, and ends the program when it still runs at the
 * end of main(): the sources that are open share it, and the last one stops it. */
std::mutex manager_lock;
std::weak_ptr<CameraManager> shared_manager;

std::shared_ptr<CameraManager> get_manager()
{
    std::lock_guard<std::mutex> guard(manager_lock);
    std::shared_ptr<CameraManager> manager = shared_manager.lock();

    if (manager)
        return manager;
    logSetTarget(LoggingTargetNone); /* what goes wrong is told in reasons */
    manager = std::shared_ptr<CameraManager>(new CameraManager, [](CameraManager *ended) {
        ended->stop();
        delete ended;
    });
    if (manager->start() != 0)
        return nullptr;
    shared_manager = manager;
    return manager;
}

uint32_t format_of(const PixelFormat &format)
{
    static const struct {
        PixelFormat theirs;
        uint32_t ours;
    } known[] = {
        {formats::NV12, REFOCUS_FRAME_NV12},     {formats::NV21, REFOCUS_FRAME_NV21},
        {formats::YUV420, REFOCUS_FRAME_YUV420}, {formats::YUYV, REFOCUS_FRAME_YUYV},
        {formats::UYVY, REFOCUS_FRAME_UYVY},     {formats::BGR888, REFOCUS_FRAME_RGB24},
        {formats::RGB888, REFOCUS_FRAME_BGR24},  {formats::XBGR8888, REFOCUS_FRAME_RGBX},
        {formats::XRGB8888, REFOCUS_FRAME_BGRX}, {formats::MJPEG, REFOCUS_FRAME_MJPEG},
        {formats::R8, REFOCUS_FRAME_GREY},
    };

    for (const auto &pair : known)
        if (pair.theirs == format)
            return pair.ours;
    return REFOCUS_FRAME_ANY;
}

/* The memories of one buffer. Planes may share a descriptor. */
struct Mapping {
    std::map<int, std::pair<uint8_t *, size_t>> memory; /* by descriptor */

    ~Mapping()
    {
        for (auto &m : memory)
            munmap(m.second.first, m.second.second);
    }

    bool map(const FrameBuffer &buffer)
    {
        std::map<int, size_t> sizes;

        for (const auto &plane : buffer.planes()) {
            const size_t end = (size_t)plane.offset + plane.length;
            size_t &size = sizes[plane.fd.get()];
            size = end > size ? end : size;
        }
        for (const auto &s : sizes) {
            void *at = mmap(nullptr, s.second, PROT_READ, MAP_SHARED, s.first, 0);
            if (at == MAP_FAILED)
                return false;
            memory[s.first] = {static_cast<uint8_t *>(at), s.second};
        }
        return true;
    }

    void sync(bool begin) const
    {
        for (const auto &m : memory) {
            struct dma_buf_sync sync = {};
            sync.flags = DMA_BUF_SYNC_READ | (begin ? DMA_BUF_SYNC_START : DMA_BUF_SYNC_END);
            while (ioctl(m.first, DMA_BUF_IOCTL_SYNC, &sync) != 0 && errno == EINTR)
                continue;
        }
    }
};

class Capture
{
public:
    explicit Capture(const char *name) : name_(name), ready_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
    {
    }

    ~Capture()
    {
        close();
        if (ready_ >= 0)
            ::close(ready_);
    }

    int open(struct refocus_reason *reason)
    {
        if (ready_ < 0)
            return rf_capture_fail_errno(reason, errno, "libcamera");
        manager_ = get_manager();
        if (!manager_)
            return rf_capture_fail(reason, REFOCUS_ERR_IO, "libcamera does not start");
        camera_ = find();
        if (!camera_) {
            manager_.reset();
            return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                                   "there is no such camera, or another program uses it; "
                                   "--list shows those that there are");
        }
        const int error = camera_->acquire();
        if (error != 0) {
            camera_.reset();
            manager_.reset();
            return rf_capture_fail_errno(reason, -error, "libcamera camera");
        }
        gone_ = false;
        camera_->requestCompleted.connect(this, &Capture::completed);
        camera_->disconnected.connect(this, &Capture::disconnected);
        return REFOCUS_OK;
    }

    void close()
    {
        stop();
        if (camera_) {
            camera_->requestCompleted.disconnect(this);
            camera_->disconnected.disconnect(this);
            camera_->release();
        }
        config_.reset();
        camera_.reset();
        manager_.reset();
    }

    int get_mode(int index, struct refocus_source_mode *mode)
    {
        std::unique_ptr<CameraConfiguration> config =
            camera_ ? camera_->generateConfiguration({StreamRole::Viewfinder}) : nullptr;

        if (!config || config->size() == 0)
            return REFOCUS_ERR_ARGUMENT;
        const StreamFormats &formats = config->at(0).formats();
        for (const PixelFormat &format : formats.pixelformats()) {
            if (format_of(format) == REFOCUS_FRAME_ANY)
                continue;
            for (const Size &size : formats.sizes(format))
                if (index-- == 0) {
                    mode->format = format_of(format);
                    mode->width = (int32_t)size.width;
                    mode->height = (int32_t)size.height;
                    return REFOCUS_OK;
                }
        }
        return REFOCUS_ERR_ARGUMENT;
    }

    int start(struct refocus_source *source, struct refocus_source_mode *mode,
              struct refocus_reason *reason)
    {
        int status = camera_ ? configure(source->config, reason)
                             : rf_capture_fail(reason, REFOCUS_ERR_GONE, "the camera is gone");

        if (status == REFOCUS_OK)
            status = allocate(reason);
        if (status != REFOCUS_OK) {
            stop();
            return status;
        }
        ControlList controls(camera_->controls());
        if (camera_->controls().find(controls::AfMode.id()) != camera_->controls().end())
            controls.set(controls::AfMode, controls::AfModeContinuous);
        int error = camera_->start(&controls);
        running_ = error == 0;
        for (auto &request : requests_)
            if (error == 0)
                error = camera_->queueRequest(request.get());
        if (error != 0) {
            stop();
            return rf_capture_fail_errno(reason, error == -ENODEV ? ENODEV : EIO,
                                         "the camera does not start");
        }
        const StreamConfiguration &stream = config_->at(0);
        mode->format = format_of(stream.pixelFormat);
        mode->width = (int32_t)stream.size.width;
        mode->height = (int32_t)stream.size.height;
        mode->fps = source->config.fps;
        return REFOCUS_OK;
    }

    void stop()
    {
        if (running_)
            camera_->stop(); /* completes what is queued */
        running_ = false;
        {
            std::lock_guard<std::mutex> guard(lock_);
            done_.clear();
        }
        requests_.clear();
        mappings_.clear();
        allocator_.reset();
    }

    int wait(struct refocus_source *source, int64_t deadline_ns, struct refocus_frame **result,
             struct refocus_reason *reason)
    {
        for (;;) {
            uint64_t ignored;
            short events;
            Request *request = nullptr;

            {
                std::lock_guard<std::mutex> guard(lock_);
                if (!done_.empty()) {
                    request = done_.front();
                    done_.pop_front();
                } else if (gone_) {
                    return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                                           "the camera is gone; plug it in");
                }
            }
            if (request) {
                source->counters.dequeued++;
                if (deliver(request, result))
                    return REFOCUS_OK;
                requeue(source, request);
                continue;
            }
            const int status = rf_source_poll(source, ready_, POLLIN, deadline_ns, &events);
            if (status != REFOCUS_OK)
                return status;
            if (read(ready_, &ignored, sizeof ignored) < 0 && errno != EAGAIN)
                return rf_capture_fail_errno(reason, errno, "libcamera");
        }
    }

    void release(struct refocus_source *source, const struct refocus_frame *frame)
    {
        mappings_[frame->buffer]->sync(false);
        requeue(source, requests_[frame->buffer].get());
    }

    int set_control(const char *name, double value, struct refocus_reason *reason)
    {
        if (!camera_)
            return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the camera is gone");
        for (const auto &control : camera_->controls()) {
            if (control.first->name() != name)
                continue;
            std::lock_guard<std::mutex> guard(lock_);
            switch (control.first->type()) {
            case ControlTypeBool:
                wanted_[control.first->id()] = ControlValue(value != 0);
                break;
            case ControlTypeInteger32:
                wanted_[control.first->id()] = ControlValue((int32_t)std::lround(value));
                break;
            case ControlTypeInteger64:
                wanted_[control.first->id()] = ControlValue((int64_t)std::llround(value));
                break;
            case ControlTypeFloat:
                wanted_[control.first->id()] = ControlValue((float)value);
                break;
            default:
                return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                       "'%.60s' is not one number", name);
            }
            return REFOCUS_OK;
        }
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "it has no control '%.60s'", name);
    }

private:
    /* By identifier, else by number. */
    std::shared_ptr<Camera> find() const
    {
        std::shared_ptr<Camera> camera = manager_->get(name_);
        const auto cameras = manager_->cameras();

        if (camera || name_.empty() ||
            name_.find_first_not_of("0123456789") != std::string::npos || name_.size() > 4)
            return camera;
        const size_t n = (size_t)std::stoul(name_);
        return n < cameras.size() ? cameras[n] : nullptr;
    }

    int configure(const struct refocus_source_config &wanted, struct refocus_reason *reason)
    {
        config_ = camera_->generateConfiguration({StreamRole::Viewfinder});
        if (!config_ || config_->size() == 0)
            return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                   "the camera has no stream to look through");
        StreamConfiguration &stream = config_->at(0);
        if (wanted.width > 0 && wanted.height > 0)
            stream.size = Size((unsigned)wanted.width, (unsigned)wanted.height);
        for (const PixelFormat &format : stream.formats().pixelformats())
            if (wanted.format != REFOCUS_FRAME_ANY && format_of(format) == wanted.format)
                stream.pixelFormat = format;
        stream.bufferCount = (unsigned)wanted.buffers;
        if (config_->validate() == CameraConfiguration::Invalid)
            return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                   "the camera cannot be set to that size and format");
        const uint32_t format = format_of(stream.pixelFormat);
        if (format == REFOCUS_FRAME_ANY ||
            (wanted.format != REFOCUS_FRAME_ANY && format != wanted.format))
            return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                   "the camera gives %.30s where %s was asked for",
                                   stream.pixelFormat.toString().c_str(),
                                   wanted.format ? refocus_frame_format_name(wanted.format)
                                                 : "a known format");
        const int error = camera_->configure(config_.get());
        if (error != 0)
            return rf_capture_fail_errno(reason, -error, "setting the camera's format");
        return REFOCUS_OK;
    }

    int allocate(struct refocus_reason *reason)
    {
        Stream *stream = config_->at(0).stream();

        allocator_ = std::make_unique<FrameBufferAllocator>(camera_);
        const int error = allocator_->allocate(stream);
        if (error < 0)
            return rf_capture_fail_errno(reason, -error, "the camera's buffers");
        for (const auto &buffer : allocator_->buffers(stream)) {
            auto mapping = std::make_unique<Mapping>();
            auto request = camera_->createRequest(requests_.size());

            if (requests_.size() == RF_MOST_BUFFERS)
                break;
            if (!request || request->addBuffer(stream, buffer.get()) != 0)
                return rf_capture_fail_memory(reason);
            if (!mapping->map(*buffer))
                return rf_capture_fail_errno(reason, errno, "mapping the camera's buffers");
            mappings_.push_back(std::move(mapping));
            requests_.push_back(std::move(request));
        }
        if (requests_.size() < 2)
            return rf_capture_fail_memory(reason);
        return REFOCUS_OK;
    }

    /* Point the frame's planes into the buffer; false when they do not fit into it. */
    bool lay_out(const FrameBuffer &buffer, size_t n, struct refocus_frame *frame) const
    {
        const StreamConfiguration &stream = config_->at(0);
        const auto &planes = buffer.planes();
        const size_t wanted = (size_t)rf_format_planes(frame->format);

        if (planes.size() != 1 && planes.size() != wanted)
            return false;
        for (size_t i = 0; i < planes.size(); i++) {
            const auto &plane = planes[i];
            const int64_t stride =
                rf_plane_stride(frame->format, (int)i, (int64_t)stream.stride);
            const uint64_t needed =
                planes.size() == 1
                    ? rf_frame_bytes(frame->format, stride, frame->width, frame->height)
                    : (uint64_t)stride *
                          (uint64_t)rf_plane_rows(frame->format, (int)i, frame->height);

            if (frame->format != REFOCUS_FRAME_MJPEG && (needed == 0 || needed > plane.length))
                return false;
            frame->plane[i] = mappings_[n]->memory.at(plane.fd.get()).first + plane.offset;
            frame->stride[i] = (ptrdiff_t)stride;
            frame->dmabuf[i] = plane.fd.get();
        }
        if (frame->format != REFOCUS_FRAME_MJPEG && planes.size() == 1) {
            rf_frame_lay_out(frame, frame->plane[0], (int64_t)stream.stride);
            for (size_t i = 1; i < wanted; i++)
                frame->dmabuf[i] = frame->dmabuf[0];
        }
        return true;
    }

    /* False for a request that brings no frame. */
    bool deliver(Request *request, struct refocus_frame **result)
    {
        const size_t n = (size_t)request->cookie();
        const StreamConfiguration &stream = config_->at(0);
        const FrameBuffer *buffer = request->findBuffer(stream.stream());
        struct refocus_frame *frame = &frames_[n];

        if (request->status() != Request::RequestComplete || !buffer)
            return false;
        const FrameMetadata &metadata = buffer->metadata();
        if (metadata.status != FrameMetadata::FrameSuccess &&
            metadata.status != FrameMetadata::FrameError)
            return false;
        rf_frame_clear(frame);
        frame->format = format_of(stream.pixelFormat);
        frame->width = (int32_t)stream.size.width;
        frame->height = (int32_t)stream.size.height;
        if (!lay_out(*buffer, n, frame))
            return false;
        if (frame->format == REFOCUS_FRAME_MJPEG && !metadata.planes().empty())
            frame->bytes = metadata.planes()[0].bytesused;
        if (metadata.status == FrameMetadata::FrameError)
            frame->flags |= REFOCUS_FRAME_CORRUPT;
        if (stream.colorSpace) {
            if (stream.colorSpace->ycbcrEncoding == ColorSpace::YcbcrEncoding::Rec709)
                frame->matrix = REFOCUS_MATRIX_BT709;
            if (stream.colorSpace->range == ColorSpace::Range::Full)
                frame->flags |= REFOCUS_FRAME_FULL_RANGE;
        }
        frame->flags |= REFOCUS_FRAME_MONOTONIC;
        frame->sequence = metadata.sequence;
        frame->timestamp_ns = (int64_t)metadata.timestamp;
        frame->buffer = (uint32_t)n;
        const auto lens = request->metadata().get(controls::LensPosition);
        if (lens)
            frame->lens_dioptres = *lens;
        mappings_[n]->sync(true);
        *result = frame;
        return true;
    }

    void requeue(struct refocus_source *source, Request *request)
    {
        request->reuse(Request::ReuseBuffers);
        {
            std::lock_guard<std::mutex> guard(lock_);
            for (const auto &control : wanted_)
                request->controls().set(control.first, control.second);
            wanted_.clear();
        }
        if (camera_->queueRequest(request) == 0)
            source->counters.queued++;
    }

    /* In a thread of libcamera. */
    void completed(Request *request)
    {
        if (request->status() == Request::RequestCancelled)
            return;
        std::lock_guard<std::mutex> guard(lock_);
        done_.push_back(request);
        wake();
    }

    void disconnected()
    {
        std::lock_guard<std::mutex> guard(lock_);
        gone_ = true;
        wake();
    }

    void wake()
    {
        const uint64_t one = 1;
        if (write(ready_, &one, sizeof one) < 0)
            return; /* full: it is readable all the same */
    }

    std::string name_;
    int ready_; /* eventfd: something is in done_, or the camera is gone */
    std::shared_ptr<CameraManager> manager_;
    std::shared_ptr<Camera> camera_;
    std::unique_ptr<CameraConfiguration> config_;
    std::unique_ptr<FrameBufferAllocator> allocator_;
    std::vector<std::unique_ptr<Mapping>> mappings_;
    std::vector<std::unique_ptr<Request>> requests_;
    struct refocus_frame frames_[RF_MOST_BUFFERS];
    bool running_ = false;
    std::mutex lock_; /* of what follows */
    std::deque<Request *> done_;
    std::map<unsigned int, ControlValue> wanted_;
    bool gone_ = false;
};

/* Run something that may throw; what it throws becomes a status. */
template<typename Work>
int guarded(struct refocus_reason *reason, Work work) noexcept
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return rf_capture_fail_memory(reason);
    } catch (const std::exception &error) {
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "libcamera: %.180s", error.what());
    } catch (...) {
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "libcamera failed");
    }
}

Capture *of(struct refocus_source *source)
{
    return static_cast<Capture *>(source->state);
}

int open_camera(struct refocus_source *source, const char *rest, struct refocus_reason *reason)
{
    return guarded(reason, [&] {
        auto capture = std::make_unique<Capture>(rest);
        const int status = capture->open(reason);

        if (status == REFOCUS_OK)
            source->state = capture.release();
        return status;
    });
}

int get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    struct refocus_reason ignored;
    return guarded(&ignored, [&] { return of(source)->get_mode(index, mode); });
}

int start(struct refocus_source *source, struct refocus_source_mode *mode,
          struct refocus_reason *reason)
{
    return guarded(reason, [&] { return of(source)->start(source, mode, reason); });
}

int wait_frame(struct refocus_source *source, int64_t deadline_ns, struct refocus_frame **frame,
               struct refocus_reason *reason)
{
    return guarded(reason, [&] { return of(source)->wait(source, deadline_ns, frame, reason); });
}

void release(struct refocus_source *source, struct refocus_frame *frame)
{
    struct refocus_reason ignored;
    guarded(&ignored, [&] {
        of(source)->release(source, frame);
        return REFOCUS_OK;
    });
}

void stop(struct refocus_source *source)
{
    struct refocus_reason ignored;
    guarded(&ignored, [&] {
        of(source)->stop();
        return REFOCUS_OK;
    });
    source->counters.lost = source->counters.dequeued - source->counters.queued;
}

int reopen(struct refocus_source *source, struct refocus_reason *reason)
{
    return guarded(reason, [&] {
        of(source)->close();
        return of(source)->open(reason);
    });
}

int set_control(struct refocus_source *source, const char *name, double value,
                struct refocus_reason *reason)
{
    return guarded(reason, [&] { return of(source)->set_control(name, value, reason); });
}

void close_camera(struct refocus_source *source)
{
    struct refocus_reason ignored;
    guarded(&ignored, [&] {
        delete of(source);
        return REFOCUS_OK;
    });
}

int list(refocus_source_found *found, void *user)
{
    struct refocus_reason ignored;
    int n = 0;

    guarded(&ignored, [&] {
        const std::shared_ptr<CameraManager> manager = get_manager();

        if (!manager)
            return (int)REFOCUS_OK;
        for (const auto &camera : manager->cameras()) {
            const auto model = camera->properties().get(properties::Model);

            found(user, ("libcamera:" + camera->id()).c_str(),
                  model ? std::string(*model).c_str() : "");
            n++;
        }
        return (int)REFOCUS_OK;
    });
    return n;
}

} // namespace

extern "C" {
extern REFOCUS_API const struct rf_source_ops rf_source_libcamera;
const struct rf_source_ops rf_source_libcamera = {
    "libcamera", open_camera, get_mode, start,        wait_frame, release,
    stop,        reopen,      set_control, close_camera, list,
};
}
