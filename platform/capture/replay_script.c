/* replay_script.c: the script of a replay source is parsed; platform/README.md describes it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "failure.h"
#include "file/number.h"
#include "layout.h"
#include "pattern.h"
#include "replay_script.h"

static const struct {
    const char *name;
    enum rf_fault fault;
    bool needs_value;
} faults[] = {
    {"drop", RF_FAULT_DROP, false},     {"corrupt", RF_FAULT_CORRUPT, false},
    {"late", RF_FAULT_LATE, true},      {"timestamp", RF_FAULT_TIMESTAMP, true},
    {"stall", RF_FAULT_STALL, true},    {"fail", RF_FAULT_FAIL, false},
    {"vanish", RF_FAULT_VANISH, true},  {"queue-error", RF_FAULT_QUEUE_ERROR, false},
    {"stride", RF_FAULT_STRIDE, true},  {"format", RF_FAULT_FORMAT, false},
    {"memory", RF_FAULT_MEMORY, false},
};

static bool parse_number(const char *text, double least, double greatest, double *value)
{
    return text && rf_parse_number(text, value) && *value >= least && *value <= greatest;
}

static bool parse_size(const char *text, int *width, int *height)
{
    char rest;

    return text && sscanf(text, "%6dx%6d%c", width, height, &rest) == 2 && *width > 0 &&
           *height > 0 && *width <= REFOCUS_MAX_SIDE && *height <= REFOCUS_MAX_SIDE;
}

/* "at 12 vanish 500", "at 12 format YUYV 320x240" */
static bool parse_event(struct rf_script *script, const char *word[4])
{
    struct rf_event *event = &script->event[script->events];
    double frame, value = 1;

    if (script->events == RF_MOST_EVENTS || !word[1] || !word[2] ||
        !parse_number(word[1], 0, 1e15, &frame))
        return false;
    memset(event, 0, sizeof *event);
    event->frame = (int64_t)frame;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        if (strcmp(word[2], faults[i].name) != 0)
            continue;
        event->fault = faults[i].fault;
        if (event->fault == RF_FAULT_FORMAT) {
            const char *size = strchr(word[3] ? word[3] : "", ',');
            char name[16];

            if (!size || (size_t)(size - word[3]) >= sizeof name)
                return false;
            snprintf(name, sizeof name, "%.*s", (int)(size - word[3]), word[3]);
            event->format = rf_format_by_name(name);
            if (event->format == REFOCUS_FRAME_ANY || event->format == REFOCUS_FRAME_MJPEG ||
                !parse_size(size + 1, &event->width, &event->height))
                return false;
        } else if (word[3] ? !parse_number(word[3], -1e9, 1e9, &value) : faults[i].needs_value) {
            return false;
        }
        event->value = (int64_t)value;
        script->events++;
        return true;
    }
    return false;
}

static bool set_text(struct rf_script *script, char **text, const char *value)
{
    const bool there = value && *value;

    free(*text);
    *text = there ? strdup(value) : NULL;
    script->lacks_memory |= there && !*text;
    return *text != NULL;
}

static bool parse_line(struct rf_script *script, const char *word[4])
{
    const char *key = word[0];
    double value;

    if (strcmp(key, "at") == 0)
        return parse_event(script, word);
    if (strcmp(key, "from") == 0) /* scripts within scripts might never end */
        return word[1] && strncmp(word[1], "replay:", 7) != 0 &&
               set_text(script, &script->from, word[1]);
    if (strcmp(key, "stack") == 0)
        return rf_pattern_check(word[1] ? word[1] : "") == 1 &&
               parse_number(word[2], 2, 1000, &script->pictures) &&
               set_text(script, &script->stack, word[1]);
    if (strcmp(key, "lens") == 0)
        return parse_number(word[1], 0, 1e6, &script->lens[0]) &&
               parse_number(word[2], script->lens[0], 1e6, &script->lens[1]);
    if (strcmp(key, "lens-error") == 0)
        return parse_number(word[1], -1e6, 1e6, &script->lens_error);
    if (strcmp(key, "jpeg") == 0) {
        script->format = REFOCUS_FRAME_MJPEG;
        return set_text(script, &script->jpeg, word[1]);
    }
    if (strcmp(key, "format") == 0) {
        script->format = rf_format_by_name(word[1] ? word[1] : "");
        return script->format != REFOCUS_FRAME_ANY && script->format != REFOCUS_FRAME_MJPEG;
    }
    if (strcmp(key, "size") == 0)
        return parse_size(word[1], &script->width, &script->height);
    if (!parse_number(word[1], 0, 1e15, &value))
        return false;
    if (strcmp(key, "fps") == 0)
        return (script->fps = value) > 0 && value <= 10000;
    if (strcmp(key, "random") == 0)
        return (script->random_percent = value) <= 100;
    if (strcmp(key, "lens-speed") == 0)
        return (script->lens_speed = value) > 0;
    if (strcmp(key, "lens-stop") == 0)
        script->lens_stop = value;
    else if (strcmp(key, "frames") == 0)
        script->frames = (int64_t)value;
    else if (strcmp(key, "stride") == 0)
        script->stride = (int64_t)value;
    else if (strcmp(key, "sequence") == 0)
        script->sequence = (uint32_t)(int64_t)value;
    else if (strcmp(key, "seed") == 0)
        script->seed = (int64_t)value;
    else if (strcmp(key, "start-errors") == 0)
        script->start_errors = value < 1000 ? (int)value : 1000;
    else
        return false;
    return true;
}

int rf_script_parse(struct rf_script *script, char *text, struct refocus_reason *reason)
{
    char *rest = NULL;
    int number = 0;

    memset(script, 0, sizeof *script);
    script->format = REFOCUS_FRAME_NV12;
    script->width = 640;
    script->height = 480;
    script->fps = 30;
    script->lens_speed = script->lens_stop = INFINITY;
    for (char *line = text; line; line = rest) {
        const char *word[4] = {NULL, NULL, NULL, NULL};
        char *within = NULL;
        int n = 0;

        rest = strpbrk(line, ";\n");
        if (rest)
            *rest++ = '\0';
        number++;
        line[strcspn(line, "#")] = '\0';
        for (char *w = strtok_r(line, " \t\r", &within); w && n < 4;
             w = strtok_r(NULL, " \t\r", &within))
            word[n++] = w;
        if (n > 0 && !parse_line(script, word)) {
            if (script->lacks_memory)
                return rf_capture_fail_memory(reason);
            return rf_capture_fail(reason, REFOCUS_ERR_FORMAT,
                                   "line %d of the script: '%.40s %.40s' is not "
                                   "understood; platform/README.md lists what is",
                                   number, word[0], word[1] ? word[1] : "");
        }
    }
    if (script->stride == 0)
        script->stride = rf_plane_row(script->format, 0, script->width);
    if (script->format != REFOCUS_FRAME_MJPEG &&
        rf_frame_bytes(script->format, script->stride, script->width, script->height) == 0)
        return rf_capture_fail(reason, REFOCUS_ERR_SIZE, "the script's stride is less than a row");
    return REFOCUS_OK;
}

void rf_script_free(struct rf_script *script)
{
    free(script->from);
    free(script->jpeg);
    free(script->stack);
    script->from = script->jpeg = script->stack = NULL;
}
