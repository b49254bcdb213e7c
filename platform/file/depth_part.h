/* depth_part.h: depth, confidence and original of a photo that lie in it as pictures of their own.
 */
#ifndef RF_FILE_DEPTH_PART_H
#define RF_FILE_DEPTH_PART_H

#include "bytes.h"
#include "reading.h"

/* Pixels of parts are limited in sum, before the first is decoded; parts may be empty. */
int rf_check_parts(const struct rf_read *read, const struct rf_bytes *parts, int count,
                   const char *what);
/* Decode a part to read->samples; a picture in colour is no depth. */
int rf_take_samples(struct rf_read *read, struct rf_bytes part, const char *what);
/* Whether a type of auxiliary picture is Apple's portrait matte, which holds hair and skin, too.
 * iOS 12 wrote it as a subtype. */
#define RF_MATTE_TYPE    "urn:com:apple:photo:2018:aux:portraiteffectsmatte"
#define RF_MATTE_SUBTYPE "portraiteffectsmatte"
bool rf_is_matte(const char *type);
/* Decode a part to read->matte, a grey picture. */
int rf_take_matte(struct rf_read *read, struct rf_bytes part, const char *what);
/* Decode a part to read->confidence, when it has the size of the samples: white is sure. */
int rf_take_confidence(struct rf_read *read, struct rf_bytes part, const char *what);
/* Decode a part to read->image: the main picture is the phone's blurred result. */
int rf_take_original(struct rf_read *read, struct rf_bytes part, const char *what);

#endif
