/* jobs.h: work on several photos is done in processes of their own, so that what goes wrong with
 * one leaves the others alone. */
#ifndef RF_CLI_JOBS_H
#define RF_CLI_JOBS_H

#include <stdbool.h>
#include <stdio.h>

struct jobs {
    int count;
    int at_once; /* processes at a time; 0: one for each processor, as far as memory reaches */
    void *of;    /* handed on to the functions */
    const char *(*name)(const void *of, int index); /* the photo's, for errors and progress */
    /* Work on a photo with so many threads, in a process of its own; an exit code. */
    int (*work)(void *of, int index, int threads);
    /* Take, in this process, all that the work printed on standard output; NULL: it goes there at
     * once. */
    void (*printed)(void *of, int index, int status, FILE *output);
};

/* EXIT_DONE, or EXIT_FAILED when one has failed; the last line says how many. Called without other
 * threads, but for that of interrupt.h, which has ended afterwards. */
int jobs_run(const struct jobs *jobs);

#endif
