/* openexr_read.cpp: an OpenEXR file is read: its colour as linear light, its channel Z as depth in
 * metres. Depth is in R, G and B where tools know pictures alone. */
#include "openexr.hpp"
#include "openexr_channels.hpp"
#include "openexr_file.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <new>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>

namespace
{

/* Says which channels are taken, and which there are as far as a line goes. */
void tell(struct rf_read *read, const OpenExrFile &file, const std::string &taken)
{
    std::string names;

    for (int part = 0; part < file.count(); part++)
        for (auto i = file.header(part).channels().begin(); i != file.header(part).channels().end();
             ++i)
            names += std::string(names.empty() ? "" : " ") + i.name();
    rf_note(read->info, "OpenEXR: channels taken %.70s; of %.90s", taken.c_str(), names.c_str());
}

struct Window {
    int64_t x, y, width, height;

    explicit Window(const Imath::Box2i &box)
        : x(box.min.x), y(box.min.y), width(static_cast<int64_t>(box.max.x) - box.min.x + 1),
          height(static_cast<int64_t>(box.max.y) - box.min.y + 1)
    {
    }
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

/* Whether a part can be read into memory. */
int check_part(struct rf_read *read, OpenExrFile &file, int part)
{
    const Window window(file.header(part).dataWindow());
    int status;

    if (window.width < 1 || window.height < 1)
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged OpenEXR: it has no pixels");
    status = rf_check_size(read, static_cast<uint64_t>(window.width),
                           static_cast<uint64_t>(window.height), 3 * sizeof(float));
    if (status == REFOCUS_OK && !file.is_complete(part))
        status = rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                         "damaged OpenEXR: parts of it are missing; copy it again");
    return status;
}

int check_sampling(struct rf_read *read, const OpenExrFile &file, int part,
                   std::initializer_list<std::string> names)
{
    for (const auto &name : names)
        if (is_sampled(file.header(part).channels(), name))
            return rf_fail(
                read->reason, REFOCUS_ERR_UNSUPPORTED,
                "OpenEXR with channels of fewer samples is not read; save it as R, G, B");
    return REFOCUS_OK;
}

int decode_picture(struct rf_read *read, OpenExrFile &file, const OpenExrChannels &chosen)
{
    const Window window(file.header(chosen.picture).dataWindow());
    Imf::FrameBuffer frame;
    int status = check_part(read, file, chosen.picture);

    if (status == REFOCUS_OK)
        status = check_sampling(read, file, chosen.picture,
                                {chosen.red, chosen.green, chosen.blue, chosen.grey});
    if (status == REFOCUS_OK)
        status = alloc(read, &read->image, window, 3);
    if (status != REFOCUS_OK)
        return status;
    if (chosen.red.empty()) {
        add(frame, chosen.grey, &read->image, 0, window);
    } else {
        add(frame, chosen.red, &read->image, 0, window);
        add(frame, chosen.green, &read->image, 1, window);
        add(frame, chosen.blue, &read->image, 2, window);
    }
    file.read(chosen.picture, frame);
    if (chosen.red.empty())
        spread_grey(&read->image);
    return REFOCUS_OK;
}

int decode_depth(struct rf_read *read, OpenExrFile &file, int part, const std::string &channel)
{
    const Window window(file.header(part).dataWindow());
    Imf::FrameBuffer frame;
    int status = check_part(read, file, part);

    if (status == REFOCUS_OK)
        status = check_sampling(read, file, part, {channel});
    if (status == REFOCUS_OK)
        status = alloc(read, &read->samples, window, 1);
    if (status != REFOCUS_OK)
        return status;
    add(frame, channel, &read->samples, 0, window);
    file.read(part, frame);
    return REFOCUS_OK;
}

int decode(struct rf_read *read, OpenExrFile &file)
{
    const OpenExrChannels chosen = choose_channels(file, read->picture_always);
    const bool colour = !chosen.red.empty();
    const bool red_is_depth = !read->picture_always && colour && chosen.depth.empty();
    const bool picture = read->picture_always || red_is_depth;
    const bool grey_is_depth = !picture && chosen.depth.empty();
    const std::string depth = grey_is_depth ? chosen.grey : chosen.depth;
    int status = REFOCUS_OK;

    if (chosen.red.empty() && chosen.grey.empty() && chosen.depth.empty() && !file.is_read(0))
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "OpenEXR of several deep parts is not read; flatten it");
    if (picture && !colour && chosen.grey.empty())
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "OpenEXR without the channels R, G, B or Y: it is no photo; give it as the "
                       "depth");
    if (!picture && depth.empty())
        return rf_fail(read->reason, REFOCUS_ERR_NO_DEPTH,
                       "OpenEXR without a channel Z, and more than one other: it is no depth map");
    if (picture)
        status = decode_picture(read, file, chosen);
    if (status == REFOCUS_OK && !depth.empty())
        status =
            decode_depth(read, file, grey_is_depth ? chosen.picture : chosen.depth_part, depth);
    if (status == REFOCUS_OK && red_is_depth)
        status = take_red(read);
    if (status != REFOCUS_OK)
        return status;
    if (!chosen.depth.empty())
        mean_metres(read, chosen.depth);
    tell(read, file,
         (picture ? (colour ? chosen.red + " G B" : chosen.grey) : "") +
             (picture && !depth.empty() ? " " : "") + depth);
    return REFOCUS_OK;
}

} // namespace

int rf_openexr_read(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    (void)extras;
    try {
        OpenExrFile parts(file);

        return decode(read, parts);
    } catch (const std::bad_alloc &) {
        return rf_fail_memory(read->reason);
    } catch (const std::exception &error) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged OpenEXR: %.150s", error.what());
    } catch (...) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged OpenEXR");
    }
}
