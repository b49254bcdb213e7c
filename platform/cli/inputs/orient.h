/* orient.h: a depth map that lies as the sensor did is turned as its photo was. */
#ifndef RF_CLI_ORIENT_H
#define RF_CLI_ORIENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "line/option.h"

enum orient { ORIENT_AUTO, ORIENT_0, ORIENT_90, ORIENT_180, ORIENT_270 };

/* Words of --orient-depth. */
extern const struct option_word orient_words[];

/* The EXIF orientation, 1 to 8, that turns a map as asked for. AUTO turns one that lies on its side
 * beside a photo by what has turned the photo, or back, where the reader has turned the map with
 * it. */
int orient_choose(enum orient orient, bool on_its_side, int photo_orientation, bool turned_already);

/* The EXIF orientation that turns back by what another one turns. */
int orient_back(int orientation);

/* Turn packed samples of any bytes by an EXIF orientation but 2 and 4, in new memory that takes
 * the place of the old; false without memory. The sides stay the caller's to exchange. */
bool orient_turn(void **samples, size_t bytes, int width, int height, int orientation);

#endif
