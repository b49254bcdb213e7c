#!/usr/bin/env python3
"""Depth in one step: --estimate, --stereo and --stereo-file of render, sheet and pull make what
`refocus depth` and --depth make. Usage: test_ways.py REFOCUS [unittest arguments]"""
import os
import random
import re
import unittest

import pictures
from case import Case
from onnx_file import network


class Ways(Case):
    def setUp(self):
        self.opencv = 'OpenCV' in self.run_it('--version').stdout

    def photos(self):
        """A photo that is near where it is red, of the network's size, and a stereo pair."""
        with open('red.onnx', 'wb') as file:
            file.write(network())
        pictures.ppm('red.ppm', 320, 192,
                     lambda x, y: (230 if x >= 160 else 40, 90, x * y & 127))
        pictures.stereo_pair('left.ppm', 'right.ppm')

    def both(self, photo, way, depth_way, command, *arguments):
        """The command by a map of `refocus depth`, and in one step."""
        found = []
        self.succeeds('depth', photo, *depth_way, '-o', 'map.png')
        for depth in ('--depth', 'map.png'), way:
            self.succeeds(command, photo, *depth, '-o', 'out.ppm', *arguments)
            found.append(pictures.read_bytes('out.ppm'))
        self.same(*found, (way, command))
        self.differs(found[0], pictures.read_bytes(photo))

    def test_estimate_has_the_shape_of_the_photo(self):
        """The network's picture is 320x192: a map of an upright photo would lie on its side."""
        if not self.opencv:
            self.skipTest('this build has no OpenCV')
        self.photos()
        for (width, height), size in (((150, 250), (320, 533)), ((400, 100), (768, 192)),
                                      ((320, 192), (320, 192))):
            pictures.ppm('other.ppm', width, height,
                         lambda x, y, w=width: (230 if x >= w // 2 else 40, 90, 9))
            self.succeeds('depth', 'other.ppm', '--estimate', 'red.onnx', '-o', 'map.pfm')
            self.succeeds('render', 'other.ppm', '--depth', 'map.pfm', '-o', 'out.ppm')
            columns, rows, samples = pictures.read_pfm('map.pfm')
            self.assertEqual((columns, rows), size)
            row = samples[columns * (rows // 2):][:columns]
            self.assertGreater(row[columns * 3 // 4], row[columns // 4] + 0.3)
            column = samples[columns * 3 // 4::columns]
            self.assertLess(max(column) - min(column), 0.03)

    def test_in_one_step(self):
        if not self.opencv:
            self.skipTest('this build has no OpenCV')
        self.photos()
        for command, more in (('render', ('--focus', '0', '--blur', '4')),
                              ('sheet', ('--focuses', '0,1', '--blur', '4')),
                              ('sheet', ('--f-numbers', '2,8', '--focal-length', '50', '--near',
                                         '1', '--far', '9'))):
            self.both('red.ppm', ('--estimate', 'red.onnx'), ('--estimate', 'red.onnx'), command,
                      *more)
            self.both('left.ppm', ('--stereo', 'right.ppm'), ('right.ppm',), command, *more)
        self.succeeds('pull', 'red.ppm', '--estimate', 'red.onnx', '-o', 'pull.apng', '--seconds',
                      '0.2', '--blur', '3', '--rays', '8')
        report = self.reports('render', 'left.ppm', '--stereo', 'right.ppm', '-o', 'out.ppm')
        self.assertEqual((report['depth']['width'], report['depth']['height']), (160, 96))
        for source, arguments in (('stereo', ('left.ppm', 'right.ppm')),
                                  ('network', ('red.ppm', '--estimate', 'red.onnx'))):
            found = self.reports('depth', *arguments, '-o', 'map.png')
            self.assertEqual(found['depth']['source'], source)
        self.assertEqual(report['depth']['source'], 'stereo')
        self.fails(1, re.compile(r'^refocus: right.ppm: '), 'render', 'red.ppm', '--stereo',
                   'right.ppm', '-o', 'new.ppm')
        self.fails(1, re.compile(r'^refocus: red.ppm: it is no stereo file'), 'render',
                   'red.ppm', '--stereo-file', '-o', 'new.ppm')
        self.fails(1, re.compile(r'^refocus: no.onnx: '), 'render', 'red.ppm', '--estimate',
                   'no.onnx', '-o', 'new.ppm')

    def test_doubtful_pair(self):
        """A line says so where less than 45 % of the pixels agree."""
        if not self.opencv:
            self.skipTest('this build has no OpenCV')
        rng = random.Random(5)
        noise = [[[rng.randrange(256) for _ in range(340)] for _ in range(128)] for _ in range(3)]

        def seen(x, y, shift, alike):
            """Two surfaces in the upper rows, and below what each picture has for itself."""
            if y >= alike:
                return noise[shift + 1][y][x]
            return noise[0][y][x + 20 + ((14 if x + 14 * shift >= 120 else 4) if shift else 0)]
        for alike, doubtful in (46, True), (80, False):
            for name, shift in ('some-left.ppm', 0), ('some-right.ppm', 1):
                pictures.ppm(name, 240, 128, lambda x, y, s=shift: (seen(x, y, s, alike),) * 3)
            for arguments in (('depth', 'some-left.ppm', 'some-right.ppm', '-o', 'some.pgm'),
                              ('render', 'some-left.ppm', '--stereo', 'some-right.ppm', '--blur',
                               '3', '-o', 'out.ppm')):
                result = self.run_it(*arguments)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(bool(re.fullmatch(
                    r'refocus: some-right.ppm: depth is doubtful, as only 3\d % of the pixels .*\n',
                    result.stderr)), doubtful, result.stderr)
                self.assertEqual(bool(result.stderr), doubtful)

    def test_which_picture_is_the_left_one(self):
        if not self.opencv:
            self.skipTest('this build has no OpenCV')
        rng = random.Random(3)
        noise = [[rng.randrange(120) for _ in range(300)] for _ in range(128)]

        def seen(x, y, shift):
            """A bright square, whose texture moves with it, before a dark wall."""
            near = 60 <= x + (20 if shift else 0) < 160 and 24 <= y < 104
            return noise[y][x + 20 + ((20 if near else 4) if shift else 0)] + (130 if near else 0)
        for name, shift in ('dark-left.ppm', 0), ('dark-right.ppm', 1):
            pictures.ppm(name, 240, 128, lambda x, y, s=shift: (seen(x, y, s),) * 3)
        pictures.ppm('crossed.ppm', 480, 128, lambda x, y: (seen(x % 240, y, x < 240),) * 3)
        tells = 'stereo: what only one picture shows tells that the %s one comes first'
        given = 'stereo: the order of the pictures is as it was given'
        for files, order, says, at in (
                (('dark-left.ppm', 'dark-right.ppm'), 'auto', tells % 'left', 110),
                (('dark-right.ppm', 'dark-left.ppm'), 'auto', tells % 'right', 90),
                (('crossed.ppm', '--side-by-side'), 'auto', tells % 'right', 90),
                (('crossed.ppm', '--side-by-side'), 'right-first', given, 90)):
            report = self.reports('depth', *files, '--pair-order', order, '-o', 'seen.pgm')
            self.assertIn(says, report['evidence'])
            samples = pictures.read_pnm('seen.pgm')[2]
            self.assertGreater(samples[64 * 240 + at], samples[12 * 240 + at] + 30000)
        self.succeeds('depth', 'crossed.ppm', '--side-by-side', '--pair-order', 'left-first', '-o',
                      'seen.pgm')
        samples = pictures.read_pnm('seen.pgm')[2]
        self.assertLess(samples[64 * 240 + 90], samples[12 * 240 + 90] - 30000)
        for name in 'dark-left.ppm', 'dark-right.ppm', 'crossed.ppm', 'seen.pgm':
            os.remove(name)

    def test_refused(self):
        twice = ('depth is given twice; give one of --depth, --estimate, --stereo and '
                 '--stereo-file')
        for line, options in (
                ('--estimate: ' + twice, ('--estimate', 'm.onnx')),
                ('--stereo: ' + twice, ('--stereo', 'plain.ppm')),
                ('--stereo: ' + twice, ('--stereo-file',)),
                ('--network: it goes with --estimate; give that too', ('--network', 'midas-small')),
                ('--match: it goes with --stereo; give that too',
                 ('--match', 'plain'))):
            self.fails(2, line, *self.render(*options))
        one = ('render', 'photo.ppm', '-o', 'new.ppm')
        self.fails(2, '--estimate: ' + twice, *one, '--estimate', 'm', '--stereo', 'plain.ppm')
        self.fails(2, '--depth-unit: it is for depth that is read from a file; leave it out', *one,
                   '--estimate', 'm.onnx', '--depth-unit', 'mm')
        self.fails(2, '--orient-depth: it is for depth that is read from a file; leave it out',
                   *one, '--stereo', 'plain.ppm', '--orient-depth', '90')
        os.makedirs('folder')
        self.fails(2, '--stereo: it is for one photo; give that alone', 'render', 'photo.ppm',
                   'plain.ppm', '--stereo', 'plain.ppm', '-o', 'folder')
        self.fails(2, 'plain.ppm: it is an input too and would be lost; give another name', 'render', 'photo.ppm', '--stereo', 'plain.ppm',
                   '-o', 'plain.ppm')
        if not self.opencv:
            self.fails(1, 'm.onnx: this build has no OpenCV; build it with OpenCV', *one,
                       '--estimate', 'm.onnx')


if __name__ == '__main__':
    unittest.main()
