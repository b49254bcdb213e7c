/* bench_kernels.c: each kernel is timed on each instruction set. */
#include <stdio.h>
#include "bench/bench_kernels.h"

static int unsupported(uint32_t cpu)
{
    return report_failure(EXIT_FAILED, "--cpu", "this processor or build has no %s; give auto",
                          refocus_cpu_name(cpu));
}

/* The instruction set that AUTO stands for here. */
static const char *cpu_name(uint32_t cpu)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(1, 1, 0);
    struct refocus_renderer_info info = refocus_renderer_info_default();
    struct refocus_renderer *renderer;

    info.cpu = cpu;
    params.threads = 1;
    params.cpu = cpu;
    if (refocus_renderer_create(&renderer, &params) == REFOCUS_OK)
        refocus_renderer_get_info(renderer, &info);
    refocus_renderer_destroy(&renderer);
    return refocus_cpu_name(info.cpu);
}

int bench_kernels(const struct engine_settings *settings)
{
    const uint32_t cpu = (uint32_t)settings->cpu;
    const char *name = cpu_name(cpu);
    json_t *rows = settings->json ? json_array() : NULL;
    struct refocus_kernel_time time = refocus_kernel_time_default();
    int status;

    for (uint32_t i = 0;; i++) {
        status = refocus_measure_kernel(i, cpu, &time);
        if (status != REFOCUS_OK)
            break;
        if (i == 0 && !rows)
            printf("%-15s %9s %9s\n", "kernel", name, "c");
        if (rows)
            json_array_append_new(rows,
                                  json_pack("{s:s, s:s, s:f, s:f}", "kernel", time.name, "unit",
                                            time.unit, "ns", time.ns, "ns_c", time.ns_c));
        else
            printf("%-15s %9.3f %9.3f ns/%s, %.1f times\n", time.name, time.ns, time.ns_c,
                   time.unit, time.ns_c / time.ns);
    }
    if (status != REFOCUS_ERR_ARGUMENT) {
        json_decref(rows);
        return status == REFOCUS_ERR_UNSUPPORTED
                   ? unsupported(cpu)
                   : report_failure(EXIT_FAILED, "--kernels", "%s", refocus_strerror(status));
    }
    return rows ? report_print_json(json_pack("{s:s, s:o}", "cpu", name, "kernels", rows))
                : report_end_output();
}
