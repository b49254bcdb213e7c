/* version.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
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
REFOCUS_API const char *refocus_version(void);
#ifdef __cplusplus
}
#endif
#endif
