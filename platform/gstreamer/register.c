/* register.c: the element gets its name. */
#include "element.h"
#include "plugin.h"

gboolean rf_gst_register(GstPlugin *plugin)
{
    return gst_element_register(plugin, "refocus", GST_RANK_NONE, rf_gst_element_get_type());
}
