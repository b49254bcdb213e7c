/* transfer.c: the curves by which photos of more than 8 bits store light. */
#include "inputs/transfer.h"

#include <refocus/image.h>

const struct option_word transfer_words[] = {
    [REFOCUS_TRANSFER_DEFAULT] = {"auto", "sRGB of 16 bits, linear of floats"},
    [REFOCUS_TRANSFER_SRGB] = {"srgb", "sRGB"},
    [REFOCUS_TRANSFER_LINEAR] = {"linear", "light itself"},
    [REFOCUS_TRANSFER_BT709] = {"bt709", "the camera's curve of BT.709"},
    [REFOCUS_TRANSFER_PQ] = {"pq", "SMPTE ST 2084, 1 is 10,000 cd/m2"},
    [REFOCUS_TRANSFER_HLG] = {"hlg", "hybrid log-gamma, light of the scene"},
    [REFOCUS_TRANSFER_GAMMA] = {"gamma", "gamma 2.2"},
    {0}};
