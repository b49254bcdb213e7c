/* create.c: creates, describes and ends renderers. */
#include <refocus/render.h>

#include <stdlib.h>
#include <string.h>

#include "renderer/layout.h"
#include "support/log.h"
#include "support/rules.h"
#include "renderer/methods.h"

static void *default_allocate(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void default_release(void *user, void *memory)
{
    (void)user;
    free(memory);
}

#define RULE(type, field, least, most)                                                             \
    RF_RULE(#field, offsetof(struct refocus_renderer_params, field), type, least, most)

static const struct rf_rule rules[] = {
    RULE(RF_SIGNED, max_width, 1, REFOCUS_MAX_SIDE),
    RULE(RF_SIGNED, max_height, 1, REFOCUS_MAX_SIDE),
    RULE(RF_REAL, max_blur_radius, 0, REFOCUS_MAX_BLUR_RADIUS),
    RULE(RF_SIGNED, threads, 0, RF_MAX_THREADS),
    RULE(RF_UNSIGNED, cpu, 0, REFOCUS_CPU_COUNT - 1),
    RULE(RF_UNSIGNED, methods, 0, REFOCUS_METHODS_ALL),
    RULE(RF_UNSIGNED, reserved, 0, 0),
    RULE(RF_UNSIGNED, in_place, 0, 1),
    RULE(RF_UNSIGNED, thin, 0, 1),
    RULE(RF_UNSIGNED, depth_edges, 0, REFOCUS_DEPTH_EDGES_STEADY),
    RULE(RF_UNSIGNED, behind, 0, 1),
    RULE(RF_UNSIGNED, textured, 0, 1),
    RULE(RF_UNSIGNED, highlights, 0, 1),
    RULE(RF_UNSIGNED, deep, 0, 1),
    RULE(RF_UNSIGNED, reserved2, 0, 0),
};

/* The log that a caller's parameters name, as far as they reach: for words on what is wrong with
 * them. */
static struct rf_log log_of(const char *function, const struct refocus_renderer_params *params)
{
    struct rf_log log = {.function = function};

    if (params && params->struct_size >= REFOCUS_SIZE_TO(struct refocus_renderer_params, log) &&
        params->struct_size <= REFOCUS_MAX_STRUCT_SIZE)
        log.to = params->log;
    return log;
}

/* The methods that are asked for have to be there, and to do with the memory that there will be. */
static int check_methods(const struct rf_log *log, const struct refocus_renderer_params *params)
{
    if (params->papers && !rf_papers_fit(params->papers))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "papers is of another build than librefocus " REFOCUS_VERSION_STRING);
    for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++) {
        if (!(params->methods & REFOCUS_METHOD_BIT(i)))
            continue;
        if (!rf_method_of(params->papers, i))
            return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "methods has %s, which needs papers",
                             refocus_method_name(i));
        if (params->in_place && (refocus_method_traits(i) & REFOCUS_METHOD_WHOLE_PHOTO))
            return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                             "in_place is 1, may be 0 with method %s, which needs the whole photo",
                             refocus_method_name(i));
    }
    return REFOCUS_OK;
}

/* Parameters with defaults in place of what an older caller's struct does not have. */
static int read_params(const struct rf_log *log, struct refocus_renderer_params *own,
                       const struct refocus_renderer_params *params)
{
    int status = rf_read_struct(log, "params", own, sizeof *own,
                                REFOCUS_SIZE_TO(struct refocus_renderer_params, thin), params);

    for (size_t i = 0; !status && i < sizeof rules / sizeof *rules; i++)
        status = rf_check_rule(log, &rules[i], own);
    if (status)
        return status;
    if ((status = check_methods(log, own)))
        return status;
    if (!own->allocator.allocate != !own->allocator.release)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "allocator has one function of two, may have both or none");
    return REFOCUS_OK;
}

uint64_t refocus_renderer_memory(const struct refocus_renderer_params *params)
{
    struct refocus_renderer_params own;

    return read_params(NULL, &own, params) ? 0 : rf_layout_size(&own);
}

int refocus_renderer_create(struct refocus_renderer **renderer,
                            const struct refocus_renderer_params *params)
{
    const struct rf_log log = log_of("refocus_renderer_create", params);
    struct refocus_renderer_params own;
    struct rf_kernels kernels;
    struct refocus_renderer *r;
    uint64_t size;
    void *block;
    int status;

    if (!renderer)
        return rf_refuse(&log, REFOCUS_ERR_ARGUMENT, "renderer is NULL");
    *renderer = NULL;
    if ((status = read_params(&log, &own, params)))
        return status;
    if (!rf_kernels_select(&kernels, &own.cpu))
        return rf_refuse(&log, REFOCUS_ERR_UNSUPPORTED,
                         "cpu is %s, which this build or processor does not have",
                         refocus_cpu_name(own.cpu));
    size = rf_layout_size(&own);
    if (size > PTRDIFF_MAX || (own.max_memory && size > own.max_memory))
        return rf_refuse(&log, REFOCUS_ERR_SIZE, "%llu bytes are needed, may be up to %llu",
                         (unsigned long long)size,
                         own.max_memory ? (unsigned long long)own.max_memory
                                        : (unsigned long long)PTRDIFF_MAX);
    if (!own.allocator.allocate)
        own.allocator = (struct refocus_allocator){default_allocate, default_release, NULL};
    block = own.allocator.allocate(own.allocator.user, (size_t)size);
    if (!block)
        return rf_refuse(&log, REFOCUS_ERR_MEMORY, "the allocator has no %llu bytes",
                         (unsigned long long)size);
    r = rf_layout_place(&own, block);
    r->allocator = own.allocator;
    r->log = own.log;
    r->block = block;
    r->memory = size;
    r->cpu = own.cpu;
    r->kernels = kernels;
    r->max_width = own.max_width;
    r->max_height = own.max_height;
    r->max_blur_radius = own.max_blur_radius;
    r->papers = own.papers;
    r->methods = rf_methods_of(own.papers, own.methods);
    r->work.owner = RF_NO_METHOD;
    r->in_place.on = own.in_place;
    for (int blend = 0; blend < RF_BLEND_COUNT; blend++)
        rf_transfer_init(&r->transfer[blend], blend);
    r->exec.pool = &r->pool;
    r->exec.run = &r->run;
    r->exec.kernels = &r->kernels;
    r->exec.scratch_size = rf_scratch_size(own.max_width, own.max_blur_radius);
    atomic_init(&r->run.state, RF_RUN_IDLE);
    atomic_flag_clear(&r->entered);
    status = rf_pool_start(&r->pool, rf_thread_count(own.threads), &own.parallel, &r->run);
    if (status) {
        own.allocator.release(own.allocator.user, block);
        return rf_refuse(&log, status, "a thread could not be started");
    }
    *renderer = r;
    return REFOCUS_OK;
}

void refocus_renderer_destroy(struct refocus_renderer **renderer)
{
    struct refocus_renderer *r;

    if (!renderer || !*renderer)
        return;
    r = *renderer;
    *renderer = NULL;
    rf_pool_end(&r->pool);
    r->allocator.release(r->allocator.user, r->block);
}

void refocus_cancel(struct refocus_renderer *renderer)
{
    int running = RF_RUN_RUNNING;

    if (renderer)
        atomic_compare_exchange_strong(&renderer->run.state, &running, RF_RUN_CANCELLED);
}

void refocus_renderer_get_info(const struct refocus_renderer *renderer,
                               struct refocus_renderer_info *info)
{
    struct refocus_renderer_info own = refocus_renderer_info_default();

    if (renderer) {
        own.threads = renderer->pool.threads;
        own.cpu = renderer->cpu;
        own.memory = renderer->memory;
    }
    refocus_struct_write(info, REFOCUS_SIZE_TO(struct refocus_renderer_info, memory), &own,
                         sizeof own);
}
