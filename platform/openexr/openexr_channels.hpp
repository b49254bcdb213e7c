/* openexr_channels.hpp: which channels of an OpenEXR file are the picture, and which is its depth.
 */
#ifndef RF_OPENEXR_CHANNELS_HPP
#define RF_OPENEXR_CHANNELS_HPP

#include <string>

#include "openexr_file.hpp"

/* The channels that are taken, and their parts; empty: there is none. */
struct OpenExrChannels {
    std::string red, green, blue, grey, depth;
    int picture = 0, depth_part = 0;
};

/* Chooses them. The depth of a photo has the pixels and the view of its picture. */
OpenExrChannels choose_channels(const OpenExrFile &file, bool is_photo);

#endif
