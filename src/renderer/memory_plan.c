/* memory_plan.c: the table of planes and the slots of memory that they share. */
#include "renderer/memory_plan.h"

static const uint8_t slot_of[RF_PLANES] = {
    [RF_PLANE_BLUR] = RF_SLOT_BLUR,
    [RF_PLANE_PREPARE_SPARE] = RF_SLOT_SMOOTH,
    [RF_PLANE_SMOOTH] = RF_SLOT_SMOOTH,
    [RF_PLANE_CELLS] = RF_SLOT_BACKGROUND_BLUR,
    [RF_PLANE_BACKGROUND_BLUR] = RF_SLOT_BACKGROUND_BLUR,
    [RF_PLANE_BACKGROUND_WEIGHT] = RF_SLOT_BACKGROUND_BLUR,
    [RF_PLANE_PREFILTER_SPARE] = RF_SLOT_BACKGROUND_LIGHT,
    [RF_PLANE_CONE] = RF_SLOT_BACKGROUND_LIGHT,
    [RF_PLANE_BACKGROUND_LIGHT] = RF_SLOT_BACKGROUND_LIGHT,
    [RF_PLANE_COVERAGE_SOURCES] = RF_SLOT_PYRAMID,
    [RF_PLANE_PYRAMID] = RF_SLOT_PYRAMID,
    [RF_PLANE_FOREGROUND] = RF_SLOT_PYRAMID,
    [RF_PLANE_WEIGHT] = RF_SLOT_PYRAMID,
    [RF_PLANE_OWN_WEIGHT] = RF_SLOT_PYRAMID,
};

void rf_plane_begin(struct rf_lifetimes *lifetimes, enum rf_plane plane)
{
    lifetimes->lives[slot_of[plane]] = (uint8_t)plane;
}

void rf_planes_end(struct rf_lifetimes *lifetimes)
{
    *lifetimes = (struct rf_lifetimes){{0}};
}

bool rf_plane_lives(const struct rf_lifetimes *lifetimes, enum rf_plane plane)
{
    return lifetimes->lives[slot_of[plane]] == plane;
}
