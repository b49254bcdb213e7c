/* keys.h: key frames: the values of render parameters at given times, and the way between them.
 *
 *     {
 *       "refocus-pull": 1,
 *       "keys": [
 *         {"time": 0, "focus": 1, "blur": 12},
 *         {"time": 1.5, "focus": 0.2, "ease": "in"},
 *         {"time": 2, "blur": 30}
 *       ]
 *     }
 *
 * Times are in seconds, each later than the one before. A key names those parameters
 * that have a value there; between two keys that name it a parameter goes from one
 * value to the other as "ease" of the second says, before the first and after the last
 * it stays.
 */
#ifndef RF_CLI_KEYS_H
#define RF_CLI_KEYS_H

#include <stddef.h>
#include <stdint.h>
#include <refocus/settings.h>
#include "line/option.h"

enum ease { EASE_SMOOTH, EASE_LINEAR, EASE_IN, EASE_OUT };
extern const struct option_word ease_words[];

/* Part of the way, 0 to 1, at a part of the time. */
double ease_at(enum ease ease, double part);

struct keys;

/* Exit codes; these print why it is not EXIT_DONE. `file` is what errors call it. */
int keys_load(struct keys **keys, const char *file);
int keys_read(struct keys **keys, const char *file, const char *bytes, size_t size);
void keys_free(struct keys *keys);

/* A key by hand: a parameter by its name, which there has to be, with a value in its
 * range. */
int keys_add(struct keys **keys, double time, const char *name, double value, enum ease ease);

double keys_seconds(const struct keys *keys);

/* The largest value of a parameter, or `otherwise` if no key names it. */
double keys_most(const struct keys *keys, const char *name, double otherwise);

/* Set what keys name to its values at a time. */
void keys_apply(const struct keys *keys, double time, struct refocus_settings *params);

#endif
