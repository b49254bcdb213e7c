/* methods.c: the table of all methods, and the operations of the core's own. */
#include "renderer/methods.h"

#include <string.h>

enum {
    ANY_FOCUS = REFOCUS_METHOD_ANY_FOCUS,
    ANY_RADIUS = REFOCUS_METHOD_ANY_RADIUS,
    DEEP = REFOCUS_METHOD_TAKES_DEEP,
    DISC_ONLY = REFOCUS_METHOD_DISC_ONLY,
    HIGHLIGHTS = REFOCUS_METHOD_HIGHLIGHTS,
    RAYS = REFOCUS_METHOD_TAKES_RAYS,
    WHOLE = REFOCUS_METHOD_WHOLE_PHOTO,
    YUV = REFOCUS_METHOD_TAKES_YUV
};

static const struct {
    const char *name, *summary;
    uint32_t traits;
} info[REFOCUS_METHOD_COUNT] = {
    [REFOCUS_METHOD_SWEEP] = {"sweep", "two layers, front-most hit, swept over disparities",
                              ANY_FOCUS | ANY_RADIUS | DEEP | HIGHLIGHTS | RAYS | YUV},
    [REFOCUS_METHOD_SEARCH] = {"search", "randomized intersection search, Yang et al. 2016",
                               ANY_FOCUS | DEEP | HIGHLIGHTS | RAYS | YUV},
    [REFOCUS_METHOD_RAYTRACE] = {"raytrace", "full image-space ray tracing, Yang et al. 2016; slow",
                                 RAYS},
    [REFOCUS_METHOD_JITTERED] = {"jittered",
                                 "the same for a ray of each cell of the mask; slow, grainy", 0},
    [REFOCUS_METHOD_LIGHTFIELD] = {"lightfield",
                                   "views from all over the aperture, warped and added up",
                                   WHOLE | RAYS},
    [REFOCUS_METHOD_BLUR] = {"blur", "each pixel blurred by its own circle of confusion",
                             ANY_FOCUS | DEEP | RAYS},
    [REFOCUS_METHOD_SCATTER] = {"scatter", "each pixel spread over its circle, Potmesil 1981",
                                DISC_ONLY | WHOLE},
    [REFOCUS_METHOD_FOVEATED] = {"foveated", "exact at the centre of attention, Mulder 2000",
                                 DISC_ONLY | WHOLE},
    [REFOCUS_METHOD_INTERPOLATED] = {"interpolated", "between three pictures, NVIDIA 2004; quick",
                                     DEEP | DISC_ONLY | WHOLE},
    [REFOCUS_METHOD_DIFFUSION] = {"diffusion", "heat through a field of blur, Kosloff 2007",
                                  ANY_FOCUS | DISC_ONLY | WHOLE},
};

static const struct rf_method own[REFOCUS_METHOD_COUNT] = {
    [REFOCUS_METHOD_SWEEP] = {.tile = rf_sweep_tile, .yuv_tile = rf_sweep_yuv_tile, .layers = true},
    [REFOCUS_METHOD_SEARCH] = {.tile = rf_search_tile, .yuv_tile = rf_search_yuv_tile},
};

const char *refocus_method_name(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? info[method].name : NULL;
}

const char *refocus_method_summary(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? info[method].summary : NULL;
}

uint32_t refocus_method_traits(uint32_t method)
{
    return method < REFOCUS_METHOD_COUNT ? info[method].traits : 0;
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
