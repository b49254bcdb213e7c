/* sheet_picture.h: the picture of a contact sheet. */
#ifndef RF_CLI_SHEET_PICTURE_H
#define RF_CLI_SHEET_PICTURE_H

#include "commands/sheet_cells.h"

/* A picture for cells of that size, their captions and gaps; plane[0] is to be freed
 * and NULL when *why says why not. */
struct refocus_image sheet_picture(const struct sheet *sheet, int cell_width, int cell_height,
                                   const char **why);

/* Put a picture, at least as large as a cell, into cell i: averaged over areas of
 * squared values, which is close to averaging light and stays within integers. */
void sheet_picture_put(const struct refocus_image *picture, const struct sheet *sheet, int i,
                       const struct refocus_image *full, int cell_width, int cell_height);

#endif
