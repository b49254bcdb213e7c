/* live_stack.c: depth of a still scene from a focus stack that the camera takes itself: at the
 * beginning, and whenever somebody asks.
 *
 * The thread that captures moves the lens, so that frames of a lens on its way are never rendered.
 * Output stands still meanwhile. The lens then stays where the middle frame was taken, whose
 * geometry the depth has.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "commands/depth_stack.h"
#include "line/report.h"
#include "live/live_look.h"
#include "live/live_stack.h"

static const char prefix[] = "stack:";

struct live_stack {
    struct shots shots;
    atomic_bool wanted;
    bool taken; /* there is depth */
};

/* ----- settings ----- */

bool live_stack_is_meant(const char *depth)
{
    return strncmp(depth, prefix, strlen(prefix)) == 0;
}

/* A part "NAME=VALUE" of the text at *at, up to a comma; false where it is another one. */
static bool part(const char **at, const char *name, double least, double most, double *value)
{
    const size_t length = strlen(name);
    char *end;
    double v;

    if (strncmp(*at, name, length) != 0 || (*at)[length] != '=')
        return false;
    v = strtod(*at + length + 1, &end);
    if (end == *at + length + 1 || (*end && *end != ',') || !(v >= least && v <= most))
        return false;
    *value = v;
    *at = *end ? end + 1 : end;
    return true;
}

int live_stack_parse(struct live_settings *settings)
{
    struct shots_settings *stack = &settings->stack;
    const char *at = settings->depth.file + strlen(prefix);

    *stack = (struct shots_settings){.camera = settings->camera,
                                     .option = "--depth",
                                     .steps = 9,
                                     .range = {NAN, NAN},
                                     .average = 1,
                                     .settle = 300,
                                     .size = {NAN, NAN}};
    while (*at)
        if (!part(&at, "steps", REFOCUS_STACK_LEAST_FRAMES, REFOCUS_STACK_MOST_FRAMES,
                  &stack->steps) &&
            !part(&at, "far", -1e9, 1e9, &stack->range[0]) &&
            !part(&at, "near", -1e9, 1e9, &stack->range[1]) &&
            !part(&at, "average", 1, 64, &stack->average) &&
            !part(&at, "settle", 0, 10000, &stack->settle))
            return report_failure(EXIT_WRONG, "--depth",
                                  "'%.40s' is no part of it; give stack: with steps=2 to 32, far=P "
                                  "and near=P of the lens, average=1 to 64, settle=MS, and commas",
                                  at);
    if (isnan(stack->range[0]) != isnan(stack->range[1]))
        return report_failure(EXIT_WRONG, "--depth", "far and near go together; give both");
    stack->steps = floor(stack->steps);
    stack->average = floor(stack->average);
    return settings->depth.unit
               ? report_failure(EXIT_WRONG, "--depth-unit",
                                "it is not for depth of a focus stack; leave it out")
               : EXIT_DONE;
}

int live_stack_open(struct live *live)
{
    const struct depth_settings *depth = &live->settings->depth;
    int status;

    live->stack = calloc(1, sizeof *live->stack);
    if (!live->stack)
        return report_failure(EXIT_FAILED, "live", "not enough memory");
    status = shots_plan(&live->stack->shots, &live->settings->stack, live->camera);
    if (status == EXIT_DONE && live_look_needs_metres(live->settings) &&
        !live->stack->shots.lens.dioptres && !(depth->near_m > 0 && depth->far_m > depth->near_m))
        status = report_failure(EXIT_FAILED, live->settings->depth.file, "%s", live_look_no_metres);
    live->stack->shots.ends_quietly = true;
    atomic_store(&live->stack->wanted, true);
    return status;
}

void live_stack_close(struct live *live)
{
    free(live->stack);
}

bool live_stack_ask(struct live *live, char *why, size_t size)
{
    if (live->stack)
        atomic_store(&live->stack->wanted, true);
    else
        snprintf(why, size, "depth is not of a focus stack; begin with --depth stack:");
    return live->stack != NULL;
}

/* ----- depth ----- */

struct taking {
    struct refocus_stack *stack;
    int width, height;
};

/* The stack is made when the size of its pictures is known. */
static int add(void *user, const struct shots *shots, int k, const struct refocus_image *image)
{
    struct taking *taking = user;
    struct refocus_stack_params params =
        refocus_stack_params_default(image->width, image->height, shots->count);
    int status = REFOCUS_OK;

    taking->width = image->width;
    taking->height = image->height;
    params.reference = shots->count / 2 + 1;
    if (!taking->stack)
        status = refocus_stack_create(&taking->stack, &params);
    if (status == REFOCUS_OK)
        status = refocus_stack_add(taking->stack, image, shots->reported[k]);
    return status == REFOCUS_OK
               ? EXIT_DONE
               : report_failure(EXIT_FAILED, shots->settings->camera,
                                "its frames make no focus stack: %s", refocus_strerror(status));
}

/* Disparities stand for the range of the lens, unless the command line says for what. */
static struct live_range range_of(const struct live *live)
{
    const struct shots *shots = &live->stack->shots;
    const struct depth_settings *depth = &live->settings->depth;
    struct live_range range = {0, 0};

    if (shots->lens.dioptres)
        range = (struct live_range){shots->reported[shots->count - 1], shots->reported[0]};
    if (depth->near_m > 0)
        range.near = 1 / depth->near_m;
    if (depth->far_m > 0)
        range.far = 1 / depth->far_m;
    return range.near > range.far ? range : (struct live_range){0, 0};
}

static int finish(struct live *live, const struct taking *taking)
{
    struct refocus_stack_result result = refocus_stack_result_default();
    struct live_depth_map *map = live_depths_fill(&live->depths, taking->width, taking->height);
    int status;

    if (!map)
        return live_is_over(live) ? EXIT_FAILED
                                  : report_failure(EXIT_FAILED, "live", "not enough memory");
    result.disparity = map->disparity;
    result.disparity_stride = 2 * (ptrdiff_t)taking->width;
    if (refocus_stack_finish(taking->stack, &result) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, live->settings->camera, "the stack cannot be finished");
    status = stack_judge(&result, live->settings->camera);
    if (status != EXIT_DONE)
        return status;
    map->range = range_of(live);
    live_depths_put(&live->depths, map, 0, true);
    live->stacks++;
    return EXIT_DONE;
}

int live_stack_take(struct live_lane *lane)
{
    struct live *live = lane->live;
    struct live_stack *stack = live->stack;
    struct taking taking = {0};
    const int64_t begin = live_now_ns();
    int status;

    if (!atomic_exchange(&stack->wanted, false))
        return EXIT_DONE;
    status = shots_photograph(&stack->shots, add, &taking);
    if (status == EXIT_DONE)
        status = finish(live, &taking);
    refocus_stack_destroy(&taking.stack);
    if (status == EXIT_DONE)
        status = shots_rest(&stack->shots, stack->shots.count / 2);
    lane->sure.known = lane->seen.known = false; /* frames have passed */
    lane->quiet_since_ns = live_now_ns();
    live_times_add(&live->depth.times, (double)(live_now_ns() - begin) / 1e6);
    if (status == EXIT_DONE)
        stack->taken = true;
    else if (!stack->taken && !live_is_over(live))
        live_fail(live, status, "", "");
    return stack->taken ? EXIT_DONE : status;
}
