/** @file refocus.h  The whole core API of librefocus. */
#ifndef REFOCUS_REFOCUS_H
#define REFOCUS_REFOCUS_H

#include <refocus/aperture.h>
#include <refocus/depth.h>
#include <refocus/depth_edges.h>
#include <refocus/focus.h>
#include <refocus/image.h>
#include <refocus/lens.h>
#include <refocus/measure.h>
#include <refocus/methods.h>
#include <refocus/params.h>
#include <refocus/render.h>
#include <refocus/scene.h>
#include <refocus/settings.h>
#include <refocus/sized.h>
#include <refocus/stack.h>
#include <refocus/status.h>
#include <refocus/temporal.h>
#include <refocus/version.h>

#endif
