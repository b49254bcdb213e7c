/* buffers.hpp: pixel formats of libcamera, and the memory that its frames lie in. */
#ifndef RF_LIBCAMERA_BUFFERS_HPP
#define RF_LIBCAMERA_BUFFERS_HPP

#include <map>
#include <utility>

#include <libcamera/libcamera.h>

#include "backend.h"

namespace refocus_libcamera
{

/* enum refocus_frame_format; REFOCUS_FRAME_ANY for those that are not ours. */
uint32_t format_of(const libcamera::PixelFormat &format);

/* The memories of one buffer, mapped. Planes may share a descriptor. */
class Mapping
{
  public:
    Mapping() = default;
    Mapping(const Mapping &) = delete;
    Mapping &operator=(const Mapping &) = delete;
    ~Mapping();

    /* False, and why is in errno. */
    bool map(const libcamera::FrameBuffer &buffer);

    /* Called before and after the processor reads. */
    void sync(bool begin) const;

    /* Point the frame's planes into the buffer; false when they do not fit into it.
     * Format and size of the frame are set already. */
    bool lay_out(const libcamera::FrameBuffer &buffer, int64_t stride,
                 struct refocus_frame *frame) const;

  private:
    std::map<int, std::pair<uint8_t *, size_t>> memory_; /* by descriptor */
};

} // namespace refocus_libcamera

#endif
