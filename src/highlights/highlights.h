/* highlights.h: gives the discs of clipped highlights the light that the photo's white point cut
 * off.
 *
 * A highlight out of focus is a disc whose brightness is the highlight's, spread over the disc. In
 * the photo the highlight is clipped to white, so its disc would come out grey. The steps, in the
 * order in which the renderer takes them:
 *
 *     estimate    lists the clipped pixels by rows, with the light that each has lost (estimate.h)
 *     silhouettes gives pixels at the edge of something bright the depth that they belong to
 *     mark        tells, for a lens setting, how far the pixels of a highlight are out of focus
 *
 * then, where the aperture and the method allow it (rf_can_splat()),
 *
 *     subtract    subtracts from the light that rays hit what a highlight has beyond its
 *                 surroundings
 *     splat       draws that, and the light that clipping took, as sprites of the aperture
 *
 * and elsewhere, where the rays have to gather the light,
 *
 *     note        tells where rays would miss a highlight
 *     raise       counts them as foreground
 *     boost       adds the light that clipping took to the light that rays hit
 *
 * Other folders include this header and, for single steps, estimate.h, known.h and steady.h; the
 * other headers here are private.
 */
#ifndef RF_HIGHLIGHTS_H
#define RF_HIGHLIGHTS_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "focus/focus.h"
#include "image/chroma.h"
#include "image/deep.h"
#include "image/photo_source.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "kernels/gather.h"
#include "support/arena.h"
#include "support/executor.h"
#include "tiles/bins.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

/* The pixels of a highlight in one row, and what the marks of a lens setting say of them. */
struct rf_highlight {
    uint16_t x, y;     /* the first pixel, in the photo */
    uint16_t boost[3]; /* Q12 light that a gain of 4 adds: mean of the pixels. At most 3 * 4095,
                          but for known light (known.h) */
    uint8_t count;     /* pixels, 1 to RF_HIGHLIGHT_RUN */
    uint8_t size; /* pixels that the highlight is wide in its narrow direction, or so; 255: more */

    /* For this lens: */
    int16_t blur;   /* mean of the pixels, as is stored, or of most; RF_NO_BLUR where they
                       differ */
    uint8_t pixels; /* pixels of the run that are in the window */
    uint8_t rows;   /* rows from this one on that are splatted as one; 0: splatted with one above */
    uint16_t below; /* the next of these rows is so many entries further on in the list */
    uint16_t subtracted[3]; /* Q12 light that was subtracted from what rays hit, mean of `pixels` */
};

/* The photo's rows are listed in parts. There is room for one run in 76 pixels, which the parts
 * share by what they need, or in 12 where light above white is known, as much for each part; what
 * does not fit stays as it is in the photo. */
enum {
    RF_HIGHLIGHT_RUN = 16,
    RF_HIGHLIGHT_STACK = 4, /* most rows that are splatted as one */
    RF_HIGHLIGHT_ROWS = 64, /* rows of a part of the photo */
    RF_HIGHLIGHT_PARTS = (REFOCUS_MAX_SIDE + RF_HIGHLIGHT_ROWS - 1) / RF_HIGHLIGHT_ROWS
};

struct rf_highlight_list {
    struct rf_highlight *run; /* row by row */
    uint32_t count, capacity;
};

struct rf_highlights {
    struct rf_highlight_list *part; /* RF_HIGHLIGHT_PARTS of them */
    struct rf_highlight *run;       /* the runs of all parts */
    uint8_t *by_rays; /* known light of a tile of the photo is left to the rays; else not valid */
};

/* Pixels at the edge of something bright that are rendered at another depth than the map gives. */
struct rf_silhouette {
    uint16_t x, y;      /* in the photo */
    uint16_t disparity; /* disparity of the bright pixels that they belong to */
};

/* Each of another pixel; of more than fit, the first stay, row by row. */
struct rf_silhouettes {
    struct rf_silhouette *pixel;
    uint32_t count, capacity;
};

/* Gives the lists of photos up to that size their memory; more if photos may hold light above
 * white. */
void rf_lay_out_highlights(struct rf_highlights *highlights, struct rf_arena *arena, int max_width,
                           int max_height, bool known);
void rf_lay_out_silhouettes(struct rf_silhouettes *silhouettes, struct rf_arena *arena,
                            int max_width, int max_height);

/* Forgets all highlights. Gives each part of a photo of that size the same room: the lists are
 * those of the photo, whatever the largest one is. */
void rf_clear_highlights(struct rf_highlights *highlights, int width, int height, bool known);

/* Gives each part of a photo of that size the capacity that is set, of the room for estimated
 * light. False: there is less, and the last parts get less. */
bool rf_share_room(struct rf_highlights *highlights, int width, int height);

/* Adds one. Of more than there is room for, the first by rows stay, in whichever order they come.
 * Rows of different parts may run at once. */
void rf_list_highlight(struct rf_highlights *highlights, const struct rf_highlight *run);

/* Puts them in the order of the rows. */
void rf_sort_highlights(const struct rf_executor *exec, struct rf_highlights *highlights);

/* Whether any row of the window has some. */
bool rf_has_highlights(const struct rf_highlights *highlights, const struct rf_viewport *view);

/* The window and the planes of it that the steps of a lens setting work on. Each step says which of
 * them it reads and writes. */
struct rf_highlight_window {
    const struct rf_viewport *view;
    struct rf_light_q12 light; /* light of the photo, not pre-filtered */
    struct rf_blur_q8 blur;
    struct rf_highlights *highlights; /* highlights of the photo */
    struct rf_bins *bins;             /* bins of each tile of the window */
    const struct rf_yuv *yuv;         /* a photo of Y, U and V: light is luminance alone; or NULL */
    const struct rf_deep *known;      /* the photo, if it holds what is above white, else NULL */
};

/* Channels of its light. */
static inline int rf_channels_of_light(const struct rf_highlight_window *window)
{
    return window->yuv ? 1 : 3;
}

/* The places where the blur of a pixel is kept: its plane, the bins of its tile and the extremes of
 * its cell. */
struct rf_blur_patch {
    const struct rf_viewport *view;
    struct rf_blur_q8 blur;
    struct rf_bins *bins;
    struct rf_bin_scale scale;
    const struct rf_cells *cells;
};

/*
 * Silhouettes. The pixels at the edge of an object are mixtures of it and of the background.
 * Where the object is bright enough to be clipped, they are nearly as bright as it is, but half of
 * them have the depth of the background: blurred, they would draw a halo around the sharp object.
 * For a pixel p beside a clipped one N that is nearer, with F the mean light of the pixels of p's
 * depth two away,
 *
 *     alpha = (p - F) . (N - F) / |N - F|^2
 *
 * tells how much of N it holds. A highlight may be many times as bright as white: a twentieth of
 * its light can be most of p's. So p is rendered at the depth of N, of several the nearest, from an
 * alpha of 0.05 on where p - F is two fifths of p and more, along N - F.
 *
 * The other way round, a wire or a hair before a highlight has pixels that the map gives to it, and
 * that are as bright as the highlight. Where a clipped pixel has at least half as many dark pixels
 * of its depth as clipped ones around it, 13 x 13, and three clipped ones farther away that are
 * nobody's silhouette, it is rendered at their depth, the nearest of them.
 *
 * Where the light above white is known it tells more. With N the light of such a pixel, F that of
 * the brightest farther one beside it, and S the least of its own depth, 5 x 5, which is dark, N is
 * rendered at the depth of F if that gives half of its light: N = (1 - b) S + b F, and 2 b F >= N.
 * A hair, S = 0.1, before a lamp, F = 8: of N = 2, b = 0.24 and b F = 1.9, so the lamp's it is.
 * And what outshines N is no silhouette of it.
 */
struct rf_silhouette_window {
    const struct rf_viewport *view;
    struct rf_light_q12 light; /* linear */
    struct rf_disparity_q16 disparity;
    const struct rf_deep *known; /* the photo, if it holds what is above white, else NULL */
};

/* Adds to the list those of the bright pixels in a part of the window. Reads pixels up to seven
 * away from the part. */
void rf_find_silhouettes(const struct rf_executor *exec, const struct rf_silhouette_window *window,
                         struct rf_rect part, struct rf_silhouettes *silhouettes);

/* Gives those in the window the blur of their depth. */
void rf_patch_silhouettes(const struct rf_executor *exec, const struct rf_silhouettes *silhouettes,
                          const struct rf_focus_plan *plan, const struct rf_blur_patch *patch);

/* Marks the highlights of the window for its blur. Reads that; writes the marks and, in
 * bins, how far a highlight reaches: by its blur or, if it is splatted, by its disc. */
void rf_mark_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                        bool splat);

/*
 * Splatting. The light of a pixel q with the blur s spreads over the pixels p whose rays hit it, p
 * + u s(q) = q (Yang et al. 2016, eq. 4): a disc of radius |s| around q. Rays are too few to show a
 * highlight of a pixel or two as an even disc with a crisp edge, and even those of a full mask show
 * it as a mesh, as they are rounded to whole pixels. So the light that clipping took is not added
 * to the planes that rays hit. What highlights have beyond their surroundings is subtracted there
 * too, if their discs are larger than what the rays show evenly (subtract.c). Each tile adds both
 * to its means:
 *
 *     mean(p) += (boost + subtracted) (p's part of the run's visible pixels) / (pi s^2)
 *
 * Of the pixels [a, b] of a run, a row of the disc shows those from max(a, x + left) to min(b, x +
 * right), its chord there. Two rays are tested for each p (visibility.c), to places left
 * and right of the middle of its chord, one above and one below it, others in each row. Where a ray
 * hits one of the tile's nearer slabs, half of the chord's light is occluded. With one ray alone,
 * thin structures in between show as dots, and edges as steps. Other apertures have their own area
 * in place of pi. Rows of large discs are drawn as one, the mean of their chords, where nothing
 * occludes them.
 *
 * Rows of discs, irises, hearts and stars are one chord or two: the first chords of all rows are
 * drawn as one aperture, and so are the second ones. A lens with a cat's eye cuts chords off as it
 * does at the place of the highlight, so that no disc shows the tiles, in which rays see it
 * change. Of masks, rings and discs with bright edges, a row of the aperture lets through what is
 * summed up of it between the ends of the run. With colour fringes, red and blue are drawn first,
 * then green. Only masks and rings through a cat's eye, which moves their light, are left to the
 * rays.
 */
struct rf_splat {
    const struct rf_executor *exec;
    struct rf_highlight_window window;
    struct rf_range_plane range;
    const struct refocus_aperture *aperture;
    float gain;            /* 1 to RF_MOST_GAIN, or RF_KNOWN_GAIN (known.h) */
    float cat_eye, fringe; /* struct refocus_look_params */
    int largest_radius; /* largest radius of the frame's plain focus, 1/256 pixel: struct rf_focus
                         */
};

/* Whether discs through that aperture can be splatted with these parameters, and there is a gain.
 * Rays have to weigh all light alike, too: weights of eq. 5 differ from pixel to pixel. */
bool rf_can_splat(const struct rf_settings *params, const struct refocus_aperture *aperture);

/* Subtracts what marked highlights have beyond their surroundings from the light that the
 * pre-filter starts from, where they are not so wide that rays `gap` times their blur apart show
 * them evenly. Reads light and blur; writes the difference to `out`, in tiles whose bins
 * it marks as subtracted, and notes in the highlights how much it was. */
void rf_subtract_highlights(const struct rf_executor *exec,
                            const struct rf_highlight_window *window,
                            const struct rf_photo_source *photo, double gap,
                            struct rf_light_q12 out);

/* Adds the discs that reach a tile to its means, Q14 and 65535 at most, one for each channel,
 * working in rf_splat_share() bytes at `share`. */
void rf_splat_highlights(const struct rf_splat *splat, const struct rf_tile_plan *plan, int tx,
                         int ty, void *share, uint16_t *const mean[3]);

/* Does so for a photo of Y, U and V, whose means are of luminance and of chroma. */
void rf_splat_yuv_highlights(const struct rf_splat *splat, const struct rf_tile_plan *plan, int tx,
                             int ty, void *share, uint16_t *luma, uint16_t *chroma);
uint64_t rf_splat_share(void);

/* Notes in bins where rays `gap` times their blur apart are too few for a marked highlight. Reads
 * blur. */
void rf_note_undersampled(const struct rf_executor *exec, const struct rf_highlight_window *window,
                          double gap);

/* Counts highlights and the pixels that their light is spread over as foreground (tiles/ranges.h),
 * as the background layer that rays see past them is not as bright. Reads blur. */
void rf_raise_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                         const struct rf_foreground_cells *foreground, double gap);

/* Up to RF_PLAIN_GAIN, sums of 16 bits hold the light of 16 rays over 4. */
enum { RF_PLAIN_GAIN = 4, RF_MOST_GAIN = 16 };

/* How far light of that gain may exceed white, and the most light, Q12, of such. */
enum rf_bright rf_bright_of(float gain);
int rf_most_light(enum rf_bright bright);

/* Adds the light that clipping took to `smooth`, the pre-filtered light, up to `most` there, at a
 * gain from 1 to 16. It is spread over half a gap of the rays, so that more than one ray hits it.
 * If it were added before the pre-filter it would spread farther, and discs would have soft edges,
 * and the hidden background beside a highlight would become brighter. Reads blur; notes the
 * brightest light in bins. */
void rf_boost_highlights(const struct rf_executor *exec, const struct rf_highlight_window *window,
                         struct rf_light_q12 smooth, float gain, double gap, int most);

#endif
