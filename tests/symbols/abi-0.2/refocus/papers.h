/* papers.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_PAPERS_H
#define REFOCUS_PAPERS_H
#include <refocus/version.h>
#ifdef __cplusplus
extern "C" {
#endif
struct refocus_papers;
REFOCUS_API const struct refocus_papers *refocus_papers(void);
#ifdef __cplusplus
}
#endif
#endif
