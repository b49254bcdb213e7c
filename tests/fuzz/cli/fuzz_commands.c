/* fuzz_commands.c: bytes as a client of `refocus live` sends them, in pieces. */
#include <stdlib.h>
#include <string.h>
#include "with_failures.h"
#include "live/live_focus.h"
#include "live/live_lines.h"

/* A frame: ten a second, so that pulls are seen under way, and a range that is not always known. */
static void check(struct live_focus *focus)
{
    static int64_t now;
    struct live_range range = {now / 100000000 % 3, 1};
    double disparity, blur, point[2];

    live_focus_frame(focus, now += 100000000, (double)NAN, &range);
    while (live_focus_point(focus, point))
        live_focus_found(focus, point, point[0] / 100); /* any number, and none */
    live_focus_get(focus, &disparity, &blur);
    if (!(disparity >= 0 && disparity <= 1 && blur >= 0 && blur <= focus->blur_most))
        abort();
}

static void obey(void *user, char *line)
{
    struct live_focus *focus = user;
    char why[200] = "";
    bool quit = false;

    if (strlen(line) >= sizeof((struct live_lines *)0)->text)
        abort();
    if (!live_focus_command(focus, line, &quit, why, sizeof why) && !why[0])
        abort();
    check(focus);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct lens_settings lens = LENS_SETTINGS_NONE;
    struct live_lines lines = {.length = 0};
    struct live_focus focus;

    live_focus_init(&focus, &lens);
    focus.blur = 5;
    focus.blur_most = 10;
    for (size_t at = 0, piece = 1; at < size; at += piece, piece = piece % 61 + 7) {
        const size_t left = size - at;

        live_lines_take(&lines, (const char *)data + at, left < piece ? left : piece, obey, &focus);
    }
    check(&focus);
    pthread_mutex_destroy(&focus.lock);
    return 0;
}
