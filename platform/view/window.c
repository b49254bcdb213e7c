/* window.c: the window of `refocus view`: SDL is started, events are read, and frames are shown. */
#include <math.h>
#include <string.h>
#include <refocus/status.h>
#include "actions.h"
#include "input.h"
#include "text.h"

/* It is called from the session's thread. */
static void notify(void *user)
{
    const struct rf_window *const w = user;
    SDL_Event event;

    SDL_zero(event);
    event.type = w->frame_event;
    SDL_PushEvent(&event);
}

static double now_ms(void)
{
    return (double)SDL_GetPerformanceCounter() * 1000 / (double)SDL_GetPerformanceFrequency();
}

static int fail(char *reason, const char *what)
{
    SDL_snprintf(reason, 256, "%s: %s", what, SDL_GetError());
    return REFOCUS_ERR_UNSUPPORTED;
}

/* The window is as large as the photo asks for, at most 7/8 of the screen. */
static void choose_size(const struct rf_view_setup *setup, int *width, int *height)
{
    const struct refocus_image *const photo = setup->session.photo;
    SDL_Rect screen = {0, 0, 1280, 960};
    double scale;

    SDL_GetDisplayUsableBounds(0, &screen);
    scale = fmin(screen.w * 0.875 / photo->width, screen.h * 0.875 / photo->height);
    scale = scale > 1 ? 1 : scale;
    *width = setup->width > 0 ? setup->width : (int)fmax(320, photo->width * scale);
    *height = setup->height > 0 ? setup->height : (int)fmax(240, photo->height * scale);
}

static int open_window(struct rf_window *w, char *reason)
{
    const Uint32 flags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI |
                         (w->setup->fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
    int width, height;

    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    /* Drivers that nobody sees are left out, unless SDL_VIDEODRIVER asks for them; and libwayland
     * complains on its own where it cannot be. */
    if (!SDL_GetHint(SDL_HINT_VIDEODRIVER))
        SDL_SetHint(SDL_HINT_VIDEODRIVER, SDL_getenv("XDG_RUNTIME_DIR")
                                              ? "x11,wayland,KMSDRM,RPI,vivante"
                                              : "x11,KMSDRM,RPI,vivante");
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        return fail(reason, "no display can be opened");
    choose_size(w->setup, &width, &height);
    w->window = SDL_CreateWindow(w->setup->title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED,
                                 width, height, flags);
    if (!w->window)
        return fail(reason, "no window can be opened");
    w->renderer = SDL_CreateRenderer(w->window, -1, 0);
    if (!w->renderer)
        w->renderer = SDL_CreateRenderer(w->window, -1, SDL_RENDERER_SOFTWARE);
    if (!w->renderer)
        return fail(reason, "nothing can be drawn into the window");
    SDL_GetRendererOutputSize(w->renderer, &w->width, &w->height);
    SDL_GetWindowSize(w->window, &width, NULL);
    w->density = width > 0 ? (double)w->width / width : 1;
    w->frame_event = SDL_RegisterEvents(1);
    SDL_SetRenderDrawBlendMode(w->renderer, SDL_BLENDMODE_BLEND);
    return REFOCUS_OK;
}

static void close_window(struct rf_window *w)
{
    if (w->texture)
        SDL_DestroyTexture(w->texture);
    if (w->renderer)
        SDL_DestroyRenderer(w->renderer);
    if (w->window)
        SDL_DestroyWindow(w->window);
    SDL_Quit();
}

/* The frame becomes a texture of its size. */
static void take_frame(struct rf_window *w)
{
    const struct rf_view_state *const of = &w->frame->of;

    if (!w->texture || w->texture_width != of->width || w->texture_height != of->height) {
        if (w->texture)
            SDL_DestroyTexture(w->texture);
        w->texture = SDL_CreateTexture(w->renderer, SDL_PIXELFORMAT_ARGB8888,
                                       SDL_TEXTUREACCESS_STREAMING, of->width, of->height);
        w->texture_width = of->width;
        w->texture_height = of->height;
    }
    if (w->texture)
        SDL_UpdateTexture(w->texture, NULL, w->frame->pixels, 4 * of->width);
}

static void set_grey(struct rf_window *w, int grey, int alpha)
{
    SDL_SetRenderDrawColor(w->renderer, (Uint8)grey, (Uint8)grey, (Uint8)grey, (Uint8)alpha);
}

static void draw_circle(struct rf_window *w, double x, double y, double radius)
{
    enum { CORNERS = 48 };
    SDL_FPoint points[CORNERS + 1];

    for (int i = 0; i <= CORNERS; i++) {
        points[i].x = (float)(x + radius * cos(i * 6.283185307 / CORNERS));
        points[i].y = (float)(y + radius * sin(i * 6.283185307 / CORNERS));
    }
    SDL_RenderDrawLinesF(w->renderer, points, CORNERS + 1);
}

/* Draw the focus point, the path that is being painted, and the brush. */
static void draw_marks(struct rf_window *w)
{
    if (w->tool == RF_TOOL_FOCUS && w->state.focus_tap > 0 && w->state.mode == RF_VIEW_RESULT) {
        const int half = (int)(14 * w->density);
        const int x = (int)((w->state.tap_x + 0.5 - w->state.x) * w->state.scale);
        const int y = (int)((w->state.tap_y + 0.5 - w->state.y) * w->state.scale);
        const SDL_Rect box = {x - half, y - half, 2 * half, 2 * half};

        SDL_SetRenderDrawColor(w->renderer, 255, 210, 60, 255);
        SDL_RenderDrawRect(w->renderer, &box);
    }
    if (w->tool == RF_TOOL_FOCUS)
        return;
    SDL_SetRenderDrawColor(w->renderer, 255, 255, 255, 200);
    if (w->path_count > 1)
        SDL_RenderDrawLinesF(w->renderer, w->path, w->path_count);
    if (w->tool == RF_TOOL_PAINT)
        draw_circle(w, w->last_x, w->last_y, w->brush);
    else if (w->pressed)
        SDL_RenderDrawLine(w->renderer, (int)w->press_x, (int)w->press_y, (int)w->last_x,
                           (int)w->last_y);
}

static void draw_buttons(struct rf_window *w)
{
    for (int i = 0; i < rf_window_buttons(w); i++) {
        const char *label;
        bool on;
        const SDL_Rect place = rf_window_button(w, i, &label, &on);
        const int dot = place.w > rf_text_width(label, 2) + 6 ? (int)(2 * w->density) : 1;

        set_grey(w, on ? 90 : 20, 180);
        SDL_RenderFillRect(w->renderer, &place);
        set_grey(w, 120, 255);
        SDL_RenderDrawRect(w->renderer, &place);
        set_grey(w, 240, 255);
        rf_text(w->renderer, label, place.x + (place.w - rf_text_width(label, dot)) / 2,
                place.y + (place.h - 5 * dot) / 2, dot);
    }
}

/* Above: what it is set to, and the disparity that a stroke fills with. */
static void draw_status(struct rf_window *w)
{
    const int dot = (int)(2 * w->density);
    const char *const more = w->setup->settings && *w->setup->settings ? "  + i" : "";
    char text[120];
    SDL_Rect bar = {0, 0, w->width, 11 * dot};

    SDL_snprintf(text, sizeof text, "%s  focus %.3f  blur %.1f%s%s",
                 refocus_method_name(w->state.method),
                 w->frame ? (double)w->frame->of.focus : (double)w->state.focus,
                 (double)w->state.blur, more, w->frame && w->frame->full ? "" : "  ...");
    set_grey(w, 20, 150);
    SDL_RenderFillRect(w->renderer, &bar);
    set_grey(w, 240, 255);
    rf_text(w->renderer, text, 4 * dot, 3 * dot, dot);
    if (w->tool == RF_TOOL_FOCUS)
        return;
    bar = (SDL_Rect){w->width - 30 * dot, dot, 28 * dot, 9 * dot};
    set_grey(w, (int)(w->value * 255), 255);
    SDL_RenderFillRect(w->renderer, &bar);
    SDL_snprintf(text, sizeof text, "%.2f", w->value);
    set_grey(w, w->value > 0.5 ? 0 : 255, 255);
    rf_text(w->renderer, text, bar.x + 5 * dot, bar.y + 2 * dot, dot);
}

/* Darkens what lies under a page of text. */
static void begin_page(struct rf_window *w, int dot)
{
    const SDL_Rect all = {0, 11 * dot, w->width, w->height};

    set_grey(w, 10, 200);
    SDL_RenderFillRect(w->renderer, &all);
    set_grey(w, 240, 255);
}

/* Draw the settings of the picture beside focus, blur and method. */
static void draw_settings(struct rf_window *w)
{
    const int dot = (int)(2 * w->density);
    const char *line = w->setup->settings;
    char text[120];

    begin_page(w, dot);
    if (!line || !*line)
        line = "a plain lens: no settings beside focus and blur";
    for (int i = 0; *line; i++) {
        const size_t length = strcspn(line, "\n");

        SDL_snprintf(text, sizeof text, "%.*s", (int)length, line);
        rf_text(w->renderer, text, 6 * dot, (16 + 8 * i) * dot, dot);
        line += length + (line[length] != '\0');
    }
}

static void draw_help(struct rf_window *w)
{
    const int dot = (int)(2 * w->density);
    const char *what, *key;

    begin_page(w, dot);
    for (int i = 0; (key = rf_view_key(i, &what)) != NULL; i++) {
        rf_text(w->renderer, key, 6 * dot, (16 + 8 * i) * dot, dot);
        rf_text(w->renderer, what, 50 * dot, (16 + 8 * i) * dot, dot);
    }
}

/* Find the place of the frame now: the view may have moved since. */
static void draw_frame(struct rf_window *w)
{
    const struct rf_view_state *const of = &w->frame->of;
    const double zoom = w->state.scale / of->scale;
    const SDL_FRect place = {(float)((of->x - w->state.x) * w->state.scale),
                             (float)((of->y - w->state.y) * w->state.scale),
                             (float)(of->width * zoom), (float)(of->height * zoom)};

    SDL_RenderCopyF(w->renderer, w->texture, NULL, &place);
}

static void draw(struct rf_window *w)
{
    set_grey(w, 32, 255);
    SDL_RenderClear(w->renderer);
    if (w->texture)
        draw_frame(w);
    draw_marks(w);
    draw_status(w);
    if (w->help)
        draw_help(w);
    else if (w->settings)
        draw_settings(w);
    draw_buttons(w);
    SDL_RenderPresent(w->renderer);
    w->redraw = false;
}

/* Note the requests that the frame just shown answers. */
static void note_times(struct rf_window *w)
{
    int kept = 0;

    for (int i = 0; i < w->pending_count; i++) {
        const struct rf_pending *const one = &w->pending[i];
        struct rf_view_time *const time = &w->report->times[one->time];

        if (w->frame->request < one->request) {
            w->pending[kept++] = *one;
            continue;
        }
        if (time->first_ms < 0) {
            time->first_ms += now_ms();
            time->first_cpu_ms += rf_window_cpu_ms();
        }
        if (w->frame->full && w->frame->request == one->request) {
            time->full_ms += now_ms();
        } else if (w->frame->request == one->request) {
            w->pending[kept++] = *one;
        }
    }
    w->pending_count = kept;
}

static void run(struct rf_window *w)
{
    const Uint32 start = SDL_GetTicks();
    SDL_Event event;

    while (!w->quit) {
        bool fresh;

        if (SDL_WaitEventTimeout(&event, w->redraw ? 1 : 15)) {
            do
                rf_window_event(w, &event);
            while (SDL_PollEvent(&event));
        }
        rf_session_tick(w->session);
        fresh = rf_session_frame(w->session, &w->frame);
        if (fresh)
            take_frame(w);
        if (fresh || w->redraw)
            draw(w);
        if (fresh)
            note_times(w);
        if (w->setup->stop && w->setup->stop(w->setup->stop_user))
            w->quit = true;
        if (w->setup->quit_after_ms > 0 &&
            SDL_GetTicks() - start >= (Uint32)w->setup->quit_after_ms)
            w->quit = true;
        if (rf_session_status(w->session) != REFOCUS_OK)
            w->quit = true;
    }
}

static int start_session(struct rf_window *w, char *reason)
{
    struct rf_session_setup session = w->setup->session;
    int status;

    session.notify = notify;
    session.notify_user = w;
    status = rf_session_create(&w->session, &session);
    if (status != REFOCUS_OK)
        SDL_snprintf(reason, 256, "%s", refocus_strerror(status));
    return status;
}

int rf_view_run(const struct rf_view_setup *setup, struct rf_view_report *report, char *reason)
{
    struct rf_window *const w = SDL_calloc(1, sizeof *w);
    int status;

    if (!w) {
        SDL_snprintf(reason, 256, "%s", refocus_strerror(REFOCUS_ERR_MEMORY));
        return REFOCUS_ERR_MEMORY;
    }
    memset(report, 0, sizeof *report);
    w->setup = setup;
    w->report = report;
    w->state = setup->state;
    w->brush = 14;
    w->value = 0.5;
    w->stroke_kind = REFOCUS_STROKE_OBJECT;
    status = open_window(w, reason);
    if (status == REFOCUS_OK)
        status = start_session(w, reason);
    if (status == REFOCUS_OK) {
        SDL_snprintf(report->driver, sizeof report->driver, "%s", SDL_GetCurrentVideoDriver());
        report->width = w->width;
        report->height = w->height;
        report->reduction = rf_session_reduction(w->session);
        w->brush *= w->density;
        rf_window_fit(w);
        rf_window_show(w, "open");
        run(w);
        status = rf_session_status(w->session);
        if (status != REFOCUS_OK)
            SDL_snprintf(reason, 256, "%s", refocus_strerror(status));
        report->last = w->state;
        if (w->frame) {
            report->last.focus = w->frame->of.focus;
            report->strokes = w->frame->strokes;
        }
    }
    rf_session_destroy(&w->session);
    close_window(w);
    for (int i = 0; i < report->count; i++) {
        if (report->times[i].first_ms < -0.0)
            report->times[i].first_ms = -1;
        if (report->times[i].full_ms < -0.0)
            report->times[i].full_ms = -1;
    }
    SDL_free(w);
    return status;
}
