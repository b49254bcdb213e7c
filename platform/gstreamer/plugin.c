/* plugin.c: the plug-in that GStreamer loads. */
#include "plugin.h"

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, refocus,
                  "Shallow depth of field after the shot, by librefocus", rf_gst_register,
                  PACKAGE_VERSION, "MIT/X11", "librefocus", "Unknown package origin")
