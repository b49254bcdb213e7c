/* view_module.c: the window of `refocus view` is loaded as a module. */
#include <stdio.h>
#include <string.h>
#include "commands/view_module.h"

#ifdef RF_HAVE_VIEW
#include <dlfcn.h>
#include <unistd.h>

static void *open_beside(const char *folder, const char *path)
{
    char name[4096];

    if (snprintf(name, sizeof name, "%s%s", folder, path) >= (int)sizeof name)
        return NULL;
    return access(name, R_OK) == 0 ? dlopen(name, RTLD_NOW | RTLD_LOCAL) : NULL;
}

view_run_fn *view_module(char *why)
{
    char folder[2048] = "";
    const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    char *slash;
    void *module = NULL, *symbol = NULL;
    view_run_fn *run;

    folder[length > 0 ? length : 0] = '\0';
    slash = strrchr(folder, '/');
    if (slash) {
        slash[1] = '\0';
        module = open_beside(folder, "../view/refocus-view.so"); /* as it is built */
        if (!module)
            module = open_beside(folder, "../" RF_LIBDIR "/refocus/refocus-view.so");
    }
    if (!module)
        module = open_beside(RF_MODULES, "refocus/refocus-view.so");
    if (module)
        symbol = dlsym(module, "rf_view_run");
    if (!symbol) {
        const char *const error = dlerror();

        snprintf(why, 256, "the part with the window cannot be loaded: %.180s",
                 error ? error : "it is not installed");
        return NULL;
    }
    memcpy(&run, &symbol, sizeof run); /* ISO C has no conversion between the two */
    return run;
}
#else
view_run_fn *view_module(char *why)
{
    snprintf(why, 256, "this build has no window; build it with SDL2");
    return NULL;
}
#endif
