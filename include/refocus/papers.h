/** @file papers.h  Methods of other papers, beside the sweep and the search of the core.
 *
 * They are a library of their own, refocus-papers: programs that compare methods link it, a phone
 * does not. struct refocus_renderer_params takes what refocus_papers() returns, and enum
 * refocus_method names the methods: raytrace, jittered, lightfield, blur (Yang et al. 2016),
 * scatter (Potmesil & Chakravarty 1981), foveated (Mulder & van Liere 2000), interpolated (NVIDIA
 * 2004) and diffusion (Kosloff & Barsky 2007).
 */
#ifndef REFOCUS_PAPERS_H
#define REFOCUS_PAPERS_H

#include <refocus/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Methods that a renderer can take on. Opaque. */
struct refocus_papers;

/* The struct and the function have one name, which -Wshadow of g++ takes for a mistake. */
#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif
/**
 * The methods of this library. It must be of the same build as the core that renders with it:
 * refocus_renderer_create() refuses another one.
 *
 * @return constant, never NULL; nothing is to be freed. Thread-safe.
 */
REFOCUS_API const struct refocus_papers *refocus_papers(void);
#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#ifdef __cplusplus
}
#endif
#endif
