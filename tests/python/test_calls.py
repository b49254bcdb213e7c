#!/usr/bin/env python3
"""What programs ask of the package refocus in one call, and what they get when they ask wrongly.

usage: test_calls.py FOLDER_OF_THE_PACKAGE [REFOCUS]
"""
import copy
import errno
import gc
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

from test_python import BLUR, COMMAND, DATA, HEIGHT, WIDTH, Case, picture_of

import numpy
import refocus


class Render(Case):
    @unittest.skipUnless(COMMAND, 'no command in this build')
    def test_the_lens_of_the_command(self):
        """Also of a photo that stands upright."""
        lens = {'f_number': 1.4, 'focal_length_mm': 50, 'near_m': 1, 'far_m': 9}
        options = ['--f-number', '1.4', '--focal-length', '50', '--near', '1', '--far', '9']
        for photo, disparity, more, named in (
                (self.photo, self.disparity, [], {}),
                (self.photo.transpose(1, 0, 2), self.disparity.T, [], {}),
                (self.photo.transpose(1, 0, 2), self.disparity.T, ['--sensor-width', '20'],
                 {'sensor_width_mm': 20})):
            photo, disparity = map(numpy.ascontiguousarray, (photo, disparity))
            with tempfile.TemporaryDirectory() as folder:
                photo_file, map_file, out = (os.path.join(folder, name) for name in (
                    'photo.ppm', 'map.pgm', 'out.ppm'))
                refocus.image_write(photo_file, photo)
                refocus.gray16_write(map_file, disparity)
                subprocess.run([COMMAND, 'render', photo_file, '--depth', map_file, '--focus',
                                '0.9', *options, *more, '-o', out], check=True)
                self.same(refocus.photo_read(out).image,
                          refocus.render(photo, disparity, focus=0.9, **lens, **named))
        with self.assertRaisesRegex(refocus.ArgumentError, 'focal_length_mm'):
            refocus.render(self.photo, self.disparity, focus=0.9, f_number=2, near_m=1, far_m=9)

    @unittest.skipUnless(COMMAND, 'no command in this build')
    def test_depth_with_holes(self):
        """A sensor's map, whose filled samples count least: the command's picture."""
        folder = DATA / 'portrait'
        photo = refocus.photo_read(folder / 'allfocus.png').image
        depth = refocus.depth_read(folder / 'depth_lowres.png', 'mm')
        disparity, report = depth.disparity(photo)
        self.assertGreater(report.unknown, 0)
        self.assertEqual((depth.confidence == 0).sum(), report.unknown + report.strays)
        for edges, option, blur in ((refocus.DepthEdges.AUTO, 'auto', 20),
                                    (refocus.DepthEdges.AS_GIVEN, 'as-given', 20),
                                    (refocus.DepthEdges.AUTO, 'auto', 33)):  # more rays
            with self.subTest(option=option, blur=blur), tempfile.TemporaryDirectory() as temporary:
                out = os.path.join(temporary, 'out.ppm')
                subprocess.run([COMMAND, 'render', folder / 'allfocus.png', '--depth',
                                folder / 'depth_lowres.png', '--depth-unit', 'mm', '--focus', '0.7',
                                '--blur', str(blur), '--depth-edges', option, '-o', out],
                               check=True)
                self.same(refocus.photo_read(out).image, refocus.render(
                    photo, disparity, focus=0.7, blur=blur, depth_edges=edges,
                    confidence=depth.confidence))


class Parameters(Case):
    def test_a_refused_prepare_keeps_the_scene(self):
        renderer = refocus.Renderer(WIDTH, HEIGHT, BLUR)
        renderer.prepare(self.photo, self.disparity)
        with unittest.mock.patch.object(refocus._core, 'prepare_scene',
                                        side_effect=refocus.BusyError('busy')):
            with self.assertRaises(refocus.BusyError):
                renderer.prepare(self.photo, self.disparity)
        self.same(renderer.render(refocus.Settings(0.9, BLUR)), self.expected)

    def test_names_of_settings(self):
        settings = refocus.Settings(0.9, BLUR)
        for name, words in (('hilights', 'Settings has no hilights; it has render, '),
                            ('rays', 'Settings has no rays; .*, and render.rays')):
            with self.assertRaisesRegex(AttributeError, words):
                setattr(settings, name, 1)
        settings.look = {'cat_eye': 0.5}
        self.assertEqual(settings.look, refocus.LookParams(cat_eye=0.5))
        settings.look = refocus.LookParams(cat_eye=0.25)
        self.same(picture_of(self.photo, self.disparity, look={'cat_eye': 0.25}),
                  self.picture_by(settings))
        self.assertRaises(TypeError, setattr, settings, 'look', None)

    def picture_by(self, settings):
        with refocus.Renderer(WIDTH, HEIGHT, BLUR) as renderer:
            renderer.prepare(self.photo, self.disparity)
            return renderer.render(settings)

    def test_copies_of_settings(self):
        settings = refocus.Settings(0.9, BLUR, aperture=refocus.Aperture(blades=5))
        twin = copy.deepcopy(settings)
        self.assertIs(twin.aperture, settings.aperture)
        twin.render.rays = 16
        self.assertNotEqual(twin.render, settings.render)
        self.assertFalse(numpy.array_equal(self.picture_by(twin), self.picture_by(settings)))
        plain = refocus.Settings(0.9, BLUR, rays=16)
        self.same(self.picture_by(pickle.loads(pickle.dumps(plain))), self.picture_by(plain))

    def test_structs_of_focus_and_highlights(self):
        band = {'band': [(0.2, 0.2, 0.0)]}

        def picture(**named):
            return refocus.render(self.photo, self.disparity, blur=BLUR, **named)

        expected = picture(focus_disparity=0.9, focus=refocus.FocusParams(**band))
        self.assertFalse(numpy.array_equal(expected, picture(focus=0.9)))
        self.same(picture(focus_disparity=0.9, focus=band), expected)
        self.same(picture(focus_at=(45, 40), highlights={'gain': 4}, focus=band),
                  picture(focus_at=(45, 40), highlights=4, focus=refocus.FocusParams(**band)))
        self.same(picture(focus=0.9, highlights=refocus.HighlightParams()),
                  picture(focus=0.9, highlights='off'))
        with self.assertRaisesRegex(refocus.ArgumentError, 'one of focus'):
            picture(focus=band)

    def test_methods_that_are_none(self):
        for method in 99, -1, 2 ** 40, 'sweep':
            with self.assertRaisesRegex(refocus.ArgumentError, 'one of Method'):
                refocus.render(self.photo, self.disparity, focus=1, blur=3, method=method)


class Files(Case):
    def test_what_is_not_there(self):
        with tempfile.TemporaryDirectory() as folder:
            for function in refocus.photo_read, refocus.depth_read:
                with self.assertRaisesRegex(FileNotFoundError, 'missing.ppm: ') as caught:
                    function(os.path.join(folder, 'missing.ppm'))
                self.assertEqual(caught.exception.errno, errno.ENOENT)
                self.assertIsInstance(caught.exception, refocus.IoError)
                with self.assertRaisesRegex(refocus.IoError, ': ') as caught:
                    function(folder)
                self.assertNotIsInstance(caught.exception, FileNotFoundError)

    def test_names_of_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(os.fsencode(folder), b'\xff.ppm')
            with self.assertRaises(refocus.NotFoundError) as caught:
                refocus.photo_read(path)
            self.assertTrue(str(caught.exception).startswith(os.fsdecode(path) + ': '))
            refocus.image_write(path, self.photo)
            self.same(refocus.photo_read(os.fsdecode(path)).image, self.photo)

    def test_halves(self):
        halves = (self.photo / 64).astype(numpy.float16)
        floats = refocus.Image(refocus.Format.RGB_HALF, WIDTH, HEIGHT,
                               (halves.reshape(HEIGHT, 3 * WIDTH),))
        endings = ['pfm', 'exr'] if 'OpenEXR' in refocus.file_formats() else ['pfm']
        with tempfile.TemporaryDirectory() as folder:
            for ending in endings:
                path = os.path.join(folder, 'light.' + ending)
                for picture in halves, floats:
                    refocus.image_write(path, picture)
                    self.same(refocus.photo_read(path).deep, halves.astype(numpy.float32))
            with self.assertRaisesRegex(refocus.UnsupportedError, 'PFM floats'):
                refocus.image_write(os.path.join(folder, 'light.ppm'), halves)


class Signals(Case):
    def test_ctrl_c_ends_a_render(self):
        """Every ray of a large blur would take minutes. Scripts have tests in their background
        ignore Ctrl-C."""
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        photo = numpy.tile(self.photo, (12, 12, 1))
        disparity = numpy.tile(self.disparity, (12, 12))
        began = time.monotonic()
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            refocus.render(photo, disparity, focus=0.1, blur=100, rays=refocus.RAYS_FULL,
                           method=refocus.Method.RAYTRACE)
        self.assertLess(time.monotonic() - began, 20)

    def test_other_handlers_run_meanwhile(self):
        """A handler that raises nothing lets the picture be finished."""
        times = []
        photo = numpy.tile(self.photo, (4, 4, 1))
        disparity = numpy.tile(self.disparity, (4, 4))
        before = signal.signal(signal.SIGALRM, lambda *_: times.append(time.monotonic()))
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.01)
            picture = refocus.render(photo, disparity, focus=0.1, blur=10, highlights='off',
                                     method=refocus.Method.RAYTRACE)
            ended = time.monotonic()
        finally:
            signal.signal(signal.SIGALRM, before)
        self.assertEqual(picture.shape, photo.shape)
        self.assertLess(times[0], ended)


class Forks(Case):
    def in_child(self, function):
        """The exit status of a child by fork() that calls a function; 100: it hangs."""
        child = os.fork()
        if child == 0:
            try:
                os._exit(function())
            finally:
                os._exit(99)
        for _ in range(200):
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                return os.waitstatus_to_exitcode(status)
            time.sleep(0.05)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return 100

    def test_a_child_drops_what_it_inherits(self):
        renderers = [refocus.Renderer(WIDTH, HEIGHT, BLUR, threads=2)]
        renderers[0].prepare(self.photo, self.disparity)
        settings = refocus.Settings(0.9, BLUR)

        def refuses():
            try:
                renderers[0].render(settings)
            except refocus.StateError as error:
                return 0 if 'create one here' in str(error) else 1
            return 2

        def drops():
            renderers.clear()
            gc.collect()
            return 0

        def closes():
            renderers[0].close()
            return int(not numpy.array_equal(picture_of(self.photo, self.disparity),
                                             self.expected))

        for function in refuses, drops, closes:
            with self.subTest(function.__name__):
                self.assertEqual(self.in_child(function), 0)
        self.same(renderers[0].render(settings), self.expected)

    def test_one_thread_goes_on_in_a_child(self):
        renderer = refocus.Renderer(WIDTH, HEIGHT, BLUR, threads=1)
        renderer.prepare(self.photo, self.disparity)
        self.assertEqual(self.in_child(lambda: int(not numpy.array_equal(
            renderer.render(refocus.Settings(0.9, BLUR)), self.expected))), 0)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
