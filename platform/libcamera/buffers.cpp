/* buffers.cpp: the memory of libcamera's buffers is mapped and described as frames. */
#include "buffers.hpp"

#include <cerrno>

#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

using namespace libcamera;

namespace refocus_libcamera
{

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

Mapping::~Mapping()
{
    for (auto &m : memory_)
        if (m.second.first)
            munmap(m.second.first, m.second.second);
}

bool Mapping::map(const FrameBuffer &buffer)
{
    std::map<int, size_t> sizes;

    for (const auto &plane : buffer.planes()) {
        const size_t end = (size_t)plane.offset + plane.length;
        size_t &size = sizes[plane.fd.get()];
        size = end > size ? end : size;
    }
    for (const auto &s : sizes) {
        auto &memory = memory_[s.first];
        void *at = mmap(nullptr, s.second, PROT_READ, MAP_SHARED, s.first, 0);

        if (at == MAP_FAILED)
            return false;
        memory = {static_cast<uint8_t *>(at), s.second};
    }
    return true;
}

void Mapping::sync(bool begin) const
{
    for (const auto &m : memory_) {
        struct dma_buf_sync sync = {};
        sync.flags = DMA_BUF_SYNC_READ | (begin ? DMA_BUF_SYNC_START : DMA_BUF_SYNC_END);
        while (ioctl(m.first, DMA_BUF_IOCTL_SYNC, &sync) != 0 && errno == EINTR)
            continue;
    }
}

bool Mapping::lay_out(const FrameBuffer &buffer, int64_t first_stride,
                      struct refocus_frame *frame) const
{
    const auto &planes = buffer.planes();
    const size_t wanted = (size_t)rf_format_planes(frame->format);

    if (planes.size() != 1 && planes.size() != wanted)
        return false;
    for (size_t i = 0; i < planes.size(); i++) {
        const auto &plane = planes[i];
        const int64_t stride = rf_plane_stride(frame->format, (int)i, first_stride);
        const uint64_t needed =
            planes.size() == 1
                ? rf_frame_bytes(frame->format, stride, frame->width, frame->height)
                : (uint64_t)stride * (uint64_t)rf_plane_rows(frame->format, (int)i, frame->height);

        if (frame->format != REFOCUS_FRAME_MJPEG && (needed == 0 || needed > plane.length))
            return false;
        frame->plane[i] = memory_.at(plane.fd.get()).first + plane.offset;
        frame->stride[i] = (ptrdiff_t)stride;
        frame->dmabuf[i] = plane.fd.get();
    }
    if (frame->format != REFOCUS_FRAME_MJPEG && planes.size() == 1) {
        rf_frame_lay_out(frame, frame->plane[0], first_stride);
        for (size_t i = 1; i < wanted; i++)
            frame->dmabuf[i] = frame->dmabuf[0];
    }
    return true;
}

} // namespace refocus_libcamera
