/* log.h: one line of words for each error, to whom the caller said: which argument, its value, and
 * what it may be. */
#ifndef RF_LOG_H
#define RF_LOG_H

#include <refocus/render.h>

/* Whom to tell, and what every line begins with: the name of the function that was called. A log
 * without a message function, as of functions that have none, is silent. */
struct rf_log {
    struct refocus_log to;
    const char *function;
};

#if defined(__GNUC__) || defined(__clang__)
#define RF_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define RF_PRINTF(text, first)
#endif

/* Say "FUNCTION: TEXT" and return the status. */
int rf_refuse(const struct rf_log *log, int status, const char *format, ...) RF_PRINTF(3, 4);

/* refocus_struct_read(), and words when it fails. `name` is what the caller calls the struct. */
int rf_read_struct(const struct rf_log *log, const char *name, void *own, size_t known,
                   size_t first, const void *given);

#endif
