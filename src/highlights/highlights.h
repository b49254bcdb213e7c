/* highlights.h: light that the photo's white point cut off, given back to small lamps.
 *
 * A lamp out of focus is a disc whose brightness is the lamp's, spread over the disc.
 * In the photo the lamp is clipped to white, so its disc comes out grey. Clipped pixels
 * that hang together are taken for a lamp when there are few of them, many times brighter
 * than what is around them, with a steep rim. Never large clipped areas: a white wall is
 * just white.
 *
 *     level      of a channel of a pixel: ramp from 0.94 to 1; what is not clipped lost nothing,
 * nor where one channel alone is clipped: hair, leaves, petals isolation  ramp of mean luminance /
 * that of all else up to 12 cells away, 2.5 to 3.75, and of the bright channel that stands out
 * most: what is blue among blue is a petal steepness  ramp of pixels of the edge / half lit ones
 * beside them, 1.67 to 2.25: those 2/5 of the way and more from what is 2 or 3 cells away to white,
 * so that what a lamp lights around it is not its rim; soft rims of large photos: judge.c added
 * (gain - 1) * level * isolation * steepness * hue, of each channel
 *
 * The hue is that of the lamp's rim: what the pixels beside it have more than those 2 or 3 cells
 * away, the brighter ones for more. A lamp and what it lights may hang together, a flame and its
 * candle, a tail light and its glow: where a shape has limbs, parts that are thinner than half of
 * it, its body may be taken alone, and where it has pixels with two clipped channels, these as its
 * core (body.c), whichever makes more light. A core inside a glow that is clipped has the glow's
 * hue. Of what is higher or wider than RF_LAMP_SIDE, tubes and rows of lamps, each cell is judged
 * by the 25 x 25 and 7 x 7 cells around it, isolation from 3 to 4.5, hue as above. Cells are
 * pixels, and squares of them in large photos, rf_lamp_cell(), clipped if any pixel is. What is
 * added acts on pixels that are blurred; the sharp ones stay as they are: it is drawn (draw.h), or
 * else rays meet it.
 *
 * 12 views, best: 30.98 dB with rims from 0.4 of white on, 31.39 from what is beside them, 31.57
 * with isolation from 2.5 in place of 3; 31.71 before and 31.84 with bodies and these hues; 31.92
 * before, 31.94 with what is added after the pre-filter, 32.01 with cores, 32.08 with ramps that
 * end at 3.75 and 2.25 in place of 5 and 2.5.
 * nightlights enlarged 4 times, focused far, near and between: 18.7, 23.1, 24.5 dB with lamps of up
 * to 24 pixels, 23.6, 26.4, 27.4 with cells.
 */
#ifndef RF_HIGHLIGHTS_H
#define RF_HIGHLIGHTS_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/image.h>

struct refocus_renderer;
struct rf_bin_scale;

/* Pixels of a row of a lamp. */
struct rf_highlight {
    uint16_t x, y;     /* the first */
    uint16_t added[3]; /* Q12 light at full gain of 4, at most 3 * 4095: mean of what they lost */
    uint8_t count;     /* 1 to RF_LAMP_RUN */
    uint8_t size;   /* pixels that the lamp is wide in its narrow direction, or so; 255 and more */
    uint16_t edges; /* for this lens: a bit each that is the edge of something bright and sharper;
                       rays leave those alone that are mostly that, drawn ones fade, */
    int16_t blur; /* and the mean of the others, Q7.8, or of most; RF_NO_BLUR where they differ, */
    uint16_t shining; /* by how much all of them shine together, 256 each */
    uint16_t own[3];  /* Q12 light that was taken out of what rays meet, mean of what shines */
    uint8_t rows;     /* that are drawn as one, from this one on; 0: with one above */
    uint8_t below;    /* the next of them is so much further in the list */
};

/* Highlights are kept in parts of so many rows, each with room for one run in 76 pixels; further
 * ones, farther down, stay as they are. */
enum {
    RF_LAMP_SIDE = 24, /* cells that a lamp is high and wide at most */
    RF_LAMP_RUN = 16,
    RF_LAMP_STACK = 4, /* rows that are drawn as one at most */
    RF_LAMP_ROWS = 64,
    RF_LAMP_PARTS = (REFOCUS_MAX_SIDE + RF_LAMP_ROWS - 1) / RF_LAMP_ROWS
};

/* Pixels that a cell is wide and high: lamps are as large as the photo makes them. Of photos up to
 * 1,439 pixels wide or high 1, up to 2,879 2, up to 5,759 4. A power of two, at most 64. */
static inline int rf_lamp_cell(int width, int height)
{
    const int longer = width > height ? width : height;
    int cell = 1;

    while (cell < RF_LAMP_ROWS && longer >= 2 * 720 * cell)
        cell *= 2;
    return cell;
}

/* What blurs around one differ by at most to be drawn as one disc, Q7.8: half a pixel, and 1/32 of
 * large ones. */
static inline int rf_blurs_alike(int blur)
{
    const int size = blur < 0 ? -blur : blur;

    return size < 4096 ? 128 : size / 32;
}

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
    return (uint32_t)width * RF_LAMP_ROWS / 76 + 6;
}

/* Forget the highlights of the photo in use. */
void rf_forget_highlights(struct refocus_renderer *r);

/* Add those of rows y0 to y1 - 1, in r->blend, to the lists of the parts of the photo in use, in
 * any order. All light of it is there, or in strip mode with the caller. Rows of different parts
 * may run at once. `scratch` is rf_scratch() of the worker. */
void rf_find_highlights(struct refocus_renderer *r, int y0, int y1, uint16_t *scratch);

/* Add one. Of more than there is room for the first stay, by rows, in whichever order they come. */
void rf_list_highlight(struct rf_highlights *found, struct rf_highlight lamp);

/* Put what was found in the order of the rows. */
void rf_sort_highlights(struct refocus_renderer *r);

/* The parts that the window has rows of: first to last. */
int rf_first_lamp_part(const struct refocus_renderer *r);
int rf_last_lamp_part(const struct refocus_renderer *r);

static inline int rf_lamp_parts_in(const struct refocus_renderer *r)
{
    return rf_last_lamp_part(r) - rf_first_lamp_part(r) + 1;
}

/* Whether they hold any. */
bool rf_has_highlights(const struct refocus_renderer *r);

/* In the window, for the lens setting of r->blur.at and r->bins: tell edges from
 * lamps, and note in its tile how far a lamp is blurred; where lamps are drawn, how far its disc
 * reaches. False: there are none. */
bool rf_mark_highlights(struct refocus_renderer *r, bool drawn);

/* How much of its light a lamp's pixel of the window has, 0 to 256: less where it is but the edge,
 * by its depth, of something bright and sharper. */
int rf_lamp_shine(const struct refocus_renderer *r, int x, int y);

/* Where lamps are not drawn (draw.h): widen those that rays `gap` times their blur apart would
 * miss. */
void rf_widen_highlights(struct refocus_renderer *r, struct rf_bin_scale scale, double gap);

/* And: lamps and what was widened of them count as foreground (tiles/ranges.h): what rays see past
 * them is not to shine like them. */
void rf_put_lamps_in_front(struct refocus_renderer *r, double gap);

/* Up to that gain, sums of 16 bits hold the light of 16 rays over 4. */
enum { RF_PLAIN_GAIN = 4, RF_MOST_GAIN = 16 };

/* Where lamps are not drawn: add what those in the window lost, gain 1 to 16, to r->smooth.channel,
 * up to `most` there; spread over half a gap of the rays, so that no ray is alone in meeting it.
 * The pre-filter would spread it farther, and discs would have soft rims; what is dark beside a
 * lamp in the background layer stays dark. */
void rf_add_highlights(struct refocus_renderer *r, float gain, double gap, int most);

#endif
