/* opencv.c: the library of depth by OpenCV is loaded when it is first asked for. */
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include "inputs/opencv.h"
#include "line/module.h"

const char *opencv_network_name(uint32_t index)
{
    static const char *const names[] = {"tcmonodepth", "midas-small", "depth-anything-small"};

    return index < sizeof names / sizeof *names ? names[index] : NULL;
}

#ifdef RF_HAVE_OPENCV
#define FUNCTION(name)                                                                             \
    {                                                                                              \
        "refocus_cv_" #name, offsetof(struct opencv, name)                                         \
    }

static const struct {
    const char *name;
    size_t offset;
} functions[] = {
    FUNCTION(stereo),           FUNCTION(network_name),  FUNCTION(network),
    FUNCTION(network_fit),      FUNCTION(estimate),      FUNCTION(estimate_free),
    FUNCTION(estimator_create), FUNCTION(estimator_run), FUNCTION(estimator_destroy),
    FUNCTION(filter_name),      FUNCTION(upsample_by),
};

/* Fill the table; false: the library is of another version. */
static bool take(void *module, struct opencv *table)
{
    uint32_t i = 0;

    for (size_t k = 0; k < sizeof functions / sizeof *functions; k++) {
        void *const symbol = module_symbol(module, functions[k].name);

        if (!symbol)
            return false;
        memcpy((char *)table + functions[k].offset, &symbol, sizeof symbol);
    }
    while (opencv_network_name(i) && table->network_name(i) &&
           strcmp(opencv_network_name(i), table->network_name(i)) == 0)
        i++;
    return !opencv_network_name(i) && !table->network_name(i);
}

const struct opencv *opencv_load(char why[OPENCV_WHY])
{
    static struct opencv table;
    static bool loaded;
    char reason[MODULE_WHY] = "it is of another version";
    void *module;

    if (loaded)
        return &table;
    module = module_open("../opencv/librefocus-opencv.so.0", "librefocus-opencv.so.0", reason);
    loaded = module && take(module, &table);
    if (!loaded)
        snprintf(why, OPENCV_WHY, "librefocus-opencv cannot be loaded: %s", reason);
    return loaded ? &table : NULL;
}
#else
const struct opencv *opencv_load(char why[OPENCV_WHY])
{
    snprintf(why, OPENCV_WHY, "this build has no OpenCV; build it with OpenCV");
    return NULL;
}
#endif
