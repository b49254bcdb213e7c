/* info_text.c: what the command `refocus info` has found, as text or JSON. */
#include "commands/info_text.h"

#include <math.h>
#include <stdio.h>

#include "inputs/edges.h"
#include "inputs/lens.h"
#include "line/report.h"

/* Put the meaning of a map's samples into words. */
static void describe_meaning(char *text, size_t size, const struct refocus_depth_map *map)
{
    if (map->meaning == REFOCUS_DEPTH_DISTANCE)
        snprintf(text, size, "distance, %.6g m + %.6g m a unit", map->metres_at_zero,
                 map->metres_per_unit);
    else if (map->value_near == map->value_far)
        snprintf(text, size, "disparity, bright = near, range measured");
    else
        snprintf(text, size, "disparity, %s = near, %.6g = nearest, %.6g = farthest",
                 map->value_near > map->value_far ? "bright" : "dark", map->value_near,
                 map->value_far);
}

static const char *sample_name(uint32_t sample)
{
    return sample == REFOCUS_SAMPLE_U8    ? "8-bit"
           : sample == REFOCUS_SAMPLE_U16 ? "16-bit"
                                          : "float";
}

static const char *source_text(uint32_t source)
{
    switch (source) {
    case REFOCUS_DEPTH_SOURCE_GDEPTH:
        return "GDepth in XMP";
    case REFOCUS_DEPTH_SOURCE_APPLE_MPF:
        return "Apple disparity image in MPF";
    case REFOCUS_DEPTH_SOURCE_HEIF:
        return "auxiliary depth image in HEIF";
    case REFOCUS_DEPTH_SOURCE_DYNAMIC:
        return "Dynamic Depth, a picture behind the main one";
    case REFOCUS_DEPTH_SOURCE_TRAILER:
        return "its maker's trailer behind the main picture";
    case REFOCUS_DEPTH_SOURCE_FILE:
        return "the file itself, as --depth reads it";
    }
    return "none";
}

static void print_metres(const char *name, double metres)
{
    if (metres > 0)
        printf("%-13s %.5g m\n", name, metres);
    else
        printf("%-13s not known\n", name);
}

static void print_depth(const struct input *input)
{
    const struct refocus_depth_report *report = &input->report;
    const struct refocus_photo *from = input->depth_from;
    const struct refocus_depth_map *map = from->depth;
    char text[160], name[REFOCUS_INFO_LENGTH];

    report_clean(name, sizeof name, input->depth_name);
    printf("depth         %s%s%s%s\n", input->side ? name : "", input->side ? ": " : "",
           source_text(from->info->depth_source),
           map->samples || from->info->views == 0 ? ""
                                                  : "; 'refocus depth FILE --stereo-file' makes it "
                                                    "of the two views");
    if (!map->samples)
        return;
    describe_meaning(text, sizeof text, map);
    printf("depth size    %dx%d, %s\n", (int)map->width, (int)map->height,
           sample_name(map->sample));
    printf("depth unit    %s\n", text);
    print_metres("near", report->near_m);
    print_metres("far", report->far_m);
    printf("without value %llu samples, %.1f %%\n", (unsigned long long)report->unknown,
           100.0 * (double)report->unknown / ((double)map->width * map->height));
}

static bool has_focus_point(const struct refocus_photo_info *info)
{
    return info->focus_x >= 0 && info->focus_y >= 0 && (info->focus_x > 0 || info->focus_y > 0);
}

/* The blur that `render` takes where no option says it; false where there is nothing to render. */
static bool find_blur(const struct input *input, double *blur, char why[INPUT_WHY])
{
    if (!input->photo->image->plane[0] || !input->depth_from->depth->samples)
        return false;
    input_default_blur(input, blur, why);
    return true;
}

/* The pixel of the file's point, as render takes it. */
static void print_focus_point(const struct input *input)
{
    static const struct lens_settings none = LENS_SETTINGS_NONE;
    double at[2];

    input_focus_point(input, &none, at);
    if (!isnan(at[0]))
        printf("focus point   %.0f,%.0f\n", at[0], at[1]);
}

static void print_defaults(const struct input *input)
{
    const struct refocus_photo_info *info = input->photo->info;
    char why[INPUT_WHY];
    double blur;

    if (!find_blur(input, &blur, why))
        return;
    printf("render takes  %.1f pixels of blur: %s\n", blur, why);
    printf("              focus on the %s\n",
           has_focus_point(info) ? "focus point"
           : info->focus_distance > 0 && input->report.near_m > 0
               ? "focus distance"
               : "subject by its depth, or the centre: the file names no point");
}

/* How the edges of the depth lie on the photo's, and what rendering does about it. */
static void print_edges(const struct refocus_depth_edges_report *edges)
{
    if (!edges->struct_size)
        return;
    printf("depth edges   ");
    if (edges->softness > 0)
        printf("%.1f pixels soft, ", (double)edges->softness);
    if (edges->parted && !(edges->on_photo > 0) && !(edges->changed > 0)) /* samples of a sensor */
        puts("put on the photo's while the map is enlarged");
    else
        printf("%.0f %% on the photo's\n", 100 * (double)edges->on_photo);
    if (!(edges->changed > 0))
        return;
    printf("placed        %.1f %% of the pixels change%s", 100 * (double)edges->changed,
           edges->bent ? ", block by block" : "");
    if (edges->shift_x != 0 || edges->shift_y != 0)
        printf(", shifted by %+.0f,%+.0f", (double)edges->shift_x, (double)edges->shift_y);
    if (edges->grown != 0)
        printf(", near things %s by %.0f pixels", edges->grown > 0 ? "shrunk" : "grown",
               fabs((double)edges->grown));
    putchar('\n');
}

/* The lines of a file on why its depth is believed; false where it has none. */
static bool print_evidence(const struct refocus_photo_info *info, bool first)
{
    char clean[REFOCUS_INFO_LENGTH];

    for (int i = 0; i < info->evidence_count && i < REFOCUS_INFO_LINES; i++, first = false) {
        report_clean(clean, sizeof clean, info->evidence[i]);
        printf("%s %s\n", first ? "because      " : "             ", clean);
    }
    return !first;
}

void info_print(const struct input *input, const struct info_findings *found)
{
    const struct refocus_photo *photo = input->photo;
    const struct refocus_photo_info *info = photo->info;
    char clean[REFOCUS_INFO_LENGTH], bits[32];
    bool first;

    report_clean(clean, sizeof clean, input->photo_name);
    printf("file          %s\n", clean);
    printf("container     %s\n", info->container);
    snprintf(bits, sizeof bits, "%d bits a channel", (int)info->stored_bits);
    if (photo->image->plane[0])
        printf("picture       %dx%d, upright, %s%s\n", (int)photo->image->width,
               (int)photo->image->height, info->stored_bits ? bits : "floats",
               info->original_used ? ", the all-in-focus original in the file" : "");
    if (info->stored_width > 0)
        printf("stored        %dx%d, orientation %d\n", (int)info->stored_width,
               (int)info->stored_height, info->orientation ? (int)info->orientation : 1);
    report_clean(clean, sizeof clean, info->camera);
    if (clean[0])
        printf("camera        %s\n", clean);
    if (info->focal_length_mm > 0)
        printf("focal length  %.4g mm\n", info->focal_length_mm);
    if (info->focal_length_35mm > 0)
        printf("35 mm terms   %.4g mm\n", info->focal_length_35mm);
    if (info->f_number > 0)
        printf("f-number      f/%.3g\n", info->f_number);
    if (info->subject_distance > 0)
        printf("subject       %.3g m\n", info->subject_distance);
    if (info->simulated_f_number > 0)
        printf("simulated     f/%.3g, the blur that the phone shows\n", info->simulated_f_number);
    if (info->own_blur > 0 && photo->image->plane[0])
        printf("own blur      %.1f pixels\n",
               info->own_blur * (photo->image->width > photo->image->height
                                     ? photo->image->width
                                     : photo->image->height));
    if (photo->image->plane[0])
        print_focus_point(input);
    print_depth(input);
    print_edges(&input->edges);
    if (photo->matte->samples)
        printf("matte         %dx%d, the portrait's; render uses it unless told --matte none\n",
               (int)photo->matte->width, (int)photo->matte->height);
    print_defaults(input);
    depth_of_field_print(&found->field);
    first = !print_evidence(info, true);
    if (input->side)
        print_evidence(input->side->info, first);
    if (found->unit_is_doubtful)
        printf("doubtful      %s\n", found->unit_line);
}

static json_t *positive(double value)
{
    return value > 0 ? report_number_json(value) : json_null();
}

static json_t *size_json(int width, int height)
{
    return json_pack("[i, i]", width, height);
}

static void add_evidence(json_t *lines, const struct refocus_photo_info *info)
{
    for (int i = 0; i < info->evidence_count && i < REFOCUS_INFO_LINES; i++)
        json_array_append_new(lines, report_text_json(info->evidence[i]));
}

static json_t *evidence_json(const struct input *input, const struct info_findings *found)
{
    json_t *lines = json_array();

    add_evidence(lines, input->photo->info);
    if (input->side)
        add_evidence(lines, input->side->info);
    if (found->unit_is_doubtful)
        json_array_append_new(lines, json_string(found->unit_line));
    return lines;
}

static json_t *depth_json(const struct input *input)
{
    const struct refocus_depth_map *map = input->depth_from->depth;
    json_t *depth = map->samples ? report_depth_json(input->depth_from, &input->report) : NULL;
    char text[160], why[INPUT_WHY];
    double blur = NAN;

    if (!map->samples)
        return json_null();
    describe_meaning(text, sizeof text, map);
    json_object_set_new(depth, "unit", report_text_json(text));
    json_object_set_new(depth, "sample", json_string(sample_name(map->sample)));
    json_object_set_new(depth, "edges", edges_json(&input->edges));
    if (find_blur(input, &blur, why))
        json_object_set_new(depth, "blur_from", json_string(why));
    json_object_set_new(depth, "blur", report_number_json(blur));
    return depth;
}

json_t *info_json(const struct input *input, const struct info_findings *found)
{
    const struct refocus_photo *photo = input->photo;
    const struct refocus_photo_info *info = photo->info;

    return json_pack(
        "{s:o, s:s, s:o, s:o, s:i, s:i, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, "
        "s:o, s:o, s:i, s:o, s:o}",
        "file", report_text_json(input->photo_name), "container", info->container, "picture",
        photo->image->plane[0] ? size_json(photo->image->width, photo->image->height) : json_null(),
        "stored",
        info->stored_width > 0 ? size_json(info->stored_width, info->stored_height) : json_null(),
        "orientation", info->orientation ? (int)info->orientation : 1, "bits",
        (int)info->stored_bits, "original_used", (int)info->original_used, "camera",
        info->camera[0] ? report_text_json(info->camera) : json_null(), "focal_length_mm",
        positive(info->focal_length_mm), "focal_length_35mm", positive(info->focal_length_35mm),
        "f_number", positive(info->f_number), "simulated_f_number",
        positive(info->simulated_f_number), "own_blur", positive(info->own_blur), "focus_point",
        has_focus_point(info) ? json_pack("[f, f]", info->focus_x, info->focus_y) : json_null(),
        "depth", depth_json(input), "matte",
        photo->matte->samples ? size_json(photo->matte->width, photo->matte->height) : json_null(),
        "evidence", evidence_json(input, found), "views", (int)info->views, "subject_distance",
        report_metres_json(info->subject_distance), "depth_of_field",
        depth_of_field_json(&found->field));
}
