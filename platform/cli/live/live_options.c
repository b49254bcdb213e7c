/* live_options.c: the options of refocus live, and what is wrong with them together. */
#include <string.h>
#include <refocus/platform/source.h>
#include "line/report.h"
#include "live/live_estimate.h"
#include "live/live_look.h"
#include "live/live_options.h"
#include "live/live_stack.h"
#include "inputs/depth_options.h"
#include "shot/shot_options.h"

static const struct option_word policy_words[] = {
    {"newest", "a new frame replaces one that waits: least delay"},
    {"every", "each frame is rendered; the source waits or drops"},
    {0}};

static const char *format_name(uint32_t index)
{
    return index == 0 ? "any" : refocus_frame_format_name(index);
}

/* Frames of a camera have no thin structures splatted, nor texture continued. The best of Y, U and
 * V have silhouettes without a halo, and a still what `render` has but for texture. */
static const char *quality_summary(uint32_t index)
{
    static const char *const rays[] = {
        "32 rays", "64 rays",
        ("128 rays; of Y, U and V also no halo beside what is in focus, of a single picture "
         "(file:) that and thin structures splatted")};
    return index < sizeof rays / sizeof *rays ? rays[index] : engine_quality_words[index].summary;
}

static const struct option_word matrix_words[] = {
    [REFOCUS_MATRIX_BT601] = {"bt601", NULL}, [REFOCUS_MATRIX_BT709] = {"bt709", NULL}, {0}};

const struct option live_options[] = {
    {.kind = OPTION_HEADING, .help = "In and out"},
    {OPTION(OPTION_TEXT, "--camera", "SOURCE", struct live_settings, camera),
     .brief = "v4l2:/dev/video0, libcamera:0, pipewire:, ...",
     .help = "v4l2:/dev/video0, libcamera:0, pipewire:[NODE], file:frames-%04d.png, y4m:FILE, "
             "raw:FILE,NV12,640x480,30 or replay:SCRIPT"},
    {OPTION(OPTION_TEXT, "--depth", "SOURCE", struct live_settings, depth.file),
     .brief = "such a source, a map, estimate:MODEL.onnx, or stack:",
     .help = "depth beside it: such a source of Y16, Z16 or GREY, the file of one fixed depth "
             "map, or estimate:MODEL.onnx[,every=N][,preset=NAME], a network that sees every "
             "N-th picture; or stack:[steps=N][,far=P,near=P][,average=N][,settle=MS], for still "
             "scenes: the camera moves its lens, and a focus stack becomes the depth, at the "
             "beginning and at each command 'stack'; the parts are the options of refocus stack"},
    GROUP(depth_unit_options, struct live_settings, depth),
    GROUP(invalid_options, struct live_settings, depth),
    {OPTION(OPTION_NUMBER, "--steady", "S", struct live_settings, steady), .least = 0,
     .greatest = 0.95, .brief = "calm the flicker of depth: 0 to 0.95",
     .help = "calm the flicker of depth: share of the past where nothing moves, 0 (default) "
             "to 0.95"},
    GROUP(upsample_options, struct live_settings, depth),
    {OPTION(OPTION_CHOICE, "--depth-edges", "HOW", struct live_settings, depth.edges),
     .words = edges_words,
     .help = "the edges of the depth, steady from frame to frame; default as-given, which takes no "
             "time"},
    {OPTION(OPTION_TEXT, "--calibration", "FILE", struct live_settings, calibration),
     .help = "JSON of two pinhole cameras, by which depth is registered onto colour"},
    {OPTION(OPTION_TEXT, "--out", "SINK", struct live_settings, out), .letter = 'o',
     .brief = "window, pipewire:, v4l2:/dev/video9, y4m:FILE, ...",
     .help = "window, v4l2:/dev/video9, pipewire:[NAME] (a camera that browsers list), y4m:FILE, "
             "raw:FILE[,FORMAT], frames-%04d.png or null "
             "(default); FILE may be - for standard output, FORMAT own (as frames come), NV12, "
             "NV21, YUV420, YUYV, UYVY, RGB24 (default), BGR24, RGBX or BGRX"},
    {OPTION(OPTION_FLAG, "--list", NULL, struct live_settings, list),
     .brief = "list the cameras, or the modes of --camera, and end",
     .help = "list the cameras, or the modes of --camera, and end"},
    {OPTION(OPTION_CHOICE, "--format", "NAME", struct live_settings, format), .choice = format_name,
     .help = "pixel format that the camera shall deliver"},
    {OPTION(OPTION_NUMBERS, "--size", "WxH", struct live_settings, size), .least = 1,
     .greatest = REFOCUS_MAX_SIDE, .count = 2,
     .help = "size of its frames; the nearest that there is is taken"},
    {OPTION(OPTION_NUMBER, "--fps", "N", struct live_settings, fps), .least = 0, .above = true,
     .greatest = 10000, .fraction = true,
     .help = "frames a second, also as 30000/1001; default as the source has them, and where it "
             "does not say, as "
             "file: and raw: without a rate, as the other of camera and depth has them, else 30"},
    {OPTION(OPTION_CHOICE, "--matrix", "NAME", struct live_settings, matrix), .words = matrix_words,
     .help = "how Y, U and V of its frames become R, G and B; default as the source says, and of "
             "y4m: and raw:, which cannot, bt709 from 1280 columns or 577 rows on, else bt601"},
    {OPTION(OPTION_TEXT, "--autofocus", "HOW", struct live_settings, focus_way),
     .help = "the camera's own lens: off (it stays where it is), once, continuous, or fixed:P at a "
             "position, which --list shows with --camera; default as the camera does, with "
             "libcamera continuous"},
    {.kind = OPTION_HEADING, .help = "Focus and blur"},
    {OPTION(OPTION_NUMBER, "--focus", "D", struct live_settings, lens.focus), .least = 0,
     .greatest = 1, .brief = "disparity in focus: 1 nearest, 0 farthest",
     .help = "disparity in focus: 1 nearest, 0 farthest"},
    {OPTION(OPTION_NUMBERS, "--focus-at", "X,Y", struct live_settings, lens.focus_at),
     .least = -INFINITY, .greatest = INFINITY, .count = 2,
     .brief = "focus on the surface at that pixel, and stay there",
     .help = "focus on the surface at that pixel of the first frame, and stay at its distance; "
             "without any --focus...: where the camera's lens is, if it says so, else the centre"},
    {OPTION(OPTION_NUMBERS, "--focus-rectangle", "X,Y,W,H", struct live_settings,
            lens.focus_rectangle),
     .least = 0, .greatest = REFOCUS_MAX_SIDE, .count = 4,
     .help = "follow what the first frame shows in that rectangle, and focus on the nearest "
             "surface that has a quarter of it; while it is not to be seen the focus stays"},
    {OPTION(OPTION_NUMBER, "--focus-distance", "M", struct live_settings, lens.focus_distance),
     .least = 0, .above = true, .greatest = INFINITY,
     .help = "metres in focus, also 'inf'; the depth must be in metres"},
    {OPTION(OPTION_NUMBER, "--blur", "K", struct live_settings, lens.blur), .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS, .brief = "largest blur radius, pixels; default 20",
     .help = "blur radius in pixels of what lies farthest from the focus, default 20; when the "
             "range of distances moves, the lens stays, and goes back to K with a time constant "
             "of ten seconds"},
    {OPTION(OPTION_NUMBER, "--blur-most", "K", struct live_settings, blur_most), .least = 0,
     .greatest = REFOCUS_MAX_BLUR_RADIUS,
     .help = "the most that the command 'blur' may ask for, and a range that widens; default "
             "twice --blur, but no more than 127 if --blur is not, and 127 for --f-number"},
    {OPTION(OPTION_NUMBER, "--f-number", "N", struct live_settings, lens.f_number), .least = 0,
     .above = true, .greatest = 1000,
     .help = "blur of a lens of this f-number and --focal-length instead, up to --blur-most; the "
             "depth must be in metres"},
    {OPTION(OPTION_NUMBER, "--focal-length", "MM", struct live_settings, lens.focal_length),
     .least = 0, .above = true, .greatest = 100000, .help = "focal length for --f-number"},
    {OPTION(OPTION_NUMBER, "--sensor-width", "MM", struct live_settings, lens.sensor_width),
     .least = 0, .above = true, .greatest = 10000,
     .help = "width of the sensor area that the picture shows, with --focal-length; default: "
             "36 mm for the larger side of the picture"},
    GROUP(control_options, struct live_settings, engine),
    GROUP(bokeh_options, struct live_settings, engine),
    {.kind = OPTION_HEADING, .help = "Rendering"},
    GROUP(method_options, struct live_settings, engine),
    GROUP(ray_options, struct live_settings, engine),
    QUALITY_OPTION(struct live_settings, engine.quality, "standard", quality_summary),
    GROUP(search_options, struct live_settings, engine),
    GROUP(blend_options, struct live_settings, engine),
    {OPTION(OPTION_INTEGER, "--threads", "N", struct live_settings, engine.threads), .greatest = 64,
     .help = "0 = one for each processor, the default; never changes a picture"},
    {OPTION(OPTION_CHOICE, "--cpu", "NAME", struct live_settings, engine.cpu),
     .choice = refocus_cpu_name, .help = "instruction set"},
    {.kind = OPTION_HEADING, .help = "Running"},
    {OPTION(OPTION_CHOICE, "--frames-policy", "NAME", struct live_settings, policy),
     .words = policy_words,
     .help = "what becomes of frames that cannot be kept up with; default newest, and every "
             "from files (file:, y4m:, raw:) to files"},
    {OPTION(OPTION_INTEGER, "--frames", "N", struct live_settings, frames), .least = 1,
     .greatest = 1e15, .brief = "end after so many frames",
     .help = "end after so many frames are written"},
    {OPTION(OPTION_NUMBER, "--duration", "S", struct live_settings, duration), .least = 0,
     .above = true, .greatest = 1e9, .brief = "end after so many seconds",
     .help = "end after so many seconds; from files to files those of the frames"},
    {OPTION(OPTION_NUMBER, "--patience", "S", struct live_settings, patience), .least = 0,
     .greatest = 1e9, .help = "how long to wait for a device that went away, default 10 s"},
    {OPTION(OPTION_FLAG, "--fast", NULL, struct live_settings, fast),
     .help = "files and scripts: as fast as they can be read; always so from files to files"},
    {OPTION(OPTION_FLAG, "--loop", NULL, struct live_settings, loop),
     .help = "files: from the beginning again at the end; not of pipes"},
    {OPTION(OPTION_FLAG, "--dmabuf", NULL, struct live_settings, dmabuf),
     .help = "V4L2: buffers exported as DMA-BUF, each access bracketed by its sync ioctl"},
    {OPTION(OPTION_FLAG, "--no-commands", NULL, struct live_settings, no_commands),
     .help = "leave standard input alone; always so where frames are read from it"},
    {OPTION(OPTION_TEXT, "--socket", "FILE", struct live_settings, socket),
     .help = "make a Unix socket there that takes commands, too, and answers each with ok or "
             "refused and why"},
    {OPTION(OPTION_FLAG, "--json", NULL, struct live_settings, engine.json),
     .brief = "print a report as one JSON object",
     .help = "print a report as one JSON object; times in milliseconds"},
    GROUP(paper_options, struct live_settings, engine),
    {.help = NULL},
};

const struct live_settings live_settings_none = {
    .depth = {.near_m = NAN, .far_m = NAN, .edges = EDGES_AS_GIVEN},
    .lens = LENS_SETTINGS_NONE,
    .engine = ENGINE_SETTINGS_NONE(QUALITY_STANDARD, 1),
    .size = {NAN, NAN},
    .fps = NAN,
    .blur_most = NAN,
    .patience = 10,
    .policy = POLICY_DEFAULT,
    .matrix = -1,
    .out = "null"};

static bool is_of_kind(const char *name, const char *kind)
{
    return strncmp(name, kind, strlen(kind)) == 0;
}

/* A single picture stays for ever, and a loop begins again. */
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
    const bool files = refocus_source_kind(settings->camera) == REFOCUS_SOURCE_KIND_FILE &&
                       (is_of_kind(settings->out, "y4m:") || is_of_kind(settings->out, "raw:") ||
                        (strchr(settings->out, '%') && !is_of_kind(settings->out, "v4l2:")));

    if (settings->policy == POLICY_DEFAULT)
        settings->policy = files ? POLICY_EVERY : POLICY_NEWEST;
    settings->offline = files && settings->policy == POLICY_EVERY && has_end(settings) &&
                        refocus_source_kind(settings->depth.file) != REFOCUS_SOURCE_KIND_CAMERA;
    settings->fast |= settings->offline;
}

/* Frames from standard input leave no room for commands there. */
static bool is_standard_input(const char *name)
{
    return strcmp(name, "y4m:-") == 0 || is_of_kind(name, "raw:-,");
}

/* Some options are for one kind of source, and wrong where neither source is of that kind. */
static int check_sources(const struct live_settings *settings)
{
    const char *const camera = settings->camera, *const depth = settings->depth.file;
    const uint32_t of_camera = refocus_source_kind(camera), of_depth = refocus_source_kind(depth);
    const bool files =
        of_camera != REFOCUS_SOURCE_KIND_CAMERA ||
        (of_depth != REFOCUS_SOURCE_KIND_NONE && of_depth != REFOCUS_SOURCE_KIND_CAMERA);

    if (!files && (settings->fast || settings->loop))
        return report_failure(EXIT_WRONG, settings->fast ? "--fast" : "--loop",
                              "it is for files and scripts, not of cameras; leave it out");
    if (settings->dmabuf && !is_of_kind(camera, "v4l2:") && !is_of_kind(depth, "v4l2:"))
        return report_failure(EXIT_WRONG, "--dmabuf", "it is for V4L2 cameras; leave it out");
    return EXIT_DONE;
}

int live_check_settings(struct live_settings *settings)
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
    if (live_stack_is_meant(settings->depth.file)) {
        status = live_stack_parse(settings);
        if (status != EXIT_DONE)
            return status;
    }
    status = live_lens_parse(&settings->autofocus, settings->focus_way);
    if (status == EXIT_DONE && settings->autofocus.wanted && settings->stack.steps > 0)
        status = report_failure(EXIT_WRONG, "--autofocus",
                                "the lens takes a focus stack for --depth; leave it out");
    if (status == EXIT_DONE)
        status = live_look_check(settings);
    if (status == EXIT_DONE)
        status = check_sources(settings);
    if (status != EXIT_DONE)
        return status;
    if (settings->calibration && !refocus_source_kind(settings->depth.file))
        return report_failure(EXIT_WRONG, "--calibration",
                              "it goes with a depth camera, not with a fixed map");
    if (!isnan(settings->lens.f_number)) {
        if (isnan(settings->blur_most))
            settings->blur_most = REFOCUS_PLAIN_BLUR_RADIUS;
        settings->lens.blur = fmin(20, settings->blur_most); /* until the lens is known */
    }
    if (isnan(settings->lens.blur))
        settings->lens.blur = 20;
    if (isnan(settings->blur_most))
        settings->blur_most =
            fmax(settings->lens.blur, fmin(settings->lens.blur * 2, REFOCUS_PLAIN_BLUR_RADIUS));
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
