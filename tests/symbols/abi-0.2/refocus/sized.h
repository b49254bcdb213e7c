/* sized.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_SIZED_H
#define REFOCUS_SIZED_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
enum { REFOCUS_MAX_STRUCT_SIZE = 65536 };
#define REFOCUS_SIZE_TO(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))
static inline int refocus_struct_read(void *own, size_t known, size_t first, const void *given)
{
    const unsigned char *byte = (const unsigned char *)given;
    const uint32_t own_size = (uint32_t)known;
    uint32_t size = 0;
    size_t i;
    if (given)
        memcpy(&size, given, sizeof size);
    if (!own || first < sizeof size || known < first || size < first ||
        size > REFOCUS_MAX_STRUCT_SIZE)
        return REFOCUS_ERR_ARGUMENT;
    for (i = known; i < size; i++)
        if (byte[i] != 0)
            return REFOCUS_ERR_UNSUPPORTED;
    memmove(own, given, size < known ? size : known);
    if (size < known)
        memset((unsigned char *)own + size, 0, known - size);
    memcpy(own, &own_size, sizeof own_size);
    return REFOCUS_OK;
}
static inline int refocus_struct_write(void *given, size_t first, const void *own, size_t known)
{
    const size_t head = sizeof(uint32_t);
    unsigned char *to = (unsigned char *)given;
    uint32_t size = 0;
    if (given)
        memcpy(&size, given, sizeof size);
    if (!own || first < head || known < first || size < first || size > REFOCUS_MAX_STRUCT_SIZE)
        return REFOCUS_ERR_ARGUMENT;
    memcpy(to + head, (const unsigned char *)own + head, (size < known ? size : known) - head);
    if (size > known)
        memset(to + known, 0, size - known);
    return REFOCUS_OK;
}
#ifdef __cplusplus
}
#endif
#endif
