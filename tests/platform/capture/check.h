/* check.h: cmocka with the headers it needs, and helpers that the tests of this folder share. */
#ifndef CAPTURE_CHECK_H
#define CAPTURE_CHECK_H

#include <stdint.h>
#include "unit_test.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/platform/source.h>

/* Entries of a folder of /proc/self: descriptors ("fd") or threads ("task"). */
int count_entries(const char *folder);
/* Lines of /proc/self/maps. */
int count_mappings(void);

/* A source that must open and start. */
struct refocus_source *started(const char *name, uint32_t flags);

#define assert_status(expression, status)                                                          \
    do {                                                                                           \
        const int got_ = (expression);                                                             \
        if (got_ != (status))                                                                      \
            fail_msg("%s gives %d (%s), not %d", #expression, got_, refocus_strerror(got_),        \
                     (int)(status));                                                               \
    } while (0)

#endif
