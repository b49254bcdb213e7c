/* highlights.h: light that the photo's white point cut off, given back to small lamps.
 *
 * A lamp out of focus is a disc whose brightness is the lamp's, spread over the disc.
 * In the photo the lamp is clipped to white, so its disc comes out grey. Clipped pixels
 * that hang together are taken for a lamp when there are few of them, many times brighter
 * than what is around them, with a steep rim. Never large clipped areas: a white wall is
 * just white.
 *
 *     level      of a channel of a pixel: ramp from 0.94 to 1; what is not clipped lost nothing
 *     isolation  ramp of mean luminance / that of all else up to 12 pixels away, 3 to 6
 *     steepness  ramp of pixels of the edge / half lit ones beside them, 1.67 to 2.5
 *     added      (gain - 1) * level * isolation * steepness * hue, of each channel
 *
 * The hue is that of the lamp's rim: what the pixels beside it have more than its
 * surroundings. Of what is higher or wider than RF_LAMP_SIDE, tubes and rows of lamps,
 * each pixel is judged by the 25 x 25 and 7 x 7 pixels around it. What is added acts on
 * pixels that are blurred; the sharp ones stay as they are.
 */
#ifndef RF_HIGHLIGHTS_H
#define RF_HIGHLIGHTS_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/image.h>

struct refocus_renderer;
struct rf_rect;
struct rf_bin_scale;

struct rf_highlight {
    uint16_t x, y;
    uint16_t added[3]; /* Q12 light at full gain of 4, at most 3 * 4095 */
    uint16_t is_edge;  /* for this lens: of something bright and sharper, left alone */
};

/* Highlights are looked for in parts of so many rows, each with room for one pixel in
 * 32; further ones, farther down, stay as they are. */
enum {
    RF_LAMP_SIDE = 24,   /* pixels that a lamp is high and wide at most */
    RF_LAMP_MARGIN = 48, /* that are looked at around a rectangle */
    RF_LAMP_ROWS = 64,
    RF_LAMP_PARTS = (REFOCUS_MAX_SIDE + RF_LAMP_ROWS - 1) / RF_LAMP_ROWS
};

struct rf_highlights {
    struct rf_highlight *lamp;
    uint32_t count, capacity;
};

static inline int rf_lamp_parts(int height)
{
    return (height + RF_LAMP_ROWS - 1) / RF_LAMP_ROWS;
}

static inline uint32_t rf_lamp_capacity(int width)
{
    return (uint32_t)width * RF_LAMP_ROWS / 32 + 8;
}

/* Forget the highlights of the photo in use. */
void rf_forget_highlights(struct refocus_renderer *r);

/* Add those of a rectangle of the window, in r->blend, to the lists of the parts of the
 * photo in use, in any order. Pixels RF_LAMP_MARGIN away from it are looked at. Rectangles
 * of different parts may run at once. `scratch` is rf_scratch() of the worker. */
void rf_find_highlights(struct refocus_renderer *r, struct rf_rect rect,
                        uint16_t *scratch);

/* Add one. Of more than there is room for the first stay, by rows, in whichever order they come. */
void rf_list_highlight(struct rf_highlights *found, struct rf_highlight lamp);

/* Put what was found in the order of the rows. */
void rf_sort_highlights(struct refocus_renderer *r);

/* In the window, for the lens setting of r->front.blur and r->bins: tell edges from
 * lamps, note in its tile how far a lamp is blurred, and widen lamps that rays `gap`
 * times their blur apart would miss. False: there are none. */
bool rf_mark_highlights(struct refocus_renderer *r, struct rf_bin_scale scale,
                        double gap);

/* Lamps and what was widened of them count as foreground (tiles/ranges.h): what rays see past them
 * is not to shine like them. */
void rf_put_lamps_in_front(struct refocus_renderer *r, double gap);

/* Up to that gain lamps go through all passes; what is more is added before the rays
 * alone, because passes sum four pixels in 16 bits. */
enum { RF_PLAIN_GAIN = 4, RF_MOST_GAIN = 16 };

/* Share of rf_highlight.added, Q8, that adds so many times white. */
static inline int rf_highlight_share(float times)
{
    return (int)(times * (256 / 3) + 0.5f);
}

/* Add what a gain beyond RF_PLAIN_GAIN adds to that, to r->smooth, up to `most` there;
 * spread over half a gap of the rays, as the pre-filter does with the rest. */
void rf_add_bright_highlights(struct refocus_renderer *r, float gain, double gap,
                              int most);

/* Add what those in the window lost, gain 1 to 4, to the light. Returns the number of
 * parts that were done before the run was cancelled, all if it was not: to take it away
 * again from. */
int rf_add_highlights(struct refocus_renderer *r, float gain);
void rf_remove_highlights(struct refocus_renderer *r, float gain, int parts);

#endif
