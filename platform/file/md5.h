/* md5.h: the MD5 digest by which extended XMP names its packets. */
#ifndef RF_FILE_MD5_H
#define RF_FILE_MD5_H

#include "bytes.h"

/* The digest in capital hexadecimal digits and a NUL. */
void rf_md5_hex(struct rf_bytes bytes, char hex[33]);

#endif
