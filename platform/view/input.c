/* input.c: events of mouse, fingers and keys become actions of the viewer. */
#include <math.h>
#include "actions.h"
#include "input.h"

/* Keys and gestures as the help lists them; 0: no key. */
static const struct {
    SDL_Keycode key;
    enum rf_action action;
    const char *name, *what;
} lines[] = {
    {0, RF_ACT_NONE, "tap, click", "focus there"},
    {0, RF_ACT_NONE, "drag, wheel", "aperture"},
    {0, RF_ACT_NONE, "pinch, ctrl + wheel", "enlarge"},
    {0, RF_ACT_NONE, "two fingers, right drag", "move"},
    {SDLK_b, RF_ACT_BEFORE, "b", "before and after"},
    {SDLK_d, RF_ACT_DEPTH, "d", "depth, bright is near"},
    {SDLK_k, RF_ACT_PEAKING, "k", "peaking: mark what is sharp"},
    {SDLK_m, RF_ACT_METHOD, "m", "next method"},
    {SDLK_HOME, RF_ACT_FIT, "home", "the whole photo"},
    {SDLK_END, RF_ACT_PIXELS, "end", "pixel by pixel"},
    {SDLK_s, RF_ACT_SAVE_PICTURE, "s", "save the picture"},
    {SDLK_j, RF_ACT_SAVE_SETTINGS, "j", "save its settings"},
    {SDLK_w, RF_ACT_SAVE_DEPTH, "w", "save the depth"},
    {SDLK_h, RF_ACT_HELP, "h, ?", "these keys"},
    {SDLK_q, RF_ACT_QUIT, "q", "quit"},
};
enum { LINES = sizeof lines / sizeof *lines };

const char *rf_window_help(int index, const char **what)
{
    if (index < 0 || index >= LINES)
        return NULL;
    *what = lines[index].what;
    return lines[index].name;
}

static void press(struct rf_window *w, double x, double y)
{
    w->press_x = w->last_x = x;
    w->press_y = w->last_y = y;
    w->press_blur = (double)w->state.blur;
    w->dragged = false;
    w->pressed = !w->help; /* a press closes an open help */
    w->redraw |= w->help;
    w->help = false;
}

static void drag_blur(struct rf_window *w, double by)
{
    const double from = w->press_blur > 0.5 ? w->press_blur : 0.5;

    w->state.hold = true;
    rf_window_blur(w, from * exp(by / (150 * w->unit)));
}

static void move(struct rf_window *w, double x, double y)
{
    const double dx = x - w->press_x, dy = y - w->press_y;

    if (w->panning)
        rf_window_pan(w, x - w->last_x, y - w->last_y);
    if (w->pressed && !w->two_fingers) {
        w->dragged |= hypot(dx, dy) > 6 * w->unit;
        if (w->dragged)
            drag_blur(w, dx - dy);
    }
    w->last_x = x;
    w->last_y = y;
}

static void release(struct rf_window *w, double x, double y)
{
    if (w->pressed && !w->two_fingers && !w->dragged)
        rf_window_tap(w, x, y);
    w->pressed = false;
    if (w->state.hold) {
        w->state.hold = false;
        rf_window_show(w, "release");
    }
}

static void turn_wheel(struct rf_window *w, const SDL_MouseWheelEvent *wheel)
{
    const double steps = (double)wheel->preciseY;

    if (SDL_GetModState() & KMOD_CTRL)
        rf_window_zoom(w, exp(steps * 0.2), w->last_x, w->last_y);
    else
        rf_window_blur(w, ((double)w->state.blur > 0.5 ? (double)w->state.blur : 0.5) *
                              exp(steps * 0.15));
}

static void key_down(struct rf_window *w, const SDL_KeyboardEvent *event)
{
    const SDL_Keycode key = event->keysym.sym;

    if (key == SDLK_ESCAPE)
        rf_window_act(w, w->help ? RF_ACT_HELP : RF_ACT_QUIT);
    if (key == SDLK_F1)
        rf_window_act(w, RF_ACT_HELP);
    for (int i = 0; i < LINES; i++)
        if (lines[i].key == key)
            rf_window_act(w, lines[i].action);
}

/* Two fingers move and enlarge; what the first of them began as a mouse is dropped. */
static void pinch(struct rf_window *w, const SDL_MultiGestureEvent *gesture)
{
    const double x = (double)gesture->x * w->width, y = (double)gesture->y * w->height;

    if (gesture->numFingers < 2)
        return;
    if (w->two_fingers) {
        rf_window_pan(w, x - w->last_x, y - w->last_y);
        rf_window_zoom(w, exp(2 * (double)gesture->dDist), x, y);
    }
    w->two_fingers = true;
    w->last_x = x;
    w->last_y = y;
}

static void resize(struct rf_window *w)
{
    rf_window_measure(w);
    if (w->fitted)
        rf_window_fit(w);
    rf_window_show(w, "size");
}

void rf_window_event(struct rf_window *w, const SDL_Event *event)
{
    const double n = w->density;

    switch (event->type) {
    case SDL_QUIT:
        w->quit = true;
        break;
    case SDL_WINDOWEVENT:
        if (event->window.event == SDL_WINDOWEVENT_SIZE_CHANGED ||
            event->window.event == SDL_WINDOWEVENT_DISPLAY_CHANGED)
            resize(w);
        w->redraw = true;
        break;
    case SDL_MOUSEBUTTONDOWN:
        if (event->button.button == SDL_BUTTON_LEFT)
            press(w, event->button.x * n, event->button.y * n);
        else
            w->panning = true;
        break;
    case SDL_MOUSEMOTION:
        move(w, event->motion.x * n, event->motion.y * n);
        break;
    case SDL_MOUSEBUTTONUP:
        if (event->button.button == SDL_BUTTON_LEFT)
            release(w, event->button.x * n, event->button.y * n);
        else
            w->panning = false;
        break;
    case SDL_MOUSEWHEEL:
        turn_wheel(w, &event->wheel);
        break;
    case SDL_MULTIGESTURE:
        pinch(w, &event->mgesture);
        break;
    case SDL_FINGERUP:
        if (SDL_GetNumTouchFingers(event->tfinger.touchId) == 0)
            w->two_fingers = false;
        break;
    case SDL_TEXTINPUT: /* wherever the keyboard has it */
        if (SDL_strcmp(event->text.text, "?") == 0)
            rf_window_act(w, RF_ACT_HELP);
        break;
    case SDL_KEYDOWN:
        key_down(w, &event->key);
        break;
    default:
        break;
    }
}
