/* npy.h: a NumPy array of two sides as depth, from a file or from one in an archive. */
#ifndef RF_FILE_NPY_H
#define RF_FILE_NPY_H

#include "bytes.h"
#include "reading.h"

/* Gives the next bytes of an array's file, exactly so many; false: it ends before. */
typedef bool (*rf_npy_pull)(void *from, uint8_t *bytes, size_t count);

bool rf_is_npy(struct rf_bytes file);
/* Fills read->samples with the array, or says why not. `bytes` is how many can be pulled. */
int rf_npy_read(struct rf_read *read, rf_npy_pull pull, void *from, uint64_t bytes);

#endif
