/* session.h: the pictures of a viewer are worked out on a thread of their own: no call here waits
 * for a picture. */
#ifndef RF_VIEW_SESSION_H
#define RF_VIEW_SESSION_H

#include <stdbool.h>
#include <stdint.h>
#include "view_state.h"

struct rf_session;

/* REFOCUS_OK, REFOCUS_ERR_MEMORY, REFOCUS_ERR_THREAD, REFOCUS_ERR_SIZE. */
int rf_session_create(struct rf_session **session, const struct rf_session_setup *setup);
void rf_session_destroy(struct rf_session **session);

/* The number of the request, which frames answer. A newer request replaces one that is not done. */
uint64_t rf_session_show(struct rf_session *session, const struct rf_view_state *state);

/* Save what is shown: enum rf_view_save, or-ed. */
void rf_session_save(struct rf_session *session, uint32_t what);

/* Words about what was saved, when there are some that were not taken yet. */
bool rf_session_words(struct rf_session *session, char words[RF_VIEW_WORDS]);

/* Call it some times a second: ends work on requests that are out of date. */
void rf_session_tick(struct rf_session *session);

/* The newest frame, when there is one that was not taken yet: it stays the caller's
 * until the next call that returns true. */
bool rf_session_frame(struct rf_session *session, const struct rf_view_frame **frame);

/* The first status that was no success: the thread goes on with what it can. */
int rf_session_status(struct rf_session *session);

/* Pixels of a photo for one of the reduced picture, each way. */
int rf_session_reduction(const struct rf_session *session);

#endif
