/** @file sized.h  Structs that grow, and programs that do not: the rule, and what keeps it.
 *
 * Every struct that may get more fields begins with `struct_size`, its size as the program that
 * fills it was compiled, set by the function that makes it (refocus_image_packed(),
 * refocus_render_params_default(), ...). New fields are only ever appended, and a new field's 0
 * means its default, which is what the library did before there was the field. So
 *
 *   - an older program runs with a newer library: fields beyond its struct take their defaults;
 *   - a newer program runs with an older library as long as the fields that this library does
 *     not know are 0. Any that is not is REFOCUS_ERR_UNSUPPORTED: what it asks for cannot be had.
 *
 * A struct_size below that of the struct's first layout, or above REFOCUS_MAX_STRUCT_SIZE, is
 * REFOCUS_ERR_ARGUMENT. Nothing behind struct_size bytes is read. A struct that the library
 * fills, such as struct refocus_renderer_info, is written as far as the caller's size goes, and
 * with 0 behind what the library knows.
 *
 * Structs without a struct_size are complete and stay as they are.
 */
#ifndef REFOCUS_SIZED_H
#define REFOCUS_SIZED_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** No struct is larger: more is taken for memory that was never set. */
enum { REFOCUS_MAX_STRUCT_SIZE = 65536 };

/** Bytes of a struct up to the end of a member: with the last member of its first layout the
 *  least struct_size that a reader takes. */
#define REFOCUS_SIZE_TO(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))

/**
 * Read a struct that another program, or another version of this library, has filled: what
 * every function here does with the structs that it gets, for libraries that take them too.
 *
 * @param own    receives it: fields that @p given has none of become 0, struct_size @p known
 * @param known  sizeof of the struct as the caller of this function knows it
 * @param first  bytes of its first layout, see REFOCUS_SIZE_TO()
 * @param given  begins with its struct_size, a uint32_t; may be @p own
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (NULL, or a struct_size out of its range),
 *         REFOCUS_ERR_UNSUPPORTED (a byte beyond @p known is not 0); on an error @p own is
 *         untouched. Thread-safe.
 */
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

/**
 * The other way round: fill a struct of the caller's, whose struct_size says how much of it
 * there is. What it has beyond @p known becomes 0, its struct_size stays.
 *
 * @return REFOCUS_OK, or REFOCUS_ERR_ARGUMENT with @p given untouched. Thread-safe.
 */
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
