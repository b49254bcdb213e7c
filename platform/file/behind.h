/* behind.h: a list of pictures that lie behind the main one in a file. */
#ifndef RF_FILE_BEHIND_H
#define RF_FILE_BEHIND_H

#include <refocus/platform/file.h>
#include "text.h"

enum { RF_BEHIND_MOST = 3 };
struct rf_behind_item {
    const char *semantic, *uri; /* as container directories name it */
    struct refocus_blob bytes;  /* a JPEG, owned */
};
/* They follow each other without gaps. A gain map is the first, as readers expect it; depth and its
 * confidence follow. */
struct rf_behind {
    struct rf_behind_item item[RF_BEHIND_MOST];
    int count;
};

extern const char rf_gain_map_semantic[8];

/* Take over one of at most RF_BEHIND_MOST. */
void rf_behind_add(struct rf_behind *behind, const char *semantic, const char *uri,
                   struct refocus_blob jpeg);
bool rf_behind_has(const struct rf_behind *behind, const char *semantic);
bool rf_behind_has_gain_map(const struct rf_behind *behind);
/* Leave the depth out. */
void rf_behind_drop_depth(struct rf_behind *behind);
/* A container directory of them, which names what they are, or, as that of Dynamic Depth, their
 * URI. */
void rf_behind_put_items(struct rf_text *text, const struct rf_behind *behind, bool by_semantic);
void rf_behind_free(struct rf_behind *behind);

#endif
