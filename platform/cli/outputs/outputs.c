/* outputs.c: files that the command writes are checked before the work and written after it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>
#include "line/interrupt.h"
#include "outputs/outputs.h"
#include "line/report.h"

enum { MOST_ENDINGS = 32 };

bool output_ends_in(const char *path, const char *ending)
{
    const size_t length = strlen(path), n = strlen(ending);

    return length > n && strcasecmp(path + length - n, ending) == 0;
}

bool output_is_jpeg(const char *path)
{
    return path && (output_ends_in(path, ".jpg") || output_ends_in(path, ".jpeg"));
}

uint32_t output_deep_format(const char *path)
{
    static const struct {
        const char *ending;
        uint32_t format;
    } deep[] = {{".png", REFOCUS_FORMAT_RGB16},
                {".tif", REFOCUS_FORMAT_RGB16},
                {".tiff", REFOCUS_FORMAT_RGB16},
                {".exr", REFOCUS_FORMAT_RGB_FLOAT},
                {".pfm", REFOCUS_FORMAT_RGB_FLOAT}};

    for (size_t i = 0; i < sizeof deep / sizeof *deep; i++)
        if (output_ends_in(path, deep[i].ending))
            return deep[i].format;
    return REFOCUS_FORMAT_NONE;
}

bool output_is_picture(const char *path)
{
    for (int i = 0; refocus_file_ending(0, i); i++)
        if (output_ends_in(path, refocus_file_ending(0, i)))
            return true;
    return false;
}

static int check_ending(const char *path, unsigned kinds, const char *const *others)
{
    const char *endings[MOST_ENDINGS];
    char words[256] = "";
    int count = 0;

    for (int i = 0; kinds & OUTPUT_PICTURE && refocus_file_ending(0, i) && count < MOST_ENDINGS;
         i++)
        endings[count++] = refocus_file_ending(0, i);
    for (int i = 0; kinds & OUTPUT_DEPTH && refocus_file_ending(1, i) && count < MOST_ENDINGS; i++)
        endings[count++] = refocus_file_ending(1, i);
    for (int i = 0; others && others[i] && count < MOST_ENDINGS; i++)
        endings[count++] = others[i];
    for (int i = 0; i < count; i++) {
        if (output_ends_in(path, endings[i]))
            return EXIT_DONE;
        snprintf(words + strlen(words), sizeof words - strlen(words), "%s%s",
                 i == 0          ? ""
                 : i + 1 < count ? ", "
                                 : " or ",
                 endings[i]);
    }
    return report_failure(EXIT_WRONG, path, "no such format is written; end the name in %s", words);
}

enum { LONGEST_FOLDER = 4096 };

/* The folder of a path that is no symbolic link; false: its name is too long. */
static bool folder_of(const char *path, char folder[LONGEST_FOLDER])
{
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) : 0;

    if (length >= LONGEST_FOLDER)
        return false;
    snprintf(folder, LONGEST_FOLDER, "%.*s", slash ? (length ? length : 1) : 1, slash ? path : ".");
    return true;
}

/* path is the file itself, not a symbolic link to it; name is the user's word for it. */
static int check_folder_of(const char *path, const char *name)
{
    char folder[LONGEST_FOLDER];

    if (!folder_of(path, folder))
        return report_failure(EXIT_FAILED, name, "the name is too long; give a shorter one");
    if (access(folder, W_OK | X_OK) != 0)
        return report_failure(EXIT_FAILED, name,
                              "the folder %s cannot be written to (%s); give another place", folder,
                              strerror(errno));
    return EXIT_DONE;
}

/* A link is followed to the file that is replaced. */
static int check_folder(const char *path)
{
    char *place = refocus_file_place(path);
    const int status = check_folder_of(place ? place : path, path);

    free(place);
    return status;
}

int output_check(const char *path, unsigned kinds, const char *const *others,
                 const char *const *inputs, int input_count)
{
    struct stat out, in;
    int status;

    if (!path)
        return report_failure(EXIT_WRONG, "-o", "the output has no name; give -o OUT");
    status = check_ending(path, kinds, others);
    if (status != EXIT_DONE)
        return status;
    if (stat(path, &out) != 0)
        return check_folder(path);
    if (S_ISDIR(out.st_mode))
        return report_failure(EXIT_FAILED, path, "it is a folder; give the name of a file");
    if (!S_ISREG(out.st_mode))
        return report_failure(EXIT_FAILED, path,
                              "it is a pipe, socket or device; give the name of a file");
    for (int i = 0; i < input_count; i++)
        if (inputs[i] && stat(inputs[i], &in) == 0 && in.st_dev == out.st_dev &&
            in.st_ino == out.st_ino)
            return report_failure(EXIT_WRONG, path,
                                  "it is an input too and would be lost; give another name");
    return check_folder(path);
}

static const char *last_name(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

/* Whether two files, of which none may be there yet, have one name in one folder. */
static bool is_one_place(const char *path, const char *other)
{
    char folder[LONGEST_FOLDER], other_folder[LONGEST_FOLDER];
    struct stat at, other_at;

    return strcmp(last_name(path), last_name(other)) == 0 && folder_of(path, folder) &&
           folder_of(other, other_folder) && stat(folder, &at) == 0 &&
           stat(other_folder, &other_at) == 0 && at.st_dev == other_at.st_dev &&
           at.st_ino == other_at.st_ino;
}

int output_check_two(const char *path, const char *other)
{
    char *place = refocus_file_place(path), *other_place = refocus_file_place(other);
    const bool one = place && other_place && is_one_place(place, other_place);

    free(place);
    free(other_place);
    if (one)
        return report_failure(EXIT_WRONG, path,
                              "two results would be written to it; give each its own name");
    return EXIT_DONE;
}

static int written(int status, const char *path, const struct refocus_reason *reason)
{
    if (status == REFOCUS_OK) {
        if (reason->text[0])
            report_warning(path, "%s", reason->text);
        return EXIT_DONE;
    }
    return report_failure(EXIT_FAILED, path, "%s",
                          reason->text[0] ? reason->text : refocus_strerror(status));
}

struct refocus_write_options output_keeps(const struct refocus_photo *of)
{
    struct refocus_write_options options = refocus_write_options_default();

    if (of) {
        options.exif = of->exif.data ? &of->exif : NULL;
        options.icc = of->icc.data ? &of->icc : NULL;
        options.keep = of;
    }
    return options;
}

int output_write_image(const char *path, const struct refocus_image *image,
                       const struct refocus_write_options *options)
{
    return output_write_image_as(path, path, image, options);
}

int output_write_image_as(const char *path, const char *name, const struct refocus_image *image,
                          const struct refocus_write_options *options)
{
    struct refocus_write_options own = options ? *options : refocus_write_options_default();
    struct refocus_reason reason = {""};
    int status;

    own.cancelled = interrupt_cancels;
    report_cut(name);
    status = refocus_image_write(path, image, &own, &reason);
    report_cut(NULL);
    if (status == REFOCUS_ERR_CANCELLED)
        return report_failure(EXIT_FAILED, name, REPORT_INTERRUPTED);
    return written(status, name, &reason);
}

int output_write_gray16(const char *path, const uint16_t *samples, int width, int height)
{
    struct refocus_reason reason = {""};
    int status;

    report_cut(path);
    status = interrupt_came() ? REFOCUS_ERR_CANCELLED
                              : refocus_gray16_write(path, samples, width, height,
                                                     (ptrdiff_t)width * 2, &reason);
    report_cut(NULL);
    if (status == REFOCUS_ERR_CANCELLED)
        return report_failure(EXIT_FAILED, path, REPORT_INTERRUPTED);
    return written(status, path, &reason);
}

int output_write_file(const char *path, const void *bytes, size_t size)
{
    struct refocus_reason reason = {""};
    int status;

    report_cut(path);
    status = refocus_file_write(path, bytes, size, &reason);
    report_cut(NULL);
    return written(status, path, &reason);
}
