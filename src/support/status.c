/* status.c: the version of the library and its status codes in words. */
#include <refocus/status.h>

const char *refocus_version(void)
{
    return REFOCUS_VERSION_STRING;
}

const char *refocus_strerror(int status)
{
    switch (status) {
    case REFOCUS_OK:
        return "done";
    case REFOCUS_ERR_ARGUMENT:
        return "an argument is out of its range";
    case REFOCUS_ERR_MEMORY:
        return "not enough memory";
    case REFOCUS_ERR_SIZE:
        return "larger than the limit";
    case REFOCUS_ERR_STATE:
        return "nothing is prepared yet";
    case REFOCUS_ERR_CANCELLED:
        return "cancelled";
    case REFOCUS_ERR_UNSUPPORTED:
        return "not supported by this build or processor";
    case REFOCUS_ERR_THREAD:
        return "a thread could not be started";
    case REFOCUS_ERR_IO:
        return "the file could not be read or written";
    case REFOCUS_ERR_FORMAT:
        return "the file is damaged or of an unknown format";
    case REFOCUS_ERR_NO_DEPTH:
        return "no depth was found";
    case REFOCUS_ERR_TIMEOUT:
        return "nothing came in time";
    case REFOCUS_ERR_END:
        return "there are no more frames";
    case REFOCUS_ERR_GONE:
        return "the device is gone or the pipe closed";
    case REFOCUS_ERR_BUSY:
        return "the device is used by another program";
    case REFOCUS_ERR_PERMISSION:
        return "access is refused";
    }
    return "unknown status";
}
