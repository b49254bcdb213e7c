/* reason.h: words for errors and for the evidence that a photo carries. */
#ifndef RF_FILE_REASON_H
#define RF_FILE_REASON_H

#include <refocus/platform/file.h>

#if defined(__GNUC__) || defined(__clang__)
#define RF_PRINTF(words, first) __attribute__((format(printf, words, first)))
#else
#define RF_PRINTF(words, first)
#endif

/* Put words into the reason; returns the status, so that a caller reports an error in one line. */
int rf_fail(struct refocus_reason *reason, int status, const char *format, ...) RF_PRINTF(3, 4);
int rf_fail_memory(struct refocus_reason *reason);
/* Report a failed call of the system: the words of the value that errno had follow `what`. */
int rf_fail_errno(struct refocus_reason *reason, int error, const char *what);
/* Report that a format needs a library which this build was made without. */
int rf_fail_absent(struct refocus_reason *reason, const char *format, const char *library);
/* Say what a writer leaves out, behind what was said before. */
void rf_leave_out(struct refocus_reason *reason, const char *format, ...) RF_PRINTF(2, 3);
/* Add a line of evidence; a line that finds no room is dropped. */
void rf_note(struct refocus_photo_info *info, const char *format, ...) RF_PRINTF(2, 3);
/* Count another view of the scene, the number of which is told. */
void rf_note_view(struct refocus_photo_info *info, const char *container, int number);
/* Replace everything but printable ASCII. Files may hold anything, and printable ASCII is what no
 * terminal obeys and every JSON writer takes. char may be signed or not, so both ends are checked.
 */
void rf_clean_text(char *text);

#endif
