"""Depth maps: distances and disparities of any type become uint16, on the edges of a photo."""
import typing

import numpy

from . import _core
from ._errors import ArgumentError
from ._image import Buffer, Image, as_image
from ._struct import made
from ._structs import DepthEdgesReport, DepthReport

_DISPARITY, _DISTANCE = 1, 2
_ZERO, _MAX, _2047 = 1, 2, 4


def depth_to_disparity(depth: Buffer, unit: str = 'disparity', *, near_m: float = 0.0,
                       far_m: float = 0.0, speckle: int = 0, zero_is_unknown: bool | None = None,
                       max_is_unknown: bool = False, confidence: Buffer | None = None,
                       photo: Image | Buffer | None = None, order: str = 'rgb',
                       out: Buffer | None = None) -> tuple[typing.Any, DepthReport]:
    """Disparities of 16 bits, 65535 nearest, and what was found: refocus_depth_repair().

    `depth` is uint8, uint16 or float32. `unit` is, as on the command line, 'disparity' (bright =
    near), 'inverse' (dark = near), 'mm', 'm', or a number per metre such as '5000/m'. Integers of
    disparity span their type, floats and integers of 'disparity/16' (16ths of a pixel, or other
    parts) the least to the greatest value there is. In distances 0
    means unknown, unless `zero_is_unknown` says otherwise; NaN and infinity always do. Unknown
    samples, and patches of fewer than `speckle`, are filled, with a `photo` of that view, of 8 bits,
    from the surface that looks like them. `confidence` (uint8) receives 255 for samples as measured
    and 0 for filled ones.
    """
    view = memoryview(depth)
    near, far, metres = 0.0, 0.0, 0.0
    if unit in ('disparity', 'inverse'):
        near = {'B': 255.0, 'H': 65535.0}.get(view.format.lstrip('@='), 0.0)
        if unit == 'inverse' and near == 0:
            values = numpy.asarray(depth)
            known = values[numpy.isfinite(values)]
            near, far = (float(known.max()), float(known.min())) if known.size else (0.0, 0.0)
        if unit == 'inverse':
            near, far = far, near
    elif not _is_fixed_point(unit):
        metres = _metres_per_unit(unit)
    is_distance = metres > 0
    unknown = is_distance if zero_is_unknown is None else zero_is_unknown
    if view.ndim != 2:
        raise TypeError(f'a depth map has rows and columns, not {view.ndim} dimensions')
    if out is None:
        out = numpy.empty(view.shape or (), numpy.uint16)
    report = _core.depth_to_disparity(
        depth, out, _DISTANCE if is_distance else _DISPARITY,
        (_ZERO if unknown else 0) | (_MAX if max_is_unknown else 0), near, far, metres, near_m,
        far_m, speckle, confidence, None if photo is None else as_image(photo, order)._tuple())
    return out, made(DepthReport, report)


def _is_fixed_point(unit: str) -> bool:
    try:
        return unit.startswith('disparity/') and 0 < float(unit[10:]) < float('inf')
    except ValueError:
        return False


def _metres_per_unit(unit: str) -> float:
    if unit in ('mm', 'm'):
        return 0.001 if unit == 'mm' else 1.0
    try:
        count = float(unit.removesuffix('/m')) if unit.endswith('/m') else 0.0
    except ValueError:
        count = 0.0
    if not 0 < count < float('inf'):
        raise ArgumentError(f"unit is 'disparity', 'inverse', 'mm', 'm' or a number per metre such "
                            f"as '5000/m', not {unit!r}")
    return 1 / count


def upsample(photo: Image | Buffer, disparity: Buffer, *, confidence: Buffer | None = None,
             out: Buffer | None = None, order: str = 'rgb', threads: int = 0) -> typing.Any:
    """A map brought to the photo's size, its edges on the photo's: refocus_upsample()."""
    image = as_image(photo, order)
    if out is None:
        out = numpy.empty((image.height, image.width), numpy.uint16)
    _core.upsample(image._tuple(), disparity, out, threads, confidence)
    return out


def depth_edges(photo: Image | Buffer, disparity: Buffer, *, out: Buffer | None = None,
                order: str = 'rgb', threads: int = 0) -> tuple[typing.Any, DepthEdgesReport]:
    """The edges of a map where the photo has them, and what was found: refocus_depth_edges()."""
    image = as_image(photo, order)
    if out is None:
        out = numpy.empty((image.height, image.width), numpy.uint16)
    report = _core.depth_edges(image._tuple(), disparity, out, threads)
    return out, made(DepthEdgesReport, report)
