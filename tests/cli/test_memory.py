#!/usr/bin/env python3
"""`refocus render --low-memory`: the same picture from less memory, and what does not go with it.
Usage: test_memory.py REFOCUS [unittest arguments]"""
import unittest

import pictures
from case import Case


class LowMemory(Case):
    def same_as_whole(self, *arguments):
        """Strips make what whole photos do without thin structures."""
        self.succeeds(*self.render('--blur', '6', *arguments, '--low-memory'))
        strips = pictures.read_bytes('out.ppm')
        self.succeeds(*self.render('--blur', '6', *arguments, '--no-thin'))
        self.same(pictures.read_bytes('out.ppm'), strips, arguments)

    def test_same_picture(self):
        pictures.pgm('small.pgm', 12, 8, lambda x, y: 255 if x >= 5 else 51)
        self.same_as_whole('--focus', '1')
        self.same_as_whole('--depth-edges', 'as-given')
        self.same_as_whole('--depth', 'small.pgm', '--focus-at', '40,9')
        self.same_as_whole('--depth', 'small.pgm', '--depth-edges', 'as-given', '--threads', '2')
        self.same_as_whole('--depth', 'mm.pgm', '--depth-unit', 'mm', '--region', '4,4,20,20')
        self.same_as_whole('--quality', 'preview', '--highlights', '4')

    def test_holes_of_a_small_map(self):
        pictures.pgm('holes.pgm', 12, 8, lambda x, y: 0 if x == 3 else 500 if x < 6 else 2000, 65535)
        self.same_as_whole('--depth', 'holes.pgm', '--depth-unit', 'mm')
        self.same_as_whole('--depth', 'holes.pgm', '--depth-unit', 'mm', '--depth-edges',
                           'as-given')

    def test_less_memory(self):
        width, height = 2000, 1000
        row = bytes((x * 7 >> 3) & 255 for x in range(3 * width))
        with open('large.ppm', 'wb') as file:
            file.write(b'P6\n%d %d\n255\n' % (width, height) + row * height)
        call = ('render', 'large.ppm', '--depth', 'depth.pgm', '--blur', '3', '-o', 'large-out.ppm',
                '--depth-edges', 'as-given', '--threads', '1', '--rays', '4')
        whole, strips = (self.reports(*call, *more)['peak_rss_kib']
                         for more in ((), ('--low-memory',)))
        self.assertLess(strips, 0.65 * whole)

    def test_large_photos(self):
        """Edges are placed at a smaller size; the picture is nearly the same."""
        width, height = 2400, 1800
        rows = [bytes(v for x in range(width) for v in (
            (40, 90, 30) if (x - 1200) ** 2 + (y - 900) ** 2 > 500 ** 2 else (200, 180, 90)))
            for y in range(0, height, 100)]
        with open('large.ppm', 'wb') as file:
            file.write(b'P6\n%d %d\n255\n' % (width, height) +
                       b''.join(rows[y // 100] for y in range(height)))
        pictures.pgm('large-depth.pgm', 240, 180, lambda x, y: 255 if (
            x - 120) ** 2 + (y // 10 * 10 - 90) ** 2 <= 50 ** 2 else 60)
        found = []
        for more in ('--no-thin', '--low-memory'):
            self.succeeds('render', 'large.ppm', '--depth', 'large-depth.pgm', '--blur', '8',
                          '--focus', '1', '--rays', '16', '-o', 'out.ppm', more)
            found.append(pictures.read_bytes('out.ppm')[-3 * width * height:])
        other = sum(abs(a - b) > 16 for a, b in zip(found[0][::301], found[1][::301]))
        self.assertLess(other, len(found[0]) / 301 / 200)

    def test_refused(self):
        for line, options in (
                ('--low-memory: method scatter needs the whole photo; leave one out',
                 ('--method', 'scatter')),
                ('--low-memory: it does not go with --matte; leave one out',
                 ('--matte', 'depth.pgm')),
                ('--low-memory: it does not go with --behind; leave one out',
                 ('--behind', 'plain.ppm', '--behind-depth', 'depth.pgm')),
                ('--low-memory: it does not go with --fill textured; leave one out',
                 ('--fill', 'textured')),
                ('--low-memory: views need the whole photo; leave it or --view out',
                 ('--view', 'blur'))):
            self.fails(2, line, *self.render('--low-memory', *options))


if __name__ == '__main__':
    unittest.main()
