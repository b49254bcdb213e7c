#!/usr/bin/env python3
"""The package refocus for Python: the command's bytes, no copies, no leaks, errors in words.

usage: test_python.py FOLDER_OF_THE_PACKAGE [REFOCUS]
"""
import dataclasses
import gc
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

sys.path.insert(0, sys.argv[1])
import numpy  # noqa: E402
import refocus  # noqa: E402

COMMAND = sys.argv[2] if len(sys.argv) > 2 else None
DATA = pathlib.Path(__file__).resolve().parents[2] / 'examples/data'
WIDTH, HEIGHT, BLUR = 96, 64, 9


def scene():
    """A small photo with texture and two lamps, and its disparities."""
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    photo = numpy.stack([(x * 7 + y * 3) % 256, (x * 2 + y * 11) % 256, (x * y) % 256], 2)
    photo[10:14, 20:24] = photo[40:43, 70:73] = 255
    disparity = numpy.where((x > 30) & (x < 60) & (y > 15), 60000, 9000 + 100 * y)
    return photo.astype(numpy.uint8), disparity.astype(numpy.uint16)


def picture_of(photo, disparity, out=None, order='rgb', blur=BLUR, **fields):
    planes = photo.planes if isinstance(photo, refocus.Image) else [photo]
    deep = int(memoryview(planes[0]).itemsize > 1)
    with refocus.Renderer(WIDTH, HEIGHT, BLUR, threads=2, deep=deep) as renderer:
        renderer.prepare(photo, disparity, order=order)
        return renderer.render(refocus.Settings(0.9, blur, **fields), out, order=order)


class Case(unittest.TestCase):
    def setUp(self):
        self.photo, self.disparity = scene()
        self.expected = picture_of(self.photo, self.disparity)

    def same(self, a, b):
        self.assertTrue(numpy.array_equal(a, b))


class Pictures(Case):
    @unittest.skipUnless(COMMAND, 'no command in this build')
    def test_the_bytes_of_the_command(self):
        folder = DATA / 'nightlights'
        photo = refocus.photo_read(folder / 'allfocus.png').image
        for name, options, arguments in (
                ('disparity.png', ['--focus', '0.966'], {'focus': 0.966}),
                ('disparity.png', ['--focus-at', '200,300', '--aperture', 'polygon:6:15'],
                 {'focus_at': (200, 300),
                  'aperture': refocus.Aperture(blades=6, rotation_deg=15)})):
            with self.subTest(options), tempfile.TemporaryDirectory() as temporary:
                out = pathlib.Path(temporary) / 'out.ppm'
                subprocess.run([COMMAND, 'render', folder / 'allfocus.png', '--depth',
                                folder / name, '--blur', '12', *options, '-o', out], check=True)
                depth = refocus.depth_read(folder / name).disparity()[0]
                self.same(refocus.photo_read(out).image,
                          refocus.render(photo, depth, blur=12, **arguments))

    @unittest.skipUnless(COMMAND, 'no command in this build')
    def test_the_noise_of_the_command(self):
        noise = numpy.random.default_rng(5).normal(120, 4, (120, 160, 1))
        photo = numpy.repeat(noise.round().astype(numpy.uint8), 3, 2)
        disparity = numpy.where(numpy.arange(160) < 80, 10280, 51400).astype(numpy.uint16)
        disparity = numpy.tile(disparity, (120, 1))
        expected = {}
        with tempfile.TemporaryDirectory() as temporary:
            noisy, depth, out = (pathlib.Path(temporary) / name
                                 for name in ('noisy.ppm', 'noisy.pgm', 'out.ppm'))
            refocus.image_write(noisy, photo)
            refocus.gray16_write(depth, disparity)
            for options in (), ('--grain', 'off'), ('--fringe', '0.2'):
                subprocess.run([COMMAND, 'render', noisy, '--depth', depth, '--focus', '1',
                                '--blur', '12', *options, '-o', out], check=True)
                expected[options] = refocus.photo_read(out).image.copy()

        def rendered(picture=photo, **fields):
            return refocus.render(picture, disparity, focus=1, blur=12, **fields)
        self.same(rendered(), expected[()])
        self.same(rendered(look={'fringe': 0.2}), expected['--fringe', '0.2'])
        for plain in {'look': {'grain': 0}}, {'look': refocus.LookParams()}:
            self.same(rendered(**plain), expected['--grain', 'off'])
        self.assertGreater(numpy.mean(expected[()] != expected['--grain', 'off']), 0.4)
        alpha = numpy.full((120, 160, 1), 255, numpy.uint8)
        self.same(rendered(numpy.concatenate([photo, alpha], 2))[:, :, :3], expected[()])
        deep = photo.astype(numpy.uint16) * 257  # deep photos and frames have none
        self.same(rendered(deep), rendered(deep, look={'grain': 0}))
        frame = refocus.Image.empty(refocus.Format.NV12, 160, 120)
        frame.planes[0][:], frame.planes[1][:] = photo[:, :, 0], 128
        self.assertEqual(rendered(frame).format, refocus.Format.NV12)

    def test_rows_anywhere_in_memory(self):
        wide = numpy.zeros((HEIGHT, WIDTH + 5, 3), numpy.uint8)
        wide[:, 2:2 + WIDTH] = self.photo
        self.same(picture_of(wide[:, 2:2 + WIDTH], self.disparity), self.expected)
        upside = self.photo[::-1].copy()[::-1]
        self.assertLess(upside.strides[0], 0)
        self.same(picture_of(upside, self.disparity[::-1].copy()[::-1]), self.expected)
        out = numpy.full((HEIGHT, WIDTH + 5, 3), 7, numpy.uint8)
        part = out[:, 1:1 + WIDTH]
        self.assertIs(picture_of(self.photo, self.disparity, part), part)
        self.same(part, self.expected)
        self.assertTrue((out[:, 0] == 7).all() and (out[:, 1 + WIDTH:] == 7).all())

    def test_orders_and_other_buffers(self):
        bgr = self.photo[:, :, ::-1].copy()
        self.same(picture_of(bgr, self.disparity, order='bgr')[:, :, ::-1], self.expected)
        alpha = numpy.full((HEIGHT, WIDTH, 1), 77, numpy.uint8)
        rgba = picture_of(numpy.concatenate([self.photo, alpha], 2), self.disparity)
        self.same(rgba[:, :, :3], self.expected)
        self.assertTrue((rgba[:, :, 3] == 77).all())
        plain = refocus.Image(refocus.Format.RGB8, WIDTH, HEIGHT,
                              (memoryview(self.photo.tobytes()).cast('B', (HEIGHT, 3 * WIDTH)),))
        self.same(picture_of(plain, self.disparity), self.expected)

    def test_deep_photos(self):
        for kind, one in (('uint16', 65535), ('float16', 1), ('float32', 1)):
            photo = (self.photo / 255 * one).astype(kind)
            out = picture_of(photo, self.disparity)
            self.assertEqual((out.dtype, out.shape), (photo.dtype, photo.shape))
            sharp = picture_of(photo, self.disparity, blur=0)
            self.same(sharp, photo)
        linear = refocus.Image(refocus.Format.RGB_FLOAT, WIDTH, HEIGHT, (photo,))
        self.differs(linear, white=0.5)
        self.differs(linear, transfer=refocus.Transfer.SRGB)
        linear.transfer = refocus.Transfer.GAMMA
        self.differs(linear, gamma=1.8)
        out = numpy.empty((HEIGHT, WIDTH, 3), numpy.uint8)
        picture_of((self.photo.astype(numpy.uint16) * 257), self.disparity, out, dither=1)
        difference = numpy.abs(out.astype(int) - self.expected)
        self.assertLessEqual(numpy.mean(difference), 0.6)

    def test_frames_of_cameras(self):
        frame = refocus.Image.empty(refocus.Format.NV12, WIDTH, HEIGHT)
        luma, chroma = frame.planes
        luma[:], chroma[:] = self.photo[:, :, 1], 128
        out = picture_of(frame, self.disparity)
        self.assertEqual(out.format, refocus.Format.NV12)
        self.assertTrue((out.planes[1] == 128).all())
        self.assertGreater(numpy.mean(numpy.abs(out.planes[0].astype(int) - luma)), 3)
        chroma[:, ::2] = 90
        self.differs(frame, matrix=refocus.Matrix.BT709)
        self.differs(frame, range=refocus.Range.FULL)

    def differs(self, image, **fields):
        """Whether what a picture says of its values counts."""
        one, other = (picture_of(each, self.disparity)
                      for each in (image, dataclasses.replace(image, **fields)))
        self.assertFalse(numpy.array_equal(getattr(one, 'planes', [one])[0],
                                           getattr(other, 'planes', [other])[0]))

    def test_settings(self):
        settings = refocus.Settings(0.9, BLUR, rays=16, look={'cat_eye': 0.5})
        self.assertEqual((settings.render.rays, settings.look.cat_eye), (16, 0.5))
        with refocus.Renderer(WIDTH, HEIGHT, BLUR) as renderer:
            renderer.prepare(self.photo, self.disparity)
            other = renderer.render(settings)
            self.assertFalse(numpy.array_equal(other, self.expected))
            # The defaults are the library's: written out, they change nothing.
            self.same(renderer.render(refocus.Settings(0.9, BLUR)), self.expected)
            settings = refocus.Settings(0.9, BLUR, region_x=8, region_y=4, region_width=40,
                                        region_height=20)
            self.same(renderer.render(settings), self.expected[4:24, 8:48])
            sharp = refocus.Settings(0.9, BLUR, focus={
                'sharp_map': numpy.full((2, 2), 255, numpy.uint8)})
            self.same(renderer.render(sharp), self.photo)
            self.assertEqual(renderer.get_view(refocus.View.BLUR).max(), 0)
            # Slopes in few codes are made smooth.
            prepared = renderer.get_view(refocus.View.DISPARITY).astype(int)
            self.assertLess(numpy.abs(prepared - self.disparity).max(), 100)
            bands = refocus.Settings(0.9, BLUR, focus={'band': [(0.2, 0.2, 0.0)]})
            self.assertFalse(numpy.array_equal(renderer.render(bands), self.expected))
            heart = refocus.Settings(0.9, BLUR, aperture=refocus.Aperture(
                figure=refocus.Figure.HEART))
            self.assertFalse(numpy.array_equal(renderer.render(heart), self.expected))
            self.assertGreaterEqual(renderer.get_info().threads, 1)
            self.assertLessEqual(renderer.get_info().memory,
                                 refocus.renderer_memory(WIDTH, HEIGHT, BLUR))

    def test_other_methods(self):
        for method in refocus.Method:
            with self.subTest(refocus.method_name(method)):
                out = refocus.render(self.photo, self.disparity, focus=0.9, blur=4,
                                     highlights='off', quality='preview', method=method)
                self.assertFalse(numpy.array_equal(out, self.photo))


class Depth(Case):
    def test_distances(self):
        metres = numpy.linspace(1, 4, WIDTH * HEIGHT, dtype=numpy.float32).reshape(HEIGHT, WIDTH)
        metres[3, 3] = math.nan
        disparity, report = refocus.depth_to_disparity(metres, 'm')
        self.assertEqual((disparity[0, 0], disparity[-1, -1]), (65535, 0))
        self.assertEqual((report.near_m, report.far_m, report.unknown), (1, 4, 1))
        one_row = numpy.linspace(1, 4, 20000, dtype=numpy.float32)[None]
        self.assertEqual(refocus.depth_to_disparity(one_row, 'm')[0][0, 0], 65535)
        millimetres = (metres * 1000).round()
        millimetres[3, 3] = 0
        again = refocus.depth_to_disparity(millimetres.astype(numpy.uint16), 'mm')[0]
        self.assertLess(numpy.abs(again.astype(int) - disparity).max(), 70)
        inverse = refocus.depth_to_disparity(255 - (disparity >> 8).astype(numpy.uint8),
                                             'inverse')[0]
        self.same(inverse >> 8, disparity >> 8)
        low, high = (refocus.depth_to_disparity(values, unit)[0] for values, unit in (
            (metres, 'inverse'), (-metres, 'disparity')))
        self.same(low, high)
        low, high = (refocus.depth_to_disparity(millimetres.astype(kind), unit)[0]
                     for kind, unit in (('f', 'disparity'), ('H', 'disparity/16')))
        self.same(low, high)

    def test_holes_take_the_surface_that_looks_like_them(self):
        near, hole = numpy.s_[:, 30:60], numpy.s_[10:30, 26:40]
        metres = numpy.full((HEIGHT, WIDTH), 4, numpy.float32)
        metres[near] = 1
        photo = numpy.full((HEIGHT, WIDTH, 3), 40, numpy.uint8)
        photo[near] = 200
        whole = refocus.depth_to_disparity(metres, 'm')[0]
        metres[hole] = math.nan
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'depth.npy')
            numpy.save(path, metres)
            depth = refocus.depth_read(path, 'm')
            small = photo[::2, ::3].copy()
            far = whole.copy()
            far[hole] = 0
            for given, order, wanted in ((photo, 'rgb', whole), (small, 'bgr', whole),
                                         (None, 'rgb', far)):
                self.same(refocus.depth_to_disparity(metres, 'm', photo=given, order=order)[0],
                          wanted)
                self.same(depth.disparity(given, order)[0], wanted)
            for of in (lambda: refocus.depth_to_disparity(metres, 'm', photo=photo.astype('H')),
                       lambda: depth.disparity(photo.astype('H'))):
                self.assertRaises(refocus.UnsupportedError, of)

    def test_upsampling_and_edges(self):
        small = self.disparity[::4, ::4].copy()
        clean = refocus.upsample(self.photo, small)
        self.assertEqual(clean.shape, (HEIGHT, WIDTH))
        small[2:4, 2:4], sure = 65535, numpy.full(small.shape, 255, numpy.uint8)
        sure[2:4, 2:4] = 0
        for confidence, least, most in ((None, 40000, 60000), (sure, 0, 600)):
            off = refocus.upsample(self.photo, small, confidence=confidence)[8:16, 8:16] - \
                clean[8:16, 8:16].astype(int)
            self.assertTrue(least <= off.mean() <= most, off.mean())
        placed, report = refocus.depth_edges(self.photo, self.disparity)
        self.assertEqual(placed.shape, (HEIGHT, WIDTH))
        self.assertGreaterEqual(report.on_photo, 0)
        self.assertAlmostEqual(refocus.focus_at_point(self.disparity, 45, 40), 60000 / 65535, 3)
        self.assertAlmostEqual(refocus.focus_in_rectangle(self.disparity, 40, 30, 5, 5),
                               60000 / 65535, 3)

    def test_lenses(self):
        lens = refocus.Lens(focal_length_mm=50, f_number=2, sensor_width_mm=36)
        depths = refocus.DepthRange(near_m=1, far_m=10)
        blur = refocus.max_blur_radius(lens, depths, 1000)
        self.assertAlmostEqual(blur, 1000 * 50 / 36 * 0.0125 * 0.9, 6)
        self.assertAlmostEqual(refocus.f_number_of_blur(lens, depths, 1000, blur), 2)
        self.assertAlmostEqual(refocus.depth_of_disparity(
            depths, refocus.disparity_of_depth(depths, 3)), 3)
        self.assertGreater(refocus.depth_of_field_m(3, refocus.hyperfocal_m(lens)).far_m, 3)
        same = refocus.render(self.photo, self.disparity, focus_distance=1.2, f_number=8,
                              focal_length_mm=50, near_m=1, far_m=10)
        lens.f_number = 8
        self.same(same, refocus.render(
            self.photo, self.disparity, focus=refocus.disparity_of_depth(depths, 1.2),
            blur=refocus.max_blur_radius(lens, depths, WIDTH)))


class Files(Case):
    def test_pixels_outlive_the_photo(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / 'photo.ppm'
            self.assertEqual(refocus.image_write(path, self.photo), '')
            image = refocus.photo_read(path).image
            gc.collect()
            self.same(image, self.photo)
            self.assertFalse(image.flags.owndata)
            self.same(refocus.photo_read_memory(path.read_bytes()).image, self.photo)
            depth = pathlib.Path(folder) / 'depth.pgm'
            refocus.gray16_write(depth, self.disparity)
            self.same(refocus.depth_read(depth).disparity()[0], self.disparity)
            self.assertEqual(refocus.photo_read(path).info.container, 'PPM')
            with self.assertRaises(refocus.NoDepthError):
                refocus.photo_read(path).disparity()
            with self.assertRaisesRegex(refocus.IoError, 'missing'):
                refocus.photo_read(os.path.join(folder, 'missing.png'))
            path.write_bytes(b'P6\n4 4\n255\n')
            with self.assertRaises(refocus.FormatError):
                refocus.photo_read(path)
            with self.assertRaises(refocus.UnsupportedError):
                refocus.image_write(os.path.join(folder, 'out.xyz'), self.photo)


class Errors(Case):
    def refused(self, kind, words, function, *arguments, **named):
        with self.assertRaisesRegex(kind, words):
            function(*arguments, **named)

    def test_arrays_that_do_not_fit(self):
        photo, disparity = self.photo, self.disparity
        for kind, words, a, b in (
                (TypeError, 'float32', photo.astype(numpy.float64), disparity),
                (TypeError, '3 or 4', photo[:, :, 0], disparity),
                (TypeError, '3 or 4', photo[:, :, :2], disparity),
                (TypeError, 'int8', photo.astype(numpy.int8).view('b'), disparity),
                (TypeError, '', [1, 2, 3], disparity),
                (TypeError, '', photo.astype('>u2'), disparity),
                (ValueError, 'ascontiguousarray', photo[:, ::2], disparity),
                (ValueError, 'ascontiguousarray', photo, disparity[:, ::2]),
                (ValueError, 'ascontiguousarray', photo.transpose(1, 0, 2), disparity),
                (ValueError, 'dimensions', photo, disparity[0]),
                (ValueError, 'disparity: no side may be larger than 65535', photo,
                 numpy.zeros((65537, 1), numpy.uint16)),
                (ValueError, 'disparity: no side may be larger than 65535', photo,
                 numpy.zeros((1, 65537), numpy.uint16)),
                (TypeError, 'depth_to_disparity', photo, disparity.astype(numpy.float32)),
                (TypeError, 'cannot be read', photo, disparity.astype('>u2')),
                (ValueError, '', numpy.broadcast_to(photo[:1], photo.shape), disparity),
                (ValueError, '', photo[:0], disparity)):
            with refocus.Renderer(WIDTH, HEIGHT, BLUR, deep=1) as renderer:
                self.refused(kind, words, renderer.prepare, a, b)
                self.refused(refocus.StateError, 'prepare', renderer.render, refocus.Settings())
        for out in (photo[:-1].copy(), numpy.zeros((HEIGHT, WIDTH, 3), numpy.int32), 'text'):
            self.refused((ValueError, TypeError), '', picture_of, photo, disparity, out)
        for wrong in (numpy.zeros((HEIGHT, WIDTH - 1), numpy.uint8), disparity):
            self.refused((ValueError, TypeError), 'confidence', refocus.upsample, photo, disparity,
                         confidence=wrong)
            self.refused((ValueError, TypeError), 'confidence', refocus.depth_to_disparity,
                         disparity, 'mm', confidence=wrong)
        fixed = photo.copy()
        fixed.flags.writeable = False
        self.refused((ValueError, BufferError), '', picture_of, photo, disparity, fixed)

    def test_maps_of_several_channels(self):
        """What cv2.imread() gives of a grey file is no map three times as wide."""
        photo, three = self.photo, numpy.repeat(self.disparity[:, :, None], 3, 2)
        bytes_ = (three >> 8).astype(numpy.uint8)
        small = numpy.zeros((2, 2, 3), numpy.uint8)
        for what, function, arguments, named in (
                ('disparity', refocus.render, (photo, three), {'focus': 0.5, 'blur': 5}),
                ('disparity', refocus.render, (photo, bytes_), {'focus': 0.5, 'blur': 5}),
                ('disparity', refocus.upsample, (photo, three), {}),
                ('disparity', refocus.depth_edges, (photo, three), {}),
                ('disparity', refocus.focus_at_point, (three, 45, 40), {}),
                ('samples', refocus.gray16_write, ('out.pgm', three), {}),
                ('matte', refocus.render, (photo, self.disparity),
                 {'focus': 0.5, 'blur': 5, 'matte': three}),
                ('mask', refocus.Aperture, (small,), {})):
            self.refused(ValueError, f'{what}: needs one sample for each pixel, not 3', function,
                         *arguments, **named)
        self.same(picture_of(photo, self.disparity[:, :, None]), self.expected)

    def test_the_words_of_the_library(self):
        with refocus.Renderer(WIDTH, HEIGHT, BLUR) as renderer:
            self.refused(refocus.StateError, '', renderer.render, refocus.Settings(),
                         self.photo.copy())
            renderer.prepare(self.photo, self.disparity)
            for settings, words in (
                    (refocus.Settings(1.5, BLUR), 'focus_disparity is 1.5, may be 0 to 1'),
                    (refocus.Settings(math.nan, BLUR), 'focus_disparity is nan'),
                    (refocus.Settings(0.5, BLUR + 1), 'max_blur_radius'),
                    (refocus.Settings(0.5, BLUR, look={'cat_eye': 2}), 'cat_eye is 2')):
                self.refused(refocus.ArgumentError, words, renderer.render, settings)
            settings = refocus.Settings(0.5, BLUR)
            for field, value, kind in (('rays', 2 ** 40, OverflowError), ('rays', 'x', TypeError),
                                       ('method', -1, OverflowError), ('sigma', 'x', TypeError)):
                broken = refocus.Settings(0.5, BLUR, **{field: value})
                self.refused(kind, f'render_params.{field}', renderer.render, broken)
            self.refused(AttributeError, 'no rayz; it has method', settings.set, rayz=3)
            for band in ([(1, 2)], [5], [(0, 0, 0)] * 16, 7):
                broken = refocus.Settings(0.5, BLUR, focus={'band': band})
                self.refused((TypeError, ValueError), '', renderer.render, broken)
            self.same(renderer.render(refocus.Settings(0.9, BLUR)), self.expected)
        self.refused(refocus.StateError, 'closed', renderer.render, settings)
        self.refused(refocus.StateError, 'closed', renderer.cancel)
        renderer.close()
        self.refused(refocus.ArgumentError, 'max_width', refocus.Renderer, 0, 10, 5)
        self.refused(refocus.SizeError, '', refocus.Renderer, 9999, 9999, 5, max_memory=10 ** 6)
        self.refused(refocus.ArgumentError, '', refocus.Aperture, blades=2)
        for shape in (300, 3), (3, 300):
            self.refused(ValueError, '255', refocus.Aperture, numpy.ones(shape, numpy.uint8))
        self.refused(refocus.ArgumentError, 'focus', refocus.render, self.photo, self.disparity,
                     blur=3)
        for x, y in (-1, 0), (0, -1), (WIDTH, 0), (0, HEIGHT):
            self.refused(refocus.ArgumentError, f'focus_at is {x}, {y}, may be 0, 0 to ',
                         refocus.render, self.photo, self.disparity, blur=3, focus_at=(x, y))
        for wrong in (1,), (1, 2, 3), 1:
            self.refused((TypeError, ValueError), 'unpack', refocus.render, self.photo,
                         self.disparity, blur=3, focus_at=wrong)
        self.refused(refocus.ArgumentError, 'near_m', refocus.render, self.photo, self.disparity,
                     focus=1, f_number=2)
        self.refused(refocus.ArgumentError, 'unit', refocus.depth_to_disparity, self.disparity,
                     'miles')
        nothing = numpy.full((4, 4), math.nan, numpy.float32)
        self.refused(refocus.NoDepthError, '', refocus.depth_to_disparity, nothing, 'm')


class Life(Case):
    def test_nothing_is_kept_and_nothing_leaks(self):
        objects = (self.photo, self.disparity, numpy.zeros((4, 4), numpy.uint8),
                   numpy.zeros_like(self.disparity))
        aperture = refocus.Aperture(blades=5)

        def once(i):
            with refocus.Renderer(WIDTH, HEIGHT, 4, threads=1, deep=i % 2) as renderer:
                renderer.prepare(objects[0], objects[1], confidence=None)
                settings = refocus.Settings(0.9, 4, rays=4, aperture=aperture, focus={
                    'sharp_map': objects[2]})
                renderer.render(settings)
                renderer.get_view(refocus.View.DISPARITY, objects[3])
                refocus.focus_at_point(objects[1], 3, 4)
                refocus.upsample(objects[0], objects[1], out=objects[3])
                for bad in (objects[1], None):
                    try:
                        renderer.render(settings, bad)
                    except (TypeError, ValueError):
                        pass
                try:
                    refocus.depth_to_disparity(objects[0][:, :, 0], 'mm')
                except ValueError:
                    pass

        def resident():
            with open('/proc/self/statm', encoding='ascii') as file:
                return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')

        for i in range(8):
            once(i)
        gc.collect()
        references, blocks, memory = [sys.getrefcount(o) for o in objects], \
            sys.getallocatedblocks(), resident()
        for i in range(60):
            once(i)
        gc.collect()
        self.assertEqual([sys.getrefcount(o) for o in objects], references)
        self.assertLess(sys.getallocatedblocks() - blocks, 200)
        # A picture of every render that stayed would be 60 times 18 KB, a renderer 2 MB each.
        self.assertLess(resident() - memory, 1 << 20)

    def test_what_a_renderer_reads_later_stays(self):
        deep = self.photo.astype(numpy.uint16) * 257
        expected = picture_of(deep, self.disparity)
        renderer = refocus.Renderer(WIDTH, HEIGHT, BLUR, deep=1)
        before = sys.getrefcount(deep)
        renderer.prepare(deep.copy(), self.disparity.copy())
        gc.collect()
        ballast = [numpy.full_like(deep, i) for i in range(20)]
        self.same(renderer.render(refocus.Settings(0.9, BLUR)), expected)
        del ballast
        renderer.prepare(deep, self.disparity)
        self.assertGreater(sys.getrefcount(deep), before)
        renderer.close()
        self.assertEqual(sys.getrefcount(deep), before)

    def test_threads(self):
        big = numpy.tile(self.photo, (6, 6, 1)).astype(numpy.uint16)
        map_ = numpy.tile(self.disparity, (6, 6))
        renderer = refocus.Renderer(big.shape[1], big.shape[0], 40, threads=1, deep=1)
        renderer.prepare(big, map_)
        references = sys.getrefcount(big)
        settings = refocus.Settings(0.5, 40, rays=1024)
        found = []

        def work():
            while not found:
                try:
                    renderer.render(settings)
                except refocus.BusyError:
                    pass
                except refocus.Error as error:
                    found.append(error)

        thread = threading.Thread(target=work)
        thread.start()
        # This thread goes on while the other renders, is told so, and ends it.
        busy = 0
        while busy < 3 and thread.is_alive():
            try:
                renderer.prepare(self.photo, self.disparity)
            except refocus.BusyError:
                busy += 1
        self.assertEqual(sys.getrefcount(big), references)  # It is still read.
        with self.assertRaises(refocus.BusyError):
            renderer.close()
        while thread.is_alive():
            renderer.cancel()
            thread.join(0.05)
        self.assertEqual(busy, 3)
        self.assertIsInstance(found[0], refocus.CancelledError)
        renderer.close()

    def test_every_public_name_is_typed(self):
        self.assertTrue((pathlib.Path(refocus.__file__).parent / 'py.typed').exists())
        for name in refocus.__all__:
            thing = getattr(refocus, name)
            if callable(thing) and not isinstance(thing, type):
                self.assertIn('return', thing.__annotations__, name)
                self.assertTrue(thing.__doc__, name)
        self.assertEqual(refocus.LookParams.__annotations__['cat_eye'], float)
        self.assertEqual(refocus.Format.RGB_HALF, 11)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
