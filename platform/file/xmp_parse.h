/* xmp_parse.h: XMP packets are read by expat. */
#ifndef RF_FILE_XMP_PARSE_H
#define RF_FILE_XMP_PARSE_H

#include <expat.h>
#include "bytes.h"
#include "xmp.h"

/* Add a packet's properties; the first value of each stays. On an error the struct holds what was
 * read and is freed as ever. */
int rf_xmp_parse(const struct rf_read *read, struct rf_bytes packet, struct rf_xmp *xmp);

/* For others who have expat read a packet: */

/* expat puts it between namespace and name; it is in no URI. */
#define RF_XMP_SEPARATOR "|"
/* NULL without memory. */
XML_Parser rf_xmp_parser(void *user, XML_StartElementHandler on_element,
                         XML_EndElementHandler on_element_end,
                         XML_StartDoctypeDeclHandler on_document_type);
int rf_xmp_check(const struct rf_read *read, struct rf_bytes packet);
/* Run the parser over a packet; *status is an error that one of its handlers met. */
int rf_xmp_run(const struct rf_read *read, XML_Parser parser, struct rf_bytes packet,
               const int *status);

#endif
