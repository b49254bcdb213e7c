/* json.h: words of the file of strokes. */
#ifndef RF_STROKES_JSON_H
#define RF_STROKES_JSON_H

enum { RF_STROKES_VERSION = 1 };

extern const char *const rf_stroke_kinds[]; /* by enum refocus_stroke_kind */

#endif
