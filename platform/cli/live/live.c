/* live.c: the command refocus live: cameras are opened, the threads run, and the report is made. */
#define _GNU_SOURCE /* pthread_tryjoin_np() */
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "commands/commands.h"
#include "line/interrupt.h"
#include "line/report.h"
#include "live/live_colour.h"
#include "live/live_commands.h"
#include "live/live_depth_camera.h"
#include "live/live_estimate.h"
#include "live/live_lens.h"
#include "live/live_look.h"
#include "live/live_options.h"
#include "live/live_output.h"
#include "live/live_render.h"
#include "live/live_report.h"
#include "live/live_sources.h"
#include "live/live_stack.h"

/* A line, or an entry of the array where one is given. */
static void print_camera(void *user, const char *name, const char *description)
{
    if (user)
        json_array_append_new(user, json_pack("{s:o, s:o}", "name", report_text_json(name),
                                              "description", report_text_json(description)));
    else
        printf("%s  %s\n", name, description);
}

static json_t *mode_json(const struct refocus_source_mode *mode)
{
    return json_pack("{s:s, s:i, s:i, s:f}", "format", refocus_frame_format_name(mode->format),
                     "width", (int)mode->width, "height", (int)mode->height, "fps", mode->fps);
}

static int print_modes(const char *name, bool json)
{
    struct refocus_reason reason = {""};
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source *source;
    const int status = refocus_source_open(&source, name, &reason);
    json_t *modes;

    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), name, "%s", reason.text);
    modes = json ? json_array() : NULL;
    for (int i = 0; refocus_source_get_mode(source, i, &mode) == REFOCUS_OK; i++)
        if (json)
            json_array_append_new(modes, mode_json(&mode));
        else
            printf("%-6s %5dx%-5d %g fps\n", refocus_frame_format_name(mode.format),
                   (int)mode.width, (int)mode.height, mode.fps);
    if (!json)
        live_lens_print(source);
    refocus_source_close(&source);
    return json ? report_print_json(
                      json_pack("{s:o, s:o}", "camera", report_text_json(name), "modes", modes))
                : report_end_output();
}

static int list(const struct live_settings *settings)
{
    json_t *cameras;
    int n;

    if (settings->camera)
        return print_modes(settings->camera, settings->engine.json);
    cameras = settings->engine.json ? json_array() : NULL;
    n = refocus_source_list(print_camera, cameras);
    if (n < 0) {
        json_decref(cameras);
        return report_failure(EXIT_FAILED, "--list", "%s", refocus_strerror(n));
    }
    if (n == 0)
        report_warning("--list",
                       "no camera is there; --camera replay:SCRIPT plays pictures instead");
    return cameras ? report_print_json(json_pack("{s:o}", "cameras", cameras))
                   : report_end_output();
}

static int open_all(struct live *live)
{
    const struct live_settings *settings = live->settings;
    struct refocus_reason reason = {""};
    int status = live_commands_open(live);

    if (status == EXIT_DONE)
        status = live_sources_open(live);
    if (status == EXIT_DONE && live->mode.width > 0 && live->mode.height > 0)
        status = live_look_place(live, live->mode.width, live->mode.height);
    if (status != EXIT_DONE)
        return status;
    report_cut(settings->out); /* a pipe is opened once somebody reads it */
    status = refocus_sink_open(&live->sink, settings->out, &reason);
    report_cut(NULL);
    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), settings->out, "%s", reason.text);
    refocus_sink_set_mode(live->sink, &live->mode);
    refocus_sink_set_cancelled(live->sink, interrupt_cancels, NULL);
    return EXIT_DONE;
}

/* Formats that the method, the look, the filter of the depth and the sink take without a detour by
 * RGB. */
static uint32_t find_yuv_formats(struct live *live)
{
    uint32_t formats = 0;

    if (!live_look_takes_yuv(live->engine) || live->settings->depth.upsample > 0)
        return 0;
    for (uint32_t format = 0; format < 32; format++)
        if (refocus_format_is_yuv(format) && refocus_sink_takes(live->sink, format))
            formats |= UINT32_C(1) << format;
    return formats;
}

/* False: a signal came, and the thread goes on nevertheless, in a library or as nobody reads. */
static bool join(pthread_t thread)
{
    const struct timespec pause = {0, 2000000};

    while (pthread_tryjoin_np(thread, NULL) == EBUSY) {
        if (interrupt_is_late())
            return false;
        nanosleep(&pause, NULL);
    }
    return true;
}

/* Counts the frames that the output thread, which is left behind, does not write any more. */
static void drop_rendered(struct live *live)
{
    bool ended = false;

    live->sink_dropped++; /* the one that it is at */
    while (!ended) {
        struct live_picture *const picture = live_queue_take(&live->rendered, &ended);

        live->sink_dropped += picture != NULL;
        if (picture)
            live_queue_return(&live->rendered, picture);
    }
}

/* The threads, and this one renders; then all is over. False: threads are left behind. */
static bool run_threads(struct live *live)
{
    enum { CAPTURE, DEPTH, ESTIMATE, OUTPUT, COMMANDS, THREADS };
    const struct live_settings *settings = live->settings;
    static void *(*const main_of[])(void *) = {[CAPTURE] = live_colour_thread,
                                               [DEPTH] = live_depth_thread,
                                               [ESTIMATE] = live_estimate_thread,
                                               [OUTPUT] = live_output_thread,
                                               [COMMANDS] = live_command_thread};
    const bool wanted[THREADS] = {[CAPTURE] = true,
                                  [DEPTH] = live->depth_camera,
                                  [ESTIMATE] = live->estimator,
                                  [OUTPUT] = true,
                                  [COMMANDS] = !settings->no_commands || live->command_fd >= 0};
    pthread_t thread[THREADS];
    bool running[THREADS] = {false}, left = false;

    for (int i = 0; i < THREADS; i++) {
        if (!wanted[i])
            continue;
        if (pthread_create(&thread[i], NULL, main_of[i], live) != 0) {
            live_fail(live, EXIT_FAILED, "live", "a thread could not be started");
            break;
        }
        running[i] = true;
    }
    while (settings->offline && running[COMMANDS] && sem_wait(&live->first_commands) != 0 &&
           !live_is_over(live))
        continue;
    live_render(live);
    /* Pictures that are rendered already are still written, unless the sink failed or a signal
     * came. */
    if (running[OUTPUT])
        left = !join(thread[OUTPUT]);
    live_stop(live);
    live_depths_end(&live->depths, false);
    live_queue_close(&live->captured);
    live_queue_close(&live->rendered);
    live_queue_close(&live->to_estimate);
    if (left)
        drop_rendered(live);
    for (int i = 0; i < THREADS; i++)
        if (running[i] && i != OUTPUT)
            left |= !join(thread[i]);
    return !left;
}

/* A stream without frames has its header all the same, if the size of a frame is known. */
static void begin_without_frames(struct live *live)
{
    const uint32_t own = refocus_frame_image_format(live->mode.format);
    const struct refocus_image like = {
        .struct_size = sizeof(struct refocus_image),
        .format = live->yuv_formats >> own & 1 ? own : (uint32_t)REFOCUS_FORMAT_RGB8,
        .width = live->mode.width,
        .height = live->mode.height};

    if (atomic_load(&live->frames_out) == 0 && live_output_is_stream(live) && like.width > 0)
        refocus_sink_start_image(live->sink, &like, live->mode.fps, NULL);
}

static void stop_live(void *live)
{
    live_stop(live);
}

static int run_live(struct live *live)
{
    struct refocus_reason reason = {""};
    bool whole = true;
    int status;

    interrupt_call(stop_live, live);
    status = open_all(live);
    if (status == EXIT_DONE) {
        live->yuv_formats = find_yuv_formats(live);
        whole = run_threads(live);
        status = live->exit_code;
        if (status != EXIT_DONE && live->what[0])
            status = report_failure(status, live->what, "%s", live->why);
        if (status == EXIT_DONE && whole)
            begin_without_frames(live);
    }
    if (whole && refocus_sink_close(&live->sink, &reason) != REFOCUS_OK && status == EXIT_DONE) {
        live_note_failure(live, EXIT_FAILED, live->settings->out, reason.text);
        status = report_failure(EXIT_FAILED, live->what, "%s", live->why);
    }
    if (status == EXIT_DONE)
        status = live_report(live);
    else if (live->settings->engine.json && live->capture.frames > 0)
        live_report(live); /* The frames until then count all the same. */
    if (!whole)
        interrupt_leave(status);
    interrupt_call(NULL, NULL);
    live_sources_close(live);
    live_commands_close(live);
    return status;
}

/* An output that would be written over an input is refused before either is opened. */
static int check_output(const struct live_settings *settings)
{
    const char *const inputs[] = {settings->camera,
                                  settings->depth.file,
                                  settings->estimate.model,
                                  settings->calibration,
                                  settings->engine.aperture,
                                  settings->engine.papers.field_map,
                                  settings->engine.controls.focus_map,
                                  settings->engine.controls.sharp_mask};

    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        const int answer = refocus_sink_overwrites(settings->out, inputs[i]);

        if (answer < 0)
            return report_failure(EXIT_FAILED, settings->out, "%s", refocus_strerror(answer));
        if (answer)
            return report_failure(EXIT_WRONG, settings->out,
                                  "it is an input too and would be lost; give another name");
    }
    return EXIT_DONE;
}

static int run(int argc, char **argv)
{
    struct live_settings settings = live_settings_none;
    struct engine engine;
    struct live *live;
    const char *files[1];
    int status;

    status = options_parse(&live_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    if (settings.list)
        return list(&settings);
    status = live_check_settings(&settings);
    if (status == EXIT_DONE)
        status = check_output(&settings);
    if (status != EXIT_DONE)
        return status;
    live = calloc(1, sizeof *live);
    if (!live)
        return report_failure(EXIT_FAILED, "live", "not enough memory");
    status = live_begin(live, &settings, &engine);
    if (status != EXIT_DONE) {
        free(live);
        return status;
    }
    status = engine_begin(&engine, &settings.engine);
    if (status == EXIT_DONE)
        status = live_look_check_method(live);
    if (status == EXIT_DONE)
        status = run_live(live);
    engine_end(&engine);
    live_clear(live);
    free(live);
    return status;
}

const struct command live_command = {
    .name = "live",
    .usage = "--camera SOURCE --depth SOURCE [--out SINK] [options]",
    .summary = "camera in, refocused frames out",
    .notes = "While it runs, standard input (and --socket) takes a command a line: focus D, "
             "focus-at X,Y, focus-rectangle X,Y,W,H (follows), pull D SECONDS, pull-at X,Y SECONDS "
             "(smooth), blur K, stack (take a new one), quit. Depth is paired with colour by time "
             "within half a frame; without a pair the newest depth serves, or, with "
             "--frames-policy every, the nearest in time. After a fault the camera is opened "
             "again; platform/README.md lists faults and outcomes. Ctrl-C ends it with status 0.",
    .table = live_options,
    .files_least = 0,
    .files_most = 0,
    .run = run,
};
