/* live_lock.h: locks of `refocus live`, with conditions whose time-outs follow CLOCK_MONOTONIC. */
#ifndef RF_CLI_LIVE_LOCK_H
#define RF_CLI_LIVE_LOCK_H

#include <pthread.h>
#include <stdbool.h>

/* Makes a lock and, if that is not NULL, a condition; false: the system has none left, and nothing
 * is to be ended. */
bool live_lock_make(pthread_mutex_t *lock, pthread_cond_t *changed);
void live_lock_end(pthread_mutex_t *lock, pthread_cond_t *changed);

#endif
