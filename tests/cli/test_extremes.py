#!/usr/bin/env python3
"""The refocus command at its limits: sizes, memory, signals; and with photos of phones.
Usage: test_extremes.py REFOCUS [unittest arguments]"""
import json
import os
import pty
import re
import resource
import signal
import subprocess
import sys
import time
import unittest

import pictures
from case import Case, PHOTOS, REFOCUS, ROOT


class Extremes(Case):
    METHODS = ('sweep', 'search', 'raytrace')

    def test_one_pixel(self):
        pictures.ppm('one.ppm', 1, 1, lambda x, y: (7, 77, 177))
        pictures.pgm('one.pgm', 1, 1, lambda x, y: 9)
        for method in self.METHODS:
            for depth in ('one.pgm', 'depth.pgm'):
                self.succeeds('render', 'one.ppm', '--depth', depth, '--blur', '127', '-o',
                              'out.ppm', '--method', method)
                self.same(pictures.read_pnm('out.ppm'), pictures.read_pnm('one.ppm'))
            self.succeeds(*self.render('--depth', 'one.pgm', '--method', method))
        for view in ('depth', 'blur', 'overlay', 'peaking', 'anaglyph', 'edges'):
            self.succeeds('render', 'one.ppm', '--depth', 'one.pgm', '-o', 'out.ppm', '--view',
                          view)

    def test_longest_side(self):
        pictures.ppm('long.ppm', 65535, 1, lambda x, y: (x & 255, 7, x >> 8))
        pictures.pgm('long.pgm', 65535, 1, lambda x, y: x // 300)
        pictures.pgm('tall.pgm', 1, 65535, lambda x, y: x // 300)
        for depth in ('long.pgm', 'tall.pgm'):
            report = self.reports('render', 'long.ppm', '--depth', depth, '--blur', '5', '-o',
                                  'out.png', '--max-side', '65535')
            self.assertEqual((report['width'], report['height']), (65535, 1))
        self.succeeds('render', 'long.ppm', '--depth', 'long.pgm', '--view', 'anaglyph', '-o',
                      'out.png', '--max-side', '65535')
        # upright: a legend is as high as its width lets it
        pictures.ppm('tall.ppm', 1, 65535, lambda x, y: (y & 255, 7, y >> 8))
        self.succeeds('render', 'tall.ppm', '--depth', 'tall.pgm', '--view', 'depth', '-o',
                      'out.png', '--max-side', '65535')

    def test_absurd_size(self):
        with open('huge.ppm', 'wb') as file:
            file.write(b'P6\n65535 65535\n255\n')
        self.fails(1, re.compile('^refocus: huge.ppm: .*limit'), 'info', 'huge.ppm')

    def test_little_memory(self):
        """Whatever allocation fails: a line, and no file."""
        def limit(kib):
            return lambda: resource.setrlimit(resource.RLIMIT_AS, (kib << 10, kib << 10))

        least = next((kib for kib in range(8000, 200000, 2000) if subprocess.run(
            [REFOCUS, '--version'], preexec_fn=limit(kib), stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL).returncode == 0), None)
        if not least:
            self.skipTest('a sanitizer takes more address space than that')
        pictures.png('black.png', 1500, 1000, [bytes(4500)] * 1000)
        for command in (('render',), ('render', '--view', 'blur'),
                        ('render', '--view', 'anaglyph'),
                        ('sheet', '--kind', 'before-after', '--cell-width', '1500')):
            codes = set()
            for more in range(0, 130000, 5000):
                out = 'out%d.png' % more
                result = self.run_it(command[0], 'black.png', *command[1:], '--depth',
                                     'depth.pgm', '--blur', '9', '--threads', '1', '--rays',
                                     '8', '-o', out, preexec_fn=limit(least + more))
                codes.add(result.returncode)
                self.assertEqual(os.path.exists(out), result.returncode == 0)
                if result.returncode != 0:
                    self.assertRegex(result.stderr, r'^refocus: .*: .*\n$')
                    self.assertEqual(result.stderr.count('\n'), 1)
                else:
                    os.remove(out)
            self.assertEqual(codes, {0, 1}, command)
        # Memory for the picture, and none for the stacks of 64 threads of eight MiB.
        def small(kib):
            limit(kib)()
            resource.setrlimit(resource.RLIMIT_STACK, (8 << 20, 8 << 20))
        result = self.run_it('render', 'black.png', '--depth', 'depth.pgm', '--blur', '9', '--threads', '64',
                             '-o', 'out.png', preexec_fn=lambda: small(least + 130000))
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, '^refocus: --threads: .*memory is short.*\n$')


class Running(Case):
    def interrupt(self, number):
        pictures.ppm('large.ppm', 640, 480, lambda x, y: (x & 255, y & 255, 7))
        pictures.pgm('large.pgm', 640, 480, lambda x, y: (x * 7 + y) & 255)
        before = sorted(os.listdir('.'))
        process = subprocess.Popen(
            [REFOCUS, 'render', 'large.ppm', '--depth', 'large.pgm', '-o', 'out.png', '--rays',
             '1024', '--blur', '100', '--repeat', '10000'], stderr=subprocess.PIPE, text=True)
        time.sleep(1)
        self.assertIsNone(process.poll())
        process.send_signal(number)
        error = process.communicate(timeout=60)[1]
        self.assertEqual(error, 'refocus: large.ppm: interrupted; nothing was written\n')
        self.assertEqual(process.returncode, 1)
        self.assertEqual(sorted(os.listdir('.')), before)

    def test_interrupt(self):
        self.interrupt(signal.SIGINT)

    def test_terminate(self):
        self.interrupt(signal.SIGTERM)

    def on_a_terminal(self, *arguments):
        terminal, other = pty.openpty()
        process = subprocess.Popen([REFOCUS, *arguments], stderr=other)
        os.close(other)
        text = b''
        try:
            while chunk := os.read(terminal, 4096):
                text += chunk
        except OSError:  # how a terminal ends
            pass
        os.close(terminal)
        self.assertEqual(process.wait(), 0)
        return text

    def test_progress_on_a_terminal(self):
        text = self.on_a_terminal(*self.render())
        for word in (b'reading', b'preparing', b'rendering', b'writing', b' % '):
            self.assertIn(word, text)
        self.assertTrue(text.endswith(b'\r\x1b[K'), text)

    def test_slow_methods_progress_by_strips(self):
        """And the picture is the same."""
        slow = self.render('--method', 'raytrace', '--focus', '1', '--blur', '7')
        for region in ((), ('--region', '5,3,30,27')):
            self.succeeds(*slow, *region)
            whole = pictures.read_pnm('out.ppm')
            text = self.on_a_terminal(*slow, *region)
            self.assertGreater(text.count(b'rendering'), 10)
            self.same(pictures.read_pnm('out.ppm'), whole, region)


class Photos(Case):
    def setUp(self):
        if not os.path.isdir(PHOTOS):
            print('SKIP: no photos in %s; set REFOCUS_PHOTOS' % PHOTOS, file=sys.stderr)
            self.skipTest('no photos')
        self.formats = self.succeeds('--version')

    def path(self, name):
        return os.path.join(PHOTOS, name)

    def test_phone_files(self):
        for name, source, near, far in (
                ('gdepth-dahlia.jpg', 'gdepth', None, None),
                ('apple-jpeg-cup.jpg', 'apple-mpf', 1 / 4.835938, 1 / 0.229614),
                ('apple-heic-pug.heic', 'heif', 1 / 4.382812, 1 / 1.498047)):
            if source == 'heif' and 'HEIC' not in self.formats:
                print('SKIP: this build reads no HEIC', file=sys.stderr)
                continue
            info = self.reports('info', self.path('phone/' + name))
            self.assertEqual(info['depth']['source'], source)
            for end, metres in (('near_m', near), ('far_m', far)):
                if metres is None:  # its distances have no unit
                    self.assertEqual(info['depth'][end], None)
                else:
                    self.assertAlmostEqual(info['depth'][end] / metres, 1, 4)
            self.assertTrue(info['evidence'])
        self.assertTrue(self.reports('info', self.path('phone/gdepth-dahlia.jpg'))
                        ['original_used'])

    def test_dahlia(self):
        """Focus at the flower the phone focused on."""
        photo = self.path('phone/gdepth-dahlia.jpg')
        report = self.reports('render', photo, '-o', 'out.jpg', '--rays', '8', '--region',
                              '400,1000,64,64', '--blur', '8')
        self.assertAlmostEqual(report['focus'], 0.7, 1)

    def change(self, photo, *more):
        """Mean change of a photo's codes by a blur, and the part that changes by 8 and more."""
        samples = []
        for blur in (more, ('--blur', '0')):
            result = self.run_it('render', photo, '-o', 'out.ppm', '--quality', 'preview', *blur)
            self.assertEqual(result.returncode, 0, result.stderr)
            samples.append(pictures.read_pnm('out.ppm')[2][::101])
        changes = [abs(a - b) for a, b in zip(*samples)]
        return sum(changes) / len(changes), sum(c >= 8 for c in changes) / len(changes)

    def test_f_number_of_phone_photos(self):
        """README's own line: plain to see on each, and more than at f/8."""
        for name, least in (('gdepth-dahlia.jpg', 2), ('apple-jpeg-cup.jpg', 2),
                            ('apple-heic-pug.heic', 2)):
            if name.endswith('heic') and 'HEIC' not in self.formats:
                continue
            photo = self.path('phone/' + name)
            (wide, part), (stopped, _) = (self.change(photo, '--f-number', n)
                                          for n in ('1.4', '8'))
            self.assertGreater(wide, least, name)
            self.assertGreater(part, 0.02, name)
            self.assertGreater(wide, 1.2 * stopped, name)

    def test_defaults_of_phone_photos(self):
        """The blur that each phone showed, at the point that it focused on: plain to see."""
        for name, blur, part in (('gdepth-dahlia.jpg', 22.27, 0.2),
                                 ('apple-jpeg-cup.jpg', 64.8, 0.01),
                                 ('apple-heic-pug.heic', 40.6, 0.01)):
            if name.endswith('heic') and 'HEIC' not in self.formats:
                continue
            info = self.reports('info', self.path('phone/' + name))
            self.assertAlmostEqual(info['depth']['blur'], blur, 1, name)
            self.assertTrue(info['focus_point'])
            self.assertGreater(self.change(self.path('phone/' + name))[1], part, name)

    def test_f_number_of_an_iphone_without_metres(self):
        """The range is taken out of the cup's XMP: the f/2.8 that the phone simulated stands
        for the default blur."""
        data = pictures.read_bytes(self.path('phone/apple-jpeg-cup.jpg'))
        for name in b'FloatMinValue', b'FloatMaxValue':
            self.assertIn(name, data)
            data = data.replace(name, b'X' + name[1:])
        with open('cup.jpg', 'wb') as file:
            file.write(data)
        report = self.warns(
            '--f-number: cup.jpg says no distances in metres; f/2 gives 112.9 pixels of blur, by '
            'the default of 80.6 at f/2.8; --near and --far give that of a lens', 'render',
            'cup.jpg', '-o', 'out.ppm', '--rays', '8', '--region', '0,0,8,8', '--f-number', '2')
        self.assertAlmostEqual(report['blur'], 4032 / 50 * 2.8 / 2, 3)
        os.remove('cup.jpg')

    def test_eight_strokes(self):
        """examples/strokes/street.json: what lies under the strokes, and far from them."""
        strokes = os.path.join(ROOT, 'examples/strokes/street.json')
        with open(strokes) as file:
            self.assertEqual(len(json.load(file)['strokes']), 8)
        photo = self.path('mono/street_8_all-in-focus.jpg')
        self.succeeds('depth', photo, '--strokes', strokes, '-o', 'street.pgm')
        width, height, samples = pictures.read_pnm('street.pgm')
        self.assertEqual((width, height), (2000, 1333))
        for x, y, d in ((1500, 1100, 0.85), (1520, 600, 0.85), (1250, 600, 0.36),
                        (1250, 780, 0.36), (1900, 950, 0.5), (100, 700, 0.79),
                        (330, 1200, 0.77), (1000, 100, 0.15), (1100, 1250, 0.9 - 82 * 0.75 / 642),
                        (800, 500, 0.15)):
            self.assertAlmostEqual(samples[y * width + x] / 65535, d, 2, (x, y))
        report = self.reports('render', photo, '--depth', 'street.pgm', '--focus-at',
                              '1500,1100', '--blur', '36', '-o', 'out.jpg', '--region',
                              '1400,500,200,200')
        self.assertAlmostEqual(report['focus'], 0.85, 3)

    def test_kinect(self):
        report = self.reports('depth', self.path('rgbd/tum-office-depth.png'), '-o', 'out.png',
                              '--depth-unit', '5000/m')
        self.assertEqual(report['depth']['unknown'], 58950)
        self.assertAlmostEqual(report['depth']['near_m'], 1.464)
        self.assertAlmostEqual(report['depth']['far_m'], 9.331)


if __name__ == '__main__':
    unittest.main()
