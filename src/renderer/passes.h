/* passes.h: the passes that a frame needs before its rays, run only where their results are not
 * there yet.
 *
 *     light of the blend  <-  photo, blend
 *     blur, bins          <-  disparity, K, df
 *     silhouettes and
 *     highlights in them  <-  photo
 *     smooth              <-  light, blur, spacing of the rays, gain of highlights
 *     hidden background   <-  smooth, blur
 *
 * The shape of the aperture, rays as dense as before and sigma change none of them.
 * For a region only a window of the photo is worked on: the region, the pixels that its rays
 * reach, those that the marks of the background there depend on, and as many around as its
 * inpainting needs. The planes of the window are kept for the next call.
 */
#ifndef RF_PASSES_H
#define RF_PASSES_H

#include "gather/frame.h"

enum rf_need {
    RF_NEED_LIGHT,  /* the light alone */
    RF_NEED_BLUR,   /* light, blur and bins */
    RF_NEED_LAYERS, /* all of that, smooth light and the hidden background */
};

/* Runs the passes that rendering `region` needs, for the whole photo if `whole`, and sets the
 * window and f->region. Ends early when cancelled. */
void rf_run_passes(struct rf_frame *f, struct rf_rect region, enum rf_need need, bool whole);

/* The passes themselves, over the window. */
void rf_set_weights(struct rf_frame *f);
void rf_pass_highlights(struct rf_frame *f);        /* detects them in the whole photo, once */
void rf_pass_blur(struct rf_frame *f, bool layers); /* with layers, ranges come later */
void rf_pass_silhouettes(struct rf_frame *f);       /* after rf_pass_blur() */
void rf_pass_thin(struct rf_frame *f);              /* after rf_pass_blur() */
void rf_pass_smooth(struct rf_frame *f);            /* ranges and the smooth light */
void rf_pass_prefilter(struct rf_frame *f);         /* the smooth light alone */
bool rf_boosts(const struct rf_frame *f);           /* tells whether rf_pass_boost() adds light */
void rf_pass_boost(struct rf_frame *f);             /* gathered highlights, after the background */
void rf_pass_weights(struct rf_frame *f);

/* Gives each pixel its chroma, for a search of a photo of Y, U and V, in the planes of smooth light
 * and of the hidden background: nothing in the cache is valid afterwards. */
void rf_pass_expand_chroma(struct rf_frame *f);

/* Mark the hidden background and push it up `levels` of the pyramid (a photo of Y, U and V is not
 * pushed here), and inpaint it on the way down from there. */
void rf_pass_mark_background(struct rf_frame *f, int levels);
void rf_pass_inpaint(struct rf_frame *f, int levels);

/* The gain of highlights that rays gather: 1 if they are splatted, and for a photo of Y, U and V
 * with weights no more than fits its sums. */
float rf_gathered_gain(const struct rf_frame *f);

/* Whether the results in r->cache are for this frame's lens, and for its light; the last one notes
 * the frame's light there. */
bool rf_same_lens(const struct rf_frame *f);
bool rf_same_light(const struct rf_frame *f);
void rf_note_light(struct rf_frame *f);

/* Strip mode, strips.c: renders the region block by block; `tiles` renders the tiles of a block. */
void rf_run_strips(struct rf_frame *f, struct rf_rect region, enum rf_need need,
                   void (*tiles)(struct rf_frame *f));

#endif
