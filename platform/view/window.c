/* window.c: the window of `refocus view`: SDL is started, events are read, and frames are shown. */
#include <math.h>
#include <string.h>
#include <refocus/status.h>
#include "actions.h"
#include "draw.h"
#include "input.h"

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

/* The sizes of what is drawn; a screen whose driver does not tell its dpi, or that is far away, has
 * 96 in a unit of the window system's. */
void rf_window_measure(struct rf_window *w)
{
    const int screen = SDL_GetWindowDisplayIndex(w->window);
    float dpi = 0;
    int width = 0;

    SDL_GetRendererOutputSize(w->renderer, &w->width, &w->height);
    SDL_GetWindowSize(w->window, &width, NULL);
    w->density = width > 0 ? (double)w->width / width : 1;
    if (SDL_GetDisplayDPI(screen, &dpi, NULL, NULL) != 0)
        dpi = 0;
    w->unit = w->setup->dpi > 0 ? w->setup->dpi / 96 : fmax(w->density, fmin((double)dpi / 96, 4));
}

static int open_window(struct rf_window *w, char *reason)
{
    const Uint32 flags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI |
                         (w->setup->fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
    char why[256];
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
    rf_window_measure(w);
    w->frame_event = SDL_RegisterEvents(1);
    SDL_SetRenderDrawBlendMode(w->renderer, SDL_BLENDMODE_BLEND);
    if (w->setup->font && SDL_strcmp(w->setup->font, "none") == 0)
        return REFOCUS_OK;
    w->text = rf_text_open(w->renderer, w->setup->font, why);
    if (w->text || !w->setup->font)
        return REFOCUS_OK;
    SDL_snprintf(reason, 256, "the font %.100s: %.120s", w->setup->font, why);
    return REFOCUS_ERR_UNSUPPORTED;
}

static void close_window(struct rf_window *w)
{
    rf_text_close(&w->text);
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
        w->redraw |= rf_session_words(w->session, w->words);
        if (fresh || w->redraw)
            rf_window_draw(w);
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
    status = open_window(w, reason);
    if (status == REFOCUS_OK)
        status = start_session(w, reason);
    if (status == REFOCUS_OK) {
        SDL_snprintf(report->driver, sizeof report->driver, "%s", SDL_GetCurrentVideoDriver());
        report->width = w->width;
        report->height = w->height;
        report->reduction = rf_session_reduction(w->session);
        rf_window_fit(w);
        rf_window_show(w, "open");
        run(w);
        status = rf_session_status(w->session);
        if (status != REFOCUS_OK)
            SDL_snprintf(reason, 256, "%s", refocus_strerror(status));
        report->last = w->state;
        if (w->frame)
            report->last.focus = w->frame->of.focus;
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
