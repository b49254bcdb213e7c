/* thin.h: thin structures, and the depth edges beside them, are separated from the background that
 * they hide.
 *
 * A wire of two pixels that is blurred over forty is hit by few rays, here by more and there by
 * less, and shows as streaks. And the pixels at its edge that have the depth of the background stay
 * there as a sharp line. All of them are mixtures of the wire, N, and of the background, F,
 *
 *     C = alpha N + (1 - alpha) F                                        coverage alpha
 *
 * So they are separated: the planes get F, at its depth, and alpha N is composited over the
 * picture, in one of two ways.
 *
 * Splatted: far before the focus, where nothing thick that is as near reaches the tile, alpha N and
 * alpha become discs of a coverage layer (coverage.h).
 *
 * Matted: in focus before something far, hair for example, its part of the pixels at its edge would
 * be blurred with the background, and the edge would show steps. It stays where it is,
 *
 *     out = alpha N + (1 - alpha) mean
 *
 * up to about half a pixel of its own blur, before what is blurred by two or more pixels, where
 * nothing nearer reaches.
 *
 * Pixels beside thick things that the map gives to the background are mixtures, too: the light of a
 * bright subject would be a halo on a dark wall. They are matted in focus. Out of focus, but not as
 * far as F, they are drawn as pixels of N: the planes get C at the depth of N, where alpha is 1/8
 * or more, and so are those of thin structures that are not splatted, where it is a half or more;
 * but not where the caller knows what is hidden. What the map has on a third surface, between F and
 * N, is left as it is.
 *
 * Of photos of Y, U and V, which may be frames of a video, the latter alone are matted, and nothing
 * is splatted (chroma.c).
 *
 * F is the mean of the pixels around of the far surface that counts most, each by the inverse
 * square of its distance; N that of the near ones around by how much they differ from F. alpha is
 * the part of N - F in C - F, at least as much as keeps N between black and white. Where C tells
 * nothing, or is of another colour than such a mixture, it is 1 if the map has the pixel near, else
 * the pixel is no mixture.
 *
 * Where the caller gives a matte, alpha is that, at any silhouette (settle.c, given.c), but for
 * what is nearer than the subject, and F the likeliest by how the light of both sides varies
 * (deviation.c). Of what is darker or brighter than any such mixture alpha is greater. What
 * is not matted is drawn as one of its sides: the planes get C with the mean background in place of
 * F, at the depth of N, where alpha is 1/8 or more, and else have C at that of F.
 *
 * This header is all that other folders see. The passes run in this order:
 *
 *     rf_matte_take_in       once a photo with a matte    changes disparity; writes the list
 *     rf_thin_find           once a photo and blend       reads light, disparity; writes the list
 *     rf_thin_set_up         once a lens setting
 *     rf_thin_separate       after circles of confusion   reads the list; writes the choice
 *     rf_thin_patch_band                                  writes blur: that of F
 *     rf_coverage_splat                                   writes the coverage layer
 *     rf_thin_swap_light     before the pre-filter        exchanges light with the list
 *     rf_thin_swap_light_back   after it
 */
#ifndef RF_THIN_H
#define RF_THIN_H

#include <stdbool.h>
#include <stdint.h>

#include "aperture/ray_set.h"
#include "background/behind.h"
#include "background/pyramid.h"
#include "colour/transfer.h"
#include "focus/focus.h"
#include "image/chroma.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "kernels/thin.h"
#include "support/arena.h"
#include "support/executor.h"
#include "tiles/bins.h"

/* The mixtures of a tile, among all that are in its row of tiles. */
struct rf_thin_run {
    uint32_t first;
    uint16_t count;
    uint16_t given; /* 1: they are those of the caller's matte */
};

/* Room for the mixtures of a row of tiles: one pixel in four. Further ones stay as they are. */
static inline uint64_t rf_thin_capacity(int width)
{
    return (uint64_t)((width + 15) / 16) * 64;
}

/* The mixtures of the caller's matte in a row of tiles: the first of the row, in this blend. */
struct rf_given_row {
    uint32_t count, blend;
};

/* The mixtures of a photo. */
struct rf_thin_list {
    struct rf_thin *pixel;      /* rf_thin_capacity() for each row of tiles; while the light planes
                                   hold F, `light` of each holds that of the photo */
    struct rf_thin_run *run;    /* run of each tile */
    uint32_t blend;             /* blend of the light that they were found in, or RF_NO_BLEND */
    bool has_matte;             /* the caller gave a matte */
    struct rf_given_row *given; /* the given ones of each row of tiles */
};

/*
 * Nothing may jump as the focus moves, so not all pixels are separated at one blur. Each cell of
 * 4 x 4 pixels of a tile has a level k. Its mixtures are splatted from a blur of
 *
 *     splat_blur (1 + k / 64)
 *
 * before the focus on, and matted up to (64 + 4 k) / 256 pixels of their own blur, before what is
 * blurred by (384 + 32 k) / 256 pixels and more.
 */

/* Mixtures of a tile that are separated, a bit each. */
struct rf_thin_choice {
    bool splats, mattes; /* whether any of them is */
    bool nears;          /* one or more are drawn as pixels of N */
    uint64_t splat[4], matte[4], near[4];
    uint64_t filled[4]; /* splatted ones whose background is that of rf_thin_take_filled() */
};

/* The coverage layer that is composited over the picture; coverage.h has its parts. */
struct rf_coverage_source;
struct rf_coverage {
    struct rf_coverage_source *source; /* 16 sources for each tile, in rows of tiles */
    uint32_t *sources;                 /* number of sources of each row of tiles */
    struct rf_thin_choice *choice;     /* choice of each tile */
    bool *swapped;                     /* whether the light planes hold F, for each row of tiles */
    int32_t (*cell)[4];                /* alpha N and alpha, Q12 times 2^RF_COVERAGE_SHIFT */
    int stride;
};

/* Lay out the list of a photo of at most this size, and its coverage layer but for the sources, of
 * which each has rf_coverage_source_bytes(). */
void rf_lay_out_thin(struct rf_thin_list *list, struct rf_arena *arena, int max_width,
                     int max_height);
void rf_lay_out_coverage(struct rf_coverage *coverage, struct rf_arena *arena, int max_width,
                         int max_height);
uint64_t rf_coverage_source_bytes(void);

/* Arguments of the passes of this folder: the planes and lists that they read and write. */
struct rf_thin_pass {
    const struct rf_executor *exec;
    const struct rf_viewport *view;
    const struct rf_focus_plan *plan;
    struct rf_disparity_q16 disparity;     /* read */
    struct rf_light_q12 light;             /* read, and exchanged with the list; of Y, U and V all
                                              three channels are luminance */
    const struct rf_chroma_planes *chroma; /* NULL of R, G and B; its light, too, is exchanged */
    struct rf_light_q12 smooth;            /* written by rf_thin_take_filled(), else read */
    struct rf_blur_q8 blur;                /* patched */
    const int16_t *cell_most;              /* greatest blur of each cell */
    ptrdiff_t cell_stride;                 /* stride of rows of cells; tiles/ranges.h */
    const struct rf_bins *bins;            /* bins of each tile */
    const struct rf_behind *behind;        /* a layer that F is known from, or NULL */
    const struct rf_transfer *transfer;    /* from its codes to light */
    struct rf_thin_list *list;
    struct rf_coverage *coverage;
    int disc_scale; /* Q8: radius of a splatted disc, as part of its blur; 0: none is splatted */
    int splat_blur; /* Q7.8: from this blur before the focus on, more and more are splatted */
    bool mattes;    /* mixtures in focus may be matted */
    bool finds;     /* thin structures are separated, and not the caller's matte alone */
};

enum {
    RF_COVERAGE_CELL = 4,        /* pixels of a cell of the coverage layer, across and down */
    RF_COVERAGE_BLUR = 8 << 8,   /* Q7.8: two cells, the least blur that is splatted */
    RF_COVERAGE_SOURCES = 4 * 4, /* cells of a tile */
};

/* Finds the mixtures of the photo, all of which is in the window, whose light is of `blend`. */
void rf_thin_find(const struct rf_thin_pass *t, uint32_t blend);

/* The caller's matte, and the planes that it is taken in with. */
struct rf_matte_pass {
    const struct rf_executor *exec;
    const struct rf_viewport *view;        /* all of the photo */
    const struct refocus_disparity *matte; /* any size; its greatest value is the subject */
    const struct rf_transfer *transfer;    /* transfer of linear light */
    struct rf_light_q12 light;             /* read: linear */
    struct rf_disparity_q16 disparity;     /* brought to the matte */
    struct rf_disparity_q16 alpha, near, lost, far; /* scratch */
    const struct rf_pyramid *pyramid;               /* scratch */
    struct rf_thin_list *list;                      /* empty; gets the mixtures */
};

/* Empties the list of mixtures, for another photo of the size of the view. */
void rf_matte_forget(struct rf_thin_list *list, const struct rf_viewport *view);

/* Takes in the matte: the disparities at its silhouettes (settle.c), and its mixtures (given.c). */
void rf_matte_take_in(const struct rf_matte_pass *pass);

/* Changes the light of these mixtures to a blend, whose transfer is transfer[blend]. */
void rf_matte_reblend(const struct rf_thin_pass *t, const struct rf_transfer *transfer,
                      uint32_t blend);

/* Settings of a lens that decide which mixtures are separated. */
struct rf_thin_settings {
    bool on;     /* mixtures can be separated */
    bool finds;  /* thin structures are looked for */
    bool splats; /* discs are as good as rays: an aperture without fine structure, the same all over
                    the picture */
    int rays;    /* rays of the preset, or REFOCUS_RAYS_FULL */
    const struct rf_ray_set *set; /* the set of these rays */
};

/* Sets t->splat_blur, disc_scale and mattes, by t->plan. */
void rf_thin_set_up(struct rf_thin_pass *t, const struct rf_thin_settings *settings);

/* Whether anything is separated with these settings. */
static inline bool rf_thin_is_separated(const struct rf_thin_pass *t)
{
    return t->disc_scale || t->mattes;
}

/* Chooses the mixtures of each tile that are splatted, and those that are matted. Cells and bins
 * are those of the circles of confusion before anything was patched. */
void rf_thin_separate(const struct rf_thin_pass *t);

/* Gives the chosen pixels of a row of tiles the circle of confusion of F. Returns whether there
 * were any, so that borders, cells and bins of the row have to be made again. */
bool rf_thin_patch_band(const struct rf_thin_pass *t, int band);

/* Splats what was chosen into the coverage layer. */
void rf_coverage_splat(const struct rf_thin_pass *t);

/* Exchange the light in the photo with that in the list, where they are separated: before the
 * pre-filter, and back after it, even if the run is cancelled. */
void rf_thin_swap_light(const struct rf_thin_pass *t);
void rf_thin_swap_light_back(const struct rf_thin_pass *t);

/* Where texture is continued (background/texture.h) that goes for what splatted structures hide,
 * too, where it is nearly in focus: those pixels are marked as hidden in a row of tiles, unless
 * they are anyway; and once they are filled the smooth light gets theirs, and they are hidden no
 * longer. */
void rf_thin_hide(const struct rf_thin_pass *t, struct rf_blur_q8 background_blur, int band);
void rf_thin_hide_none(const struct rf_thin_pass *t); /* takes all of that back */
void rf_thin_take_filled(const struct rf_thin_pass *t, struct rf_background background, int band);

/* Means of a tile in Q14 that no ray changes: the photo, and F where mixtures are separated. */
void rf_thin_sharp_means(const struct rf_thin_pass *t, int tx, int ty, uint16_t mean[3][256]);

/* Composites the matted mixtures of a tile over its means, Q14; of Y, U and V those of luma, and of
 * chroma with samples as in its planes. */
void rf_matte_over(const struct rf_thin_pass *t, int tx, int ty, uint16_t mean[3][256]);
void rf_matte_over_yuv(const struct rf_thin_pass *t, int tx, int ty, uint16_t luma[256],
                       uint16_t chroma[256]);

/* Whether the coverage layer has anything over a tile; composites it over the means, Q14. */
bool rf_has_coverage(const struct rf_thin_pass *t, int tx, int ty);
void rf_coverage_over(const struct rf_thin_pass *t, int tx, int ty, uint16_t mean[3][256]);

#endif
