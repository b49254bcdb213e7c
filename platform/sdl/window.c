/* window.c: the sink `window` shows frames by SDL2, on X11, Wayland, or the whole screen of a
 * console (KMS).
 *
 * SDL wants one thread for all that it does, and windows want their events to be read also when
 * no frame comes, so the sink has a thread of its own, which holds everything of SDL's. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <SDL.h>
#include "sink.h"

enum { POLL_MS = 20, PATIENCE_MS = 1000 };

/* These belong to the thread alone. */
struct screen {
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
    int width, height; /* size of the texture */
};

struct window {
    pthread_t thread;
    pthread_mutex_t lock; /* guards the members below */
    pthread_cond_t changed;
    enum { STARTING, OPEN, FAILED, CLOSED } state;
    bool quit;  /* the sink is being closed */
    bool fresh; /* a frame waits to be shown */
    uint8_t *pixels;
    size_t capacity;
    int width, height;
    struct refocus_reason reason; /* the reason of FAILED */
};

/* Make the window as large as the picture, but not larger than the screen. */
static bool make_window(struct screen *screen, int width, int height)
{
    SDL_Rect room = {0, 0, width, height};
    double scale;

    SDL_GetDisplayUsableBounds(0, &room);
    scale = SDL_min(SDL_min((double)room.w / width, (double)room.h / height), 1);
    screen->window =
        SDL_CreateWindow("refocus", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                         (int)(width * scale), (int)(height * scale), SDL_WINDOW_RESIZABLE);
    if (!screen->window)
        return false;
    screen->renderer = SDL_CreateRenderer(screen->window, -1, 0);
    if (!screen->renderer)
        screen->renderer = SDL_CreateRenderer(screen->window, -1, SDL_RENDERER_SOFTWARE);
    return screen->renderer != NULL;
}

static bool make_texture(struct screen *screen, int width, int height)
{
    if (screen->texture && screen->width == width && screen->height == height)
        return true;
    if (screen->texture)
        SDL_DestroyTexture(screen->texture);
    screen->texture = SDL_CreateTexture(screen->renderer, SDL_PIXELFORMAT_RGB24,
                                        SDL_TEXTUREACCESS_STREAMING, width, height);
    screen->width = width;
    screen->height = height;
    /* Keeps the picture's proportions in a window of any. */
    return screen->texture && SDL_RenderSetLogicalSize(screen->renderer, width, height) == 0;
}

static void show(const struct screen *screen)
{
    SDL_SetRenderDrawColor(screen->renderer, 0, 0, 0, 255);
    SDL_RenderClear(screen->renderer);
    if (screen->texture)
        SDL_RenderCopy(screen->renderer, screen->texture, NULL, NULL);
    SDL_RenderPresent(screen->renderer);
}

static void fail(struct window *window, const char *what)
{
    window->state = FAILED;
    snprintf(window->reason.text, sizeof window->reason.text, "%s: %.180s", what, SDL_GetError());
}

/* The frame that waits goes into the texture. With the lock held. */
static void take_frame(struct window *window, struct screen *screen)
{
    if ((!screen->window && !make_window(screen, window->width, window->height)) ||
        !make_texture(screen, window->width, window->height) ||
        SDL_UpdateTexture(screen->texture, NULL, window->pixels, 3 * window->width) != 0)
        fail(window, "the window");
    window->fresh = false;
    pthread_cond_broadcast(&window->changed);
}

static bool ends_it(const SDL_Event *event)
{
    if (event->type == SDL_KEYDOWN)
        return event->key.keysym.sym == SDLK_ESCAPE || event->key.keysym.sym == SDLK_q;
    return event->type == SDL_QUIT ||
           (event->type == SDL_WINDOWEVENT && event->window.event == SDL_WINDOWEVENT_CLOSE);
}

static void serve(struct window *window)
{
    struct screen screen = {NULL, NULL, NULL, 0, 0};
    SDL_Event event;
    bool go_on = true;

    while (go_on) {
        bool again = false, closed = false;

        if (SDL_WaitEventTimeout(&event, POLL_MS))
            do {
                closed |= ends_it(&event);
                again |= event.type == SDL_WINDOWEVENT;
            } while (SDL_PollEvent(&event));
        pthread_mutex_lock(&window->lock);
        if (window->fresh && window->state == OPEN) {
            take_frame(window, &screen);
            again = true;
        }
        if (closed)
            window->state = CLOSED;
        go_on = window->state == OPEN && !window->quit;
        pthread_mutex_unlock(&window->lock);
        if (again && screen.renderer)
            show(&screen);
    }
    if (screen.texture)
        SDL_DestroyTexture(screen.texture);
    if (screen.renderer)
        SDL_DestroyRenderer(screen.renderer);
    if (screen.window)
        SDL_DestroyWindow(screen.window);
}

/* SDL's own search ends with a screen that nobody sees, and asking for Wayland where
 * there is none prints a line. SDL_VIDEODRIVER of the environment has the first
 * word. */
static bool init_video(void)
{
    if (SDL_GetHint("SDL_VIDEODRIVER"))
        return SDL_VideoInit(NULL) == 0;
    return SDL_VideoInit("x11") == 0 ||
           (SDL_getenv("WAYLAND_DISPLAY") && SDL_VideoInit("wayland") == 0) ||
           SDL_VideoInit("KMSDRM") == 0;
}

static void *run(void *argument)
{
    struct window *window = argument;
    bool works;

    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1"); /* Ctrl-C is the program's */
    works = init_video();
    pthread_mutex_lock(&window->lock);
    if (works)
        window->state = OPEN;
    else
        fail(window, "there is no display to open a window on");
    pthread_cond_broadcast(&window->changed);
    pthread_mutex_unlock(&window->lock);
    if (works) {
        serve(window);
        SDL_VideoQuit();
    }
    SDL_TLSCleanup(); /* memory that SDL keeps for a thread which it did not start */
    pthread_mutex_lock(&window->lock);
    if (window->state == OPEN)
        window->state = CLOSED;
    pthread_cond_broadcast(&window->changed);
    pthread_mutex_unlock(&window->lock);
    return NULL;
}

static void free_window(struct window *window)
{
    pthread_cond_destroy(&window->changed);
    pthread_mutex_destroy(&window->lock);
    free(window->pixels);
    free(window);
}

/* A lock, and a condition whose time-outs follow CLOCK_MONOTONIC: both or none. */
static bool init_lock(struct window *window)
{
    pthread_condattr_t attributes;
    int error;

    if (pthread_condattr_init(&attributes))
        return false;
    error = pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    if (!error)
        error = pthread_mutex_init(&window->lock, NULL);
    if (!error && (error = pthread_cond_init(&window->changed, &attributes)))
        pthread_mutex_destroy(&window->lock);
    pthread_condattr_destroy(&attributes);
    return !error;
}

static int open_window(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason)
{
    struct window *window = calloc(1, sizeof *window);

    (void)rest;
    if (!window || !init_lock(window)) {
        free(window);
        return rf_capture_fail_memory(reason);
    }
    if (pthread_create(&window->thread, NULL, run, window) != 0) {
        free_window(window);
        return rf_capture_fail_memory(reason);
    }
    pthread_mutex_lock(&window->lock);
    while (window->state == STARTING)
        pthread_cond_wait(&window->changed, &window->lock);
    pthread_mutex_unlock(&window->lock);
    if (window->state == FAILED) {
        pthread_join(window->thread, NULL);
        rf_capture_fail(reason, REFOCUS_ERR_GONE, "%s; is DISPLAY set?", window->reason.text);
        free_window(window);
        return REFOCUS_ERR_GONE;
    }
    sink->state = window;
    return REFOCUS_OK;
}

static int start(struct refocus_sink *sink, int width, int height, double fps,
                 struct refocus_reason *reason)
{
    (void)sink;
    (void)fps;
    /* One texture has to hold it, and SDL's sizes are in int bytes. */
    if ((int64_t)width * height > INT32_MAX / 4)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%dx%d pixels are too many for a window", width, height);
    return REFOCUS_OK;
}

/* The frame before may still wait to be shown: no longer than a second. */
static bool wait_for_room(struct window *window)
{
    const int64_t until = rf_now_ns() + (int64_t)PATIENCE_MS * 1000000;
    const struct timespec moment = {(time_t)(until / 1000000000), (long)(until % 1000000000)};
    int error = 0;

    while (window->fresh && window->state == OPEN && error == 0)
        error = pthread_cond_timedwait(&window->changed, &window->lock, &moment);
    return !window->fresh;
}

static int copy_frame(struct window *window, const struct refocus_image *image,
                      struct refocus_reason *reason)
{
    const size_t row = (size_t)image->width * 3, bytes = row * (size_t)image->height;

    if (bytes > window->capacity) {
        free(window->pixels);
        window->pixels = malloc(bytes);
        window->capacity = window->pixels ? bytes : 0;
    }
    if (!window->pixels)
        return rf_capture_fail_memory(reason);
    for (int y = 0; y < image->height; y++)
        memcpy(window->pixels + (size_t)y * row, image->plane[0] + y * image->stride[0], row);
    window->width = image->width;
    window->height = image->height;
    window->fresh = true;
    return REFOCUS_OK;
}

static int write_frame(struct refocus_sink *sink, const struct refocus_image *image,
                       struct refocus_reason *reason)
{
    struct window *window = sink->state;
    int status;

    pthread_mutex_lock(&window->lock);
    if (!wait_for_room(window) && window->state == OPEN)
        status =
            rf_capture_fail(reason, REFOCUS_ERR_TIMEOUT, "the window took no frame for a second");
    else if (window->state == CLOSED)
        status = rf_capture_fail(reason, REFOCUS_ERR_END, "the window was closed");
    else if (window->state == FAILED)
        status = rf_capture_fail(reason, REFOCUS_ERR_GONE, "%s", window->reason.text);
    else
        status = copy_frame(window, image, reason);
    pthread_mutex_unlock(&window->lock);
    if (status == REFOCUS_OK) {
        SDL_Event wake = {.type = SDL_USEREVENT};

        SDL_PushEvent(&wake); /* a full queue: it is looked at all the same */
    }
    return status;
}

static int close_window(struct refocus_sink *sink, struct refocus_reason *reason)
{
    struct window *window = sink->state;

    (void)reason;
    pthread_mutex_lock(&window->lock);
    window->quit = true;
    pthread_mutex_unlock(&window->lock);
    pthread_join(window->thread, NULL);
    free_window(window);
    return REFOCUS_OK;
}

extern REFOCUS_API const struct rf_sink_ops rf_sink_window;
const struct rf_sink_ops rf_sink_window = {.scheme = "window",
                                           .open = open_window,
                                           .start = start,
                                           .write = write_frame,
                                           .close = close_window};
