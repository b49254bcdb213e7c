"""Renderers, their settings, and the picture in one call."""
import math
import threading
import types
import typing

import numpy

from . import _core
from ._errors import ArgumentError, BusyError, StateError
from ._image import Buffer, Image, as_image, is_deep
from ._optics import disparity_of_depth, max_blur_radius
from ._struct import Struct, made
from ._structs import (
    ApertureParams, DepthEdges, DepthEdgesReport, DepthRange, DiffusionParams, FieldParams,
    FocusParams, Format, FoveatedParams, HighlightParams, Inpaint, InterpolatedParams, JitteredParams, Lens,
    LookParams, Method, RendererInfo, RendererParams, RenderParams, ScatterParams, SearchParams,
    ThinParams, View)


class Aperture:
    """The shape of the aperture; never changes, and may be shared by threads.

    Takes the fields of `ApertureParams`, or a `mask` of uint8: 255 = open, 0 = closed.

        refocus.Aperture(blades=6, rotation_deg=15)
    """

    def __init__(self, mask: Buffer | None = None, **fields: typing.Any) -> None:
        self.params = ApertureParams(**fields)
        self._handle = _core.aperture_create(vars(self.params), mask)

    def __copy__(self) -> 'Aperture':
        return self

    def __deepcopy__(self, memo: dict[int, typing.Any]) -> 'Aperture':
        return self


class Settings:
    """All parameters of a render: struct refocus_settings.

    `render` has those that every render needs; `look`, `focus` and so on one feature each.

        settings = refocus.Settings(0.8, 20, rays=128)
        settings.look.cat_eye = 0.5
        settings.focus = {'band': [(0.2, 0.1, 0.05)]}

    Further arguments are fields of `render`, or dictionaries of the fields of a feature.
    """

    render: RenderParams
    highlights: HighlightParams
    thin: ThinParams
    look: LookParams
    focus: FocusParams
    field: FieldParams
    search: SearchParams
    jittered: JitteredParams
    scatter: ScatterParams
    interpolated: InterpolatedParams
    foveated: FoveatedParams
    diffusion: DiffusionParams
    aperture: Aperture | None

    def __init__(self, focus_disparity: float = 0.0, max_blur_radius: float = 0.0, *,
                 aperture: Aperture | None = None, **fields: typing.Any) -> None:
        vars(self).update(
            render=RenderParams(focus_disparity=focus_disparity, max_blur_radius=max_blur_radius),
            field=FieldParams(disparity=focus_disparity), aperture=aperture,
            **{name: kind() for name, kind in self.__annotations__.items()
               if name not in ('render', 'field', 'aperture')})
        self.set(**fields)

    def set(self, **fields: typing.Any) -> None:
        """Set fields of `render`, or features by dictionaries or structs of their own."""
        for name, value in fields.items():
            setattr(self if name in vars(self) else self.render, name, value)

    def __setattr__(self, name: str, value: typing.Any) -> None:
        part = vars(self).get(name)
        if name not in vars(self):
            raise AttributeError(f'Settings has no {name}; it has {", ".join(vars(self))}'
                                 + (f', and render.{name}' if hasattr(self.render, name) else ''))
        if isinstance(part, Struct) and not isinstance(value, type(part)):
            part.set(**value)
        else:
            vars(self)[name] = value

    def _parts(self) -> dict[str, dict[str, typing.Any]]:
        return {name: vars(part) for name, part in vars(self).items() if isinstance(part, Struct)}


def _interruptibly(handle: typing.Any, function: typing.Callable[..., None],
                   *arguments: typing.Any) -> None:
    """Call a function of the renderer in a thread of its own, so that the main thread, which alone
    handles signals, sees a Ctrl-C at once and not when the library is done."""
    raised: list[BaseException] = []
    done = threading.Event()

    def work() -> None:
        try:
            function(handle, *arguments)
        except BaseException as error:
            raised.append(error)
        finally:
            done.set()

    if threading.current_thread() is not threading.main_thread():
        return function(handle, *arguments)
    try:
        threading.Thread(target=work).start()
    except RuntimeError:  # no thread can be had, as at the end of the interpreter
        return function(handle, *arguments)
    try:
        done.wait()
    except BaseException:  # a handler of signals raised it
        while not done.wait(0.05):
            _core.cancel(handle)
        raise
    if raised:
        raise raised.pop()


class Renderer:
    """Create once, prepare a photo, render as often as lens settings change.

    The arguments are fields of `RendererParams`. One thread at a time may call into a renderer
    (others get `BusyError`), but `cancel()`, which any may call; Python's lock is released while
    the library works, and Ctrl-C ends its work. A child by fork() cannot use the renderers of its
    parent, unless they have `threads=1`. Ends with `close()` or at the end of `with`.

        with refocus.Renderer(720, 540, max_blur_radius=20) as renderer:
            renderer.prepare(photo, disparity)
            near = renderer.render(refocus.Settings(0.9, 20))
            far = renderer.render(refocus.Settings(0.1, 20))
    """

    def __init__(self, max_width: int, max_height: int, max_blur_radius: float,
                 **fields: typing.Any) -> None:
        self.params = RendererParams(max_width=max_width, max_height=max_height,
                                     max_blur_radius=max_blur_radius, **fields)
        self._handle = _core.renderer_create(vars(self.params))
        self._photo: Image | None = None

    def __enter__(self) -> 'Renderer':
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: types.TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Stop the threads and free all memory; further calls raise `StateError`."""
        _core.renderer_destroy(self._handle)

    def prepare(self, photo: Image | Buffer, disparity: Buffer, *,
                depth_edges: DepthEdges = DepthEdges.AS_GIVEN, matte: Buffer | None = None,
                behind: Image | Buffer | None = None, behind_disparity: Buffer | None = None,
                confidence: Buffer | None = None, order: str = 'rgb') -> None:
        """Take in a photo and what is known of its depth: refocus_prepare_scene().

        `disparity` is uint8 or uint16 of any size, its greatest value nearest. Photos of more than
        8 bits and renderers with `in_place` read photo and map until the next scene: they must not
        change until then, and are kept.
        """
        image = as_image(photo, order)
        hidden = None if behind is None else as_image(behind, order)._tuple()
        try:
            _interruptibly(self._handle, _core.prepare_scene, image._tuple(), disparity,
                           int(depth_edges), matte, hidden, behind_disparity, confidence)
        except BusyError:
            raise  # the scene of before is still there
        except BaseException:
            self._photo = None
            raise
        # Its form alone: pixels are kept where they are needed, and only there.
        self._photo = Image(image.format, image.width, image.height, (), image.matrix, image.range,
                            image.transfer, image.gamma, image.white)

    prepare_scene = prepare

    def render(self, settings: Settings, out: Image | Buffer | None = None, *,
               order: str = 'rgb') -> typing.Any:
        """Refocus the prepared photo.

        Returns `out`, or without it a new array of the photo's type (a new `Image` of photos that
        are one of several planes), of the size of the region.
        """
        if out is not None:
            image = as_image(out, order)
        else:
            photo = self._form()
            part = settings.render
            image = photo._empty_like(photo.format, part.region_width or photo.width,
                                      part.region_height or photo.height)
            out = image.array if len(image.planes) == 1 else image
        aperture = settings.aperture._handle if settings.aperture else None
        _interruptibly(self._handle, _core.render, settings._parts(), aperture, image._tuple())
        return out

    def cancel(self) -> None:
        """End the prepare() or render() that runs in another thread early: `CancelledError`."""
        _core.cancel(self._handle)

    def get_view(self, view: View, out: Buffer | None = None) -> typing.Any:
        """A layer of the prepared photo: uint16, of its size."""
        photo = self._form()
        if out is None:
            out = numpy.empty((photo.height, photo.width), numpy.uint16)
        _core.get_view(self._handle, int(view), out, photo.width, photo.height)
        return out

    def get_depth_edges(self) -> DepthEdgesReport:
        """The findings of the last prepare() about the edges of its map."""
        return made(DepthEdgesReport, _core.get_depth_edges(self._handle))

    def get_info(self) -> RendererInfo:
        """Threads, instruction set and memory."""
        return made(RendererInfo, _core.get_info(self._handle))

    def _form(self) -> Image:
        if self._photo is None:
            _core.get_info(self._handle)  # raises if it is closed
            raise StateError('nothing is prepared; call prepare() first')
        return self._photo


def renderer_memory(max_width: int, max_height: int, max_blur_radius: float,
                    **fields: typing.Any) -> int:
    """Bytes that a renderer takes, all of them at its creation."""
    return _core.renderer_memory(vars(RendererParams(
        max_width=max_width, max_height=max_height, max_blur_radius=max_blur_radius, **fields)))


#: {name: (rays, thin structures, texture)}: as --quality of the command.
QUALITIES = {'preview': (32, 0, Inpaint.SMOOTH), 'standard': (64, 1, Inpaint.SMOOTH),
             'best': (128, 1, Inpaint.TEXTURED), 'auto': (64, 1, Inpaint.SMOOTH)}


def _rays_of(quality: str, blur: float, method: int) -> int:
    """Rays of a quality; 'auto' has those of `refocus_still_rays()` in refocus/params.h."""
    rays = QUALITIES[quality][0]
    if quality != 'auto' or method != Method.SWEEP:
        return rays
    return min(max(math.ceil(rays * blur * blur / 400), rays), 256)


def _has_grain(photo: Image, goal: Image | None) -> bool:
    """Whether the noise that blur averages away is put back: in 8 bits of R, G and B."""
    return all(image.format <= Format.BGRA8 for image in (photo, goal) if image is not None)


def _is_struct(value: typing.Any) -> bool:
    return isinstance(value, (Struct, dict))


def render(photo: Image | Buffer, depth: Buffer, *,
           focus: float | FocusParams | dict[str, typing.Any] | None = None,
           focus_at: tuple[int, int] | None = None, focus_distance: float | None = None,
           blur: float | None = None, f_number: float | None = None,
           focal_length_mm: float | None = None, sensor_width_mm: float | None = None,
           near_m: float = 0.0, far_m: float = 0.0, quality: str = 'auto',
           highlights: str | float | HighlightParams | dict[str, typing.Any] = 'auto',
           depth_edges: DepthEdges = DepthEdges.AUTO,
           matte: Buffer | None = None, confidence: Buffer | None = None,
           aperture: Aperture | None = None, out: Image | Buffer | None = None,
           order: str = 'rgb', threads: int = 0, **fields: typing.Any) -> typing.Any:
    """Refocus a photo, with the defaults of the command `refocus render`, to the same bytes.

    `depth` are disparities, uint8 or uint16, bright near; `depth_to_disparity()` makes them of
    distances and floats, and with `Photo.disparity()` the `confidence` that counts where a map is
    brought to the photo's size: 255 for samples as measured, 0 for guesses. One of `focus`
    (disparity, 0 farthest to 1), `focus_at` (a pixel, x and y) and `focus_distance` (metres) says
    what is sharp; `blur` (pixels) or `f_number` by how much the rest is not. Metres and f-numbers
    need `near_m` and `far_m`, the distances of disparities 1 and 0, and an f-number
    `focal_length_mm`: `sensor_width_mm` is what the width of the photo shows, by default so much
    that its larger side shows 36 mm. (The command takes the focal length of the file where none is
    given, `photo.info.focal_length_35mm`, as equal on the diagonal.) `highlights` is 'auto', 'off'
    or a gain. Where photo and result have 8 bits, noise is put back into what is blurred unless
    `look={'grain': 0}` leaves it out. Further arguments are those of `Settings`; structs and
    dictionaries for `focus` and `highlights` are, too: then `focus_disparity` can say what is
    sharp.
    """
    image = as_image(photo, order)
    if _is_struct(focus):
        fields['focus'], focus = focus, None
    if quality not in QUALITIES:
        raise ArgumentError(f'quality is one of {", ".join(QUALITIES)}, not {quality!r}')
    said = fields.pop('focus_disparity', None)
    if sum(given is not None for given in (focus, said, focus_at, focus_distance)) != 1:
        raise ArgumentError('give one of focus, focus_at and focus_distance')
    if focus_at is not None:
        x, y = focus_at
        if not (0 <= x < image.width and 0 <= y < image.height):
            raise ArgumentError(f'focus_at is {x}, {y}, may be 0, 0 to '
                                f'{image.width - 1}, {image.height - 1}')
    if (blur is None) == (f_number is None):
        raise ArgumentError('give blur or f_number')
    if f_number is not None:
        sensor_width = sensor_width_mm or 36.0 * image.width / max(image.width, image.height)
        blur = max_blur_radius(Lens(focal_length_mm=focal_length_mm or 0.0, f_number=f_number,
                                    sensor_width_mm=sensor_width),
                               DepthRange(near_m=near_m, far_m=far_m), image.width)
        if math.isnan(blur):
            raise ArgumentError('f_number needs near_m and far_m, 0 < near_m < far_m, and '
                                'focal_length_mm')
    if said is not None:
        focus = said
    if focus_distance is not None:
        focus = disparity_of_depth(DepthRange(near_m=near_m, far_m=far_m), focus_distance)
        if math.isnan(focus):
            raise ArgumentError('focus_distance needs near_m and far_m, 0 < near_m < far_m')
        focus = min(max(focus, 0.0), 1.0)
    assert blur is not None
    _, thin, inpaint = QUALITIES[quality]
    rays = _rays_of(quality, blur, fields.get('method', Method.SWEEP))
    goal = None if out is None else as_image(out, order)
    settings = Settings(0.0, blur, aperture=aperture, rays=rays, inpaint=inpaint,
                        thin={'enabled': thin}, look={'grain': int(_has_grain(image, goal))},
                        highlights=highlights if _is_struct(highlights) else
                        {'estimate': 1} if highlights == 'auto' else
                        {'gain': 1 if highlights == 'off' else highlights})
    settings.set(**fields)
    if settings.render.method not in iter(Method):
        raise ArgumentError(f'method is one of Method, not {settings.render.method!r}')
    method = int(settings.render.method)
    with Renderer(image.width, image.height, blur, threads=threads,
                  methods=1 << method, thin=int(settings.thin.enabled or matte is not None),
                  textured=int(settings.render.inpaint), depth_edges=int(depth_edges),
                  deep=int(is_deep(image) or (goal is not None and is_deep(goal)))) as renderer:
        if memoryview(depth).shape == (image.height, image.width):
            confidence = None  # a map of the photo's size is taken as it is
        renderer.prepare(image, depth, depth_edges=depth_edges, matte=matte, confidence=confidence)
        if focus_at is not None:
            focus = _core.focus_at(renderer.get_view(View.DISPARITY), *focus_at, 0)
        assert focus is not None
        settings.render.focus_disparity = focus
        if 'field' not in fields:
            settings.field.disparity = focus
        if goal is not None:
            renderer.render(settings, goal)
            return out
        return renderer.render(settings)


def method_name(method: Method) -> str:
    """Name of a method on the command line."""
    return _core.method_name(int(method))
