/* openexr_channels.cpp: which channels of an OpenEXR file are the picture, and which is its depth.
 *
 * Channels may lie in layers: "R" or "ViewLayer.Combined.R"; colour and depth may be parts of their
 * own, as compositing programs write them. A file of a renderer has many layers in R, G and B, and
 * many in X, Y and Z that are directions or places. Depth is "Z" where Arnold and V-Ray write it,
 * "Depth.Z" of Blender's and Cycles' layers, "Depth.V" of Blender's compositor. */
#include "openexr_channels.hpp"

#include <algorithm>
#include <climits>
#include <initializer_list>

#include <ImfChannelList.h>

namespace
{

const int none = INT_MAX;

/* "ViewLayer.Depth." of "ViewLayer.Depth.Z"; empty: it lies in no layer. */
std::string layer_of(const std::string &name)
{
    return name.substr(0, name.rfind('.') + 1);
}

/* "depth" of "ViewLayer.Depth.": its last word, in small letters. */
std::string word_of(const std::string &layer)
{
    std::string word = layer.substr(0, layer.size() - (layer.empty() ? 0 : 1));

    word = word.substr(word.rfind('.') + 1);
    for (char &c : word)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return word;
}

bool has(const Imf::ChannelList &channels, const std::string &name)
{
    return channels.findChannel(name) != nullptr;
}

bool is_one_of(const std::string &word, std::initializer_list<const char *> words)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

/* How well a name is that of the red of the picture, 0 best: a channel of no layer, then layers and
 * parts of those names, then all others. */
int rank_red(const OpenExrFile &file, int part, const std::string &name)
{
    const Imf::Header &header = file.header(part);
    const Imf::ChannelList &channels = header.channels();
    const std::string layer = layer_of(name);
    const bool is_part = layer.empty() && file.count() > 1 && header.hasName();

    if (name != layer + "R" || !has(channels, layer + "G") || !has(channels, layer + "B"))
        return none;
    if (layer.empty() && !is_part)
        return 0;
    if (is_one_of(word_of(is_part ? header.name() + "." : layer),
                  {"combined", "beauty", "rgba", "rgb"}))
        return 1;
    return is_part ? 2 : 3;
}

/* Luminance beside Z is a picture, and Y beside X is not. */
int rank_grey(const OpenExrFile &file, int part, const std::string &name)
{
    const std::string layer = layer_of(name);

    if (name != layer + "Y" || has(file.header(part).channels(), layer + "X"))
        return none;
    return layer.empty() ? 0 : 1;
}

int rank_depth(const OpenExrFile &file, int part, const std::string &name)
{
    const Imf::ChannelList &channels = file.header(part).channels();
    const std::string layer = layer_of(name), word = word_of(layer), last = word_of(name + ".");

    if (name == layer + "Z") {
        if (has(channels, layer + "X") || (!layer.empty() && has(channels, layer + "Y")))
            return none; /* a direction or a place */
        return layer.empty()                             ? 0
               : word == "depth"                         ? 2
               : word.find("depth") != std::string::npos ? 3
                                                         : 4;
    }
    if (last == "depth")
        return layer.empty() ? 1 : 2;
    return name == layer + "V" && word == "depth" ? 2 : none;
}

using Rank = int (*)(const OpenExrFile &, int, const std::string &);

/* The channel of the least rank, the first of several; is_taken tells whether a part counts. */
template <typename Taken>
std::string find(const OpenExrFile &file, Rank rank, Taken is_taken, int *part)
{
    std::string found;
    int best = none;

    for (int i = 0; i < file.count(); i++) {
        const Imf::ChannelList &channels = file.header(i).channels();

        if (!file.is_read(i) || !is_taken(i))
            continue;
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            const int is = rank(file, i, channel.name());

            if (is < best) {
                best = is;
                found = channel.name();
                *part = i;
            }
        }
    }
    return found;
}

/* Whether two parts show the same pixels, of the left or of the right view. */
bool are_beside(const OpenExrFile &file, int part, int other)
{
    const Imf::Header &one = file.header(part), &two = file.header(other);

    return one.dataWindow() == two.dataWindow() &&
           (!one.hasView() || !two.hasView() || one.view() == two.view());
}

/* The name of the channel of a file that has one alone. */
std::string only_channel(const OpenExrFile &file)
{
    const Imf::ChannelList &channels = file.header(0).channels();
    auto only = channels.begin();

    if (file.count() != 1 || only == channels.end())
        return "";
    const std::string name = only.name();

    return ++only == channels.end() ? name : "";
}

} // namespace

OpenExrChannels choose_channels(const OpenExrFile &file, bool is_photo)
{
    OpenExrChannels chosen;
    const auto any = [](int) { return true; };
    const auto beside = [&](int part) {
        return !is_photo || are_beside(file, part, chosen.picture);
    };

    chosen.red = find(file, rank_red, any, &chosen.picture);
    if (chosen.red.empty()) {
        chosen.grey = find(file, rank_grey, any, &chosen.picture);
    } else {
        chosen.green = layer_of(chosen.red) + "G";
        chosen.blue = layer_of(chosen.red) + "B";
    }
    chosen.depth = find(file, rank_depth, beside, &chosen.depth_part);
    if (chosen.red.empty() && chosen.grey.empty() && chosen.depth.empty())
        chosen.grey = only_channel(file);
    return chosen;
}
