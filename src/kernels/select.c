/* select.c: chooses the kernels of the best instruction set that the processor and the build have.
 */
#include "kernels/kernels.h"
#include "kernels/sets.h"

#include <refocus/render.h>

#if defined(__arm__)
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

/* Whether the processor has a set: has_avx2() and so on. */
#define SET(name, NAME, test)                                                                      \
    static bool has_##name(void)                                                                   \
    {                                                                                              \
        return test;                                                                               \
    }
#define NO_SET(name, NAME)
#include "kernels/sets.def"

static const struct set {
    const char *name;
    const struct rf_kernels *kernels; /* NULL: this build does not have it */
    bool (*has)(void);
} sets[REFOCUS_CPU_COUNT] = {
    [REFOCUS_CPU_AUTO] = {"auto", NULL, NULL},
#define SET(name, NAME, test) [REFOCUS_CPU_##NAME] = {#name, &rf_kernels_##name, has_##name},
#define NO_SET(name, NAME)    [REFOCUS_CPU_##NAME] = {#name, NULL, NULL},
#include "kernels/sets.def"
};

static bool has(uint32_t cpu)
{
    return cpu < REFOCUS_CPU_COUNT && sets[cpu].kernels && sets[cpu].has();
}

bool rf_kernels_select(struct rf_kernels *kernels, uint32_t *cpu)
{
    for (uint32_t best = REFOCUS_CPU_COUNT - 1; *cpu == REFOCUS_CPU_AUTO; best--)
        if (has(best))
            *cpu = best;
    if (!has(*cpu))
        return false;
    *kernels = *sets[*cpu].kernels;
    return true;
}

const char *refocus_cpu_name(uint32_t cpu)
{
    return cpu < REFOCUS_CPU_COUNT ? sets[cpu].name : NULL;
}
