/* failure.h: words and a status for what went wrong with a source or sink. */
#ifndef RF_CAPTURE_FAILURE_H
#define RF_CAPTURE_FAILURE_H

#include <refocus/platform/file.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__) || defined(__clang__)
__attribute__((format(printf, 3, 4)))
#endif
int rf_capture_fail(struct refocus_reason *reason, int status, const char *format, ...);
int rf_capture_fail_memory(struct refocus_reason *reason);
/* The status for a value of errno of a file or device, and words: "what: why; what to do". */
int rf_capture_fail_errno(struct refocus_reason *reason, int error, const char *what);

#ifdef __cplusplus
}
#endif

#endif
