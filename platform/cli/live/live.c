/* refocus live */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>
#include "commands/commands.h"
#include "line/interrupt.h"
#include "live/live.h"

static const char *policy_name(uint32_t index)
{
    static const char *const names[] = {"newest", "every"};
    return index < 2 ? names[index] : NULL;
}

static const char *policy_summary(uint32_t index)
{
    static const char *const summaries[] = {"a new frame replaces one that waits: least delay",
                                            "each frame is rendered; the source waits or drops"};
    return index < 2 ? summaries[index] : NULL;
}

static const char *format_name(uint32_t index)
{
    return index == 0 ? "any" : refocus_frame_format_name(index);
}

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "In and out"},
    {.kind = OPTION_TEXT,
     .name = "--camera",
     .argument = "SOURCE",
     .offset = offsetof(struct live_settings, camera),
     .help = "v4l2:/dev/video0, libcamera:0, file:frames-%04d.png, y4m:FILE, "
             "raw:FILE,NV12,640x480,30 or replay:SCRIPT"},
    {.kind = OPTION_TEXT,
     .name = "--depth",
     .argument = "SOURCE",
     .offset = offsetof(struct live_settings, depth.file),
     .help = "depth beside it: such a source of Y16, Z16 or GREY, the file of one fixed depth "
             "map, or estimate:MODEL.onnx[,every=N][,preset=NAME], a network that sees every "
             "N-th picture"},
    DEPTH_UNIT_OPTIONS(struct live_settings, depth),
    {.kind = OPTION_NUMBER,
     .name = "--steady",
     .argument = "S",
     .offset = offsetof(struct live_settings, steady),
     .least = 0,
     .greatest = 0.95,
     .help = "calm the flicker of depth: share of the past where nothing moves, 0 (default) "
             "to 0.95"},
    {.kind = OPTION_TEXT,
     .name = "--calibration",
     .argument = "FILE",
     .offset = offsetof(struct live_settings, calibration),
     .help = "JSON of two pinhole cameras, by which depth is registered onto colour"},
    {.kind = OPTION_TEXT,
     .letter = 'o',
     .name = "--out",
     .argument = "SINK",
     .offset = offsetof(struct live_settings, out),
     .help = "window, v4l2:/dev/video9, y4m:FILE, raw:FILE[,FORMAT], frames-%04d.png or null "
             "(default); FILE may be - for standard output, FORMAT own (as frames come), NV12, "
             "NV21, YUV420, YUYV, UYVY, RGB24 (default), BGR24, RGBX or BGRX"},
    {.kind = OPTION_FLAG,
     .name = "--list",
     .offset = offsetof(struct live_settings, list),
     .help = "list the cameras, or the modes of --camera, and end"},
    {.kind = OPTION_CHOICE,
     .name = "--format",
     .argument = "NAME",
     .offset = offsetof(struct live_settings, format),
     .choice = format_name,
     .help = "pixels that the camera shall deliver"},
    {.kind = OPTION_NUMBERS,
     .name = "--size",
     .argument = "WxH",
     .offset = offsetof(struct live_settings, size),
     .least = 1,
     .greatest = REFOCUS_MAX_SIDE,
     .count = 2,
     .help = "and how many of them; the nearest size that there is"},
    {.kind = OPTION_NUMBER,
     .name = "--fps",
     .argument = "N",
     .offset = offsetof(struct live_settings, fps),
     .least = 0,
     .above = true,
     .greatest = 10000,
     .help = "frames a second"},
    {.kind = OPTION_HEADING, .help = "Focus and blur"},
    {.kind = OPTION_NUMBER,
     .name = "--focus",
     .argument = "D",
     .offset = offsetof(struct live_settings, lens.focus),
     .least = 0,
     .greatest = 1,
     .help = "disparity in focus: 1 nearest, 0 farthest"},
    {.kind = OPTION_NUMBERS,
     .name = "--focus-at",
     .argument = "X,Y",
     .offset = offsetof(struct live_settings, lens.focus_at),
     .least = -INFINITY,
     .greatest = INFINITY,
     .count = 2,
     .help = "focus on the surface at that pixel of the first frame, and stay at its distance; "
             "without any --focus...: where the camera's lens is, if it says so, else the "
             "centre"},
    {.kind = OPTION_NUMBER,
     .name = "--blur",
     .argument = "K",
     .offset = offsetof(struct live_settings, lens.blur),
     .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS,
     .help = "blur radius in pixels of what lies farthest from the focus, default 20; when the "
             "range of distances moves, the lens stays, and goes back to K within some ten "
             "seconds"},
    {.kind = OPTION_NUMBER,
     .name = "--blur-most",
     .argument = "K",
     .offset = offsetof(struct live_settings, blur_most),
     .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS,
     .help = "the most that the command 'blur' may ask for, and a range that widens; default "
             "twice --blur"},
    {.kind = OPTION_HEADING, .help = "Rendering"},
    METHOD_OPTION(struct live_settings, engine),
    METHOD_OPTIONS(struct live_settings, engine),
    {.kind = OPTION_INTEGER,
     .name = "--threads",
     .argument = "N",
     .offset = offsetof(struct live_settings, engine.threads),
     .greatest = 64,
     .help = "0 = one for each processor, the default; never changes a picture"},
    {.kind = OPTION_CHOICE,
     .name = "--cpu",
     .argument = "NAME",
     .offset = offsetof(struct live_settings, engine.cpu),
     .choice = refocus_cpu_name,
     .help = "instruction set"},
    {.kind = OPTION_HEADING, .help = "Running"},
    {.kind = OPTION_CHOICE,
     .name = "--frames-policy",
     .argument = "NAME",
     .offset = offsetof(struct live_settings, policy),
     .choice = policy_name,
     .summary = policy_summary,
     .help = "what becomes of frames that cannot be kept up with; default newest, and every "
             "from files (file:, y4m:, raw:) to files"},
    {.kind = OPTION_INTEGER,
     .name = "--frames",
     .argument = "N",
     .offset = offsetof(struct live_settings, frames),
     .least = 1,
     .greatest = 1e15,
     .help = "end after so many frames are written"},
    {.kind = OPTION_NUMBER,
     .name = "--duration",
     .argument = "S",
     .offset = offsetof(struct live_settings, duration),
     .least = 0,
     .above = true,
     .greatest = 1e9,
     .help = "end after so many seconds; from files to files those of the frames"},
    {.kind = OPTION_NUMBER,
     .name = "--patience",
     .argument = "S",
     .offset = offsetof(struct live_settings, patience),
     .least = 0,
     .greatest = 1e9,
     .help = "how long to wait for a device that went away, default 10 s"},
    {.kind = OPTION_FLAG,
     .name = "--fast",
     .offset = offsetof(struct live_settings, fast),
     .help = "files and scripts: as fast as they can be read; always so from files to files"},
    {.kind = OPTION_FLAG,
     .name = "--loop",
     .offset = offsetof(struct live_settings, loop),
     .help = "files: from the beginning again at the end"},
    {.kind = OPTION_FLAG,
     .name = "--dmabuf",
     .offset = offsetof(struct live_settings, dmabuf),
     .help = "V4L2: buffers exported as DMA-BUF, each access bracketed by its sync ioctl"},
    {.kind = OPTION_FLAG,
     .name = "--no-commands",
     .offset = offsetof(struct live_settings, no_commands),
     .help = "leave standard input alone; always so where frames are read from it"},
    {.kind = OPTION_TEXT,
     .name = "--socket",
     .argument = "FILE",
     .offset = offsetof(struct live_settings, socket),
     .help = "make a Unix socket there that takes commands, too, and answers each with ok or "
             "refused and why"},
    {.kind = OPTION_FLAG,
     .name = "--json",
     .offset = offsetof(struct live_settings, engine.json),
     .help = "print a report as one JSON object; times in milliseconds"},
    {.help = NULL},
};

int64_t live_now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

bool live_is_over(struct live *live)
{
    return atomic_load(&live->quit) || interrupt_came();
}

void live_end(struct live *live)
{
    const uint64_t one = 1;

    atomic_store(&live->quit, true);
    if (write(live->wake_fd, &one, sizeof one) < 0)
        return;
    refocus_source_interrupt(live->camera);
    refocus_source_interrupt(live->depth_camera);
}

void live_fail(struct live *live, int exit_code, const char *what, const char *why)
{
    pthread_mutex_lock(&live->lock);
    if (live->exit_code == EXIT_DONE) {
        live->exit_code = exit_code;
        snprintf(live->what, sizeof live->what, "%s", what);
        snprintf(live->why, sizeof live->why, "%s", why);
    }
    pthread_mutex_unlock(&live->lock);
    live_end(live);
}

static void print_camera(void *user, const char *name, const char *description)
{
    (void)user;
    printf("%s  %s\n", name, description);
}

static int print_modes(const char *name)
{
    struct refocus_reason reason = {""};
    struct refocus_source_mode mode;
    struct refocus_source *source;
    const int status = refocus_source_open(&source, name, &reason);

    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), name, "%s", reason.text);
    for (int i = 0; refocus_source_get_mode(source, i, &mode) == REFOCUS_OK; i++)
        printf("%-6s %5dx%-5d %g fps\n", refocus_frame_format_name(mode.format), (int)mode.width,
               (int)mode.height, mode.fps);
    refocus_source_close(&source);
    return report_end_output();
}

static int list(const struct live_settings *settings)
{
    int n;

    if (settings->camera)
        return print_modes(settings->camera);
    n = refocus_source_list(print_camera, NULL);
    if (n < 0)
        return report_failure(EXIT_FAILED, "--list", "%s", refocus_strerror(n));
    return report_end_output();
}

static bool is_of_kind(const char *name, const char *kind)
{
    return strncmp(name, kind, strlen(kind)) == 0;
}

/* One of the kinds in a list that ends with NULL. */
static bool is_of(const char *name, const char *const *kind)
{
    for (; *kind; kind++)
        if (is_of_kind(name, *kind))
            return true;
    return false;
}

static bool is_source(const char *name)
{
    return is_of(name, (const char *const[]){
                           "v4l2:", "libcamera:", "file:", "y4m:", "raw:", "replay:", NULL});
}

static bool is_camera(const char *name)
{
    return is_of(name, (const char *const[]){"v4l2:", "libcamera:", NULL});
}

/* A picture stays for ever, and so does what begins again. */
static bool has_end(const struct live_settings *settings)
{
    const bool still = is_of_kind(settings->camera, "file:") && !strchr(settings->camera, '%');

    return settings->frames > 0 || settings->duration > 0 || !(still || settings->loop);
}

/*
 * From files to files no frame is left out, and where there is an end nothing waits for the clock:
 * the same files and commands make the same frames. A photo that stays, as if it were a camera,
 * keeps its pace.
 */
static void choose_pace(struct live_settings *settings)
{
    const bool files =
        is_of(settings->camera, (const char *const[]){"file:", "y4m:", "raw:", NULL}) &&
        (is_of(settings->out, (const char *const[]){"y4m:", "raw:", NULL}) ||
         (strchr(settings->out, '%') && !is_of_kind(settings->out, "v4l2:")));

    if (settings->policy == POLICY_DEFAULT)
        settings->policy = files ? POLICY_EVERY : POLICY_NEWEST;
    settings->offline = files && settings->policy == POLICY_EVERY && has_end(settings) &&
                        !is_camera(settings->depth.file);
    settings->fast |= settings->offline;
}

/* Frames from standard input leave no room for commands there. */
static bool is_standard_input(const char *name)
{
    return strcmp(name, "y4m:-") == 0 || is_of_kind(name, "raw:-,");
}

/* Options of one kind of source, where neither source is of it. */
static int check_sources(const struct live_settings *settings)
{
    const char *const camera = settings->camera, *const depth = settings->depth.file;
    const bool files = !is_camera(camera) || (is_source(depth) && !is_camera(depth));

    if (!files && (settings->fast || settings->loop))
        return report_failure(EXIT_WRONG, settings->fast ? "--fast" : "--loop",
                              "it is of files and scripts, not of cameras; leave it out");
    if (settings->dmabuf && !is_of_kind(camera, "v4l2:") && !is_of_kind(depth, "v4l2:"))
        return report_failure(EXIT_WRONG, "--dmabuf", "it is of V4L2 cameras; leave it out");
    return EXIT_DONE;
}

static int check(struct live_settings *settings)
{
    int status = input_check_depth(&settings->depth);

    if (status != EXIT_DONE)
        return status;
    if (!settings->camera)
        return report_failure(EXIT_WRONG, "--camera", "no source is given; --list shows some");
    if (!settings->depth.file)
        return report_failure(EXIT_WRONG, "--depth",
                              "no depth is given; give a source or a depth map");
    if (live_estimate_is_meant(settings->depth.file)) {
        status = live_estimate_parse(&settings->estimate, settings->depth.file);
        if (status != EXIT_DONE)
            return status;
    }
    if (!isnan(settings->lens.focus) && !isnan(settings->lens.focus_at[0]))
        return report_failure(EXIT_WRONG, "--focus-at",
                              "the focus is given twice; give --focus or --focus-at");
    status = check_sources(settings);
    if (status != EXIT_DONE)
        return status;
    if (settings->calibration && !is_source(settings->depth.file))
        return report_failure(EXIT_WRONG, "--calibration",
                              "it goes with a depth camera, not with a fixed map");
    if (isnan(settings->lens.blur))
        settings->lens.blur = 20;
    if (isnan(settings->blur_most))
        settings->blur_most = fmin(settings->lens.blur * 2, REFOCUS_MAX_BLUR_RADIUS);
    if (settings->blur_most < settings->lens.blur)
        return report_failure(EXIT_WRONG, "--blur-most", "it is less than --blur %g",
                              settings->lens.blur);
    choose_pace(settings);
    settings->no_commands |=
        is_standard_input(settings->camera) || is_standard_input(settings->depth.file);
    if (settings->engine.json && strcmp(settings->out + strcspn(settings->out, ":"), ":-") == 0)
        return report_failure(EXIT_WRONG, "--json",
                              "standard output is taken by --out; give a file there");
    return EXIT_DONE;
}

static int open_camera(struct live *live, const char *name, bool depth,
                       struct refocus_source **source, struct refocus_source_mode *mode)
{
    const struct live_settings *settings = live->settings;
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_reason reason = {""};
    int status;

    if (!depth) {
        config.format = (uint32_t)settings->format;
        config.width = isnan(settings->size[0]) ? 0 : (int32_t)settings->size[0];
        config.height = isnan(settings->size[0]) ? 0 : (int32_t)settings->size[1];
    }
    config.fps = isnan(settings->fps) ? 0 : settings->fps;
    config.flags =
        (settings->fast ? REFOCUS_SOURCE_FAST : 0) | (settings->loop ? REFOCUS_SOURCE_LOOP : 0) |
        (settings->dmabuf ? REFOCUS_SOURCE_DMABUF : 0) | (depth ? REFOCUS_SOURCE_DEPTH : 0);
    status = refocus_source_open(source, name, &reason);
    if (status == REFOCUS_OK)
        status = refocus_source_start(*source, &config, mode, &reason);
    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), name, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_DONE;
}

static int open_all(struct live *live)
{
    const struct live_settings *settings = live->settings;
    struct refocus_reason reason = {""};
    int status = live_commands_open(live);

    if (status == EXIT_DONE && settings->calibration)
        status = live_read_calibration(&live->calibration, settings->calibration);
    if (status == EXIT_DONE)
        status = open_camera(live, settings->camera, false, &live->camera, &live->mode);
    if (status == EXIT_DONE && is_source(settings->depth.file))
        status =
            open_camera(live, settings->depth.file, true, &live->depth_camera, &live->depth_mode);
    else if (status == EXIT_DONE && settings->estimate.model[0])
        status = live_estimate_open(live);
    else if (status == EXIT_DONE)
        status = live_read_fixed_depth(live);
    if (status != EXIT_DONE)
        return status;
    status = refocus_sink_open(&live->sink, settings->out, &reason);
    if (status != REFOCUS_OK)
        return report_failure(input_exit_code(status), settings->out, "%s", reason.text);
    return EXIT_DONE;
}

/* Formats that the method and the sink take without a detour by way of RGB. */
static uint32_t find_yuv_formats(struct live *live)
{
    uint32_t formats = 0;

    if (live->engine->params.method != REFOCUS_METHOD_SWEEP)
        return 0;
    for (uint32_t format = 0; format < 32; format++)
        if (refocus_format_is_yuv(format) && refocus_sink_takes(live->sink, format))
            formats |= UINT32_C(1) << format;
    return formats;
}

/* The threads, and this one renders; then all is over. */
static void run_threads(struct live *live)
{
    enum { CAPTURE, DEPTH, ESTIMATE, OUTPUT, COMMANDS, THREADS };
    const struct live_settings *settings = live->settings;
    static void *(*const main_of[])(void *) = {[CAPTURE] = live_capture_thread,
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
    bool running[THREADS] = {false};

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
    /* What is rendered already is still written, unless something failed. */
    if (running[OUTPUT])
        pthread_join(thread[OUTPUT], NULL);
    live_end(live);
    live_depths_end(&live->depths);
    live_queue_close(&live->captured);
    live_queue_close(&live->rendered);
    live_queue_close(&live->to_estimate);
    for (int i = 0; i < THREADS; i++)
        if (running[i] && i != OUTPUT)
            pthread_join(thread[i], NULL);
}

static int run_live(struct live *live)
{
    struct refocus_reason reason = {""};
    int status = open_all(live);

    if (status == EXIT_DONE) {
        live->yuv_formats = find_yuv_formats(live);
        run_threads(live);
        if (live->exit_code != EXIT_DONE)
            status = report_failure(live->exit_code, live->what, "%s", live->why);
    }
    if (refocus_sink_close(&live->sink, &reason) != REFOCUS_OK && status == EXIT_DONE)
        status = report_failure(EXIT_FAILED, live->settings->out, "%s", reason.text);
    if (status == EXIT_DONE)
        status = live_report(live);
    refocus_source_close(&live->camera);
    refocus_source_close(&live->depth_camera);
    live_commands_close(live);
    live_estimate_close(live);
    free(live->calibration);
    return status;
}

static int run(int argc, char **argv)
{
    struct live_settings settings = {.depth = DEPTH_SETTINGS_NONE,
                                     .lens = LENS_SETTINGS_NONE,
                                     .engine = ENGINE_SETTINGS_NONE(1),
                                     .size = {NAN, NAN},
                                     .fps = NAN,
                                     .blur_most = NAN,
                                     .patience = 10,
                                     .policy = POLICY_DEFAULT,
                                     .out = "null"};
    struct engine engine;
    struct live *live;
    const char *files[1];
    int status;

    status = options_parse(&live_command, argc, argv, &settings, files);
    if (status != OPTIONS_PARSED)
        return status;
    if (settings.list)
        return list(&settings);
    status = check(&settings);
    if (status != EXIT_DONE)
        return status;
    live = calloc(1, sizeof *live);
    if (!live)
        return report_failure(EXIT_FAILED, "live", "not enough memory");
    live->settings = &settings;
    live->engine = &engine;
    live->lens_dioptres = live->focus_disparity = live->blur = NAN;
    live->command_fd = -1;
    live->wake_fd = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    pthread_mutex_init(&live->lock, NULL);
    sem_init(&live->first_commands, 0, 0);
    live_queue_init(&live->captured, settings.policy);
    live_queue_init(&live->rendered, settings.policy);
    live_queue_init(&live->to_estimate, settings.policy);
    live_depths_init(&live->depths, settings.policy == POLICY_EVERY);
    live_focus_init(&live->focus, &settings);
    live->focus.blur = settings.lens.blur;
    live->focus.blur_most = settings.blur_most;
    status = engine_begin(&engine, &settings.engine);
    if (status == EXIT_DONE)
        status = run_live(live);
    engine_end(&engine);
    live_queue_free(&live->captured);
    live_queue_free(&live->rendered);
    live_queue_free(&live->to_estimate);
    live_depths_free(&live->depths);
    pthread_mutex_destroy(&live->focus.lock);
    pthread_mutex_destroy(&live->lock);
    sem_destroy(&live->first_commands);
    if (live->wake_fd >= 0)
        close(live->wake_fd);
    free(live);
    return status;
}

const struct command live_command = {
    .name = "live",
    .usage = "--camera SOURCE --depth SOURCE [--out SINK] [options]",
    .summary = "camera in, refocused frames out",
    .notes = "While it runs, standard input (and --socket) takes a command a line: focus D, "
             "focus-at X,Y, "
             "pull D SECONDS, pull-at X,Y SECONDS (smooth), blur K, quit. Depth is paired with "
             "colour by time within half a frame; without a pair the newest depth serves, or, "
             "with --frames-policy every, the nearest in time. "
             "After a fault the camera is opened again; platform/README.md lists faults and "
             "outcomes. Ctrl-C ends it with status 0.",
    .options = options,
    .files_least = 0,
    .files_most = 0,
    .run = run,
};
