/* modules.c: parts that bring many libraries with them are loaded when they are first asked for.
 * Those libraries start up with C++ objects that end the program when memory is short, or open
 * devices, and nobody who only opens files should pay for them. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include "modules.h"

#if defined RF_HAVE_LIBCAMERA || defined RF_HAVE_PIPEWIRE || defined RF_HAVE_WINDOW
static const int here;

/* The address of a symbol in the module of that file, or NULL. */
static const void *try(const char *folder, int length, const char *name, const char *symbol)
{
    char path[4096];
    void *module;

    if (snprintf(path, sizeof path, "%.*s%s.so", length, folder, name) >= (int)sizeof path)
        return NULL;
    module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    return module ? dlsym(module, symbol) : NULL;
}

/* The module lies beside this library, where both are installed and where both are built. */
static const void *load(const char *installed, const char *built, const char *symbol)
{
    const void *found = NULL;
    Dl_info self;

    if (dladdr((const void *)&here, &self) && self.dli_fname) {
        const char *slash = strrchr(self.dli_fname, '/');
        const int length = slash ? (int)(slash + 1 - self.dli_fname) : 0;

        found = try(self.dli_fname, length, installed, symbol);
        if (!found)
            found = try(self.dli_fname, length, built, symbol);
    }
    return found ? found : try(RF_MODULES, (int)strlen(RF_MODULES), installed, symbol);
}
#endif

#ifdef RF_HAVE_LIBCAMERA
static pthread_once_t libcamera_once = PTHREAD_ONCE_INIT;
static const struct rf_source_ops *libcamera;

static void load_libcamera(void)
{
    libcamera =
        load("refocus/refocus-libcamera", "../libcamera/refocus-libcamera", "rf_source_libcamera");
}

const struct rf_source_ops *rf_libcamera(void)
{
    pthread_once(&libcamera_once, load_libcamera);
    return libcamera;
}
#else
const struct rf_source_ops *rf_libcamera(void)
{
    return NULL;
}
#endif

#ifdef RF_HAVE_PIPEWIRE
static pthread_once_t pipewire_once = PTHREAD_ONCE_INIT;
static const struct rf_source_ops *pipewire_source;
static const struct rf_sink_ops *pipewire_sink;

static void load_pipewire(void)
{
    static const char installed[] = "refocus/refocus-pipewire";
    static const char built[] = "../pipewire/refocus-pipewire";

    pipewire_source = load(installed, built, "rf_source_pipewire");
    pipewire_sink = load(installed, built, "rf_sink_pipewire");
}

const struct rf_source_ops *rf_pipewire_source(void)
{
    pthread_once(&pipewire_once, load_pipewire);
    return pipewire_source;
}

const struct rf_sink_ops *rf_pipewire_sink(void)
{
    pthread_once(&pipewire_once, load_pipewire);
    return pipewire_sink;
}
#else
const struct rf_source_ops *rf_pipewire_source(void)
{
    return NULL;
}

const struct rf_sink_ops *rf_pipewire_sink(void)
{
    return NULL;
}
#endif

#ifdef RF_HAVE_WINDOW
static pthread_once_t window_once = PTHREAD_ONCE_INIT;
static const struct rf_sink_ops *window;

static void load_window(void)
{
    window = load("refocus/refocus-window", "../sdl/refocus-window", "rf_sink_window");
}

const struct rf_sink_ops *rf_window(void)
{
    pthread_once(&window_once, load_window);
    return window;
}
#else
const struct rf_sink_ops *rf_window(void)
{
    return NULL;
}
#endif
