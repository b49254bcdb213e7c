/* depth_of_field.h: what still looks sharp before and behind the focus of a photo. */
#ifndef RF_CLI_DEPTH_OF_FIELD_H
#define RF_CLI_DEPTH_OF_FIELD_H

#include <stdbool.h>
#include <stdint.h>
#include <jansson.h>
#include "inputs/read_input.h"
#include "inputs/lens.h"

/* The depth of field of a photo as it would be rendered. Metres are NAN where its depth has none,
 * and where there is no blur. */
struct depth_of_field {
    bool known;                       /* there is a photo with depth; else nothing else is set */
    double focus, blur;               /* df, K */
    double sharp;                     /* the blur radius up to which it looks sharp, pixels */
    double nearest, farthest;         /* disparities that look sharp, 0 to 1 */
    double focus_m, near_m, far_m;    /* U, U-, U+ */
    double hyperfocal_m;              /* H */
    double focal_length_mm, f_number; /* a lens that has this blur */
    enum { LENS_GIVEN, LENS_OF_FILE, LENS_NORMAL } from; /* where its focal length is from */
};

/* Find it by the options and the packed disparities of the photo's size. Returns an exit code and
 * prints why. */
int depth_of_field_find(const struct input *input, const struct lens_settings *settings,
                        const uint16_t *disparity, struct depth_of_field *field);

void depth_of_field_print(const struct depth_of_field *field);
json_t *depth_of_field_json(const struct depth_of_field *field);

#endif
