#!/usr/bin/env python3
"""The same photo, depth and lens make the same pixels whichever command makes the picture: a cell of
`sheet`, a frame of `pull` and a method of `compare` are what `render` writes, of photos of 8 and of
16 bits, of floats and with a gain map. Usage: test_agree.py REFOCUS [unittest arguments]"""
import os
import struct
import unittest

import pictures
from case import Case, H, W

GAP = 4
DEPTH = '--depth', 'depth.pgm'
LENS = DEPTH + ('--blur', '9')


def bright(x, y):
    return 30 <= x < 34 and 12 <= y < 16


class Agree(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        pictures.png('eight.png', W, H, [bytes(
            v for x in range(W) for v in ((x * 5) & 255, (y * 8) & 255, 255 if bright(x, y) else 70))
            for y in range(H)])
        pictures.png('sixteen.png', W, H, [struct.pack('>%dH' % (3 * W), *(
            65535 if bright(x, y) else 9000 + x * 1100 + y * 7 + c for x in range(W)
            for c in range(3))) for y in range(H)], depth=16)
        pictures.pfm_colour('light.pfm', W, H, lambda x, y: tuple(
            12.5 if bright(x, y) else 0.05 + (x * 3 + y + c) / 200 for c in range(3)))
        pictures.ppm('dim.ppm', W, H, lambda x, y: (
            (255,) * 3 if bright(x, y) else (x * 4, y * 6, 90)))
        pictures.ppm('gains.ppm', W, H, lambda x, y: (255 if bright(x, y) else 0,) * 3)

    def makes(self, *arguments):
        """A line may say that 8 bits are taken."""
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        return result.stdout

    def written(self, photo, name):
        self.succeeds('render', photo, *LENS, '--blur', '0', '--focus', '0', '-o', name)

    def photos(self):
        """Names, and whether there is more than 8 bits."""
        for name in 'dim', 'gains':
            self.written(name + '.ppm', name + '.jpg')
        pictures.ultra_hdr('hdr.jpg', 'dim.jpg', 'gains.jpg', 3)
        yield from (('eight.png', False), ('sixteen.png', True), ('light.pfm', True),
                    ('hdr.jpg', True))
        if ' OpenEXR ' in self.succeeds('--version'):
            self.written('light.pfm', 'light.exr')
            yield 'light.exr', True

    def cell(self, photo, *options):
        """The first cell of a sheet, as tall and as wide as the photo."""
        self.makes('sheet', photo, *DEPTH, '--cell-width', str(W), '-o', 's.ppm', *options)
        width, _, samples = pictures.read_pnm('s.ppm')
        return tuple(v for y in range(GAP, GAP + H)
                     for v in samples[3 * (y * width + GAP):3 * (y * width + GAP + W)])

    def test_sheet(self):
        for photo, _ in self.photos():
            for more in (), ('--no-dither',), ('--grain', 'off'):
                self.makes('render', photo, *LENS, '--focus', '0.2', *more, '-o', 'r.ppm')
                wanted = pictures.read_pnm('r.ppm')[2]
                for kind in (('--focuses', '0.2', '--blurs', '9'),
                             ('--kind', 'aperture', '--blur', '9', '--focus', '0.2', '--apertures', 'disc,heart'),
                             ('--kind', 'sigma', '--blur', '9', '--focus', '0.2', '--sigmas', 'off,100'),
                             ('--kind', 'bokeh', '--blur', '9', '--focus', '0.2')):
                    self.same(self.cell(photo, *kind, *more), wanted, (photo, kind, more))

    def test_cells_that_take_the_photo_otherwise(self):
        """Cells with and without sigma are made of different bits of one photo: none leaves
        anything to the next."""
        width = 3 * (W + GAP) + GAP
        for photo, deep in self.photos():
            command = ('sheet', photo, *LENS, '--cell-width', str(W), '-o', 's.ppm', '--kind', 'sigma',
                       '--focus', '0.2', '--sigmas', 'off,100,off')
            line = r'refocus: %s: it has (16|32) bits a channel; 8 are taken, dithered\n' % photo
            result = self.run_it(*command)
            self.assertRegex(result.stderr, '^(%s)?$' % line)  # once
            samples = pictures.read_pnm('s.ppm')[2]
            cells = [[samples[3 * (y * width + x):3 * (y * width + x + W)]
                      for y in range(GAP, GAP + H)] for x in (GAP, GAP + W + GAP, GAP + 2 * (W + GAP))]
            self.same(cells[0], cells[2], photo)
            self.makes('render', photo, *LENS, '--focus', '0.2', '--sigma', '100', '-o', 'r.ppm')
            self.same(tuple(v for row in cells[1] for v in row), pictures.read_pnm('r.ppm')[2], photo)
            if deep:
                self.differs(cells[0], cells[1])

    def test_pull(self):
        for photo, deep in self.photos():
            for ending in 'ppm', 'png', 'pfm':
                command = LENS + (() if photo == 'eight.png' else ('--no-dither',))
                self.succeeds('render', photo, *command, '--focus', '0.2', '-o', 'r.' + ending)
                self.succeeds('pull', photo, *command, '--from', '0.2', '--seconds', '0.04', '-o',
                              'f%d.' + ending)
                if ending == 'png':
                    self.assertEqual(pictures.read_png('f0.png')[2],
                                     16 if deep and photo != 'hdr.jpg' else 8)
                    self.same(pictures.read_png('f0.png'), pictures.read_png('r.png'), photo)
                else:
                    self.same(pictures.read_bytes('f0.' + ending), pictures.read_bytes('r.' + ending),
                              (photo, ending))
            self.assertGreater(max(pictures.read_pfm('f0.pfm')[2]), 1.01 if deep and
                               photo != 'sixteen.png' else 0)

    def test_compare(self):
        """Also beside methods that take 8 bits alone, before it and behind it."""
        for photo, _ in self.photos():
            lens = LENS + ('--focus', '0.2', '--quality', 'standard')
            for method in 'sweep', 'search':
                self.makes('render', photo, *lens, '--grain', 'off', '--method', method, '-o',
                              method + '.ppm')
            for method, methods in (('sweep', 'sweep'), ('sweep', 'scatter,sweep,blur'),
                                    ('search', 'sweep:sigma=100,search,scatter'),
                                    ('sweep', 'search,sweep:blend=linear:sigma=off,sweep:blend=stored')):
                table = self.makes('compare', photo, *lens, '--reference', method + '.ppm',
                                   '--border', '0', '--methods', methods)
                rows = [line.split() for line in table.splitlines()[1:]]
                wanted = next(row for row in rows if row[0].startswith(method) and
                              'sigma=100' not in row[0])
                self.assertEqual(wanted[4], '0.00', (photo, methods, rows))

    def test_transfer(self):
        """--transfer and --white mean the same everywhere."""
        for photo in 'sixteen.png', 'light.pfm':
            more = ('--focus', '0.2', '--transfer', 'linear', '--white', '0.5')
            self.succeeds('render', photo, *LENS, *more, '-o', 'r.ppm')
            wanted = pictures.read_pnm('r.ppm')[2]
            self.same(self.cell(photo, '--kind', 'aperture', '--apertures', 'disc', '--blur',
                                '9', *more), wanted)
            self.succeeds('pull', photo, *LENS, '--from', '0.2', *more[2:], '--seconds', '0.04',
                          '-o', 'f%d.ppm')
            self.same(pictures.read_pnm('f0.ppm')[2], wanted)
            scores = self.reports('compare', photo, *LENS, *more, '--reference', 'r.ppm',
                                  '--methods', 'sweep', '--border', '0')['methods']
            self.assertEqual(scores[-1]['rmse'], 0)
        self.fails(1, '--transfer: the option is for photos of more than 8 bits, rendered by sweep, '
                   'search, blur or interpolated in linear light without --sigma, --grain, --star, '
                   '--view and --wiggle; leave it out', 'pull', 'sixteen.png', *LENS, '--transfer',
                   'linear', '--focus', '0', '--wiggle', '2', '-o', 'f%d.ppm')
        os.remove('r.ppm')


if __name__ == '__main__':
    unittest.main()
