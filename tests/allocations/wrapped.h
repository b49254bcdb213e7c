/* wrapped.h: calls that make something of the system are counted and can fail, for programs linked
 * with --wrap of them and of those that end it. One file of a program includes it. */
#ifndef ALLOCATIONS_WRAPPED_H
#define ALLOCATIONS_WRAPPED_H

static int calls, fail_at; /* calls that make something; the one that fails, from 1 on */
static int kept;           /* things that were made and not ended yet */

/* Defines a pair: `parameters` and `given` are what is declared and what is handed on, `failed` is
 * what the call returns that fails. */
#define WRAP(make, parameters, given, failed, end, ended_parameters, ended)                        \
    int __real_##make parameters;                                                                  \
    int __wrap_##make parameters;                                                                  \
    int __real_##end ended_parameters;                                                             \
    int __wrap_##end ended_parameters;                                                             \
    int __wrap_##make parameters                                                                   \
    {                                                                                              \
        if (++calls == fail_at)                                                                    \
            return failed;                                                                         \
        kept++;                                                                                    \
        return __real_##make given;                                                                \
    }                                                                                              \
    int __wrap_##end ended_parameters                                                              \
    {                                                                                              \
        kept--;                                                                                    \
        return __real_##end ended;                                                                 \
    }

#endif
