/* Ctrl-C and SIGTERM: the work is ended early and nothing partial stays behind. */
#ifndef RF_CLI_INTERRUPT_H
#define RF_CLI_INTERRUPT_H

#include <stdbool.h>
#include <refocus/render.h>

/* Before any thread is started. Returns false when no thread can be had; then a signal ends
 * the process as it would without this. */
bool interrupt_start(void);

/* The renderer that a signal cancels, or NULL for none any more. */
void interrupt_watch(struct refocus_renderer *renderer);

/* Whether a signal has come. */
bool interrupt_came(void);

/* Around the writing of a file, which a second signal shall not cut short. */
void interrupt_hold(bool hold);

#endif
