/** @file render.h  Refocusing: create once, prepare a photo, render as often as wanted.
 *
 *     refocus_renderer_create    once: threads are started, all memory is taken
 *     refocus_prepare            once a photo or frame (refocus_prepare_scene: with all that
 *                                is known of its depth)
 *     refocus_render             once a lens setting
 *
 * One thread at a time may call into a renderer, except refocus_cancel() and
 * refocus_renderer_get_info(), which any thread may call. A second call while one runs, from
 * another thread or from a callback, is refused with REFOCUS_ERR_BUSY and changes nothing;
 * refocus_renderer_destroy() has to be the last call of all. No call takes more than 16 KiB of the
 * stack of the thread that makes it, nor of a thread of `parallel`, but for refocus/papers.h. The
 * result does not depend on the number of threads, on the processor or, but for
 * REFOCUS_DEPTH_EDGES_STEADY of scene.h and `steady` of struct refocus_highlight_params, on earlier
 * calls.
 */
#ifndef REFOCUS_RENDER_H
#define REFOCUS_RENDER_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/depth_edges.h>
#include <refocus/focus.h>
#include <refocus/image.h>
#include <refocus/methods.h>
#include <refocus/papers.h>
#include <refocus/params.h>
#include <refocus/scene.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A renderer. Opaque. */
struct refocus_renderer;

/** Where a renderer takes its memory. Both functions or none. */
struct refocus_allocator {
    /** @return @p size bytes aligned for any type, or NULL */
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory);
    void *user;
};

/**
 * Receives one line of text without a line end, from the thread that called in, for each error
 * that refocus_renderer_create(), refocus_prepare(), refocus_prepare_scene(), refocus_render() and
 * refocus_get_view() return, but for REFOCUS_ERR_CANCELLED: which argument is wrong, its value,
 * and what it may be.
 *
 *     refocus_render: focus_disparity is 1.5, may be 0 to 1
 */
struct refocus_log {
    void (*message)(void *user, const char *text);
    void *user;
};

/**
 * The caller's threads in place of the renderer's own, for programs that have a pool.
 *
 * parallel_for(user, work, context, count) calls work(context, i) once for each i = 0 ..
 * count - 1 and returns when all calls have returned. In any order, on any threads, one after
 * the other or all at once. An item is a worker, not a piece of the picture: it takes
 * pieces for as long as there are any, so the first few items may do all the work, and the
 * last ones nothing. count is at most params.threads. It is called from the thread that called
 * refocus_prepare() or refocus_render(), some dozens of times a picture, and never from
 * within itself. An item that is called twice or not at all makes the result undefined.
 */
struct refocus_parallel {
    void (*parallel_for)(void *user, void (*work)(void *context, int32_t item), void *context,
                         int32_t count);
    void *user;
};

/** Instruction sets. AUTO is the best that the processor has. */
enum refocus_cpu {
    REFOCUS_CPU_AUTO = 0,
    REFOCUS_CPU_C = 1,
    REFOCUS_CPU_NEON = 2,
    REFOCUS_CPU_SSE41 = 3,
    REFOCUS_CPU_AVX2 = 4,
    REFOCUS_CPU_AVX512 = 5, /**< 256-bit vectors with the masks of AVX-512 (BW, VL, VNNI) */
};
enum { REFOCUS_CPU_COUNT = 6 };

/** The limits of a renderer. Start from refocus_renderer_params_default(). */
struct refocus_renderer_params {
    uint32_t struct_size;  /**< sizeof(struct refocus_renderer_params) */
    int32_t max_width;     /**< largest photo, pixels, 1 to REFOCUS_MAX_SIDE */
    int32_t max_height;    /**< largest photo, pixels, 1 to REFOCUS_MAX_SIDE */
    float max_blur_radius; /**< largest K, 0 to REFOCUS_MAX_BLUR_RADIUS */
    int32_t threads;       /**< 1 to 64; 0 = one for each processor. With `parallel`: the most
                                that work at once */
    uint32_t cpu;          /**< enum refocus_cpu */
    uint64_t max_memory;   /**< bytes; creation fails above; 0 = no limit */
    struct refocus_allocator allocator; /**< all NULL: malloc and free */
    struct refocus_log log;             /**< message NULL: silent */
    uint32_t methods;  /**< methods of `papers` that need memory of their own and may be rendered:
                            REFOCUS_METHOD_BIT() of each, or-ed */
    uint32_t reserved; /**< 0 */
    struct refocus_parallel parallel;    /**< parallel_for NULL: threads of its own */
    const struct refocus_papers *papers; /**< NULL: the methods are sweep and search, or
                           refocus_papers() of papers.h: all of them. One of another build than this
                           library is refused with REFOCUS_ERR_ARGUMENT */
    uint32_t in_place;    /**< 1: strip mode, for little memory. The photo and its disparities,
                               which are of its size, are not copied: they stay as they are and
                               where they are until the next refocus_prepare() or the
                               renderer's end. Rendering goes through them twice, block by
                               block, and takes longer; the bytes are the same, but that
                               tilts and fields whose K is more than half of max_blur_radius
                               may change what a blurred foreground uncovers: rarely, by 9
                               codes of 255 at the most where that was tried. For sweep, search,
                               raytrace, jittered and blur */
    uint32_t thin;        /**< 1: with memory for struct refocus_thin_params, which other
                               renderers, and strip mode, take as not enabled, and for a matte
                               (scene.h), which they refuse */
    uint32_t depth_edges; /**< enum refocus_depth_edges of scene.h, up to which there is memory: 0,
                               the default, AUTO or STEADY. In strip mode it is memory for the
                               whole map */
    uint32_t behind;      /**< 1: with memory for `behind` of struct refocus_scene, which other
                               renderers, and strip mode, refuse */
    uint32_t textured; /**< 1: with memory for REFOCUS_INPAINT_TEXTURED, which other renderers, and
                            strip mode, take as smooth */
    uint32_t highlights; /**< 1: in strip mode, with memory for finding highlights. Without, strip
                            mode takes struct refocus_highlight_params and the star filter as
                            off. Renderers of whole photos always have it */
    uint32_t deep;      /**< 1: with memory for photos and pictures of deep formats (image.h), which
                           other renderers, and strip mode, refuse */
    uint32_t reserved2; /**< 0 */
};

static inline struct refocus_renderer_params
refocus_renderer_params_default(int32_t max_width, int32_t max_height, float max_blur_radius)
{
    struct refocus_renderer_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.max_width = max_width;
    params.max_height = max_height;
    params.max_blur_radius = max_blur_radius;
    return params;
}

/**
 * Bytes that a renderer with these parameters takes, all of them at its creation
 * (stacks of its threads not counted):
 *
 *     27 (W + 2P + 79) (H + 2P + 16) + 3 (W + 16) (H + 16) + 4 T (W + R) + 620000 T
 *     + 24 W + 12 H + 2^20
 *
 * with P = ceil(K) + 2, T threads and R = 512, of K above 127, 236 and 472 twice that each, is
 * never exceeded. On top of it comes the most that one of params->methods needs:
 *
 *     lightfield    1200 (W + 2P + 64) T + 2^12
 *     scatter       32 W H + 3 (4 P + 80) P^2 + 2^16
 *     foveated      96 (W + 16) (H + 16) + 2^18
 *     interpolated  32 (W + 16) (H + 16) + 24 (W + 64) T + 2^16
 *     diffusion     96 (W + 16) (H + 16) + 2^18
 *
 * params->thin takes up to 8 (W + 16) (H + 16) + 2^12 more, 6 bytes a pixel for large pictures.
 *
 * params->depth_edges takes up to 16 (W + 128) (H + 64) + 64 (W + H) + 2^18 more, and STEADY up to
 * 4 W H + 2^8 on top of it.
 *
 * params->behind takes up to 6 W H + 2^8 more, params->textured up to 80000 T, params->deep up to
 * 7 (W + 16) (H + 64) + 2^16.
 *
 * Strip mode, params->in_place, takes no more than
 *
 *     25 (B + 64) (B + 32) + 2.5 (B + 2P + 64)^2 + 0.78 (W + 16) (H + 64) + 4 T (W + R)
 *     + 620000 T + 24 min(P, 129)^2 + 300000
 *
 * with B = 128 + 2N the side of a block, N = max(2P + 9, P + 28), of K above 54 max(2P + 9, P +
 * 52), above 127 max(2P + 9, P + 148), rounded up to a multiple of 16: 1920x1080 with K = 40 takes
 * less than 6,000,000 bytes for one thread. With params->depth_edges, whose passes need the whole
 * map, strip mode takes up to 32 (W + 128) (H + 64) + 2^18 more, and STEADY 4 W H + 2^8 on top of
 * it. With params->highlights it takes up to 24 min(W, 512) min(H, 512) + 2^16 more.
 *
 * @return 0 if a parameter is out of its range. Thread-safe.
 */
REFOCUS_API uint64_t refocus_renderer_memory(const struct refocus_renderer_params *params);

/**
 * Take the memory and start the threads.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY, REFOCUS_ERR_SIZE
 *         (above max_memory or the address space), REFOCUS_ERR_UNSUPPORTED (the
 *         processor lacks the instruction set), REFOCUS_ERR_THREAD. On an error
 *         *renderer is NULL and nothing stays behind.
 */
REFOCUS_API int refocus_renderer_create(struct refocus_renderer **renderer,
                                        const struct refocus_renderer_params *params);

/** Stop the threads, free all, set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_renderer_destroy(struct refocus_renderer **renderer);

/**
 * Take a photo and what is known of its depth in. All is copied in the form the renderer needs; the
 * caller's memory is not used after the return, but for a photo of a deep format, which stays with
 * the renderer until the next scene or its end: what is finer than, or above, the light that the
 * renderer stores is read there. In strip mode (params.in_place) photo and
 * disparities are not copied, and stay with the renderer until the next scene or its end; a map
 * whose edges are placed is.
 *
 * @param scene  see struct refocus_scene
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (also depth_edges without memory for it),
 *         REFOCUS_ERR_SIZE, REFOCUS_ERR_UNSUPPORTED (in_place: a map of another size, or a photo of
 *         Y, U and V or a deep one; a deep photo without params.deep; a matte without params.thin
 *         or what is behind without params.behind, in strip mode or of a photo of Y, U and V),
 *         REFOCUS_ERR_CANCELLED, REFOCUS_ERR_BUSY. After any error but the last nothing is
 *         prepared.
 */
REFOCUS_API int refocus_prepare_scene(struct refocus_renderer *renderer,
                                      const struct refocus_scene *scene);

/**
 * The findings of the last refocus_prepare_scene() about the edges of its map.
 *
 * @param report  written as far as its struct_size goes; softness is 0 and parted 0 where edges
 *                stayed as given
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (nothing prepared), REFOCUS_ERR_BUSY
 */
REFOCUS_API int refocus_get_depth_edges(const struct refocus_renderer *renderer,
                                        struct refocus_depth_edges_report *report);

/** refocus_prepare_scene() of a photo and its disparities alone: refocus_scene_default(). */
REFOCUS_API int refocus_prepare(struct refocus_renderer *renderer,
                                const struct refocus_image *photo,
                                const struct refocus_disparity *disparity);

/**
 * Refocus the prepared photo.
 *
 * Ray (u, v) of pixel p meets disparity d at p + (u, v) K (df - d)
 * (Yang et al. 2016, eq. 4). Pixels of less than half a pixel of blur, with nothing
 * blurred reaching over them, come out as they went in; alpha always does (255 where
 * the photo has none).
 *
 * What the last call made is kept as long as it holds: another aperture shape or region
 * costs only the rays; other rays, highlights or sigma, what depends on them; another focus or K,
 * all but the light of the photo. A region costs what lies in it and around it. None of this
 * changes a byte.
 *
 * A photo of Y, U and V is rendered in Y, U and V by sweep or search, chroma at its own resolution
 * by the sweep, and by the search at that of luma. Averaged are the luminance L of each pixel and,
 * for each sample of chroma, the light that blue and red have more than that. With g the curve of
 * the blend, Y' the luma of the mean light of the pixels that share the sample, and B', R', G' the
 * colour by the photo's matrix:
 *
 *     E = Kr g(R') + Kg g(G') + Kb g(B') - g(Y')     L   = g(Y) + E
 *     D_b = g(B') - g(Y') - E                        D_r = g(R') - g(Y') - E
 *
 * and back in the same way from their means. A sample of chroma has the blur of that pixel of
 * its own which is the sharpest; sigma weighs by L. Highlights are told by R', G', B' as those of
 * R, G, B are, and get light of the same hue; with sigma below 1e6 they get its luminance alone, up
 * to 4 times white.
 * Samples that nothing changed keep their codes, so that one colour stays that colour, even
 * where its codes are none.
 *
 * A photo of a deep format that can hold light above white (floats, PQ, HLG, or a `white` below
 * the largest value) is taken at its word: nothing was clipped, and highlights are not looked at.
 * Light above white, up to 336 times that, is drawn over the area of the aperture as that given
 * back to highlights is; where much of the photo is brighter than white, rays meet up to 16
 * times white, those of search up to 8. Means saturate at 4 times white. Pixels that come out as
 * they went in do so in full, U and V where all pixels do that share them. P010 and P016 are read
 * as R, G and B, their chroma as that of 2 x 2 pixels. Deep photos and pictures are rendered by the
 * methods with the trait REFOCUS_METHOD_TAKES_DEEP, in linear light and without sigma; blur and
 * interpolated take light above white for white.
 *
 * @param params  see struct refocus_render_params; of a photo of Y, U and V the region begins and
 *                ends at even columns and, in 4:2:0, rows, or at the picture's end
 * @param out     of the size of the region, any stride; may not overlap itself. Any format of
 *                R, G, B of a photo of R, G, B, deep or not, with a transfer and white of its own,
 *                P010 and P016 among them, with a matrix and range of their own too and a region
 *                as of 4:2:0; else any of 4:2:0 of one of 4:2:0, and YUYV of YUYV, whose matrix
 *                and range are the photo's, whatever they say.
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (nothing prepared),
 *         REFOCUS_ERR_UNSUPPORTED (another format than these; a field that this library
 *         does not know; a deep format, of the photo or of @p out, without params.deep, with
 *         a method without REFOCUS_METHOD_TAKES_DEEP, another blend than linear, sigma below 1e6,
 *         star filter or grain; of a photo of Y, U and V another
 *         method than sweep and search, cat's eye, fringe, star filter,
 *         grain or an aperture that differs before and behind the focus),
 *         REFOCUS_ERR_CANCELLED, REFOCUS_ERR_BUSY. On REFOCUS_ERR_CANCELLED parts of @p out are
 * written, on the others none. Allocates nothing.
 */
REFOCUS_API int refocus_render(struct refocus_renderer *renderer,
                               const struct refocus_render_params *params,
                               const struct refocus_image *out);

/**
 * End the refocus_prepare(), refocus_prepare_scene() or refocus_render() that is running, if any,
 * early: it returns REFOCUS_ERR_CANCELLED as soon as each thread has done the few pixels that it is
 * at, a few milliseconds at most whatever the picture. Has no effect on later calls. With NULL it
 * does nothing. Thread-safe.
 */
REFOCUS_API void refocus_cancel(struct refocus_renderer *renderer);

/** Layers that can be looked at. */
enum refocus_view {
    REFOCUS_VIEW_DISPARITY = 0, /**< the prepared disparity, 65535 nearest */
    REFOCUS_VIEW_BLUR = 1,      /**< |s| of the last render in 1/256 pixel, 65535 for 256 pixels and
                                     more */
};

/**
 * Copy a layer out: width x height 16-bit values of the prepared photo's size.
 *
 * @param stride  bytes from a row of @p out to the next; even
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE, REFOCUS_ERR_BUSY
 */
REFOCUS_API int refocus_get_view(struct refocus_renderer *renderer, uint32_t view, uint16_t *out,
                                 ptrdiff_t stride);

/** The threads, instruction set and memory of a renderer. Start from
 * refocus_renderer_info_default(). */
struct refocus_renderer_info {
    uint32_t struct_size; /**< sizeof(struct refocus_renderer_info), set by the caller */
    int32_t threads;
    uint32_t cpu;      /**< enum refocus_cpu, never AUTO */
    uint32_t reserved; /**< 0 */
    uint64_t memory;   /**< bytes taken */
};

static inline struct refocus_renderer_info refocus_renderer_info_default(void)
{
    struct refocus_renderer_info info;

    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    return info;
}

/** Threads, instruction set and memory of a renderer, all 0 for a NULL one. With a NULL @p info, or
 *  one whose struct_size is out of its range, it does nothing. */
REFOCUS_API void refocus_renderer_get_info(const struct refocus_renderer *renderer,
                                           struct refocus_renderer_info *info);

/** "c", "neon", "sse41", "avx2", "avx512" or "auto"; NULL for an unknown one. Thread-safe. */
REFOCUS_API const char *refocus_cpu_name(uint32_t cpu);

#ifdef __cplusplus
}
#endif
#endif
