/* encoder.c: raw frames are piped into the ffmpeg program. */
#include "outputs/encoder.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "outputs/outputs.h"

extern char **environ;

struct encoder {
    pid_t process;
    int pipe;
};

bool encoder_is_there(void)
{
    const char *path = getenv("PATH");

    while (path && *path) {
        const int length = (int)strcspn(path, ":");
        char name[PATH_MAX];

        if (length > 0 &&
            snprintf(name, sizeof name, "%.*s/ffmpeg", length, path) < (int)sizeof name &&
            access(name, X_OK) == 0)
            return true;
        path += length + (path[length] == ':');
    }
    return false;
}

static int failed(struct refocus_reason *reason, const char *what, int error)
{
    snprintf(reason->text, sizeof reason->text, "%s%s%s", what, error ? ": " : "",
             error ? strerror(error) : "");
    return REFOCUS_ERR_IO;
}

/* ffmpeg with our end of the pipe closed, and Ctrl-C for us alone; signals are blocked in
 * our threads, and not in it. */
static int start(struct encoder *e, int read_end, char *const *arguments)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    int error = posix_spawn_file_actions_init(&files);

    if (error)
        return error;
    error = posix_spawnattr_init(&attributes);
    if (!error) {
        posix_spawn_file_actions_adddup2(&files, read_end, STDIN_FILENO);
        sigset_t none;

        sigemptyset(&none);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
        posix_spawnattr_setpgroup(&attributes, 0);
        error = posix_spawnp(&e->process, "ffmpeg", &files, &attributes, arguments, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&files);
    return error;
}

int encoder_open(struct encoder **encoder, const char *path, int width, int height, double fps,
                 struct refocus_reason *reason)
{
    /* Sides of 4:2:0 are even; the one more row or column repeats the last. Players take what does
     * not say its matrix for BT.709, or what is small for BT.601. */
    static char film[] =
        "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p,"
        "setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709:range=tv";
    static char palette[] = "split[a][b];[a]palettegen[p];[b][p]paletteuse";
    const bool gif = output_ends_in(path, ".gif");
    char size[32], rate[32], file[PATH_MAX + 8];
    char *const arguments[] = {"ffmpeg",
                               "-nostdin",
                               "-loglevel",
                               "error",
                               "-f",
                               "rawvideo",
                               "-pixel_format",
                               "rgb24",
                               "-video_size",
                               size,
                               "-framerate",
                               rate,
                               "-i",
                               "pipe:0",
                               "-vf",
                               gif ? palette : film,
                               "-y",
                               file,
                               NULL};
    struct encoder *e = malloc(sizeof *e);
    int ends[2], error;

    *encoder = e;
    if (!e)
        return failed(reason, "not enough memory", 0);
    e->process = -1;
    e->pipe = -1;
    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%.12g", fps);
    snprintf(file, sizeof file, "file:%s", path);
    if (pipe(ends) != 0)
        return failed(reason, "no pipe to ffmpeg", errno);
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    error = start(e, ends[0], arguments);
    close(ends[0]);
    e->pipe = ends[1];
    if (error) {
        e->process = -1;
        return failed(reason, "ffmpeg does not start", error);
    }
    signal(SIGPIPE, SIG_IGN); /* a program of our own: errors are enough */
    return REFOCUS_OK;
}

int encoder_write(struct encoder *e, const struct refocus_image *image,
                  struct refocus_reason *reason)
{
    for (int y = 0; y < image->height; y++) {
        const uint8_t *row = image->plane[0] + y * image->stride[0];
        size_t left = (size_t)image->width * 3;

        while (left > 0) {
            const ssize_t n = write(e->pipe, row, left);

            if (n < 0 && errno == EINTR)
                continue;
            if (n < 0)
                return failed(reason, "ffmpeg ended early", errno);
            row += n;
            left -= (size_t)n;
        }
    }
    return REFOCUS_OK;
}

long encoder_process(const struct encoder *e)
{
    return e ? (long)e->process : -1;
}

int encoder_close(struct encoder *e, bool finish, struct refocus_reason *reason)
{
    int result = 0, status = REFOCUS_OK;

    if (!e)
        return REFOCUS_OK;
    if (e->pipe >= 0)
        close(e->pipe);
    if (e->process > 0) {
        if (!finish)
            kill(e->process, SIGKILL);
        while (waitpid(e->process, &result, 0) < 0 && errno == EINTR)
            continue;
        if (finish && !(WIFEXITED(result) && WEXITSTATUS(result) == 0))
            status = failed(reason, "ffmpeg failed; what it says is above", 0);
    }
    free(e);
    return status;
}
