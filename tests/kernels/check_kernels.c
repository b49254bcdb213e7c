/* check_kernels.c: check-kernels: every kernel of every instruction set that this build and this
 * processor have, bit for bit against a reference. With --bench, the times of those that
 * src/kernels/measure.c has, beside those of plain C.
 *
 * usage: check-kernels [--bench] */
#include "check.h"

#include <refocus/measure.h>

#include <stdio.h>
#include <string.h>

/* Plain C has no operations of its own. */
int check_vec_c(void)
{
    return 0;
}

static int check_vec(uint32_t cpu)
{
    switch (cpu) {
#define SET(name, NAME, test)                                                                      \
    case REFOCUS_CPU_##NAME:                                                                       \
        return check_vec_##name();
#define NO_SET(name, NAME)
#include "kernels/sets.def"
    }
    return 0;
}

static void bench_measured(uint32_t cpu)
{
    struct refocus_kernel_time time = refocus_kernel_time_default();

    for (uint32_t i = 0; refocus_measure_kernel(i, cpu, &time) == REFOCUS_OK; i++)
        printf("ok    %-15s %-6s c %.3f  %s %.3f ns/%s\n", time.name, refocus_cpu_name(cpu),
               time.ns_c, refocus_cpu_name(cpu), time.ns, time.unit);
}

int main(int argc, char **argv)
{
    const bool bench = argc == 2 && !strcmp(argv[1], "--bench");
    int failures = 0;

    if (argc > 1 && !bench) {
        fprintf(stderr, "usage: check-kernels [--bench]\n");
        return 2;
    }
    if (!bench)
        failures += check_focus();
    for (uint32_t cpu = REFOCUS_CPU_C; refocus_cpu_name(cpu); cpu++) {
        struct subject subject = {.cpu = refocus_cpu_name(cpu)};
        uint32_t plain = REFOCUS_CPU_C, own = cpu;

        if (!rf_kernels_select(&subject.kernels, &own) ||
            !rf_kernels_select(&subject.plain, &plain))
            continue;
        if (bench && cpu != REFOCUS_CPU_C) {
            bench_measured(cpu);
        } else if (!bench) {
            failures += check_vec(cpu) + check_aim(&subject) + check_windows(&subject) +
                        check_sweep(&subject) + check_discs(&subject) + check_light(&subject) +
                        check_search(&subject) + check_series(&subject) + check_texture(&subject) +
                        check_rows(&subject) + check_surface(&subject) + check_thin(&subject) +
                        check_edges(&subject) + check_edge_planes(&subject) + check_yuv(&subject);
        }
    }
    return failures > 0;
}
