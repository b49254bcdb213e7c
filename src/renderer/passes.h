/* passes.h: what a lens setting needs before its rays, made as far as it is not there
 * yet.
 *
 *     light of the blend  <-  photo, blend
 *     blur, bins          <-  disparity, K, df
 *     silhouettes and
 *     highlights in them  <-  photo
 *     smooth              <-  light, blur, spacing of the rays, gain of highlights
 *     background layer    <-  smooth, blur
 *
 * The shape of the aperture and rays as dense as before change none of them, nor does sigma,
 * but where the light of both layers is times its weight (passes/weights.h).
 * For a region only a window of the photo is worked on: the region, what its rays
 * reach, what the marks of the background there depend on, and as much around as its
 * fill asks for. What is in the window is kept for the next call.
 */
#ifndef RF_PASSES_H
#define RF_PASSES_H

#include "gather/frame.h"

enum rf_need {
    RF_NEED_LIGHT, /* the light alone */
    RF_NEED_BLUR,  /* and blur and bins */
    RF_NEED_LAYERS,
};

/* Make what rendering `region` needs and set the window and
 * f->region; `whole`: of the whole photo. Ends early when cancelled. */
void rf_run_passes(struct rf_frame *f, struct rf_rect region, enum rf_need need, bool whole);

/* The passes themselves, over the window. */
void rf_set_weights(struct rf_frame *f);
float rf_gathered_gain(const struct rf_frame *f);   /* 1 if they are splatted; of luma what fits */
void rf_pass_highlights(struct rf_frame *f);        /* detects them, in all of the photo, once */
void rf_pass_blur(struct rf_frame *f, bool layers); /* with layers ranges come after silhouettes */
void rf_pass_silhouettes(struct rf_frame *f);       /* after rf_pass_blur() */
void rf_pass_thin(struct rf_frame *f);              /* after rf_pass_blur() */
void rf_pass_smooth(struct rf_frame *f);
void rf_pass_prefilter(struct rf_frame *f); /* of rf_pass_smooth() the smooth light alone */
void rf_pass_mark_background(struct rf_frame *f,
                             int levels);             /* and up the pyramid, but of Y, U and V */
void rf_pass_inpaint(struct rf_frame *f, int levels); /* down the pyramid from there */
void rf_pass_boost(struct rf_frame *f); /* gathered highlights, after the background */
void rf_pass_weights(struct rf_frame *f);

/* Whether what r->cache tells of is for this lens, and its light for this frame's; note
 * the frame's there. */
bool rf_same_lens(const struct rf_frame *f);
bool rf_same_light(const struct rf_frame *f);
void rf_note_light(struct rf_frame *f);

/* Strip mode, blocks.c: render the region, whose tiles of a block `tiles` renders. */
void rf_run_strips(struct rf_frame *f, struct rf_rect region, enum rf_need need,
                   void (*tiles)(struct rf_frame *f));

#endif
