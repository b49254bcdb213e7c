/* status.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_STATUS_H
#define REFOCUS_STATUS_H
#include <refocus/version.h>
#ifdef __cplusplus
extern "C" {
#endif
enum refocus_status {
    REFOCUS_OK = 0,
    REFOCUS_ERR_ARGUMENT = -1,
    REFOCUS_ERR_MEMORY = -2,
    REFOCUS_ERR_SIZE = -3,
    REFOCUS_ERR_STATE = -4,
    REFOCUS_ERR_CANCELLED = -5,
    REFOCUS_ERR_UNSUPPORTED = -6,
    REFOCUS_ERR_THREAD = -7,
    REFOCUS_ERR_IO = -8,
    REFOCUS_ERR_FORMAT = -9,
    REFOCUS_ERR_NO_DEPTH = -10,
    REFOCUS_ERR_TIMEOUT = -11,
    REFOCUS_ERR_END = -12,
    REFOCUS_ERR_GONE = -13,
    REFOCUS_ERR_BUSY = -14,
    REFOCUS_ERR_PERMISSION = -15,
};
REFOCUS_API const char *refocus_strerror(int status);
#ifdef __cplusplus
}
#endif
#endif
