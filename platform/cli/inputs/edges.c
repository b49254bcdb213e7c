/* edges.c: the edges of a depth map are put where the photo has them. */
#include <stdlib.h>
#include "inputs/edges.h"
#include "line/report.h"

const struct option_word edges_words[] = {
    {"auto", "where the map is soft, coarse or beside the photo, its edges go to the photo's"},
    {"as-given", "every disparity as the map has it"},
    {0}};

int edges_place(const struct refocus_image *photo, const struct refocus_disparity *map,
                uint16_t **placed, struct refocus_depth_edges_report *report, const char *name)
{
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    const uint64_t bytes = (uint64_t)photo->width * (uint64_t)photo->height * 2;
    uint16_t *out = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    int status = REFOCUS_ERR_MEMORY;

    *report = refocus_depth_edges_report_default();
    if (out)
        status = refocus_depth_edges(photo, map, &params, out, (ptrdiff_t)photo->width * 2, report);
    if (status != REFOCUS_OK) {
        free(out);
        return report_failure(EXIT_FAILED, name, "the edges of the depth map: %s",
                              refocus_strerror(status));
    }
    *placed = out;
    return EXIT_DONE;
}

json_t *edges_json(const struct refocus_depth_edges_report *report)
{
    if (report->struct_size == 0)
        return json_null();
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:b, s:b, s:f, s:f, s:f}", "softness_px",
                     (double)report->softness, "on_photo", (double)report->on_photo, "grown_px",
                     (double)report->grown, "shift_x_px", (double)report->shift_x, "shift_y_px",
                     (double)report->shift_y, "bent", (int)report->bent, "parted",
                     (int)report->parted, "changed", (double)report->changed, "noise",
                     (double)report->noise, "specks", (double)report->specks);
}
