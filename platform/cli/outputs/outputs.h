/* Files that the command writes. */
#ifndef RF_CLI_OUTPUTS_H
#define RF_CLI_OUTPUTS_H

#include <stdint.h>
#include <refocus/image.h>
#include <refocus/platform/file.h>

/* Row of a table of options. */
#define OUTPUT_OPTION(type, member, text)                                                          \
    {                                                                                              \
        .kind = OPTION_TEXT, .letter = 'o', .elsewhere = true, .name = "--output",                 \
        .argument = "OUT", .offset = offsetof(type, member), .help = text                          \
    }

/* These return exit codes and print why it is not EXIT_DONE. */

/* Before the work: is there a name, with one of the endings, in a folder that can be
 * written to, and is it none of the inputs (which end with NULL and may hold NULL
 * before)? */
int output_check(const char *path, const char *const *endings, const char *const *inputs,
                 int input_count);

int output_write_image(const char *path, const struct refocus_image *image,
                       const struct refocus_photo *of);
int output_write_file(const char *path, const void *bytes, size_t size);
int output_write_gray16(const char *path, const uint16_t *samples, int width, int height);

#endif
