/* capture.cpp: a camera of libcamera is configured, and its requests are queued and delivered as
 * frames. */
#include "capture.hpp"
#include "lens.hpp"

#include <cerrno>
#include <cmath>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

using namespace libcamera;

namespace refocus_libcamera
{

Capture::Capture(const char *name) : name_(name), ready_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
}

Capture::~Capture()
{
    close();
    if (ready_ >= 0)
        ::close(ready_);
}

int Capture::open(struct refocus_reason *reason)
{
    if (ready_ < 0)
        return rf_capture_fail_errno(reason, errno, "libcamera");
    manager_ = get_manager();
    if (!manager_)
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "libcamera does not start");
    camera_ = find_camera(*manager_, name_);
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

void Capture::close()
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

int Capture::get_mode(int index, struct refocus_source_mode *mode)
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

int Capture::start(struct refocus_source *source, struct refocus_source_mode *mode,
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
    const uint32_t focus =
        source->focused ? source->focus_mode : (uint32_t)REFOCUS_SOURCE_FOCUS_CONTINUOUS;
    ControlList controls(camera_->controls());
    for (const auto &control : focus_controls(camera_->controls(), focus, source->focus_position))
        controls.set(control.first, control.second);
    position_ = NAN;
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

void Capture::stop()
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

int Capture::wait(struct refocus_source *source, int64_t deadline_ns, struct refocus_frame **result,
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
                return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the camera is gone; plug it in");
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

void Capture::release(struct refocus_source *source, const struct refocus_frame *frame)
{
    mappings_[frame->buffer]->sync(false);
    requeue(source, requests_[frame->buffer].get());
}

int Capture::set_control(const char *name, double value, struct refocus_reason *reason)
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
            return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED, "'%.60s' is not one number",
                                   name);
        }
        return REFOCUS_OK;
    }
    return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "it has no control '%.60s'", name);
}

bool Capture::has(const ControlId &control) const
{
    return has_control(camera_->controls(), control);
}

int Capture::get_lens(struct refocus_source_lens *lens, struct refocus_reason *reason)
{
    if (!camera_)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the camera is gone");
    describe_lens(camera_->controls(), lens);
    lens->position = position_;
    return REFOCUS_OK;
}

int Capture::set_focus(uint32_t mode, double position, struct refocus_reason *reason)
{
    if (!camera_)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the camera is gone");
    std::lock_guard<std::mutex> guard(lock_);
    for (const auto &control : focus_controls(camera_->controls(), mode, position))
        wanted_[control.first] = control.second;
    return REFOCUS_OK;
}

/* Exposure, gain and colour gains stay as they were when their algorithms stop. */
int Capture::lock_exposure(bool lock, struct refocus_reason *reason)
{
    if (!camera_)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the camera is gone");
    if (!has(controls::AeEnable) && !has(controls::AwbEnable))
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "it has no exposure that can be locked");
    std::lock_guard<std::mutex> guard(lock_);
    if (has(controls::AeEnable))
        wanted_[controls::AeEnable.id()] = ControlValue(!lock);
    if (has(controls::AwbEnable))
        wanted_[controls::AwbEnable.id()] = ControlValue(!lock);
    return REFOCUS_OK;
}

int Capture::configure(const struct refocus_source_config &wanted, struct refocus_reason *reason)
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
        return rf_capture_fail(
            reason, REFOCUS_ERR_UNSUPPORTED, "the camera gives %.30s where %s was asked for",
            stream.pixelFormat.toString().c_str(),
            wanted.format ? refocus_frame_format_name(wanted.format) : "a known format");
    const int error = camera_->configure(config_.get());
    if (error != 0)
        return rf_capture_fail_errno(reason, -error, "setting the camera's format");
    return REFOCUS_OK;
}

int Capture::allocate(struct refocus_reason *reason)
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

/* False for a request that brings no frame. */
bool Capture::deliver(Request *request, struct refocus_frame **result)
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
    *frame = refocus_frame_default();
    frame->format = format_of(stream.pixelFormat);
    frame->width = (int32_t)stream.size.width;
    frame->height = (int32_t)stream.size.height;
    if (!mappings_[n]->lay_out(*buffer, (int64_t)stream.stride, frame))
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
        position_ = frame->lens_dioptres = *lens;
    mappings_[n]->sync(true);
    *result = frame;
    return true;
}

void Capture::requeue(struct refocus_source *source, Request *request)
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

/* It runs in a thread of libcamera. */
void Capture::completed(Request *request)
{
    if (request->status() == Request::RequestCancelled)
        return;
    std::lock_guard<std::mutex> guard(lock_);
    done_.push_back(request);
    wake();
}

void Capture::disconnected()
{
    std::lock_guard<std::mutex> guard(lock_);
    gone_ = true;
    wake();
}

void Capture::wake()
{
    const uint64_t one = 1;
    if (write(ready_, &one, sizeof one) < 0)
        return; /* full: it is readable all the same */
}

} // namespace refocus_libcamera
