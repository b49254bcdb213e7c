/* live_begin.c: locks, queues and events that refocus live begins with, and their end. */
#include <math.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include "line/report.h"
#include "live/live_lock.h"
#include "live/live_state.h"

int live_begin(struct live *live, const struct live_settings *settings, struct engine *engine)
{
    const bool newest_wins = settings->policy == POLICY_NEWEST;

    live->settings = settings;
    live->engine = engine;
    live->lens_dioptres = live->focus_disparity = live->blur = NAN;
    live->command_fd = -1;
    live->wake_fd = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    live->has_lock = live_lock_make(&live->lock, NULL);
    live->has_semaphore = sem_init(&live->first_commands, 0, 0) == 0;
    if (live->wake_fd < 0 || !live->has_lock || !live->has_semaphore ||
        !live_queue_init(&live->captured, newest_wins) ||
        !live_queue_init(&live->rendered, newest_wins) ||
        !live_queue_init(&live->to_estimate, newest_wins) ||
        !live_depths_init(&live->depths, settings->policy == POLICY_EVERY) ||
        !live_focus_init(&live->focus, &settings->lens)) {
        live_clear(live);
        return report_failure(EXIT_FAILED, "live", "the system has no lock or event left");
    }
    live->focus.blur = settings->lens.blur;
    live->focus.blur_most = settings->blur_most;
    return EXIT_DONE;
}

void live_clear(struct live *live)
{
    live_queue_free(&live->captured);
    live_queue_free(&live->rendered);
    live_queue_free(&live->to_estimate);
    live_depths_free(&live->depths);
    live_focus_free(&live->focus);
    if (live->has_lock)
        live_lock_end(&live->lock, NULL);
    if (live->has_semaphore)
        sem_destroy(&live->first_commands);
    if (live->wake_fd >= 0)
        close(live->wake_fd);
}
