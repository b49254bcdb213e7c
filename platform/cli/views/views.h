/* views.h: the pictures of `refocus render --view`. */
#ifndef RF_CLI_VIEWS_H
#define RF_CLI_VIEWS_H

#include "shot/shot.h"

enum view {
    VIEW_NONE,
    VIEW_DEPTH,
    VIEW_BLUR,
    VIEW_OVERLAY,
    VIEW_PEAKING,
    VIEW_ANAGLYPH,
    VIEW_EDGES
};

/* Words of --view. */
extern const struct option_word view_words[];

/* Render an open shot into `out`, or replace that by a view of it. parallax: pixels
 * between the eyes of an anaglyph at disparity 1 when 0 is in focus; NAN: 1/50 of the
 * width. Exit code; prints why it is not EXIT_DONE. */
int views_render(struct shot *shot, struct refocus_image *out, int view, double parallax,
                 int repeat);

#endif
