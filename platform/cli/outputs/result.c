/* result.c: the size, the quality and the place of a picture that is written. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>
#include "line/interrupt.h"
#include "line/report.h"
#include "outputs/outputs.h"
#include "outputs/resize.h"
#include "outputs/result.h"

const struct option result_options[] = {
    {OPTION(OPTION_CHOICE, "--format", "NAME", struct result_settings, format), .elsewhere = true,
     .choice = result_format,
     .help = "of standard output (-o -), and {ext} of names; default the photo's own"},
    {OPTION(OPTION_TEXT, "--resize", "SIZE", struct result_settings, resize), .elsewhere = true,
     .brief = "size of the picture: W, WxH or N%",
     .help = "make the picture smaller: W pixels wide, to fit into WxH, or N% of its sides; never "
             "larger than it is. Everything else is in pixels of the photo; the mean of areas is "
             "taken in linear light"},
    {OPTION(OPTION_INTEGER, "--jpeg-quality", "Q", struct result_settings, quality),
     .elsewhere = true, .least = 1, .greatest = 100,
     .help = "of JPEG, default 95, or HEIC, default 90. Below 90 the colour of a JPEG is stored at "
             "half the size"},
    {.help = NULL},
};

const char *result_format(uint32_t index)
{
    const char *ending = index == 0 ? NULL : refocus_file_ending(0, (int)index - 1);

    return index == 0 ? "auto" : ending ? ending + 1 : NULL;
}

static bool is_lossy(const char *output)
{
    const char *dot = strrchr(output, '.');

    return dot && (strcasecmp(dot, ".jpg") == 0 || strcasecmp(dot, ".jpeg") == 0 ||
                   strcasecmp(dot, ".heic") == 0);
}

int result_check(const struct result_settings *settings, const char *output, bool alone)
{
    const char *dot = strrchr(output, '.'), *format = result_format((uint32_t)settings->format);
    struct resize size;

    if (settings->format && dot && strcmp(dot + 1, format) != 0)
        return report_failure(EXIT_WRONG, "--format",
                              "%s says the format by its end; leave it out, or end it in {ext}",
                              output);
    if (settings->resize && !resize_parse(settings->resize, &size))
        return report_failure(EXIT_WRONG, "--resize",
                              "'%s' cannot be used; give a width W, WxH, up to %d, or N%% up to "
                              "100%%",
                              settings->resize, REFOCUS_MAX_SIDE);
    if (alone && !isnan(settings->quality) && !is_lossy(output))
        return report_failure(EXIT_WRONG, "--jpeg-quality",
                              "it changes nothing of %s, which is no JPEG or HEIC; leave it out",
                              settings->standard ? "standard output" : output);
    return EXIT_DONE;
}

int result_resize(const struct result_settings *settings, struct refocus_image *picture)
{
    struct resize size;
    int width, height, status;
    struct refocus_image small;

    if (!settings->resize || !resize_parse(settings->resize, &size))
        return EXIT_DONE;
    resize_fit(&size, picture->width, picture->height, &width, &height);
    if (width == picture->width && height == picture->height)
        return EXIT_DONE;
    status = resize_image(picture, width, height, &small);
    if (status == REFOCUS_ERR_UNSUPPORTED)
        return report_failure(EXIT_FAILED, "--resize",
                              "it goes with light by sRGB, linear or gamma; leave it or --transfer "
                              "out");
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, "--resize", "not enough memory");
    free(picture->plane[0]);
    *picture = small;
    return EXIT_DONE;
}

static void remove_file(void *path)
{
    unlink(path);
}

/* Messages call the temporary file behind it by this name. */
static const char standard_output[] = "standard output";

static int read_whole(const char *path, struct refocus_blob *bytes)
{
    struct refocus_reason reason = {""};

    if (refocus_file_read(path, UINT64_MAX, bytes, &reason) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, standard_output, "%s", reason.text);
    return EXIT_DONE;
}

/* A file that nobody else can read, as what goes through a pipe. */
static int make_temporary(const char *beside, char **path, struct refocus_reason *reason)
{
    const mode_t mask = umask(0077);
    const int status = refocus_file_temporary(beside, path, reason);

    umask(mask);
    return status;
}

/* Writes to a temporary file first, so that an error leaves nothing on standard output. */
static int write_standard(const char *output, const struct refocus_image *picture,
                          const struct refocus_write_options *options)
{
    const char *folder = getenv("TMPDIR");
    struct refocus_reason reason = {""};
    struct refocus_blob bytes = {0};
    char beside[4096], *path = NULL;
    int status;

    snprintf(beside, sizeof beside, "%s/refocus%s", folder && *folder ? folder : "/tmp",
             strrchr(output, '.'));
    interrupt_hold(true);
    status = make_temporary(beside, &path, &reason);
    if (status == REFOCUS_OK)
        interrupt_clean_up(remove_file, path);
    interrupt_hold(false);
    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, standard_output, "%s", reason.text);
    status = output_write_image_as(path, standard_output, picture, options);
    if (status == EXIT_DONE)
        status = read_whole(path, &bytes);
    unlink(path);
    interrupt_clean_up(NULL, NULL);
    if (status == EXIT_DONE) {
        report_cut(standard_output);
        fwrite(bytes.data, 1, bytes.size, stdout);
        fflush(stdout);
        report_cut(NULL);
        status = report_end_output();
    }
    free(bytes.data);
    free(path);
    return status;
}

int result_write(const struct result_settings *settings, const char *output,
                 const struct refocus_image *picture, struct refocus_write_options options)
{
    if (!isnan(settings->quality))
        options.quality = (int)settings->quality;
    return settings->standard ? write_standard(output, picture, &options)
                              : output_write_image(output, picture, &options);
}
