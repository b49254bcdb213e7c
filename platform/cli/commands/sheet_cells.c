/* sheet_cells.c: lists of the command line become the cells of a contact sheet. */
#include <stdio.h>
#include <string.h>
#include "commands/sheet_cells.h"

const struct option_word sheet_kind_words[] = {
    {"focus", "columns of --focuses, rows of --blurs or --f-numbers"},
    {"aperture", "--apertures"},
    {"sigma", "columns of --sigmas, a row for each --blend"},
    {"before-after", "the photo, and what render makes of it"},
    {"bokeh", "the presets of --bokeh"},
    {0}};

/* The next item of a list into text; where the list goes on, or NULL after an error. */
static const char *next(const char *at, char *text, size_t size, const char *name)
{
    const size_t length = strcspn(at, ",");

    if (length == 0 || length >= size) {
        report_failure(EXIT_WRONG, name,
                       length ? "one of its values is too long"
                              : "one of its values is empty; give values with commas between");
        return NULL;
    }
    memcpy(text, at, length);
    text[length] = '\0';
    return at + length;
}

static int too_many(const char *name)
{
    return report_failure(EXIT_WRONG, name, "has too many values; give at most %d",
                          (int)SHEET_LIST);
}

/* Values of one range; an exit code. */
static int read_list(const struct option *range, const char *list, double *values, int *count)
{
    char text[64];

    for (*count = 0; list; ++*count) {
        if (*count == SHEET_LIST)
            return too_many(range->name);
        list = next(list, text, sizeof text, range->name);
        if (!list || options_set(range, range->name, text, values + *count) != OPTIONS_PARSED)
            return EXIT_WRONG;
        list = *list ? list + 1 : NULL;
    }
    return EXIT_DONE;
}

static int read_focuses(const char *list, double *values, int *count)
{
    static const struct option range = {.kind = OPTION_NUMBER, .name = "--focuses", .greatest = 1};
    return read_list(&range, list, values, count);
}

static int read_blurs(const char *list, double *values, int *count)
{
    static const struct option range = {
        .kind = OPTION_NUMBER, .name = "--blurs", .greatest = REFOCUS_MAX_BLUR_RADIUS};
    return read_list(&range, list, values, count);
}

static int read_f_numbers(const char *list, double *values, int *count)
{
    static const struct option range = {
        .kind = OPTION_NUMBER, .name = "--f-numbers", .above = true, .greatest = 1000};
    return read_list(&range, list, values, count);
}

static int read_sigmas(const char *list, double *values, int *count)
{
    static const struct option range = {.kind = OPTION_NUMBER,
                                        .name = "--sigmas",
                                        .least = 1,
                                        .greatest = 1e30,
                                        .word = "off",
                                        .word_value = INFINITY};
    return read_list(&range, list, values, count);
}

static double extreme(const double *values, int count, double sign)
{
    double most = NAN;

    for (int i = 0; i < count; i++)
        most = isnan(most) || sign * values[i] > sign * most ? values[i] : most;
    return most;
}

static struct sheet_cell *add(struct sheet *sheet)
{
    struct sheet_cell *cell = &sheet->cell[sheet->count++];

    *cell = (struct sheet_cell){.focus = NAN, .blur = NAN, .sigma = NAN, .blend = -1};
    return cell;
}

/* A cell with the bokeh of these settings. */
static int begin_look(struct sheet *sheet, const struct engine_settings *settings,
                      const char *caption)
{
    struct engine *const look = &sheet->look[sheet->looks++];
    const int status = engine_begin(look, settings);
    struct sheet_cell *cell;

    if (status != EXIT_DONE)
        return status;
    cell = add(sheet);
    cell->look = look;
    snprintf(cell->caption, sizeof cell->caption, "%.47s", caption);
    sheet->columns = sheet->count < 4 ? sheet->count : 4;
    return EXIT_DONE;
}

/* Each aperture as --aperture reads it. */
static int begin_apertures(struct sheet *sheet, const char *list,
                           const struct engine_settings *engine)
{
    static const char usual[] = "disc,polygon:3,polygon:4,polygon:5,polygon:6:15,"
                                "polygon:8,heart,star:5";
    int status = EXIT_DONE;

    for (list = list ? list : usual; list && status == EXIT_DONE;) {
        struct engine_settings one = *engine;
        char shape[1024];
        const char *slash;

        if (sheet->looks == SHEET_LIST)
            return too_many("--apertures");
        list = next(list, shape, sizeof shape, "--apertures");
        if (!list)
            return EXIT_WRONG;
        list = *list ? list + 1 : NULL;
        one.aperture = shape;
        slash = strrchr(shape, '/');
        status = begin_look(sheet, &one, slash ? slash + 1 : shape);
    }
    return status;
}

static int begin_presets(struct sheet *sheet, const struct engine_settings *engine)
{
    struct engine_settings one = *engine;
    int status = EXIT_DONE;

    for (one.bokeh.preset = 0; status == EXIT_DONE; one.bokeh.preset++) {
        const char *const name = bokeh_preset_name((uint32_t)one.bokeh.preset);

        if (!name)
            break;
        status = begin_look(sheet, &one, name);
    }
    return status;
}

/* A list that does not go with the kind of sheet. */
static int check_lists(const struct sheet_settings *s)
{
    const struct {
        const char *name, *list;
        int kind;
    } lists[] = {{"--focuses", s->focuses, SHEET_FOCUS},
                 {"--blurs", s->blurs, SHEET_FOCUS},
                 {"--f-numbers", s->f_numbers, SHEET_FOCUS},
                 {"--apertures", s->apertures, SHEET_APERTURE},
                 {"--sigmas", s->sigmas, SHEET_SIGMA}};

    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (lists[i].list && lists[i].kind != s->kind)
            return report_failure(EXIT_WRONG, lists[i].name,
                                  "goes with --kind %s alone; leave one of them out",
                                  sheet_kind_words[lists[i].kind].name);
    if (s->blurs && s->f_numbers)
        return report_failure(EXIT_WRONG, "--f-numbers",
                              "is in place of --blurs; leave one of them out");
    return EXIT_DONE;
}

int sheet_begin(struct sheet *sheet, const struct sheet_settings *settings,
                const struct engine_settings *engine)
{
    double values[SHEET_LIST];
    int count, status;

    memset(sheet, 0, sizeof *sheet);
    sheet->columns = 1;
    sheet->most_blur = sheet->least_f_number = NAN;
    status = check_lists(settings);
    if (status == EXIT_DONE)
        status = read_focuses(settings->focuses, values, &count);
    if (status == EXIT_DONE)
        status = read_sigmas(settings->sigmas, values, &count);
    if (status == EXIT_DONE)
        status = read_blurs(settings->blurs, values, &count);
    if (status == EXIT_DONE) {
        sheet->most_blur = extreme(values, count, 1);
        status = read_f_numbers(settings->f_numbers, values, &count);
    }
    if (status == EXIT_DONE)
        sheet->least_f_number = extreme(values, count, -1);
    if (status == EXIT_DONE && settings->kind == SHEET_APERTURE)
        status = begin_apertures(sheet, settings->apertures, engine);
    if (status == EXIT_DONE && settings->kind == SHEET_BOKEH)
        status = begin_presets(sheet, engine);
    return status;
}

/* The rows: blur radii, and what captions call them. */
static int make_rows(const struct sheet_settings *settings, const struct lens_settings *lens,
                     const struct input *input, double blur, double *blurs, char captions[][16],
                     int *count)
{
    double f_numbers[SHEET_LIST];
    int status = EXIT_DONE;

    if (settings->f_numbers) {
        status = read_f_numbers(settings->f_numbers, f_numbers, count);
        for (int i = 0; i < *count && status == EXIT_DONE; i++) {
            struct lens_settings one = *lens;

            one.f_number = f_numbers[i];
            /* The renderer was made for the widest of them, of which a warning told. */
            status = input_blur_and_f_number(input, &one, blurs + i, &f_numbers[i]);
            snprintf(captions[i], sizeof captions[i], "f/%.4g", f_numbers[i]);
        }
        return status;
    }
    if (settings->blurs) {
        status = read_blurs(settings->blurs, blurs, count);
    } else {
        *count = 3;
        for (int i = 0; i < 3; i++)
            blurs[i] = blur * (1 << i) / 4;
    }
    for (int i = 0; i < *count; i++)
        snprintf(captions[i], sizeof captions[i], "blur %.4g", blurs[i]);
    return status;
}

static int fill_focus(struct sheet *sheet, const struct sheet_settings *settings,
                      const struct lens_settings *lens, const struct input *input, double blur)
{
    double focuses[SHEET_LIST], blurs[SHEET_LIST];
    char captions[SHEET_LIST][16];
    int rows = 0, status = read_focuses(settings->focuses ? settings->focuses : "0,0.25,0.5,0.75,1",
                                        focuses, &sheet->columns);

    if (status == EXIT_DONE)
        status = make_rows(settings, lens, input, blur, blurs, captions, &rows);
    for (int i = 0; i < rows * sheet->columns && status == EXIT_DONE; i++) {
        struct sheet_cell *cell = add(sheet);

        cell->focus = focuses[i % sheet->columns];
        cell->blur = blurs[i / sheet->columns];
        snprintf(cell->caption, sizeof cell->caption, "focus %.4g  %s", cell->focus,
                 captions[i / sheet->columns]);
    }
    return status;
}

static int fill_sigma(struct sheet *sheet, const char *list)
{
    double sigmas[SHEET_LIST];
    const int status = read_sigmas(list ? list : "off,400,100,30", sigmas, &sheet->columns);

    for (int i = 0; status == EXIT_DONE && engine_blend_words[i / sheet->columns].name; i++) {
        struct sheet_cell *cell = add(sheet);

        cell->blend = i / sheet->columns;
        cell->sigma = sigmas[i % sheet->columns];
        if (isinf(cell->sigma))
            snprintf(cell->caption, sizeof cell->caption, "%s  sigma off",
                     engine_blend_words[cell->blend].name);
        else
            snprintf(cell->caption, sizeof cell->caption, "%s  sigma %.4g",
                     engine_blend_words[cell->blend].name, cell->sigma);
    }
    return status;
}

static void fill_before_after(struct sheet *sheet)
{
    struct sheet_cell *before = add(sheet), *after = add(sheet);

    before->untouched = true;
    strcpy(before->caption, "before");
    strcpy(after->caption, "after");
    sheet->columns = 2;
}

int sheet_fill(struct sheet *sheet, const struct sheet_settings *settings,
               const struct lens_settings *lens, const struct input *input, double blur)
{
    switch (settings->kind) {
    case SHEET_FOCUS:
        return fill_focus(sheet, settings, lens, input, blur);
    case SHEET_SIGMA:
        return fill_sigma(sheet, settings->sigmas);
    case SHEET_BEFORE_AFTER:
        fill_before_after(sheet);
        break;
    default:
        break; /* looks are there */
    }
    return EXIT_DONE;
}

void sheet_end(struct sheet *sheet)
{
    for (int i = 0; i < sheet->looks; i++)
        engine_end(&sheet->look[i]);
}
