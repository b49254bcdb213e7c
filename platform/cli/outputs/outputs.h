/* outputs.h: files that the command writes are checked before the work and written after it. */
#ifndef RF_CLI_OUTPUTS_H
#define RF_CLI_OUTPUTS_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/image.h>
#include <refocus/platform/file.h>

/* A row for tables of options. */
#define OUTPUT_OPTION(type, member, text)                                                          \
    {                                                                                              \
        OPTION(OPTION_TEXT, "--output", "OUT", type, member),                                      \
            .letter = 'o', .elsewhere = true,                                                      \
            .brief = "the file to write; its ending says the format", .help = text                 \
    }

/* These return exit codes and print why it is not EXIT_DONE. */

/* Kinds of files by their endings, to be or-ed. */
enum { OUTPUT_PICTURE = 1, OUTPUT_DEPTH = 2 };
/* The endings of pictures as the help lists them. */
#define OUTPUT_PICTURES ".jpg, .png, .heic, .tif, .exr, .ppm or .pfm"

/* Check before the work that there is a name, that it ends as these kinds or as one of the other
 * endings (which end with NULL, or are NULL), that its folder can be written to, and that it is
 * none of the inputs, some of which may be NULL. */
int output_check(const char *path, unsigned kinds, const char *const *others,
                 const char *const *inputs, int input_count);
/* Check that the output at a path is not that at the other one. */
int output_check_two(const char *path, const char *other);
/* Whether a name ends so, in capitals or not, with something before it. */
bool output_ends_in(const char *path, const char *ending);
bool output_is_jpeg(const char *path); /* NULL is not */
/* The deep format that a picture of that name holds: of PNG, TIFF, OpenEXR and PFM; of others 0. */
uint32_t output_deep_format(const char *path);
/* Whether the name ends as that of a picture. */
bool output_is_picture(const char *path);

/* Options for a picture that keeps what the file of a photo says; NULL: keeps nothing. */
struct refocus_write_options output_keeps(const struct refocus_photo *of);
int output_write_image(const char *path, const struct refocus_image *image,
                       const struct refocus_write_options *options);
/* Write a temporary file, which messages call by another name. */
int output_write_image_as(const char *path, const char *name, const struct refocus_image *image,
                          const struct refocus_write_options *options);
int output_write_file(const char *path, const void *bytes, size_t size);
int output_write_gray16(const char *path, const uint16_t *samples, int width, int height);

#endif
