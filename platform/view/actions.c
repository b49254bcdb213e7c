/* actions.c: keys, buttons and gestures of the viewer change its state. */
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

void rf_window_asked(struct rf_window *w, uint64_t request, const char *cause)
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
    rf_window_asked(w, rf_session_show(w->session, &w->state), cause);
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

/* A point of the photo that strokes take. */
static void inside(const struct rf_window *w, double x, double y, float *px, float *py)
{
    const struct refocus_image *const photo = w->setup->session.photo;

    *px = (float)clamp(photo_x(w, x), 0, photo->width - 1);
    *py = (float)clamp(photo_y(w, y), 0, photo->height - 1);
}

static void begin_stroke(struct rf_window *w, struct refocus_stroke *stroke, bool end_from_depth)
{
    w->state.selection = w->tool != RF_TOOL_FOCUS;
    rf_session_show(w->session, &w->state);
    rf_window_asked(w, rf_session_begin(w->session, stroke, end_from_depth), "paint");
}

static struct refocus_stroke make_stroke(const struct rf_window *w, uint32_t kind)
{
    struct refocus_stroke stroke =
        refocus_stroke_default(kind, (float)clamp(w->brush / w->state.scale, 0.5, 4096));

    if (kind != REFOCUS_STROKE_MORE && kind != REFOCUS_STROKE_LESS)
        stroke.fill.kind = REFOCUS_FILL_SOLID;
    stroke.fill.d0 = stroke.fill.d1 = (float)w->value;
    return stroke;
}

void rf_window_stroke(struct rf_window *w, double x, double y, uint32_t kind)
{
    struct refocus_stroke stroke = make_stroke(w, kind);

    w->path_count = 0;
    begin_stroke(w, &stroke, false);
    rf_window_stroke_to(w, x, y);
}

void rf_window_stroke_to(struct rf_window *w, double x, double y)
{
    float px, py;

    inside(w, x, y, &px, &py);
    rf_window_asked(w, rf_session_extend(w->session, px, py), "paint");
    if (w->path_count < RF_PATH) {
        w->path[w->path_count].x = (float)x;
        w->path[w->path_count++].y = (float)y;
    }
    w->redraw = true;
}

void rf_window_gradient(struct rf_window *w, double x, double y)
{
    struct refocus_stroke stroke = make_stroke(w, REFOCUS_STROKE_FILL);
    struct refocus_fill *const fill = &stroke.fill;

    inside(w, w->press_x, w->press_y, &fill->x0, &fill->y0);
    inside(w, x, y, &fill->x1, &fill->y1);
    fill->kind = REFOCUS_FILL_GRADIENT;
    if (fabs((double)fill->x1 - (double)fill->x0) >= 1 ||
        fabs((double)fill->y1 - (double)fill->y0) >= 1)
        begin_stroke(w, &stroke, true);
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

static void use_tool(struct rf_window *w, enum rf_tool tool, uint32_t kind)
{
    w->tool = tool;
    w->stroke_kind = kind;
    w->state.selection = tool != RF_TOOL_FOCUS;
    rf_window_show(w, "tool");
}

static void paint_layer(struct rf_window *w, uint32_t kind)
{
    struct refocus_stroke stroke = make_stroke(w, kind);

    begin_stroke(w, &stroke, false);
}

static void change_value(struct rf_window *w, double by)
{
    w->value = clamp(w->value + by, 0, 1);
    w->redraw = true;
}

static void change_brush(struct rf_window *w, double factor)
{
    w->brush = clamp(w->brush * factor, 2, 500);
    w->redraw = true;
}

static void act_on_picture(struct rf_window *w, enum rf_action action)
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
        rf_session_save(w->session, RF_SAVE_PICTURE);
        break;
    case RF_ACT_SAVE_SETTINGS:
        rf_session_save(w->session, RF_SAVE_SETTINGS);
        break;
    case RF_ACT_SAVE_DEPTH:
        rf_session_save(w->session, RF_SAVE_DEPTH);
        break;
    case RF_ACT_HELP:
        w->help = !w->help;
        w->settings = false;
        w->redraw = true;
        break;
    case RF_ACT_SETTINGS:
        w->settings = !w->settings;
        w->help = false;
        w->redraw = true;
        break;
    case RF_ACT_QUIT:
        w->quit = true;
        break;
    default:
        break;
    }
}

void rf_window_act(struct rf_window *w, enum rf_action action)
{
    switch (action) {
    case RF_ACT_FOCUS:
        use_tool(w, RF_TOOL_FOCUS, REFOCUS_STROKE_OBJECT);
        break;
    case RF_ACT_PAINT:
        use_tool(w, RF_TOOL_PAINT, REFOCUS_STROKE_OBJECT);
        break;
    case RF_ACT_MORE:
        use_tool(w, RF_TOOL_PAINT, REFOCUS_STROKE_MORE);
        break;
    case RF_ACT_LESS:
        use_tool(w, RF_TOOL_PAINT, REFOCUS_STROKE_LESS);
        break;
    case RF_ACT_BRUSH:
        use_tool(w, RF_TOOL_PAINT, REFOCUS_STROKE_BRUSH);
        break;
    case RF_ACT_GRADIENT:
        use_tool(w, RF_TOOL_GRADIENT, REFOCUS_STROKE_FILL);
        break;
    case RF_ACT_GROUND:
        paint_layer(w, REFOCUS_STROKE_ALL);
        break;
    case RF_ACT_FILL:
        paint_layer(w, REFOCUS_STROKE_FILL);
        break;
    case RF_ACT_UNDO:
        rf_window_asked(w, rf_session_undo(w->session), "undo");
        break;
    case RF_ACT_NEARER:
        change_value(w, 0.05);
        break;
    case RF_ACT_FARTHER:
        change_value(w, -0.05);
        break;
    case RF_ACT_LARGER:
        change_brush(w, 1.25);
        break;
    case RF_ACT_SMALLER:
        change_brush(w, 0.8);
        break;
    default:
        act_on_picture(w, action);
    }
}
