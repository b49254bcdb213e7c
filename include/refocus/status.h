/** @file status.h  What functions return. */
#ifndef REFOCUS_STATUS_H
#define REFOCUS_STATUS_H

#include <refocus/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Functions that can fail return REFOCUS_OK or one of the negative values. A NULL, a
 * size, a stride or a number that a function's description does not allow is
 * REFOCUS_ERR_ARGUMENT, never a crash. A struct of a newer caller in which a field is set that this
 * library does not know is REFOCUS_ERR_UNSUPPORTED. Functions without a status do nothing then, or
 * return 0, NULL or NAN. What cannot be told is not looked for: memory that is not as
 * large as it is said to be, a handle that has been destroyed.
 */
enum refocus_status {
    REFOCUS_OK = 0,
    REFOCUS_ERR_ARGUMENT = -1,    /**< an argument is out of its documented range */
    REFOCUS_ERR_MEMORY = -2,      /**< the allocator returned NULL */
    REFOCUS_ERR_SIZE = -3,        /**< a picture is larger than a stated limit */
    REFOCUS_ERR_STATE = -4,       /**< called too early: nothing prepared yet */
    REFOCUS_ERR_CANCELLED = -5,   /**< refocus_cancel() was called */
    REFOCUS_ERR_UNSUPPORTED = -6, /**< this build or processor cannot do it */
    REFOCUS_ERR_THREAD = -7,      /**< a thread could not be started */
    REFOCUS_ERR_IO = -8,          /**< a file could not be opened, read or written */
    REFOCUS_ERR_FORMAT = -9,      /**< a file is damaged or of an unknown format */
    REFOCUS_ERR_NO_DEPTH = -10,   /**< a picture carries no depth, or no known depth */
    REFOCUS_ERR_TIMEOUT = -11,    /**< nothing came in the time that was given */
    REFOCUS_ERR_END = -12,        /**< a stream has no more frames */
    REFOCUS_ERR_GONE = -13,       /**< a device is not or no longer there, a pipe is
                                       closed */
    REFOCUS_ERR_BUSY = -14,       /**< a device is used by another program, or a
                                       renderer by another thread */
    REFOCUS_ERR_PERMISSION = -15, /**< access to a file or device is refused */
};

/** English words for a status, never NULL, without a full stop. Thread-safe. */
REFOCUS_API const char *refocus_strerror(int status);

#ifdef __cplusplus
}
#endif
#endif
