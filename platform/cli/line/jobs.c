/* jobs.c: work on several photos is done in processes of their own. */
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include "line/interrupt.h"
#include "line/jobs.h"
#include "line/memory.h"
#include "line/report.h"

struct process {
    pid_t pid;
    int index;
    FILE *output; /* or NULL */
};

struct run {
    const struct jobs *jobs;
    struct process *processes;
    int running, begun, done, failed, most;
    int64_t memory_kib; /* for all together */
    bool stopped;
};

/* The number of processes that may run now: of photos whose need is not known yet one, and then
 * as many as three quarters of the memory hold when each takes as much as the largest has. */
static int limit(const struct run *run)
{
    struct rusage usage;
    int64_t fit;

    if (run->jobs->at_once > 0)
        return run->jobs->at_once;
    if (run->done + run->failed == 0 || getrusage(RUSAGE_CHILDREN, &usage) != 0)
        return 1;
    fit = run->memory_kib * 3 / 4 / (usage.ru_maxrss > 0 ? usage.ru_maxrss : 1);
    return fit < 1 ? 1 : fit < run->most ? (int)fit : run->most;
}

static void show(const struct run *run, const char *name)
{
    char text[128];

    if (!report_is_watched())
        return;
    snprintf(text, sizeof text, "%d of %d, %.80s", run->done + run->failed, run->jobs->count, name);
    report_progress(text, (double)(run->done + run->failed) / run->jobs->count);
}

/* The life of a process; does not return. */
static void live(const struct run *run, const struct process *process, int at_once)
{
    const struct jobs *jobs = run->jobs;
    const int threads = report_processors() / at_once;
    int status;

    if (process->output)
        dup2(fileno(process->output), STDOUT_FILENO);
    report_about(jobs->name(jobs->of, process->index));
    interrupt_start();
    status = jobs->work(jobs->of, process->index, threads > 1 ? threads : 1);
    interrupt_stop();
    exit(status);
}

static bool begin(struct run *run, int at_once)
{
    struct process *process = &run->processes[run->running];

    process->index = run->begun;
    process->output = run->jobs->printed ? tmpfile() : NULL;
    if (run->jobs->printed && !process->output)
        return false;
    show(run, run->jobs->name(run->jobs->of, process->index));
    fflush(NULL);
    process->pid = fork();
    if (process->pid == 0)
        live(run, process, at_once);
    if (process->pid < 0) {
        if (process->output)
            fclose(process->output);
        return false;
    }
    run->begun++;
    run->running++;
    return true;
}

/* Begin as many as may run. A process that cannot be had is waited for while others run. */
static void begin_more(struct run *run)
{
    const int most = limit(run);

    while (!run->stopped && run->running < most && run->begun < run->jobs->count) {
        if (begin(run, most))
            continue;
        if (run->running > 0)
            return;
        report_failure(EXIT_FAILED, run->jobs->name(run->jobs->of, run->begun),
                       "no process can be had for it");
        run->begun++;
        run->failed++;
    }
}

static void finish(struct run *run, struct process *process, int status)
{
    const struct jobs *jobs = run->jobs;
    const char *name = jobs->name(jobs->of, process->index);
    int code = WIFEXITED(status) ? WEXITSTATUS(status) : EXIT_FAILED;

    if (WIFSIGNALED(status) && !run->stopped)
        report_failure(EXIT_FAILED, name, "its process was ended by signal %d%s", WTERMSIG(status),
                       WTERMSIG(status) == SIGKILL ? ", for want of memory if by nobody" : "");
    if (process->output) {
        rewind(process->output);
        jobs->printed(jobs->of, process->index, code, process->output);
        fclose(process->output);
    }
    if (code == EXIT_DONE)
        run->done++;
    else
        run->failed++;
    *process = run->processes[--run->running];
    show(run, name);
}

static void finish_ended(struct run *run)
{
    for (int i = run->running - 1; i >= 0; i--) {
        int status;

        if (waitpid(run->processes[i].pid, &status, WNOHANG) == run->processes[i].pid)
            finish(run, &run->processes[i], status);
    }
}

static void stop(struct run *run, bool all_know)
{
    run->stopped = true;
    for (int i = 0; i < run->running && !all_know; i++)
        kill(run->processes[i].pid, SIGTERM);
}

static int report(const struct run *run)
{
    const int left = run->jobs->count - run->begun;

    report_progress_end();
    fprintf(stderr, "%d rendered, %d failed", run->done, run->failed);
    if (left > 0)
        fprintf(stderr, ", %d not begun", left);
    fputc('\n', stderr);
    return run->done == run->jobs->count ? EXIT_DONE : EXIT_FAILED;
}

int jobs_run(const struct jobs *jobs)
{
    struct run run = {.jobs = jobs, .memory_kib = memory_free_kib()};
    int status;

    run.most = jobs->at_once > 0 ? jobs->at_once : report_processors();
    run.processes = calloc((size_t)run.most, sizeof *run.processes);
    if (!run.processes)
        return report_failure(EXIT_FAILED, "--jobs", "not enough memory; give fewer");
    interrupt_wait_begin();
    for (begin_more(&run); run.running > 0; begin_more(&run)) {
        bool all_know;

        if (interrupt_wait_child(&all_know))
            stop(&run, all_know);
        finish_ended(&run);
    }
    status = report(&run);
    free(run.processes);
    return status;
}
