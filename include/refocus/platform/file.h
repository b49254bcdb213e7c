/** @file platform/file.h  Photos with their depth from files, and pictures into files.
 *
 * Part of librefocus-file, not of the core: `#include <refocus/platform/file.h>`,
 * pkg-config name `refocus-file`. Formats that were left out of a build are refused
 * with REFOCUS_ERR_UNSUPPORTED; see refocus_file_formats().
 */
#ifndef REFOCUS_PLATFORM_FILE_H
#define REFOCUS_PLATFORM_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/depth.h>
#include <refocus/image.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Why something failed, in words that say what to do: one line, no full stop. The struct
 *  is complete. */
struct refocus_reason {
    char text[256];
};

/** Bytes owned by the struct that holds them; data is NULL when there are none. The
 *  struct is complete. */
struct refocus_blob {
    uint8_t *data;
    size_t size;
};

/** Bounds that a reader keeps whatever a file claims. Zeros stand for the defaults. Start from
 *  refocus_read_limits_default(). */
struct refocus_read_limits {
    uint32_t struct_size; /**< sizeof(struct refocus_read_limits) */
    uint32_t reserved;    /**< 0 */
    uint64_t max_pixels;  /**< pixels of one picture; default 268,435,456 (2^28) */
    uint64_t max_bytes; /**< bytes of a file, and of any part once it is unpacked; default 1 GiB */
};

static inline struct refocus_read_limits refocus_read_limits_default(void)
{
    struct refocus_read_limits limits;

    memset(&limits, 0, sizeof limits);
    limits.struct_size = sizeof limits;
    return limits;
}

/** Container in which depth was found. */
enum refocus_depth_source {
    REFOCUS_DEPTH_SOURCE_NONE = 0,
    REFOCUS_DEPTH_SOURCE_GDEPTH = 1,    /**< Google GDepth in XMP */
    REFOCUS_DEPTH_SOURCE_APPLE_MPF = 2, /**< Apple portrait JPEG: a disparity image by
                                             MPF */
    REFOCUS_DEPTH_SOURCE_HEIF = 3,      /**< HEIC: auxiliary depth image */
    REFOCUS_DEPTH_SOURCE_FILE = 4,      /**< a depth file of its own */
};

/** Room for the lines of struct refocus_photo_info. */
enum { REFOCUS_INFO_LINES = 24, REFOCUS_INFO_LENGTH = 160 };

/** Facts that a file states about itself. Numbers that it does not say are 0. */
struct refocus_photo_info {
    uint32_t struct_size; /**< bytes that the library wrote: later fields may be beyond them */
    int32_t stored_width; /**< width before orientation */
    int32_t stored_height;
    int32_t orientation;      /**< EXIF 1 to 8, already applied to photo and depth */
    char container[16];       /**< "JPEG", "PNG", ..., of refocus_file_formats() */
    uint32_t depth_source;    /**< enum refocus_depth_source */
    int32_t original_used;    /**< 1: the main picture was blurred; the photo is the
                                   file's own all-in-focus original (GImage) */
    double focal_length_mm;   /**< EXIF */
    double focal_length_35mm; /**< EXIF, equivalent on 36 x 24 mm */
    double f_number;          /**< EXIF, of the lens that took the photo */
    double focus_x, focus_y;  /**< GFocus FocalPoint, 0..1 of the upright picture;
                                   -1: none */
    double focus_distance;    /**< GFocus FocalDistance: metres, or the file's own
                                   unit where near_m and far_m of the depth are 0 */
    double blur_at_infinity;  /**< GFocus BlurAtInfinity, of the larger picture
                                   side */
    char camera[96];          /**< EXIF make and model, printable ASCII */
    /** Evidence, a line each, for what was found and why it is believed: containers, parts passed
     * over (gain map, portrait matte), units, polarity. Printable ASCII, never a position. */
    char evidence[REFOCUS_INFO_LINES][REFOCUS_INFO_LENGTH];
    int32_t evidence_count;
    int32_t stored_bits; /**< bits a channel of the stored picture; more than 8 are dithered to
                              8, or rounded in HEIC; of a depth file those of its samples. 0:
                              floats */
    /** Maximum blur radius K of the blur that GFocus names, of the larger picture side:
     *
     *      K = B (1/near - 1/far) zf      B = BlurAtInfinity, zf = FocalDistance
     *
     *  It needs no unit: a surface at z is blurred over B |z - zf| / z. */
    double own_blur;
    double simulated_f_number; /**< Apple's portraits: of the blur that the phone shows */
};

/** A photo read from a file, upright, with the depth it carries: made by the functions below and
 *  never by a program, which is why it and its parts may grow. */
struct refocus_photo {
    struct refocus_image *image;           /**< RGB8; plane[0] NULL in a pure depth file */
    struct refocus_depth_map *depth;       /**< samples NULL when the file carries none */
    const struct refocus_photo_info *info; /**< as far as the library knows it: its struct_size */
    /** TIFF block without "Exif\0\0", made true for the upright photo: orientation 1,
     *  width and height exchanged when it lay on its side, the old thumbnail
     *  unlinked. */
    struct refocus_blob exif;
    struct refocus_blob icc; /**< ICC profile, when it is one for RGB */
};

/**
 * Read a photo of any of refocus_file_formats(), told by its content, not its name.
 *
 * EXIF orientation is applied to photo and depth alike. Depth comes from GDepth
 * (standard or extended XMP), Apple's MPF disparity, or a HEIC auxiliary depth image.
 * Distances of GDepth that say no unit are never taken for metres: near_m and far_m stay
 * 0, and RangeLinear becomes 16-bit disparities.
 *
 * Memory at the most, while reading: the file, 8 times the XMP in it, 9 bytes a pixel
 * of the photo, 9 bytes a sample of the depth, and 128 KiB; and what the decoding
 * libraries take for themselves, which is much for progressive JPEG and HEIC (some 6
 * bytes a pixel). The limits are checked before memory is asked for.
 *
 * @param photo   receives a new object, or NULL on an error; ended by
 *                refocus_photo_free()
 * @param limits  NULL for the defaults
 * @param reason  receives words on an error; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_IO, REFOCUS_ERR_FORMAT,
 *         REFOCUS_ERR_SIZE, REFOCUS_ERR_MEMORY, REFOCUS_ERR_UNSUPPORTED. Depth that is
 *         damaged is an error, not a photo without depth. Thread-safe.
 */
REFOCUS_API int refocus_photo_read(struct refocus_photo **photo, const char *path,
                                   const struct refocus_read_limits *limits,
                                   struct refocus_reason *reason);

/** Read a photo from memory; the bytes are not used after the return. */
REFOCUS_API int refocus_photo_read_memory(struct refocus_photo **photo, const void *bytes,
                                          size_t size, const struct refocus_read_limits *limits,
                                          struct refocus_reason *reason);

/**
 * The second picture of a stereo file: of an MPO (a JPEG with the other view behind it,
 * CIPA DC-007), or of a HEIC with two pictures. refocus_photo_read() reads the first,
 * the left one.
 *
 * @return as refocus_photo_read(); REFOCUS_ERR_UNSUPPORTED when there is only one
 *         picture
 */
REFOCUS_API int refocus_photo_read_second(struct refocus_photo **photo, const char *path,
                                          const struct refocus_read_limits *limits,
                                          struct refocus_reason *reason);

/** Free a photo and set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_photo_free(struct refocus_photo **photo);

/**
 * Read a depth file of its own: greyscale (or grey-valued) PNG, PGM or JPEG of 8 or 16
 * bits, PFM (both byte orders), or any photo with depth in it. The result has no image,
 * only depth.
 *
 * @param unit  how to read the samples, the words of the command line: "disparity"
 *              (bright = near), "inverse" (dark = near), "mm", "m", or a number per
 *              metre such as "5000/m". NULL: what the file says, else "disparity". In
 *              distances 0 means unknown.
 * @param near_m, far_m  z0 and z1 in metres; 0 = what the file says, else measured
 * @return as refocus_photo_read(), and REFOCUS_ERR_ARGUMENT for a unit it does not
 *         know, REFOCUS_ERR_NO_DEPTH for a colour picture
 */
REFOCUS_API int refocus_depth_read(struct refocus_photo **depth, const char *path, const char *unit,
                                   double near_m, double far_m,
                                   const struct refocus_read_limits *limits,
                                   struct refocus_reason *reason);

/** Read a depth file from memory. */
REFOCUS_API int refocus_depth_read_memory(struct refocus_photo **depth, const void *bytes,
                                          size_t size, const char *unit, double near_m,
                                          double far_m, const struct refocus_read_limits *limits,
                                          struct refocus_reason *reason);

/** Words of the command line for how samples are read; see refocus_depth_read().
 *  Changes @p map's meaning, values and flags. @return REFOCUS_OK or
 *  REFOCUS_ERR_ARGUMENT */
REFOCUS_API int refocus_depth_set_unit(struct refocus_depth_map *map, const char *unit);

/** Parts of a file beside the pixels. Zeros: none. Start from refocus_write_options_default(). */
struct refocus_write_options {
    uint32_t struct_size;            /**< sizeof(struct refocus_write_options) */
    int32_t quality;                 /**< JPEG, 1 to 100; 0 = 95 */
    const struct refocus_blob *exif; /**< TIFF block; NULL = none. PPM takes neither */
    const struct refocus_blob *icc;  /**< NULL = none */
    int32_t unsynced;                /**< 1: does not wait until the file is on the disk,
                                          for frames of a stream */
    uint32_t reserved;               /**< 0 */
};

static inline struct refocus_write_options refocus_write_options_default(void)
{
    struct refocus_write_options options;

    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    return options;
}

/**
 * Write an 8-bit picture; the end of the name says how, see refocus_file_ending().
 *
 * The file is written beside its place under a temporary name and moved there when
 * whole and on the disk: on an error what was there before is untouched and nothing
 * partial is left, nor after a loss of power. A file that is replaced passes its owner and
 * mode on, else it is not replaced; its group as far as the process may. A symbolic link
 * stays, and the file that it points at is replaced. A folder, pipe, socket or device is
 * refused.
 * Alpha is kept in PNG and dropped elsewhere.
 *
 * @param reason  receives words on an error and, on success, what had to be left out:
 *                EXIF of more than 65,527 bytes does not fit into a JPEG, a damaged ICC
 *                profile is not taken by PNG; else empty. May be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (an ending it does
 *         not know), REFOCUS_ERR_IO, REFOCUS_ERR_MEMORY. Thread-safe.
 */
REFOCUS_API int refocus_image_write(const char *path, const struct refocus_image *image,
                                    const struct refocus_write_options *options,
                                    struct refocus_reason *reason);

/**
 * Write 16-bit samples as greyscale: .png (16 bits) or .pgm (16 bits), or .pfm with the
 * value sample / 65535 as 32-bit float. As refocus_image_write() otherwise.
 *
 * @param stride  bytes from a row to the next; even
 */
REFOCUS_API int refocus_gray16_write(const char *path, const uint16_t *samples, int width,
                                     int height, ptrdiff_t stride, struct refocus_reason *reason);

/** Depth to be saved in a photo. Start from refocus_depth_write_default(). */
struct refocus_depth_write {
    uint32_t struct_size;      /**< sizeof(struct refocus_depth_write) */
    int32_t width;             /**< samples, 1 to REFOCUS_MAX_SIDE */
    int32_t height;            /**< samples, 1 to REFOCUS_MAX_SIDE */
    uint32_t reserved;         /**< 0 */
    const uint16_t *disparity; /**< disparities of the upright photo: 65535 nearest, 0 farthest */
    ptrdiff_t stride;          /**< bytes from a row to the next; even; may be
                                    negative */
    double near_m, far_m;      /**< z0 and z1 in metres; 0 = not known */
    double focus_x, focus_y;   /**< point in focus, 0..1 of the upright photo; -1: none */
    double focus_distance;     /**< metres; 0 = not known */
    double blur_at_infinity;   /**< radius of its blur, of the larger side; 0 = not
                                    known */
};

static inline struct refocus_depth_write refocus_depth_write_default(void)
{
    struct refocus_depth_write depth;

    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    depth.focus_x = depth.focus_y = -1;
    return depth;
}

/**
 * Save a JPEG photo with depth in it, as GDepth: a standard XMP packet with the range
 * and the focus, and an extended one with the depth as a 16-bit PNG. Every segment of
 * the original stays byte for byte, also an XMP packet that is there already; what an
 * earlier call put in is replaced, so that writing the same depth again gives the same
 * file.
 *
 * @param path      as for refocus_image_write(): whole or not at all
 * @param original  a JPEG; may be @p path
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (the original is no
 *         JPEG), REFOCUS_ERR_FORMAT (it is damaged), REFOCUS_ERR_SIZE, REFOCUS_ERR_IO,
 *         REFOCUS_ERR_MEMORY. Thread-safe.
 */
REFOCUS_API int refocus_photo_write_depth(const char *path, const char *original,
                                          const struct refocus_depth_write *depth,
                                          struct refocus_reason *reason);

/**
 * Read any file whole.
 *
 * @param max_bytes  larger files are refused
 * @param blob       takes the bytes, which free() frees; empty after an error
 * @param reason     why it failed; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_IO, REFOCUS_ERR_SIZE,
 *         REFOCUS_ERR_MEMORY. Thread-safe.
 */
REFOCUS_API int refocus_file_read(const char *path, uint64_t max_bytes, struct refocus_blob *blob,
                                  struct refocus_reason *reason);

/**
 * Write any file, whole or not at all: as refocus_image_write().
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_IO, REFOCUS_ERR_MEMORY.
 *         Thread-safe.
 */
REFOCUS_API int refocus_file_write(const char *path, const void *bytes, size_t size,
                                   struct refocus_reason *reason);

/** The file that is written when a path is: where the last of its symbolic links points,
 *  there or not, else the path itself. free() ends it; NULL without memory. Thread-safe. */
REFOCUS_API char *refocus_file_place(const char *path);

/**
 * Move a finished file to its place, in the same file system, as the writers here do with
 * theirs: on the disk, with mode and owner of what it replaces. The temporary file stays
 * on an error.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_IO, REFOCUS_ERR_MEMORY.
 *         Thread-safe.
 */
REFOCUS_API int refocus_file_move(const char *temporary, const char *path,
                                  struct refocus_reason *reason);

/** The ending number @p index, from 0 on, of names under which pictures (@p depth 0) or depth maps
 *  (1) are written, such as ".png"; NULL behind the last. Thread-safe. */
REFOCUS_API const char *refocus_file_ending(int depth, int index);

/** Formats of this build, e.g. "JPEG PNG HEIC PPM PGM PFM". Thread-safe. */
REFOCUS_API const char *refocus_file_formats(void);

#ifdef __cplusplus
}
#endif
#endif
