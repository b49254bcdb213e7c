/* interrupt.h: Ctrl-C and the other signals that end a process: the work is ended early and
 * nothing partial stays behind. After SIGINT and SIGTERM the command returns as after any error;
 * the others end it in the end. */
#ifndef RF_CLI_INTERRUPT_H
#define RF_CLI_INTERRUPT_H

#include <stdbool.h>
#include <refocus/render.h>

/* Called before any other thread is started. When no thread can be had a signal ends the process as
 * it would without this. */
void interrupt_start(void);
/* Called after all work; does not return where a signal is to end the process. */
void interrupt_stop(void);

/* The renderer that a signal cancels, or NULL for none any more. */
void interrupt_watch(struct refocus_renderer *renderer);

/* Whether a signal has come. */
bool interrupt_came(void);

/* Whether it will end the process: a reader that has gone need not be told anything. */
bool interrupt_ends(void);

/* Hold signals back while a file is written, which none shall cut short. */
void interrupt_hold(bool hold);

/* Set a function that is called, in another thread, before a signal ends the process at once; not
 * while a file is held. NULL: nothing. */
void interrupt_clean_up(void (*function)(void *), void *of);

#endif
