/* bytes.h: bytes and lines of a file or pipe, for which a source waits as for a device. */
#ifndef RF_CAPTURE_BYTES_H
#define RF_CAPTURE_BYTES_H

#include "backend.h"

/* Read so many bytes, or fewer where the stream ends. However long a pipe says nothing, an
 * interrupt ends the wait, with REFOCUS_ERR_CANCELLED; what was read until then is gone. */
int rf_read_bytes(const struct refocus_source *source, int fd, void *bytes, size_t size,
                  size_t *got, struct refocus_reason *reason);
/* Read a line without its end; REFOCUS_ERR_END where the stream ends, REFOCUS_ERR_FORMAT when it
 * does so within the line, or the line is too long. */
int rf_read_line(const struct refocus_source *source, int fd, char *line, size_t size,
                 struct refocus_reason *reason);

#endif
