/* live_lines.h: lines out of bytes that come in pieces. */
#ifndef RF_CLI_LIVE_LINES_H
#define RF_CLI_LIVE_LINES_H

#include <stddef.h>

/* All zeros at the beginning. The rest of a line behind 255 bytes is left out, and the line is
 * then none that any command has. */
struct live_lines {
    char text[256];
    size_t length;
};

/* Call line() for each line that is complete, without its end; it may write to the text. */
void live_lines_take(struct live_lines *lines, const char *bytes, size_t count,
                     void (*line)(void *user, char *text), void *user);

#endif
