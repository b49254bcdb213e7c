/* mixture.h: the mixtures of a tile, and which of them are separated; private to this folder. */
#ifndef RF_MIXTURE_H
#define RF_MIXTURE_H

#include <assert.h>
#include <stdlib.h>

#include "thin/thin.h"

/* The mixtures of a tile of the window. */
static inline const struct rf_thin_run *rf_thin_run_of(const struct rf_thin_pass *t, int tx, int ty)
{
    const int row = ty + t->view->y0 / RF_TILE, column = tx + t->view->x0 / RF_TILE;
    const int across = (t->view->photo_width + RF_TILE - 1) / RF_TILE;

    return &t->list->run[(size_t)row * across + column];
}

static inline struct rf_thin *rf_thin_of(const struct rf_thin_pass *t, int tx, int ty,
                                         uint32_t *count)
{
    const struct rf_thin_run *run = rf_thin_run_of(t, tx, ty);
    const int row = ty + t->view->y0 / RF_TILE;

    *count = run->count;
    return t->list->pixel + (uint64_t)row * rf_thin_capacity(t->view->photo_width) + run->first;
}

/* The choice of which of these mixtures are separated. */
static inline struct rf_thin_choice *rf_thin_choice_of(const struct rf_thin_pass *t, int tx, int ty)
{
    return &t->coverage->choice[(size_t)ty * t->view->tiles_x + tx];
}

static inline bool rf_has_bit(const uint64_t bits[4], uint32_t i)
{
    return bits[i / 64] >> i % 64 & 1;
}

/* Circle of confusion, Q7.8, of a disparity at a pixel of the window, and of N of a mixture. */
int rf_thin_blur(const struct rf_thin_pass *t, uint16_t disparity, int x, int y);
int rf_near_blur(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty);

/* Whether N is far enough before the focus to be splatted, or in focus before something that is not
 * and so matted. */
bool rf_is_splatted(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty);
bool rf_is_matted(const struct rf_thin_pass *t, const struct rf_thin *thin, int tx, int ty);

/* alpha N + (1 - alpha) mean, Q14, where alpha N = C - (1 - alpha) F, both Q12; 255 = 1. */
static inline uint16_t rf_mix(int mean, int c, int f, int alpha)
{
    static_assert(255 * UINT16_MAX + 127 <= INT32_MAX, "a mean times coverage");
    const int light = 4 * c + ((255 - alpha) * (mean - 4 * f) + 127) / 255;

    return (uint16_t)(light < 0 ? 0 : light < UINT16_MAX ? light : UINT16_MAX);
}

/* Puts the chroma of F into the planes for the matted mixtures of a tile, and the photo's into
 * `whole` of the list; or back. */
void rf_swap_chroma(const struct rf_thin_pass *t, int tx, int ty, bool back);

/* Disparities farther apart than this are of two surfaces. */
enum { RF_SURFACE_JUMP = 65535 / 32 };

/* Whether alpha, 255 = 1, of the caller's matte is as good as 1, or 0. */
static inline bool rf_is_sure(int alpha, bool near)
{
    return near ? alpha >= 247 : alpha <= 8;
}

/* Brings the disparities at the silhouettes of the caller's matte to it, after alpha was read. */
void rf_settle_sides(const struct rf_matte_pass *pass);

/* Measures how much the light of either side varies, from the pixels that are sure to be on it, and
 * keeps that in `lost`. */
void rf_measure_deviations(const struct rf_matte_pass *pass);

/* Gives the standard deviations of luminance around a pixel that were measured, Q12. */
void rf_deviations_at(const struct rf_matte_pass *pass, int x, int y, int *near, int *far);

/* Chooses the mixtures of a tile, of those that are not splatted, that are drawn as pixels of N:
 * where N is blurred, and not as F is, and they have enough of it. */
void rf_choose_near(const struct rf_thin_pass *t, int tx, int ty, struct rf_thin_choice *choice);

/* Chooses the mixtures of a tile that are matted, if nothing nearer reaches it. */
void rf_choose_matted(const struct rf_thin_pass *t, int tx, int ty, struct rf_thin_choice *choice);

/*
 * Hair before print: F, the mean light around a pixel, is neither that of a letter nor that of the
 * paper, so the pattern would stay in alpha N, as dashes. Along a line of one pixel C follows f,
 * the mean of the far pixels beside each,
 *
 *     C = alpha N + (1 - alpha) f
 *
 * so least squares yield 1 - alpha, the slope in all three channels, and alpha N. Where f varies,
 * and explains half of how C varies, alpha becomes that, and F = (C - alpha N) / (1 - alpha).
 */
void rf_fit_coverage(const struct rf_thin_pass *t, struct rf_thin *thin, int tx, int ty);

#endif
