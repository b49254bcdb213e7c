/* settings.c: the properties of the element are rows of a table. */
#include <math.h>
#include <string.h>
#include "settings.h"

enum kind { NUMBER, INTEGER, TRUTH, TEXT, CHOICE };

enum {
    LIVE = GST_PARAM_MUTABLE_PLAYING,
    MOVES = GST_PARAM_MUTABLE_PLAYING | GST_PARAM_CONTROLLABLE,
    READY = GST_PARAM_MUTABLE_READY,
};

struct row {
    enum kind kind;
    int flags;
    const char *name;
    size_t offset;
    double least, greatest, otherwise;
    const char *text; /* the default of a TEXT */
    GType (*choices)(void);
    const char *nick, *help;
};

static const struct {
    const char *name, *help;
    int rays;
} qualities[] = {
    {"preview", "32 rays a pixel", 32},
    {"standard", "64 rays a pixel", 64},
    {"best", "128 rays a pixel; of Y, U and V also no halo beside what is in focus", 128},
};

enum { QUALITIES = sizeof qualities / sizeof *qualities };

int rf_gst_quality_rays(int quality)
{
    return qualities[quality].rays;
}

bool rf_gst_quality_is_best(int quality)
{
    return quality == QUALITIES - 1;
}

static GType quality_type(void)
{
    static GEnumValue values[QUALITIES + 1];
    static gsize type;

    if (g_once_init_enter(&type)) {
        for (int i = 0; i < QUALITIES; i++)
            values[i] = (GEnumValue){i, qualities[i].help, qualities[i].name};
        g_once_init_leave(&type, g_enum_register_static("RefocusQuality", values));
    }
    return type;
}

/* The names and summaries are the library's own. */
static GType method_type(void)
{
    static GEnumValue values[REFOCUS_METHOD_COUNT + 1];
    static gsize type;

    if (g_once_init_enter(&type)) {
        for (uint32_t i = 0; i < REFOCUS_METHOD_COUNT; i++)
            values[i] = (GEnumValue){(gint)i, refocus_method_summary(i), refocus_method_name(i)};
        g_once_init_leave(&type, g_enum_register_static("RefocusMethod", values));
    }
    return type;
}

#define AT(member) offsetof(struct rf_gst_settings, member)

static const struct row rows[] = {
    {NUMBER, MOVES, "focus", AT(focus), 0, 1, 0.5, NULL, NULL, "Focus",
     "Disparity in focus: 0 the farthest, 1 the nearest"},
    {NUMBER, MOVES, "focus-x", AT(focus_x), -1, 1, -1, NULL, NULL, "Focus, column",
     "Focus on the surface at this place of each frame, 0 left to 1 right, in place of 'focus'; "
     "at once, then with a time constant of 80 ms; below 0: not. With focus-y"},
    {NUMBER, MOVES, "focus-y", AT(focus_y), -1, 1, -1, NULL, NULL, "Focus, row",
     "See focus-x: 0 top to 1 bottom"},
    {NUMBER, MOVES, "focus-distance", AT(focus_distance), 0, 1e6, 0, NULL, NULL, "Focus distance",
     "Metres in focus, in place of 'focus'; 0: not. Needs near and far"},
    {NUMBER, MOVES, "blur", AT(blur), 0, REFOCUS_MAX_BLUR_RADIUS, 20, NULL, NULL, "Blur",
     "Blur radius in pixels of what lies a disparity of 1 from the focus"},
    {NUMBER, MOVES, "f-number", AT(f_number), 0, 1000, 0, NULL, NULL, "F-number",
     "The lens in place of 'blur'; 0: not. Needs near and far"},
    {NUMBER, MOVES, "focal-length", AT(focal_length), 0.1, 10000, 50, NULL, NULL, "Focal length",
     "Millimetres; counts with f-number"},
    {NUMBER, LIVE, "sensor-width", AT(sensor_width), 0.1, 1000, 36, NULL, NULL, "Sensor width",
     "Millimetres of the sensor that a frame shows; counts with f-number"},
    {NUMBER, LIVE, "near", AT(near_m), 0, 1e6, 0, NULL, NULL, "Near",
     "Metres that disparity 1 stands for; 0: not known. Distances on the pad depth need near and "
     "far"},
    {NUMBER, LIVE, "far", AT(far_m), 0, INFINITY, 0, NULL, NULL, "Far",
     "Metres that disparity 0 stands for, which may be inf; 0: not known"},
    {CHOICE, LIVE, "quality", AT(quality), 0, 0, 1, NULL, quality_type, "Quality",
     "Time against smoothness"},
    {CHOICE, READY, "method", AT(method), 0, 0, REFOCUS_METHOD_SWEEP, NULL, method_type, "Method",
     "How it is rendered; all but sweep and search take frames of R, G and B alone"},
    {TEXT, LIVE, "aperture", AT(aperture), 0, 0, 0, "disc", NULL, "Aperture",
     "disc, polygon:BLADES, polygon:BLADES:DEGREES, heart, star or star:POINTS"},
    {NUMBER, MOVES, "highlights", AT(highlights), 0, 16, 0, NULL, NULL, "Highlights",
     "Light given back to clipped highlights: below 1 as estimated from the frame, 1 "
     "none, above it as many times white"},
    {NUMBER, LIVE, "steady", AT(steady), 0, 0.95, 0, NULL, NULL, "Steady",
     "Calm the flicker of depth: share of the past where nothing moves"},
    {TRUTH, READY, "depth-edges", AT(place_edges), 0, 0, FALSE, NULL, NULL, "Depth edges",
     "Put edges of the depth that are soft, coarse or beside those of the frame onto them, "
     "steadily from frame to frame"},
    {TEXT, READY, "depth-location", AT(depth_location), 0, 0, 0, NULL, NULL, "Depth location",
     "File of a depth map that holds for all frames, when the pad depth is not there"},
    {TEXT, READY, "depth-unit", AT(depth_unit), 0, 0, 0, NULL, NULL, "Depth unit",
     "The meaning of samples of depth: disparity (bright is near; the default of the pad), "
     "disparity/16 (16ths of a pixel, range of each map), inverse, mm, m, or a number per metre "
     "such as 5000/m; NULL: for a file what it says itself"},
    {TEXT, READY, "invalid", AT(invalid), 0, 0, 0, NULL, NULL, "Invalid",
     "Samples of depth that hold no value, with commas: zero, max (255 or 65535), and numbers; in "
     "distances zero never does"},
    {INTEGER, READY, "threads", AT(threads), 0, 64, 0, NULL, NULL, "Threads",
     "Threads that render; 0: one for each processor. They do not change a byte"},
    {TRUTH, LIVE, "qos", AT(qos), 0, 0, TRUE, NULL, NULL, "QoS",
     "Leave out frames that would come too late, as elements downstream say"},
};

enum { ROWS = sizeof rows / sizeof *rows };

static GParamSpec *spec_of(const struct row *row)
{
    const GParamFlags flags =
        (GParamFlags)(row->flags | G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);

    switch (row->kind) {
    case NUMBER:
        return g_param_spec_double(row->name, row->nick, row->help, row->least, row->greatest,
                                   row->otherwise, flags);
    case INTEGER:
        return g_param_spec_int(row->name, row->nick, row->help, (gint)row->least,
                                (gint)row->greatest, (gint)row->otherwise, flags);
    case TRUTH:
        return g_param_spec_boolean(row->name, row->nick, row->help, row->otherwise != 0, flags);
    case CHOICE:
        return g_param_spec_enum(row->name, row->nick, row->help, row->choices(),
                                 (gint)row->otherwise, flags);
    case TEXT:
        break;
    }
    return g_param_spec_string(row->name, row->nick, row->help, row->text, flags);
}

void rf_gst_settings_install(GObjectClass *object_class)
{
    for (guint i = 0; i < ROWS; i++)
        g_object_class_install_property(object_class, i + 1, spec_of(&rows[i]));
    gst_type_mark_as_plugin_api(quality_type(), 0);
    gst_type_mark_as_plugin_api(method_type(), 0);
}

bool rf_gst_settings_have(guint id)
{
    return id >= 1 && id <= ROWS;
}

static void *member(const struct rf_gst_settings *settings, guint id)
{
    return (char *)settings + rows[id - 1].offset;
}

static void read_aperture(struct rf_gst_settings *settings)
{
    settings->shape_known = rf_gst_read_shape(settings->aperture, &settings->shape);
    settings->shape_number++;
}

void rf_gst_settings_begin(struct rf_gst_settings *settings)
{
    memset(settings, 0, sizeof *settings);
    for (guint i = 0; i < ROWS; i++) {
        void *const at = member(settings, i + 1);

        if (rows[i].kind == NUMBER)
            *(double *)at = rows[i].otherwise;
        else if (rows[i].kind == TEXT)
            *(char **)at = g_strdup(rows[i].text);
        else
            *(int *)at = (int)rows[i].otherwise;
    }
    read_aperture(settings);
}

void rf_gst_settings_copy(struct rf_gst_settings *copy, const struct rf_gst_settings *settings)
{
    *copy = *settings;
    for (guint i = 0; i < ROWS; i++)
        if (rows[i].kind == TEXT)
            *(char **)member(copy, i + 1) = g_strdup(*(char **)member(settings, i + 1));
}

void rf_gst_settings_end(struct rf_gst_settings *settings)
{
    for (guint i = 0; i < ROWS; i++)
        if (rows[i].kind == TEXT)
            g_free(*(char **)member(settings, i + 1));
}

void rf_gst_settings_set(struct rf_gst_settings *settings, guint id, const GValue *value)
{
    void *const at = member(settings, id);

    switch (rows[id - 1].kind) {
    case NUMBER:
        *(double *)at = g_value_get_double(value);
        break;
    case INTEGER:
        *(int *)at = g_value_get_int(value);
        break;
    case TRUTH:
        *(int *)at = g_value_get_boolean(value);
        break;
    case CHOICE:
        *(int *)at = g_value_get_enum(value);
        break;
    case TEXT:
        g_free(*(char **)at);
        *(char **)at = g_value_dup_string(value);
        break;
    }
    if (rows[id - 1].offset == AT(aperture))
        read_aperture(settings);
}

void rf_gst_settings_get(const struct rf_gst_settings *settings, guint id, GValue *value)
{
    const void *const at = member(settings, id);

    switch (rows[id - 1].kind) {
    case NUMBER:
        g_value_set_double(value, *(const double *)at);
        break;
    case INTEGER:
        g_value_set_int(value, *(const int *)at);
        break;
    case TRUTH:
        g_value_set_boolean(value, *(const int *)at);
        break;
    case CHOICE:
        g_value_set_enum(value, *(const int *)at);
        break;
    case TEXT:
        g_value_set_string(value, *(char *const *)at);
        break;
    }
}

/* The number behind a colon; false: something else is there. */
static bool read_part(const char **text, double *number)
{
    gchar *end;

    if (**text != ':' || !strchr("+-.0123456789", (*text)[1]) || (*text)[1] == '\0')
        return false;
    *number = g_ascii_strtod(*text + 1, &end);
    if (end == *text + 1 || !(*number >= -3600 && *number <= 3600))
        return false;
    *text = end;
    return true;
}

bool rf_gst_read_shape(const char *text, struct refocus_aperture_params *shape)
{
    double corners = 0, degrees = 0;

    *shape = refocus_aperture_params_default();
    if (!text || strcmp(text, "disc") == 0)
        return true;
    if (strcmp(text, "heart") == 0) {
        shape->figure = REFOCUS_FIGURE_HEART;
        return true;
    }
    if (g_str_has_prefix(text, "polygon:")) {
        text += strlen("polygon");
        if (!read_part(&text, &corners) || (*text && !read_part(&text, &degrees)))
            return false;
        shape->rotation_deg = degrees;
    } else if (g_str_has_prefix(text, "star")) {
        shape->figure = REFOCUS_FIGURE_STAR;
        text += strlen("star");
        corners = 5;
        if (*text && !read_part(&text, &corners))
            return false;
    } else {
        return false;
    }
    shape->blades = (int32_t)corners;
    return *text == '\0' && corners >= 3 && corners <= 16 && corners == (double)shape->blades;
}
