/* animation.c: frames are written as pictures, as a video stream, or through an encoder. */
#include "outputs/animation.h"

#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <refocus/platform/file.h>
#include <refocus/platform/sink.h>
#include "line/interrupt.h"
#include "outputs/apng.h"
#include "outputs/encoder.h"
#include "outputs/outputs.h"
#include "line/report.h"

enum kind { KIND_NONE, KIND_PICTURES, KIND_Y4M, KIND_APNG, KIND_ENCODER };

struct animation {
    enum kind kind;
    char path[PATH_MAX];
    char *temporary; /* NULL: none yet */
    int frames;      /* written */
    ino_t old;       /* the file that has the name of the next one already, or 0 */
    long process;    /* process number of the encoder, or -1 */
    struct refocus_sink *sink;
    struct apng *apng;
    struct encoder *encoder;
};

/* Whether a name has one %d, with a width if wanted, and no other %. */
static bool is_pattern(const char *path)
{
    const char *percent = strchr(path, '%');

    if (!percent || strchr(percent + 1, '%'))
        return false;
    return percent[1 + strspn(percent + 1, "0123456789")] == 'd' &&
           strspn(percent + 1, "0123456789") < 3;
}

static enum kind kind_of(const char *path)
{
    if (strchr(path, '%'))
        return is_pattern(path) && output_is_picture(path) ? KIND_PICTURES : KIND_NONE;
    if (output_ends_in(path, ".y4m"))
        return KIND_Y4M;
    if (output_ends_in(path, ".apng"))
        return KIND_APNG;
    if (output_ends_in(path, ".mp4") || output_ends_in(path, ".gif") ||
        output_ends_in(path, ".webm"))
        return KIND_ENCODER;
    return KIND_NONE;
}

/* The pattern was looked at: its one % takes an int. */
static bool frame_name(const struct animation *a, int i, char name[PATH_MAX])
{
    const char *percent = strchr(a->path, '%');
    const int width = (int)strtol(percent + 1 + (percent[1] == '0'), NULL, 10);
    const char *rest = strchr(percent, 'd') + 1;

    return snprintf(name, PATH_MAX, percent[1] == '0' ? "%.*s%0*d%s" : "%.*s%*d%s",
                    (int)(percent - a->path), a->path, width, i, rest) < PATH_MAX;
}

int animation_check(const char *path, const char *const *inputs, int input_count)
{
    static const char *const films[] = {".y4m", ".apng", ".mp4", ".gif", ".webm", NULL};
    const enum kind kind = path ? kind_of(path) : KIND_NONE;

    if (path && strlen(path) + 64 > PATH_MAX)
        return report_failure(EXIT_FAILED, path, "the name is too long; give a shorter one");
    if (path && kind == KIND_NONE)
        return report_failure(EXIT_WRONG, path,
                              "no such animation is written; give frames-%%03d with the ending of "
                              "a picture, " OUTPUT_PICTURES
                              ", or end the name in .y4m, .apng, .mp4, .gif or .webm");
    if (kind == KIND_ENCODER && !encoder_is_there())
        return report_failure(EXIT_FAILED, path,
                              "there is no ffmpeg program to write it; install ffmpeg, or give a "
                              "name in .apng or .y4m");
    return output_check(path, OUTPUT_PICTURE, films, inputs, input_count);
}

static int lost(const struct animation *a, const struct refocus_reason *reason)
{
    return report_failure(EXIT_FAILED, a->path, "%s", reason->text);
}

/* Returns the number of the file, or 0 where there is none. */
static ino_t file_at(const char *name)
{
    struct stat file;

    return lstat(name, &file) == 0 ? file.st_ino : 0;
}

static void take_away(const struct animation *a)
{
    char name[PATH_MAX];

    if (a->kind != KIND_PICTURES) {
        if (a->temporary)
            unlink(a->temporary);
        return;
    }
    for (int i = 0; i < a->frames; i++)
        if (frame_name(a, i, name))
            unlink(name);
    /* One that has just come into its place may not be counted yet. */
    if (frame_name(a, a->frames, name) && file_at(name) != a->old)
        unlink(name);
}

static int begin(struct animation *a, int width, int height, double fps, int frames,
                 struct refocus_reason *reason)
{
    char *name;
    int status;

    if (a->kind == KIND_PICTURES)
        return REFOCUS_OK;
    status = refocus_file_temporary(a->path, &a->temporary, reason);
    if (status != REFOCUS_OK)
        return status;
    if (a->kind == KIND_APNG)
        return apng_open(&a->apng, a->temporary, width, height, fps, frames, reason);
    if (a->kind == KIND_ENCODER) {
        status = encoder_open(&a->encoder, a->temporary, width, height, fps, reason);
        a->process = encoder_process(a->encoder);
        return status;
    }
    name = malloc(strlen(a->temporary) + 8);
    if (!name) {
        snprintf(reason->text, sizeof reason->text, "not enough memory");
        return REFOCUS_ERR_MEMORY;
    }
    sprintf(name, "y4m:%s", a->temporary);
    status = refocus_sink_open(&a->sink, name, reason);
    free(name);
    return status == REFOCUS_OK ? refocus_sink_start(a->sink, width, height, fps, reason) : status;
}

/* A signal does not wait for animation_close(). */
static void abandon(void *of)
{
    const struct animation *a = of;

    if (a->process > 0)
        kill((pid_t)a->process, SIGKILL); /* before it makes the file once more */
    apng_take_away(a->apng);
    take_away(a);
}

int animation_open(struct animation **animation, const char *path, int width, int height,
                   double fps, int frames)
{
    struct animation *a = calloc(1, sizeof *a);
    struct refocus_reason reason = {{0}};
    int status;

    *animation = a;
    if (!a)
        return report_failure(EXIT_FAILED, path, "not enough memory");
    snprintf(a->path, sizeof a->path, "%s", path);
    a->kind = kind_of(path);
    a->process = -1;
    interrupt_hold(true);
    interrupt_clean_up(abandon, a);
    status = begin(a, width, height, fps, frames, &reason);
    interrupt_hold(false);
    return status == REFOCUS_OK ? EXIT_DONE : lost(a, &reason);
}

static int write_picture(struct animation *a, const struct refocus_image *image,
                         struct refocus_reason *reason)
{
    struct refocus_write_options options = refocus_write_options_default();
    char name[PATH_MAX];

    if (!frame_name(a, a->frames, name)) {
        snprintf(reason->text, sizeof reason->text, "the name is too long; give a shorter one");
        return REFOCUS_ERR_ARGUMENT;
    }
    a->old = file_at(name);
    options.cancelled = interrupt_cancels;
    return refocus_image_write(name, image, &options, reason);
}

int animation_write(struct animation *a, const struct refocus_image *image)
{
    struct refocus_reason reason = {{0}};
    int status = REFOCUS_OK;

    report_cut(a->path);
    switch (a->kind) {
    case KIND_PICTURES:
        status = write_picture(a, image, &reason);
        break;
    case KIND_Y4M:
        status = refocus_sink_write(a->sink, image, &reason);
        break;
    case KIND_APNG:
        status = apng_write(a->apng, image, &reason);
        break;
    case KIND_ENCODER:
        status = encoder_write(a->encoder, image, &reason);
        break;
    case KIND_NONE:
        break;
    }
    a->frames += status == REFOCUS_OK;
    report_cut(NULL);
    if (status == REFOCUS_ERR_CANCELLED)
        return report_failure(EXIT_FAILED, a->path, REPORT_INTERRUPTED);
    return status == REFOCUS_OK ? EXIT_DONE : lost(a, &reason);
}

int animation_close(struct animation *a, bool keep)
{
    struct refocus_reason reason = {{0}};
    int status = REFOCUS_OK, result = EXIT_DONE;
    struct apng *apng;

    if (!a)
        return EXIT_DONE;
    apng = a->apng;
    if (keep)
        report_cut(a->path);
    interrupt_hold(true);
    a->apng = NULL; /* No frame of it is on its way any more. */
    interrupt_hold(false);
    if (a->sink)
        status = refocus_sink_close(&a->sink, &reason);
    else if (apng)
        status = apng_close(apng, &reason);
    else if (a->encoder)
        status = encoder_close(a->encoder, keep, &reason);
    a->process = -1;
    if (keep && status == REFOCUS_OK && a->kind != KIND_PICTURES)
        status = refocus_file_move(a->temporary, a->path, &reason);
    if (!keep || status != REFOCUS_OK)
        take_away(a);
    report_cut(NULL);
    interrupt_clean_up(NULL, NULL);
    if (keep && status != REFOCUS_OK)
        result = lost(a, &reason);
    free(a->temporary);
    free(a);
    return result;
}
