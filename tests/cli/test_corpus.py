#!/usr/bin/env python3
"""Photos with depth of all kinds, made from what is published about them: each is opened, its
refocused picture is plain to see, and after two edits its depth is the same.
Usage: test_corpus.py REFOCUS [unittest arguments]"""
import base64
import os
import shutil
import struct
import subprocess
import unittest

import photo_files
import pictures
from case import Case
from jpeg_files import (EXTENDED, GDEPTH, HAS_JPEG, HAS_PNG, HAS_XMP, OTHERS, STANDARD, TITLE,
                        VERSION, exif, extended, mpf, packet, segment)

W, H = 96, 64  # of the photo as it is stored
BRIEF = 'REFOCUS_BRIEF' in os.environ
APPLE = (b' xmlns:apdi="http://ns.apple.com/pixeldatainfo/1.0/" '
         b'xmlns:depthData="http://ns.apple.com/depthData/1.0/" apdi:AuxiliaryImageType="%s" '
         b'apdi:FloatMinValue="0.25" apdi:FloatMaxValue="4" apdi:IntMinValue="0" '
         b'apdi:IntMaxValue="255" depthData:Accuracy="relative">')
CONTAINER = (b' xmlns:GContainer="http://ns.google.com/photos/1.0/container/" '
             b'xmlns:GImage="http://ns.google.com/photos/1.0/image/"')


def colour(x, y):
    """Fine and coarse patterns, so that any blur is seen."""
    return (40 + 170 * (x // 3 + y // 3 & 1), 30 + 60 * (x // 12 & 3), 220 - 90 * (y // 8 & 2))


def near(x, y):
    """A subject before a slope: 0 farthest to 1 nearest."""
    return 1 if 30 <= x < 62 and y >= 16 else 0.1 + 0.3 * y / H


def code(x, y):
    return int(255 * near(x, y))


def metres(x, y):
    return 1 / (0.1 + 1.9 * near(x, y))


def grey_png(name, width, height, value):
    pictures.png(name, width, height, [bytes(value(x, y) for x in range(width))
                                       for y in range(height)], colour=0)
    return pictures.read_bytes(name)


@unittest.skipUnless(HAS_JPEG and HAS_PNG and HAS_XMP, 'a part of the build is missing')
class Corpus(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        pictures.ppm('scene.ppm', W, H, colour)
        pictures.pgm('grey.pgm', W, H, lambda x, y: sum(colour(x, y)) // 3)
        pictures.pgm('code.pgm', W, H, code)
        for name, pixels in ('base.jpg', 'scene.ppm'), ('code.jpg', 'code.pgm'):
            cls.call('render', pixels, '--depth', 'code.pgm', '--blur', '0', '-o', name,
                     '--jpeg-quality', '98')
        cls.base, cls.map_jpeg = (pictures.read_bytes(name) for name in ('base.jpg', 'code.jpg'))
        cls.map_png = grey_png('code.png', W, H, code)
        cls.sure = grey_png('sure.png', W, H, lambda x, y: 0 if x < 9 and y < 9 else 255)
        pictures.png('mm.png', W, H, [struct.pack('>%dH' % W, *(
            0 if (x, y) == (5, 5) else int(1000 * metres(x, y)) for x in range(W)))
                                      for y in range(H)], 16, 0)
        pictures.pfm('metres.pfm', W, H, metres)
        pictures.pgm('small.pgm', W // 4, H // 4, lambda x, y: code(4 * x + 2, 4 * y + 2))

    @classmethod
    def call(cls, *arguments):
        result = cls.run_it(cls, *arguments)
        assert result.returncode == 0, (arguments, result.stderr)
        return result.stdout

    def jpeg(self, *parts, behind=b'', photo=None):
        """in.jpg of the base picture, with these segments and pictures behind."""
        photo = photo or self.base
        with open('in.jpg', 'wb') as file:
            file.write(photo[:20] + b''.join(segment(*part) for part in parts) + photo[20:] +
                       behind)
        return 'in.jpg'

    def gdepth(self, more=b'', inside=b'', form=b'RangeInverse', orientation=1, step=0, names=b'',
               behind=b''):
        """A photo with GDepth, in one packet, or in an extended one of parts of so many bytes."""
        head = (GDEPTH + names + b' GDepth:Format="' + form + b'" GDepth:Near="0.5" GDepth:Far="10"'
                b' GDepth:Mime="image/png"' + more)
        # Bright is far in both forms.
        data = grey_png('gdepth.png', W, H, lambda x, y: 255 - code(x, y))
        body = b' GDepth:Data="' + base64.b64encode(data) + b'"' + inside
        turned = (0xe1, b'Exif\0\0' + exif(orientation))
        if not step:
            return self.jpeg(turned, (0xe1, STANDARD + packet(TITLE, head + body + b'>')),
                             behind=behind)
        guid, parts = extended(packet(GDEPTH + names + body + b'>'), step)
        head += (b' xmlns:xmpNote="http://ns.adobe.com/xmp/note/" xmpNote:HasExtendedXMP="' + guid +
                 b'">')
        self.assertTrue(parts[0][1].startswith(EXTENDED))
        return self.jpeg(turned, (0xe1, STANDARD + packet(TITLE, head)), *parts, behind=behind)

    def dynamic(self, confidence):
        pictures.insert_dynamic(
            self.jpeg(), 'DepthMap:Format="RangeInverse" DepthMap:Near="0.5" DepthMap:Far="10" '
            'DepthMap:Units="Meters" DepthMap:DepthURI="d"' +
            (' DepthMap:ConfidenceURI="c"' if confidence else ''),
            [('d', grey_png('d.png', W, H, lambda x, y: 255 - code(x, y))), ('c', self.sure)])
        return 'in.jpg'

    def apple(self, *kinds):
        """Auxiliary pictures behind the main one, which an index names."""
        parts = [self.map_jpeg[:2] + segment(0xe1, STANDARD + packet(APPLE % kind)) +
                 self.map_jpeg[2:] for kind in kinds]
        self.jpeg((0xe2, mpf(0, [0] * len(parts))))
        main = pictures.read_bytes('in.jpg')
        at, places = len(main) - main.index(b'MPF\0MM') - 4, []
        for part in parts:
            places.append((at, len(part)))
            at += len(part)
        return self.jpeg((0xe2, mpf(len(main), places)), behind=b''.join(parts))

    def ultra_hdr(self):
        gain = self.map_jpeg[:2] + segment(0xe1, STANDARD + packet(
            b' xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/" hdrgm:Version="1.0" '
            b'hdrgm:GainMapMax="2" hdrgm:HDRCapacityMax="2">')) + self.map_jpeg[2:]
        return self.gdepth(behind=gain)

    def picture(self, name, bits=8, channels=3):
        rows = []
        for y in range(H):
            row = [v for x in range(W) for v in (colour(x, y) + (200,))[:channels]]
            rows.append(bytes(row) if bits == 8 else struct.pack(
                '>%dH' % len(row), *(257 * v for v in row)))
        pictures.png(name, W, H, rows, bits, {3: 2, 4: 6}[channels])
        return name

    def written(self, name, photo=None):
        """By the command itself, of the PNG of 16 bits, or of another photo."""
        self.ok('render', photo or self.picture('deep.png', 16), '--depth', 'code.png', '--blur',
                '0', '-o', name, '--no-editable')
        return name

    def encoded(self, name, *command):
        """By a program that other people wrote."""
        self.picture('in.png')
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return name

    def mpo(self):
        """Two views, of which the first is refocused."""
        photo = self.jpeg((0xe1, b'Exif\0\0' + exif(1)))
        pictures.insert_mpf(photo, [self.base])
        return photo

    def apple_heic(self):
        """A HEIC of a photo with GDepth, which is an edited one of ours then."""
        self.ok('render', self.gdepth(), '-o', 'in.heic', '--blur', '3')
        return 'in.heic'

    def others(self):
        """Kinds that need a library which a build may lack, or a program to make them."""
        png = ('--depth', 'code.png')
        if 'HEIC' in VERSION and 'no encoder' not in self.run_it(
                'render', 'scene.ppm', *png, '-o', 'try.heic').stderr:
            yield 'HEIC', lambda: self.written('in.heic', self.jpeg()), png
            yield 'HEIC, edited', self.apple_heic, ()
        if 'TIFF' in VERSION:
            yield 'TIFF of 16 bits', lambda: self.written('in.tif'), png
            yield 'TIFF', lambda: self.written('in.tif', 'scene.ppm'), png
        if 'OpenEXR' in VERSION:
            yield 'OpenEXR', lambda: self.written('in.exr', 'scene.ppm'), png
        if 'raw' in VERSION:
            yield 'raw, developed', lambda: photo_files.dng('in.dng', W, H, colour), png
            yield 'raw, its preview', lambda: photo_files.dng(
                'in.dng', W, H, colour, self.base), png + ('--raw-preview',)
        for kind, needs, name, command in (
                ('WebP', 'WebP', 'cwebp', ('in.png', '-o', 'in.webp')),
                ('WebP without loss', 'WebP', 'cwebp', ('-lossless', 'in.png', '-o', 'in.webp')),
                ('JPEG XL', 'JPEG-XL', 'cjxl', ('in.png', 'in.jxl')),
                ('JPEG XL without loss', 'JPEG-XL', 'cjxl', ('-d', '0', 'in.png', 'in.jxl')),
                ('AVIF', 'AVIF', 'heif-enc', ('-A', 'in.png', '-o', 'in.avif'))):
            if needs in VERSION and shutil.which(name):
                yield kind, lambda n=name, c=command: self.encoded(c[-1], n, *c), png

    def kinds(self):
        """(name, a function that makes the photo, options of its depth)."""
        png = ('--depth', 'code.png')
        yield 'JPEG, 8-bit PNG map', self.jpeg, png
        yield 'JPEG, PNG in millimetres', self.jpeg, ('--depth', 'mm.png', '--depth-unit', 'mm')
        yield 'JPEG, PFM in metres', self.jpeg, ('--depth', 'metres.pfm', '--depth-unit', 'm')
        yield 'JPEG, small map', self.jpeg, ('--depth', 'small.pgm')
        yield 'JPEG, JPEG map', self.jpeg, ('--depth', 'code.jpg')
        yield 'JPEG of many segments', lambda: self.jpeg(*OTHERS), png
        yield 'GDepth, inverse', self.gdepth, ()
        yield 'GDepth, linear', lambda: self.gdepth(form=b'RangeLinear'), ()
        yield 'GDepth in metres', lambda: self.gdepth(b' GDepth:Units="m"'), ()
        yield 'GDepth, extended', lambda: self.gdepth(step=700), ()
        yield 'GDepth with confidence', lambda: self.gdepth(
            inside=b' GDepth:Confidence="' + base64.b64encode(self.sure) + b'"', step=900), ()
        yield 'GDepth with original', lambda: self.gdepth(
            names=CONTAINER, inside=b' GImage:Mime="image/jpeg" GImage:Data="' +
            base64.b64encode(self.base) + b'"', step=9000), ()
        yield 'GDepth with own blur', lambda: self.gdepth(
            b' xmlns:GFocus="http://ns.google.com/photos/1.0/focus/" GFocus:BlurAtInfinity="0.02"'
            b' GFocus:FocalDistance="0.5" GFocus:FocalPointX="0.5" GFocus:FocalPointY="0.6"'), ()
        for orientation in range(2, 9):
            yield ('GDepth, turned %d' % orientation,
                   lambda o=orientation: self.gdepth(orientation=o), ())
        yield 'Dynamic Depth', lambda: self.dynamic(False), ()
        yield 'Dynamic Depth with confidence', lambda: self.dynamic(True), ()
        yield 'Apple disparity', lambda: self.apple(b'disparity'), ()
        yield 'Apple disparity and matte', lambda: self.apple(
            b'urn:com:apple:photo:2018:aux:portraiteffectsmatte', b'disparity'), ()
        yield 'Ultra HDR with GDepth', self.ultra_hdr, ()
        yield 'PNG', lambda: self.picture('in.png'), png
        yield 'PNG of 16 bits', lambda: self.picture('in.png', 16), png
        yield 'PNG with alpha', lambda: self.picture('in.png', 8, 4), png
        yield 'PPM', lambda: 'scene.ppm', png
        yield 'PGM', lambda: 'grey.pgm', png
        yield 'JPEG of CMYK', lambda: photo_files.cmyk_jpeg('in.jpg', W, H, lambda x, y: (
            40 + 170 * (x // 8 + y // 8 & 1), 30 + 20 * (x // 8 & 7), 220 - 90 * (y // 8 & 2))), png
        yield 'MPO', self.mpo, png
        yield from self.others()

    def ok(self, *arguments):
        """Lines of warnings are allowed."""
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))

    def samples(self, photo, *options):
        self.ok('render', photo, '-o', 'out.ppm', '--threads', '1', *options)
        return pictures.read_pnm('out.ppm')

    def is_seen(self, name, photo, depth):
        """Half a percent of the pixels and more change by 8 codes and more."""
        kind = name[-8:] if 'turned' in name else photo  # many are the same picture
        if kind not in self.sharp:
            self.sharp[kind] = self.samples(photo, *depth, '--blur', '0')
        width, height, sharp = self.sharp[kind]
        for lens in (), ('--f-number', '1.4'):
            blurred = self.samples(photo, *depth, *lens)
            self.assertEqual(blurred[:2], (width, height))
            changed = sum(max(abs(a - b) for a, b in zip(sharp[i:i + 3], blurred[2][i:i + 3])) >= 8
                          for i in range(0, len(sharp), 3))
            self.assertGreaterEqual(changed, 0.005 * width * height, lens)

    def map_of(self, photo, depth):
        self.ok('depth', photo, '-o', 'map.png', *depth)
        return pictures.read_bytes('map.png')

    def stays(self, photo, depth, photo_too):
        """After two edits the photo and its depth are as they were; the original of a HEIC is a
        JPEG then, which stays."""
        self.ok('render', photo, '-o', 'first.jpg', '--threads', '1', *depth, '--editable')
        self.ok('render', 'first.jpg', '-o', 'second.jpg', '--threads', '1', '--f-number', '1.4')
        self.same(self.map_of('second.jpg', ()), self.map_of(photo, depth))
        if photo_too:
            self.same(self.samples('second.jpg', '--blur', '2'),
                      self.samples(photo, '--blur', '2', *depth)
                      if not photo.endswith('.heic') else self.samples('first.jpg', '--blur', '2'))

    def test_cmyk(self):
        """Inks take their colours away, whichever way they are stored."""
        pictures.pgm('flat.pgm', 32, 16, lambda x, y: 9)
        for adobe in True, False:
            photo_files.cmyk_jpeg('in.jpg', 32, 16, lambda x, y: (255 - 8 * x, 15 * y, 100), 55,
                                  adobe)
            wanted = [round(v * 200 / 255) for y in range(16) for x in range(32)
                      for v in (255 - x // 8 * 64, 15 * (y // 8 * 8), 100)]
            self.assertEqual(list(self.samples('in.jpg', '--depth', 'flat.pgm', '--blur', '0')[2]),
                             wanted)

    def test_all(self):
        made, self.sharp = 0, {}
        for i, (name, make, depth) in enumerate(self.kinds()):
            made += 1
            if BRIEF and i % 4:
                continue
            with self.subTest(name):
                photo = make()
                self.is_seen(name, photo, depth)
                if not photo.endswith('.exr') and name != 'raw, developed':  # they are floats
                    self.stays(photo, depth, i % 4 == 0 or not photo.endswith('.jpg'))
        self.assertGreaterEqual(made, 30)


if __name__ == '__main__':
    unittest.main()
