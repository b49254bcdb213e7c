/** @file depth.h  From the numbers in a depth map to disparities. */
#ifndef REFOCUS_DEPTH_H
#define REFOCUS_DEPTH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Type of the samples of a depth map, in the machine's byte order. */
enum refocus_sample {
    REFOCUS_SAMPLE_U8 = 1,
    REFOCUS_SAMPLE_U16 = 2,
    REFOCUS_SAMPLE_F32 = 3,
};

/** The quantity that the samples are proportional to. */
enum refocus_depth_meaning {
    REFOCUS_DEPTH_DISPARITY = 1, /**< linear in 1/z: value_far is d = 0, value_near is d
                                      = 1 */
    REFOCUS_DEPTH_DISTANCE = 2,  /**< linear in z: z = metres_at_zero + v *
                                      metres_per_unit */
};

enum refocus_depth_flags {
    REFOCUS_DEPTH_ZERO_IS_UNKNOWN = 1, /**< a sample of 0 holds no value */
    REFOCUS_DEPTH_MAX_IS_UNKNOWN = 2,  /**< nor does the greatest code, 255 or 65535 */
    REFOCUS_DEPTH_2047_IS_UNKNOWN = 4, /**< nor does 2047, as in raw Kinect frames */
};

/** Most values of refocus_depth_map.unknown. */
enum { REFOCUS_DEPTH_MOST_UNKNOWN = 4 };

/**
 * A depth map as a sensor or a file gives it. The caller owns the samples. Start from
 * refocus_depth_map_default().
 * NaN and infinite samples never hold a value; nor does a distance <= 0, nor 65535 of distances of
 * 16 bits where less than a hundredth of the map has it: sensors mark so where they found nothing.
 * For video refocus_depth_follow_flags() tells that steadily.
 */
struct refocus_depth_map {
    uint32_t struct_size; /**< sizeof(struct refocus_depth_map) */
    uint32_t sample;      /**< enum refocus_sample */
    const void *samples;  /**< top row; NULL when there is no map */
    ptrdiff_t stride;     /**< bytes from a row to the next one below; may be negative */
    int32_t width;        /**< samples, 1 to REFOCUS_MAX_SIDE */
    int32_t height;       /**< samples, 1 to REFOCUS_MAX_SIDE */
    uint32_t meaning;     /**< enum refocus_depth_meaning */
    uint32_t flags;       /**< enum refocus_depth_flags, or-ed */

    /** For disparity: the samples that mean d = 1 and d = 0. Near below far is a map
     *  whose dark is near. Both equal: measure the least and the greatest sample,
     *  greatest = nearest. */
    double value_near, value_far;

    /** For distance. */
    double metres_per_unit, metres_at_zero;

    /** z0 and z1 in metres; 0 = not known. For distance, unknown ones are measured:
     *  the nearest and the farthest sample that holds a value. Strays do not count for the nearest
     *  one, as disparity is 1/z and so the nearest sample decides the range: fewer than a
     *  thousandth of the samples each of which would leave less than half of the range to the
     *  rest, and no nine of which lie in a square. A sample of 3 mm would leave 1/200 of it to
     *  what is 0.4 to 1.2 m away. */
    double near_m, far_m;

    /** Samples of these values hold none, beside those of flags: -16 of OpenCV's matchers, say. The
     *  first unknown_count of them count, 0 to REFOCUS_DEPTH_MOST_UNKNOWN. Of floats, give what a
     *  float is exactly. */
    double unknown[REFOCUS_DEPTH_MOST_UNKNOWN];
    int32_t unknown_count;
    int32_t reserved; /**< 0 */
};

/** A map of 8-bit disparities without samples yet; the samples follow. */
static inline struct refocus_depth_map refocus_depth_map_default(void)
{
    struct refocus_depth_map map;

    memset(&map, 0, sizeof map);
    map.struct_size = sizeof map;
    map.sample = REFOCUS_SAMPLE_U8;
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    return map;
}

/** Whether flags or unknown of the map say that a sample of this value holds none: 1 or 0. */
static inline int refocus_depth_is_code(const struct refocus_depth_map *map, double value)
{
    if ((value == 0 && (map->flags & REFOCUS_DEPTH_ZERO_IS_UNKNOWN)) ||
        (value == 2047 && (map->flags & REFOCUS_DEPTH_2047_IS_UNKNOWN)) ||
        ((map->flags & REFOCUS_DEPTH_MAX_IS_UNKNOWN) &&
         ((value == 255 && map->sample == REFOCUS_SAMPLE_U8) ||
          (value == 65535 && map->sample == REFOCUS_SAMPLE_U16))))
        return 1;
    for (int i = 0; i < map->unknown_count && i < REFOCUS_DEPTH_MOST_UNKNOWN; i++)
        if (value == map->unknown[i])
            return 1;
    return 0;
}

/** The findings of refocus_depth_to_disparity(), which are written as far as struct_size goes.
 *  Start from refocus_depth_report_default(). */
struct refocus_depth_report {
    uint32_t struct_size; /**< sizeof(struct refocus_depth_report), set by the caller */
    uint32_t reserved;    /**< 0 */
    double near_m;        /**< z0 of the result; 0 when not known */
    double far_m;         /**< z1 of the result; 0 when not known; may be INFINITY */
    double value_near;    /**< for disparity: the sample that became d = 1 */
    double value_far;     /**< for disparity: the sample that became d = 0 */
    uint64_t unknown;     /**< samples that held no value and were filled */
    uint64_t clamped;     /**< samples beyond z0 or z1 (or the values of d = 1 and 0) */
    uint64_t specks;      /**< samples in patches too small to be true; filled too */
    uint64_t strays; /**< samples far nearer than all others, see near_m of the map; filled too */
};

static inline struct refocus_depth_report refocus_depth_report_default(void)
{
    struct refocus_depth_report report;

    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    return report;
}

/**
 * Turn a depth map into 16-bit disparities, 65535 nearest, rounded to nearest:
 *
 *     d = (1/z - 1/z1) / (1/z0 - 1/z1)           for distances
 *     d = (v - value_far) / (value_near - value_far)   for disparities
 *
 * Samples without a value, and strays, are filled from the nearest samples that have one, from
 * the farther side where two surfaces meet. At the border of the map surfaces go on to it, but for
 * what is near and no wider than the unmeasured strip there, as a pole: what is behind that does.
 * In a sparse map, most of whose samples with a value have less than half of their neighbours, the
 * nearest sample counts alone, up to two mean distances of samples.
 * A map of one single depth becomes all 0.
 *
 * @param map        see struct refocus_depth_map
 * @param disparity  receives width x height values; may not overlap the samples
 * @param stride     bytes from a row of @p disparity to the next; even
 * @param report     filled on success, as far as its struct_size goes; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_NO_DEPTH (no sample holds a
 *         value), REFOCUS_ERR_MEMORY (a byte a sample is needed when there are unknown
 *         samples or strays, and 458,752 for whole numbers from 65,536 samples on). On an error
 *         @p disparity holds nothing of use.
 *
 * Thread-safe.
 */
REFOCUS_API int refocus_depth_to_disparity(const struct refocus_depth_map *map, uint16_t *disparity,
                                           ptrdiff_t stride, struct refocus_depth_report *report);

/** Largest patch that can be taken for a speck, in samples. */
enum { REFOCUS_MAX_SPECKLE = 255 };

/** The steps of refocus_depth_repair(). Start from refocus_repair_params_default(). */
struct refocus_repair_params {
    uint32_t struct_size;        /**< sizeof(struct refocus_repair_params) */
    int32_t speckle;             /**< patches of fewer samples are filled like holes, 0 to
                                      REFOCUS_MAX_SPECKLE; 0 and 1 = none. A patch is what
                                      touches, across corners too, in steps of 1/24 of the
                                      range */
    uint8_t *confidence;         /**< receives a byte a sample: 255 = as measured, 0 = filled;
                                      may be NULL. For refocus_upsample() */
    ptrdiff_t confidence_stride; /**< bytes from a row to the next; may be negative */
    void *memory;                /**< to work in, aligned for any type, of the caller: then nothing
                                      is allocated, which suits depth frame after frame; NULL =
                                      what is needed is allocated and freed */
    size_t memory_bytes;         /**< how large that is: refocus_repair_memory() or more, and with
                                      a photo 6 a sample more */
    const struct refocus_image *photo; /**< the photo of that view, packed, of 8 bits and any size;
                                            or NULL. A hole where two surfaces meet is filled from
                                            the one that looks like it; without a photo, or where
                                            both do, from the farther one */
};

static inline struct refocus_repair_params refocus_repair_params_default(void)
{
    struct refocus_repair_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}

/**
 * Bytes of memory that refocus_depth_repair() works in at the most: 458,752 and 1 a sample, 5 with
 * @p speckle above 1. 0 where a side is not 1 to REFOCUS_MAX_SIDE, or @p speckle out of its range.
 * Thread-safe.
 */
REFOCUS_API uint64_t refocus_repair_memory(int32_t width, int32_t height, int32_t speckle);

/**
 * refocus_depth_to_disparity() that also removes specks, fills holes by the photo and says what was
 * filled. Time and memory are linear in the number of samples: refocus_repair_memory() at most, and
 * with a photo 6 bytes a sample more.
 *
 * @return as refocus_depth_to_disparity(); REFOCUS_ERR_ARGUMENT also when params->memory is less
 *         than that or not aligned, or params->photo is not packed, REFOCUS_ERR_UNSUPPORTED when
 *         that has more than 8 bits. Thread-safe.
 */
REFOCUS_API int refocus_depth_repair(const struct refocus_depth_map *map,
                                     const struct refocus_repair_params *params,
                                     uint16_t *disparity, ptrdiff_t stride,
                                     struct refocus_depth_report *report);

/**
 * Tell whether 65535 is a hole in the next map of a video. Where about a hundredth of the maps has
 * it, it would be one in this map and 65.5 m in the next; so it stays a hole until a tenth of a map
 * has it, and a distance until less than a hundredth has.
 *
 * @param map    see struct refocus_depth_map
 * @param flags  0 for the first map, and what this function left there after it; becomes
 *               REFOCUS_DEPTH_MAX_IS_UNKNOWN or 0, to be or-ed into map->flags. Always 0 for other
 *               samples than distances of 16 bits
 * @return REFOCUS_OK or REFOCUS_ERR_ARGUMENT, which leaves @p flags as they are. Thread-safe.
 */
REFOCUS_API int refocus_depth_follow_flags(const struct refocus_depth_map *map, uint32_t *flags);

/** How to upsample. Start from refocus_upsample_params_default(). */
struct refocus_upsample_params {
    uint32_t struct_size;        /**< sizeof(struct refocus_upsample_params) */
    int32_t threads;             /**< 1 to 64; 0 = one for each processor */
    uint32_t cpu;                /**< enum refocus_cpu of render.h; 0 = the best there
                                      is */
    uint32_t reserved;           /**< 0 */
    const uint8_t *confidence;   /**< a byte for each sample of the map, 255 = sure, 0 = a
                                      guess that counts where there is nothing else; NULL
                                      = all sure */
    ptrdiff_t confidence_stride; /**< bytes from a row to the next; may be negative */
};

static inline struct refocus_upsample_params refocus_upsample_params_default(void)
{
    struct refocus_upsample_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}

/**
 * Bring a map of disparities to the size of the photo that it belongs to, with its
 * edges on the photo's: refocus_prepare() does the same with maps of another size.
 *
 * Joint bilateral upsampling (Kopf et al. 2007) averages the samples around a pixel by
 * nearness and likeness, and so makes up disparities between surfaces. Here the samples
 * are parted into surfaces first; the pixel goes to the one with the most of nearness
 * times mean likeness, and takes the plane through its samples. The result does not
 * depend on threads or processor. A map of the photo's size is copied, one with more
 * columns or rows is sampled.
 *
 * @param photo   any packed format of 8 bits a channel
 * @param map     covers the same view as the photo; see struct refocus_disparity
 * @param params  see struct refocus_upsample_params
 * @param out     receives 16-bit disparities of the photo's size, 65535 nearest; may
 *                not overlap the map
 * @param stride  bytes from a row of @p out to the next; even; may be negative
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY (up to 8 bytes a sample,
 *         330 W (H / rows + 1) for W x H pixels and rows of samples, and 40000 a thread are
 *         needed), REFOCUS_ERR_SIZE, REFOCUS_ERR_UNSUPPORTED, REFOCUS_ERR_THREAD.
 *         On an error @p out is untouched.
 *
 * Thread-safe.
 */
REFOCUS_API int refocus_upsample(const struct refocus_image *photo,
                                 const struct refocus_disparity *map,
                                 const struct refocus_upsample_params *params, uint16_t *out,
                                 ptrdiff_t stride);

#ifdef __cplusplus
}
#endif
#endif
