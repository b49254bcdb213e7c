/* settings.c: the properties of the operation are rows of a table. */
#include <stddef.h>
#include <string.h>
#include <gegl-plugin.h>
#include <refocus/refocus.h>
#include "settings.h"

enum kind { NUMBER, INTEGER, TRUTH, CHOICE };

/* Keys that tell a dialog what a number is: "unit", and for places "axis". */
enum meaning { PLAIN, PIXELS, DEGREES, COLUMN, ROW };

struct row {
    enum kind kind;
    const char *name;
    size_t offset;
    double least, greatest, otherwise;
    double most_shown, gamma; /* a slider's; 0: as far as it goes, evenly */
    enum meaning meaning;
    GType (*choices)(void);
    const char *nick, *help;
};

/* An enumeration that is registered once. Names are shown in dialogs, nicks are typed. */
static GType type_of(const char *name, const GEnumValue *values, gsize *type)
{
    if (g_once_init_enter(type))
        g_once_init_leave(type, g_enum_register_static(name, values));
    return *type;
}

static GType shape_type(void)
{
    static const GEnumValue values[] = {{RF_GEGL_DISC, "Disc", "disc"},
                                        {RF_GEGL_POLYGON, "Polygon of blades", "polygon"},
                                        {RF_GEGL_HEART, "Heart", "heart"},
                                        {RF_GEGL_STAR, "Star", "star"},
                                        {0, NULL, NULL}};
    static gsize type;

    return type_of("RefocusGeglAperture", values, &type);
}

static GType quality_type(void)
{
    static const GEnumValue values[] = {
        {0, "Preview: 32 rays a pixel", "preview"},
        {1, "Standard: 64 rays, thin structures", "standard"},
        {2, "Best: 128 rays, texture behind what is in front", "best"},
        {RF_GEGL_STILL, "Auto: standard, with up to 256 rays where the blur is large", "auto"},
        {0, NULL, NULL}};
    static gsize type;

    return type_of("RefocusGeglQuality", values, &type);
}

static GType unit_type(void)
{
    static const GEnumValue values[] = {{RF_GEGL_DISPARITY, "Near is white", "disparity"},
                                        {RF_GEGL_INVERSE, "Far is white", "inverse"},
                                        {RF_GEGL_METRES, "Metres", "m"},
                                        {0, NULL, NULL}};
    static gsize type;

    return type_of("RefocusGeglDepthUnit", values, &type);
}

static GType values_type(void)
{
    static const GEnumValue values[] = {{RF_GEGL_STORED, "As stored", "stored"},
                                        {RF_GEGL_PERCEPTUAL, "Perceptual", "perceptual"},
                                        {RF_GEGL_LINEAR, "Linear light", "linear"},
                                        {0, NULL, NULL}};
    static gsize type;

    return type_of("RefocusGeglDepthValues", values, &type);
}

static GType light_type(void)
{
    static const GEnumValue values[] = {{RF_GEGL_AUTO, "By what is above white", "auto"},
                                        {RF_GEGL_PHOTO, "Clipped at white", "photo"},
                                        {RF_GEGL_SCENE, "Light of the scene", "scene"},
                                        {0, NULL, NULL}};
    static gsize type;

    return type_of("RefocusGeglLight", values, &type);
}

#define AT(member) offsetof(struct rf_gegl_settings, member)

static const struct row rows[] = {
    {NUMBER, "focus", AT(focus), 0, 1, 0.5, 0, 0, PLAIN, NULL, "Focus",
     "Disparity in focus: 0 the farthest, 1 the nearest"},
    {NUMBER, "focus-x", AT(focus_x), -1, 1, -1, 0, 0, COLUMN, NULL, "Focus, column",
     "Focus on the surface at this place of the photo, 0 left to 1 right, in place of 'focus'; "
     "below 0: not. With focus-y"},
    {NUMBER, "focus-y", AT(focus_y), -1, 1, -1, 0, 0, ROW, NULL, "Focus, row",
     "See focus-x: 0 top to 1 bottom"},
    {NUMBER, "blur", AT(blur), 0, REFOCUS_MAX_BLUR_RADIUS, 20, 100, 1.5, PIXELS, NULL, "Blur",
     "Blur radius in pixels of what lies a disparity of 1 from the focus"},
    {NUMBER, "highlights", AT(highlights), 0, 16, 0, 0, 0, PLAIN, NULL, "Highlights",
     "Light given back to clipped highlights: below 1 as estimated from the photo, 1 none, above "
     "it as many times white. Light of a scene has lost none"},
    {NUMBER, "focus-width", AT(focus_width), 0, 1, 0, 0.25, 0, PLAIN, NULL, "Focus width",
     "Half the width of the band in focus, in disparity"},
    {NUMBER, "focus-transition", AT(focus_transition), -1, 1, -1, 0, 0, PLAIN, NULL,
     "Focus transition",
     "Disparity over which blur grows beside the band in focus to that of the lens; below 0: as "
     "much as focus-width"},
    {CHOICE, "aperture", AT(shape), 0, 0, RF_GEGL_DISC, 0, 0, PLAIN, shape_type, "Aperture",
     "The shape that a point of light takes"},
    {INTEGER, "blades", AT(blades), 3, 16, 6, 0, 0, PLAIN, NULL, "Blades",
     "Corners of a polygon, points of a star"},
    {NUMBER, "rotation", AT(rotation), -360, 360, 0, 0, 0, DEGREES, NULL, "Rotation",
     "Degrees that the aperture is turned by, counter-clockwise"},
    {NUMBER, "curvature", AT(curvature), 0, 1, 0, 0, 0, PLAIN, NULL, "Curvature",
     "Of the blades of a polygon: 0 straight, 1 round"},
    {NUMBER, "squeeze", AT(squeeze), 0.5, 2, 1, 0, 0, PLAIN, NULL, "Squeeze",
     "Width by height of the aperture; below 1 as of an anamorphic lens"},
    {NUMBER, "ring", AT(ring), 0, 0.9, 0, 0, 0, PLAIN, NULL, "Ring",
     "Radius of a stop in the middle of the aperture, as of a mirror lens"},
    {NUMBER, "edge", AT(edge), -1, 1, 0, 0, 0, PLAIN, NULL, "Edge",
     "Above 0 discs behind the focus have bright edges and those before it fade out, below 0 the "
     "other way round"},
    {NUMBER, "cat-eye", AT(cat_eye), 0, 0.9, 0, 0, 0, PLAIN, NULL, "Cat's eye",
     "How much of its width the aperture has lost in the corners of the photo"},
    {NUMBER, "fringe", AT(fringe), -0.5, 0.5, 0, 0, 0, PLAIN, NULL, "Fringe",
     "Longitudinal colour: by how much the blur of red and blue behind the focus, and of green "
     "before it, is smaller; below 0 the other way round"},
    {CHOICE, "quality", AT(quality), 0, 0, RF_GEGL_STILL, 0, 0, PLAIN, quality_type, "Quality",
     "Time against smoothness"},
    {CHOICE, "depth-unit", AT(unit), 0, 0, RF_GEGL_DISPARITY, 0, 0, PLAIN, unit_type, "Depth unit",
     "The meaning of the depth map: disparity (near is white), inverse (far is white), or m"},
    {CHOICE, "depth-values", AT(values), 0, 0, RF_GEGL_STORED, 0, 0, PLAIN, values_type,
     "Depth values",
     "The values that are read: as they are stored; perceptual, where an image of linear light "
     "holds a map out of a file of 8 or 16 bits; linear"},
    {NUMBER, "near", AT(near_m), 0, 1e6, 0, 100, 3, PLAIN, NULL, "Near",
     "Metres that disparity 1 stands for; 0: the nearest of the map. Of depth-unit m"},
    {NUMBER, "far", AT(far_m), 0, G_MAXDOUBLE, 0, 1000, 3, PLAIN, NULL, "Far",
     "Metres that disparity 0 stands for; 0: the farthest of the map. Of depth-unit m"},
    {TRUTH, "depth-edges", AT(place_edges), 0, 0, TRUE, 0, 0, PLAIN, NULL, "Depth edges",
     "Put edges of the depth that are soft, coarse or beside those of the photo onto them"},
    {CHOICE, "light", AT(light), 0, 0, RF_GEGL_AUTO, 0, 0, PLAIN, light_type, "Light",
     "Of photos of floats: photo, clipped at white, which has lost the light of its highlights; "
     "scene, whose light above white is all there; auto, scene if anything is above white"},
};

enum { ROWS = sizeof rows / sizeof *rows };

static GParamSpec *spec_of(const struct row *row)
{
    const GParamFlags flags =
        (GParamFlags)(G_PARAM_READWRITE | G_PARAM_CONSTRUCT | G_PARAM_STATIC_STRINGS |
                      (GParamFlags)GEGL_PARAM_PAD_INPUT);
    const double shown = row->most_shown > 0 ? row->most_shown : row->greatest;
    const double gamma = row->gamma > 0 ? row->gamma : 1;

    switch (row->kind) {
    case NUMBER:
        return gegl_param_spec_double(row->name, row->nick, row->help, row->least, row->greatest,
                                      row->otherwise, row->least, shown, gamma, flags);
    case INTEGER:
        return gegl_param_spec_int(row->name, row->nick, row->help, (gint)row->least,
                                   (gint)row->greatest, (gint)row->otherwise, (gint)row->least,
                                   (gint)shown, gamma, flags);
    case TRUTH:
        return g_param_spec_boolean(row->name, row->nick, row->help, row->otherwise != 0, flags);
    case CHOICE:
        break;
    }
    return gegl_param_spec_enum(row->name, row->nick, row->help, row->choices(),
                                (gint)row->otherwise, flags);
}

static void tell_meaning(GParamSpec *spec, enum meaning meaning)
{
    static const char *const units[] = {NULL, "pixel-distance", "degree", "relative-coordinate",
                                        "relative-coordinate"};

    if (units[meaning])
        gegl_param_spec_set_property_key(spec, "unit", units[meaning]);
    if (meaning == COLUMN || meaning == ROW)
        gegl_param_spec_set_property_key(spec, "axis", meaning == COLUMN ? "x" : "y");
}

void rf_gegl_settings_install(GObjectClass *object_class)
{
    for (guint i = 0; i < ROWS; i++) {
        GParamSpec *const spec = spec_of(&rows[i]);

        tell_meaning(spec, rows[i].meaning);
        g_object_class_install_property(object_class, i + 1, spec);
    }
}

static void *member(const struct rf_gegl_settings *settings, guint id)
{
    return (char *)settings + rows[id - 1].offset;
}

void rf_gegl_settings_begin(struct rf_gegl_settings *settings)
{
    memset(settings, 0, sizeof *settings);
    for (guint i = 0; i < ROWS; i++) {
        void *const at = member(settings, i + 1);

        if (rows[i].kind == NUMBER)
            *(double *)at = rows[i].otherwise;
        else
            *(int *)at = (int)rows[i].otherwise;
    }
}

void rf_gegl_settings_set(struct rf_gegl_settings *settings, guint id, const GValue *value)
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
    }
}

void rf_gegl_settings_get(const struct rf_gegl_settings *settings, guint id, GValue *value)
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
    }
}
