/* fuzz_script.c: scripts of the replay source: parsed, and played when they open no other file,
 * are of a bearable size, and do not wait. */
#include "source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "replay_script.h"

enum { MOST_BYTES = 1 << 18, LONGEST_MS = 1 };

static bool is_bearable(const struct rf_script *script)
{
    for (int i = 0; i < script->events; i++) {
        const struct rf_event *event = &script->event[i];

        if ((event->fault == RF_FAULT_LATE || event->fault == RF_FAULT_STALL ||
             event->fault == RF_FAULT_VANISH) &&
            event->value > LONGEST_MS)
            return false;
        if (event->fault == RF_FAULT_STRIDE && event->value * script->height > MOST_BYTES)
            return false;
        if (event->fault == RF_FAULT_DROP && event->value > 1000000)
            return false; /* decides the fate of each */
        if (event->fault == RF_FAULT_FORMAT && (int64_t)event->width * event->height > MOST_BYTES)
            return false;
    }
    return !script->from && !script->jpeg && script->stride * script->height <= MOST_BYTES &&
           (int64_t)script->width * script->height <= MOST_BYTES;
}

static void run(const uint8_t *data, size_t size)
{
    struct rf_script *script = malloc(sizeof *script);
    char *text = malloc(size + 1);
    struct refocus_reason reason = {""};
    bool play = false;

    if (script && text) {
        memcpy(text, data, size);
        text[size] = '\0';
        play = rf_script_parse(script, text, &reason) == REFOCUS_OK;
        if (!play && !reason.text[0])
            abort();
        play = play && is_bearable(script);
        rf_script_free(script);
    }
    free(text);
    free(script);
    if (play) {
        char path[64], name[80];
        const int fd = fuzz_open(data, size, path);

        snprintf(name, sizeof name, "replay:%s", path);
        fuzz_source(name);
        close(fd);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 4096)
        fuzz_run_failing(run, data, size);
    return 0;
}
