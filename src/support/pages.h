/* pages.h: memory of many megabytes in large pages, where the system has them. */
#ifndef RF_PAGES_H
#define RF_PAGES_H

#include <stddef.h>

/* A tile's rays look into rows that are kilobytes apart, in several planes, each in a page of its
 * own: with small pages most processors have to look these up over and over. A wish, which may
 * come to nothing. */
void rf_prefer_large_pages(void *block, size_t size);

#endif
