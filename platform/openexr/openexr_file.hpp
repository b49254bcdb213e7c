/* openexr_file.hpp: the parts of an OpenEXR file in memory. */
#ifndef RF_OPENEXR_FILE_HPP
#define RF_OPENEXR_FILE_HPP

#include <cstring>
#include <memory>
#include <stdexcept>

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

extern "C" {
#include "bytes.h"
}

/* The bytes of a file as a stream. */
class OpenExrMemory : public Imf::IStream
{
  public:
    explicit OpenExrMemory(struct rf_bytes file) : IStream("photo"), file_(file)
    {
    }

    bool read(char c[], int n) override
    {
        if (n < 0 || static_cast<size_t>(n) > file_.size - at_)
            throw std::runtime_error("it ends too early; copy it again");
        std::memcpy(c, file_.data + at_, static_cast<size_t>(n));
        at_ += static_cast<size_t>(n);
        return at_ < file_.size;
    }

    uint64_t tellg() override
    {
        return at_;
    }

    void seekg(uint64_t position) override
    {
        if (position > file_.size)
            throw std::runtime_error("it ends too early; copy it again");
        at_ = static_cast<size_t>(position);
    }

  private:
    struct rf_bytes file_;
    size_t at_ = 0;
};

/* The parts of a file: pictures beside each other, or one. One alone may be deep, with several
 * samples a pixel, which InputFile flattens. */
class OpenExrFile
{
  public:
    explicit OpenExrFile(struct rf_bytes file)
        : memory_(file), parts_(memory_, 0) /* in this thread */
    {
        if (parts_.parts() == 1) {
            alone_memory_ = std::make_unique<OpenExrMemory>(file);
            alone_ = std::make_unique<Imf::InputFile>(*alone_memory_, 0);
        }
    }

    int count() const
    {
        return parts_.parts();
    }

    const Imf::Header &header(int part) const
    {
        return alone_ ? alone_->header() : parts_.header(part);
    }

    bool is_read(int part) const
    {
        return alone_ || !header(part).hasType() || !Imf::isDeepData(header(part).type());
    }

    bool is_complete(int part)
    {
        return alone_ ? alone_->isComplete() : parts_.partComplete(part);
    }

    void read(int part, const Imf::FrameBuffer &frame)
    {
        const Imath::Box2i &box = header(part).dataWindow();

        if (alone_) {
            alone_->setFrameBuffer(frame);
            alone_->readPixels(box.min.y, box.max.y);
        } else {
            Imf::InputPart input(parts_, part);

            input.setFrameBuffer(frame);
            input.readPixels(box.min.y, box.max.y);
        }
    }

  private:
    OpenExrMemory memory_;
    Imf::MultiPartInputFile parts_;
    std::unique_ptr<OpenExrMemory> alone_memory_;
    std::unique_ptr<Imf::InputFile> alone_;
};

#endif
