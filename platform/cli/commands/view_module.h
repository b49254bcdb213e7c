/* view_module.h: the window of `refocus view` as a module: it brings SDL's many libraries, so it
 * is loaded when it is asked for. */
#ifndef RF_CLI_VIEW_MODULE_H
#define RF_CLI_VIEW_MODULE_H

#include "view/view.h"

/* rf_view_run() of the module, or NULL when it is not in this build or cannot be
 * loaded; why: 256 bytes of words then. */
typedef int view_run_fn(const struct rf_view_setup *setup, struct rf_view_report *report,
                        char *reason);
view_run_fn *view_module(char *why);

#endif
