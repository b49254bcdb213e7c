/* read.h: pictures and maps of the caller, read once with their sizes and checked. */
#ifndef RF_IMAGE_READ_H
#define RF_IMAGE_READ_H

#include <refocus/image.h>

#include "support/log.h"

/*
 * A picture of any format of 8 bits and a map of disparities, `name` what the function that was
 * called names them. A log of NULL is silent.
 *
 * REFOCUS_OK, REFOCUS_ERR_ARGUMENT (NULL, a size, a stride, a plane), REFOCUS_ERR_UNSUPPORTED (a
 * field of a newer library).
 */
int rf_read_image(const struct rf_log *log, const char *name, struct refocus_image *own,
                  const struct refocus_image *given);
/* Does so with one of any format, deep ones too, where the other refuses these. */
int rf_read_any_image(const struct rf_log *log, const char *name, struct refocus_image *own,
                      const struct refocus_image *given);
int rf_read_map(const struct rf_log *log, const char *name, struct refocus_disparity *own,
                const struct refocus_disparity *given);

#endif
