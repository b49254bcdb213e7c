/* papers.c: the table of this library's methods, for the core that renders with them. */
#include "papers/papers.h"

#include <refocus/papers.h>

#define ROW(NAME, name) [REFOCUS_METHOD_##NAME] = &rf_##name##_method,

static const struct refocus_papers papers = {
    .version = REFOCUS_VERSION_STRING,
    .frame_size = sizeof(struct rf_frame),
    .method = {RF_PAPERS_METHODS(ROW)},
};

const struct refocus_papers *refocus_papers(void)
{
    return &papers;
}
