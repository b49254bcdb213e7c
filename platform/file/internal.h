/* What the files of this folder share. Nothing here is installed. */
#ifndef RF_FILE_INTERNAL_H
#define RF_FILE_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <refocus/platform/file.h>

#if defined(__GNUC__) || defined(__clang__)
#define RF_PRINTF(words, first) __attribute__((format(printf, words, first)))
#else
#define RF_PRINTF(words, first)
#endif

/* Bytes that somebody else owns. */
struct rf_bytes {
    const uint8_t *data;
    size_t size;
};

/* A decoded picture as its file stores it. Samples are in the machine's byte order. */
struct rf_raster {
    uint8_t *pixels; /* owned; top row first; NULL when there is none */
    int32_t width, height;
    int32_t channels;   /* 1 or 3 */
    uint32_t sample;    /* enum refocus_sample; F32 only with one channel */
    uint32_t max_value; /* code of white; 0 for F32 */
    bool lossy;         /* from a JPEG: equal channels may differ by a little */
};

/* The public photo and what is freed with it, whatever the caller did to the fields. */
struct rf_photo {
    struct refocus_photo shown;
    void *image, *depth, *exif, *icc;
};

/* One reading: what the container readers fill and read.c turns into a photo. */
struct rf_read {
    struct refocus_read_limits limits; /* no zeros */
    struct refocus_reason *reason;     /* never NULL */
    bool picture_always;               /* false: the main picture only when there is no depth */
    struct refocus_photo_info *info;
    struct refocus_blob exif, icc;  /* owned */
    struct rf_raster image;         /* as stored */
    struct rf_raster samples;       /* depth, as stored */
    struct refocus_depth_map depth; /* meaning, values and range of the samples */
    int orientation;                /* 1 to 8, to be applied to image and samples */
    bool second;                    /* the second picture of a stereo file is meant */
};

/* context.c: words, limits, memory ------------------------------------ */

/* Put words into the reason; returns the status, so that errors are one line. */
int rf_fail(struct refocus_reason *reason, int status, const char *format, ...) RF_PRINTF(3, 4);
int rf_fail_memory(struct refocus_reason *reason);
/* The same with the words of errno's value. */
int rf_fail_errno(struct refocus_reason *reason, int error, const char *what);
/* Add a line of evidence; what does not fit any more is dropped. */
void rf_note(struct refocus_photo_info *info, const char *format, ...) RF_PRINTF(2, 3);
/* Files may hold anything: only printable ASCII gets out, which no terminal obeys and
 * every JSON writer takes. char may be signed or not: both ends are checked. */
void rf_clean_text(char *text);
/* Bytes of one sample of enum refocus_sample. */
size_t rf_sample_bytes(uint32_t sample);
/* Bytes of one pixel of enum refocus_format; 0 for an unknown one. This library does
 * not link the core for it. */
int rf_format_bytes(uint32_t format);
/* Whether rows of so many bytes can lie so far apart, and the place of each is a
 * ptrdiff_t; rows >= 1. */
static inline bool rf_good_rows(ptrdiff_t stride, int64_t bytes, int64_t rows)
{
    const int64_t most = PTRDIFF_MAX / rows;

    return stride >= -most && stride <= most && (rows == 1 || stride >= bytes || stride <= -bytes);
}
/* Sizes are checked here and nowhere else, in 64 bits and before memory is asked for:
 * sides 1 to REFOCUS_MAX_SIDE, pixels and bytes within the limits. */
int rf_check_size(const struct rf_read *read, uint64_t width, uint64_t height,
                  uint64_t pixel_bytes);
int rf_check_bytes(const struct rf_read *read, uint64_t bytes, const char *what);
/* Memory for a raster whose fields but pixels are filled. */
int rf_raster_alloc(const struct rf_read *read, struct rf_raster *raster);
void rf_raster_free(struct rf_raster *raster);
size_t rf_raster_stride(const struct rf_raster *raster);
/* A sample of 8 or 16 bits; those of a pixel follow each other. */
uint32_t rf_raster_sample(const struct rf_raster *raster, size_t index);

/* number.c: decimal numbers without the locale ------------------------ */

/* The whole text, blanks around it allowed, as a finite number. */
bool rf_parse_number(const char *text, double *value);

/* raster.c: from stored samples to what the library works with -------- */

int rf_raster_to_rgb8(const struct rf_read *read, struct rf_raster *raster);
/* One channel from equal ones; REFOCUS_ERR_NO_DEPTH when they are not. */
int rf_raster_to_grey(const struct rf_read *read, struct rf_raster *raster);
/* orient.c: turn upright, EXIF orientation 1 to 8. */
int rf_raster_orient(const struct rf_read *read, struct rf_raster *raster, int orientation);
void rf_orient_point(double *x, double *y, int orientation);
/* The orientation that undoes one. */
int rf_orient_inverse(int orientation);

/* load.c, store.c: whole files ---------------------------------------- */

int rf_load(const char *path, uint64_t max_bytes, struct refocus_reason *reason,
            struct refocus_blob *blob);

/* A file under construction beside its place. Writes after a failure do nothing. */
struct rf_store {
    void *stream; /* FILE * */
    char *temporary, *path;
    int error;     /* errno of the first failure, or 0 */
    bool unsynced; /* renamed without waiting for the disk */
};
int rf_store_open(struct rf_store *store, const char *path, struct refocus_reason *reason);
void rf_store_write(struct rf_store *store, const void *bytes, size_t size);
/* Move into place when status is REFOCUS_OK and all was written, else remove. */
int rf_store_close(struct rf_store *store, int status, struct refocus_reason *reason);

/* Formats ------------------------------------------------------------- */

enum rf_container {
    RF_CONTAINER_UNKNOWN,
    RF_CONTAINER_JPEG,
    RF_CONTAINER_PNG,
    RF_CONTAINER_HEIC,
    RF_CONTAINER_PNM,
    RF_CONTAINER_PFM,
};
enum rf_container rf_sniff(struct rf_bytes file);
/* A PNG or JPEG inside another file, plain: no depth, no orientation. */
int rf_decode_part(const struct rf_read *read, struct rf_bytes part, const char *what,
                   struct rf_raster *raster);

int rf_read_pnm(struct rf_read *read, struct rf_bytes file);
int rf_read_pfm(struct rf_read *read, struct rf_bytes file);
int rf_read_png(struct rf_read *read, struct rf_bytes file);
int rf_read_jpeg(struct rf_read *read, struct rf_bytes file);
int rf_read_heic(struct rf_read *read, struct rf_bytes file);
int rf_png_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster,
                  struct refocus_blob *exif, struct refocus_blob *icc);
int rf_jpeg_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster);

/* Rows of one or more samples as a file wants them. */
struct rf_rows {
    const uint8_t *top;
    ptrdiff_t stride;
    int32_t width, height;
    uint32_t format; /* enum refocus_format; NONE: 16-bit grey */
};
int rf_write_ppm(struct rf_store *store, const struct rf_rows *rows, struct refocus_reason *reason);
int rf_write_pfm(struct rf_store *store, const struct rf_rows *rows, struct refocus_reason *reason);
int rf_write_png(struct rf_store *store, const struct rf_rows *rows,
                 const struct refocus_write_options *options, struct refocus_reason *reason);
int rf_write_jpeg(struct rf_store *store, const struct rf_rows *rows,
                  const struct refocus_write_options *options, struct refocus_reason *reason);

/* exif.c -------------------------------------------------------------- */

struct rf_exif {
    int orientation;                                     /* 1 to 8; 1 when there is none */
    double focal_length_mm, focal_length_35mm, f_number; /* 0: not said */
    char camera[96];
};
/* Read a TIFF block and make it true for the upright picture without a thumbnail:
 * orientation 1, sides exchanged when it lay on its side, thumbnail unlinked. */
bool rf_exif_parse(uint8_t *tiff, size_t size, struct rf_exif *exif);
/* Copy a block into read->exif and its facts into read->info and read->orientation. */
int rf_exif_take(struct rf_read *read, struct rf_bytes tiff, bool orient);
/* An ICC profile for RGB is taken over; any other would be wrong for the RGB8 photo. */
int rf_icc_take(struct rf_read *read, struct refocus_blob *profile);

/* heif_boxes.c: EXIF's number for the rotation and mirroring of an item; item 0 is the
 * main picture. 1 when the container states none. */
int rf_heif_orientation(struct rf_bytes file, uint32_t item);

/* JPEG structure ------------------------------------------------------ */

enum rf_jpeg_step { RF_JPEG_SEGMENT, RF_JPEG_END, RF_JPEG_DAMAGED };
struct rf_jpeg_walk {
    struct rf_bytes file;
    size_t position; /* at RF_JPEG_END: the byte behind the picture */
    int marker;      /* second byte, 0xE1 for APP1 */
    struct rf_bytes segment;
};
/* Begin at a file's SOI. */
bool rf_jpeg_walk_begin(struct rf_jpeg_walk *walk, struct rf_bytes file);
/* The next segment with a length; entropy-coded data is skipped. */
enum rf_jpeg_step rf_jpeg_walk_next(struct rf_jpeg_walk *walk);
/* What is behind a signature at the begin of a segment; false when it is not there. */
bool rf_jpeg_after(struct rf_bytes segment, const char *signature, size_t size,
                   struct rf_bytes *rest);
extern const char rf_jpeg_exif_signature[6];
extern const char rf_jpeg_icc_signature[12];
extern const char rf_jpeg_xmp_signature[29];
extern const char rf_jpeg_extended_signature[35];
extern const char rf_jpeg_mpf_signature[4];

/* mpf.c: images that follow the main one in a file (CIPA DC-007) */
enum { RF_MPF_MAX = 32 };
struct rf_mpf_image {
    uint64_t offset; /* from the begin of the MPF segment's TIFF header; 0: the main one */
    uint64_t size;
};
struct rf_mpf {
    int count;
    struct rf_mpf_image image[RF_MPF_MAX];
};
bool rf_mpf_parse(struct rf_bytes tiff, struct rf_mpf *mpf);

/* XMP ----------------------------------------------------------------- */

enum rf_xmp_key {
    RF_XMP_EXTENDED, /* xmpNote:HasExtendedXMP */
    RF_XMP_DEPTH_FORMAT,
    RF_XMP_DEPTH_NEAR,
    RF_XMP_DEPTH_FAR,
    RF_XMP_DEPTH_UNITS,
    RF_XMP_DEPTH_MIME,
    RF_XMP_DEPTH_DATA,
    RF_XMP_IMAGE_MIME,
    RF_XMP_IMAGE_DATA,
    RF_XMP_FOCUS_X,
    RF_XMP_FOCUS_Y,
    RF_XMP_FOCUS_DISTANCE,
    RF_XMP_FOCUS_BLUR,
    RF_XMP_APPLE_TYPE,
    RF_XMP_APPLE_FLOAT_MIN,
    RF_XMP_APPLE_FLOAT_MAX,
    RF_XMP_APPLE_INT_MIN,
    RF_XMP_APPLE_INT_MAX,
    RF_XMP_APPLE_ACCURACY,
    RF_XMP_APPLE_APERTURE,
    RF_XMP_GAIN_MAP, /* hdrgm:Version */
    RF_XMP_KEYS
};
/* The properties above as text, NUL-terminated; NULL: not there. */
struct rf_xmp {
    char *value[RF_XMP_KEYS];
    size_t length[RF_XMP_KEYS];
};
/* Add a packet's properties; the first value of each stays. On an error the struct
 * holds what was read and is freed as ever. */
int rf_xmp_parse(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp *xmp);
void rf_xmp_free(struct rf_xmp *xmp);
/* A number; false when the property is absent. A property that is no number fails. */
int rf_xmp_number(const struct rf_read *read, const struct rf_xmp *xmp, enum rf_xmp_key key,
                  const char *name, bool *found, double *value);
/* f-number of the blur that an iPhone shows; 0: not said. */
double rf_xmp_simulated_f_number(const struct rf_xmp *xmp);

/* xmp_extended.c: put the chunks of one GUID together, in whatever order they come. */
int rf_xmp_extended(struct rf_read *read, struct rf_bytes jpeg, const char *guid,
                    size_t guid_length, struct refocus_blob *packet);

/* base64.c: decode in place; (size_t)-1 when it is no base64. Blanks are skipped. */
size_t rf_base64_decode(char *text, size_t length);

/* md5.c: digest in capital hexadecimal digits and a NUL. */
void rf_md5_hex(struct rf_bytes bytes, char hex[33]);

/* depth_write.c: x:xmptk of our packets, and whether a standard packet is one. */
#define RF_XMP_TOOL "librefocus"
bool rf_xmp_is_ours(struct rf_bytes packet);

/* Depth containers: fill read->samples, read->depth, info. */
int rf_read_gdepth(struct rf_read *read, struct rf_xmp *xmp);
int rf_read_apple(struct rf_read *read, struct rf_bytes file, struct rf_bytes mpf, size_t main_end);
/* A map linear in 1/z whose codes 0 and 1 of the unit interval have these values. */
void rf_depth_from_disparity(struct refocus_depth_map *map, double value_min, double value_max,
                             double disparity_min, double disparity_max);
/* Unit words of depth_file.c for samples whose white is max_value. */
int rf_depth_unit(struct refocus_depth_map *map, const char *unit, double max_value);

#include "absent.h"

#endif
