/* orient.c: a depth map that lies as the sensor did is turned as its photo was. */
#include <stdlib.h>
#include <string.h>
#include "inputs/orient.h"

const struct option_word orient_words[] = {
    {"auto", "a map on its side beside a photo that EXIF has turned is turned with it"},
    {"0", "as it is"},
    {"90", "a quarter turn"},
    {"180", "upside down"},
    {"270", "a quarter turn anticlockwise"},
    {0}};

int orient_choose(enum orient orient, bool on_its_side, int photo_orientation, bool turned_already)
{
    static const int asked[] = {1, 1, 6, 3, 8};

    if (orient != ORIENT_AUTO || !on_its_side || photo_orientation < 5)
        return asked[orient];
    return turned_already ? orient_back(photo_orientation) : photo_orientation;
}

int orient_back(int orientation)
{
    return orientation == 6 || orientation == 8 ? 14 - orientation : orientation;
}

bool orient_turn(void **samples, size_t bytes, int width, int height, int orientation)
{
    const bool exchanged = orientation >= 5;
    const int across = exchanged ? height : width, down = exchanged ? width : height;
    uint8_t *const turned = malloc((size_t)width * (size_t)height * bytes), *to = turned;

    if (!turned)
        return false;
    for (int y = 0; y < down; y++)
        for (int x = 0; x < across; x++, to += bytes) {
            int u = exchanged ? y : x, v = exchanged ? x : y;

            if (orientation == 3 || orientation == 7 || orientation == 8)
                u = width - 1 - u;
            if (orientation == 3 || orientation == 6 || orientation == 7)
                v = height - 1 - v;
            memcpy(to, (const uint8_t *)*samples + ((size_t)v * (size_t)width + (size_t)u) * bytes,
                   bytes);
        }
    free(*samples);
    *samples = turned;
    return true;
}
