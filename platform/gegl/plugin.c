/* plugin.c: the plug-in that GEGL loads. */
#include "operation.h"

/* GEGL looks these up by name, and declares them in no header that a plug-in can include. */
G_MODULE_EXPORT const GeglModuleInfo *gegl_module_query(GTypeModule *module);
G_MODULE_EXPORT gboolean gegl_module_register(GTypeModule *module);

const GeglModuleInfo *gegl_module_query(GTypeModule *module)
{
    static const GeglModuleInfo info = {GEGL_MODULE_ABI_VERSION};

    (void)module;
    return &info;
}

gboolean gegl_module_register(GTypeModule *module)
{
    rf_gegl_operation_register(module);
    return TRUE;
}
