/* stack_shots.h: a camera moves its lens and photographs a focus stack, into a folder or for
 * whoever takes the pictures. */
#ifndef RF_CLI_STACK_SHOTS_H
#define RF_CLI_STACK_SHOTS_H

#include <stdbool.h>
#include <refocus/image.h>
#include "commands/stack_lens.h"

/* These return exit codes and print why it is not EXIT_DONE. */

/* Plan positions, evenly between the ends of the range, of a source that is open, or of the camera
 * of the settings, which is opened for NULL. */
int shots_plan(struct shots *shots, const struct shots_settings *settings,
               struct refocus_source *source);
/* Take picture k, of R, G and B; it is gone when this returns. */
typedef int shots_picture_fn(void *user, const struct shots *shots, int k,
                             const struct refocus_image *image);
/* Photograph all with a camera that runs; its lens then stays where it is. */
int shots_photograph(struct shots *shots, shots_picture_fn *take, void *user);
/* Photograph all into an empty folder, with names from shots_name() and stack.json, which holds the
 * positions. */
int shots_take(struct shots *shots, const char *folder, const char *ending);
/* Close a camera that shots_plan() has opened. */
void shots_end(struct shots *shots);

enum { SHOTS_NAME = 4096 };
/* The file of frame k, or of the positions for k < 0; false where it is too long. */
bool shots_name(char name[SHOTS_NAME], const char *folder, int k, const char *ending);
/* Remove what shots_take() has made, and the folder. */
void shots_remove(const struct shots *shots, const char *folder, const char *ending);

#endif
