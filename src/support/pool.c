#include "support/pool.h"

#include <refocus/status.h>

static void take_items(struct rf_pool *pool, int worker)
{
    while (!rf_run_cancelled(pool->run)) {
        const int item = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);

        if (item >= pool->count)
            return;
        pool->work(pool->context, item, worker);
    }
}

/* The items of the caller's loop are our workers: each has scratch memory of its own, and takes
 * items of ours until there are none. */
static void caller_item(void *context, int32_t worker)
{
    take_items(context, worker);
}

static void *thread_main(void *argument)
{
    struct rf_pool *pool = argument;
    unsigned seen = 0;
    int worker;

    pthread_mutex_lock(&pool->lock);
    worker = ++pool->started;
    pthread_cond_signal(&pool->done);
    for (;;) {
        while (pool->generation == seen && !pool->quit)
            pthread_cond_wait(&pool->wake, &pool->lock);
        if (pool->quit)
            break;
        seen = pool->generation;
        pthread_mutex_unlock(&pool->lock);
        take_items(pool, worker);
        pthread_mutex_lock(&pool->lock);
        if (--pool->busy == 0)
            pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static void join(struct rf_pool *pool, int created)
{
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (int i = 0; i < created; i++)
        pthread_join(pool->thread[i], NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
}

int rf_pool_start(struct rf_pool *pool, int threads, const struct refocus_parallel *parallel,
                  struct rf_run *run)
{
    int created = 0;

    *pool = (struct rf_pool){.threads = threads, .run = run};
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
    /* Wait until all have their worker numbers: a loop may not begin before. */
    pthread_mutex_lock(&pool->lock);
    while (pool->started < created)
        pthread_cond_wait(&pool->done, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
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
        pthread_mutex_lock(&pool->lock);
        pool->busy = pool->threads - 1;
        pool->generation++;
        pthread_cond_broadcast(&pool->wake);
        pthread_mutex_unlock(&pool->lock);
        take_items(pool, 0);
        pthread_mutex_lock(&pool->lock);
        while (pool->busy > 0)
            pthread_cond_wait(&pool->done, &pool->lock);
        pthread_mutex_unlock(&pool->lock);
    }
}
