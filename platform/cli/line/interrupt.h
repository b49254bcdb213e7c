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

/* Set a function that ends other work. It is called in another thread, again and again once a
 * signal has come, and for the last time before this returns. Where the work has not ended two
 * seconds after SIGINT or SIGTERM, they end the process, as the other signals do. NULL: nothing. */
void interrupt_call(void (*function)(void *), void *of);

/* In place of the thread, for a process that only waits for others that it has started:
 * interrupt_wait_begin() ends the thread and holds signals back, in the processes to come too until
 * each calls interrupt_start(). interrupt_wait_child() returns when one of them may have ended, or
 * true for a signal; *all_know: the whole group has got it, as by Ctrl-C. */
void interrupt_wait_begin(void);
bool interrupt_wait_child(bool *all_know);

/* After interrupt_wait_begin(), for a process that waits for files too: one that can be read once a
 * signal has come, or -1. interrupt_take() then takes the signal. */
int interrupt_wait_file(void);
void interrupt_take(void);

/* Whether a signal has come; also as libraries ask it. */
bool interrupt_came(void);
int interrupt_cancels(void *unused);

/* Whether it will end the process: a reader that has gone need not be told anything. */
bool interrupt_ends(void);

/* Whether INTERRUPT_SOON_MS have gone by since one. interrupt_leave() then ends the process with a
 * status, or by the signal, and leaves threads that are still at work behind, without what they
 * have written in part. It flushes standard output, and does not return. */
enum { INTERRUPT_SOON_MS = 100 };
bool interrupt_is_late(void);
void interrupt_leave(int status);

/* Hold signals back for a moment: while a file has a name that interrupt_clean_up() does not know
 * yet. */
void interrupt_hold(bool hold);

/* Work that asks for no signal, such as that of other libraries, and that leaves nothing but
 * temporary files of refocus_image_write() and what interrupt_clean_up() removes: where it has not
 * ended INTERRUPT_SOON_MS after a signal the process ends, with this line and status 1, or by the
 * signal. The line stays until this is called with NULL. report_cut() makes the line. */
void interrupt_cut(const char *line);

/* Add a function, the fourth at the most, that is called, in another thread, before a signal ends
 * the process at once; not while signals are held. NULL: the last one is taken away. */
void interrupt_clean_up(void (*function)(void *), void *of);

#endif
