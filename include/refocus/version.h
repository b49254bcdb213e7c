/** @file version.h  Version and visibility of the library.
 *
 * A program that was built with one version runs with every later one of the same soversion, the
 * number behind .so: functions and fields are only added (see sized.h for fields). A release that
 * takes something away, or changes what it means, gets the next soversion.
 */
#ifndef REFOCUS_VERSION_H
#define REFOCUS_VERSION_H

#define REFOCUS_VERSION_MAJOR  0
#define REFOCUS_VERSION_MINOR  2
#define REFOCUS_VERSION_PATCH  0
#define REFOCUS_VERSION_STRING "0.2.0"

#if defined(__GNUC__) || defined(__clang__)
#define REFOCUS_API __attribute__((visibility("default")))
#else
#define REFOCUS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** Version of the library that is linked, "major.minor.patch". Thread-safe. */
REFOCUS_API const char *refocus_version(void);

#ifdef __cplusplus
}
#endif
#endif
