"""Photos with their depth from files, and pictures into files."""
import dataclasses
import os
import typing

import numpy

from . import _core
from ._errors import IoError, NoDepthError, NotFoundError
from ._image import Array, Buffer, Image, as_image
from ._struct import made
from ._structs import DepthReport, Format, PhotoInfo


class Photo:
    """A photo from a file, upright, with the depth it carries: struct refocus_photo.

    `image` is an array of uint8 (None of a depth file), `deep` of uint16 or float32 where the file
    has more than 8 bits; both are the library's own memory. `info` says what else the file states.
    `confidence`, a byte for each sample of its depth, is what the file says, and after disparity()
    0 for samples that were filled, too; None: all are as measured.
    """

    def __init__(self, handle: typing.Any) -> None:
        self._handle = handle
        parts = _core.photo_parts(handle)
        self.image = _array(parts['image'])
        self.deep = _array(parts['deep'])
        self.info = made(PhotoInfo, {**parts['info'], 'evidence': parts['evidence']})
        self.exif: bytes = parts['exif']
        self.icc: bytes = parts['icc']
        self._depth: tuple[int, int] | None = parts['depth']
        self._matte: tuple[int, int] | None = parts['matte']
        self.confidence: Array | None = None
        if parts['confidence'] is not None and self._depth:
            self.confidence = numpy.frombuffer(parts['confidence'],
                                               numpy.uint8).reshape(self._depth[::-1])

    @property
    def has_depth(self) -> bool:
        """Whether disparity() has something to give."""
        return self._depth is not None

    def disparity(self, photo: Image | Buffer | None = None,
                  order: str = 'rgb') -> tuple[Array, DepthReport]:
        """Its depth as disparities of 16 bits; `NoDepthError` when it carries none.

        Holes are filled by the colours of `photo`, a picture of that view of 8 bits: its own one if
        it has any. `confidence` then says which samples are guesses: give it to render() with the map.
        """
        sure = None if self._depth is None else numpy.empty(self._depth[::-1], numpy.uint8)
        if photo is None and self._lies_as_its_depth():
            photo = self.image
        out, report = self._map(self._depth, False, sure,
                                None if photo is None else as_image(photo, order)._tuple())
        if sure is not None and report.unknown + report.specks + report.strays > 0:
            self.confidence = sure if self.confidence is None else numpy.minimum(
                sure, self.confidence)
        return out, report

    def matte(self) -> Array:
        """How much of each pixel is subject, 65535 = all; `NoDepthError` when it has no matte."""
        return self._map(self._matte, True, None, None)[0]

    def _lies_as_its_depth(self) -> bool:
        if self.image is None or self._depth is None:
            return False
        height, width = self.image.shape[:2]
        return (width > height) == (self._depth[0] > self._depth[1])

    def _map(self, size: tuple[int, int] | None, is_matte: bool,
             confidence: Array | None,
             photo: tuple[typing.Any, ...] | None) -> tuple[Array, DepthReport]:
        if size is None:
            raise NoDepthError('the file has no ' + ('matte' if is_matte else 'depth'))
        out = numpy.empty(size[::-1], numpy.uint16)
        report = _core.photo_disparity(self._handle, is_matte, out, confidence, photo)
        return out, made(DepthReport, report)


def _array(part: tuple[typing.Any, int, int, int] | None) -> Array | None:
    if part is None:
        return None
    pixels, width, height, stride = part
    kind = {3: numpy.uint8, 6: numpy.uint16, 12: numpy.float32}[stride // width]
    return numpy.frombuffer(pixels, kind).reshape(height, width, 3)


def _read(function: typing.Callable[..., typing.Any], path: str | os.PathLike[str] | bytes,
          *arguments: typing.Any) -> Photo:
    try:
        return Photo(function(os.fsencode(path), *arguments))
    except IoError as error:
        if os.path.exists(path):
            raise
        raise NotFoundError(*error.args) from None


def photo_read(path: str | os.PathLike[str] | bytes, *, second: bool = False) -> Photo:
    """Read a photo; with `second` the other picture of a stereo file."""
    return _read(_core.photo_read, path, second)


def photo_read_memory(data: typing.Any) -> Photo:
    """Read a photo from the bytes of a file."""
    return Photo(_core.photo_read_memory(data))


def depth_read(path: str | os.PathLike[str] | bytes, unit: str | None = None, *,
               near_m: float = 0.0, far_m: float = 0.0) -> Photo:
    """Read a depth file of its own; `unit` as in depth_to_disparity(), None: what it says."""
    return _read(_core.depth_read, path, unit, near_m, far_m)


def image_write(path: str | os.PathLike[str] | bytes, image: Image | Buffer, *, quality: int = 0,
                keep: Photo | None = None, order: str = 'rgb') -> str:
    """Write a picture whole or not at all; the end of the name says how.

    Halves go into OpenEXR as they are, into PFM as floats.
    With `keep`, metadata of that photo is kept. Returns what had to be left out, in words.
    """
    picture = as_image(image, order)
    if picture.format == Format.RGB_HALF:  # files take floats, and those of halves round back
        picture = dataclasses.replace(picture, format=Format.RGB_FLOAT, planes=(
            picture.array.view(numpy.float16).reshape(picture.height, picture.width, 3).astype(
                numpy.float32),))
    return _core.image_write(os.fsencode(path), picture._tuple(), quality,
                             keep._handle if keep else None)


def gray16_write(path: str | os.PathLike[str] | bytes, samples: Buffer) -> None:
    """Write uint16 samples as greyscale: .png, .pgm or .pfm."""
    _core.gray16_write(os.fsencode(path), samples)


def file_formats() -> str:
    """Formats of this build, such as 'JPEG PNG HEIC PPM PGM PFM'."""
    return _core.file_formats()
