/* interrupt.c: Ctrl-C ends the work early. refocus_cancel() may be called from any thread, but
 * not from a signal handler, so signals are blocked everywhere and a thread of their own waits
 * for them. */
#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>
#include "line/interrupt.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct refocus_renderer *watched; /* this and all to clean_up_count under the lock */
static bool came, held;
static const char *cut;
static void (*end_work)(void *);
static void *end_work_of;
static struct {
    void (*function)(void *);
    void *of;
} clean_ups[4];
static int clean_up_count;
static pthread_t thread;
static bool started;
static atomic_bool late;
static atomic_int ending; /* the signal that is to end the process, or 0 */

/* Signals that end a process, but for those that the caller has it ignore, as nohup and shells do
 * for work in the background, and those of a debugger or profiler. */
static void choose_signals(sigset_t *set)
{
    static const int numbers[] = {
        SIGINT,    SIGTERM, SIGHUP, SIGQUIT, SIGALRM, SIGUSR1, SIGUSR2,
#ifdef SIGVTALRM
        SIGVTALRM,
#endif
#ifdef SIGPROF
        SIGPROF,
#endif
#ifdef SIGPOLL
        SIGPOLL,
#endif
#ifdef SIGXCPU
        SIGXCPU,
#endif
#ifdef SIGPWR
        SIGPWR,
#endif
#ifdef SIGSTKFLT
        SIGSTKFLT,
#endif
    };
    struct sigaction action;

    sigemptyset(set);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (sigaction(numbers[i], NULL, &action) == 0 && action.sa_handler == SIG_DFL)
            sigaddset(set, numbers[i]);
    for (int number = SIGRTMIN; number <= SIGRTMAX; number++)
        if (sigaction(number, NULL, &action) == 0 && action.sa_handler == SIG_DFL)
            sigaddset(set, number);
}

/* A write that cannot go on raises these in its own thread, and fails when they have a
 * handler: the work then ends as by any error. */
static void note_signal(int number)
{
    atomic_store(&ending, number);
}

static void note_failed_writes(void)
{
    static const int numbers[] = {SIGPIPE, SIGXFSZ};
    struct sigaction action;

    for (int i = 0; i < 2; i++)
        if (sigaction(numbers[i], NULL, &action) == 0 && action.sa_handler == SIG_DFL) {
            action.sa_handler = note_signal;
            action.sa_flags = SA_RESTART;
            sigaction(numbers[i], &action, NULL);
        }
}

static void cancel(void)
{
    pthread_mutex_lock(&lock);
    came = true;
    if (watched)
        refocus_cancel(watched);
    if (end_work)
        end_work(end_work_of);
    pthread_mutex_unlock(&lock);
}

static void die_of(int number)
{
    sigset_t set;

    signal(number, SIG_DFL);
    sigemptyset(&set);
    sigaddset(&set, number);
    raise(number);
    pthread_sigmask(SIG_UNBLOCK, &set, NULL);
}

/* Remove the files of this process that are open to be written and have their temporary names
 * (platform/file/store.c) still; false: which those are cannot be told. */
static bool remove_temporaries(void)
{
    enum { LONGEST = 4096 };
    DIR *const files = opendir("/proc/self/fd");
    char begin[32], name[LONGEST];

    if (!files)
        return false;
    snprintf(begin, sizeof begin, "/.refocus-%u-", (unsigned)getpid());
    for (const struct dirent *entry; (entry = readdir(files));) {
        const int mode = fcntl(atoi(entry->d_name), F_GETFL);
        const ssize_t length = readlinkat(dirfd(files), entry->d_name, name, LONGEST - 1);
        const char *last;

        if (length < 0 || mode < 0 || (mode & O_ACCMODE) == O_RDONLY)
            continue;
        name[length] = '\0';
        last = strrchr(name, '/');
        if (last && strncmp(last, begin, strlen(begin)) == 0)
            unlink(name);
    }
    closedir(files);
    return true;
}

/* The line of work that is cut. It is printed past the stream, whose lock the work may
 * have, and left out where standard error would make us wait. */
static void print_cut(void)
{
    struct pollfd error = {.fd = STDERR_FILENO, .events = POLLOUT};

    if (poll(&error, 1, 0) == 1 && error.revents & POLLOUT)
        (void)!write(STDERR_FILENO, cut, strlen(cut));
}

static void remove_all(void)
{
    for (int i = 0; i < clean_up_count; i++)
        clean_ups[i].function(clean_ups[i].of);
}

/* Ends the process with the status that the work would end with where work is cut, else by the
 * signal. Does nothing while signals are held back, or where work is cut whose temporary files
 * cannot be found. */
static void end_process(int number, bool by_signal)
{
    pthread_mutex_lock(&lock);
    if (!held && (remove_temporaries() || !cut)) {
        remove_all();
        if (cut && !by_signal)
            print_cut();
        if (cut && !by_signal && atomic_load(&ending) == 0)
            _exit(EXIT_FAILURE);
        die_of(number);
    }
    pthread_mutex_unlock(&lock);
}

/* Whether the first signal ends the process by now, so many milliseconds after it came: by cutting
 * the work, or by the signal. */
static bool is_due(double waited, bool by_signal)
{
    enum { PATIENCE_MS = 2000 };
    bool result;

    pthread_mutex_lock(&lock);
    if (by_signal)
        result = waited >= PATIENCE_MS && (atomic_load(&ending) != 0 || end_work != NULL);
    else
        result = waited >= INTERRUPT_SOON_MS && cut != NULL;
    pthread_mutex_unlock(&lock);
    return result;
}

static double clock_ms(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

static void *wait_for_signals(void *argument)
{
    const struct timespec pause = {0, 10000000};
    sigset_t set;
    int first, second = 0;
    double since;

    choose_signals(&set);
    if (sigwait(&set, &first) != 0)
        return argument;
    since = clock_ms();
    /* Ctrl-C and SIGTERM end the work, with the status of one that was not done. */
    if (first != SIGINT && first != SIGTERM)
        atomic_store(&ending, first);
    /* A cancel has no effect on calls that have not begun: repeat it until the renderer
     * is given up. Work that asks nobody is cut soon. A second signal ends the process at once; so
     * does the first one after two seconds in which the work has not ended, as it waits for a
     * pipe: of a command that ends its own work, or of signals that are not asked to wait. */
    for (;;) {
        double waited;
        int number;

        cancel();
        number = sigtimedwait(&set, NULL, &pause);
        waited = clock_ms() - since;
        second = number > 0 ? number : second;
        atomic_store(&late, waited >= INTERRUPT_SOON_MS);
        if (second > 0)
            end_process(second, true);
        else if (is_due(waited, false))
            end_process(first, false);
        else if (is_due(waited, true))
            end_process(first, true);
    }
}

void interrupt_start(void)
{
    sigset_t set;

    note_failed_writes();
    choose_signals(&set);
    pthread_sigmask(SIG_BLOCK, &set, NULL);
    started = pthread_create(&thread, NULL, wait_for_signals, NULL) == 0;
    if (!started)
        pthread_sigmask(SIG_UNBLOCK, &set, NULL);
}

void interrupt_stop(void)
{
    int number;

    if (started) {
        pthread_cancel(thread); /* waiting for a signal is where that takes effect */
        pthread_join(thread, NULL);
        started = false;
    }
    number = atomic_load(&ending);
    if (number != 0)
        die_of(number);
}

static void choose_wait(sigset_t *set)
{
    choose_signals(set);
    sigaddset(set, SIGCHLD);
}

void interrupt_wait_begin(void)
{
    sigset_t set;

    interrupt_stop();
    signal(SIGCHLD, SIG_DFL);
    choose_wait(&set);
    pthread_sigmask(SIG_BLOCK, &set, NULL);
}

bool interrupt_wait_child(bool *all_know)
{
    sigset_t set;
    siginfo_t about;
    int number;

    choose_wait(&set);
    do
        number = sigwaitinfo(&set, &about);
    while (number < 0);
    if (number == SIGCHLD)
        return false;
    if (number != SIGINT && number != SIGTERM)
        atomic_store(&ending, number);
    *all_know = about.si_code > 0; /* by the kernel: of the terminal */
    return true;
}

int interrupt_wait_file(void)
{
    sigset_t set;

    choose_signals(&set);
    return signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

void interrupt_take(void)
{
    const struct timespec none = {0, 0};
    sigset_t set;
    int number;

    choose_signals(&set);
    number = sigtimedwait(&set, NULL, &none);
    if (number > 0 && number != SIGINT && number != SIGTERM)
        atomic_store(&ending, number);
}

bool interrupt_ends(void)
{
    return atomic_load(&ending) != 0;
}

void interrupt_watch(struct refocus_renderer *renderer)
{
    pthread_mutex_lock(&lock);
    watched = renderer;
    pthread_mutex_unlock(&lock);
}

void interrupt_call(void (*function)(void *), void *of)
{
    pthread_mutex_lock(&lock);
    end_work = function;
    end_work_of = of;
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

bool interrupt_is_late(void)
{
    return atomic_load(&late);
}

void interrupt_leave(int status)
{
    fflush(stdout);
    pthread_mutex_lock(&lock);
    remove_temporaries();
    remove_all();
    if (atomic_load(&ending) != 0)
        die_of(atomic_load(&ending));
    _exit(status);
}

int interrupt_cancels(void *unused)
{
    (void)unused;
    return interrupt_came();
}

void interrupt_hold(bool hold)
{
    pthread_mutex_lock(&lock);
    held = hold;
    pthread_mutex_unlock(&lock);
}

void interrupt_cut(const char *line)
{
    pthread_mutex_lock(&lock);
    cut = line;
    pthread_mutex_unlock(&lock);
}

void interrupt_clean_up(void (*function)(void *), void *of)
{
    pthread_mutex_lock(&lock);
    if (!function && clean_up_count > 0) {
        clean_up_count--;
    } else if (function && clean_up_count < (int)(sizeof clean_ups / sizeof *clean_ups)) {
        clean_ups[clean_up_count].function = function;
        clean_ups[clean_up_count++].of = of;
    }
    pthread_mutex_unlock(&lock);
}
