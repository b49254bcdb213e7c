/* openexr_write.cpp: light in floats, or a picture of 8 bits by the curve of sRGB, becomes an
 * OpenEXR file in memory, packed without loss. */
#include "openexr.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

extern "C" {
#include "half.h"
}

namespace
{

class Memory : public Imf::OStream
{
  public:
    Memory() : OStream("picture")
    {
    }

    void write(const char c[], int n) override
    {
        const size_t end = at_ + static_cast<size_t>(n);

        if (end > bytes_.size())
            bytes_.resize(end);
        std::memcpy(bytes_.data() + at_, c, static_cast<size_t>(n));
        at_ = end;
    }

    uint64_t tellp() override
    {
        return at_;
    }

    void seekp(uint64_t position) override
    {
        at_ = static_cast<size_t>(position);
    }

    const std::vector<char> &bytes() const
    {
        return bytes_;
    }

  private:
    std::vector<char> bytes_;
    size_t at_ = 0;
};

float light_of(int code)
{
    const float value = static_cast<float>(code) / 255;

    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

/* A row of packed halves. */
void convert(uint16_t *to, const struct rf_rows *rows, const uint8_t *from, const uint16_t *half_of)
{
    const int bytes = rf_format_bytes(rows->format);
    const size_t samples = 3 * static_cast<size_t>(rows->width);
    const bool swapped =
        rows->format == REFOCUS_FORMAT_BGR8 || rows->format == REFOCUS_FORMAT_BGRA8;

    for (size_t i = 0; rows->format == REFOCUS_FORMAT_RGB_FLOAT && i < samples; i++) {
        float light;

        std::memcpy(&light, from + 4 * i, 4);
        to[i] = rf_half_of(light);
    }
    for (int32_t x = 0; rows->format != REFOCUS_FORMAT_RGB_FLOAT && x < rows->width; x++)
        for (int c = 0; c < 3; c++)
            to[3 * static_cast<size_t>(x) + static_cast<size_t>(c)] =
                half_of[from[static_cast<ptrdiff_t>(x) * bytes + (swapped ? 2 - c : c)]];
}

int run(struct refocus_blob *file, const struct rf_rows *rows)
{
    static const char *const names[] = {"R", "G", "B"};
    const size_t step = 6;
    std::vector<uint16_t> row(static_cast<size_t>(rows->width) * 3);
    std::vector<uint16_t> half_of(256);
    Imf::Header header(rows->width, rows->height);
    Imf::FrameBuffer frame;
    Memory memory;

    for (int code = 0; code < 256; code++)
        half_of[static_cast<size_t>(code)] = rf_half_of(light_of(code));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (size_t c = 0; c < 3; c++) {
        header.channels().insert(names[c], Imf::Channel(Imf::HALF));
        /* Each row of the picture lies in the same place. */
        frame.insert(names[c],
                     Imf::Slice(Imf::HALF, reinterpret_cast<char *>(row.data() + c), step, 0));
    }
    {
        Imf::OutputFile output(memory, header, 0); /* in this thread */

        output.setFrameBuffer(frame);
        for (int32_t y = 0; y < rows->height; y++) {
            convert(row.data(), rows, rows->top + y * rows->stride, half_of.data());
            output.writePixels(1);
        }
    }
    file->data = static_cast<uint8_t *>(std::malloc(memory.bytes().size()));
    if (!file->data)
        throw std::bad_alloc();
    std::memcpy(file->data, memory.bytes().data(), memory.bytes().size());
    file->size = memory.bytes().size();
    return REFOCUS_OK;
}

} // namespace

int rf_openexr_write(struct refocus_blob *file, const struct rf_rows *rows,
                     const struct rf_extras *extras, struct refocus_reason *reason)
{
    try {
        const int status = run(file, rows);

        if (extras->exif.size > 0 || extras->icc.size > 0 || extras->xmp.size > 0)
            rf_leave_out(reason, "EXIF, XMP and colour profile are not written into OpenEXR");
        return status;
    } catch (const std::bad_alloc &) {
        return rf_fail_memory(reason);
    } catch (const std::exception &error) {
        return rf_fail(reason, REFOCUS_ERR_IO, "the OpenEXR encoder gave up: %.150s", error.what());
    }
}

extern "C" {
__attribute__((visibility("default"))) extern const struct rf_codec rf_codec_openexr;
const struct rf_codec rf_codec_openexr = {RF_CODEC_VERSION, rf_openexr_read, rf_openexr_write};
}
