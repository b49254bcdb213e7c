/* live_lines.c: lines are put together from bytes that come in pieces. */
#include <string.h>
#include "live/live_lines.h"

void live_lines_take(struct live_lines *lines, const char *bytes, size_t count,
                     void (*line)(void *user, char *text), void *user)
{
    for (; count > 0; count--, bytes++) {
        if (*bytes == '\n') {
            lines->text[lines->length] = '\0';
            lines->text[strcspn(lines->text, "\r")] = '\0';
            line(user, lines->text);
            lines->length = 0;
        } else if (lines->length + 1 < sizeof lines->text) {
            lines->text[lines->length++] = *bytes;
        } else {
            lines->text[0] = '?';
        }
    }
}
