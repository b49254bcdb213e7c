/* base64.h: Base64 is decoded in place. */
#ifndef RF_FILE_BASE64_H
#define RF_FILE_BASE64_H

#include <stddef.h>

/* Bytes that came out; (size_t)-1 when the text is no base64. Blanks are skipped. */
size_t rf_base64_decode(char *text, size_t length);

#endif
