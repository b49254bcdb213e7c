/* draw.c: the window's picture: the frame, the mark of the tap, one line of text, and the keys. */
#include <math.h>
#include "draw.h"
#include "input.h"

/* In 1/96 inch: letters, the least that they shrink to in a small window, and what lies around
 * them. */
enum { LETTERS = 14, LEAST_LETTERS = 8, AROUND = 10 };

static const SDL_Color white = {240, 240, 240, 255}, dim = {190, 190, 190, 255},
                       yellow = {255, 210, 60, 255};

static void set_black(struct rf_window *w, int alpha)
{
    SDL_SetRenderDrawColor(w->renderer, 0, 0, 0, (Uint8)alpha);
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

static void draw_box(struct rf_window *w, int x, int y, int half, int thick)
{
    for (int i = 0; i < thick; i++, half--) {
        const SDL_Rect box = {x - half, y - half, 2 * half, 2 * half};

        SDL_RenderDrawRect(w->renderer, &box);
    }
}

/* The focus point, with a dark line around it that shows on bright photos. */
static void draw_mark(struct rf_window *w)
{
    const int half = (int)(16 * w->unit), thick = (int)(1.5 * w->unit + 0.5);
    const int x = (int)((w->state.tap_x + 0.5 - w->state.x) * w->state.scale);
    const int y = (int)((w->state.tap_y + 0.5 - w->state.y) * w->state.scale);

    if (w->state.focus_tap == 0 || w->state.mode != RF_VIEW_RESULT)
        return;
    set_black(w, 120);
    draw_box(w, x, y, half + (thick + 1) / 2, 2 * thick);
    SDL_SetRenderDrawColor(w->renderer, yellow.r, yellow.g, yellow.b, 255);
    draw_box(w, x, y, half, thick);
}

/* The line says what the window shows. */
static void describe(const struct rf_window *w, char words[RF_VIEW_WORDS])
{
    static const char *const modes[RF_VIEW_MODES] = {"", "before \u00b7 ", "depth \u00b7 "};
    struct rf_view_state state = w->state;
    char lens[RF_VIEW_WORDS / 2];

    if (w->words[0]) {
        SDL_strlcpy(words, w->words, RF_VIEW_WORDS);
        return;
    }
    if (w->frame)
        state.focus = w->frame->of.focus;
    if (w->setup->describe)
        w->setup->describe(w->setup->describe_user, &state, lens, sizeof lens);
    else
        SDL_snprintf(lens, sizeof lens, "focus %.3f \u00b7 blur %.1f px", (double)state.focus,
                     (double)state.blur);
    SDL_snprintf(words, RF_VIEW_WORDS, "%s%s%s%s%s%s", modes[state.mode], lens,
                 state.method != REFOCUS_METHOD_SWEEP ? " \u00b7 " : "",
                 state.method != REFOCUS_METHOD_SWEEP ? refocus_method_name(state.method) : "",
                 state.peaking ? " \u00b7 peaking" : "",
                 w->frame && w->frame->full ? "" : " \u2026");
}

/* The longest hint for which there is room; less of it once it was of use. */
static void draw_hint(struct rf_window *w, int from, int y)
{
    static const char *const hints[] = {
        "tap to focus \u00b7 drag for the aperture \u00b7 pinch to enlarge \u00b7 h for keys",
        "tap to focus \u00b7 drag for the aperture \u00b7 h for keys", "h for keys"};
    enum { HINTS = sizeof hints / sizeof *hints };

    for (int i = w->used ? HINTS - 1 : 0; i < HINTS; i++) {
        const int x = w->width - from - rf_text_width(w->text, hints[i]);

        if (x >= w->line_end + 3 * from) {
            rf_text_draw(w->text, hints[i], x, y, dim);
            break;
        }
    }
}

/* Set letters of the normal size, or smaller ones where these would take that many times the room
 * that there is. */
static void set_letters(struct rf_window *w, double needed)
{
    const double normal = LETTERS * w->unit;

    rf_text_set_size(w->text, needed > 1 ? fmax(normal / needed, LEAST_LETTERS) : normal);
}

static void draw_line(struct rf_window *w, const char *words)
{
    const int around = (int)(AROUND * w->unit);
    SDL_Rect bar = {0, 0, w->width, 0};
    int y;

    set_letters(w, 1);
    set_letters(w, rf_text_width(w->text, words) / fmax(w->width - 2 * around, 1));
    bar.h = rf_text_height(w->text) + around;
    bar.y = w->height - bar.h;
    y = bar.y + around / 2;
    set_black(w, 150);
    SDL_RenderFillRect(w->renderer, &bar);
    rf_text_draw(w->text, words, around, y, white);
    w->line_end = around + rf_text_width(w->text, words);
    draw_hint(w, around, y);
}

/* The place of the help in the middle of the window; the width of its keys, the height of a row. */
static SDL_Rect measure_help(struct rf_window *w, int *keys, int *row)
{
    const int gap = rf_text_height(w->text);
    const char *key, *what;
    int whats = 0, count = 0;
    SDL_Rect page;

    *keys = 0;
    *row = (int)(1.25 * gap);
    for (; (key = rf_window_help(count, &what)) != NULL; count++) {
        *keys = SDL_max(*keys, rf_text_width(w->text, key));
        whats = SDL_max(whats, rf_text_width(w->text, what));
    }
    page.w = *keys + whats + 4 * gap;
    page.h = count * *row + 2 * gap;
    page.x = (w->width - page.w) / 2;
    page.y = (w->height - page.h) / 2;
    return page;
}

static void draw_help(struct rf_window *w)
{
    const char *key, *what;
    int keys, row, gap;
    SDL_Rect page;

    set_letters(w, 1);
    page = measure_help(w, &keys, &row);
    set_letters(w, fmax((double)page.w / w->width, (double)page.h / w->height));
    page = measure_help(w, &keys, &row);
    gap = rf_text_height(w->text);
    set_black(w, 200);
    SDL_RenderFillRect(w->renderer, &page);
    for (int i = 0; (key = rf_window_help(i, &what)) != NULL; i++) {
        const int y = page.y + gap + i * row + (row - gap) / 2;

        rf_text_draw(w->text, key, page.x + gap, y, yellow);
        rf_text_draw(w->text, what, page.x + 3 * gap + keys, y, white);
    }
}

/* Without a font the words are the window's title. */
static void set_title(struct rf_window *w, const char *words)
{
    char title[2 * RF_VIEW_WORDS];
    size_t used = 0;
    const char *key, *what;

    SDL_snprintf(title, sizeof title, "%s: %s", w->setup->title, words);
    for (int i = 0; w->help && used < sizeof title && (key = rf_window_help(i, &what)); i++)
        used += (size_t)SDL_snprintf(title + used, sizeof title - used, "%s%s: %s", i ? ", " : "",
                                     key, what);
    if (SDL_strcmp(title, SDL_GetWindowTitle(w->window)) != 0)
        SDL_SetWindowTitle(w->window, title);
}

void rf_window_draw(struct rf_window *w)
{
    char words[RF_VIEW_WORDS];

    SDL_SetRenderDrawColor(w->renderer, 32, 32, 32, 255);
    SDL_RenderClear(w->renderer);
    if (w->texture)
        draw_frame(w);
    draw_mark(w);
    describe(w, words);
    if (!w->text)
        set_title(w, words);
    else if (w->help)
        draw_help(w);
    else
        draw_line(w, words);
    SDL_RenderPresent(w->renderer);
    w->redraw = false;
}
