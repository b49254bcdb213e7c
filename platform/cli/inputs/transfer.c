/* transfer.c: the curves by which photos of more than 8 bits store light. */
#include "inputs/transfer.h"

#include <refocus/image.h>
#include "inputs/input.h"

const struct option transfer_options[] = {
    {OPTION(OPTION_CHOICE, "--transfer", "CURVE", struct depth_settings, transfer),
     .words = transfer_words, .rare = true,
     .help = "how a photo of more than 8 bits stores light; default auto"},
    {OPTION(OPTION_NUMBER, "--white", "LIGHT", struct depth_settings, white), .least = 1 / 65536.0,
     .greatest = 65536,
     .help = "light of such a photo that is shown as white, cd/m2 with pq; what is brighter keeps "
             "its light out of focus; default 1, 203 with pq, 0.265 with hlg"},
    {.help = NULL},
};

const struct option_word transfer_words[] = {
    [REFOCUS_TRANSFER_DEFAULT] = {"auto", "sRGB of 16 bits, linear of floats"},
    [REFOCUS_TRANSFER_SRGB] = {"srgb", "sRGB"},
    [REFOCUS_TRANSFER_LINEAR] = {"linear", "light itself"},
    [REFOCUS_TRANSFER_BT709] = {"bt709", "the camera's curve of BT.709"},
    [REFOCUS_TRANSFER_PQ] = {"pq", "SMPTE ST 2084, 1 is 10,000 cd/m2"},
    [REFOCUS_TRANSFER_HLG] = {"hlg", "hybrid log-gamma, light of the scene"},
    [REFOCUS_TRANSFER_GAMMA] = {"gamma", "gamma 2.2"},
    {0}};
