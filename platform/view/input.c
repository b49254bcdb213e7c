/* input.c: events of mouse, fingers and keys become actions of the viewer. */
#include <math.h>
#include "actions.h"
#include "input.h"

static const struct {
    SDL_Keycode key;
    enum rf_action action;
    const char *name, *what; /* name for people */
} keys[] = {
    {SDLK_t, RF_ACT_FOCUS, "t", "tap to focus, drag for the aperture"},
    {SDLK_m, RF_ACT_METHOD, "m", "next method"},
    {SDLK_d, RF_ACT_DEPTH, "d", "depth, bright = near"},
    {SDLK_k, RF_ACT_PEAKING, "k", "peaking: mark what is sharp"},
    {SDLK_b, RF_ACT_BEFORE, "b", "before and after"},
    {SDLK_p, RF_ACT_PAINT, "p", "paint: select the object under the stroke"},
    {SDLK_a, RF_ACT_MORE, "a", "paint what belongs to the object too"},
    {SDLK_x, RF_ACT_LESS, "x", "paint what does not belong to it"},
    {SDLK_o, RF_ACT_BRUSH, "o", "paint exactly what the brush covers"},
    {SDLK_g, RF_ACT_GRADIENT, "g", "drag: a gradient, to the depth where the drag ends"},
    {SDLK_l, RF_ACT_GROUND, "l", "a layer of the whole picture"},
    {SDLK_f, RF_ACT_FILL, "f", "fill the last layer anew"},
    {SDLK_PAGEUP, RF_ACT_NEARER, "page up", "fill with something nearer"},
    {SDLK_PAGEDOWN, RF_ACT_FARTHER, "page down", "fill with something farther"},
    {SDLK_RIGHTBRACKET, RF_ACT_LARGER, "]", "larger brush"},
    {SDLK_LEFTBRACKET, RF_ACT_SMALLER, "[", "smaller brush"},
    {SDLK_u, RF_ACT_UNDO, "u", "drop the last stroke"},
    {SDLK_HOME, RF_ACT_FIT, "home", "show the whole photo"},
    {SDLK_END, RF_ACT_PIXELS, "end", "show pixel by pixel"},
    {SDLK_s, RF_ACT_SAVE_PICTURE, "s", "save the picture"},
    {SDLK_j, RF_ACT_SAVE_SETTINGS, "j", "save the settings"},
    {SDLK_w, RF_ACT_SAVE_DEPTH, "w", "save the depth, and the strokes"},
    {SDLK_i, RF_ACT_SETTINGS, "i", "the settings that it began with"},
    {SDLK_h, RF_ACT_HELP, "h", "keys"},
    {SDLK_q, RF_ACT_QUIT, "q", "quit"},
};

static const struct {
    const char *label;
    enum rf_action action;
} buttons[] = {
    {"focus", RF_ACT_FOCUS},       {"paint", RF_ACT_PAINT},   {"more", RF_ACT_MORE},
    {"less", RF_ACT_LESS},         {"ground", RF_ACT_GROUND}, {"slope", RF_ACT_GRADIENT},
    {"fill", RF_ACT_FILL},         {"far", RF_ACT_FARTHER},   {"near", RF_ACT_NEARER},
    {"undo", RF_ACT_UNDO},         {"method", RF_ACT_METHOD}, {"depth", RF_ACT_DEPTH},
    {"peak", RF_ACT_PEAKING},      {"before", RF_ACT_BEFORE}, {"set", RF_ACT_SETTINGS},
    {"save", RF_ACT_SAVE_PICTURE},
};
enum { KEYS = sizeof keys / sizeof *keys, BUTTONS = sizeof buttons / sizeof *buttons };

const char *rf_view_key(int index, const char **what)
{
    if (index < 0 || index >= KEYS)
        return NULL;
    *what = keys[index].what;
    return keys[index].name;
}

int rf_window_buttons(const struct rf_window *w)
{
    return w->height > 200 ? BUTTONS : 0;
}

/* Two rows where one would be too narrow for fingers. */
SDL_Rect rf_window_button(const struct rf_window *w, int index, const char **label, bool *on)
{
    const int rows = w->width < 60 * BUTTONS ? 2 : 1;
    const int columns = (BUTTONS + rows - 1) / rows;
    const int height = (int)(36 * w->density);
    const int row = index / columns, column = index % columns;
    const SDL_Rect place = {column * w->width / columns, w->height - (rows - row) * height,
                            (column + 1) * w->width / columns - column * w->width / columns,
                            height};
    const enum rf_action action = buttons[index].action;

    *label = buttons[index].label;
    *on = (action == RF_ACT_FOCUS && w->tool == RF_TOOL_FOCUS) ||
          (action == RF_ACT_GRADIENT && w->tool == RF_TOOL_GRADIENT) ||
          (w->tool == RF_TOOL_PAINT &&
           ((action == RF_ACT_PAINT && w->stroke_kind == REFOCUS_STROKE_OBJECT) ||
            (action == RF_ACT_MORE && w->stroke_kind == REFOCUS_STROKE_MORE) ||
            (action == RF_ACT_LESS && w->stroke_kind == REFOCUS_STROKE_LESS))) ||
          (action == RF_ACT_DEPTH && w->state.mode == RF_VIEW_DEPTH) ||
          (action == RF_ACT_BEFORE && w->state.mode == RF_VIEW_BEFORE) ||
          (action == RF_ACT_SETTINGS && w->settings) ||
          (action == RF_ACT_PEAKING && w->state.peaking);
    return place;
}

static bool press_button(struct rf_window *w, double x, double y)
{
    const SDL_Point at = {(int)x, (int)y};

    for (int i = 0; i < rf_window_buttons(w); i++) {
        const char *label;
        bool on;
        const SDL_Rect place = rf_window_button(w, i, &label, &on);

        if (SDL_PointInRect(&at, &place)) {
            rf_window_act(w, buttons[i].action);
            return true;
        }
    }
    return false;
}

static void press(struct rf_window *w, double x, double y)
{
    const SDL_Keymod held = SDL_GetModState();

    w->press_x = w->last_x = x;
    w->press_y = w->last_y = y;
    w->press_blur = (double)w->state.blur;
    if (press_button(w, x, y))
        return;
    w->pressed = true;
    w->dragged = false;
    if (w->tool == RF_TOOL_PAINT) {
        w->painting = w->state.hold = true;
        rf_window_stroke(w, x, y,
                         held & KMOD_SHIFT  ? (uint32_t)REFOCUS_STROKE_MORE
                         : held & KMOD_CTRL ? (uint32_t)REFOCUS_STROKE_LESS
                                            : w->stroke_kind);
    }
}

static void drag_blur(struct rf_window *w, double by)
{
    const double from = w->press_blur > 0.5 ? w->press_blur : 0.5;

    w->state.hold = true;
    rf_window_blur(w, from * exp(by / (150 * w->density)));
}

static void move(struct rf_window *w, double x, double y)
{
    const double dx = x - w->press_x, dy = y - w->press_y;

    if (w->panning)
        rf_window_pan(w, x - w->last_x, y - w->last_y);
    if (w->pressed && !w->two_fingers) {
        w->dragged |= hypot(dx, dy) > 6 * w->density;
        if (w->painting)
            rf_window_stroke_to(w, x, y);
        else if (w->dragged && w->tool == RF_TOOL_FOCUS)
            drag_blur(w, dx - dy);
    }
    w->last_x = x;
    w->last_y = y;
    w->redraw |= w->tool != RF_TOOL_FOCUS;
}

static void release(struct rf_window *w, double x, double y)
{
    if (w->pressed && !w->two_fingers) {
        if (w->tool == RF_TOOL_GRADIENT)
            rf_window_gradient(w, x, y);
        else if (w->tool == RF_TOOL_FOCUS && !w->dragged)
            rf_window_tap(w, x, y);
    }
    w->pressed = w->painting = false;
    w->path_count = 0;
    w->redraw = true;
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
    else if (w->tool == RF_TOOL_FOCUS)
        rf_window_blur(w, ((double)w->state.blur > 0.5 ? (double)w->state.blur : 0.5) *
                              exp(steps * 0.15));
    else
        rf_window_act(w, steps > 0 ? RF_ACT_LARGER : RF_ACT_SMALLER);
}

static void key_down(struct rf_window *w, const SDL_KeyboardEvent *event)
{
    const SDL_Keycode key = event->keysym.sym;

    if (key >= SDLK_0 && key <= SDLK_9) {
        w->value = (key - SDLK_0) / 10.0;
        w->redraw = true;
    } else if (key == SDLK_ESCAPE) {
        w->quit = true;
    } else if (key == SDLK_z && event->keysym.mod & KMOD_CTRL) {
        rf_window_act(w, RF_ACT_UNDO);
    } else {
        for (int i = 0; i < KEYS; i++)
            if (keys[i].key == key)
                rf_window_act(w, keys[i].action);
    }
}

/* Two fingers move and enlarge; what the first of them began as a mouse is dropped. */
static void pinch(struct rf_window *w, const SDL_MultiGestureEvent *gesture)
{
    const double x = (double)gesture->x * w->width, y = (double)gesture->y * w->height;

    if (gesture->numFingers < 2)
        return;
    if (w->painting) {
        w->painting = w->state.hold = false;
        w->path_count = 0;
        rf_window_act(w, RF_ACT_UNDO);
    }
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
    SDL_GetRendererOutputSize(w->renderer, &w->width, &w->height);
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
        if (event->window.event == SDL_WINDOWEVENT_SIZE_CHANGED)
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
    case SDL_KEYDOWN:
        key_down(w, &event->key);
        break;
    default:
        break;
    }
}
