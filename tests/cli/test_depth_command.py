#!/usr/bin/env python3
"""The refocus command: depth maps that `depth` makes, and facts that `info` tells.
Usage: test_depth_command.py REFOCUS [unittest arguments]"""
import json
import math
import os
import re
import shutil
import subprocess
import unittest

import pictures
from case import Case, H, REFOCUS, W


class DepthAndInfo(Case):
    def test_depth(self):
        report = self.reports('depth', 'depth.pgm', '-o', 'd.pgm')
        self.assertEqual(report['depth']['unknown'], 0)
        expected = tuple(65535 if x >= W // 2 else 13107 for y in range(H) for x in range(W))
        self.same(pictures.read_pnm('d.pgm'), (W, H, expected))
        self.succeeds('depth', 'depth.pgm', '-o', 'd.pfm')
        width, height, values = pictures.read_pfm('d.pfm')
        self.assertEqual((width, height), (W, H))
        self.assertTrue(all(abs(v - e / 65535) < 1e-6 for v, e in zip(values, expected)))
        self.succeeds('depth', 'depth.pgm', '-o', 'd.png', '--depth-unit', 'inverse')
        width, height, bits, channels, rows = pictures.read_png('d.png')
        self.assertEqual((width, height, bits, channels), (W, H, 16, 1))
        self.assertEqual((rows[0][:2], rows[0][-2:]), (b'\xcc\xcc', b'\0\0'))
        self.succeeds('depth', 'depth.pgm', '-o', 'v.png', '--view', 'disparity')
        self.same(pictures.read_png('v.png'), (W, H, 8, 3, [b'333' * 24 + b'\xff\xff\xff' * 24] * H))
        text = self.succeeds('depth', 'mm.pgm', '-o', 'd.png', '--depth-unit', 'mm')
        self.assertEqual(text, 'size     48x32\nnear     0.5 m\nfar      2 m\n'
                               'filled   1 samples without a value, 0.1 %\n'
                               'clamped  0 samples beyond the range, 0.0 %\n')
        self.fails(2, 'd.bmp: no such format is written; end the name in .png, .tif, .tiff, .pgm, .pfm, .jpg '
                   'or .jpeg', 'depth', 'depth.pgm', '-o', 'd.bmp')
        self.fails(1, 'd.jpg: depth is saved into JPEG photos; the photo is none',
                   'depth', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'd.jpg')
        self.fails(2, "--invalid: 'zero,x' is not known; give zero, max or numbers, up to 4, with "
                   'commas', 'depth', 'depth.pgm', '-o', 'd.png', '--invalid', 'zero,x')
        self.assertFalse(os.path.exists('d.jpg') or os.path.exists('d.tif'))

    def test_depth_repair(self):
        given = 'depth', 'mm.pgm', '--depth-unit', 'disparity', '-o'
        whole = self.reports(*given, 'a.png')['depth']
        less = self.reports(*given, 'b.png', '--invalid', 'zero')['depth']
        self.assertEqual((whole['unknown'], less['unknown']), (0, 1))
        self.succeeds(*given, 'c.png', '--invalid', 'zero', '--view', 'confidence')
        width, height, bits, channels, rows = pictures.read_png('c.png')
        self.assertEqual((width, height, bits, channels), (W, H, 8, 3))
        self.assertEqual(sum(row.count(b'\0\0\0') for row in rows), less['unknown'])

    def test_holes_by_the_photo(self):
        """A hole at a silhouette goes to the surface that looks like it, also in a map that is yet to
        be turned, and to the farther one alone where there is no photo."""
        def code(x, y):
            return 0 if 44 <= x < 54 and 20 <= y < 38 else 240 if x < 50 else 20
        pictures.ppm('sides.ppm', 96, 64, lambda x, y: (60,) * 3 if x < 50 else (200,) * 3)
        pictures.pgm('hole.pgm', 96, 64, code)
        pictures.pgm('90.pgm', 64, 96, lambda x, y: code(95 - y, x))
        pictures.pgm('180.pgm', 96, 64, lambda x, y: code(95 - x, 63 - y))
        pictures.pgm('270.pgm', 64, 96, lambda x, y: code(y, 63 - x))
        for ends, *given in (44, 'hole.pgm'), (50, 'sides.ppm', '--depth', 'hole.pgm'), *(
                (50, 'sides.ppm', '--depth', turn + '.pgm', '--orient-depth', turn)
                for turn in ('90', '180', '270')):
            self.succeeds('depth', *given, '--invalid', 'zero', '-o', 'd.pgm')
            width, height, values = pictures.read_pnm('d.pgm')
            self.assertEqual((width, height), (96, 64))
            row = values[32 * width:33 * width]
            self.assertEqual([x for x in range(width) if row[x] > 32768], list(range(ends)))
        for name in 'sides.ppm', 'hole.pgm', '90.pgm', '180.pgm', '270.pgm':
            os.remove(name)

    def test_strays(self):
        """A sample far nearer than all others is filled, which a line says, unless --near is given."""
        pictures.pgm('stray.pgm', W, H,
                     lambda x, y: 3 if (x, y) == (9, 3) else 500 if x < 24 else 2000, 65535)
        told = ('stray.pgm: samples that are far nearer than all others (1, the rest 0.5 m and '
                'farther) are taken for mistakes and filled; --near keeps them')
        self.warns(told, 'render', 'photo.ppm', '--depth', 'stray.pgm', '--depth-unit', 'mm',
                   '--blur', '4', '-o', 'out.ppm')
        given = 'depth', 'stray.pgm', '--depth-unit', 'mm', '-o', 'a.pgm'
        self.warns(told, *given)
        filled = pictures.read_pnm('a.pgm')
        self.assertEqual(set(filled[2]), {0, 65535})
        self.assertIn('strays   1 samples', subprocess.run([REFOCUS, *given], capture_output=True,
                                                           text=True, check=True).stdout)
        report = self.reports(*given, '--near', '0.003')['depth']
        self.assertEqual((report['strays'], report['near_m']), (0, 0.003))
        self.assertEqual(pictures.read_pnm('a.pgm')[2].count(65535), 1)

    def test_distances_without_a_unit(self):
        """They are taken for disparities, as ever, and a line says so."""
        told = ('its samples from 500 to 2000, and zeros, are taken for disparities, bright = near; '
                'if they are distances, give --depth-unit mm, or 5000/m, else disparity; if zeros '
                'have no value, --invalid zero')
        paths = ('render', 'photo.ppm', '--depth', 'mm.pgm', '-o', 'a.ppm'), (
            'depth', 'mm.pgm', '-o', 'a.png')
        for arguments in paths:
            self.warns('mm.pgm: ' + told, *arguments)
            self.warns('mm.pgm: ' + told.replace(', and zeros,', '').split(';')[0] + ';' +
                       told.split(';')[1], *arguments, '--invalid', 'zero')
            for unit in 'mm', 'disparity', 'inverse', '5000/m':
                self.succeeds(*arguments, '--depth-unit', unit)
        self.assertIn('doubtful      %s\n' % told, self.succeeds('info', 'mm.pgm'))
        self.assertEqual(self.reports('info', 'mm.pgm')['evidence'][-1], told)
        for least, most in (99, 2000), (500, 32768), (2000, 3000):
            pictures.pgm('other.pgm', W, H, lambda x, y: (least, most, 0)[x % 3], 65535)
            self.succeeds('render', 'photo.ppm', '--depth', 'other.pgm', '-o', 'a.ppm')
            self.assertNotIn('doubtful', self.succeeds('info', 'other.pgm'))
        pictures.pgm('other.pgm', W, H, lambda x, y: (100, 32767, 0)[x % 3], 65535)
        self.assertIn('doubtful', self.succeeds('info', 'other.pgm'))

    def test_an_end_apart(self):
        """A value that many samples of disparity share beyond a gap may stand for none."""
        told = '%d %% of its samples are %s, apart from all others, and taken for what is %s; if ' \
            'they hold no value, give --invalid=%s'

        def seen(code, part, first, step):
            """Every part-th sample has the code, the others go up in 48 steps."""
            return lambda x, y: code if (x + W * y) % part == 0 else first + step * x
        maps = ((-1, 4, 0, 0.0625, 'farthest'), (-16, 4, 3, 1, 'farthest'),
                (0, 100, 12, 1, 'farthest'), (65520, 4, 0, 16, 'nearest'))
        for code, part, first, step, end in maps:
            pictures.pfm('ends.pfm', W, H, seen(code, part, first, step))
            if code == 0:
                self.assertNotIn('apart', self.succeeds('info', 'ends.pfm'))
                pictures.pgm('ends.pfm', W, H, seen(code, part, first, step))
            line = told % (100 / part, code, end, code)
            for arguments in (('render', 'photo.ppm', '--depth', 'ends.pfm', '-o', 'a.ppm'),
                              ('depth', 'ends.pfm', '-o', 'a.png')):
                self.warns('ends.pfm: ' + line, *arguments)
                self.warns('ends.pfm: ' + line, *arguments, '--depth-unit', 'disparity')
                self.succeeds(*arguments, '--invalid=%d' % code)
            self.assertIn('doubtful      %s\n' % line, self.succeeds('info', 'ends.pfm'))
            found = self.reports('info', 'ends.pfm', '--invalid=%d' % code)['depth']
            self.assertEqual(found['unknown'], -(-W * H // part))
        for code, part, first, step in ((0, 110, 12, 1), (0, 4, 3, 1), (5, 4, 20, 1), (65, 4, 0, 1),
                                        (90, 4, 0, 2)):
            pictures.pgm('ends.pfm', W, H, seen(code, part, first, step))
            self.assertNotIn('apart', self.succeeds('info', 'ends.pfm'))

    def test_parts_of_a_pixel(self):
        """Whole numbers of parts of a pixel use little of 16 bits, and have their own range."""
        told = 'its samples from 16 to 768 use 1.1 % of their range, and leave as little of the ' \
            'blur; if they are parts of a pixel, give --depth-unit disparity/16 (OpenCV) or /256 ' \
            '(KITTI), by which the range is measured'
        sharp = pictures.read_pnm('photo.ppm')
        for name, value in ('parts.pgm', 16), ('parts.pfm', 1):
            write = pictures.pfm if name.endswith('pfm') else pictures.pgm
            write(name, W, H, lambda x, y, v=value: v * (x + 1),
                  **({} if write is pictures.pfm else {'greatest': 65535}))
        lens = '--focus-at', '0,0', '--blur', '9', '--depth-edges', 'as-given', '-o', 'a.ppm'
        self.warns('parts.pgm: ' + told, 'render', 'photo.ppm', '--depth', 'parts.pgm',
                   '--depth-unit', 'disparity', *lens)
        self.assertEqual(pictures.read_pnm('a.ppm'), sharp)
        self.succeeds('render', 'photo.ppm', '--depth', 'parts.pfm', *lens)
        wanted = pictures.read_pnm('a.ppm')
        self.assertNotEqual(wanted, sharp)
        for unit in 'disparity/16', 'disparity/256':
            self.succeeds('render', 'photo.ppm', '--depth', 'parts.pgm', '--depth-unit', unit,
                          *lens)
            self.assertEqual(pictures.read_pnm('a.ppm'), wanted)
        for unit in 'disparity/', 'disparity/0', 'disparity/-1', 'disparity/inf', 'disparity/x':
            self.fails(2, re.compile("^refocus: --depth-unit: '%s' is not known" % unit), 'depth', 'parts.pgm',
                       '--depth-unit', unit, '-o', 'a.png')
        pictures.pgm('parts.pgm', W, H, lambda x, y: x * 140, 65535)  # a tenth, and a little
        self.assertNotIn('little', self.succeeds('info', 'parts.pgm', '--depth-unit', 'disparity'))

    def test_bottom_farther(self):
        """Where 3 of 4 samples that differ of the edges say so, and a quarter differs."""
        told = ('as disparities, %s = near, its bottom is farther than its top; if that is wrong, '
                'give --depth-unit inverse, mm, m or 5000/m, else disparity')
        pictures.pgm('down.pgm', W, H, lambda x, y: 200 - 2 * y)
        pictures.pfm('down.pfm', W, H, lambda x, y: -1.0 * y if x else math.nan)
        for name, most in ('down.pgm', 'bright'), ('down.pfm', 'greater'):
            paths = (('render', 'photo.ppm', '--depth', name, '-o', 'a.ppm'),
                     ('depth', name, '-o', 'a.png'))
            for arguments in paths:
                self.warns('%s: %s' % (name, told % most), *arguments)
                for unit in 'disparity', 'inverse':
                    self.succeeds(*arguments, '--depth-unit', unit)
            self.assertIn('doubtful      %s\n' % told % most, self.succeeds('info', name))
            # once it is turned, another half is the lower one
            self.succeeds('depth', name, '-o', 'a.png', '--orient-depth', '180')
        bounds = ((lambda x, y: 200 - 2 * y if 4 * x < 3 * W else 2 * y + 1, True),
                  (lambda x, y: 200 - 2 * y if 4 * x < 3 * W - 4 else 2 * y + 1, False),
                  (lambda x, y: 200 - 2 * y if 4 * x < W else 9, True),
                  (lambda x, y: 200 - 2 * y if 4 * x < W - 4 else 9, False),
                  (lambda x, y: 200 - 2 * y if 2 * y < H else 0, False),
                  # a subject stands in the middle; the lowest and the highest eighth count
                  (lambda x, y: 2 * y + 1 if 4 <= y < H - 4 else 200 - 2 * y, True),
                  (lambda x, y: 200 - 2 * y if 4 <= y < H - 4 else 2 * y + 1, False))
        for sample, doubtful in bounds:
            pictures.pgm('other.pgm', W, H, sample)
            self.assertEqual('doubtful' in self.succeeds('info', 'other.pgm'), doubtful)

    def test_depth_of_pictures(self):
        self.fails(1, re.compile(r'^refocus: depth.pgm: (the two pictures do not match|too few '
                                 r'pixels|it is a depth map, not a photo|the pictures are too '
                                 r'small|this build has no OpenCV)'),
                   'depth', 'photo.ppm', 'depth.pgm', '-o', 'd.png')
        self.fails(2, 'photo.ppm: its depth is given twice; give one of RIGHT, --side-by-side, '
                   '--stereo-file, --focal-stack, '
                   '--estimate and --depth', 'depth', 'photo.ppm', 'photo.ppm', '-o', 'd.png',
                   '--depth', 'depth.pgm')
        self.fails(1, re.compile(r'^refocus: photo.ppm: (it is no stereo file|this build)'),
                   'depth', 'photo.ppm', '--stereo-file', '-o', 'd.png')
        self.fails(2, "--input-size: '8,8' cannot be used; give W,H from 32 to 2048", 'depth',
                   'photo.ppm', '--estimate', 'no.onnx', '--input-size', '8,8', '-o', 'd.png')
        self.fails(2, re.compile("^refocus: --upsample: 'magic' cannot be used"), 'depth',
                   'photo.ppm', '--depth', 'depth.pgm', '--full', '--upsample', 'magic', '-o',
                   'd.png')
        self.fails(1, re.compile(r'^refocus: no.onnx: (it cannot be read; give an ONNX file|this '
                                 r'build has no OpenCV)'),
                   'depth', 'photo.ppm', '-o', 'd.png', '--estimate', 'no.onnx')

    def strokes(self, name, *strokes, width=W, height=H):
        with open(name, 'w') as file:
            json.dump({'refocus-strokes': 1, 'width': width, 'height': height,
                       'strokes': strokes}, file)

    def test_depth_of_strokes(self):
        ground = {'kind': 'all', 'gradient': [[0, 0, 0], [0, H - 1, 1]]}
        brush = {'kind': 'brush', 'radius': 3, 'points': [[5, 5]], 'disparity': 1}
        self.strokes('s.json', ground, brush)
        report = self.reports('depth', 'photo.ppm', '--strokes', 's.json', '-o', 'a.png')
        self.assertEqual(report['depth']['source'], 'strokes')
        self.assertEqual(report['evidence'], ['painted: 2 strokes'])
        self.assertEqual((report['width'], report['height']), (W, H))
        width, height, bits, channels, rows = pictures.read_png('a.png')
        self.assertEqual((width, height, bits, channels), (W, H, 16, 1))
        for y, row in enumerate(rows):
            self.assertLessEqual(abs(int.from_bytes(row[-2:], 'big') - 65535 * y / (H - 1)), 1)
        self.assertEqual(rows[5][10:12], b'\xff\xff')
        # over a depth map: the last strokes alone change it
        self.strokes('s.json', brush)
        self.succeeds('depth', 'photo.ppm', '--depth', 'depth.pgm', '--strokes', 's.json', '-o',
                      'b.png')
        self.succeeds('depth', 'depth.pgm', '-o', 'c.png')
        over, under = pictures.read_png('b.png')[4], pictures.read_png('c.png')[4]
        self.assertEqual(sum(over[y][2 * x:2 * x + 2] != under[y][2 * x:2 * x + 2]
                             for y in range(H) for x in range(W)), 29)
        self.succeeds('depth', 'photo.ppm', '--strokes', 's.json', '-o', 'v.png', '--view',
                      'confidence')
        self.strokes('s.json', {'kind': 'object', 'radius': 3, 'points': [[12, 12]],
                                'disparity': 0.5})
        self.succeeds('depth', 'plain.ppm', '--strokes', 's.json', '-o', 'd.pfm')

    def test_strokes_in_one_step(self):
        """The bytes of the two steps, and what is saved makes them again."""
        self.strokes('s.json', {'kind': 'all', 'gradient': [[0, 0, 0], [0, H - 1, 1]]},
                     {'kind': 'brush', 'radius': 5, 'points': [[9, 9]], 'disparity': 1})
        pictures.pgm('small.pgm', W // 2, H // 2, lambda x, y: 200 if x >= W // 4 else 40)
        lens = ('--focus', '1', '--blur', '6')

        def rendered(*more):
            self.succeeds('render', 'photo.ppm', *more, *lens, '-o', 'out.ppm')
            data = pictures.read_bytes('out.ppm')
            os.remove('out.ppm')
            return data

        for base in (), ('--depth', 'depth.pgm'), ('--depth', 'small.pgm'):
            self.succeeds('depth', 'photo.ppm', *base, '--strokes', 's.json', '-o', 'map.png')
            wanted = rendered('--depth', 'map.png')
            self.assertEqual(rendered(*base, '--strokes', 's.json', '--save-settings', 'a.json'),
                             wanted)
            self.assertEqual(rendered('--settings', 'a.json'), wanted)
        self.assertEqual(rendered('--strokes', 's.json', '--low-memory'),
                         rendered('--strokes', 's.json', '--no-thin', '--matte', 'none'))
        self.succeeds('sheet', 'photo.ppm', '--strokes', 's.json', '-o', 'out.ppm')
        for depth, status, line in (('s.json', 2, '--strokes: it is for one photo; give that alone'),
                                    ('no.json', 1, None)):
            photos = ('photo.ppm', 'plain.ppm') if line else ('photo.ppm',)
            self.fails(status, line or re.compile('^refocus: no.json: cannot open it: '), 'render',
                       *photos, '--strokes', depth, *lens, '-o', '{name}-out.ppm')
        self.fails(2, re.compile('^refocus: s.json: it is an input too and would be lost'), 'render',
                   'photo.ppm', '--strokes', 's.json', '-o', 'x.ppm', '--save-settings', 's.json')

    def test_depth_of_bad_strokes(self):
        command = ('depth', 'photo.ppm', '-o', 'new.png', '--strokes')
        self.strokes('s.json', width=640)
        self.fails(1, 's.json: its strokes are of a picture of 640x32, the photo has 48x32',
                   *command, 's.json')
        self.strokes('s.json', {'kind': 'all', 'disparity': 2})
        self.fails(1, 's.json: strokes[0].disparity must be a number from 0 to 1', *command,
                   's.json')
        self.fails(1, 'no.json: cannot open it: No such file or directory', *command, 'no.json')
        self.fails(1, '.: it is a folder; give the name of a file', *command, '.')
        self.fails(1, re.compile(r'^refocus: photo.ppm: line 1 is no JSON: '), *command,
                   'photo.ppm')
        for content, why in ((b'', 'it is empty'), (b' ' * (64 << 20) + b' ',
                                                    'it is larger than the limit of 67108864 bytes')):
            with open('s.json', 'wb') as file:
                file.write(content)
            self.fails(1, 's.json: ' + why, *command, 's.json')
        self.fails(2, '--strokes: they are not painted over half a picture; give LEFT and RIGHT',
                   *command, 's.json', '--side-by-side')
        os.remove('s.json')

    def test_depth_into_jpeg(self):
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'p.jpg', '--blur', '0')
        self.succeeds('depth', 'p.jpg', '--depth', 'depth.pgm', '-o', 'd0.jpg', '--focus-at',
                      '3,4', '--blur', '5', '--near', '0.5', '--far', '7')
        self.succeeds('depth', 'd0.jpg', '-o', 'd0.png')
        self.succeeds('depth', 'depth.pgm', '-o', 'd.png')
        self.assertEqual(pictures.read_png('d0.png'), pictures.read_png('d.png'))
        for i in range(10):
            self.succeeds('depth', 'd%d.jpg' % i, '-o', 'd%d.jpg' % (i + 1))
        with open('d0.jpg', 'rb') as first, open('d10.jpg', 'rb') as last, \
                open('p.jpg', 'rb') as photo:
            first, photo = first.read(), photo.read()
            self.assertEqual(first, last.read())
        rest = first.replace(first[20:20 + len(first) - len(photo)], b'', 1)
        self.assertEqual(rest, photo)
        info = self.reports('info', 'd10.jpg')
        self.assertEqual(info['depth']['near_m'], 0.5)
        self.assertEqual((info['depth']['edges']['parted'], info['depth']['edges']['changed']),
                         (False, 0))
        self.assertRegex(self.succeeds('info', 'd10.jpg'), r"(?m)^depth edges +.*on the photo's$")
        pictures.ppm('step.ppm', 96, 64, lambda x, y: (40,) * 3 if x < 48 else (200,) * 3)
        pictures.pgm('ramp.pgm', 96, 64, lambda x, y: 50 + 15 * min(max(x - 42, 0), 12))
        self.succeeds('render', 'step.ppm', '--depth', 'ramp.pgm', '-o', 's.jpg', '--blur', '0')
        self.succeeds('depth', 's.jpg', '--depth', 'ramp.pgm', '-o', 'soft.jpg')
        edges = self.reports('info', 'soft.jpg')['depth']['edges']
        self.assertTrue(edges['parted'] and 2 < edges['softness_px'] < 6 and edges['changed'] > 0.05)
        self.assertRegex(self.succeeds('info', 'soft.jpg'), r'(?m)^placed +1?\d\.\d % of the pixels')

    def test_focus_into_jpeg(self):
        """Point and blur are read back as they were given, also of a photo that stands upright."""
        for width, height in (W, H), (H, W):
            pictures.ppm('f.ppm', width, height, lambda x, y: (5 * x, 5 * y, 90))
            pictures.pgm('f.pgm', width, height, lambda x, y: 255 if 2 * x >= width else 51)
            self.succeeds('render', 'f.ppm', '--depth', 'f.pgm', '-o', 'f.jpg', '--blur', '0')
            command = ('depth', 'f.jpg', '--depth', 'f.pgm', '-o', 'g.jpg', '--focus-at')
            for (x, y), disparity in ((3, 4), 0.2), ((width - 2, 4), 1), ((3, height - 2), 0.2):
                self.succeeds(*command, f'{x},{y}', '--blur', '5')
                info = self.reports('info', 'g.jpg')
                self.assertAlmostEqual(info['focus_point'][0], (x + 0.5) / width, 4)
                self.assertAlmostEqual(info['focus_point'][1], (y + 0.5) / height, 4)
                self.assertAlmostEqual(info['own_blur'], 5 / W, 4)
                self.assertAlmostEqual(info['depth']['blur'], 5, 2)
                self.assertAlmostEqual(info['depth_of_field']['focus'], disparity, 3)
                text = self.succeeds('info', 'g.jpg')
                self.assertIn(f'\nown blur      5.0 pixels\nfocus point   {x},{y}\n', text)
            for x, y in (width, 0), (0, height):
                self.fails(2, f'--focus-at: {x},{y} lies outside of f.jpg; give 0,0 to '
                           f'{width - 1},{height - 1}', *command, f'{x},{y}')
        for name in 'f.ppm', 'f.pgm', 'f.jpg', 'g.jpg':
            os.remove(name)

    def test_info_of_a_photo_with_a_map(self):
        """By --depth, edges, blur and focus are those that `render` finds."""
        pictures.ppm('step.ppm', 96, 64, lambda x, y: (40,) * 3 if x < 48 else (200,) * 3)
        pictures.pgm('ramp.pgm', 96, 64, lambda x, y: 50 + 15 * min(max(x - 42, 0), 12))
        for more in (), ('--depth-unit', 'inverse'), ('--invalid', 'zero', '--speckle', '3'), (
                '--depth-unit', '100/m', '--near', '0.4', '--far', '5'), ('--orient-depth', '180'):
            pair = ('step.ppm', '--depth', 'ramp.pgm', *more)
            info = self.reports('info', *pair)
            rendered = self.reports('render', *pair, '-o', 'out.ppm')
            self.assertEqual(info['depth'], info['depth'] | rendered['depth'])
            self.assertEqual(info['depth']['edges'], rendered['edges'])
            self.assertAlmostEqual(info['depth']['blur'], rendered['blur'], 5)
            self.assertAlmostEqual(info['depth_of_field']['focus'], rendered['focus'], 5)
            self.assertGreater(info['depth']['edges']['changed'], 0.02)
            self.assertEqual((info['file'], info['picture']), ('step.ppm', [96, 64]))
            self.assertTrue(info['evidence'])
        text = self.succeeds('info', 'step.ppm', '--depth', 'ramp.pgm')
        for line in (r'depth         ramp\.pgm: the file itself, as --depth reads it',
                     r'depth size    96x64, 8-bit', r'placed +1?\d\.\d % of the pixels',
                     r'because       depth file: 96 x 64 8-bit samples'):
            self.assertRegex(text, '(?m)^' + line)
        # depth that the photo has itself by another unit, and what is no pair
        unit = self.reports('info', 'mm.pgm', '--depth-unit', 'm')['depth']
        self.assertEqual((unit['meaning'], unit['near_m']), ('distance', 500))
        self.fails(2, '--orient-depth: it turns the map of --depth; give that too', 'info',
                   'photo.ppm', '--orient-depth', '90')
        self.fails(1, 'metres.pfm: it is a depth map, not a photo; give it as the depth', 'info',
                   'metres.pfm', '--depth', 'ramp.pgm')

    def test_info_of_a_map_that_is_too_large(self):
        """Near things shrink to their edges in the photo, or grow."""
        def disc(x, y, more=0):
            return math.hypot(x - 96, y - 64) < 48 + more
        pictures.ppm('disc.ppm', 192, 128, lambda x, y: (200, 150, 90) if disc(x, y) else (40,) * 3)
        for more, word in (3, 'shrunk'), (-3, 'grown'):
            pictures.pgm('disc.pgm', 192, 128, lambda x, y: 220 if disc(x, y, more) else 60)
            self.assertIn(f'near things {word} by 3 pixels\n',
                          self.succeeds('info', 'disc.ppm', '--depth', 'disc.pgm'))
        for name in 'disc.ppm', 'disc.pgm':
            os.remove(name)

    def test_info_of_holes_and_specks(self):
        """As `depth` counts them; a map of nothing but holes, which it refuses, is told."""
        pictures.pgm('odd.pgm', W, H, lambda x, y: 250 if x in (20, 21) and y in (9, 10) else 60)
        for most, specks in ('4', 0), ('5', 4):
            for command in ('info', 'odd.pgm'), ('depth', 'odd.pgm', '-o', 'a.png'):
                self.assertEqual(self.reports(*command, '--speckle', most)['depth']['specks'], specks)
        pictures.pgm('odd.pgm', W, H, lambda x, y: 0)
        holes = ('info', 'odd.pgm', '--invalid', 'zero')
        self.assertEqual(self.reports(*holes)['depth']['unknown'], W * H)
        self.assertIn(f'\nwithout value {W * H} samples, 100.0 %\n', self.succeeds(*holes))
        os.remove('odd.pgm')

    def test_info(self):
        info = self.reports('info', 'photo.ppm')
        self.assertEqual((info['container'], info['picture'], info['depth'], info['orientation'],
                          info['camera'], info['file']),
                         ('PPM', [W, H], None, 1, None, 'photo.ppm'))
        info = self.reports('info', 'metres.pfm')
        self.assertEqual((info['container'], info['depth']['width'], info['depth']['sample']),
                         ('PFM', W, 'float'))
        self.assertTrue(info['evidence'])
        text = self.succeeds('info', 'mm.pgm')
        self.assertIn('depth size    48x32, 16-bit\n', text)
        self.assertIn('because ', text)
        self.fails(1, re.compile('^refocus: missing: '), 'info', 'missing')

    def test_odd_names(self):
        """A name cannot break the one line or the terminal."""
        name = 'a\nb\x1b[31m.ppm'
        shutil.copy('photo.ppm', name)
        self.assertNotIn('\x1b', self.succeeds('info', name))
        self.assertEqual(self.reports('info', name)['file'], 'a?b?[31m.ppm')
        self.fails(1, re.compile(r'^refocus: a\?b\?\[31m.ppm: it carries no depth'), 'render',
                   name, '-o', 'out.ppm')
        os.remove(name)
        raw = b'\xff.ppm'
        shutil.copy(b'photo.ppm', raw)
        result = subprocess.run([REFOCUS, 'info', raw, '--json'], stdout=subprocess.PIPE)
        self.assertEqual(json.loads(result.stdout)['file'], '?.ppm')
        os.remove(raw)


if __name__ == '__main__':
    unittest.main()
