/* xmp_edit.h: properties are cut out of an XMP packet and others are put in; all its other bytes
 * stay. */
#ifndef RF_FILE_XMP_EDIT_H
#define RF_FILE_XMP_EDIT_H

#include "bytes.h"
#include "reading.h"
#include "text.h"
#include "xmp.h"

/* Properties that are cut, to be or-ed. */
enum {
    RF_XMP_CUT_STALE = 1,     /* pictures, videos and depth in other places of the file, or its old
                                 look: Container, Dynamic Depth, thumbnails */
    RF_XMP_CUT_DEPTH = 2,     /* GDepth */
    RF_XMP_CUT_ORIGINAL = 4,  /* GImage */
    RF_XMP_CUT_BLUR = 8,      /* GFocus:FocalDistance and GFocus:BlurAtInfinity */
    RF_XMP_CUT_POINT = 16,    /* the rest of GFocus */
    RF_XMP_CUT_NOTE = 32,     /* the note that this library leaves */
    RF_XMP_CUT_EXTENDED = 64, /* xmpNote:HasExtendedXMP */
    RF_XMP_CUT_ORIENTATION = 128, /* tiff:Orientation */
    RF_XMP_CUT_SIZE = 256,        /* pixels of the sides in tiff and exif */
    RF_XMP_CUT_GAIN_MAP = 512,
    /* all that makes a file editable: */
    RF_XMP_CUT_EDITABLE = 2 | 4 | 8 | 16 | 32,
};

enum rf_xmp_outcome { RF_XMP_SAME, RF_XMP_CHANGED, RF_XMP_EMPTY };
struct rf_xmp_edit {
    unsigned cut;
    struct rf_bytes insert; /* whole rdf:Description elements with their own namespaces */
    enum rf_xmp_outcome
        outcome;           /* RF_XMP_EMPTY: nothing was left but the frame, and nothing put in */
    unsigned found;        /* properties of `cut` that were there */
    struct rf_text packet; /* the new packet, when it is RF_XMP_CHANGED */
};

/* Properties that hold nothing any more go with the rdf:Description that held them. Without a
 * packet, or where nothing of it is left, `insert` gets one of its own. REFOCUS_ERR_FORMAT and
 * REFOCUS_ERR_SIZE: the packet is damaged or beyond the limits. */
int rf_xmp_edit(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp_edit *edit);

#endif
