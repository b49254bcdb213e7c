/* apertures.h: the apertures of inputs. */
#ifndef RF_FUZZ_APERTURES_H
#define RF_FUZZ_APERTURES_H

#include <refocus/refocus.h>

#include "input.h"

/* The aperture that an input says, or NULL where there is none or it is refused; it is kept. `few`:
 * of openings one of a few. */
const struct refocus_aperture *take_aperture(struct input *in, int wild, int few);

#endif
