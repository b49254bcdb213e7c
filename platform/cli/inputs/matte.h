/* matte.h: the matte of a photo, out of a file of its own or the photo itself. */
#ifndef RF_CLI_MATTE_H
#define RF_CLI_MATTE_H

#include <stdbool.h>
#include <stdint.h>
#include <jansson.h>
#include <refocus/refocus.h>

/* Whether --matte takes the photo's own away. */
bool matte_is_none(const char *matte);

/* Make a matte of packed samples, which the caller frees, also after an error: of a map whose
 * greatest value is all subject, or of a file, whose white is. It has to have the photo's shape;
 * exit codes, and prints why. */
int matte_take(const struct refocus_depth_map *map, const char *name,
               const struct refocus_image *photo, uint16_t **samples,
               struct refocus_disparity *matte);
int matte_read(const char *file, const struct refocus_image *photo, uint16_t **samples,
               struct refocus_disparity *matte);

/* null, or the matte's file, size, and the parts of it that are subject, and mixed. */
json_t *matte_json(const char *name, const struct refocus_disparity *matte);

#endif
