/* capture.hpp: a camera of libcamera with its requests. Its functions may throw; camera.cpp turns
 * that into a status. */
#ifndef RF_LIBCAMERA_CAPTURE_HPP
#define RF_LIBCAMERA_CAPTURE_HPP

#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "buffers.hpp"
#include "manager.hpp"

namespace refocus_libcamera
{

class Capture
{
  public:
    explicit Capture(const char *name);
    Capture(const Capture &) = delete;
    Capture &operator=(const Capture &) = delete;
    ~Capture();

    int open(struct refocus_reason *reason);
    void close();
    int get_mode(int index, struct refocus_source_mode *mode);
    int start(struct refocus_source *source, struct refocus_source_mode *mode,
              struct refocus_reason *reason);
    void stop();
    int wait(struct refocus_source *source, int64_t deadline_ns, struct refocus_frame **result,
             struct refocus_reason *reason);
    void release(struct refocus_source *source, const struct refocus_frame *frame);
    int set_control(const char *name, double value, struct refocus_reason *reason);
    int get_lens(struct refocus_source_lens *lens, struct refocus_reason *reason);
    int set_focus(uint32_t mode, double position, struct refocus_reason *reason);
    int lock_exposure(bool lock, struct refocus_reason *reason);

  private:
    bool has(const libcamera::ControlId &control) const;
    int configure(const struct refocus_source_config &wanted, struct refocus_reason *reason);
    int allocate(struct refocus_reason *reason);
    bool deliver(libcamera::Request *request, struct refocus_frame **result);
    void requeue(struct refocus_source *source, libcamera::Request *request);
    /* These run in threads of libcamera. */
    void completed(libcamera::Request *request);
    void disconnected();
    void wake();

    std::string name_;
    int ready_; /* eventfd: something is in done_, or the camera is gone */
    std::shared_ptr<libcamera::CameraManager> manager_;
    std::shared_ptr<libcamera::Camera> camera_;
    std::unique_ptr<libcamera::CameraConfiguration> config_;
    std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
    std::vector<std::unique_ptr<Mapping>> mappings_;
    std::vector<std::unique_ptr<libcamera::Request>> requests_;
    struct refocus_frame frames_[RF_MOST_BUFFERS];
    bool running_ = false;
    float position_ = NAN; /* where the lens was in the last frame */
    std::mutex lock_;      /* guards the members below */
    std::deque<libcamera::Request *> done_;
    std::map<unsigned int, libcamera::ControlValue> wanted_;
    bool gone_ = false;
};

} // namespace refocus_libcamera

#endif
