/* view_module.c: the window of `refocus view` is loaded as a module. */
#include <stdio.h>
#include <string.h>
#include "commands/view_module.h"

#ifdef RF_HAVE_VIEW
#include "line/module.h"

view_run_fn *view_module(char *why)
{
    char reason[MODULE_WHY] = "it is of another version";
    void *module = module_open("../view/refocus-view.so", "refocus/refocus-view.so", reason);
    void *const symbol = module ? module_symbol(module, "rf_view_run") : NULL;
    view_run_fn *run;

    if (!symbol) {
        snprintf(why, 256, "the part with the window cannot be loaded: %.180s", reason);
        return NULL;
    }
    memcpy(&run, &symbol, sizeof run);
    return run;
}
#else
view_run_fn *view_module(char *why)
{
    snprintf(why, 256, "this build has no window; build it with SDL2");
    return NULL;
}
#endif
