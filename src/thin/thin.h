/* thin.h: thin things, and the edges beside them, taken apart.
 *
 * A wire of two pixels that is blurred over forty is met by few rays, here by more and
 * there by less: it shows as streaks. And the pixels at its edge that have the depth of
 * what is behind stay there as a sharp line. All of them are mixtures of the wire, N,
 * and of what is behind, F,
 *
 *     C = alpha N + (1 - alpha) F
 *
 * So they are taken apart: the planes get F, at its depth, and alpha N is drawn over
 * the picture (veil.h). That is done where the near thing is thin, far before the
 * focus, and nothing thick that is as near reaches the tile.
 *
 * F is the mean of the pixels around of the far surface that counts most, each by the
 * inverse square of its distance; N that of the near ones around by how much they
 * differ from F. alpha is the share of N - F in C - F, at least as much as keeps N
 * between black and white. Where C tells nothing, or is of another colour than such a
 * mixture, it is 1 if the map has the pixel near, else none.
 */
#ifndef RF_THIN_H
#define RF_THIN_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/thin.h"

struct refocus_renderer;
struct rf_frame;

/* Those of a tile, of all that are in its row of tiles. */
struct rf_thin_run {
    uint32_t first;
    uint16_t count;
    uint16_t least, most; /* near disparities; 65535 and 0 of none */
};

/* Room for those of a row of tiles: one pixel in four; further ones stay as they are.
 */
static inline uint64_t rf_thin_capacity(int width)
{
    return (uint64_t)((width + 15) / 16) * 64;
}

struct rf_thin_list {
    struct rf_thin *pixel;   /* rf_thin_capacity() for each row of tiles; while the planes
                                have F, the light of each is that of the photo */
    struct rf_thin_run *run; /* of each tile */
    uint32_t blend;          /* that they were found in, or RF_NO_BLEND */
};

/* Find those of the photo in use, all of which is in the window, in r->blend. */
void rf_find_thin(struct refocus_renderer *r);

/*
 * Hair before letters: F, the mean of what is around, is neither that of a letter nor that of what
 * is between, and the pattern stays in what is laid over, as dashes. Along a strand of one pixel C
 * goes with f, the mean of the far pixels beside each,
 *
 *     C = alpha N + (1 - alpha) f
 *
 * so least squares tell 1 - alpha, the slope in all three channels, and alpha N. Where f varies,
 * and half of how C varies is told, alpha becomes that, and F = (C - alpha N) / (1 - alpha).
 */
void rf_tell_strand(const struct refocus_renderer *r, struct rf_thin *thin, int tx, int ty);

/* Those of a tile of the window. */
const struct rf_thin_run *rf_thin_run_of(const struct refocus_renderer *r, int tx, int ty);
struct rf_thin *rf_thin_of(const struct refocus_renderer *r, int tx, int ty, uint32_t *count);

/*
 * What is thin and in focus, hair before something far, is held: its shares of the pixels at its
 * edge would be blurred with what is behind it, and its edge be in steps. It is taken apart too,
 * and laid over the picture where it is,
 *
 *     out = alpha N + (1 - alpha) mean
 *
 * up to half a pixel or so of its own blur, before what is blurred by two or so and more, where
 * nothing nearer reaches.
 *
 * Nothing is to jump as the focus moves, so that not all pixels are taken apart at one blur: those
 * of a level k, that of their cell of 4 x 4 pixels in the tile, are from veil_blur (1 + k / 64) on,
 * or held up to (112 + 9 k) / 256 pixels, before (384 + 32 k) / 256.
 */
enum { RF_THIN_LEVELS = 16 };

/* Of a plan that is a lens's, disparities of a level: veils are near from one on, 65536: none;
 * what is held between two, and what is behind it at most one. */
struct rf_thin_bounds {
    int veil_from, held_from, held_to, held_far;
};

/* f->thin_bounds, from veil_blur. */
void rf_set_thin_bounds(struct rf_frame *f);

/* Blur of a disparity at a pixel, Q7.8; of what is near in one of a tile. */
int rf_thin_blur(const struct rf_frame *f, uint16_t disparity, int x, int y);
int rf_near_blur(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty);

/* Whether that is far enough before the focus, or in it before what is not. */
bool rf_is_veil(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty);
bool rf_is_held(const struct rf_frame *f, const struct rf_thin *thin, int tx, int ty);

/* Whether a frame takes anything apart. */
bool rf_takes_apart(const struct rf_frame *f);

/* After blurs, cells and bins, before rims: choose the tiles whose edges are taken
 * apart; there blurs become those of F, and the veil is drawn. */
void rf_take_thin_apart(struct rf_frame *f);

/* Which of those of a tile are taken apart, a bit each. */
struct rf_apart {
    bool veils, held; /* any */
    uint64_t veil[4], hold[4];
};

struct rf_apart *rf_apart_of(const struct refocus_renderer *r, int tx, int ty);

static inline bool rf_has_bit(const uint64_t bits[4], uint32_t i)
{
    return bits[i / 64] >> i % 64 & 1;
}

/* Choose those of a tile that are held, if nothing nearer reaches it. */
void rf_choose_held(const struct rf_frame *f, int tx, int ty, struct rf_apart *apart);

/* Lay those held over the means of a tile, Q14. */
void rf_lay_held(const struct rf_frame *f, int tx, int ty, uint16_t mean[3][256]);

/* Means of a tile, Q14, that nothing reaches but what is drawn: the photo, and F. */
void rf_sharp_means(const struct rf_frame *f, int tx, int ty, uint16_t mean[3][256]);

/* Exchange the light in the photo with that in the list, where they are: before the
 * pre-filter, and back after it, even if the run is cancelled. */
void rf_swap_thin_light(struct rf_frame *f);
void rf_swap_thin_light_back(struct rf_frame *f);

#endif
