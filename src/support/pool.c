/* pool.c: threads that share out the items of a loop. */
#include "support/pool.h"

#include <refocus/status.h>

#include <stdint.h>
#include <time.h>
#include <unistd.h>

enum {
    WORKERS = 0xff, /* bits of pool->state */
    OPEN = 0x100,
    LOOP = 0x200,
};

enum {
    SPIN_NS = 150 * 1000, /* longer than the work between two loops of a picture */
    SPINS = 32,           /* pauses between two looks at the clock */
    SHARES = 4,           /* runs for each thread in the items that are left */
};

/* Takes a run of items. Items that lie side by side write to shared cache lines, so they are handed
 * out in runs, long ones first, which get shorter as fewer items are left. */
static int take_run(struct rf_pool *pool, int *end)
{
    const int shares = SHARES * pool->threads;
    int first = atomic_load_explicit(&pool->next, memory_order_relaxed), n;

    do {
        const int left = pool->count - first;

        if (left <= 0)
            return *end = pool->count;
        n = left > shares ? left / shares : 1;
    } while (!atomic_compare_exchange_weak_explicit(&pool->next, &first, first + n,
                                                    memory_order_relaxed, memory_order_relaxed));
    *end = first + n;
    return first;
}

static void take_items(struct rf_pool *pool, int worker)
{
    const int count = pool->count;
    int item, end;

    while ((item = take_run(pool, &end)) < count)
        for (; item < end; item++) {
            if (rf_run_cancelled(pool->run))
                return;
            pool->work(pool->context, item, worker);
        }
}

/* An item of the caller's loop is one of our workers: it has scratch memory of its own, and takes
 * items of ours until there are none. */
static void caller_item(void *context, int32_t worker)
{
    take_items(context, worker);
}

static inline void pause_briefly(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__) || (defined(__arm__) && __ARM_ARCH >= 7)
    __asm__ volatile("yield");
#endif
}

static int64_t now_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Whether there is a loop to join other than the one last seen. */
static bool is_new(unsigned state, unsigned seen)
{
    return state & OPEN && (state & ~WORKERS) != seen;
}

static bool nobody_in(unsigned state)
{
    return !(state & WORKERS);
}

/* Stays awake for a while, as to be woken takes 50 us and more, about as long as a small loop. */
static bool spin(struct rf_pool *pool, bool (*is_over)(struct rf_pool *pool, unsigned seen),
                 unsigned seen)
{
    int64_t end;

    if (!pool->spins)
        return false;
    end = now_ns() + SPIN_NS;
    do {
        for (int i = 0; i < SPINS; i++) {
            if (is_over(pool, seen))
                return true;
            pause_briefly();
        }
    } while (now_ns() < end);
    return false;
}

static bool is_called(struct rf_pool *pool, unsigned seen)
{
    return is_new(atomic_load(&pool->state), seen) || atomic_load(&pool->quit);
}

static bool is_left(struct rf_pool *pool, unsigned seen)
{
    (void)seen;
    return nobody_in(atomic_load(&pool->state));
}

/* Waits for a loop, asleep if it takes long. Whoever opens a loop sees `sleepers`, or the sleeper
 * sees the loop: both exchange before they look. A store would do for processors, but emulators of
 * ARM let the load after it go first, and both sides sleep. */
static void wait_for_loop(struct rf_pool *pool, unsigned seen)
{
    if (spin(pool, is_called, seen))
        return;
    pthread_mutex_lock(&pool->lock);
    atomic_fetch_add(&pool->sleepers, 1);
    while (!is_called(pool, seen))
        pthread_cond_wait(&pool->wake, &pool->lock);
    atomic_fetch_sub(&pool->sleepers, 1);
    pthread_mutex_unlock(&pool->lock);
}

/* Joins the loop if it is still open. A thread that comes too late does not wait for a closed loop,
 * nor the loop for it. */
static bool join_loop(struct rf_pool *pool, unsigned *seen)
{
    unsigned state = atomic_load(&pool->state);

    while (is_new(state, *seen))
        if (atomic_compare_exchange_weak(&pool->state, &state, state + 1)) {
            *seen = state & ~WORKERS;
            return true;
        }
    return false;
}

static void leave_loop(struct rf_pool *pool)
{
    if ((atomic_fetch_sub(&pool->state, 1) & (WORKERS | OPEN)) == 1 && atomic_load(&pool->waits)) {
        pthread_mutex_lock(&pool->lock);
        pthread_cond_signal(&pool->done);
        pthread_mutex_unlock(&pool->lock);
    }
}

static void *thread_main(void *argument)
{
    struct rf_pool *pool = argument;
    const int worker = 1 + atomic_fetch_add(&pool->started, 1);
    unsigned seen = 0;

    while (!atomic_load(&pool->quit)) {
        wait_for_loop(pool, seen);
        if (join_loop(pool, &seen)) {
            take_items(pool, worker);
            leave_loop(pool);
        }
    }
    return NULL;
}

static void open_loop(struct rf_pool *pool)
{
    atomic_exchange(&pool->state, ((atomic_load(&pool->state) & ~OPEN) + LOOP) | OPEN);
    if (atomic_load(&pool->sleepers) > 0) {
        pthread_mutex_lock(&pool->lock);
        pthread_cond_broadcast(&pool->wake);
        pthread_mutex_unlock(&pool->lock);
    }
}

static void close_loop(struct rf_pool *pool)
{
    if (nobody_in(atomic_fetch_and(&pool->state, ~(unsigned)OPEN)) || spin(pool, is_left, 0))
        return;
    pthread_mutex_lock(&pool->lock);
    atomic_exchange(&pool->waits, true); /* exchanged before the look, as `sleepers` is */
    while (!is_left(pool, 0))
        pthread_cond_wait(&pool->done, &pool->lock);
    atomic_store(&pool->waits, false);
    pthread_mutex_unlock(&pool->lock);
}

static void join(struct rf_pool *pool, int created)
{
    pthread_mutex_lock(&pool->lock);
    atomic_store(&pool->quit, true);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (int i = 0; i < created; i++)
        pthread_join(pool->thread[i], NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
}

int rf_thread_count(int32_t asked)
{
    const long n = asked ? asked : sysconf(_SC_NPROCESSORS_ONLN);

    return n < 1 ? 1 : n > RF_MAX_THREADS ? RF_MAX_THREADS : (int)n;
}

int rf_pool_start(struct rf_pool *pool, int threads, const struct refocus_parallel *parallel,
                  struct rf_run *run)
{
    int created = 0;

    *pool = (struct rf_pool){.threads = threads, .run = run};
    pool->spins = threads <= sysconf(_SC_NPROCESSORS_ONLN);
    if (parallel && parallel->parallel_for) {
        pool->parallel = *parallel;
        return REFOCUS_OK;
    }
    if (pthread_mutex_init(&pool->lock, NULL))
        goto no_lock;
    if (pthread_cond_init(&pool->wake, NULL))
        goto no_wake;
    if (pthread_cond_init(&pool->done, NULL))
        goto no_done;
    while (created < threads - 1) {
        if (pthread_create(&pool->thread[created], NULL, thread_main, pool)) {
            join(pool, created);
            return REFOCUS_ERR_THREAD;
        }
        created++;
    }
    return REFOCUS_OK;

no_done:
    pthread_cond_destroy(&pool->wake);
no_wake:
    pthread_mutex_destroy(&pool->lock);
no_lock:
    return REFOCUS_ERR_THREAD;
}

void rf_pool_end(struct rf_pool *pool)
{
    if (!pool->parallel.parallel_for)
        join(pool, pool->threads - 1);
}

void rf_pool_run(struct rf_pool *pool, rf_work_fn *work, void *context, int count)
{
    pool->work = work;
    pool->context = context;
    pool->count = count;
    atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
    if (pool->threads == 1 || count <= 1) {
        take_items(pool, 0);
    } else if (pool->parallel.parallel_for) {
        pool->parallel.parallel_for(pool->parallel.user, caller_item, pool,
                                    count < pool->threads ? count : pool->threads);
    } else {
        open_loop(pool);
        take_items(pool, 0);
        close_loop(pool);
    }
}
