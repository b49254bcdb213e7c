#include "kernels/kernels.h"

#include <refocus/render.h>

#if defined(__arm__)
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

static bool has(uint32_t cpu)
{
    switch (cpu) {
    case REFOCUS_CPU_C:
        return true;
#if defined(RF_WITH_NEON) && defined(__aarch64__)
    case REFOCUS_CPU_NEON:
        return true;
#elif defined(RF_WITH_NEON)
    case REFOCUS_CPU_NEON:
        return (getauxval(AT_HWCAP) & HWCAP_NEON) != 0;
#endif
#if defined(RF_WITH_SSE41)
    case REFOCUS_CPU_SSE41:
        return __builtin_cpu_supports("sse4.1");
#endif
#if defined(RF_WITH_AVX2)
    case REFOCUS_CPU_AVX2:
        return __builtin_cpu_supports("avx2");
#endif
#if defined(RF_WITH_AVX512)
    case REFOCUS_CPU_AVX512:
        return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512vnni");
#endif
    }
    return false;
}

bool rf_kernels_select(struct rf_kernels *kernels, uint32_t *cpu)
{
    static const uint32_t best_first[] = {REFOCUS_CPU_AVX512, REFOCUS_CPU_AVX2, REFOCUS_CPU_SSE41,
                                          REFOCUS_CPU_NEON, REFOCUS_CPU_C};

    for (int i = 0; *cpu == REFOCUS_CPU_AUTO; i++)
        if (has(best_first[i]))
            *cpu = best_first[i];
    if (!has(*cpu))
        return false;
    kernels->draw_disc = rf_draw_disc_c;
    kernels->meets = rf_meets_c;
    kernels->hide = rf_hide_c;
    kernels->search = rf_search_c;
    kernels->sweep = rf_sweep_c;
    kernels->sweep1 = rf_sweep1_c;
    kernels->sweep1_weighted = rf_sweep1_weighted_c;
    kernels->weigh = rf_weigh_c;
    kernels->weigh1 = rf_weigh1_c;
    kernels->weigh_chroma = rf_weigh_chroma_c;
    kernels->smooth1 = rf_smooth1_c;
    kernels->smooth3 = rf_smooth3_c;
    kernels->push = rf_push_c;
    kernels->pull = rf_pull_c;
    kernels->pull_blur = rf_pull_blur_c;
    rf_aim_use_c(kernels);
    rf_windows_use_c(kernels);
    kernels->sweep_weighted = rf_sweep_weighted_c;
    rf_rows_use_c(kernels);
    rf_yuv_use_c(kernels);
    rf_discs_use_c(kernels);
    rf_light_use_c(kernels);
    rf_upsample_use_c(kernels);
    rf_choose_use_c(kernels);
    rf_part_use_c(kernels);
    rf_dequantise_use_c(kernels);
    rf_series_use_c(kernels);
    rf_surfaces_use_c(kernels);
    rf_thin_use_c(kernels);
#if defined(RF_WITH_NEON)
    if (*cpu == REFOCUS_CPU_NEON)
        rf_kernels_use_neon(kernels);
#endif
#if defined(RF_WITH_SSE41)
    if (*cpu == REFOCUS_CPU_SSE41)
        rf_kernels_use_sse41(kernels);
#endif
#if defined(RF_WITH_AVX2)
    if (*cpu == REFOCUS_CPU_AVX2)
        rf_kernels_use_avx2(kernels);
#endif
#if defined(RF_WITH_AVX512)
    if (*cpu == REFOCUS_CPU_AVX512)
        rf_kernels_use_avx512(kernels);
#endif
    return true;
}
