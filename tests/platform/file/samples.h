/* samples.h: one small file of every kind that the readers tell apart, for tests that damage
 * them. */
#ifndef RF_TEST_SAMPLES_H
#define RF_TEST_SAMPLES_H

#include "make.h"

struct sample {
    const char *name;
    struct bytes bytes;
    bool photo, depth; /* the one of the two readings that takes it whole */
    size_t whole_at;   /* cut here it is whole as well; 0: nowhere */
    bool loose_end;    /* the last bytes of the file may be cut and it still makes sense */
};

enum { SAMPLES_MAX = 26 };
/* Fill the array; returns how many. Free with free_samples(). */
int make_samples(struct sample *samples);
void free_samples(struct sample *samples, int count);

#endif
