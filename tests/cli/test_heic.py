#!/usr/bin/env python3
"""HEIC is written: with EXIF, XMP and colour profile, and editable as a JPEG is.
Usage: test_heic.py REFOCUS [unittest arguments]"""
import base64
import os
import re
import struct
import unittest

import heif_files
import pictures
from case import Case, H, W
from jpeg_files import (GDEPTH, HAS_JPEG, HAS_PNG, HAS_XMP, OTHERS, STANDARD, TITLE, VERSION, exif,
                        extended, packet, segment)

GAIN_BASE = 140, 120, 100
PROFILE = b'\0' * 12 + b'mntrRGB ' + bytes(16) + b'acsp' + bytes(88)


@unittest.skipUnless('HEIC' in VERSION, 'needs libheif')
class Heic(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        pictures.ppm('photo.ppm', W, H, lambda x, y: (
            60 + 2 * x + 40 * (x // 8 & 1), 60 + x + 40 * (x // 8 & 1), 40 * (x // 8 & 1) + 4 * y))
        result = cls.run_it(cls, 'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'try.heic')
        if 'no encoder' in result.stderr:
            raise unittest.SkipTest('libheif has no encoder of HEVC here')

    def jpeg(self, *parts, name='in.jpg'):
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o', name)
        base = pictures.read_bytes(name)
        with open(name, 'wb') as file:
            file.write(base[:20] + b''.join(segment(*part) for part in parts) + base[20:])

    def samples(self, photo, *options):
        self.succeeds('render', photo, '-o', 'out.ppm', *options)
        return pictures.read_pnm('out.ppm')

    def map_of(self, photo, *options):
        self.succeeds('depth', photo, '-o', 'map.png', *options)
        return pictures.read_bytes('map.png')

    def near(self, a, b, most):
        """Mean difference of two pictures of one size, in codes."""
        self.assertEqual(a[:2], b[:2])
        mean = sum(abs(p - q) for p, q in zip(a[2], b[2])) / len(a[2])
        self.assertLess(mean, most)

    def test_the_picture(self):
        """Within what the encoder loses, of any size; a better one has more bytes."""
        sizes = []
        for options in (), ('--resize', '31'), ('--resize', '7'):
            depth = ('--depth', 'depth.pgm', '--blur', '3')
            self.succeeds('render', 'photo.ppm', *depth, *options, '-o', 'out.heic',
                          '--jpeg-quality', '95')
            wanted = self.samples('photo.ppm', *depth, *options)
            pictures.pgm('flat.pgm', *wanted[:2], lambda x, y: 9)
            self.near(self.samples('out.heic', '--depth', 'flat.pgm', '--blur', '0'), wanted, 6)
        for quality in '30', '95':
            self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.heic',
                          '--jpeg-quality', quality)
            sizes.append(os.path.getsize('out.heic'))
        self.assertLess(sizes[0], sizes[1])
        self.assertIn('HEIC', self.succeeds('info', 'out.heic'))

    def test_nothing_is_left_of_what_failed(self):
        self.fails(2, '--editable: it is for JPEG and HEIC; end the name of the output in .jpg or '
                   '.heic', 'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'x.png',
                   '--editable')
        with open('bad.jpg', 'wb') as file:
            file.write(b'\xff\xd8\xff')
        self.fails(1, 'bad.jpg: damaged JPEG: it ends in the middle of the picture; copy it again',
                   'render', 'bad.jpg', '--depth', 'depth.pgm', '-o', 'x.heic')

    def test_limits(self):
        """Pixels are counted: a picture may be wider than the root of what is allowed."""
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.heic')
        for more in ('--max-pixels', str(W * H)), ('--max-side', str(W)):
            self.assertIn('%dx%d' % (W, H), self.succeeds('info', 'out.heic', *more))
        self.fails(1, 'out.heic: its %d x %d pixels are more than the limit of %d pixels' % (
            W, H, W * H - 1), 'info', 'out.heic', '--max-pixels', str(W * H - 1))
        self.fails(1, re.compile('out.heic: .*%d' % (W - 1)), 'info', 'out.heic', '--max-side',
                   str(W - 1))

    def test_as_phones_write(self):
        """Picture and depth in tiles, and EXIF that describes two pictures."""
        side = 64
        flat = ('--depth', 'flat.pgm', '--blur', '0', '--strip', '--no-editable')
        pictures.pgm('flat.pgm', side, side, lambda x, y: 9)
        pictures.ppm('tile.ppm', side, side, lambda x, y: (4 * x, 200 - 2 * y, 60))
        pictures.ppm('depth.ppm', side, side, lambda x, y: (40 if x < 32 else 220,) * 3)
        for name in 'tile', 'depth':
            self.succeeds('render', name + '.ppm', *flat, '-o', name + '.heic')
        heif_files.phone('phone.heic', 'tile.heic', 'depth.heic', side, b'abc')
        info = self.reports('info', 'phone.heic')
        self.assertEqual((info['picture'], info['camera']), ([2 * side] * 2, 'abc'))
        width, height, rgb = self.samples('phone.heic', '--blur', '0')
        self.assertEqual((width, height), (2 * side,) * 2)
        for x in 0, 100:
            for y in 10, 90:
                for c, want in enumerate((4 * (x % side), 200 - 2 * (y % side), 60)):
                    self.assertLess(abs(rgb[3 * (y * width + x) + c] - want), 12)
        self.succeeds('depth', 'phone.heic', '-o', 'map.pfm')
        width, height, depth = pictures.read_pfm('map.pfm')
        for x in 10, 50, 74, 114:
            want = (40 if x % side < 32 else 220) / 255
            self.assertLess(abs(depth[width * 70 + x] - want), 0.03)

    def test_pair_beside_the_photo(self):
        """Depth of the pair is that of the left picture, which is the photo then."""
        pictures.stereo_pair('left.ppm', 'right.ppm')
        pictures.ppm('main.ppm', 64, 64, lambda x, y: (4 * x, 200 - 2 * y, 60))
        for name, width, height in (('main', 64, 64), ('left', 160, 96), ('right', 160, 96)):
            pictures.pgm('flat.pgm', width, height, lambda x, y: 9)
            self.succeeds('render', name + '.ppm', '--depth', 'flat.pgm', '--blur', '0', '--strip',
                          '--no-editable', '--jpeg-quality', '100', '-o', name + '.heic')
        heif_files.pair_beside('spatial.heic', 'main.heic', (64, 64), 'left.heic', 'right.heic',
                               (160, 96))
        info = self.reports('info', 'spatial.heic')
        self.assertEqual((info['picture'], info['views'], info['camera']), ([64, 64], 1, None))
        self.assertIn('a stereo pair lies beside the photo', ''.join(info['evidence']))
        if 'OpenCV' not in VERSION:
            self.skipTest('this build has no OpenCV')
        self.succeeds('depth', 'spatial.heic', '--stereo-file', '-o', 'within.pfm')
        self.succeeds('depth', 'left.heic', 'right.heic', '-o', 'given.pfm')
        self.same(pictures.read_bytes('within.pfm'), pictures.read_bytes('given.pfm'))
        self.same(self.samples('spatial.heic', '--stereo-file', '--blur', '0'),
                  self.samples('left.heic', '--depth', 'given.pfm', '--blur', '0'))

    def gain_map_file(self, name, **how):
        """The left half of a photo of one colour has the gain 1, the right half 4."""
        side = 64
        if not os.path.exists('base.heic'):
            pictures.pgm('flat.pgm', side, side, lambda x, y: 9)
            pictures.ppm('base.ppm', side, side, lambda x, y: GAIN_BASE)
            pictures.ppm('gain.ppm', side, side, lambda x, y: (0 if x < 32 else 255,) * 3)
            for part in 'base', 'gain':
                self.succeeds('render', part + '.ppm', '--depth', 'flat.pgm', '--blur', '0',
                              '--strip', '--no-editable', '-o', part + '.heic')
        heif_files.with_gain_map(name, 'base.heic', 'gain.heic', side, side, **how)
        return self.succeeds('info', name)

    def test_gain_maps(self):
        """By a tone map, upright and turned, and by an auxiliary image with XMP."""
        forms = [{'metadata': heif_files.tone_map(2)},
                 {'metadata': heif_files.tone_map(2), 'quarters': 1}]
        if HAS_XMP:
            forms.append({'xmp': packet(
                b' xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/" hdrgm:Version="1.0" '
                b'hdrgm:GainMapMax="2" hdrgm:HDRCapacityMax="2" hdrgm:OffsetSDR="0" '
                b'hdrgm:OffsetHDR="0">')})
        light = [((code / 255 + 0.055) / 1.055) ** 2.4 for code in GAIN_BASE]
        for form in forms:
            self.assertIn('gain map: 64 x 64 samples, up to 4 times white',
                          self.gain_map_file('toned.heic', **form))
            self.succeeds('render', 'toned.heic', '--depth', 'flat.pgm', '--blur', '0', '-o',
                          'light.pfm')
            width, _, rgb = pictures.read_pfm('light.pfm')
            for name in ('light.exr',) * ('OpenEXR' in VERSION) + ('tones.heic',):
                told = self.run_it('render', 'toned.heic', '--depth', 'flat.pgm', '--no-editable',
                                   '-o', name)
                self.assertEqual((told.returncode, 'without an HDR gain map' in told.stderr),
                                 (0, name == 'tones.heic'))
            for x, y in (10, 20), (50, 20), (10, 50), (50, 50):
                is_bright = y < 32 if 'quarters' in form else x >= 32
                for c in range(3):
                    self.assertAlmostEqual(rgb[3 * (y * width + x) + c] / light[c],
                                           4 if is_bright else 1, delta=0.2)

    def test_gain_maps_that_are_passed_over(self):
        """The photo is whole without them, and says why."""
        good = heif_files.tone_map(2)
        for metadata, why in (
                (b'\1' + good[1:], 'its metadata is of a version that is not known'),
                (good[:30], 'its metadata is damaged'),
                (good[:6] + good[14:22] + good[6:14] + good[22:],
                 'its photo is not the darker rendition')):
            self.assertIn('gain map: passed over, ' + why,
                          self.gain_map_file('passed.heic', metadata=metadata))

    @unittest.skipUnless(HAS_JPEG and HAS_XMP, 'needs TurboJPEG and expat')
    def test_what_is_kept(self):
        """EXIF made true, title and profile; a JPEG of it has them again."""
        turned = (0xe1, b'Exif\0\0' + exif(8))
        title = (0xe1, STANDARD + packet(TITLE))
        self.jpeg(turned, title, (0xe2, b'ICC_PROFILE\0\1\1' + PROFILE), *OTHERS)
        pictures.pgm('turned.pgm', H, W, lambda x, y: 255 if y >= W // 2 else 51)
        for more in (), ('--no-editable',):
            self.warns("out.heic: it is written without the photo's IPTC and comments; a JPEG keeps "
                       'them', 'render', 'in.jpg', '--depth', 'turned.pgm', '-o', 'out.heic', *more)
            info = self.reports('info', 'out.heic')
            self.assertEqual((info['picture'], info['stored'], info['orientation']),
                             ([H, W], [H, W], 1))
            bytes_ = pictures.read_bytes('out.heic')
            self.assertIn('Gr&#252;n &lt;3'.encode(), bytes_)
            self.assertIn(PROFILE, bytes_)
            block = bytes_[bytes_.index(b'MM\0*'):]
            self.assertEqual(struct.unpack('>H', block[18:20])[0], 1)
            self.succeeds('render', 'out.heic', '--depth', 'turned.pgm', '-o', 'again.jpg')
            again = pictures.read_bytes('again.jpg')
            self.assertIn('Gr&#252;n &lt;3'.encode(), again)
            self.assertIn(PROFILE, again)
            self.assertEqual(b'HasExtendedXMP' in bytes_, False)
        self.succeeds('render', 'in.jpg', '--depth', 'turned.pgm', '-o', 'out.heic', '--strip')
        bytes_ = pictures.read_bytes('out.heic')
        self.assertNotIn(b'MM\0*', bytes_)
        self.assertNotIn(b'xmpmeta', bytes_)
        self.assertIn(PROFILE, bytes_)

    @unittest.skipUnless(HAS_JPEG and HAS_XMP and HAS_PNG, 'needs TurboJPEG, expat and libpng')
    def test_editing_changes_nothing_but_the_picture(self):
        """From JPEG over HEIC to JPEG: original and depth are those of the first photo, bit by
        bit within a container; a change of container encodes the original once more."""
        pictures.png('map.png', W, H, [bytes(4 * x for x in range(W))] * H, colour=0)
        data = base64.b64encode(pictures.read_bytes('map.png'))
        guid, chunks = extended(packet(GDEPTH + b' GDepth:Data="' + data + b'">'), 900)
        head = GDEPTH + b' GDepth:Format="RangeInverse" GDepth:Near="0.5" GDepth:Far="4" ' \
            b'GDepth:Units="m" GDepth:Mime="image/png" ' \
            b'xmlns:xmpNote="http://ns.adobe.com/xmp/note/" xmpNote:HasExtendedXMP="' + guid + b'">'
        for orientation in 1, 6:
            self.jpeg((0xe1, b'Exif\0\0' + exif(orientation)),
                      (0xe1, STANDARD + packet(TITLE, head)), *chunks)
            depth, sharp = self.map_of('in.jpg'), self.samples('in.jpg', '--blur', '0')
            self.succeeds('render', 'in.jpg', '-o', 'a.heic', '--blur', '4')
            first = self.samples('a.heic', '--blur', '2')
            self.near(self.samples('a.heic', '--blur', '0'), sharp, 1)
            self.succeeds('render', 'a.heic', '-o', 'x.heic', '--blur', '5')
            self.succeeds('render', 'x.heic', '-o', 'b.heic', '--blur', '1', '--focus', '0')
            self.same(self.map_of('b.heic'), depth)
            self.same(self.samples('b.heic', '--blur', '2'), first)
            self.assertLess(os.path.getsize('b.heic'), 2 * os.path.getsize('a.heic'))
            self.succeeds('render', 'b.heic', '-o', 'c.jpg', '--blur', '3')
            self.same(self.map_of('c.jpg'), depth)
            self.near(self.samples('c.jpg', '--blur', '2'), first, 1)
            self.succeeds('render', 'c.jpg', '-o', 'd.jpg', '--blur', '2')
            self.same(self.samples('d.jpg', '--blur', '2'), self.samples('c.jpg', '--blur', '2'))
            self.succeeds('render', 'd.jpg', '-o', 'e.heic')
            self.same(self.map_of('e.heic'), depth)
            self.near(self.samples('e.heic', '--blur', '2'), first, 1)
            for name, more in ('f.heic', ('--no-editable',)), ('f.png', ()), ('f.tif', ()):
                if name != 'f.tif' or 'TIFF' in VERSION:
                    self.succeeds('render', 'e.heic', '-o', name, *more)
                    self.assertNotIn(b'GDepth', pictures.read_bytes(name))


if __name__ == '__main__':
    unittest.main()
