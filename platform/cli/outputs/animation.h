/* animation.h: frames become an animation, in the format that the end of the name says:
 *
 *     frames-%03d.png   a picture each: .png .jpg .ppm; counted from 0
 *     .y4m              YUV4MPEG2, 4:2:0
 *     .apng             animated PNG, repeated for ever
 *     .mp4 .gif .webm   by the ffmpeg program, where it is installed
 *
 * All of it is there in the end, or nothing.
 */
#ifndef RF_CLI_ANIMATION_H
#define RF_CLI_ANIMATION_H

#include <stdbool.h>
#include <refocus/image.h>

struct animation;

/* These return exit codes and print why it is not EXIT_DONE. */

/* Check before the work that such files can be written. */
int animation_check(const char *path, const char *const *inputs, int input_count);

int animation_open(struct animation **animation, const char *path, int width, int height,
                   double fps, int frames);

/* RGB8 of the size that was announced. */
int animation_write(struct animation *animation, const struct refocus_image *image);

/* Finish, or with `keep` false take everything away again. NULL is fine. */
int animation_close(struct animation *animation, bool keep);

#endif
