/* renderer.h: the renderer: the prepared photo, its planes, and which results are valid. It is one
 * block of memory, laid out by layout.c. */
#ifndef RF_RENDERER_H
#define RF_RENDERER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "aperture/cat_eye.h"
#include "aperture/cat_shape.h"
#include "aperture/ray_set.h"
#include "background/behind.h"
#include "background/mark.h"
#include "background/pyramid.h"
#include "background/texture.h"
#include "colour/transfer.h"
#include "edges/edges.h"
#include "focus/focus.h"
#include "gather/frame.h"
#include "gather/work_memory.h"
#include "highlights/highlights.h"
#include "highlights/steady.h"
#include "image/chroma.h"
#include "image/planes.h"
#include "look/look.h"
#include "image/viewport.h"
#include "kernels/kernels.h"
#include "passes/prefilter.h"
#include "renderer/memory_plan.h"
#include "support/executor.h"
#include "support/log.h"
#include "support/settings.h"
#include "thin/thin.h"
#include "tiles/bins.h"
#include "tiles/ranges.h"

enum {
    RF_GROUP = 4, /* planes that lie together */
};

/* The photo as it was prepared. */
struct rf_photo {
    int width, height;              /* pixels; 0: none prepared */
    int pad;                        /* pixels beyond each side that may be read */
    ptrdiff_t stride;               /* elements from row to row, of all padded planes */
    ptrdiff_t pitch;                /* elements between the planes of a group; see layout.c */
    uint16_t *group;                /* four planes: R, G, B, disparity */
    uint16_t *light[3], *disparity; /* pixel (0, 0); not in strip mode */
    uint8_t *alpha;                 /* unpadded, width a row */
    uint8_t *band_blend;            /* enum refocus_blend that the light of a band of rows is in */
    struct rf_silhouettes silhouettes;
    struct rf_highlights highlights;
    uint32_t highlights_blend; /* blend that they were found in, or RF_NO_BLEND */
    float highlights_estimate; /* times the estimate that they have lost; 0: for a fixed gain */
    float highlights_steady;   /* part of small changes since the last photo that was left out */
    struct rf_thin_list thin;
    struct rf_behind behind; /* width 0: the scene has none */
};

/* The pass cache: which results of the last lens setting the planes still hold (pass_cache.c). */
struct rf_pass_cache {
    bool blur;             /* circles of confusion, and bins */
    bool silhouettes;      /* silhouettes of clipped things are patched in them */
    bool gathered;         /* highlights are marked in them for the rays */
    bool splatted;         /* highlights are marked to be splatted */
    bool ranges;           /* ranges of the tiles; until then their cells live */
    bool smooth;           /* the pre-filtered light */
    enum rf_bright bright; /* how far boosted highlights may exceed white */
    bool boosted;          /* highlights in the pre-filtered light are boosted */
    bool background;       /* the hidden background */
    bool textured;         /* texture is continued in it */
    bool weighted;         /* weights of `sigma` lie in place of its blur */
    float sigma;
    float own_sigma; /* weights of the photo's own light are of it and of own_blend; -1: none are */
    uint32_t own_blend;
    int rays;              /* number of rays that highlights were marked for */
    struct rf_rect window; /* part of the photo that all of it is limited to */
    struct rf_rect exact;  /* part where the background is that of the whole photo */
    struct rf_focus_plan plan;
    int shift;      /* scale of the bins */
    uint32_t thin;  /* how thin structures were separated: thin_key() */
    int splat_blur; /* Q7.8: from which blur on they were splatted */
    uint32_t blend;
    float gain;
    int prefilter_above[RF_PREFILTER_STEPS];
};

/*
 * Strip mode: the photo stays with the caller, and planes hold a window of it at a time, that
 * of a block with a margin. What is known of the background is marked for the whole photo, a
 * bit a pixel, and the background's pyramid is kept from level RF_KEPT on.
 */
enum { RF_KEPT = 3 };

struct rf_in_place {
    bool on;
    struct refocus_image photo;   /* the caller's */
    struct refocus_disparity map; /* the caller's, or `placed` */
    uint16_t *placed;  /* a map whose edges went to the photo's; NULL: no memory for one */
    int code_step;     /* rf_code_step() of the map */
    int block, margin; /* pixels of a block that is rendered, and around it */
    int mark_block, mark_margin; /* a block whose background is marked */
    struct rf_rect beyond;       /* part of the margin in use that lies beyond the photo */
    struct rf_known known;
    struct rf_pyramid kept; /* levels from RF_KEPT on */
};

struct refocus_renderer {
    struct refocus_allocator allocator;
    struct refocus_log log;
    struct rf_settings settings; /* the last render; its plan has its maps */
    void *block;
    uint64_t memory;
    uint32_t cpu;              /* enum refocus_cpu, never AUTO */
    struct rf_kernels kernels; /* the functions of that set */
    int max_width, max_height;
    float max_blur_radius;

    atomic_flag entered; /* a call runs: rf_enter() */
    struct rf_pool pool;
    struct rf_run run;
    struct rf_executor exec; /* all three, as passes get them */

    /* The prepared photo, and memory for the planes that depend on a lens setting. */
    bool prepared;
    struct rf_photo photo;
    uint16_t *smooth_group, *background_group; /* blur and smooth light; hidden background */
    struct rf_pass_cache cache;
    struct rf_lifetimes lifetimes;
    struct rf_in_place in_place;
    struct rf_focus_plan last_plan; /* the plan of the last render */
    bool last_silhouettes;          /* silhouettes were patched in it */
    bool blurred;                   /* there was a last render */

    /*
     * The window, and its planes as if it were all there is: set by rf_use(). The background and
     * what is computed from it share memory: memory_plan.h.
     */
    struct rf_viewport view;
    ptrdiff_t pitch; /* elements between the planes of a group; see layout.c */
    uint32_t blend;  /* blend of the planes of light */
    struct rf_light_q12 light;
    struct rf_light_q12 smooth; /* light, pre-filtered where rays lie far apart */
    struct rf_blur_q8 blur;
    struct rf_disparity_q16 disparity;
    struct rf_alpha_u8 alpha;
    struct rf_background background;
    struct rf_yuv *yuv;             /* the photo's coding */
    struct rf_deep deep;            /* the photo, if it is a deep one */
    struct rf_deep deep_out;        /* the picture that is written, if it is one */
    struct rf_chroma_planes chroma; /* planes of the window, if yuv.on */
    struct rf_dilated_blur cone;    /* while the background is marked */
    struct rf_pyramid pyramid;
    struct rf_weight_q15 weight, background_weight; /* once the background is inpainted */
    struct rf_weight_q15 own_weight;                /* weights of what the search looks at */
    struct rf_cells cells;                          /* until the background is marked */
    struct rf_foreground_cells foreground; /* from the inpainted background up to weights */
    struct rf_range_plane range;
    struct rf_bins *bins;   /* one for each tile */
    struct rf_bins *blocks; /* blocks of tiles; NULL: no blur has a unit */
    int unit;               /* unit of the blurs of the last render */

    void *prepare_memory;    /* for upsampling and for edges; ends with the first render */
    void *highlights_memory; /* for finding them, in planes of a lens setting, or NULL */
    uint32_t most_edges;     /* enum refocus_depth_edges that there is enough of it for */
    struct refocus_depth_edges_report edges; /* about the prepared photo */
    struct rf_last_edges last_edges;         /* for the next frame, if they are placed steadily */
    struct rf_last_light last_light;         /* for the next frame, with highlights_memory */

    struct rf_transfer *transfer; /* RF_BLEND_COUNT of them */
    uint16_t *light_weight;       /* eq. 5: weight of Q12 light max(R, G, B), Q15 */
    float weight_sigma;           /* sigma of light_weight, in weight_blend */
    uint32_t weight_blend;

    struct rf_texture_scratch *texture; /* NULL: there is no memory for texture */
    bool has_behind;                    /* there is memory for a second layer */
    bool has_thin;                      /* there is memory for thin structures */
    struct rf_coverage coverage;
    struct rf_stars stars;  /* for this lens setting */
    struct rf_grain *grain; /* for this lens setting */
    uint32_t renders;       /* counts renders with maps of their own */

    struct rf_work_memory work;
    const struct refocus_papers *papers; /* may be NULL */
    uint32_t methods;                    /* REFOCUS_METHOD_BIT of each that `work` suffices for */

    struct rf_ray_sets ray_sets;
    struct rf_cat_eye *cat_eye;     /* made when it is first needed */
    struct rf_cat_shape *cat_shape; /* for the last aperture that needed one */

    struct rf_frame *frame; /* the call that renders */
    struct rf_exact *exact; /* tables of its method */
};

/* Make a part of the photo the window, and give a frame the views of its planes. */
void rf_use(struct refocus_renderer *r, struct rf_rect window);
void rf_set_planes(struct rf_frame *f);

/* Gives a frame its views before the rays: in debug builds none of a plane that does not live. */
void rf_set_gather_planes(struct rf_frame *f);

/* The whole photo, in the blend in use, and its size. */
struct rf_photo_source rf_photo_source(const struct refocus_renderer *r);
static inline struct rf_rect rf_whole(const struct refocus_renderer *r)
{
    return (struct rf_rect){0, 0, r->photo.width, r->photo.height};
}

/* Elements of a worker's scratch: two rows of the largest picture with the margins of spread_row.
 */
static inline uint64_t rf_scratch_size(int max_width, float max_blur_radius)
{
    const int margin = rf_spread_margin(rf_unit_of(max_blur_radius));

    return 2 * ((uint64_t)max_width + 2 * (uint64_t)margin);
}

/* Begins a call: REFOCUS_OK, REFOCUS_ERR_ARGUMENT where r is NULL, or REFOCUS_ERR_BUSY where
 * another one runs, in another thread or in a callback of which this one is made. What goes wrong
 * in the call is told to the renderer's log; log is NULL in a call that tells nothing. */
static inline int rf_enter(struct refocus_renderer *r, struct rf_log *log)
{
    if (!r)
        return REFOCUS_ERR_ARGUMENT;
    if (log)
        log->to = r->log;
    if (!atomic_flag_test_and_set_explicit(&r->entered, memory_order_acquire))
        return REFOCUS_OK;
    return log ? rf_refuse(log, REFOCUS_ERR_BUSY, "another call uses this renderer")
               : REFOCUS_ERR_BUSY;
}

/* Ends it with a status. */
static inline int rf_leave(struct refocus_renderer *r, int status)
{
    atomic_flag_clear_explicit(&r->entered, memory_order_release);
    return status;
}

static inline void rf_run_begin(struct refocus_renderer *r)
{
    atomic_store(&r->run.state, RF_RUN_RUNNING);
}

/* Whether the run that ends here was cancelled. */
static inline bool rf_run_end(struct refocus_renderer *r)
{
    return atomic_exchange(&r->run.state, RF_RUN_IDLE) == RF_RUN_CANCELLED;
}

/* The renderer that a frame belongs to. */
static inline struct refocus_renderer *rf_renderer_of(const struct rf_frame *f)
{
    return f->owner;
}

#endif
