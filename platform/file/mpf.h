/* mpf.h: the pictures that follow the main one in a file (CIPA DC-007, Multi-Picture Format). */
#ifndef RF_FILE_MPF_H
#define RF_FILE_MPF_H

#include <stdbool.h>
#include "bytes.h"

enum { RF_MPF_MAX = 32 };
enum { RF_MPF_VIEW = 0x020002 }; /* a view for stereo */
struct rf_mpf_image {
    uint32_t type;   /* code of the MP type, 24 bits */
    uint64_t offset; /* counted from the begin of the MPF segment's TIFF header; 0: the main one */
    uint64_t size;
};
struct rf_mpf {
    int count;
    struct rf_mpf_image image[RF_MPF_MAX];
};
bool rf_mpf_parse(struct rf_bytes tiff, struct rf_mpf *mpf);

#endif
