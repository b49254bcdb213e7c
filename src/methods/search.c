#include "methods/method.h"
void rf_search_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker) { (void)tx;(void)ty;(void)worker; rf_copy_tile(f, rect); }
