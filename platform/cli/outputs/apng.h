/* apng.h: animated PNG: the pictures of the PNG writer in one file, after the APNG specification.
 */
#ifndef RF_CLI_APNG_H
#define RF_CLI_APNG_H

#include <refocus/image.h>
#include <refocus/platform/file.h>

struct apng;

/* Status codes; reason has the words. apng_close() frees, whatever came before. */
int apng_open(struct apng **apng, const char *path, int width, int height, double fps, int frames,
              struct refocus_reason *reason);
int apng_write(struct apng *apng, const struct refocus_image *image, struct refocus_reason *reason);
void apng_take_away(const struct apng *apng); /* the file of a frame that is being written */
int apng_close(struct apng *apng, struct refocus_reason *reason);

#endif
