/* serve.c: the command `refocus serve` shows photos as a page for a browser. */
#include <signal.h>
#include <stdio.h>
#include <unistd.h>
#include "commands/commands.h"
#include "line/interrupt.h"
#include "line/module.h"
#include "line/report.h"
#include "serve/browser.h"
#include "serve/serving.h"
#include "inputs/depth_options.h"

struct settings {
    struct serve_base base;
    const char *listen, *origin;
    double port, upload, memory; /* NAN: not given */
    bool open;                   /* open the page in a browser */
};

enum { PORT = 8085, MOST_UPLOAD_MIB = 100 };

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Network"},
    {OPTION(OPTION_INTEGER, "--port", "N", struct settings, port), .greatest = 65535,
     .brief = "port to listen on; default 8085",
     .help = "port to listen on; 0 = any that is free; default 8085", .elsewhere = true},
    {OPTION(OPTION_TEXT, "--listen", "ADDRESS", struct settings, listen),
     .brief = "address to listen on; default 127.0.0.1, this machine alone",
     .help = "address to listen on, in numbers of IPv4 or IPv6; default 127.0.0.1, this machine "
             "alone. Of another one, what is sent can be read on the way, the link too: use it "
             "within a network that you trust",
     .elsewhere = true},
    {OPTION(OPTION_TEXT, "--origin", "URL", struct settings, origin),
     .help = "where an encrypted server that passes all requests on shows the page, such as "
             "https://photos.example.org: its name is taken as this one's own, and the link is "
             "printed with it",
     .elsewhere = true},
    {OPTION(OPTION_INTEGER, "--max-upload", "MIB", struct settings, upload), .least = 1,
     .greatest = 4096, .help = "refuse photos that are sent and larger, in MiB; default 100",
     .elsewhere = true},
    {OPTION(OPTION_INTEGER, "--session-memory", "MIB", struct settings, memory), .least = 64,
     .greatest = 1e9,
     .help = "memory of all open photos together, in MiB: beyond it those are closed that nobody "
             "has used for longest; default half the machine's",
     .elsewhere = true},
    {.kind = OPTION_HEADING, .help = "Live view"},
    {OPTION(OPTION_TEXT, "--live", "SOURCE", struct settings, base.live.camera),
     .brief = "a camera for the page, as of refocus live",
     .help = "a camera that the page shows, too: a source as of refocus live --camera",
     .elsewhere = true},
    {OPTION(OPTION_TEXT, "--depth", "SOURCE", struct settings, base.live.depth.file),
     .help = "depth beside it: a source as of refocus live --depth, a depth map, or "
             "estimate:MODEL.onnx. A photo gets its map by refocus depth",
     .elsewhere = true},
    GROUP(depth_unit_options, struct settings, base.live.depth),
    {.kind = OPTION_HEADING, .help = "Photos"},
    GROUP(upsample_options, struct settings, base.shot.depth),
    GROUP(depth_edges_options, struct settings, base.shot.depth),
    GROUP(limit_options, struct settings, base.shot.depth.limits),
    {.kind = OPTION_HEADING, .help = "Running"},
    {OPTION(OPTION_INTEGER, "--threads", "N", struct settings, base.shot.engine.threads),
     .elsewhere = true, .greatest = 64,
     .help =
         "of each open photo; 0 = one for each processor, the default; never changes the result"},
    {OPTION(OPTION_CHOICE, "--cpu", "NAME", struct settings, base.shot.engine.cpu),
     .elsewhere = true, .choice = refocus_cpu_name,
     .help = "instruction set, auto = the best that there is, the default; never changes the "
             "result"},
    {.help = NULL},
};

/* The link is all that is printed, for scripts too. */
static void tell_link(void *of, const char *link)
{
    (void)of;
    printf("%s\n", link);
    report_end_output();
}

static void open_link(void *of, const char *link)
{
    tell_link(of, link);
    browser_open(link);
}

static uint64_t memory_limit(double mebibytes)
{
    if (!isnan(mebibytes))
        return (uint64_t)mebibytes << 20;
    return (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE) / 2;
}

static int serve(struct settings *settings, const char *path)
{
    struct serve_base *const base = &settings->base;
    struct rf_web_setup setup = {
        .address = settings->listen ? settings->listen : "127.0.0.1",
        .port = !isnan(settings->port) ? (int)settings->port
                : settings->open       ? 0
                                       : PORT,
        .path = path,
        .origin = settings->origin,
        .live = base->live.camera != NULL,
        .most_upload = (uint64_t)(isnan(settings->upload) ? MOST_UPLOAD_MIB : settings->upload)
                       << 20,
        .most_memory = memory_limit(settings->memory),
        .ready = settings->open ? open_link : tell_link,
        .work = serve_work,
        .of = base,
    };
    static const struct module_function server = {"../web/refocus-web.so", "refocus/refocus-web.so",
                                                  "rf_web_run", "the server", "libmicrohttpd"};
    int (*run_server)(const struct rf_web_setup *, char *);
    char why[MODULE_WHY] = "";
    int status = EXIT_DONE;

    if (!module_load(&server, &run_server, why))
        return report_failure(EXIT_FAILED, "serve", "%s", why);
    /* The rest is for the photo and its pictures. */
    base->shot.engine.memory_kib = (int64_t)(setup.most_memory / 1024 / 4 * 3);
    signal(SIGPIPE, SIG_IGN);
    interrupt_wait_begin();
    setup.signals = interrupt_wait_file();
    if (setup.signals < 0)
        return report_failure(EXIT_FAILED, "serve", "no file for signals can be had");
    if (run_server(&setup, why) != 0)
        status = report_failure(EXIT_FAILED, path ? path : "serve", "%s", why);
    close(setup.signals);
    interrupt_take();
    return status;
}

static int parse_and_serve(int argc, char **argv, bool open)
{
    struct settings settings = {.base = {.shot = SHOT_SETTINGS_NONE},
                                .port = NAN,
                                .upload = NAN,
                                .memory = NAN,
                                .open = open};
    struct shot_settings *const shot = &settings.base.shot;
    const char *files[2] = {NULL};
    int status;

    serve_live_none(&settings.base);
    status = options_parse(&serve_command, argc, argv, &settings, files);

    if (status != OPTIONS_PARSED)
        return status;
    shot->depth.optional = true;
    shot->depth.deep = DEEP_LIGHT;
    shot->depth.light = true;
    status = shot_check(shot, false);
    if (status == EXIT_DONE)
        status = serve_live_check(&settings.base);
    return status == EXIT_DONE ? serve(&settings, files[0]) : status;
}

static int run(int argc, char **argv)
{
    return parse_and_serve(argc, argv, false);
}

int serve_in_browser(int argc, char **argv)
{
    return parse_and_serve(argc, argv, true);
}

const struct command serve_command = {
    .name = "serve",
    .usage = "[PHOTO | FOLDER] [options]",
    .summary = "refocus photos on a page in a browser",
    .notes = "Prints a link to open in a browser, and serves until Ctrl-C. Whoever has the link "
             "can see the photos of the folder, and send photos of their own; nobody can change "
             "or add a file. Of a photo that is open there is a process; what is saved goes to "
             "the browser.",
    .table = options,
    .files_least = 0,
    .files_most = 1,
    .run = run,
};
