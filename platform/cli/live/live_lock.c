/* live_lock.c: makes locks and conditions of `refocus live`, or nothing. */
#include "live/live_lock.h"

#include <stddef.h>
#include <time.h>

static bool make_condition(pthread_cond_t *changed)
{
    pthread_condattr_t attributes;
    bool made;

    if (pthread_condattr_init(&attributes) != 0)
        return false;
    made = pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC) == 0 &&
           pthread_cond_init(changed, &attributes) == 0;
    pthread_condattr_destroy(&attributes);
    return made;
}

bool live_lock_make(pthread_mutex_t *lock, pthread_cond_t *changed)
{
    if (pthread_mutex_init(lock, NULL) != 0)
        return false;
    if (!changed || make_condition(changed))
        return true;
    pthread_mutex_destroy(lock);
    return false;
}

void live_lock_end(pthread_mutex_t *lock, pthread_cond_t *changed)
{
    if (changed)
        pthread_cond_destroy(changed);
    pthread_mutex_destroy(lock);
}
