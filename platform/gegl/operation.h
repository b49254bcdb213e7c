/* operation.h: the operation `refocus:lens-blur`. */
#ifndef RF_GEGL_OPERATION_H
#define RF_GEGL_OPERATION_H

#include <gegl-plugin.h>

void rf_gegl_operation_register(GTypeModule *module);

#endif
