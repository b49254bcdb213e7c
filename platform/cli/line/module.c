/* module.c: parts that bring many libraries with them are loaded when they are first asked for. */
#include <stdio.h>
#include <string.h>
#include "line/module.h"

#ifdef RF_MODULES
#include <dlfcn.h>
#include <unistd.h>

static void *open_beside(const char *folder, const char *path)
{
    char name[4096];

    if (snprintf(name, sizeof name, "%s%s", folder, path) >= (int)sizeof name)
        return NULL;
    return access(name, R_OK) == 0 ? dlopen(name, RTLD_NOW | RTLD_LOCAL) : NULL;
}

void *module_open(const char *built, const char *installed, char why[MODULE_WHY])
{
    char folder[2048] = "", path[512];
    const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    const char *error;
    char *slash;
    void *module = NULL;

    folder[length > 0 ? length : 0] = '\0';
    slash = strrchr(folder, '/');
    if (slash) {
        slash[1] = '\0';
        module = open_beside(folder, built);
        snprintf(path, sizeof path, "../" RF_LIBDIR "/%s", installed);
        if (!module)
            module = open_beside(folder, path);
    }
    if (!module)
        module = open_beside(RF_MODULES, installed);
    if (module)
        return module;
    error = dlerror();
    snprintf(why, MODULE_WHY, "%.180s", error ? error : "it is not installed");
    return NULL;
}

void *module_symbol(void *module, const char *name)
{
    return dlsym(module, name);
}
#else
void *module_open(const char *built, const char *installed, char why[MODULE_WHY])
{
    (void)built;
    (void)installed;
    snprintf(why, MODULE_WHY, "it is not in this build");
    return NULL;
}

void *module_symbol(void *module, const char *name)
{
    (void)module;
    (void)name;
    return NULL;
}
#endif

bool module_load(const struct module_function *wanted, void *function, char why[MODULE_WHY])
{
    char reason[MODULE_WHY] = "it is of another version";
    void *const module = module_open(wanted->built, wanted->installed, reason);
    void *const symbol = module ? module_symbol(module, wanted->name) : NULL;

    if (symbol)
        memcpy(function, &symbol, sizeof symbol);
    else
        snprintf(why, MODULE_WHY, "%s cannot be loaded: %.150s; it is built with %s", wanted->part,
                 reason, wanted->library);
    return symbol != NULL;
}
