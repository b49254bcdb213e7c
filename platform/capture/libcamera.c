/* The libcamera backend is a module of its own, loaded when it is first asked for: its
 * libraries start up with C++ objects that end the program when memory is short, and nobody
 * who only opens files should pay for them. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include "backend.h"
#include "libcamera.h"

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const struct rf_source_ops *loaded;

static void try(const char *folder, int length, const char *name)
{
    char path[4096];
    void *module;

    if (loaded || snprintf(path, sizeof path, "%.*s%s", length, folder, name) >=
                      (int)sizeof path)
        return;
    module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (module)
        loaded = dlsym(module, "rf_source_libcamera");
}

/* Beside this library: where both are installed, and where both are built. */
static void load(void)
{
    Dl_info self;

    if (dladdr((void *)&once, &self) && self.dli_fname) {
        const char *slash = strrchr(self.dli_fname, '/');
        const int length = slash ? (int)(slash + 1 - self.dli_fname) : 0;

        try(self.dli_fname, length, "refocus/refocus-libcamera.so");
        try(self.dli_fname, length, "../libcamera/refocus-libcamera.so");
    }
    try(RF_LIBCAMERA_FOLDER, (int)strlen(RF_LIBCAMERA_FOLDER), "/refocus-libcamera.so");
}

const struct rf_source_ops *rf_libcamera(void)
{
    pthread_once(&once, load);
    return loaded;
}
