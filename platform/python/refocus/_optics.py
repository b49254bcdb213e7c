"""The thin lens: from millimetres and metres to pixels of blur, and what is in focus."""
from . import _core
from ._image import Buffer
from ._struct import made
from ._structs import DepthOfField, DepthRange, Lens


def _lens(lens: Lens) -> tuple[float, float, float]:
    return (lens.focal_length_mm, lens.f_number, lens.sensor_width_mm)


def _range(depths: DepthRange) -> tuple[float, float]:
    return (depths.near_m, depths.far_m)


def disparity_of_depth(depths: DepthRange, depth_m: float) -> float:
    """d = (1/z - 1/z1) / (1/z0 - 1/z1), not clamped; NaN for arguments out of their range."""
    return _core.disparity_of_depth(_range(depths), depth_m)


def depth_of_disparity(depths: DepthRange, disparity: float) -> float:
    """z of a disparity: the inverse; infinity where 1/z = 0."""
    return _core.depth_of_disparity(_range(depths), disparity)


def max_blur_radius(lens: Lens, depths: DepthRange, picture_width_px: float) -> float:
    """Largest blur radius in pixels: K = s R (1/z0 - 1/z1)."""
    return _core.max_blur_radius(_lens(lens), _range(depths), picture_width_px)


def f_number_of_blur(lens: Lens, depths: DepthRange, picture_width_px: float,
                     max_blur_radius_px: float) -> float:
    """The f-number whose largest blur radius that is: the inverse."""
    return _core.f_number_of_blur(_lens(lens), _range(depths), picture_width_px,
                                  max_blur_radius_px)


def hyperfocal_m(lens: Lens, acuity: float = 1000.0) -> float:
    """Hyperfocal distance in metres for an eye that resolves 1/acuity of a distance."""
    return _core.hyperfocal_m(_lens(lens), acuity)


def depth_of_field_m(focus_m: float, hyperfocal: float) -> DepthOfField:
    """Depths between which all looks sharp."""
    return made(DepthOfField, _core.depth_of_field_m(focus_m, hyperfocal))


def focus_at_point(disparity: Buffer, x: int, y: int, radius: int = 0) -> float:
    """The disparity of the surface that is tapped: refocus_focus_at_point()."""
    return _core.focus_at(disparity, x, y, radius)


def focus_in_rectangle(disparity: Buffer, x: int, y: int, width: int, height: int) -> float:
    """The disparity of a rectangle."""
    return _core.focus_at(disparity, x, y, width, height)
