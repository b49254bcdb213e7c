/* operation.c: the operation takes a photo and its depth map through the graph of GEGL. */
#include <stdlib.h>
#include "operation.h"
#include "picture.h"
#include "settings.h"
#include "shot.h"

typedef struct {
    GeglOperationComposer parent;
    struct rf_gegl_settings settings;
    struct rf_gegl_format format;
    gboolean told; /* the user, that there is no depth map */
} RefocusLensBlur;

typedef struct {
    GeglOperationComposerClass parent_class;
} RefocusLensBlurClass;

static const char type_name[] = "RefocusLensBlur";

static RefocusLensBlur *self_of(gpointer object)
{
    return object;
}

/* Messages of this level and domain are those that GIMP shows. */
static void tell(const char *why)
{
    g_log("GEGL", G_LOG_LEVEL_MESSAGE, "refocus:lens-blur: %s", why);
}

static GeglRectangle extent_of(GeglOperation *operation, const char *pad)
{
    const GeglRectangle *const extent = gegl_operation_source_get_bounding_box(operation, pad);

    return extent ? *extent : *GEGL_RECTANGLE(0, 0, 0, 0);
}

static void prepare(GeglOperation *operation)
{
    RefocusLensBlur *const self = self_of(operation);
    const Babl *const photo = gegl_operation_get_source_format(operation, "input");
    const Babl *const depth = gegl_operation_get_source_format(operation, "aux");

    self->format = rf_gegl_format_of(photo, gegl_operation_get_source_space(operation, "input"));
    gegl_operation_set_format(operation, "input", self->format.babl);
    if (depth)
        gegl_operation_set_format(operation, "aux", depth);
    gegl_operation_set_format(operation, "output", self->format.babl);
}

static GeglRectangle get_bounding_box(GeglOperation *operation)
{
    return extent_of(operation, "input");
}

/* Any pixel may be blurred over any other, and the edges of the depth map be moved. */
static GeglRectangle get_invalidated_by_change(GeglOperation *operation, const gchar *pad,
                                               const GeglRectangle *changed)
{
    (void)pad, (void)changed;
    return extent_of(operation, "input");
}

/* A photo without an end goes through, and no more of it is made than is wanted. */
static GeglRectangle get_required_for_output(GeglOperation *operation, const gchar *pad,
                                             const GeglRectangle *wanted)
{
    const GeglRectangle photo = extent_of(operation, "input"), extent = extent_of(operation, pad);

    if (gegl_rectangle_is_infinite_plane(&photo))
        return *wanted;
    return gegl_rectangle_is_infinite_plane(&extent) ? photo : extent;
}

/* A pass over the whole photo costs as much as one for each part of it. */
static GeglRectangle get_cached_region(GeglOperation *operation, const GeglRectangle *wanted)
{
    const GeglRectangle extent = extent_of(operation, "input");

    return gegl_rectangle_is_infinite_plane(&extent) ? *wanted : extent;
}

static gboolean is_too_large(const GeglRectangle *size)
{
    return size->width > REFOCUS_MAX_SIDE || size->height > REFOCUS_MAX_SIDE;
}

/* A map without an end, as that of one colour, is taken where the photo is. */
static GeglRectangle depth_extent(GeglOperation *operation, const GeglRectangle *whole)
{
    const GeglRectangle extent = extent_of(operation, "aux");

    return gegl_rectangle_is_infinite_plane(&extent) ? *whole : extent;
}

static int count_threads(void)
{
    gint threads = 0;

    g_object_get(gegl_config(), "threads", &threads, NULL);
    return CLAMP(threads, 0, 64);
}

static gboolean render(RefocusLensBlur *self, GeglBuffer *photo, GeglBuffer *depth,
                       GeglBuffer *output, const GeglRectangle *whole, const GeglRectangle *map,
                       const GeglRectangle *part)
{
    char why[RF_GEGL_WORDS] = "not enough memory";
    struct rf_gegl_picture picture = {0};
    struct rf_gegl_shot shot = {&self->settings,    &picture.photo,     NULL,
                                map->width,         map->height,        count_threads(),
                                part->x - whole->x, part->y - whole->y, &picture.out};
    float *const samples =
        rf_gegl_depth_read(depth, map, (enum rf_gegl_values)self->settings.values);
    gboolean done = FALSE;

    shot.depth = samples;
    if (samples && rf_gegl_picture_read(&picture, photo, whole, part, &self->format,
                                        (enum rf_gegl_light)self->settings.light))
        done = rf_gegl_shot_take(&shot, why) == REFOCUS_OK;
    if (done)
        gegl_buffer_set(output, part, 0, self->format.babl, picture.out.plane[0],
                        (gint)picture.out.stride[0]);
    else
        tell(why);
    rf_gegl_picture_free(&picture);
    free(samples);
    return done;
}

/* The reason why there is nothing to do, in words; NULL: there is. */
static const char *refuse(RefocusLensBlur *self, const GeglRectangle *whole,
                          const GeglRectangle *map, GObject *depth)
{
    static const char no_depth[] =
        "choose a depth map as aux input; without one nothing is blurred";
    const gboolean told = self->told;

    self->told = !depth || map->width < 1 || map->height < 1;
    if (self->told)
        return told ? "" : no_depth;
    if (gegl_rectangle_is_infinite_plane(whole))
        return "the photo has no end; crop it first";
    if (is_too_large(whole) || is_too_large(map))
        return "the photo or its depth map has a side of more than 65535 pixels";
    return NULL;
}

/* A photo that cannot be refocused goes through as it is. */
static gboolean process(GeglOperation *operation, GeglOperationContext *context, const gchar *pad,
                        const GeglRectangle *part, gint level)
{
    RefocusLensBlur *const self = self_of(operation);
    GObject *const photo = gegl_operation_context_get_object(context, "input");
    GObject *const depth = gegl_operation_context_get_object(context, "aux");
    const GeglRectangle whole = extent_of(operation, "input");
    const GeglRectangle map = depth_extent(operation, &whole);
    const char *why;

    (void)level;
    if (!photo)
        return FALSE;
    why = refuse(self, &whole, &map, depth);
    if (why && *why)
        tell(why);
    if (why || !render(self, GEGL_BUFFER(photo), GEGL_BUFFER(depth),
                       gegl_operation_context_get_target(context, pad), &whole, &map, part))
        gegl_operation_context_take_object(context, pad, g_object_ref(photo));
    return TRUE;
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    (void)spec;
    rf_gegl_settings_set(&self_of(object)->settings, id, value);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    (void)spec;
    rf_gegl_settings_get(&self_of(object)->settings, id, value);
}

static void class_init(gpointer class, gpointer data)
{
    GObjectClass *const object_class = G_OBJECT_CLASS(class);
    GeglOperationClass *const operation_class = GEGL_OPERATION_CLASS(class);
    GeglOperationComposerClass *const composer_class = GEGL_OPERATION_COMPOSER_CLASS(class);

    (void)data;
    object_class->set_property = set_property;
    object_class->get_property = get_property;
    rf_gegl_settings_install(object_class);
    operation_class->prepare = prepare;
    operation_class->process = process;
    operation_class->get_bounding_box = get_bounding_box;
    operation_class->get_invalidated_by_change = get_invalidated_by_change;
    operation_class->get_required_for_output = get_required_for_output;
    operation_class->get_cached_region = get_cached_region;
    composer_class->aux_label = "Depth map";
    composer_class->aux_description = "Depth of the photo; see depth-unit";
    operation_class->threaded = FALSE;
    operation_class->opencl_support = FALSE;
    gegl_operation_class_set_keys(
        operation_class, "name", "refocus:lens-blur", "title", "Refocus", "categories", "blur",
        "description",
        "Refocus a photo by a depth map: the blur of a real lens, with the surfaces that hide each "
        "other kept apart and the light of highlights given back",
        NULL);
}

static void instance_init(GTypeInstance *instance, gpointer class)
{
    (void)class;
    rf_gegl_settings_begin(&self_of(instance)->settings);
}

/* A second copy of the plug-in, as one in a build beside the one that is installed, leaves the
 * operation to the first on GEGL's path; GObject would leave it there too, with a warning. */
static gboolean is_anothers(GTypeModule *module)
{
    const GType type = g_type_from_name(type_name);

    return type && g_type_get_plugin(type) != G_TYPE_PLUGIN(module);
}

void rf_gegl_operation_register(GTypeModule *module)
{
    const GTypeInfo info = {
        .class_size = sizeof(RefocusLensBlurClass),
        .class_init = class_init,
        .instance_size = sizeof(RefocusLensBlur),
        .instance_init = instance_init,
    };

    if (is_anothers(module))
        return;
    g_type_module_register_type(module, GEGL_TYPE_OPERATION_COMPOSER, type_name, &info,
                                (GTypeFlags)0);
}
