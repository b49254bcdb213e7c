/* methods.c: the table of all methods, and the operations of the core's own. */
#include "renderer/methods.h"

#include <string.h>

static const struct rf_method_info info[REFOCUS_METHOD_COUNT] = {
    [REFOCUS_METHOD_SWEEP] = {"sweep", "two layers, front-most hit, swept over disparities",
                              .any_focus = true},
    [REFOCUS_METHOD_SEARCH] = {"search", "randomized intersection search, Yang et al. 2016",
                               .any_focus = true},
    [REFOCUS_METHOD_RAYTRACE] = {"raytrace", "full image-space ray tracing, Yang et al. 2016; slow",
                                 .any_focus = false},
    [REFOCUS_METHOD_JITTERED] = {"jittered",
                                 "the same for a ray of each cell of the mask; slow, grainy",
                                 .any_focus = false},
    [REFOCUS_METHOD_LIGHTFIELD] = {"lightfield",
                                   "views from all over the aperture, warped and added up",
                                   .whole_photo = true},
    [REFOCUS_METHOD_BLUR] = {"blur", "each pixel blurred by its own circle of confusion",
                             .any_focus = true},
    [REFOCUS_METHOD_SCATTER] = {"scatter", "each pixel spread over its circle, Potmesil 1981",
                                .disc_only = true, .whole_photo = true},
    [REFOCUS_METHOD_FOVEATED] = {"foveated", "exact at the centre of attention, Mulder 2000",
                                 .disc_only = true, .whole_photo = true},
    [REFOCUS_METHOD_INTERPOLATED] = {"interpolated", "between three pictures, NVIDIA 2004; quick",
                                     .disc_only = true, .whole_photo = true},
    [REFOCUS_METHOD_DIFFUSION] = {"diffusion", "heat through a field of blur, Kosloff 2007",
                                  .any_focus = true, .disc_only = true, .whole_photo = true},
};

static const struct rf_method own[REFOCUS_METHOD_COUNT] = {
    [REFOCUS_METHOD_SWEEP] = {.tile = rf_sweep_tile, .layers = true},
    [REFOCUS_METHOD_SEARCH] = {.tile = rf_search_tile},
};

const char *refocus_method_name(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? info[method].name : NULL;
}

const char *refocus_method_summary(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? info[method].summary : NULL;
}

const struct rf_method_info *rf_method_info(uint32_t method)
{
    return &info[method];
}

const struct rf_method *rf_method_of(const struct refocus_papers *papers, uint32_t method)
{
    if (own[method].tile)
        return &own[method];
    return papers ? papers->method[method] : NULL;
}

uint32_t rf_methods_of(const struct refocus_papers *papers, uint32_t asked)
{
    uint32_t methods = 0;

    for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++) {
        const struct rf_method *method = rf_method_of(papers, i);

        if (method && (!method->work_bytes || (asked & REFOCUS_METHOD_BIT(i))))
            methods |= REFOCUS_METHOD_BIT(i);
    }
    return methods;
}

bool rf_papers_fit(const struct refocus_papers *papers)
{
    return papers->frame_size == sizeof(struct rf_frame) &&
           !strcmp(papers->version, REFOCUS_VERSION_STRING);
}
