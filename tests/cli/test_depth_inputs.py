#!/usr/bin/env python3
"""refocus depth with damaged, mismatched, empty and huge files in every place that takes one: one
clear line, nothing written. Usage: test_depth_inputs.py REFOCUS [unittest arguments]"""
import os
import re
import shutil
import struct
import subprocess
import unittest

import pictures
from case import Case, H, PHOTOS, REFOCUS, W

# file: what is said of it
PICTURES = {
    'empty': 'it is empty',
    'text': 'its content is of no known format',
    'cut.ppm': 'damaged: it ends in the middle of the picture',
    'none.pgm': 'damaged: it claims a picture without pixels',
    'huge.ppm': r'its 65535 x 65535 pixels are more than the limit of 32768 a side',
    'huge.pgm': r'its 65535 x 65535 pixels are more than the limit of 32768 a side',
    'missing': 'cannot open it: No such file',
    '.': 'it is a folder; give the name of a file',
}
STROKES = {
    'empty': 'it is empty',
    'text': 'line 1 is no JSON',
    'cut.json': 'line 1 is no JSON',
    'deep.json': 'line 1 is no JSON',
    'huge.json': 'width and height must be those of the photo, 48x32',
    'huge.ppm': 'line 1 is no JSON',
    'missing': 'cannot open it: No such file',
    '.': 'it is a folder; give the name of a file',
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
        self.opencv = 'OpenCV' in self.run_it('--version').stdout

    def refused(self, name, why, *arguments):
        """Onto a file that is there, which stays, and onto a new one."""
        for out in 'old.pgm', 'new.pgm':
            self.fails(1, re.compile('^refocus: %s: (%s)[^\n]*\n$' % (re.escape(name), why)),
                       'depth', *arguments, '-o', out)

    def need_opencv(self):
        if not self.opencv:
            self.skipTest('this build has no OpenCV')

    def test_opencv_is_a_module(self):
        """The command starts without OpenCV, and tells what is missing where it is asked for."""
        self.need_opencv()
        found = subprocess.run(['ldd', REFOCUS], stdout=subprocess.PIPE, text=True)
        if found.returncode:
            self.skipTest('no ldd for this command')
        self.assertNotIn('opencv', found.stdout)
        own = re.findall(r'=> (\S*/)librefocus', found.stdout)
        os.makedirs('alone/bin')
        shutil.copy(REFOCUS, 'alone/bin/refocus')
        for call in (('depth', 'photo.ppm', '--estimate', 'no.onnx', '-o', 'new.pgm'),
                     ('render', 'photo.ppm', '--depth', 'small.pgm', '--upsample', 'guided', '-o',
                      'new.ppm')):
            pictures.pgm('small.pgm', 12, 8, lambda x, y: 20 * x)
            result = subprocess.run(['alone/bin/refocus', *call], stderr=subprocess.PIPE, text=True,
                                    env={**os.environ, 'LD_LIBRARY_PATH': ':'.join(own)})
            self.assertRegex(result.stderr, r'^refocus: (no.onnx|--upsample): librefocus-opencv '
                             r'cannot be loaded: [^\n]*\n$')
            self.assertEqual(result.returncode, 1)

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

    def test_map_of_one_half(self):
        """That of one of two pictures side by side does not lie on its side."""
        pictures.ppm('pair.ppm', 2 * W, H, lambda x, y: (x, y, 9))
        pictures.pgm('half.pgm', W, H, lambda x, y: 9 * x & 255)
        for command in 'render', 'sheet':
            self.fails(1, 'half.pgm: its 48x32 samples are of one half of the photo of 96x32 pixels; '
                       'give that half as the photo, of two pictures side by side the first one',
                       command, 'pair.ppm', '--depth', 'half.pgm', '-o', 'new.ppm')
        for width, height, why in (42, H, 'another shape'), (34, 2 * W, 'on their side'):
            pictures.pgm('half.pgm', width, height, lambda x, y: 5 * x)
            self.fails(1, re.compile(why), 'render', 'pair.ppm', '--depth', 'half.pgm', '-o',
                       'new.ppm')

    def test_shape(self):
        """The map of another picture, or one on its side; squares, as networks make them, and a
        few samples are for any shape."""
        pictures.pgm('side.pgm', H, W, lambda x, y: 9 * x & 255)
        pictures.pgm('long.pgm', 80, 16, lambda x, y: x)
        pictures.pgm('4to3.pgm', 40, 30, lambda x, y: x)
        pictures.pgm('few.pgm', 1, 15, lambda x, y: 16 * y)
        for name, size in (('side.pgm', '32x48'), ('long.pgm', '80x16')):
            why = 'its %s samples lie on their side beside the photo of 48x32 pixels; turn them ' \
                  'by --orient-depth 90 or 270, or give the map of this photo' % size
            if name == 'long.pgm':
                why = 'its %s samples have another shape than the photo of 48x32 pixels; give ' \
                      'the map of this photo, as upright as the photo is' % size
            self.refused(name, why, 'photo.ppm', '--depth', name)
            self.refused(name, why, 'photo.ppm', '--depth', name, '--full')
            for command in 'render', 'sheet':
                self.fails(1, '%s: %s' % (name, why), command, 'photo.ppm', '--depth', name, '-o',
                           'new.ppm')
            self.succeeds('depth', name, '-o', 'made.pgm')
        for name in '4to3.pgm', 'few.pgm':
            self.succeeds('depth', 'photo.ppm', '--depth', name, '--full', '-o', 'made.pgm')
        pictures.pgm('5to4.pgm', 40, 32, lambda x, y: x)
        result = self.run_it('depth', 'photo.ppm', '--depth', '5to4.pgm', '--full', '-o', 'made.pgm')
        self.assertEqual((result.returncode, result.stderr),
                         (0, 'refocus: 5to4.pgm: its 40x32 samples are stretched to the shape of the '
                          'photo, 48x32\n'))
        pictures.ppm('wide.ppm', 64, 32, lambda x, y: (x, y, 0))
        pictures.pgm('square.pgm', 32, 32, lambda x, y: x)
        self.succeeds('depth', 'wide.ppm', '--depth', 'square.pgm', '--full', '-o', 'made.pgm')

    def test_orient_depth(self):
        """The same map in four positions gives the same disparities; EXIF turns it by itself."""
        pictures.pgm('upright.pgm', W, H, lambda x, y: 4 * x + y)
        pictures.pgm('90.pgm', H, W, lambda x, y: 4 * (W - 1 - y) + x)
        pictures.pgm('270.pgm', H, W, lambda x, y: 4 * y + H - 1 - x)
        pictures.pgm('180.pgm', W, H, lambda x, y: 4 * (W - 1 - x) + H - 1 - y)
        self.succeeds('depth', 'photo.ppm', '--depth', 'upright.pgm', '-o', 'made.pgm')
        wanted = pictures.read_pnm('made.pgm')
        for degrees in '90', '180', '270':
            self.succeeds('depth', 'photo.ppm', '--depth', degrees + '.pgm', '-o', 'made.pgm',
                          '--orient-depth', degrees)
            self.assertEqual(pictures.read_pnm('made.pgm'), wanted, degrees)
            self.succeeds('depth', degrees + '.pgm', '-o', 'made.pgm', '--orient-depth', degrees)
            self.assertEqual(pictures.read_pnm('made.pgm'), wanted, degrees)
        self.succeeds('depth', 'photo.ppm', '--depth', 'upright.pgm', '-o', 'made.pgm',
                      '--orient-depth', '0')
        self.assertEqual(pictures.read_pnm('made.pgm'), wanted)
        self.refused('upright.pgm', 'its 48x32 samples lie on their side once --orient-depth has '
                     'turned them; leave that out, or give 0 or 180', 'photo.ppm', '--depth',
                     'upright.pgm', '--orient-depth', '90')
        # a photo that lies on its side by EXIF, and a map that lies as its pixels are stored
        pictures.ppm('stored.ppm', H, W, lambda x, y: (9 * x & 255, 5 * y & 255, 99))
        self.succeeds('render', 'stored.ppm', '--depth', '90.pgm', '--depth-unit',
                      'disparity', '--blur', '0', '-o', 'side.jpg')
        for orientation, name in ((6, '90.pgm'), (8, '270.pgm')):
            exif = (b'Exif\0\0MM\0*\0\0\0\x08\0\1\x01\x12\0\3\0\0\0\1\0' +
                    bytes([orientation]) + bytes(6))
            data = pictures.read_bytes('side.jpg')
            write('turned.jpg', data[:2] + b'\xff\xe1' + struct.pack('>H', len(exif) + 2) + exif +
                  data[2:])
            line = ('%s: its 32x48 samples lie on their side; they are turned by EXIF orientation '
                    '%d of the photo; --orient-depth says otherwise' % (name, orientation))
            result = self.run_it('depth', 'turned.jpg', '--depth', name, '-o', 'made.pgm')
            self.assertEqual((result.returncode, result.stderr), (0, 'refocus: %s\n' % line))
            self.assertEqual(pictures.read_pnm('made.pgm'), wanted)
            # a map in the file that was upright already: turned with the photo, and back
            with_map = pictures.read_bytes('turned.jpg')
            pictures.png('upright.png', W, H, [bytes(255 - 4 * x - y for x in range(W))
                                               for y in range(H)], colour=0)
            write('own.jpg', with_map)
            pictures.insert_dynamic('own.jpg', 'DepthMap:Format="RangeInverse" '
                                    'DepthMap:DepthURI="d"',
                                    [('d', pictures.read_bytes('upright.png'))])
            result = self.run_it('depth', 'own.jpg', '--full', '--depth-edges', 'as-given', '-o',
                                 'made.pgm')
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn('turned back by EXIF orientation %d' % orientation, result.stderr)
            self.assertEqual(pictures.read_pnm('made.pgm'), wanted)

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
            for command in 'render', 'sheet', 'pull', 'compare':
                out = () if command == 'compare' else ('-o', 'x-%d.ppm')
                more = ('--reference', 'photo.ppm') if command == 'compare' else ()
                self.fails(1, re.compile('^refocus: %s: (%s)' % (re.escape(name), why)), command,
                           'photo.ppm', '--depth', name, '--upsample', 'bilinear', *more, *out)

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
        for command, *more in (('render',), ('sheet',), ('pull',), ('view',),
                               ('compare', '--reference', 'photo.ppm'), ('depth', '--full')):
            self.fails(2, "--upsample: this build has no OpenCV, which 'guided' is of; give core",
                       command, 'photo.ppm', '--depth', 'depth.pgm', *more, '--upsample', 'guided',
                       *(() if more[:1] == ['--reference'] else ('-o', 'x.png')))
        self.fails(2, "--upsample: this build has no OpenCV, which 'guided' is of; give core",
                   'live', '--camera', 'replay:', '--depth', 'depth.pgm', '--upsample', 'guided')
        none = 'this build has no OpenCV'
        for name, why in PICTURES.items():  # a fault of the file itself may be seen first
            self.refused(name, none, 'photo.ppm', name)
            self.refused(name, '%s|%s' % (none, why), name, '--side-by-side')
            self.refused(name, '%s|%s' % (none, why), name, '--stereo-file')
            self.refused(name, none, 'photo.ppm', '--estimate', name)


if __name__ == '__main__':
    unittest.main()
