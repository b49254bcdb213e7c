/* live_track.c: a subject is followed by the likeness of its brightness, as normalised
 * cross-correlation measures it, which neither light nor contrast changes.
 *
 * A pattern that learns how the subject changes finds it; the first pattern then places it, so that
 * errors do not add up (Matthews, Ishikawa and Baker, "The template update problem", 2004). */
#include <math.h>
#include <string.h>
#include <refocus/refocus.h>
#include "live/live_track.h"

static const double least_likeness = 0.5; /* below it, to either pattern, the subject is lost */
static const double known_likeness =
    0.7;                                 /* to the first one: it is the subject, after a loss too */
static const double sure_likeness = 0.8; /* from it on the pattern learns what has changed */
static const double larger_likeness = 0.01; /* by so much another size has to be more like it */
static const double distance_costs = 0.15; /* likeness that a place at the end of the reach lacks */
static const double least_contrast = 2;    /* codes: standard deviation of what can be followed */
enum {
    LEARNS = 8, /* one part of so many is new in the pattern */
    NEARBY = 2, /* samples around the place found that the first pattern is looked for in */
};

/* A parabola, 16 in the middle: towards the sides of its rectangle a subject is less likely. */
static int32_t weight_at(int i, int n)
{
    return 1 + 15 * (2 * i + 1) * (2 * (n - i) - 1) / (n * n);
}

void live_track_begin(struct live_tracker *tracker, const double box[4])
{
    memset(tracker, 0, sizeof *tracker);
    memcpy(tracker->box, box, sizeof tracker->box);
    tracker->step = fmax(fmax(box[2], box[3]) / LIVE_TRACK_SIDE, 1);
    tracker->columns = (int)fmin(fmax(box[2] / tracker->step, 1), LIVE_TRACK_SIDE);
    tracker->rows = (int)fmin(fmax(box[3] / tracker->step, 1), LIVE_TRACK_SIDE);
    for (int j = 0; j < tracker->rows; j++)
        for (int i = 0; i < tracker->columns; i++)
            tracker->window[j * tracker->columns + i] =
                weight_at(i, tracker->columns) * weight_at(j, tracker->rows);
}

static int clamp(double at, int size)
{
    return at < 0 ? 0 : at > size - 1 ? size - 1 : (int)at;
}

/* Brightness around a place: Y, or G, of 3 x 3 pixels a third of a step apart. */
static uint8_t look_at(const struct refocus_image *photo, double x, double y, double step)
{
    const bool yuv = photo->format != REFOCUS_FORMAT_RGB8;
    const ptrdiff_t bytes = !yuv ? 3 : photo->format == REFOCUS_FORMAT_YUYV ? 2 : 1;
    int sum = 0;

    for (int j = -1; j <= 1; j++) {
        const uint8_t *const row =
            photo->plane[0] + clamp(y + j * step / 3, photo->height) * photo->stride[0] + !yuv;

        for (int i = -1; i <= 1; i++)
            sum += row[clamp(x + i * step / 3, photo->width) * bytes];
    }
    return (uint8_t)(sum / 9);
}

/* Samples from a corner on. */
static void look(uint8_t *to, const struct refocus_image *photo, double x, double y, double step,
                 int columns, int rows)
{
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++)
            to[j * columns + i] = look_at(photo, x + (i + 0.5) * step, y + (j + 0.5) * step, step);
}

/* Compares a pattern with what lies at (x, y) of what is seen, by the weights of the window. */
static double likeness_at(const struct live_tracker *tracker, const uint8_t *pattern,
                          const uint8_t *seen, int stride, int x, int y)
{
    const int32_t *const window = tracker->window;
    int64_t n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    double va, vb, square;

    for (int j = 0; j < tracker->rows; j++) {
        const uint8_t *const p = pattern + j * tracker->columns;
        const uint8_t *const q = seen + (y + j) * stride + x;
        const int32_t *const w = window + j * tracker->columns;
        int32_t row[6] = {0};

        for (int i = 0; i < tracker->columns; i++) {
            row[0] += w[i];
            row[1] += w[i] * p[i];
            row[2] += w[i] * q[i];
            row[3] += w[i] * p[i] * p[i];
            row[4] += w[i] * q[i] * q[i];
            row[5] += w[i] * p[i] * q[i];
        }
        n += row[0];
        a += row[1];
        b += row[2];
        aa += row[3];
        bb += row[4];
        ab += row[5];
    }
    square = (double)n * (double)n;
    va = (double)(n * aa - a * a);
    vb = (double)(n * bb - b * b);
    if (fmin(va, vb) < least_contrast * least_contrast * square)
        return 0;
    return (double)(n * ab - a * b) / sqrt(va * vb);
}

/* Where between its neighbours the top of a parabola through three values lies: -1/2 to 1/2. */
static double top(double before, double at, double after)
{
    const double bend = before - 2 * at + after;

    return bend < 0 ? fmin(fmax(0.5 * (before - after) / bend, -0.5), 0.5) : 0;
}

/* Likeness of a pattern to what lies at a corner. */
static double likeness_to(const struct live_tracker *tracker, const uint8_t *pattern,
                          const struct refocus_image *photo, const double at[2], double step)
{
    uint8_t seen[LIVE_TRACK_SAMPLES];

    look(seen, photo, at[0], at[1], step, tracker->columns, tracker->rows);
    return likeness_at(tracker, pattern, seen, tracker->columns, 0, 0);
}

/* Move a corner to where a pattern is found best, up to `reach` samples away, where a place at the
 * end of the whole reach lacks `costs`; returns its likeness there. A place between samples is
 * taken where it is better when it is looked at. */
static double find(const struct live_tracker *tracker, const uint8_t *pattern,
                   const struct refocus_image *photo, int reach, double costs, double corner[2])
{
    enum { MOST = 2 * LIVE_TRACK_REACH + 1 };
    const int wide = tracker->columns + 2 * reach, high = tracker->rows + 2 * reach;
    const double step = tracker->step;
    uint8_t seen[LIVE_TRACK_SEEN * LIVE_TRACK_SEEN];
    double likeness[MOST][MOST], best = -2, finer[2], found;
    int bx = 0, by = 0;

    look(seen, photo, corner[0] - reach * step, corner[1] - reach * step, step, wide, high);
    for (int y = 0; y <= 2 * reach; y++)
        for (int x = 0; x <= 2 * reach; x++) {
            const double away = (double)((x - reach) * (x - reach) + (y - reach) * (y - reach)) /
                                (LIVE_TRACK_REACH * LIVE_TRACK_REACH);

            likeness[y][x] = likeness_at(tracker, pattern, seen, wide, x, y);
            if (likeness[y][x] - costs * away > best) {
                best = likeness[y][x] - costs * away;
                by = y;
                bx = x;
            }
        }
    corner[0] += (bx - reach) * step;
    corner[1] += (by - reach) * step;
    finer[0] = corner[0];
    finer[1] = corner[1];
    if (bx > 0 && bx < 2 * reach)
        finer[0] += step * top(likeness[by][bx - 1], likeness[by][bx], likeness[by][bx + 1]);
    if (by > 0 && by < 2 * reach)
        finer[1] += step * top(likeness[by - 1][bx], likeness[by][bx], likeness[by + 1][bx]);
    found = likeness_to(tracker, pattern, photo, finer, step);
    if (found <= likeness[by][bx])
        return likeness[by][bx];
    corner[0] = finer[0];
    corner[1] = finer[1];
    return found;
}

static void learn(struct live_tracker *tracker, const struct refocus_image *photo,
                  const double corner[2])
{
    uint8_t seen[LIVE_TRACK_SAMPLES];

    look(seen, photo, corner[0], corner[1], tracker->step, tracker->columns, tracker->rows);
    for (int i = 0; i < tracker->columns * tracker->rows; i++)
        tracker->pattern[i] =
            (uint8_t)((tracker->pattern[i] * (LEARNS - 1) + seen[i] + LEARNS / 2) / LEARNS);
}

/* Give the box the size in which the subject is most like the first pattern, 1/16 more or less than
 * in the last frame. */
static void resize(struct live_tracker *tracker, const struct refocus_image *photo,
                   double corner[2], double *first)
{
    const double was = tracker->step;

    for (int i = -1; i <= 1; i += 2) {
        const double step = was * (1 + i / 16.0);
        const double wider[2] = {corner[0] - 0.5 * tracker->columns * (step - was),
                                 corner[1] - 0.5 * tracker->rows * (step - was)};
        const double likeness = likeness_to(tracker, tracker->first, photo, wider, step);

        if (likeness > *first + larger_likeness) {
            *first = likeness;
            for (int k = 0; k < 2; k++) {
                corner[k] = wider[k];
                tracker->box[2 + k] *= step / was;
            }
            tracker->step = step;
            break;
        }
    }
}

bool live_track_frame(struct live_tracker *tracker, const struct refocus_image *photo)
{
    double *const box = tracker->box, to[2], back[2], first;

    if (!tracker->has_pattern) {
        look(tracker->first, photo, box[0], box[1], tracker->step, tracker->columns, tracker->rows);
        memcpy(tracker->pattern, tracker->first, sizeof tracker->pattern);
        tracker->has_pattern = true;
        tracker->likeness = likeness_to(tracker, tracker->first, photo, box, tracker->step);
        tracker->lost += tracker->likeness == 0;
        return tracker->likeness > 0;
    }
    for (int i = 0; i < 2; i++)
        to[i] = box[i] + tracker->speed[i];
    tracker->likeness =
        find(tracker, tracker->pattern, photo, LIVE_TRACK_REACH, distance_costs, to);
    /* The pattern drifts as it learns, and it would learn an occluder; the first one does neither.
     */
    back[0] = to[0];
    back[1] = to[1];
    first = find(tracker, tracker->first, photo, NEARBY, 0, back);
    if (tracker->likeness < least_likeness ||
        first < (tracker->gone ? known_likeness : least_likeness)) {
        tracker->gone = true;
        tracker->lost++;
        tracker->speed[0] = tracker->speed[1] = 0;
        return false;
    }
    tracker->gone = false;
    if (first >= known_likeness) {
        to[0] = back[0];
        to[1] = back[1];
        resize(tracker, photo, to, &first);
        if (tracker->likeness >= sure_likeness)
            learn(tracker, photo, to);
    }
    /* The subject may leave the picture, and its middle stays. */
    to[0] = fmin(fmax(to[0], -box[2] / 2), photo->width - box[2] / 2);
    to[1] = fmin(fmax(to[1], -box[3] / 2), photo->height - box[3] / 2);
    for (int i = 0; i < 2; i++) {
        tracker->speed[i] = (tracker->speed[i] + to[i] - tracker->box[i]) / 2;
        tracker->box[i] = to[i];
    }
    return true;
}
