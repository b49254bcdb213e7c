/* plugin.h: the element under its name, for the plug-in and for programs that contain it. */
#ifndef RF_GSTREAMER_PLUGIN_H
#define RF_GSTREAMER_PLUGIN_H

#include <gst/gst.h>

gboolean rf_gst_register(GstPlugin *plugin);

#endif
