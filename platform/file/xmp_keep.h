/* xmp_keep.h: the XMP of a photo as a picture made from it has it. */
#ifndef RF_FILE_XMP_KEEP_H
#define RF_FILE_XMP_KEEP_H

#include "reading.h"
#include "xmp_edit.h"

enum { RF_XMP_PACKETS = 4 }; /* one is usual; depth_write.c puts its own before it */

/* A standard packet and the extended one that it names. */
struct rf_xmp_packet {
    struct rf_bytes standard;
    char guid[33];                /* empty: names none, or one that is not whole */
    struct refocus_blob extended; /* put together */
    struct rf_xmp_edit edit, edit_extended;
    char new_guid[33];
};

struct rf_xmp_keep {
    struct rf_read read; /* limits, with places for what nobody is told: */
    struct refocus_reason unused;
    struct refocus_photo_info info;
    unsigned cut;                            /* RF_XMP_CUT_... */
    struct rf_bytes insert, insert_extended; /* into the last packet, or one of their own */
    struct rf_xmp_packet packet[RF_XMP_PACKETS];
    int count;
    bool damaged; /* a packet could not be edited and stays as it is */
};

#ifdef RF_HAVE_XMP
/* Edit the packets of a JPEG, or a packet by itself. What is damaged stays as it is. */
int rf_xmp_keep_jpeg(struct rf_xmp_keep *keep, struct rf_bytes jpeg);
int rf_xmp_keep_packet(struct rf_xmp_keep *keep, struct rf_bytes packet);
#else
static inline int rf_xmp_keep_jpeg(struct rf_xmp_keep *keep, struct rf_bytes jpeg)
{
    (void)keep;
    (void)jpeg;
    return REFOCUS_OK;
}

static inline int rf_xmp_keep_packet(struct rf_xmp_keep *keep, struct rf_bytes packet)
{
    (void)keep;
    (void)packet;
    return REFOCUS_OK;
}
#endif
/* A standard packet after its editing; empty: nothing is left. */
struct rf_bytes rf_xmp_kept(const struct rf_xmp_packet *packet);
void rf_xmp_keep_free(struct rf_xmp_keep *keep);

#endif
