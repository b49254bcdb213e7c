/* openexr_read.cpp: an OpenEXR file is read: its colour as linear light, its channel Z as depth in
 * metres. Channels may lie in layers: "R" or "beauty.R". Depth is called "Depth.V" where Blender
 * writes what its compositor has, and is in R, G and B where tools know pictures alone. */
#include "openexr.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfPartType.h>

namespace
{

class Memory : public Imf::IStream
{
  public:
    explicit Memory(struct rf_bytes file) : IStream("photo"), file_(file)
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

/* The channels that are taken; empty: there is none. */
struct Chosen {
    std::string red, green, blue, grey, depth;
};

bool ends_in(const std::string &name, const std::string &end)
{
    return name == end ||
           (name.size() > end.size() + 1 &&
            name.compare(name.size() - end.size() - 1, std::string::npos, "." + end) == 0);
}

/* The first of that name, those without a layer before others. */
std::string find(const Imf::ChannelList &channels, const char *name)
{
    std::string found;

    if (channels.findChannel(name))
        return name;
    for (auto i = channels.begin(); i != channels.end() && found.empty(); ++i)
        if (ends_in(i.name(), name))
            found = i.name();
    return found;
}

Chosen choose(const Imf::ChannelList &channels)
{
    Chosen chosen;
    const std::string red = find(channels, "R");
    const std::string layer = red.empty() ? "" : red.substr(0, red.size() - 1);
    int count = 0;
    std::string only;

    if (!red.empty() && channels.findChannel(layer + "G") && channels.findChannel(layer + "B")) {
        chosen.red = red;
        chosen.green = layer + "G";
        chosen.blue = layer + "B";
    }
    chosen.grey = find(channels, "Y");
    for (const char *name : {"Z", "depth", "Depth", "Depth.V"})
        if (chosen.depth.empty())
            chosen.depth = find(channels, name);
    for (auto i = channels.begin(); i != channels.end(); ++i, ++count)
        only = i.name();
    if (chosen.grey.empty() && chosen.depth.empty() && count == 1)
        chosen.grey = only;
    return chosen;
}

/* Say which channels there are and which are taken, as far as a line goes. */
void tell(struct rf_read *read, const Imf::ChannelList &channels, const std::string &taken)
{
    std::string names;

    for (auto i = channels.begin(); i != channels.end(); ++i)
        names += std::string(names.empty() ? "" : " ") + i.name();
    rf_note(read->info, "OpenEXR: channels %.90s; taken %.30s", names.c_str(), taken.c_str());
}

struct Window {
    int64_t x, y, width, height;
};

void add(Imf::FrameBuffer &frame, const std::string &name, struct rf_raster *raster, int channel,
         const Window &window)
{
    const size_t step = static_cast<size_t>(raster->channels) * sizeof(float);
    const size_t stride = step * static_cast<size_t>(window.width);
    /* The address of the pixel (0, 0), which may lie outside. */
    const uintptr_t base =
        reinterpret_cast<uintptr_t>(raster->pixels) + static_cast<size_t>(channel) * sizeof(float) -
        static_cast<uintptr_t>(window.x) * step - static_cast<uintptr_t>(window.y) * stride;

    frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(base), step, stride));
}

bool is_sampled(const Imf::ChannelList &channels, const std::string &name)
{
    const Imf::Channel *const channel = name.empty() ? nullptr : channels.findChannel(name);

    return channel && (channel->xSampling != 1 || channel->ySampling != 1);
}

int alloc(struct rf_read *read, struct rf_raster *raster, const Window &window, int channels)
{
    raster->width = static_cast<int32_t>(window.width);
    raster->height = static_cast<int32_t>(window.height);
    raster->channels = channels;
    raster->sample = REFOCUS_SAMPLE_F32;
    raster->max_value = 0;
    return rf_raster_alloc(read, raster);
}

void spread_grey(struct rf_raster *raster)
{
    float *const light = reinterpret_cast<float *>(raster->pixels);
    const size_t pixels = static_cast<size_t>(raster->width) * static_cast<size_t>(raster->height);

    for (size_t i = 0; i < pixels; i++)
        light[3 * i + 1] = light[3 * i + 2] = light[3 * i];
}

/* Distances, nearest is least; renderers write very much for nothing at all, which is the far end,
 * and more than halves hold is infinite. */
void mean_metres(struct rf_read *read, const std::string &channel)
{
    float *const metres = reinterpret_cast<float *>(read->samples.pixels);
    const size_t count =
        static_cast<size_t>(read->samples.width) * static_cast<size_t>(read->samples.height);

    for (size_t i = 0; i < count; i++)
        metres[i] = std::min(metres[i], FLT_MAX); /* NaN stays */
    read->depth.meaning = REFOCUS_DEPTH_DISTANCE;
    read->depth.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    read->depth.metres_per_unit = 1.0;
    read->info->depth_source = REFOCUS_DEPTH_SOURCE_FILE;
    rf_note(read->info, "OpenEXR: channel %.40s, distances read as metres", channel.c_str());
}

/* A picture that was read for its depth: it is one if its channels are alike, or if the first alone
 * has values. */
int take_red(struct rf_read *read)
{
    float *const rgb = reinterpret_cast<float *>(read->image.pixels);
    const size_t pixels =
        static_cast<size_t>(read->image.width) * static_cast<size_t>(read->image.height);
    bool alike = true, alone = true;

    for (size_t i = 0; i < pixels && (alike || alone); i++) {
        alike = alike && std::memcmp(rgb + 3 * i, rgb + 3 * i + 1, 2 * sizeof *rgb) == 0;
        alone = alone && rgb[3 * i + 1] == 0 && rgb[3 * i + 2] == 0;
    }
    if (!alike && !alone)
        return rf_fail(read->reason, REFOCUS_ERR_NO_DEPTH,
                       "it is an OpenEXR picture in colour without a channel Z, not a depth map");
    for (size_t i = 0; i < pixels; i++)
        rgb[i] = rgb[3 * i];
    read->samples = read->image;
    read->samples.channels = 1;
    read->image.pixels = nullptr;
    return REFOCUS_OK;
}

int decode(struct rf_read *read, Imf::InputFile &input, const Window &window)
{
    const Imf::ChannelList &channels = input.header().channels();
    const Chosen chosen = choose(channels);
    const bool colour = !chosen.red.empty();
    const bool red_is_depth = !read->picture_always && colour && chosen.depth.empty();
    const bool picture = read->picture_always || red_is_depth;
    Imf::FrameBuffer frame;
    int status = REFOCUS_OK;

    if (picture && !colour && chosen.grey.empty())
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "OpenEXR without the channels R, G, B or Y: it is no photo; give it as the "
                       "depth");
    if (!picture && chosen.depth.empty() && chosen.grey.empty())
        return rf_fail(read->reason, REFOCUS_ERR_NO_DEPTH,
                       "OpenEXR without a channel Z, and more than one other: it is no depth map");
    for (const auto &name : {chosen.red, chosen.green, chosen.blue, chosen.grey, chosen.depth})
        if (is_sampled(channels, name))
            return rf_fail(
                read->reason, REFOCUS_ERR_UNSUPPORTED,
                "OpenEXR with channels of fewer samples is not read; save it as R, G, B");
    if (picture) {
        status = alloc(read, &read->image, window, 3);
        if (status == REFOCUS_OK && colour) {
            add(frame, chosen.red, &read->image, 0, window);
            add(frame, chosen.green, &read->image, 1, window);
            add(frame, chosen.blue, &read->image, 2, window);
        } else if (status == REFOCUS_OK) {
            add(frame, chosen.grey, &read->image, 0, window);
        }
    }
    const std::string depth = !chosen.depth.empty() ? chosen.depth : picture ? "" : chosen.grey;
    if (status == REFOCUS_OK && !depth.empty()) {
        status = alloc(read, &read->samples, window, 1);
        if (status == REFOCUS_OK)
            add(frame, depth, &read->samples, 0, window);
    }
    if (status != REFOCUS_OK)
        return status;
    input.setFrameBuffer(frame);
    input.readPixels(static_cast<int>(window.y), static_cast<int>(window.y + window.height - 1));
    if (red_is_depth)
        status = take_red(read);
    if (picture && !colour)
        spread_grey(&read->image);
    if (!chosen.depth.empty())
        mean_metres(read, chosen.depth);
    tell(read, channels,
         (picture ? (colour ? chosen.red + " " + chosen.green + " " + chosen.blue : chosen.grey)
                  : "") +
             (picture && !depth.empty() ? " " : "") + depth);
    return status;
}

int run(struct rf_read *read, struct rf_bytes file)
{
    Memory memory(file);
    Imf::InputFile input(memory, 0); /* in this thread */
    const Imath::Box2i &box = input.header().dataWindow();
    const Window window = {box.min.x, box.min.y, static_cast<int64_t>(box.max.x) - box.min.x + 1,
                           static_cast<int64_t>(box.max.y) - box.min.y + 1};
    int status;

    if (window.width < 1 || window.height < 1)
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged OpenEXR: it has no pixels");
    status = rf_check_size(read, static_cast<uint64_t>(window.width),
                           static_cast<uint64_t>(window.height), 3 * sizeof(float));
    if (status == REFOCUS_OK && !input.isComplete())
        status = rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                         "damaged OpenEXR: parts of it are missing; copy it again");
    return status == REFOCUS_OK ? decode(read, input, window) : status;
}

} // namespace

int rf_openexr_read(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    (void)extras;
    try {
        return run(read, file);
    } catch (const std::bad_alloc &) {
        return rf_fail_memory(read->reason);
    } catch (const std::exception &error) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged OpenEXR: %.150s", error.what());
    } catch (...) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged OpenEXR");
    }
}
