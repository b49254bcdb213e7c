/* pull.c: the command `refocus pull` renders an animation between focus settings. */
#include <stdio.h>
#include <stdlib.h>
#include "outputs/animation.h"
#include "commands/commands.h"
#include "settings/keys.h"
#include "outputs/outputs.h"
#include "line/report.h"
#include "settings/settings.h"
#include "shot/shot.h"
#include "views/stereo_views.h"
#include "inputs/depth_options.h"
#include "shot/shot_options.h"

struct settings {
    struct shot_settings shot;
    const char *output, *keys;
    double from, to, blur_from, blur_to, seconds, fps, wiggle; /* NAN: not given */
    int ease;
    bool back;
};

#define NUMBER(name_, argument_, field_, least_, greatest_, brief_, help_)                         \
    {                                                                                              \
        OPTION(OPTION_NUMBER, name_, argument_, struct settings, field_),                          \
            .least = least_, .greatest = greatest_, .brief = brief_, .help = help_                 \
    }

static const struct option options[] = {
    {.kind = OPTION_HEADING, .help = "Files"},
    OUTPUT_OPTION(struct settings, output,
                  "frames-%03d.png (" OUTPUT_PICTURES ") for a picture each; or a name in "
                  ".y4m, .apng, and by the ffmpeg program .mp4, .webm or .gif"),
    GROUP(shot_depth_options, struct settings, shot),
    GROUP(behind_options, struct settings, shot.behind),
    GROUP(light_options, struct settings, shot.depth),
    {.kind = OPTION_HEADING, .help = "The pull"},
    NUMBER("--from", "D", from, 0, 1, "disparity in focus at the beginning; default 1",
           "disparity in focus at the beginning; default 1"),
    NUMBER("--to", "D", to, 0, 1, "and at the end; default 0", "and at the end; default 0"),
    NUMBER("--blur-from", "K", blur_from, 0, REFOCUS_MAX_BLUR_RADIUS, NULL,
           "blur radius at the beginning; default --blur"),
    NUMBER("--blur-to", "K", blur_to, 0, REFOCUS_MAX_BLUR_RADIUS, NULL,
           "and at the end; default --blur"),
    {OPTION(OPTION_TEXT, "--keys", "FILE", struct settings, keys),
     .help = "JSON list of key frames in place of these; see below"},
    NUMBER("--seconds", "S", seconds, 0.01, 3600, "how long it takes; default 2",
           "how long it takes; default 2"),
    {OPTION(OPTION_NUMBER, "--fps", "N", struct settings, fps), .least = 1, .greatest = 240,
     .fraction = true, .brief = "frames a second; default 25",
     .help = "frames a second, also as 30000/1001; default 25"},
    {OPTION(OPTION_CHOICE, "--ease", "HOW", struct settings, ease), .words = ease_words,
     .help = "how it goes from one to the other; default smooth"},
    {OPTION(OPTION_FLAG, "--back", NULL, struct settings, back),
     .help = "and the same way back, so that it can be repeated"},
    NUMBER("--wiggle", "PIXELS", wiggle, 0, STEREO_MOST, NULL,
           "in place of a pull: the eye swings sideways, and what is not in focus "
           "moves by so many pixels, at disparity 1 when 0 is in focus"),
    GROUP(shot_lens_options, struct settings, shot),
    GROUP(shot_method_options, struct settings, shot),
    {.kind = OPTION_HEADING, .help = "Running"},
    CONFIG_OPTIONS(struct settings, shot.config, shot.preset, NULL),
    SETTINGS_OPTION(struct settings, shot.load),
    SAVE_SETTINGS_OPTION(struct settings, shot.save),
    GROUP(run_options, struct settings, shot.engine),
    GROUP(paper_options, struct settings, shot.engine),
    {.help = NULL},
};

static double given(double value, double otherwise)
{
    return isnan(value) ? otherwise : value;
}

/* Keys of the options: focus, and blur where that moves. */
static int make_keys(struct keys **keys, const struct settings *s, double blur)
{
    const double end = given(s->seconds, 2);
    int status = keys_add(keys, 0, "focus", given(s->from, 1), EASE_SMOOTH);

    if (status == EXIT_DONE)
        status = keys_add(keys, 0, "blur", given(s->blur_from, blur), EASE_SMOOTH);
    if (status == EXIT_DONE)
        status = keys_add(keys, end, "focus", given(s->to, 0), (enum ease)s->ease);
    if (status == EXIT_DONE)
        status = keys_add(keys, end, "blur", given(s->blur_to, blur), (enum ease)s->ease);
    return status;
}

/* The options' focus is that of a wiggle, or where keys name none. A pull's own takes
 * its place, but for the line that --tilt-angle turns about. */
static int check_focus(const struct settings *s, int argc, char **argv)
{
    static const char *const names[] = {"--focus", "--focus-distance", "--focus-rectangle", NULL};
    static const char *const point[] = {"--focus-at", NULL};
    static const char why[] = "--from and --to are in its place; leave it out";
    const struct control_settings *controls = &s->shot.engine.controls;
    const bool turns = !isnan(controls->tilt_angle) && isnan(controls->tilt_line[0]);

    int status = EXIT_DONE;

    if (s->keys || !isnan(s->wiggle))
        return EXIT_DONE;
    if (!turns)
        status = options_refuse(&pull_command, argc, argv, point, why);
    return status == EXIT_DONE ? options_refuse(&pull_command, argc, argv, names, why) : status;
}

static int check(struct settings *s, const char *photo, int argc, char **argv)
{
    const char *inputs[SHOT_INPUTS + 1];
    int count = shot_inputs(&s->shot, photo, inputs);
    int status = shot_check(&s->shot, true); /* each frame has a focus of its own */

    inputs[count++] = s->keys;
    if (status == EXIT_DONE)
        status = check_focus(s, argc, argv);
    if (status == EXIT_DONE && (s->keys || !isnan(s->wiggle)) &&
        options_given(&pull_command, argc, argv, "--ease"))
        status = report_failure(EXIT_WRONG, "--ease",
                                "is for the way from --from to --to; leave it or %s out",
                                s->keys ? "--keys" : "--wiggle");
    if (status == EXIT_DONE && s->keys &&
        !(isnan(s->from) && isnan(s->to) && isnan(s->blur_from) && isnan(s->blur_to) &&
          isnan(s->seconds)))
        status = report_failure(EXIT_WRONG, "--keys",
                                "is in place of --from, --to, --blur-from, --blur-to "
                                "and --seconds; leave them out");
    if (status == EXIT_DONE && !isnan(s->wiggle) &&
        (s->keys || s->back ||
         !(isnan(s->from) && isnan(s->to) && isnan(s->blur_from) && isnan(s->blur_to))))
        status = report_failure(EXIT_WRONG, "--wiggle",
                                "is in place of --keys, --from, --to, --blur-from, "
                                "--blur-to and --back; leave them out");
    if (status == EXIT_DONE && !isnan(s->wiggle) && s->shot.behind.image)
        status = report_failure(EXIT_WRONG, "--behind",
                                "is what one eye cannot see; leave it or --wiggle out");
    if (status == EXIT_DONE)
        status = animation_check(s->output, inputs, count);
    if (status == EXIT_DONE && s->shot.save)
        status = settings_check(s->shot.save, inputs, count);
    return status;
}

/* Frame i of a pull of `there` frames, and as many back but the two ends. */
static int position(int i, int there)
{
    return i < there ? i : 2 * (there - 1) - i;
}

/* Frame i of `count` that go round: the eye swings as sin. */
static double swing(double parallax, int i, int count)
{
    const double turn = 6.283185307179586;

    return parallax / 2 * sin(turn * i / count);
}

static int render_frame(struct shot *shot, const struct keys *keys, const struct stereo *stereo,
                        const struct settings *s, int i, int count, int there,
                        const struct refocus_image *out)
{
    if (stereo)
        return stereo_render(stereo, shot, swing(s->wiggle, i, count), out);
    keys_apply(keys, position(i, there) / given(s->fps, 25), &shot->engine.params);
    return engine_render(&shot->engine, out, 1);
}

/* stereo: NULL in a pull. */
static int write_frames(struct shot *shot, const struct keys *keys, const struct stereo *stereo,
                        const struct settings *s, int *frames)
{
    const double fps = given(s->fps, 25);
    const double seconds = stereo ? given(s->seconds, 2) - 1 / fps : keys_seconds(keys);
    const int there = (int)(seconds * fps + 0.5) + 1;
    const int count = s->back && there > 2 ? 2 * there - 2 : there;
    const double whole[4] = {NAN};
    struct refocus_image out;
    struct animation *animation = NULL;
    int status = shot_output(shot, whole, stereo ? NULL : s->output, &out), closed;

    if (status != EXIT_DONE)
        return status;
    status = animation_open(&animation, s->output, out.width, out.height, fps, count);
    for (int i = 0; i < count && status == EXIT_DONE; i++) {
        status = render_frame(shot, keys, stereo, s, i, count, there, &out);
        if (status == EXIT_DONE)
            status = animation_write(animation, &out);
        report_progress("pulling", (i + 1.0) / count);
    }
    closed = animation_close(animation, status == EXIT_DONE);
    *frames = count;
    free(out.plane[0]);
    return status == EXIT_DONE ? closed : status;
}

static int wiggle(struct shot *shot, const struct settings *s, int *frames)
{
    struct stereo stereo;
    int status = stereo_open(&stereo, shot);

    if (status == EXIT_DONE)
        status = write_frames(shot, NULL, &stereo, s, frames);
    stereo_close(&stereo);
    return status;
}

static int pull(struct shot *shot, const char *photo, struct keys **keys, const struct settings *s,
                int *frames)
{
    struct shot_settings wanted = s->shot;
    double most_blur = fmax(given(s->blur_from, 0), given(s->blur_to, 0));
    int status = s->keys ? keys_load(keys, s->keys) : EXIT_DONE;

    if (status == EXIT_DONE && *keys)
        most_blur = keys_most(*keys, "blur", 0);
    if (status != EXIT_DONE)
        return status;
    if (isnan(s->wiggle) && !input_focus_is_given(&wanted.lens))
        /* each frame has its own: none is found */
        wanted.lens.focus = given(s->from, 1);
    if (isnan(s->wiggle))
        shot_suit_output(&wanted.depth, s->output);
    status = shot_open(shot, photo, &wanted, most_blur);
    if (status == EXIT_DONE && !isnan(s->wiggle))
        return wiggle(shot, s, frames);
    if (status == EXIT_DONE && !*keys)
        status = make_keys(keys, s, (double)shot->engine.params.render.max_blur_radius);
    if (status == EXIT_DONE)
        status = write_frames(shot, *keys, NULL, s, frames);
    return status;
}

static int print_report(const struct settings *s, const struct shot *shot, int frames)
{
    const struct refocus_image *photo = shot->input.photo->image;
    json_t *json, *blur;

    if (!s->shot.engine.json)
        return EXIT_DONE;
    json = json_pack("{s:o, s:o, s:i, s:i, s:i, s:f, s:s}", "photo",
                     report_text_json(shot->input.photo_name), "output",
                     report_text_json(s->output), "width", (int)photo->width, "height",
                     (int)photo->height, "frames", frames, "fps", given(s->fps, 25), "method",
                     refocus_method_name(shot->engine.params.render.method));
    blur = input_blur_json(&shot->input, &s->shot.lens);
    if (json && json_object_update(json, blur) != 0) {
        json_decref(json);
        json = NULL;
    }
    json_decref(blur);
    return report_print_json(json);
}

static int run(int argc, char **argv)
{
    struct settings settings = {.shot = SHOT_SETTINGS_NONE,
                                .from = NAN,
                                .to = NAN,
                                .blur_from = NAN,
                                .blur_to = NAN,
                                .seconds = NAN,
                                .fps = NAN,
                                .wiggle = NAN};
    struct keys *keys = NULL;
    struct shot shot = {.engine = {.spool = -1}};
    const char *files[2];
    int frames = 0, status = options_parse(&pull_command, argc, argv, &settings, files);

    if (status != OPTIONS_PARSED)
        return status;
    status = check(&settings, files[0], argc, argv);
    if (status != EXIT_DONE)
        return status;
    status = pull(&shot, files[0], &keys, &settings, &frames);
    report_progress_end();
    if (status == EXIT_DONE && settings.shot.save)
        status = settings_save(&pull_command, settings.shot.save, &settings);
    if (status == EXIT_DONE)
        status = print_report(&settings, &shot, frames);
    keys_free(keys);
    shot_close(&shot);
    return status;
}

const struct command pull_command = {
    .name = "pull",
    .usage = "PHOTO -o OUT [options]",
    .summary = "focus pull: an animation between focus settings",
    .notes = "A file of --keys: {\"refocus-pull\": 1, \"keys\": [{\"time\": 0, \"focus\": 1, "
             "\"blur\": 12}, {\"time\": 1.5, \"focus\": 0.2, \"ease\": \"in\"}]}. Keys may name "
             "focus, blur, highlights, focus-width, focus-transition, cat-eye, field-x, field-y, "
             "field-disparity, field-radius, field-falloff and field-angle; \"ease\" is how the "
             "way to a key goes: smooth, linear, in (slowly at first), out (slowly in the end).\n"
             "Ctrl-C ends with status 1 and leaves nothing behind.",
    .table = options,
    .files_least = 1,
    .files_most = 1,
    .run = run,
};
