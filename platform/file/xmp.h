/* xmp.h: the XMP properties that say what is depth, and what a gain map means. */
#ifndef RF_FILE_XMP_H
#define RF_FILE_XMP_H

#include "reading.h"

/* Namespaces that are read and written. */
#define RF_NS_RDF       "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
#define RF_NS_DEPTH     "http://ns.google.com/photos/1.0/depthmap/"
#define RF_NS_IMAGE     "http://ns.google.com/photos/1.0/image/"
#define RF_NS_FOCUS     "http://ns.google.com/photos/1.0/focus/"
#define RF_NS_NOTE      "http://ns.adobe.com/xmp/note/"
#define RF_NS_GAIN_MAP  "http://ns.adobe.com/hdr-gain-map/1.0/"
#define RF_NS_CONTAINER "http://ns.google.com/photos/1.0/container/"
#define RF_NS_DYNAMIC   "http://ns.google.com/photos/dd/1.0/"
#define RF_NS_REFOCUS   "urn:librefocus:edit:1.0/"

enum rf_xmp_key {
    RF_XMP_EXTENDED, /* xmpNote:HasExtendedXMP */
    RF_XMP_DEPTH_FORMAT,
    RF_XMP_DEPTH_NEAR,
    RF_XMP_DEPTH_FAR,
    RF_XMP_DEPTH_UNITS,
    RF_XMP_DEPTH_MIME,
    RF_XMP_DEPTH_DATA,
    RF_XMP_DEPTH_CONFIDENCE,
    RF_XMP_IMAGE_MIME,
    RF_XMP_IMAGE_DATA,
    RF_XMP_FOCUS_X,
    RF_XMP_FOCUS_Y,
    RF_XMP_FOCUS_DISTANCE,
    RF_XMP_FOCUS_BLUR,
    RF_XMP_APPLE_TYPE,
    RF_XMP_APPLE_SUBTYPE,
    RF_XMP_APPLE_FLOAT_MIN,
    RF_XMP_APPLE_FLOAT_MAX,
    RF_XMP_APPLE_INT_MIN,
    RF_XMP_APPLE_INT_MAX,
    RF_XMP_APPLE_ACCURACY,
    RF_XMP_APPLE_APERTURE,
    RF_XMP_GAIN_MAP,      /* hdrgm:Version */
    RF_XMP_NOTE_ORIGINAL, /* Refocus:OriginalOrientation; see editable.c */
    RF_XMP_NOTE_DEPTH,
    RF_XMP_NOTE_FOCUS,
    RF_XMP_NOTE_BLUR,
    RF_XMP_NOTE_F_NUMBER,
    RF_XMP_NOTE_MATTE,
    /* Found in the first DepthMap and the first Image of Dynamic Depth's cameras. */
    RF_XMP_MAP_FORMAT,
    RF_XMP_MAP_NEAR,
    RF_XMP_MAP_FAR,
    RF_XMP_MAP_UNITS,
    RF_XMP_MAP_SEMANTIC,
    RF_XMP_MAP_URI,
    RF_XMP_MAP_CONFIDENCE_URI,
    RF_XMP_CAMERA_IMAGE_SEMANTIC,
    RF_XMP_CAMERA_IMAGE_URI,
    /* Kept while an item is read, and then put into the list of items below. */
    RF_XMP_ITEM_SEMANTIC,
    RF_XMP_ITEM_URI,
    RF_XMP_ITEM_LENGTH,
    RF_XMP_ITEM_PADDING,
    RF_XMP_APPLE_HEADROOM,
    /* These may be lists of a value for each channel: their items have blanks between them. */
    RF_XMP_GAIN_MIN,
    RF_XMP_GAIN_MAX,
    RF_XMP_GAIN_GAMMA,
    RF_XMP_GAIN_OFFSET_SDR,
    RF_XMP_GAIN_OFFSET_HDR,
    RF_XMP_GAIN_CAPACITY_MIN,
    RF_XMP_GAIN_CAPACITY_MAX,
    RF_XMP_GAIN_BASE_IS_HDR,
    RF_XMP_KEYS
};
/* An item of a container directory: the main picture, which is first, or one that lies behind it
 * in the file. */
enum { RF_XMP_ITEMS = 32, RF_XMP_ITEM_NAME = 64 };
struct rf_xmp_item {
    int directory; /* counted from 1: a file may have one of each of Google's two kinds */
    char semantic[RF_XMP_ITEM_NAME], uri[RF_XMP_ITEM_NAME];
    uint64_t length, padding; /* bytes, below 2^53; the padding is behind the item */
};
/* The properties above as text, NUL-terminated; NULL: not there. */
struct rf_xmp {
    char *value[RF_XMP_KEYS];
    size_t length[RF_XMP_KEYS];
    struct rf_xmp_item item[RF_XMP_ITEMS];
    int items, directories, maps, images; /* so many were met */
};
void rf_xmp_free(struct rf_xmp *xmp);
/* A property as a number; *found is false when it is absent. A property that is no number fails. */
int rf_xmp_number(const struct rf_read *read, const struct rf_xmp *xmp, enum rf_xmp_key key,
                  const char *name, bool *found, double *value);
/* f-number of the blur that an iPhone shows; 0: not said. */
double rf_xmp_simulated_f_number(const struct rf_xmp *xmp);

#endif
