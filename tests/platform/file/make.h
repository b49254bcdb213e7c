/* make.h: small files for tests and fuzz seeds, put together byte by byte and without the
 * library under test. */
#ifndef RF_TEST_MAKE_H
#define RF_TEST_MAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes that grow; free with bytes_free(). A failing malloc ends the program. */
struct bytes {
    uint8_t *data;
    size_t size;
};

void bytes_add(struct bytes *bytes, const void *data, size_t size);
void bytes_text(struct bytes *bytes, const char *text);
void bytes_number(struct bytes *bytes, uint64_t value, int size, bool big_endian);
void bytes_join(struct bytes *bytes, struct bytes tail); /* frees the tail */
void bytes_free(struct bytes *bytes);
struct bytes bytes_copy(const void *data, size_t size);

/* A picture whose every sample differs from its neighbours: channel c of (x, y). */
unsigned pattern(int x, int y, int c, unsigned max);

/* PNG, not compressed. Types: 0 grey, 2 RGB, 3 palette of 256 greys, two transparent, 4
 * grey + alpha, 6 RGBA. samples: rows as PNG stores them. exif, icc: put in when not
 * NULL. */
struct bytes make_png_raw(int width, int height, int type, int bits, const uint8_t *samples,
                          const struct bytes *exif);
/* Make it with the pattern. */
struct bytes make_png(int width, int height, int type, int bits);
void png_chunk(struct bytes *png, const char *type, const void *data, size_t size);

/* JPEG with four coloured quarters: red, green / blue, white; or grey quarters
 * 32, 96 / 160, 224. Sides in multiples of 16 keep the quarters exact but for rounding.
 */
struct bytes make_jpeg(int width, int height, bool grey, bool progressive);
/* A segment right behind SOI. */
void jpeg_insert(struct bytes *jpeg, int marker, const char *signature, size_t signature_size,
                 const void *data, size_t size);
void jpeg_insert_exif(struct bytes *jpeg, struct bytes exif); /* frees it */
void jpeg_insert_xmp(struct bytes *jpeg, const char *xmp);

/* TIFF block: orientation, Make "Maker", Model "Model X", 50.5 mm, 75 mm, f/1.8, pixel
 * sides 640 and 480, a thumbnail directory. */
struct bytes make_exif(bool big_endian, int orientation);

/* The boxes of a HEIF file with one item, 1, whose properties are ispe and then the
 * given ones: "irot" with an angle, "imir" with an axis. Nothing to decode. */
struct heif_property {
    const char *type;
    int value;
};
struct bytes make_heif_boxes(const struct heif_property *properties, int count, bool large);

struct bytes base64(const void *data, size_t size); /* NUL-terminated */

/* XMP packets. Attributes are written as given: GDepth:Format="RangeInverse" ... */
struct bytes make_xmp(const char *attributes);
/* Add the extended packet in chunks of a size, in the order of the permutation
 * i -> i * step mod count. skip: index of a chunk to leave out; -1: none. */
void jpeg_insert_extended(struct bytes *jpeg, const char *guid, struct bytes packet, size_t chunk,
                          int step, int skip);
extern const char test_guid[33];

/* A phone's photo: main JPEG, GDepth in the standard packet. NULL stands for absent. */
struct gdepth {
    const char *format;    /* RangeInverse or RangeLinear */
    const char *extra;     /* more attributes */
    struct bytes depth;    /* PNG or JPEG; freed */
    struct bytes original; /* GImage; freed; empty: none */
};
struct bytes make_gdepth(struct gdepth gdepth, int orientation);
/* Make it with depth and original in an extended packet. */
struct bytes make_gdepth_extended(struct gdepth gdepth, size_t chunk, int step, int skip);

/* A phone's photo of 48 x 32 with Dynamic Depth, or with the directory of Ultra HDR, which names
 * items by what they are. */
struct dynamic {
    bool plain;        /* the directory of Ultra HDR */
    const char *map;   /* attributes of Camera:DepthMap; NULL: no Device */
    size_t padding;    /* bytes behind the main picture and behind each item */
    size_t between;    /* bytes of something else behind the main picture */
    struct bytes gain; /* freed, as the others; empty: none */
    struct bytes depth, confidence, original;
};
struct bytes make_dynamic(struct dynamic dynamic, int orientation);
/* The packet of such a file alone. */
struct bytes make_dynamic_xmp(const struct dynamic *dynamic);

/* A JPEG with others behind it, as MPF lists them. Parts are freed. */
struct bytes make_mpf(struct bytes main_jpeg, struct bytes *parts, int count, bool big_endian);
/* The XMP of a gain map: its properties as elements, <hdrgm:Gamma>1</hdrgm:Gamma>... */
struct bytes make_gain_xmp(const char *elements);
/* ISO 21496-1: base and other headroom, then least, greatest, gamma and two offsets of each
 * channel, in thousandths. */
struct bytes make_gain_iso(int channels, const int32_t *values);
/* Here all values share one denominator. */
struct bytes make_gain_iso_common(int channels, const int32_t *values);
/* A grey JPEG whose XMP says what it is. */
struct bytes make_auxiliary(const char *type, const char *extra);

/* A JPEG of 64 x 32 with a map of 6 x 4 in the trailer of Samsung or Huawei, which says these
 * sides, Samsung's at that place; with an original of 60 x 30, and behind it a block of another
 * kind. */
struct bytes make_samsung(int mark_at, int width, int height, bool original, bool other_block);
struct bytes make_huawei(int width, int height, bool original);

#endif
