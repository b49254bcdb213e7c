/* Ctrl-C and SIGTERM: the work is ended early and nothing partial stays behind. */
#ifndef RF_CLI_INTERRUPT_H
#define RF_CLI_INTERRUPT_H

#include <stdbool.h>
#include <refocus/render.h>

/* Before any other thread is started. When no thread can be had a signal ends the
 * process as it would without this. */
void interrupt_start(void);
void interrupt_stop(void);

/* The renderer that a signal cancels, or NULL for none any more. */
void interrupt_watch(struct refocus_renderer *renderer);

/* Whether a signal has come. */
bool interrupt_came(void);

/* Around the writing of a file, which a second signal shall not cut short. */
void interrupt_hold(bool hold);

#endif
