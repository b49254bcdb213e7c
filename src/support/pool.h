/* pool.h: threads that share out the items of a loop.
 *
 * rf_pool_run() calls work(context, item, worker) once for each item in 0 .. count - 1,
 * from the calling thread and the pool's. Which thread takes which item is left open,
 * so an item's result must not depend on it. worker, 0 .. threads - 1, picks scratch
 * memory.
 */
#ifndef RF_POOL_H
#define RF_POOL_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <refocus/render.h>

enum { RF_MAX_THREADS = 64 };

/* A run can be cancelled from outside: RUNNING becomes CANCELLED, nothing else does. */
enum rf_run_state { RF_RUN_IDLE, RF_RUN_RUNNING, RF_RUN_CANCELLED };

struct rf_run {
    atomic_int state;              /* enum rf_run_state */
    void (*looked_at)(void *user); /* for tests, else NULL: called at each look */
    void *user;
};

/* Whether a run was cancelled; a NULL run never is. Every loop that takes long asks at least once a
 * millisecond or two. */
static inline bool rf_run_cancelled(struct rf_run *run)
{
    if (!run)
        return false;
    if (run->looked_at)
        run->looked_at(run->user);
    return atomic_load_explicit(&run->state, memory_order_relaxed) == RF_RUN_CANCELLED;
}

typedef void rf_work_fn(void *context, int item, int worker);

struct rf_pool {
    int threads;                      /* with the calling one, or the caller's at most */
    bool spins;                       /* there is a processor for each thread */
    struct refocus_parallel parallel; /* the caller's, or parallel_for == NULL */
    pthread_t thread[RF_MAX_THREADS];
    pthread_mutex_t lock; /* only for those that sleep, and to wake them */
    pthread_cond_t wake, done;
    atomic_bool quit;
    atomic_bool waits; /* the caller sleeps until all have left */
    atomic_int started;
    atomic_int sleepers; /* pool threads */
    struct rf_run *run;  /* CANCELLED: hand out no more items */

    /* The loop, which is set before it is opened and kept until the last worker has left. */
    rf_work_fn *work;
    void *context;
    int count;
    atomic_uint state; /* the threads in it, whether it is open, and its number */
    char apart[64];    /* gives `next`, which all threads change, its own cache line */
    atomic_int next;   /* item */
    char apart_too[64];
};

/* The number of threads to work with when a caller asks for so many: 0 asks for one a processor. */
int rf_thread_count(int32_t asked);

/* Starts threads of its own, or none where the caller's parallel_for is to be used
 * (NULL or empty: it is not). Returns REFOCUS_OK or REFOCUS_ERR_THREAD, then with
 * nothing left behind. */
int rf_pool_start(struct rf_pool *pool, int threads, const struct refocus_parallel *parallel,
                  struct rf_run *run);
void rf_pool_end(struct rf_pool *pool);

/* Returns when all items are done, or those under way once the run is cancelled. */
void rf_pool_run(struct rf_pool *pool, rf_work_fn *work, void *context, int count);

#endif
