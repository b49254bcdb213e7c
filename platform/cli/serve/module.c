/* module.c: the HTTP server of `refocus serve` is loaded as a module. */
#include <stdio.h>
#include <string.h>
#include "serve/module.h"

#ifdef RF_HAVE_WEB
#include "line/module.h"

web_run_fn *web_module(char *why)
{
    char reason[MODULE_WHY] = "it is of another version";
    void *module = module_open("../web/refocus-web.so", "refocus/refocus-web.so", reason);
    void *const symbol = module ? module_symbol(module, "rf_web_run") : NULL;
    web_run_fn *run;

    if (!symbol) {
        snprintf(why, 256, "the part with the server cannot be loaded: %.180s", reason);
        return NULL;
    }
    memcpy(&run, &symbol, sizeof run);
    return run;
}
#else
web_run_fn *web_module(char *why)
{
    snprintf(why, 256, "this build has no server; build it with libmicrohttpd");
    return NULL;
}
#endif
