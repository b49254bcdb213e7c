#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "live/live.h"

void live_focus_init(struct live_focus *focus, const struct live_settings *settings)
{
    memset(focus, 0, sizeof *focus);
    pthread_mutex_init(&focus->lock, NULL);
    focus->from = focus->to = isnan(settings->lens.focus) ? 0.5 : settings->lens.focus;
    focus->at_given = isnan(settings->lens.focus);
    focus->follow_lens =
        isnan(settings->lens.focus) && isnan(settings->lens.focus_at[0]);
    focus->at[0] = settings->lens.focus_at[0]; /* NAN: the centre */
    focus->at[1] = settings->lens.focus_at[1];
}

/* Eased, so that a pull neither starts nor ends with a jerk. */
static double focus_at_time(const struct live_focus *focus, int64_t now_ns)
{
    const double t = focus->duration_ns > 0 ? (double)(now_ns - focus->begin_ns) /
                                                  (double)focus->duration_ns
                                            : 1;

    if (t >= 1)
        return focus->to;
    return t <= 0 ? focus->from
                  : focus->from + (focus->to - focus->from) * t * t * (3 - 2 * t);
}

static void pull(struct live_focus *focus, double disparity, double seconds)
{
    const int64_t now = live_now_ns();

    focus->from = focus_at_time(focus, now);
    focus->to = disparity > 0 ? fmin(disparity, 1) : 0;
    focus->begin_ns = now;
    focus->duration_ns = (int64_t)(seconds * 1e9);
}

void live_focus_pull(struct live_focus *focus, double disparity, double seconds)
{
    pthread_mutex_lock(&focus->lock);
    pull(focus, disparity, seconds);
    pthread_mutex_unlock(&focus->lock);
}

bool live_focus_point(struct live_focus *focus, double point[2], double *seconds)
{
    bool given;

    pthread_mutex_lock(&focus->lock);
    given = focus->at_given;
    focus->at_given = false;
    point[0] = focus->at[0];
    point[1] = focus->at[1];
    *seconds = focus->at_seconds;
    pthread_mutex_unlock(&focus->lock);
    return given;
}

void live_focus_size(struct live_focus *focus, int width, int height)
{
    pthread_mutex_lock(&focus->lock);
    focus->width = width;
    focus->height = height;
    pthread_mutex_unlock(&focus->lock);
}

void live_focus_get(struct live_focus *focus, int64_t now_ns, double *disparity,
                    double *blur)
{
    pthread_mutex_lock(&focus->lock);
    *disparity = focus_at_time(focus, now_ns);
    *blur = focus->blur;
    pthread_mutex_unlock(&focus->lock);
}

/* "0.5", "0.5 2", "320,240" or "320,240 2": up to two values and, behind a blank,
 * seconds. */
static bool parse_values(const char *text, int count, double values[2], double *seconds)
{
    char *end;

    for (int i = 0; i < count; i++) {
        values[i] = strtod(text, &end);
        if (end == text || !isfinite(values[i]))
            return false;
        text = end;
        if (i + 1 < count && *text++ != ',')
            return false;
    }
    if (*text == ' ') {
        *seconds = strtod(text, &end);
        if (end == text || !(*seconds >= 0 && *seconds <= 3600))
            return false;
        text = end;
    }
    return *text == '\0';
}

static bool is_inside(const struct live_focus *focus, const double at[2])
{
    return !focus->width || (at[0] >= 0 && at[0] < focus->width && at[1] >= 0 &&
                             at[1] < focus->height);
}

static bool apply(struct live_focus *focus, const char *word, const char *rest,
                  char *why, size_t size)
{
    const bool point = strcmp(word, "focus-at") == 0 || strcmp(word, "pull-at") == 0;
    double values[2] = {0, 0}, seconds = strncmp(word, "pull", 4) == 0 ? 1 : 0;

    if (strcmp(word, "blur") != 0 && strcmp(word, "focus") != 0 &&
        strcmp(word, "pull") != 0 && !point) {
        snprintf(why, size, "unknown; give focus D, focus-at X,Y, pull D SECONDS, "
                            "pull-at X,Y SECONDS, blur K or quit");
        return false;
    }
    if (!parse_values(rest, point ? 2 : 1, values, &seconds)) {
        snprintf(why, size, "'%.60s' is no number as it takes them; give %s", rest,
                 point ? "X,Y or X,Y SECONDS" : "one number, and seconds behind it");
        return false;
    }
    if (strcmp(word, "blur") == 0) {
        if (!(values[0] >= 0 && values[0] <= focus->blur_most)) {
            snprintf(why, size, "%g is out of 0 to %g; give --blur-most for more",
                     values[0], focus->blur_most);
            return false;
        }
        focus->blur = values[0];
    } else if (point && !is_inside(focus, values)) {
        snprintf(why, size, "%g,%g is outside of pictures of %dx%d", values[0], values[1],
                 focus->width, focus->height);
        return false;
    } else if (point) {
        focus->at_given = true;
        focus->follow_lens = false;
        focus->at[0] = values[0];
        focus->at[1] = values[1];
        focus->at_seconds = seconds;
    } else if (!(values[0] >= 0 && values[0] <= 1)) {
        snprintf(why, size, "%g is out of 0 (farthest) to 1 (nearest)", values[0]);
        return false;
    } else {
        focus->follow_lens = false;
        pull(focus, values[0], seconds);
    }
    return true;
}

bool live_focus_command(struct live_focus *focus, const char *line, bool *quit,
                        char *why, size_t size)
{
    char word[16];
    size_t n;
    bool understood;

    line += strspn(line, " \t");
    n = strcspn(line, " \t");
    if (n == 0 || n >= sizeof word) {
        snprintf(why, size, "unknown");
        return n == 0;
    }
    memcpy(word, line, n);
    word[n] = '\0';
    line += n;
    line += strspn(line, " \t");
    if (strcmp(word, "quit") == 0) {
        *quit = true;
        return true;
    }
    pthread_mutex_lock(&focus->lock);
    understood = apply(focus, word, line, why, size);
    pthread_mutex_unlock(&focus->lock);
    return understood;
}
