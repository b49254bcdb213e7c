/* exif.h: EXIF blocks: facts about the camera, made true for the upright photo. */
#ifndef RF_FILE_EXIF_H
#define RF_FILE_EXIF_H

#include "bytes.h"
#include "reading.h"

struct rf_exif {
    int orientation;                                     /* 1 to 8; 1 when there is none */
    double focal_length_mm, focal_length_35mm, f_number; /* 0: not said */
    double subject_distance;                             /* metres; INFINITY; 0: not said */
    struct rf_subject subject;
    char camera[96];
    double apple_headroom; /* brightest over white of an iPhone's gain map; 0: not said */
    bool is_portrait;      /* an iPhone has blurred it by its depth */
};

/* Read a TIFF block and make it true for the upright picture without a thumbnail: orientation 1,
 * sides exchanged when it lay on its side, the subject's place turned with it, thumbnail erased. */
bool rf_exif_parse(uint8_t *tiff, size_t size, struct rf_exif *exif);
/* Put the sides of a picture in place of those that a block says. */
void rf_exif_set_size(uint8_t *tiff, size_t size, uint32_t width, uint32_t height);
/* Copy a block into read->exif and its facts into read->info and read->orientation. */
int rf_exif_take(struct rf_read *read, struct rf_bytes tiff, bool orient);

#endif
