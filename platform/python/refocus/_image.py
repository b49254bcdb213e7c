"""Pictures: arrays of numpy, or other buffers, as the library sees them."""
import dataclasses
import typing

import numpy

from ._structs import Format, Matrix, Range, Transfer

#: Anything with rows of samples in memory: an array of numpy, of PyTorch on the CPU, a memoryview.
Buffer = typing.Any
#: Arrays that the package makes.
Array = numpy.ndarray[typing.Any, typing.Any]

_PACKED = {
    ('B', 3): Format.RGB8, ('B', 4): Format.RGBA8, ('H', 3): Format.RGB16, ('H', 4): Format.RGBA16,
    ('e', 3): Format.RGB_HALF, ('e', 4): Format.RGBA_HALF, ('f', 3): Format.RGB_FLOAT,
    ('f', 4): Format.RGBA_FLOAT}
_SHAPES = {form: (numpy.dtype(kind), channels) for (kind, channels), form in _PACKED.items()}
_SHAPES[Format.BGR8], _SHAPES[Format.BGRA8] = _SHAPES[Format.RGB8], _SHAPES[Format.RGBA8]
_YUV = {Format.NV12: ((1, 1, 1), (2, 2, 2)), Format.NV21: ((1, 1, 1), (2, 2, 2)),
        Format.I420: ((1, 1, 1), (2, 2, 1), (2, 2, 1)), Format.YUYV: ((1, 2, 4),),
        Format.P010: ((1, 1, 1), (2, 2, 2)), Format.P016: ((1, 1, 1), (2, 2, 2))}


@dataclasses.dataclass
class Image:
    """A picture in memory that stays the caller's: struct refocus_image.

    Each plane has `height` rows (of U and V fewer) of samples that follow each other; rows may lie
    any number of bytes apart, and upside down. Packed formats have one plane.
    """

    format: Format
    width: int
    height: int
    planes: tuple[Buffer, ...]
    matrix: Matrix = Matrix.BT601
    range: Range = Range.LIMITED
    transfer: Transfer = Transfer.DEFAULT
    gamma: float = 0.0
    white: float = 0.0

    @classmethod
    def empty(cls, format: Format, width: int, height: int, **fields: typing.Any) -> 'Image':
        """A picture whose planes are new arrays."""
        if format in _SHAPES:
            kind, channels = _SHAPES[format]
            return cls(format, width, height, (numpy.empty((height, width, channels), kind),),
                       **fields)
        kind = numpy.dtype('H' if format in (Format.P010, Format.P016) else 'B')
        planes = tuple(numpy.empty((-(-height // down), -(-width // across) * samples), kind)
                       for down, across, samples in _YUV[format])
        return cls(format, width, height, planes, **fields)

    def _empty_like(self, format: Format, width: int, height: int) -> 'Image':
        alike = {} if format in _SHAPES and self.format not in _SHAPES else {
            name: getattr(self, name) for name in ('matrix', 'range', 'transfer', 'gamma', 'white')}
        return Image.empty(format, width, height, **alike)

    def _tuple(self) -> tuple[typing.Any, ...]:
        return (int(self.format), self.width, self.height, tuple(self.planes), int(self.matrix),
                int(self.range), int(self.transfer), self.gamma, self.white)

    @property
    def array(self) -> Array:
        """The array of a packed picture."""
        if len(self.planes) != 1:
            raise ValueError(f'a picture in {self.format.name} has {len(self.planes)} planes')
        return numpy.asarray(self.planes[0])


def as_image(picture: 'Image | Buffer', order: str = 'rgb') -> Image:
    """An array of height x width x 3 or 4 samples as a picture, without a copy.

    uint8 and uint16 are sRGB, float16 and float32 linear light with 1 = white; other curves are
    told by an `Image`. `order` is that of the samples: 'rgb', or 'bgr' as OpenCV has it.
    """
    if isinstance(picture, Image):
        return picture
    view = memoryview(picture)
    shape = view.shape or ()
    form = _PACKED.get((view.format.lstrip('@='), shape[2])) if len(shape) == 3 else None
    if form is None:
        raise TypeError('a photo is an array of height x width x 3 or 4 of uint8, uint16, float16 '
                        f'or float32, not of {shape} of type {view.format!r}')
    if order not in ('rgb', 'bgr'):
        raise ValueError(f"order is 'rgb' or 'bgr', not {order!r}")
    if order == 'bgr':
        if form not in (Format.RGB8, Format.RGBA8):
            raise ValueError('pictures of more than 8 bits are R, G, B')
        form = Format.BGR8 if form == Format.RGB8 else Format.BGRA8
    return Image(form, shape[1], shape[0], (picture,))


def is_deep(image: Image) -> bool:
    """Whether a renderer needs `deep` for it."""
    return image.format >= Format.RGB16
