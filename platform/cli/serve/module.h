/* module.h: the HTTP server of `refocus serve` as a module, which is loaded when it is asked for.
 */
#ifndef RF_CLI_SERVE_MODULE_H
#define RF_CLI_SERVE_MODULE_H

#include "web/web.h"

/* rf_web_run() of the module, or NULL when it is not in this build or cannot be loaded; why: 256
 * bytes of words then. */
typedef int web_run_fn(const struct rf_web_setup *setup, char *reason);
web_run_fn *web_module(char *why);

#endif
