/* live_state.c: how the threads of refocus live come to an end together. */
#include <stdio.h>
#include <unistd.h>
#include "line/interrupt.h"
#include "line/report.h"
#include "live/live_state.h"

bool live_is_over(struct live *live)
{
    return atomic_load(&live->quit) || interrupt_came();
}

void live_stop(struct live *live)
{
    const uint64_t one = 1;

    atomic_store(&live->quit, true);
    live_steady_cancel(&live->steady);
    if (write(live->wake_fd, &one, sizeof one) < 0)
        return;
    pthread_mutex_lock(&live->lock);
    refocus_source_interrupt(live->camera);
    refocus_source_interrupt(live->depth_camera);
    pthread_mutex_unlock(&live->lock);
}

void live_note_failure(struct live *live, int exit_code, const char *what, const char *why)
{
    pthread_mutex_lock(&live->lock);
    if (live->exit_code == EXIT_DONE) {
        live->exit_code = exit_code;
        snprintf(live->what, sizeof live->what, "%s", what);
        snprintf(live->why, sizeof live->why, "%s", why);
    }
    pthread_mutex_unlock(&live->lock);
}

void live_fail(struct live *live, int exit_code, const char *what, const char *why)
{
    live_note_failure(live, exit_code, what, why);
    live_stop(live);
}
