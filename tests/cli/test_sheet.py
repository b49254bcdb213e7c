#!/usr/bin/env python3
"""refocus sheet: cells are what render makes of the same setting, smaller ones its averages, and
nothing partial stays. Usage: test_sheet.py REFOCUS [unittest arguments]"""
import math
import os
import re
import signal
import subprocess
import time
import unittest

import pictures
from case import H, REFOCUS, W, Case

GAP, CAPTION = 4, 10


class Sheet(Case):
    def sheet(self, *arguments):
        return ('sheet', 'photo.ppm', '--depth', 'depth.pgm', '-o', 's.ppm') + arguments

    def made(self, *arguments):
        """The report, the picture, and its cells."""
        report = self.reports(*self.sheet(*arguments))
        width, height, samples = pictures.read_pnm('s.ppm')
        os.remove('s.ppm')
        columns = report['columns']
        rows = -(-len(report['cells']) // columns)
        w = (width - GAP) // columns - GAP
        h = (height - GAP) // rows - GAP - CAPTION
        self.assertEqual((width, height), (report['width'], report['height']))
        self.assertEqual((width, height),
                         (columns * (w + GAP) + GAP, rows * (h + GAP + CAPTION) + GAP))

        def part(left, top, rows_):
            return tuple(v for y in range(rows_)
                         for v in samples[3 * ((top + y) * width + left):][:3 * w])

        cells, captions = [], []
        for i in range(len(report['cells'])):
            left = GAP + i % columns * (w + GAP)
            top = GAP + i // columns * (h + CAPTION + GAP)
            cells.append((w, h, part(left, top, h)))
            captions.append(part(left, top + h, CAPTION))
        return report, cells, captions

    def rendered(self, *arguments):
        self.succeeds(*self.render(*arguments))
        picture = pictures.read_pnm('out.ppm')
        os.remove('out.ppm')
        return picture

    def test_focus(self):
        report, cells, captions = self.made('--focuses', '0,0.2,1', '--blurs', '2,6')
        self.assertEqual((report['kind'], report['columns']), ('focus', 3))
        self.assertEqual(report['cells'],
                         ['focus %s  blur %s' % (f, k) for k in (2, 6) for f in (0, 0.2, 1)])
        for i, (k, f) in enumerate((k, f) for k in (2, 6) for f in (0, 0.2, 1)):
            self.same(cells[i], self.rendered('--blur', str(k), '--focus', str(f)), i)
        self.assertEqual(set(captions[0]), {16, 240})
        cells = self.made('--focuses', '0.2', '--blurs', '30,40')[1]  # of 144 and of 256 rays
        for i, k in enumerate(('30', '40')):
            self.same(cells[i], self.rendered('--blur', k, '--focus', '0.2'))
        report = self.made('--blur', '8')[0]
        self.assertEqual(len(report['cells']), 15)
        self.assertEqual(report['cells'][0], 'focus 0  blur 2')
        self.assertEqual(report['cells'][14], 'focus 1  blur 8')

    def test_f_numbers(self):
        lens = ('--near', '1', '--far', '4', '--focal-length', '50', '--sensor-width', '36')
        report, cells, _ = self.made('--f-numbers', '8,2', '--focuses', '0.5', *lens)
        self.assertEqual(report['cells'], ['focus 0.5  f/8', 'focus 0.5  f/2'])
        for i, n in enumerate(('8', '2')):
            self.same(cells[i], self.rendered('--f-number', n, '--focus', '0.5', *lens))

    def test_apertures(self):
        pictures.pgm('mask.pgm', 5, 5, lambda x, y: 255 if x == 2 else 0)
        shapes = ('disc', 'polygon:3', 'polygon:6:15', './mask.pgm', 'polygon:16')
        report, cells, _ = self.made('--kind', 'aperture', '--apertures', ','.join(shapes),
                                     '--focus', '1', '--blur', '7')
        self.assertEqual(report['cells'], [s.split('/')[-1] for s in shapes])
        self.assertEqual(report['columns'], 4)
        for cell, shape in zip(cells, shapes):
            self.same(cell, self.rendered('--focus', '1', '--blur', '7', '--aperture', shape))
        self.assertEqual(len(self.made('--kind', 'aperture')[1]), 8)

    def test_bokeh(self):
        names = re.search(r'--bokeh NAME.*?\n((?: {28}.*\n)+)',
                          self.succeeds('sheet', '--help-all')).group(1)
        names = re.findall(r'(?m)^ {28}(\S+)', names)
        self.assertIn('swirl', names)
        for more in (), ('--cat-eye', '0.3', '--seed', '2', '--grain', '0.5'):
            report, cells, _ = self.made('--kind', 'bokeh', '--focus', '1', '--blur', '7', *more)
            self.assertEqual((report['cells'], report['columns']), (names, 4))
            for cell, name in zip(cells, names):
                self.same(cell, self.rendered('--focus', '1', '--blur', '7', '--bokeh', name,
                                              *more), name)
        self.fails(2, '--bokeh: the sheet has a cell for each; leave it out',
                   *self.sheet('--kind', 'bokeh', '--bokeh', 'swirl'))
        self.fails(2, '--cat-eye: it does not go with --method search; give sweep, or leave it '
                   'out', *self.sheet('--kind', 'bokeh', '--method', 'search'))

    def test_sigmas(self):
        report, cells, _ = self.made('--kind', 'sigma', '--sigmas', 'off,50', '--focus', '1')
        self.assertEqual(report['cells'][:3],
                         ['linear  sigma off', 'linear  sigma 50', 'stored  sigma off'])
        names = [(b, s) for b in ('linear', 'stored', 'gamma') for s in ('off', '50')]
        for cell, (blend, sigma) in zip(cells, names):
            self.same(cell, self.rendered('--focus', '1', '--blend', blend, '--sigma', sigma))

    def test_before_after(self):
        report, cells, _ = self.made('--kind', 'before-after', '--focus', '0.2', '--blur', '5')
        self.assertEqual(report['cells'], ['before', 'after'])
        self.same(cells[0], pictures.read_pnm('photo.ppm'))
        self.same(cells[1], self.rendered('--focus', '0.2', '--blur', '5'))
        cells = self.made('--kind', 'before-after', '--focus', '0.2', '--blur', '5', '--region',
                          '20,3,10,16')[1]
        photo = pictures.read_pnm('photo.ppm')[2]
        self.same(cells[0][2], tuple(v for y in range(3, 19)
                                     for v in photo[3 * (y * W + 20):3 * (y * W + 30)]))
        self.same(cells[1], self.rendered('--focus', '0.2', '--blur', '5', '--region',
                                          '20,3,10,16'))

    def test_smaller_cells_are_averages(self):
        photo = pictures.read_pnm('photo.ppm')[2]
        for width in (24, 10, 8):
            cells = self.made('--kind', 'before-after', '--cell-width', str(width))[1]
            w, h, samples = cells[0]
            self.assertEqual((w, h), (width, (H * width + W // 2) // W))

            def part(i, n, source):
                """Source pixels under target pixel i, with their shares."""
                begin, end = i * source / n, (i + 1) * source / n
                return [(j, min(end, j + 1) - max(begin, j))
                        for j in range(int(begin), min(source, math.ceil(end)))]

            for y in range(h):
                for x in range(w):
                    for c in range(3):
                        mean = sum(a * b * photo[3 * (j * W + i) + c] ** 2
                                   for j, a in part(y, h, H) for i, b in part(x, w, W))
                        mean /= (H / h) * (W / w)
                        self.assertAlmostEqual(samples[3 * (y * w + x) + c], math.sqrt(mean),
                                               delta=0.51 + 0.5 / (2 * math.sqrt(mean) + 1))

    def test_lists(self):
        for option, kind, bad, what in (
                ('--focuses', 'focus', '1.1', 'a number from 0 to 1'),
                ('--focuses', 'focus', 'x', 'a number from 0 to 1'),
                ('--blurs', 'focus', '945', 'a number from 0 to 944'),
                ('--f-numbers', 'focus', '0', 'a number above 0, at most 1000'),
                ('--sigmas', 'sigma', '0.5', "a number from 1 to 1e+30, or 'off'")):
            self.fails(2, "%s: '%s' cannot be used; give %s" % (option, bad, what),
                       *self.sheet('--kind', kind, option, '1,' + bad))
            for empty in ('1,', ',1', '1,,1', ','):
                self.fails(2, option + ': one of its values is empty; give values with commas '
                           'between', *self.sheet('--kind', kind, option, empty))
            self.fails(2, option + ': one of its values is too long',
                       *self.sheet('--kind', kind, option, '1' * 99))
            self.fails(2, option + ': has too many values; give at most 16',
                       *self.sheet('--kind', kind, option, ','.join('1' * 17)))
        self.succeeds(*self.sheet('--focuses', ','.join('1' * 16), '--blurs', ','.join('1' * 16)))
        os.remove('s.ppm')
        self.fails(2, re.compile('^refocus: --aperture: \'polygon:2\' cannot be used'),
                   *self.sheet('--kind', 'aperture', '--apertures', 'disc,polygon:2'))
        self.fails(2, '--apertures: has too many values; give at most 16',
                   *self.sheet('--kind', 'aperture', '--apertures', ','.join(['disc'] * 17)))
        for option, kind, other in (('--focuses', 'focus', 'sigma'), ('--sigmas', 'sigma', 'focus'),
                                    ('--blurs', 'focus', 'aperture'),
                                    ('--f-numbers', 'focus', 'before-after'),
                                    ('--apertures', 'aperture', 'focus')):
            self.fails(2, '%s: goes with --kind %s alone; leave one of them out' % (option, kind),
                       *self.sheet('--kind', other, option, '1'))
        self.fails(2, '--f-numbers: is in place of --blurs; leave one of them out',
                   *self.sheet('--f-numbers', '2', '--blurs', '2'))
        self.fails(2, '--f-numbers: is in place of --blur and --f-number; leave them out',
                   *self.sheet('--f-numbers', '2', '--blur', '2'))

    def test_sizes(self):
        for width in ('7', '8193', '8.5', 'x'):
            self.fails(2, "--cell-width: '%s' cannot be used; give a whole number from 8 to 8192"
                       % width, *self.sheet('--cell-width', width))
        self.fails(2, re.compile('^refocus: --region: 40,0,9,9 does not lie within the 48x32'),
                   *self.sheet('--region', '40,0,9,9'))
        pictures.ppm('wide.ppm', 8000, 2, lambda x, y: (x & 255, y, 0))
        pictures.pgm('wide.pgm', 8, 2, lambda x, y: 30 * x)
        self.fails(1, 's.ppm: the sheet would be too large; give a smaller --cell-width or fewer '
                   'values', 'sheet', 'wide.ppm', '--depth', 'wide.pgm', '-o', 's.ppm',
                   '--cell-width', '8000', '--blurs', '1', '--focuses', '0,0,0,0,0,0,0,0,0')
        os.remove('wide.ppm')
        os.remove('wide.pgm')

    def test_outputs(self):
        self.fails(2, '-o: the output has no name; give -o OUT', 'sheet', 'photo.ppm')
        self.fails(2, re.compile('no such format is written'), 'sheet', 'photo.ppm', '-o', 'a.bmp')
        self.fails(2, re.compile('it is an input too'), *self.sheet('-o', 'photo.ppm'))
        self.fails(1, re.compile('^refocus: no.ppm: '), 'sheet', 'no.ppm', '-o', 's.ppm')

    def test_interrupted(self):
        before = sorted(os.listdir('.'))
        many = ','.join(str(127 - i) for i in range(16))
        process = subprocess.Popen([REFOCUS, *self.sheet('--blurs', many, '--focuses',
                                                         ','.join('1' * 16), '--rays', 'full',
                                                         '--method', 'raytrace')],
                                   stderr=subprocess.PIPE, text=True)
        time.sleep(0.5)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        self.assertIn('interrupted', process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 1)
        self.assertEqual(sorted(os.listdir('.')), before)

    def test_settings_describe_the_sheet(self):
        _, cells, captions = self.made('--focuses', '0,0.7', '--blurs', '3', '--save-settings',
                                       's.json')
        self.succeeds('sheet', 'photo.ppm', '-o', 's.ppm', '--settings', 's.json')
        self.assertEqual(self.made('--settings', 's.json')[1:], (cells, captions))
        os.remove('s.json')


if __name__ == '__main__':
    unittest.main()
