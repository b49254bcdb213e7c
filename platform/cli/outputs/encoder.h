/* encoder.h: video files are written by the ffmpeg program, which takes raw frames from a pipe. */
#ifndef RF_CLI_ENCODER_H
#define RF_CLI_ENCODER_H

#include <stdbool.h>
#include <refocus/image.h>
#include <refocus/platform/file.h>

struct encoder;

/* Whether such a program is on the PATH. */
bool encoder_is_there(void);

/* Status codes; reason has the words. */
int encoder_open(struct encoder **encoder, const char *path, int width, int height, double fps,
                 struct refocus_reason *reason);
int encoder_write(struct encoder *encoder, const struct refocus_image *image,
                  struct refocus_reason *reason);

/* The program's process, or -1. */
long encoder_process(const struct encoder *encoder);

/* Ends the program, at once unless `finish`, and frees. */
int encoder_close(struct encoder *encoder, bool finish, struct refocus_reason *reason);

#endif
