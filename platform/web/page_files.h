/* page_files.h: the files of the page, which embed.py puts into the program. */
#ifndef RF_WEB_PAGE_FILES_H
#define RF_WEB_PAGE_FILES_H

#include <stddef.h>

struct page_file {
    const char *name, *type; /* name: "" for the page itself */
    const unsigned char *bytes;
    size_t size;
};

/* Ended by a name of NULL. */
extern const struct page_file page_files[];

#endif
