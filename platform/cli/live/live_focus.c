/* live_focus.c: focus and blur of each frame, as commands and the camera's lens ask for them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "live/live_focus.h"
#include "live/live_lock.h"

/* Until it is followed its middle is focused on. */
static void aim_at_rectangle(struct live_focus *focus, struct live_target *target)
{
    target->known = target->follows_lens = false;
    for (int i = 0; i < 2; i++)
        target->point[i] = focus->rectangle[i] + focus->rectangle[2 + i] / 2;
    focus->rectangles++;
}

bool live_focus_init(struct live_focus *focus, const struct lens_settings *lens)
{
    memset(focus, 0, sizeof *focus);
    focus->made = live_lock_make(&focus->lock, NULL);
    focus->to.known = !isnan(lens->focus);
    focus->to.follows_lens = isnan(lens->focus) && isnan(lens->focus_at[0]);
    focus->to.value = lens->focus;
    focus->to.point[0] = lens->focus_at[0]; /* NAN: the centre */
    focus->to.point[1] = lens->focus_at[1];
    if (!isnan(lens->focus_distance)) {
        focus->to.known = focus->to.dioptres = true;
        focus->to.follows_lens = false;
        focus->to.value = 1 / lens->focus_distance;
    }
    memcpy(focus->rectangle, lens->focus_rectangle, sizeof focus->rectangle);
    if (!isnan(focus->rectangle[0]))
        aim_at_rectangle(focus, &focus->to);
    focus->from = focus->to;
    focus->stretch = 1;
    return focus->made;
}

void live_focus_free(struct live_focus *focus)
{
    if (focus->made)
        live_lock_end(&focus->lock, NULL);
    focus->made = false;
}

static double clamp(double disparity)
{
    return disparity > 0 ? fmin(disparity, 1) : 0; /* NAN: 0 */
}

static double disparity_of(const struct live_focus *focus, const struct live_target *target)
{
    const struct live_range *range = &focus->range;

    if (!target->known)
        return 0.5;
    if (!target->dioptres)
        return target->value;
    if (!live_range_is_known(range))
        return 0.5;
    return (target->value - range->far) / (range->near - range->far);
}

/* How far the pull is, 0 to 1: eased, so that it neither starts nor ends with a jerk. */
static double progress(const struct live_focus *focus)
{
    const double t = focus->duration_ns > 0
                         ? (double)(focus->now_ns - focus->begin_ns) / (double)focus->duration_ns
                         : 1;

    if (!focus->begun && focus->duration_ns > 0)
        return 0;
    return t >= 1 ? 1 : t <= 0 ? 0 : t * t * (3 - 2 * t);
}

static double present(const struct live_focus *focus)
{
    const double from = disparity_of(focus, &focus->from), to = disparity_of(focus, &focus->to);

    return clamp(from + (to - from) * progress(focus));
}

/* The focus where it stands between two targets. */
static struct live_target standing(const struct live_focus *focus)
{
    const struct live_range *range = &focus->range;
    struct live_target target = {.known = true, .value = present(focus)};

    target.dioptres = live_range_is_known(range);
    if (target.dioptres)
        target.value = range->far + target.value * (range->near - range->far);
    return target;
}

static void pull(struct live_focus *focus, const struct live_target *to, double seconds)
{
    const double part = progress(focus);

    if (part >= 1)
        focus->from = focus->to;
    else if (part > 0)
        focus->from = standing(focus);
    focus->to = *to;
    focus->duration_ns = (int64_t)(seconds * 1e9);
    focus->begun = false;
}

static void follow_lens(struct live_target *target, double dioptres)
{
    if (target->follows_lens) {
        target->known = target->dioptres = true;
        target->value = dioptres;
    }
}

/* The distance in focus need not be in the scene, at either end of a pull. */
static void include(struct live_range *range, const struct live_target *target)
{
    if (!target->known || !target->dioptres || !live_range_is_known(range))
        return;
    range->near = fmax(range->near, target->value);
    range->far = fmin(range->far, fmax(target->value, 0));
}

/*
 * K is the blur of what lies farthest from the focus, and it is for a lens, whose blur goes with
 * differences of 1/z. When the range moves the lens stays: K is stretched as the range is, so that
 * what was there is blurred as before, up to blur_most. Then the lens goes back to K, so slowly
 * that nobody sees it.
 */
static void stretch(struct live_focus *focus, const struct live_range *range, double seconds)
{
    static const double back_s = 10;
    const struct live_range *was = &focus->range;

    if (live_range_is_known(range) && live_range_is_known(was))
        focus->stretch *= (range->near - range->far) / (was->near - was->far);
    else
        focus->stretch = 1;
    focus->stretch = pow(focus->stretch, exp(-seconds / back_s));
}

void live_focus_frame(struct live_focus *focus, int64_t now_ns, double lens_dioptres,
                      struct live_range *range)
{
    pthread_mutex_lock(&focus->lock);
    if (isfinite(lens_dioptres) && live_range_is_known(range)) {
        follow_lens(&focus->from, lens_dioptres);
        follow_lens(&focus->to, lens_dioptres);
    }
    include(range, &focus->from);
    include(range, &focus->to);
    stretch(focus, range, (double)(now_ns - focus->now_ns) / 1e9);
    focus->now_ns = now_ns;
    focus->range = *range;
    if (!focus->begun)
        focus->begin_ns = now_ns;
    focus->begun = true;
    if (progress(focus) >= 1)
        focus->from = focus->to;
    pthread_mutex_unlock(&focus->lock);
}

bool live_focus_point(struct live_focus *focus, double point[2])
{
    const struct live_target *target;
    bool wanted;

    pthread_mutex_lock(&focus->lock);
    target = focus->from.known ? &focus->to : &focus->from;
    wanted = !target->known;
    memcpy(point, target->point, sizeof target->point);
    pthread_mutex_unlock(&focus->lock);
    return wanted;
}

void live_focus_looked_at(struct live_focus *focus, double point[2])
{
    pthread_mutex_lock(&focus->lock);
    memcpy(point, focus->to.point, sizeof focus->to.point);
    pthread_mutex_unlock(&focus->lock);
}

static bool same_point(const double a[2], const double b[2])
{
    return (a[0] == b[0] && a[1] == b[1]) || (isnan(a[0]) && isnan(b[0]));
}

void live_focus_found(struct live_focus *focus, const double point[2], double disparity)
{
    struct live_target *const target[] = {&focus->from, &focus->to};

    pthread_mutex_lock(&focus->lock);
    for (int i = 0; i < 2; i++) { /* another may be asked for since */
        if (target[i]->known || !same_point(target[i]->point, point))
            continue;
        target[i]->known = true;
        target[i]->dioptres = live_range_is_known(&focus->range);
        target[i]->value = clamp(disparity);
        if (target[i]->dioptres)
            target[i]->value =
                focus->range.far + target[i]->value * (focus->range.near - focus->range.far);
    }
    pthread_mutex_unlock(&focus->lock);
}

bool live_focus_rectangle(struct live_focus *focus, double rectangle[4], uint64_t *asked)
{
    bool wanted;

    pthread_mutex_lock(&focus->lock);
    wanted = !isnan(focus->rectangle[0]);
    memcpy(rectangle, focus->rectangle, sizeof focus->rectangle);
    *asked = focus->rectangles;
    pthread_mutex_unlock(&focus->lock);
    return wanted;
}

void live_focus_follow(struct live_focus *focus, double disparity, bool first, double seconds)
{
    static const double settle_s = 0.08;
    double was;

    pthread_mutex_lock(&focus->lock);
    was = present(focus);
    if (!isnan(focus->rectangle[0])) {
        focus->to = focus->from = (struct live_target){.known = true, .value = disparity};
        if (!first)
            focus->to.value += (was - disparity) * exp(-seconds / settle_s);
        focus->duration_ns = 0;
        focus->from = focus->to = standing(focus);
    }
    pthread_mutex_unlock(&focus->lock);
}

void live_focus_size(struct live_focus *focus, int width, int height)
{
    pthread_mutex_lock(&focus->lock);
    focus->width = width;
    focus->height = height;
    pthread_mutex_unlock(&focus->lock);
}

void live_focus_get(struct live_focus *focus, double *disparity, double *blur)
{
    pthread_mutex_lock(&focus->lock);
    *disparity = present(focus);
    *blur = focus->per_dioptre > 0 ? focus->per_dioptre * (focus->range.near - focus->range.far)
                                   : focus->blur * focus->stretch;
    *blur = fmin(*blur, focus->blur_most);
    pthread_mutex_unlock(&focus->lock);
}

void live_focus_lens(struct live_focus *focus, double per_dioptre)
{
    pthread_mutex_lock(&focus->lock);
    if (!focus->blur_asked)
        focus->per_dioptre = per_dioptre;
    pthread_mutex_unlock(&focus->lock);
}

/* "0.5", "0.5 2", "320,240" or "320,240 2": up to four values and, behind a blank, seconds. */
static bool parse_values(const char *text, int count, double values[4], double *seconds)
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
    return !focus->width ||
           (at[0] >= 0 && at[0] < focus->width && at[1] >= 0 && at[1] < focus->height);
}

bool live_focus_has_inside(const struct live_focus *focus, const double box[4])
{
    const bool positive = box[0] >= 0 && box[1] >= 0 && box[2] >= 1 && box[3] >= 1;

    return positive &&
           (!focus->width || (box[0] + box[2] <= focus->width && box[1] + box[3] <= focus->height));
}

static bool apply(struct live_focus *focus, const char *word, const char *rest, char *why,
                  size_t size)
{
    const bool point = strcmp(word, "focus-at") == 0 || strcmp(word, "pull-at") == 0;
    const bool rectangle = strcmp(word, "focus-rectangle") == 0;
    const bool pulls = strncmp(word, "pull", 4) == 0;
    double values[4] = {0, 0, 0, 0}, seconds = pulls ? 1 : 0;
    struct live_target target = {.known = !point, .point = {NAN, NAN}};

    if (strcmp(word, "blur") != 0 && strcmp(word, "focus") != 0 && strcmp(word, "pull") != 0 &&
        !point && !rectangle) {
        snprintf(why, size,
                 "unknown; give focus D, focus-at X,Y, focus-rectangle X,Y,W,H, pull D SECONDS, "
                 "pull-at X,Y SECONDS, blur K, stack or quit");
        return false;
    }
    if (!parse_values(rest, rectangle ? 4 : point ? 2 : 1, values, &seconds)) {
        snprintf(why, size, "'%.60s' cannot be used; give %s%s", rest,
                 rectangle ? "X,Y,W,H"
                 : point   ? "X,Y"
                           : "a number",
                 pulls ? ", and behind a blank 0 to 3600 seconds" : "");
        return false;
    }
    if (strcmp(word, "blur") == 0) {
        if (!(values[0] >= 0 && values[0] <= focus->blur_most)) {
            snprintf(why, size, "%g is out of 0 to %g; give --blur-most for more", values[0],
                     focus->blur_most);
            return false;
        }
        focus->blur = values[0];
        focus->blur_asked = true;
        focus->per_dioptre = 0;
        focus->stretch = 1;
    } else if (rectangle && !live_focus_has_inside(focus, values)) {
        snprintf(why, size, "%g,%g,%g,%g does not lie within pictures of %dx%d", values[0],
                 values[1], values[2], values[3], focus->width, focus->height);
        return false;
    } else if (rectangle) {
        memcpy(focus->rectangle, values, sizeof focus->rectangle);
        aim_at_rectangle(focus, &target);
        pull(focus, &target, 0);
    } else if (point && !is_inside(focus, values)) {
        snprintf(why, size, "%g,%g is outside of pictures of %dx%d", values[0], values[1],
                 focus->width, focus->height);
        return false;
    } else if (point) {
        target.point[0] = values[0];
        target.point[1] = values[1];
        focus->rectangle[0] = NAN;
        pull(focus, &target, seconds);
    } else if (!(values[0] >= 0 && values[0] <= 1)) {
        snprintf(why, size, "%g is out of 0 (farthest) to 1 (nearest)", values[0]);
        return false;
    } else {
        target.value = values[0];
        focus->rectangle[0] = NAN;
        pull(focus, &target, seconds);
    }
    return true;
}

bool live_focus_command(struct live_focus *focus, const char *line, bool *quit, char *why,
                        size_t size)
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
