#!/usr/bin/env python3
"""usage: test_formats.py REFOCUS  -- TIFF and OpenEXR go through the command as PNG and PFM do."""
import os
import struct
import subprocess
import unittest

import case
import pictures
from case import H, W

FORMATS = subprocess.run([case.REFOCUS, '--version'], stdout=subprocess.PIPE, text=True,
                         check=True).stdout


class Formats(case.Case):
    def setUp(self):
        with open('flat.pgm', 'wb') as file:
            file.write(b'P5\n%d %d\n255\n' % (W, H) + bytes(W * H))
        self.sharp = ('--depth', 'flat.pgm', '--blur', '0')

    def cut(self, name):
        """Half a file is refused in one line that names it."""
        with open(name, 'rb') as file:
            whole = file.read()
        with open('cut', 'wb') as file:
            file.write(whole[:len(whole) // 2])
        result = self.run_it('render', 'cut', *self.sharp, '-o', 'out.ppm')
        self.assertEqual((result.returncode, result.stdout), (1, ''))
        self.assertRegex(result.stderr, r'^refocus: cut: [^\n]+\n$')
        self.assertFalse(os.path.exists('out.ppm'))

    @unittest.skipUnless(' TIFF ' in FORMATS and ' PNG ' in FORMATS, 'needs libtiff and libpng')
    def test_tiff_keeps_16_bits(self):
        codes = [[(x * 41 + y * 2003 + c) % 65536 for x in range(W) for c in range(3)]
                 for y in range(H)]
        pictures.png('deep.png', W, H, [struct.pack('>%dH' % (3 * W), *row) for row in codes],
                     depth=16)
        for name in 'out.tiff', 'out.tif':
            self.succeeds('render', 'deep.png', *self.sharp, '-o', name)
        self.same(pictures.read_bytes('out.tiff'), pictures.read_bytes('out.tif'))
        self.assertIn('16 bits a channel', self.succeeds('info', 'out.tif'))
        self.succeeds('render', 'out.tif', *self.sharp, '-o', 'out.png')
        self.assertEqual([list(struct.unpack('>%dH' % (3 * W), row))
                          for row in pictures.read_png('out.png')[4]], codes)
        self.cut('out.tif')
        self.succeeds('depth', 'depth.pgm', '-o', 'map.tiff')
        self.succeeds('render', 'deep.png', '--depth', 'map.tiff', '--blur', '3', '-o', 'a.png')
        self.succeeds('render', 'deep.png', '--depth', 'depth.pgm', '--blur', '3', '-o', 'b.png')
        self.assertEqual(pictures.read_bytes('a.png'), pictures.read_bytes('b.png'))

    @unittest.skipUnless(' OpenEXR ' in FORMATS, 'needs OpenEXR')
    def test_openexr_keeps_light_above_white(self):
        pictures.pfm_colour('light.pfm', W, H,
                            lambda x, y: (40.0, 2.5, 0.125) if x == 9 else (x / 64, y / 32, 0.25))
        self.succeeds('render', 'light.pfm', *self.sharp, '-o', 'out.exr')
        self.succeeds('render', 'out.exr', *self.sharp, '-o', 'out.pfm')
        self.assertEqual(pictures.read_pfm('out.pfm'), pictures.read_pfm('light.pfm'))
        self.cut('out.exr')
        for photo in 'light.pfm', 'out.exr':
            self.succeeds('render', photo, '--depth', 'flat.pgm', '--focus', '1', '--blur', '6',
                          '-o', photo + '.ppm')
        self.assertEqual(pictures.read_bytes('light.pfm.ppm'), pictures.read_bytes('out.exr.ppm'))


if __name__ == '__main__':
    unittest.main()
