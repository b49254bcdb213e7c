/* render.h: the pictures of a viewer's session, made by its thread. */
#ifndef RF_VIEW_RENDER_H
#define RF_VIEW_RENDER_H

#include "shared.h"

/* All return REFOCUS_OK or a status; REFOCUS_ERR_CANCELLED when something newer came. */

/* Called before all others. */
int rf_view_make_renderers(struct rf_session *session);

/* The lens of a state, for the full picture or for the reduced one. */
struct refocus_settings rf_view_lens(const struct rf_session *session,
                                     const struct rf_view_state *state, bool full);

/* Whether both are of the same lens. Rays do not count: a picture that was saved may be shown, too.
 */
bool rf_view_same_lens(const struct refocus_settings *a, const struct refocus_settings *b);

/* Render `small_out` by the sweep. */
int rf_view_render_small(struct rf_session *session, const struct rf_view_state *state);

/* Render `full_out`, of which `have_full` and `full_of` tell. */
int rf_view_render_full(struct rf_session *session, const struct refocus_settings *params);

/* Render the picture that is saved: `full_out`, unless the photo holds more and `setup.saved` asks
 * for it; that is of its own memory, which is to be freed whatever this returned. */
int rf_view_render_saved(struct rf_session *session, const struct refocus_settings *params,
                         struct refocus_image *picture);

#endif
