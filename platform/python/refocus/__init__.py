"""Refocus photos by their depth: librefocus for Python.

    import numpy, refocus

    picture = refocus.render(photo, disparity, focus=0.8, blur=20)

Names, units and ranges are those of the library's headers: refocus_prepare() is
`Renderer.prepare()`, struct refocus_look_params is `LookParams`. Photos are arrays of height x
width x 3 or 4, of uint8, uint16, float16 or float32, or an `Image` of any format of the library;
nothing is copied on the way in or out. Errors are subclasses of `Error`, with the words of the library.
"""
from . import _core
from ._depth import depth_edges, depth_to_disparity, upsample
from ._errors import (
    AccessError, ArgumentError, BusyError, CancelledError, Error, FormatError, IoError,
    NoDepthError, NotFoundError, OutOfMemoryError, SizeError, StateError, ThreadError,
    UnsupportedError)
from ._files import (
    Photo, depth_read, file_formats, gray16_write, image_write, photo_read, photo_read_memory)
from ._image import Image, as_image
from ._optics import (
    depth_of_disparity, depth_of_field_m, disparity_of_depth, f_number_of_blur, focus_at_point,
    focus_in_rectangle, hyperfocal_m, max_blur_radius)
from ._render import Aperture, Renderer, Settings, method_name, render, renderer_memory
from ._structs import *  # noqa: F403  (all structs and enums of the headers)
from ._structs import __all__ as _structs_all

#: Version of the library.
__version__ = _core.version()
#: Rays: every pixel of the aperture mask.
RAYS_FULL = -1

__all__ = [
    'AccessError', 'Aperture', 'ArgumentError', 'BusyError', 'CancelledError', 'Error',
    'FormatError', 'Image', 'IoError', 'NoDepthError', 'NotFoundError', 'OutOfMemoryError', 'Photo',
    'RAYS_FULL', 'Renderer', 'Settings', 'SizeError', 'StateError', 'ThreadError', 'UnsupportedError',
    'as_image', 'depth_edges', 'depth_of_disparity', 'depth_of_field_m', 'depth_read',
    'depth_to_disparity', 'disparity_of_depth', 'f_number_of_blur', 'file_formats',
    'focus_at_point', 'focus_in_rectangle', 'gray16_write', 'hyperfocal_m', 'image_write',
    'max_blur_radius', 'method_name', 'photo_read', 'photo_read_memory', 'render',
    'renderer_memory', 'upsample', *_structs_all]
