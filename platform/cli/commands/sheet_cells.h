/* sheet_cells.h: the cells of a contact sheet. */
#ifndef RF_CLI_SHEET_CELLS_H
#define RF_CLI_SHEET_CELLS_H

#include <refocus/refocus.h>
#include "shot/engine.h"
#include "inputs/read_input.h"
#include "inputs/lens.h"

enum sheet_kind { SHEET_FOCUS, SHEET_APERTURE, SHEET_SIGMA, SHEET_BEFORE_AFTER, SHEET_BOKEH };
enum { SHEET_LIST = 16, SHEET_MOST = SHEET_LIST * SHEET_LIST };

/* Words of --kind. */
extern const struct option_word sheet_kind_words[];

/* Values with commas between them, as the command line has them; NULL: not given. */
struct sheet_settings {
    int kind;
    const char *focuses, *blurs, *f_numbers, *apertures, *sigmas;
    double cell_width; /* NAN: not given */
};

struct sheet_cell {
    char caption[48];
    double focus, blur, sigma; /* NAN: as --focus, --blur and --sigma say */
    int blend;                 /* -1: as --blend says */
    const struct engine *look; /* the engine whose bokeh it has; NULL: as the options say */
    bool untouched;            /* the photo itself */
};

struct sheet {
    struct sheet_cell cell[SHEET_MOST];
    int columns, count;
    double most_blur, least_f_number; /* extremes of the lists; NAN: there is none */
    struct engine look[SHEET_LIST];   /* apertures, or presets of bokeh */
    int looks;                        /* begun, also those that failed */
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Called before a photo is read: parse the lists, and make the apertures or the bokeh of the cells.
 */
int sheet_begin(struct sheet *sheet, const struct sheet_settings *settings,
                const struct engine_settings *engine);

/* The cells, for a photo with its blur. */
int sheet_fill(struct sheet *sheet, const struct sheet_settings *settings,
               const struct lens_settings *lens, const struct input *input, double blur);

/* Called after sheet_begin(), whatever it returned. */
void sheet_end(struct sheet *sheet);

#endif
