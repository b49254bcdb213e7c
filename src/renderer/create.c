#include <refocus/render.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "renderer/layout.h"
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

/* Whether the methods that are asked for are there, and do with the memory that there will be. */
static bool good_methods(const struct refocus_renderer_params *params)
{
    if ((params->methods & ~REFOCUS_METHODS_ALL) ||
        (params->papers && !rf_papers_fit(params->papers)))
        return false;
    for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++)
        if ((params->methods & REFOCUS_METHOD_BIT(i)) &&
            (!rf_method_of(params->papers, i) ||
             (params->in_place && rf_method_info(i)->whole_photo)))
            return false;
    return true;
}

/* Parameters with defaults in place of what an older caller's struct does not have. */
static bool read_params(struct refocus_renderer_params *own,
                        const struct refocus_renderer_params *params)
{
    if (!params || params->struct_size != sizeof *params)
        return false;
    *own = *params;
    return own->max_width >= 1 && own->max_width <= REFOCUS_MAX_SIDE && own->max_height >= 1 &&
           own->max_height <= REFOCUS_MAX_SIDE && own->max_blur_radius >= 0 &&
           own->max_blur_radius <= REFOCUS_MAX_BLUR_RADIUS && own->threads >= 0 &&
           own->threads <= RF_MAX_THREADS && refocus_cpu_name(own->cpu) && own->reserved == 0 &&
           own->in_place <= 1 && own->thin <= 1 && good_methods(own) &&
           !own->allocator.allocate == !own->allocator.release;
}

uint64_t refocus_renderer_memory(const struct refocus_renderer_params *params)
{
    struct refocus_renderer_params own;

    return read_params(&own, params) ? rf_layout_size(&own) : 0;
}

int refocus_renderer_create(struct refocus_renderer **renderer,
                            const struct refocus_renderer_params *params)
{
    struct refocus_renderer_params own;
    struct rf_kernels kernels;
    struct refocus_renderer *r;
    uint64_t size;
    void *block;
    int status;

    if (!renderer)
        return REFOCUS_ERR_ARGUMENT;
    *renderer = NULL;
    if (!read_params(&own, params))
        return REFOCUS_ERR_ARGUMENT;
    if (!rf_kernels_select(&kernels, &own.cpu))
        return REFOCUS_ERR_UNSUPPORTED;
    size = rf_layout_size(&own);
    if (size > PTRDIFF_MAX || (own.max_memory && size > own.max_memory))
        return REFOCUS_ERR_SIZE;
    if (!own.allocator.allocate)
        own.allocator = (struct refocus_allocator){default_allocate, default_release, NULL};
    block = own.allocator.allocate(own.allocator.user, (size_t)size);
    if (!block)
        return REFOCUS_ERR_MEMORY;
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
    r->exec.scratch_size = rf_scratch_size(own.max_width);
    atomic_init(&r->run.state, RF_RUN_IDLE);
    status = rf_pool_start(&r->pool, rf_thread_count(own.threads), &own.parallel, &r->run);
    if (status) {
        own.allocator.release(own.allocator.user, block);
        return status;
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
    if (!info)
        return;
    memset(info, 0, sizeof *info);
    if (!renderer)
        return;
    info->threads = renderer->pool.threads;
    info->cpu = renderer->cpu;
    info->memory = renderer->memory;
}
