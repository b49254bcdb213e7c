#!/usr/bin/env python3
"""refocus depth with damaged, mismatched, empty and huge files in every place that takes one: one
clear line, nothing written. Usage: test_depth_inputs.py REFOCUS [unittest arguments]"""
import os
import re
import struct
import unittest

import pictures
from case import Case, H, PHOTOS, W

# file: what is said of it
PICTURES = {
    'empty': 'it is empty',
    'text': 'its content is of no known format',
    'cut.ppm': 'damaged: it ends in the middle of the picture',
    'none.pgm': 'damaged: it claims a picture without pixels',
    'huge.ppm': r'its 65535 x 65535 pixels are more than the limit of \d+ pixels',
    'huge.pgm': r'its 65535 x 65535 pixels are more than the limit of \d+ pixels',
    'missing': 'cannot open it: No such file',
    '.': 'cannot read it: Is a directory',
}
STROKES = {
    'empty': 'it is empty',
    'text': 'line 1 is no JSON',
    'cut.json': 'line 1 is no JSON',
    'deep.json': 'line 1 is no JSON',
    'huge.json': 'width and height must be those of the photo, 48x32',
    'huge.ppm': 'line 1 is no JSON',
    'missing': 'cannot open it: No such file',
    '.': 'cannot read it: Is a directory',
}


def write(name, data):
    with open(name, 'wb') as file:
        file.write(data)


class DepthInputs(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        write('empty', b'')
        write('text', b'not a picture\n')
        write('cut.ppm', pictures.read_bytes('photo.ppm')[:100])
        write('none.pgm', b'P5\n0 0\n255\n')
        write('huge.ppm', b'P6\n65535 65535\n255\n')
        write('huge.pgm', b'P5\n65535 65535\n255\n')
        write('huge.pfm', b'Pf\n65535 65535\n-1\n')
        write('unknown.pfm', b'Pf\n%d %d\n-1\n' % (W, H) + struct.pack('<f', float('nan')) * W * H)
        pictures.pgm('holes.pgm', W, H, lambda x, y: 0)
        pictures.ppm('other.ppm', 20, 20, lambda x, y: (x, y, 3))
        pictures.ppm('thin.ppm', 1, 40, lambda x, y: (1, 2, 3))
        strokes = b'{"refocus-strokes": 1, "width": %s, "height": 32, "strokes": []}'
        write('s.json', strokes % b'48')
        write('huge.json', strokes % b'1e300')
        write('wide.json', strokes % b'640')
        write('cut.json', (strokes % b'48')[:30])
        write('deep.json', b'[' * 100000)
        write('old.pgm', b'old')

    def setUp(self):
        self.opencv = 'bilinear' in self.run_it('depth', '--help').stdout

    def refused(self, name, why, *arguments):
        """Onto a file that is there, which stays, and onto a new one."""
        for out in 'old.pgm', 'new.pgm':
            self.fails(1, re.compile('^refocus: %s: (%s)[^\n]*\n$' % (re.escape(name), why)),
                       'depth', *arguments, '-o', out)

    def need_opencv(self):
        if not self.opencv:
            self.skipTest('this build has no OpenCV')

    def test_depth(self):
        for name, why in PICTURES.items():
            self.refused(name, why, name)
            self.refused(name, why, name, '--depth', 'depth.pgm')
            self.refused(name, why, 'photo.ppm', '--depth', name)
            self.refused(name, why, 'photo.ppm', '--depth', name, '--full', '--speckle', '9')
        self.refused('huge.pfm', PICTURES['huge.pgm'], 'photo.ppm', '--depth', 'huge.pfm')
        for name in 'holes.pgm', 'unknown.pfm':
            self.refused(name, 'no sample of the depth map holds a value', 'photo.ppm', '--depth',
                         name, '--depth-unit', 'mm' if name == 'holes.pgm' else 'm')
        self.refused('photo.ppm', 'it is a colour picture, not a depth map', 'photo.ppm',
                     '--depth', 'photo.ppm')
        self.refused('metres.pfm', '(it|a PFM file) is a depth map, not a photo', 'metres.pfm', '--depth',
                     'depth.pgm')

    def test_shape(self):
        """The map of another picture, or one on its side; squares, as networks make them, and a
        few samples are for any shape."""
        pictures.pgm('side.pgm', H, W, lambda x, y: 9 * x & 255)
        pictures.pgm('long.pgm', 80, 16, lambda x, y: x)
        pictures.pgm('4to3.pgm', 40, 30, lambda x, y: x)
        pictures.pgm('few.pgm', 1, 15, lambda x, y: 16 * y)
        for name, size in (('side.pgm', '32x48'), ('long.pgm', '80x16')):
            why = 'its %s samples have another shape than the photo of 48x32 pixels; give the ' \
                  'map of this photo, as upright as the photo is' % size
            self.refused(name, why, 'photo.ppm', '--depth', name)
            self.refused(name, why, 'photo.ppm', '--depth', name, '--full')
            for command in 'render', 'sheet':
                self.fails(1, '%s: %s' % (name, why), command, 'photo.ppm', '--depth', name, '-o',
                           'new.ppm')
            self.succeeds('depth', name, '-o', 'made.pgm')
        for name in '4to3.pgm', 'few.pgm':
            self.succeeds('depth', 'photo.ppm', '--depth', name, '--full', '-o', 'made.pgm')
        pictures.ppm('wide.ppm', 64, 32, lambda x, y: (x, y, 0))
        pictures.pgm('square.pgm', 32, 32, lambda x, y: x)
        self.succeeds('depth', 'wide.ppm', '--depth', 'square.pgm', '--full', '-o', 'made.pgm')

    def test_cut_heic(self):
        whole = os.path.join(PHOTOS, 'stereo', 'spatial-photo.heic')
        if not os.path.exists(whole):
            self.skipTest('no photos')
        if self.run_it('info', whole).returncode:
            self.skipTest('this build does not read HEIC')
        write('cut.heic', pictures.read_bytes(whole)[:100000])
        why = 'damaged HEIC: it ends too early; copy it again'
        for arguments in ('cut.heic',), ('cut.heic', '--full'), ('photo.ppm', '--depth', 'cut.heic'):
            self.refused('cut.heic', why, *arguments)

    def test_upsample(self):
        self.need_opencv()
        for name, why in PICTURES.items():
            how = ('--full', '--upsample', 'bilinear')
            self.refused(name, why, 'photo.ppm', '--depth', name, *how)
            self.refused(name, why, name, '--depth', 'depth.pgm', *how)

    def test_strokes(self):
        for name, why in STROKES.items():
            self.refused(name, why, 'photo.ppm', '--strokes', name)
            self.refused(name, why, 'photo.ppm', '--depth', 'depth.pgm', '--strokes', name)
        for name, why in PICTURES.items():
            self.refused(name, why, name, '--strokes', 's.json')
            self.refused(name, why, 'photo.ppm', '--depth', name, '--strokes', 's.json')
        for name, photo in ('wide.json', 'photo.ppm'), ('s.json', 'other.ppm'):
            self.refused(name, 'its strokes are of a picture of', photo, '--strokes', name)

    def test_stereo(self):
        self.need_opencv()
        for name, why in PICTURES.items():
            self.refused(name, why, 'photo.ppm', name)
            self.refused(name, why, name, 'photo.ppm')
            self.refused(name, why, name, '--side-by-side')
            self.refused(name, why, name, '--stereo-file')
        self.refused('other.ppm', 'the two pictures differ in size', 'photo.ppm', 'other.ppm')
        self.refused('metres.pfm', '(it|a PFM file) is a depth map, not a photo', 'photo.ppm', 'metres.pfm')
        self.refused('photo.ppm', 'the pictures are too small to be matched', 'photo.ppm',
                     '--side-by-side')
        self.refused('thin.ppm', 'it is one pixel wide; give two pictures side by side',
                     'thin.ppm', '--side-by-side')
        self.refused('photo.ppm', 'it is no stereo file', 'photo.ppm', '--stereo-file')

    def test_estimate(self):
        self.need_opencv()
        for name, why in PICTURES.items():
            self.refused(name, 'OpenCV finds no depth network|it cannot be read', 'photo.ppm',
                         '--estimate', name)
            self.refused(name, why, name, '--estimate', 'text')

    def test_without_opencv(self):
        if self.opencv:
            self.skipTest('this build has OpenCV')
        for name in PICTURES:
            none = 'this build has no OpenCV'
            self.refused(name, none, 'photo.ppm', name)
            self.refused(name, none, name, '--side-by-side')
            self.refused(name, none, name, '--stereo-file')
            self.refused(name, none, 'photo.ppm', '--estimate', name)


if __name__ == '__main__':
    unittest.main()
