/* canceller.h: a renderer is cancelled by itself, at a chosen look whether to go on. */
#ifndef RENDER_CANCELLER_H
#define RENDER_CANCELLER_H

#include "renderer/renderer.h"

/* Cancels when it has been looked `left` times whether to go on. */
struct canceller {
    struct refocus_renderer *renderer;
    atomic_int left, looks;
};

/* For renderer->run.looked_at; run.user is the canceller. */
static inline void cancel_later(void *user)
{
    struct canceller *canceller = user;

    atomic_fetch_add(&canceller->looks, 1);
    if (atomic_fetch_sub(&canceller->left, 1) == 1)
        refocus_cancel(canceller->renderer);
}

#endif
