/* test_pool.c: the pool: each item once, whoever is asleep; it neither waits for nor keeps awake
 * in vain. */
#include <stdint.h>

#include "unit_test.h"
#include <time.h>

#include <refocus/status.h>

#include "support/pool.h"

enum { MOST_ITEMS = 300 };

struct loop {
    struct rf_run run;
    atomic_int taken[MOST_ITEMS];
    atomic_bool in_use[RF_MAX_THREADS];
    atomic_int faults;     /* two at once with one worker's number */
    int plain[MOST_ITEMS]; /* written by any thread, read by ours: no race */
    int value, cancel_at;
};

static void take(void *context, int item, int worker)
{
    struct loop *loop = context;

    if (atomic_exchange(&loop->in_use[worker], true))
        atomic_fetch_add(&loop->faults, 1);
    atomic_fetch_add(&loop->taken[item], 1);
    loop->plain[item] = loop->value + item;
    if (item == loop->cancel_at)
        atomic_store(&loop->run.state, RF_RUN_CANCELLED);
    atomic_store(&loop->in_use[worker], false);
}

static void rest_ms(long ms)
{
    nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000}, NULL);
}

TEST(each_item_once)
{
    static const int threads[] = {1, 2, 3, 8, 64};

    for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
        static struct loop loop;
        struct rf_pool pool;

        loop = (struct loop){.cancel_at = -1};
        assert_int_equal(rf_pool_start(&pool, threads[t], NULL, &loop.run), REFOCUS_OK);
        for (int round = 0; round < 400; round++) {
            const int count = round * 7 % (MOST_ITEMS + 1);

            loop.value = round;
            for (int i = 0; i < MOST_ITEMS; i++)
                atomic_store(&loop.taken[i], 0);
            rf_pool_run(&pool, take, &loop, count);
            for (int i = 0; i < MOST_ITEMS; i++) {
                assert_int_equal(atomic_load(&loop.taken[i]), i < count);
                if (i < count)
                    assert_int_equal(loop.plain[i], round + i);
            }
            if (round % 50 == 49)
                rest_ms(1); /* all asleep */
        }
        assert_int_equal(atomic_load(&loop.faults), 0);
        rf_pool_end(&pool);
    }
}

TEST(cancelled)
{
    static struct loop loop;
    struct rf_pool pool;
    int taken = 0;

    loop = (struct loop){.cancel_at = 0};
    assert_int_equal(rf_pool_start(&pool, 2, NULL, &loop.run), REFOCUS_OK);
    atomic_store(&loop.run.state, RF_RUN_CANCELLED);
    rf_pool_run(&pool, take, &loop, MOST_ITEMS);
    for (int i = 0; i < MOST_ITEMS; i++)
        taken += atomic_load(&loop.taken[i]);
    assert_int_equal(taken, 0);
    atomic_store(&loop.run.state, RF_RUN_RUNNING);
    loop.cancel_at = -1;
    rf_pool_run(&pool, take, &loop, MOST_ITEMS);
    for (int i = 0; i < MOST_ITEMS; i++)
        assert_int_equal(atomic_load(&loop.taken[i]), 1);
    rf_pool_end(&pool);
}

static void add_item(void *context, int item, int worker)
{
    (void)item;
    (void)worker;
    atomic_fetch_add((atomic_int *)context, 1);
}

/* Another thread asks for the loop's end: nobody takes items for much longer. */
static void wait_item(void *context, int item, int worker)
{
    struct loop *loop = context;

    (void)item;
    (void)worker;
    atomic_fetch_add(&loop->taken[0], 1);
    atomic_store(&loop->run.state, RF_RUN_CANCELLED);
    rest_ms(1);
}

TEST(cancelled_on_the_way)
{
    static struct loop loop;
    struct rf_pool pool;

    loop = (struct loop){.cancel_at = -1};
    assert_int_equal(rf_pool_start(&pool, 3, NULL, &loop.run), REFOCUS_OK);
    rf_pool_run(&pool, wait_item, &loop, 100000);
    assert_in_range(atomic_load(&loop.taken[0]), 1, 3); /* one of each thread */
    rf_pool_end(&pool);
}

static double cpu_seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A pool with nothing to do costs nothing, whether there is a processor for each thread
 * or not: if they stayed awake, they would take all that the machine has. */
TEST(idle_sleeps)
{
    static const int threads[] = {2, 16};

    for (int t = 0; t < 2; t++) {
        struct rf_pool pool;
        atomic_int items = 0;
        double before;

        assert_int_equal(rf_pool_start(&pool, threads[t], NULL, NULL), REFOCUS_OK);
        rf_pool_run(&pool, add_item, &items, 100);
        assert_int_equal(atomic_load(&items), 100);
        rest_ms(50);
        before = cpu_seconds();
        rest_ms(300);
        assert_true(cpu_seconds() - before < 0.03);
        rf_pool_end(&pool);
    }
}

TEST(short_lives)
{
    for (int round = 0; round < 200; round++) {
        struct rf_pool pool;
        atomic_int items = 0;

        assert_int_equal(rf_pool_start(&pool, 1 + round % 5, NULL, NULL), REFOCUS_OK);
        if (round % 2)
            rf_pool_run(&pool, add_item, &items, round);
        rf_pool_end(&pool);
        assert_int_equal(atomic_load(&items), round % 2 ? round : 0);
    }
}
