/* store.h: a file is written beside its place and moved there when it is whole. */
#ifndef RF_FILE_STORE_H
#define RF_FILE_STORE_H

#include <stdbool.h>
#include <refocus/platform/file.h>

/* A file under construction. Writes after a failure do nothing. */
struct rf_store {
    void *stream; /* FILE * */
    char *temporary, *path;
    int error;                    /* errno of the first failure, or 0 */
    bool unsynced;                /* renamed without waiting for the disk */
    uint64_t written;             /* bytes so far */
    int (*cancelled)(void *user); /* asked before more is written; NULL: nobody */
    void *user;
    char *bytes; /* a file in memory */
    size_t size;
};

int rf_store_open(struct rf_store *store, const char *path, struct refocus_reason *reason);
void rf_store_write(struct rf_store *store, const void *bytes, size_t size);
/* Whether more is to be written: there was no failure, and nobody has cancelled it. */
bool rf_store_goes_on(struct rf_store *store);
/* Move the file into place when status is REFOCUS_OK and all was written, else remove it. */
int rf_store_close(struct rf_store *store, int status, struct refocus_reason *reason);

/* A file in memory, which becomes *blob, empty when status is an error. The store stays where it is
 * in between. */
int rf_store_open_memory(struct rf_store *store, struct refocus_reason *reason);
int rf_store_close_memory(struct rf_store *store, int status, struct refocus_blob *blob,
                          struct refocus_reason *reason);

#endif
