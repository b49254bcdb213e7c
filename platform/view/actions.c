/* actions.c: keys and gestures of the viewer change its state. */
#include <math.h>
#include <time.h>
#include <refocus/status.h>
#include "actions.h"

static double clamp(double value, double least, double most)
{
    return value < least ? least : value > most ? most : value;
}

static double photo_x(const struct rf_window *w, double x)
{
    return w->state.x + x / w->state.scale - 0.5;
}

static double photo_y(const struct rf_window *w, double y)
{
    return w->state.y + y / w->state.scale - 0.5;
}

double rf_window_cpu_ms(void)
{
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

/* A request was made now. */
static void note_request(struct rf_window *w, uint64_t request, const char *cause)
{
    const double now =
        (double)SDL_GetPerformanceCounter() * 1000 / (double)SDL_GetPerformanceFrequency();
    struct rf_view_time *time;

    if (request == 0 || w->report->count == RF_VIEW_TIMES || w->pending_count == RF_PENDING)
        return;
    time = &w->report->times[w->report->count];
    /* Until they are answered the two hold the time of the question, below 0. */
    time->cause = cause;
    time->first_ms = time->full_ms = -now;
    time->first_cpu_ms = -rf_window_cpu_ms();
    w->pending[w->pending_count].request = request;
    w->pending[w->pending_count++].time = w->report->count++;
}

void rf_window_show(struct rf_window *w, const char *cause)
{
    w->state.width = w->width;
    w->state.height = w->height;
    w->words[0] = '\0';
    w->used |= SDL_strcmp(cause, "open") != 0 && SDL_strcmp(cause, "size") != 0;
    note_request(w, rf_session_show(w->session, &w->state), cause);
}

void rf_window_tap(struct rf_window *w, double x, double y)
{
    const struct refocus_image *const photo = w->setup->session.photo;
    const double px = photo_x(w, x), py = photo_y(w, y);

    if (px < -0.5 || py < -0.5 || px > photo->width - 0.5 || py > photo->height - 0.5)
        return;
    w->state.tap_x = px;
    w->state.tap_y = py;
    w->state.focus_tap = ++w->taps;
    rf_window_show(w, "tap");
}

void rf_window_blur(struct rf_window *w, double blur)
{
    w->state.blur = (float)clamp(blur, 0, REFOCUS_PLAIN_BLUR_RADIUS);
    rf_window_show(w, "aperture");
}

void rf_window_fit(struct rf_window *w)
{
    const struct refocus_image *const photo = w->setup->session.photo;
    const double across = (double)w->width / photo->width;
    const double down = (double)w->height / photo->height;

    w->state.scale = across < down ? across : down;
    w->state.x = (photo->width - w->width / w->state.scale) / 2;
    w->state.y = (photo->height - w->height / w->state.scale) / 2;
    w->fitted = true;
}

void rf_window_zoom(struct rf_window *w, double factor, double x, double y)
{
    const double px = w->state.x + x / w->state.scale, py = w->state.y + y / w->state.scale;

    w->state.scale = clamp(w->state.scale * factor, 1.0 / 64, 16);
    w->state.x = px - x / w->state.scale;
    w->state.y = py - y / w->state.scale;
    w->fitted = false;
    w->redraw = true; /* show the old frame at its new place until the new one comes */
    rf_window_show(w, "zoom");
}

void rf_window_pan(struct rf_window *w, double dx, double dy)
{
    const struct refocus_image *const photo = w->setup->session.photo;

    w->state.x = clamp(w->state.x - dx / w->state.scale, -w->width / w->state.scale, photo->width);
    w->state.y =
        clamp(w->state.y - dy / w->state.scale, -w->height / w->state.scale, photo->height);
    w->fitted = false;
    w->redraw = true; /* show the old frame at its new place until the new one comes */
    rf_window_show(w, "zoom");
}

/* The methods that take no memory of their own and no minutes. */
static void next_method(struct rf_window *w)
{
    static const uint32_t methods[] = {REFOCUS_METHOD_SWEEP, REFOCUS_METHOD_SEARCH,
                                       REFOCUS_METHOD_JITTERED, REFOCUS_METHOD_BLUR};
    enum { COUNT = sizeof methods / sizeof *methods };
    const uint32_t allowed = w->setup->methods ? w->setup->methods : REFOCUS_METHODS_ALL;
    int from = 0;

    while (from < COUNT && methods[from] != w->state.method)
        from++;
    for (int i = 1; i <= COUNT; i++) {
        const uint32_t method = methods[(from < COUNT ? from + i : i - 1) % COUNT];

        if (allowed & REFOCUS_METHOD_BIT(method)) {
            w->state.method = method;
            break;
        }
    }
    rf_window_show(w, "method");
}

static void set_mode(struct rf_window *w, uint32_t mode, const char *cause)
{
    w->state.mode = w->state.mode == mode ? (uint32_t)RF_VIEW_RESULT : mode;
    rf_window_show(w, cause);
}

static void save(struct rf_window *w, uint32_t what)
{
    SDL_strlcpy(w->words, "saving \u2026", sizeof w->words);
    w->redraw = true;
    rf_session_save(w->session, what);
}

void rf_window_act(struct rf_window *w, enum rf_action action)
{
    switch (action) {
    case RF_ACT_METHOD:
        next_method(w);
        break;
    case RF_ACT_DEPTH:
        set_mode(w, RF_VIEW_DEPTH, "depth");
        break;
    case RF_ACT_BEFORE:
        set_mode(w, RF_VIEW_BEFORE, "before");
        break;
    case RF_ACT_PEAKING:
        w->state.peaking = !w->state.peaking;
        rf_window_show(w, "peaking");
        break;
    case RF_ACT_FIT:
        rf_window_fit(w);
        rf_window_show(w, "zoom");
        break;
    case RF_ACT_PIXELS:
        rf_window_zoom(w, 1 / w->state.scale, w->width / 2.0, w->height / 2.0);
        break;
    case RF_ACT_SAVE_PICTURE:
        save(w, RF_SAVE_PICTURE);
        break;
    case RF_ACT_SAVE_SETTINGS:
        save(w, RF_SAVE_SETTINGS);
        break;
    case RF_ACT_SAVE_DEPTH:
        save(w, RF_SAVE_DEPTH);
        break;
    case RF_ACT_HELP:
        w->help = !w->help;
        w->redraw = true;
        break;
    case RF_ACT_QUIT:
        w->quit = true;
        break;
    case RF_ACT_NONE:
        break;
    }
}
