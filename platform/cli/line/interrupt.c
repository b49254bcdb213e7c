/* refocus_cancel() may be called from any thread, but not from a signal handler:
 * signals are blocked everywhere and a thread of their own waits for them. */
#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <time.h>
#include "line/interrupt.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct refocus_renderer *watched; /* these three under the lock */
static bool came, held;
static pthread_t thread;
static bool started;

/* SIGINT and SIGTERM, but for those that the caller has the process ignore, as nohup
 * and shells do for work in the background. */
static void choose_signals(sigset_t *set)
{
    static const int numbers[] = {SIGINT, SIGTERM};
    struct sigaction action;

    sigemptyset(set);
    for (int i = 0; i < 2; i++)
        if (sigaction(numbers[i], NULL, &action) == 0 && action.sa_handler != SIG_IGN)
            sigaddset(set, numbers[i]);
}

static void cancel(void)
{
    pthread_mutex_lock(&lock);
    came = true;
    if (watched)
        refocus_cancel(watched);
    pthread_mutex_unlock(&lock);
}

static void end_process(int number)
{
    sigset_t set;

    pthread_mutex_lock(&lock);
    if (!held) {
        signal(number, SIG_DFL);
        sigemptyset(&set);
        sigaddset(&set, number);
        raise(number);
        pthread_sigmask(SIG_UNBLOCK, &set, NULL);
    }
    pthread_mutex_unlock(&lock);
}

static void *wait_for_signals(void *argument)
{
    const struct timespec pause = {0, 10000000};
    sigset_t set;
    int number;

    choose_signals(&set);
    if (sigwait(&set, &number) != 0)
        return argument;
    /* A cancel has no effect on calls that have not begun: repeat it until the renderer
     * is given up. A second signal ends the process when nothing is being written. */
    for (;;) {
        cancel();
        number = sigtimedwait(&set, NULL, &pause);
        if (number > 0)
            end_process(number);
    }
}

void interrupt_start(void)
{
    sigset_t set;

    choose_signals(&set);
    pthread_sigmask(SIG_BLOCK, &set, NULL);
    started = pthread_create(&thread, NULL, wait_for_signals, NULL) == 0;
    if (!started)
        pthread_sigmask(SIG_UNBLOCK, &set, NULL);
}

void interrupt_stop(void)
{
    if (!started)
        return;
    pthread_cancel(thread); /* waiting for a signal is where that takes effect */
    pthread_join(thread, NULL);
    started = false;
}

void interrupt_watch(struct refocus_renderer *renderer)
{
    pthread_mutex_lock(&lock);
    watched = renderer;
    pthread_mutex_unlock(&lock);
}

bool interrupt_came(void)
{
    bool result;

    pthread_mutex_lock(&lock);
    result = came;
    pthread_mutex_unlock(&lock);
    return result;
}

void interrupt_hold(bool hold)
{
    pthread_mutex_lock(&lock);
    held = hold;
    pthread_mutex_unlock(&lock);
}
