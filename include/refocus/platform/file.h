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

/** Bounds that a reader keeps whatever a file claims: what goes beyond one is REFOCUS_ERR_SIZE
 * before memory is asked for. Zeros stand for the defaults, in which the largest pictures of phones
 * fit. Strokes have bounds of their own, see <refocus/platform/strokes.h>. Start from
 *  refocus_read_limits_default(). */
struct refocus_read_limits {
    uint32_t struct_size; /**< sizeof(struct refocus_read_limits) */
    uint32_t max_side;    /**< pixels of a side; default 32,768; not above REFOCUS_MAX_SIDE */
    uint64_t max_pixels;  /**< pixels of one picture, and of depth, confidence and original
                               together; default 201,326,592: 16384 x 12288 */
    uint64_t max_bytes;  /**< bytes of a file, and of any part once it is unpacked; default 1 GiB */
    uint64_t max_memory; /**< bytes of the file, its pictures and what decoding them takes, at any
                              one time; default half the memory of the machine */
    uint64_t max_metadata; /**< bytes of EXIF, of the ICC profile, and of an XMP packet; default
                                256 MiB */
    uint32_t max_segments; /**< segments of a JPEG; default 65,536 */
    uint32_t max_scans; /**< scans of a JPEG; default 100. Scans times pixels, too, are at most 20
                             max_pixels */
    uint32_t max_elements; /**< tags and attributes in an XMP packet; default 100,000 */
    uint32_t max_depth;    /**< elements within each other in it; default 256 */
    uint32_t raw_preview; /**< 1: of a camera raw its preview, the JPEG that the camera made for its
                               display, instead of the photo that libraw develops */
    uint32_t reserved;    /**< 0 */
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
    REFOCUS_DEPTH_SOURCE_DYNAMIC = 5,   /**< Google Dynamic Depth: a picture behind the
                                             main one, by a container directory */
    REFOCUS_DEPTH_SOURCE_TRAILER = 6,   /**< Samsung's or Huawei's own trailer behind the main
                                             picture */
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
    double focus_x, focus_y;  /**< GFocus FocalPoint, else the middle of EXIF's subject
                                   area, 0..1 of the upright picture; -1: none */
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
                              8; of a depth file those of its samples. 0: floats */
    /** Maximum blur radius K of the blur that GFocus names, of the larger picture side:
     *
     *      K = B (1/near - 1/far) zf      B = BlurAtInfinity, zf = FocalDistance
     *
     *  It needs no unit: a surface at z is blurred over B |z - zf| / z. */
    double own_blur;
    double simulated_f_number; /**< Apple's portraits: of the blur that the phone shows */
    double gain_map_stops;     /**< log2 of the largest gain of the photo's gain map, see
                                    refocus_light_create(); 0: it has none, or none that is known */
    /** A result that is editable: its lens setting, beside the all-in-focus original that is the
     *  photo; max_blur_radius 0: it is none. */
    double edited_focus_disparity, edited_max_blur_radius;
    int32_t views; /**< pictures from beside the first, as in an MPO and in a HEIC of two pictures:
                        the first of them is what refocus_photo_read_second() reads; 1 also where
                        a HEIC holds a stereo pair beside its photo */
    uint32_t reserved;       /**< 0 */
    double subject_distance; /**< EXIF SubjectDistance in metres, where the lens was focused;
                                  INFINITY; 0: not said */
};

/** A photo read from a file, upright, with the depth it carries: made by the functions below and
 *  never by a program, which is why it and its parts may grow. */
struct refocus_photo {
    struct refocus_image *image;           /**< RGB8; plane[0] NULL in a pure depth file */
    struct refocus_depth_map *depth;       /**< samples NULL when the file carries none */
    const struct refocus_photo_info *info; /**< as far as the library knows it: its struct_size */
    /** TIFF block without "Exif\0\0", made true for the upright photo: orientation 1,
     *  width and height exchanged when it lay on its side, the old thumbnail
     *  overwritten. */
    struct refocus_blob exif;
    struct refocus_blob icc; /**< ICC profile, when it is one for RGB */
    /** All that is stored of the picture, when that is more than 8 bits a channel
     *  (REFOCUS_FORMAT_RGB16, sRGB), or floats or codes of PQ or HLG (REFOCUS_FORMAT_RGB_FLOAT,
     *  linear, 1 = white, in the primaries of BT.709 where the file names others); else plane[0]
     *  is NULL. */
    struct refocus_image *deep;
    /** How sure each sample of the depth is, where the file says so, else NULL: a byte for each,
     * the rows packed; 255 = sure, 0 = a guess. As refocus_scene.confidence. */
    const uint8_t *confidence;
    /** How much of each pixel is subject, of any size: Apple's portrait matte; samples NULL: none.
     *  Its values are those of a disparity map, 0 = background, value_near = subject:
     *  refocus_depth_to_disparity() makes refocus_scene.matte of it. */
    struct refocus_depth_map *matte;
};

/**
 * Read a photo of any of refocus_file_formats(), told by its content, not its name.
 *
 * EXIF orientation is applied to photo and depth alike. Depth comes from GDepth
 * (standard or extended XMP), Dynamic Depth or another container directory with an item
 * "Depth", Apple's MPF disparity, the trailers of Samsung's Live Focus (DualShot) and of Huawei
 * (edof), or a HEIC auxiliary depth image.
 * Distances of Google's that say no unit are never taken for metres: near_m and far_m stay
 * 0, and RangeLinear becomes 16-bit disparities.
 *
 * Memory at the most, while reading: the file, of a JPEG twice, as the photo holds what
 * pictures made from it keep, and of a HEIC or AVIF with a tone map twice; 8 times the XMP in it, 9
 * bytes a pixel of the photo, 27 of one of more than 8 bits, 9 bytes a sample of the depth, 6 of a
 * gain map, and 128 KiB; and what the decoding libraries take for themselves, which is much for
 * progressive JPEG and HEIC (some 6 bytes a pixel). The limits are checked before memory is asked
 * for. XMP beyond them that says nothing of depth is passed over.
 *
 * @param photo   receives a new object, or NULL on an error; ended by
 *                refocus_photo_free()
 * @param path    of a file: a folder, pipe, socket or device is REFOCUS_ERR_IO at once. A file
 *                that begins as no known format is not read further
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
 * CIPA DC-007), of a JPEG with another one right behind it, as Leia's tablets write (LIF), or of a
 * HEIC with two pictures. refocus_photo_read_first() reads the first one. That is the left one as a
 * rule, but some files have the right one first (`order` of struct refocus_stereo_params).
 *
 * @return as refocus_photo_read(); REFOCUS_ERR_UNSUPPORTED when there is only one
 *         picture
 */
REFOCUS_API int refocus_photo_read_second(struct refocus_photo **photo, const char *path,
                                          const struct refocus_read_limits *limits,
                                          struct refocus_reason *reason);

/**
 * The first picture of a stereo file, which refocus_photo_read_second() reads the other one of. It
 * is what refocus_photo_read() reads, but for a HEIC that holds a stereo pair beside its photo, as
 * iPhones write since iOS 26: there it is the left one of the pair, smaller than the photo and
 * without the photo's depth and gain map.
 *
 * @return as refocus_photo_read()
 */
REFOCUS_API int refocus_photo_read_first(struct refocus_photo **photo, const char *path,
                                         const struct refocus_read_limits *limits,
                                         struct refocus_reason *reason);

/** Free a photo and set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_photo_free(struct refocus_photo **photo);

/** The light of a photo by its gain map. Thread-safe: its image and refocus_light_to_base() may be
 *  used by several threads at once. */
struct refocus_light;

/**
 * Make the light that a photo with a gain map stands for: its 8 bits, the base rendition, are
 * clipped at white; with the map they are not. Gain maps come with Ultra HDR (XMP of Adobe and
 * Google, or ISO 21496-1), with the HEIC of Samsung's phones and the tone maps ("tmap") of HEIC and
 * AVIF, and with Apple's photos; a damaged one is passed over, with a line of
 * evidence, when the photo is read, and so is one whose photo is the brighter rendition.
 *
 *     H = (S + base offset) 2^gain - other offset
 *
 * with S the linear light of the photo's sRGB code and the map's gain, as it is for a display that
 * shows all of it, interpolated between its samples. Colours stay in the space of the photo.
 * Takes 6 bytes a pixel, and 200 KiB; 700 KiB more while it is made.
 *
 * @param light  receives a new object, or NULL on an error; ended by refocus_light_destroy()
 * @param photo  stays as it is as long as the object is used
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (it has no gain map that is
 *         known), REFOCUS_ERR_MEMORY. Thread-safe.
 */
REFOCUS_API int refocus_light_create(struct refocus_light **light,
                                     const struct refocus_photo *photo);

/** The light, REFOCUS_FORMAT_RGB_HALF, linear, 1 = white of the photo: for refocus_prepare(). The
 *  object owns it. NULL of NULL. */
REFOCUS_API const struct refocus_image *refocus_light_image(const struct refocus_light *light);

/**
 * Bring light that was refocused into the tones of the photo: by curves from light to codes that
 * are measured in the photo, where both are known. Cells, 12 along its longer side, have curves of
 * their own, of each channel, or of the brightest where the map has one channel, and are read in
 * between in proportion (a bilateral grid: Chen, Paris, Durand 2007), as tones are chosen place by
 * place. What a pixel of the photo has beyond its curves fades as its light changes, within a
 * sixteenth, and its mean over 17 x 17 pixels within a quarter; so a part of a photo may differ
 * a little from the whole in nine pixels at its sides. Refocused light saturates at 4 times white:
 * it is shown as the mean of the photo around, of 64 blocks along the longer side, where that is
 * more, and from 3 times white on it leads there. Pixels that nothing changed, byte by byte, have
 * the photo's own codes.
 *
 * @param refocused  REFOCUS_FORMAT_RGB_HALF, linear, 1 = white: as refocus_render() makes it of
 *                   the object's image
 * @param x, y       column and row of the photo that its first pixel is
 * @param dither     of the other pixels: enum refocus_dither of <refocus/params.h>
 * @param out        REFOCUS_FORMAT_RGB8, of the same size, in other memory than `refocused`
 * @return REFOCUS_OK or REFOCUS_ERR_ARGUMENT. Thread-safe.
 */
REFOCUS_API int refocus_light_to_base(const struct refocus_light *light,
                                      const struct refocus_image *refocused, int32_t x, int32_t y,
                                      uint32_t dither, const struct refocus_image *out);

/** End an object and set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_light_destroy(struct refocus_light **light);

/**
 * Read a depth file of its own: greyscale (or grey-valued) PNG, PGM or JPEG of 8 or 16
 * bits or TIFF of the same or of floats, OpenEXR (channel Z, or the only one), PFM (both byte
 * orders), NumPy's arrays of two sides, alone (.npy) or in archives (.npz: the one called depth or
 * disparity, else the first), or any photo with depth in it. The result has no image,
 * only depth. Samples of PNG, TIFF, WebP and JPEG XL whose opacity is 0 hold no value: a map that
 * has any is of floats, the codes of the file and NaN for these.
 *
 * @param unit  how to read the samples, the words of the command line: "disparity"
 *              (bright = near), "inverse" (dark = near), "mm", "m", or a number per
 *              metre such as "5000/m"; or "disparity/16", whole numbers in 16ths of a pixel (any
 *              number of parts), of which the range is measured as that of floats is. NULL: what
 * the file says, else "disparity". In distances 0 means unknown.
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

/** Words of the command line for samples that hold no value: "zero", "max" and numbers such as
 *  "-16", several with commas; NULL = none. Adds to @p map's flags and unknown, so it comes after
 *  refocus_depth_set_unit(). @return REFOCUS_OK or REFOCUS_ERR_ARGUMENT, which changes
 *  nothing: also where there are more numbers than unknown has places */
REFOCUS_API int refocus_depth_set_invalid(struct refocus_depth_map *map, const char *codes);

struct refocus_depth_write;

/** Parts that make a refocused JPEG or HEIC editable: refocus_photo_read() of the result gives the
 * all-in-focus photo and the depth that it was made of. The original of a JPEG is that of the photo
 * that is kept, without what the result keeps itself, its coefficients as they are, and behind it
 * the photo's gain map and portrait matte; of a HEIC it becomes a JPEG of quality 95, with the gain
 * map; of others a PNG of 8 or 16 bits; what an earlier result holds stays byte for byte, unless a
 * JPEG becomes a HEIC or the other way round: its original is a JPEG of quality 95 then. In the
 * file they are GImage:Data and GDepth:Data of extended XMP, and the depth once more, in 8 bits,
 * behind the picture as Dynamic Depth; of a HEIC they are in its one packet of XMP, which this
 * library reads (libheif 1.15 writes no auxiliary depth image). Start from
 * refocus_editable_default().
 */
struct refocus_editable {
    uint32_t struct_size; /**< sizeof(struct refocus_editable) */
    int32_t own_depth;    /**< 1: the depth is the GDepth that the photo carries, which stays
                               byte for byte */
    /** Depth of the upright photo; its focus and range are those that the photo had, not those of
     *  the result. It is written as GDepth when own_depth is 0 or the file is of another kind than
     *  the photo's, and in a JPEG as Dynamic Depth, of 8 bits, for others; NULL: neither, which
     *  own_depth 1 allows where the kind stays. */
    const struct refocus_depth_write *depth;
    double focus_disparity;    /**< 0 to 1: a note of the result's lens for whoever opens it */
    double max_blur_radius;    /**< K in pixels, likewise */
    double simulated_f_number; /**< the photo's, see struct refocus_photo_info; 0 = none */
    /** A matte of the upright photo, 65535 = subject, which whoever opens the result finds as the
     *  photo's; NULL: the photo's own stays. */
    const uint16_t *matte;
    int32_t matte_width, matte_height; /**< samples; 0 without a matte */
    ptrdiff_t matte_stride;            /**< bytes from a row to the next; may be negative */
};

static inline struct refocus_editable refocus_editable_default(void)
{
    struct refocus_editable editable;

    memset(&editable, 0, sizeof editable);
    editable.struct_size = sizeof editable;
    return editable;
}

/** Parts of a file beside the pixels. Zeros: none. Start from refocus_write_options_default(). */
struct refocus_write_options {
    uint32_t struct_size;            /**< sizeof(struct refocus_write_options) */
    int32_t quality;                 /**< JPEG and HEIC, 1 to 100; 0 = 95 and 90 */
    const struct refocus_blob *exif; /**< TIFF block, whose sides become the picture's; NULL = none.
                                          PPM and PFM take neither, nor does OpenEXR; TIFF takes no
                                          maker's note */
    const struct refocus_blob *icc;  /**< NULL = none */
    int32_t unsynced;                /**< 1: does not wait until the file is on the disk,
                                          for frames of a stream */
    uint32_t reserved;               /**< 0 */
    /** Photo that a function here read and the picture was made from: the picture keeps what
     *  else its file says, byte for byte, into JPEG from JPEG XMP, IPTC, comments, unknown segments
     *  and the density; into PNG from PNG texts, density, colour chunks and all that is safe to
     *  copy; elsewhere XMP. Properties of XMP that point at what is not in the new file (depth,
     *  gain map, video), or are not true for it (thumbnail, orientation, sides), are cut out.
     *  NULL = nothing. */
    const struct refocus_photo *keep;
    /** A JPEG or HEIC only, of a photo `keep` that is not of floats; else, and without expat or
     * libpng, REFOCUS_ERR_UNSUPPORTED. NULL = original and depth are left out. */
    const struct refocus_editable *editable;
    /** A JPEG of a picture in RGB8 only, else REFOCUS_ERR_UNSUPPORTED or REFOCUS_ERR_ARGUMENT: the
     *  light that the picture shows, as refocus_light_to_base() brought it into its tones, in
     *  REFOCUS_FORMAT_RGB_HALF or _FLOAT, linear, 1 = white, of any size. A gain map is made of
     *  both, as large as the smaller one and with the headroom of the photo `keep` at the least,
     *  and lies behind the picture: an Ultra HDR photo, by ISO 21496-1 and by XMP. NULL = none. */
    const struct refocus_image *light;
    /** Asked before each row of a PNG, PPM and PFM, and where an encoder takes the whole picture
     *  (JPEG, HEIC, TIFF, OpenEXR) at least before and after it, in the thread of the call: other
     * than 0 ends it with REFOCUS_ERR_CANCELLED, as any error does. NULL = never */
    int (*cancelled)(void *user);
    void *user; /**< handed to `cancelled` */
};

static inline struct refocus_write_options refocus_write_options_default(void)
{
    struct refocus_write_options options;

    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    return options;
}

/**
 * Write a picture; the end of the name says how, see refocus_file_ending().
 * REFOCUS_FORMAT_RGB16 goes to PNG and TIFF, stored as it is, and REFOCUS_FORMAT_RGB_FLOAT to PFM,
 * and to OpenEXR as halves; other deep formats are refused, and so are these elsewhere. PFM and
 * OpenEXR take pictures of 8 bits as linear light. It is the caller's to say of light in a PNG or
 * PFM by which curve it is stored.
 *
 * The file is written beside its place under a temporary name and moved there when
 * whole and on the disk: on an error what was there before is untouched and nothing
 * partial is left, nor after a loss of power. A file that is replaced passes its owner and
 * mode on, else it is not replaced; its group as far as the process may. A symbolic link
 * stays, and the file that it points at is replaced. A folder, pipe, socket or device is
 * refused.
 * Alpha is kept in PNG and TIFF and dropped elsewhere.
 *
 * @param reason  receives words on an error and, on success, what had to be left out:
 *                EXIF of more than 65,527 bytes does not fit into a JPEG, a damaged ICC
 *                profile is not taken by PNG, the gain map of a photo that is kept does
 *                not fit another picture (give its light), its XMP may leave no room for what makes
 * the picture editable; else empty. May be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (an ending it does
 *         not know, or a HEIC where libheif has no encoder of HEVC), REFOCUS_ERR_IO,
 *         REFOCUS_ERR_MEMORY, REFOCUS_ERR_CANCELLED (by `cancelled`). Thread-safe.
 */
REFOCUS_API int refocus_image_write(const char *path, const struct refocus_image *image,
                                    const struct refocus_write_options *options,
                                    struct refocus_reason *reason);

/**
 * Write 16-bit samples as greyscale: .png, .tif or .pgm (16 bits), or .pfm with the
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
    const uint8_t *confidence; /**< for each disparity, 255 sure to 0 a guess; NULL: all are sure */
    ptrdiff_t confidence_stride; /**< bytes from a row to the next; may be negative */
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
 * Read any file whole. A folder, pipe, socket or device is refused at once.
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
 * Make a temporary file, empty, beside the place of a path: for what another program or function
 * writes, and refocus_file_move() then brings there. No file, and no link that somebody put there
 * in advance, is ever opened in its stead.
 *
 * @param path       as for refocus_image_write()
 * @param temporary  receives its name, which ends as the path does from its last dot on, and free()
 *                   ends; NULL after an error
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_IO, REFOCUS_ERR_MEMORY.
 *         Thread-safe.
 */
REFOCUS_API int refocus_file_temporary(const char *path, char **temporary,
                                       struct refocus_reason *reason);

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

/** Formats of this build, e.g. "JPEG PNG HEIC AVIF TIFF PPM PGM PFM". Thread-safe. */
REFOCUS_API const char *refocus_file_formats(void);

#ifdef __cplusplus
}
#endif
#endif
