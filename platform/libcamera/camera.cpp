/* camera.cpp: cameras by libcamera, behind the C functions of a source. No exception gets out. */
#include <exception>
#include <memory>
#include <new>

#include "capture.hpp"

namespace
{

using refocus_libcamera::Capture;

/* Run something that may throw; what it throws becomes a status. */
template <typename Work> int guarded(struct refocus_reason *reason, Work work) noexcept
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

int get_lens(struct refocus_source *source, struct refocus_source_lens *lens,
             struct refocus_reason *reason)
{
    return guarded(reason, [&] { return of(source)->get_lens(lens, reason); });
}

int set_focus(struct refocus_source *source, uint32_t mode, double position,
              struct refocus_reason *reason)
{
    return guarded(reason, [&] { return of(source)->set_focus(mode, position, reason); });
}

int lock_exposure(struct refocus_source *source, bool lock, struct refocus_reason *reason)
{
    return guarded(reason, [&] { return of(source)->lock_exposure(lock, reason); });
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
        const auto manager = refocus_libcamera::get_manager();

        if (!manager)
            return (int)REFOCUS_OK;
        for (const auto &camera : manager->cameras()) {
            const auto model = camera->properties().get(libcamera::properties::Model);

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
    "libcamera",   REFOCUS_SOURCE_KIND_CAMERA,
    open_camera,   get_mode,
    start,         wait_frame,
    release,       stop,
    reopen,        set_control,
    close_camera,  list,
    get_lens,      set_focus,
    lock_exposure,
};
}
