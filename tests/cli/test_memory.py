#!/usr/bin/env python3
"""`refocus render --low-memory`: the same picture from less memory, and what does not go with it.
Usage: test_memory.py REFOCUS [unittest arguments]"""
import os
import resource
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

    def large(self, width, height):
        row = bytes((x * 7 >> 3) & 255 for x in range(3 * width))
        with open('large.ppm', 'wb') as file:
            file.write(b'P6\n%d %d\n255\n' % (width, height) + row * height)

    def test_less_memory(self):
        self.large(1800, 1200)
        call = ('render', 'large.ppm', '--depth', 'depth.pgm', '--blur', '3', '-o', 'large-out.ppm',
                '--depth-edges', 'as-given', '--threads', '1', '--rays', '4')
        whole, strips = (self.reports(*call, *more)['peak_rss_kib']
                         for more in ((), ('--low-memory',)))
        self.assertLess(strips, 0.5 * whole)

    @unittest.skipIf('REFOCUS_BRIEF' in os.environ, 'sanitizers take memory of their own')
    @unittest.skipUnless('RF_JPEG' in os.environ, 'the photo is a JPEG')
    def test_stated(self):
        """12 megapixels with a soft map, whose edges are placed, and the original kept."""
        width, height = 4000, 3000
        lines = [bytes((x // 25 * 40 + y + 9 * (x * x + y) % 17 + c * 20) & 255
                       for x in range(width) for c in range(3)) for y in range(0, 40)]
        with open('stated.ppm', 'wb') as file:
            file.write(b'P6\n%d %d\n255\n' % (width, height) +
                       b''.join(lines[y // 3 % 40] for y in range(height)))
        pictures.pgm('soft.pgm', 500, 375, lambda x, y: 20000 + min(max(
            (120 - abs(x - 250)) * 1500, 0), 30000), 65535)
        self.succeeds('render', 'stated.ppm', '--depth', 'soft.pgm', '--blur', '0', '-o', 'sharp.jpg')
        self.succeeds('depth', 'sharp.jpg', '--depth', 'soft.pgm', '-o', 'stated.jpg')
        os.environ['MALLOC_PERTURB_'] = '0'  # with another value, what is not used is written to
        report = self.reports('render', 'stated.jpg', '--blur', '20', '--low-memory', '-o',
                              'stated-out.jpg')
        self.assertTrue(report['edges']['parted'])
        self.assertLess(report['peak_rss_kib'] * 1024, 150e6)
        self.assertGreater(os.path.getsize('stated-out.jpg'), os.path.getsize('stated.jpg'))

    def test_waits_in_a_file(self):
        """Pictures of 1000 rows wait in a temporary file, where there is a place for one."""
        self.large(1560, 1040)
        call = ('render', 'large.ppm', '--depth', 'depth.pgm', '--blur', '5', '-o', 'large-out.ppm')
        found = []
        for more in (('--no-thin', '--matte', 'none'), ('--low-memory',)):
            self.succeeds(*call, *more)
            found.append(pictures.read_bytes('large-out.ppm'))
        os.mkdir('spool')
        for folder in ('spool', 'nowhere'):
            os.environ['TMPDIR'] = os.path.abspath(folder)
            self.succeeds(*call, '--low-memory')
            found.append(pictures.read_bytes('large-out.ppm'))
        del os.environ['TMPDIR']
        self.assertEqual(os.listdir('spool'), [])
        self.assertEqual(len(set(found)), 1)

    def test_no_room_to_wait(self):
        """Where the temporary file finds no room, the folder is named, and a way out."""
        self.large(1560, 1040)
        call = ('large.ppm', '--depth', 'depth.pgm', '--blur', '5', '--low-memory', '-o')
        os.mkdir('full')
        os.environ['TMPDIR'] = os.path.abspath('full')
        old = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (3 << 20, old[1]))
        try:
            # SIGXFSZ stays ignored: a full disk raises no signal either.
            result = self.run_it('render', *call, 'no-room.ppm', restore_signals=False)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, old)
            folder = os.environ.pop('TMPDIR')
        self.assertEqual((result.returncode, result.stdout, result.stderr), (
            1, '', "refocus: large.ppm: its rows cannot wait in a file in '%s': File too large; make "
            'room there, or set TMPDIR to a folder with room for 5 MB\n' % folder))
        self.assertFalse(os.path.exists('no-room.ppm'))
        self.assertEqual(os.listdir('full'), [])

    @unittest.skipIf('REFOCUS_BRIEF' in os.environ, 'sanitizers take addresses of their own')
    def test_by_itself(self):
        """Strips are made where there is too little memory, if they suit; other things fail."""
        self.large(4000, 3000)
        call = ('render', 'large.ppm', '--depth', 'depth.pgm', '--blur', '30', '--threads', '1',
                '--depth-edges', 'as-given', '-o', 'large-out.ppm')
        self.succeeds(*call, '--low-memory')
        strips = pictures.read_bytes('large-out.ppm')
        old = resource.getrlimit(resource.RLIMIT_AS)
        try:
            resource.setrlimit(resource.RLIMIT_AS, (450 << 20, old[1]))
            self.warns('large.ppm: there is little memory: it is rendered in strips, as by '
                       '--low-memory', *call, '--save-settings', 'own.json')
            self.assertEqual(pictures.read_bytes('large-out.ppm'), strips)
            with open('own.json', encoding='utf-8') as file:
                self.assertNotIn('low-memory', file.read())
            for options in (('--method', 'scatter'), ('--fill', 'textured')):
                result = self.run_it(*call, *options)
                self.assertEqual(result.returncode, 1)
                self.assertIn('give a smaller picture or less blur', result.stderr)
        finally:
            resource.setrlimit(resource.RLIMIT_AS, old)

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
