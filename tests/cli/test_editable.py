#!/usr/bin/env python3
"""A result holds its original and depth: ten edits change nothing but the picture.
Usage: test_editable.py REFOCUS [unittest arguments]"""
import base64
import re
import struct
import unittest
from xml.etree import ElementTree

import pictures
from case import H, W
from jpeg_files import (EXTENDED, GDEPTH, HAS_JPEG, HAS_PNG, HAS_XMP, Keep, OTHERS, RDF, RDF_NAME,
                        STANDARD, TITLE, exif, extended, join_extended, mpf, packet, segment,
                        segments)


def scan(jpeg):
    """The picture itself: its tables and coefficients."""
    plain = b''.join(segment(*part) for part in segments(jpeg) if part[0] in (0xc0, 0xc4, 0xdb))
    begin = 2 + sum(len(payload) + 4 for _, payload in segments(jpeg))
    return plain + jpeg[begin:jpeg.index(b'\xff\xd9', begin) + 2]


def data(jpeg, name):
    """A property of the extended packet, from Base64."""
    return base64.b64decode(join_extended(segments(jpeg))[1].split(name + b'="')[1].split(b'"')[0])


@unittest.skipUnless(HAS_JPEG and HAS_PNG and HAS_XMP, 'needs TurboJPEG, libpng and expat')
class Editable(Keep):
    LENSES = [('--blur', '2'), ('--blur', '3', '--focus', '0.2'), ('--blur', '1', '--focus', '1')]

    def render(self, photo, out, *options):
        self.succeeds('render', photo, '-o', out, *options)
        with open(out, 'rb') as file:
            return file.read()

    def ten_edits(self, photo, *depth):
        """Each result is the one that the photo itself gives; original and depth never change."""
        direct = []
        for lens in self.LENSES:
            self.run_it('render', photo, '-o', 'direct.jpg', '--no-editable', *lens, *depth)
            direct.append(pictures.read_bytes('direct.jpg'))
        first = self.render(photo, 'edit0.jpg', *self.LENSES[0], *depth)
        self.assertEqual(scan(first), scan(direct[0]))
        for i in range(1, 10):
            lens = self.LENSES[i % 3]
            last = self.render('edit%d.jpg' % (i - 1), 'edit%d.jpg' % i, *lens)
            self.assertEqual(scan(last), scan(direct[i % 3]), i)
            self.assertEqual(join_extended(segments(last)), join_extended(segments(first)))
        self.assertEqual(last, first)  # the lens is that of the first again
        self.check_dynamic_depth(first)
        return first

    def check_rdf(self, node):
        """A property has attributes, a structure, or one node: else XMP toolkits refuse all."""
        for item in node:
            content = list(item)
            kind = item.get(RDF_NAME + 'parseType')
            attributes = [a for a in item.attrib
                          if not a.startswith((RDF_NAME, '{http://www.w3.org/XML/1998/namespace}'))]
            if content:
                self.assertEqual(attributes, [], item.tag)
            if kind is None and content:
                self.assertEqual([c.tag.startswith(RDF_NAME) for c in content], [True], item.tag)
                content = content[0]
            self.check_rdf(content)

    def check_dynamic_depth(self, jpeg):
        """Readers that know Dynamic Depth alone find the same depth, in 8 bits."""
        own = re.compile(rb'\s(GDepth|GImage|Refocus|xmpNote):\w+="[^"]*"')
        parts = [(m, own.sub(b'', p)) for m, p in segments(jpeg) if not p.startswith(EXTENDED)]
        self.assertIn(b'>DepthPhoto</Profile:Type>', b''.join(p for _, p in parts))
        for _, payload in parts:
            if payload.startswith(STANDARD):
                tree = ElementTree.fromstring(payload[payload.index(b'<x:xmpmeta'):])
                for description in tree.find(RDF_NAME + 'RDF'):
                    self.check_rdf(description)
        self.assertEqual(jpeg[-self.length_of(jpeg, b'android/confidencemap'):][:3], b'\xff\xd8\xff')
        rest = jpeg[2 + sum(len(p) + 4 for _, p in segments(jpeg)):]
        with open('other.jpg', 'wb') as file:
            file.write(jpeg[:2] + b''.join(segment(*part) for part in parts) + rest)
        with open('own.jpg', 'wb') as file:
            file.write(jpeg)
        info = [self.reports('info', name)['depth'] for name in ('own.jpg', 'other.jpg')]
        self.assertEqual([i['source'] for i in info], ['gdepth', 'dynamic-depth'])
        for key in 'near_m', 'far_m', 'width', 'height':
            self.assertEqual(info[0][key], info[1][key], key)
        for name in 'own', 'other':
            self.succeeds('depth', name + '.jpg', '-o', name + '.pgm')
        own, other = (pictures.read_pnm(name)[2] for name in ('own.pgm', 'other.pgm'))
        self.assertLess(max(abs(a - b) for a, b in zip(own, other)), 3 * 257)

    def test_ten_edits_of_a_photo_with_a_map_beside_it(self):
        self.jpeg('in.jpg', OTHERS + [(0xe1, STANDARD + packet(TITLE))])
        first = self.ten_edits('in.jpg', '--depth', 'mm.pgm', '--depth-unit', 'mm')
        self.assertEqual(data(first, b'GImage:Data'), self.base)
        self.assertTrue(data(first, b'GDepth:Data').startswith(b'\x89PNG'))
        kept = [part for part in segments(first) if part in OTHERS]
        self.assertEqual(kept, OTHERS)
        standard = [p for m, p in segments(first) if m == 0xe1 and p.startswith(STANDARD)]
        self.assertEqual(len(standard), 1)
        head, tail = (STANDARD + packet(TITLE)).split(b'</rdf:RDF>')
        self.assertTrue(standard[0].startswith(head))
        self.assertTrue(standard[0].endswith(b'</rdf:RDF>' + tail))
        info = self.reports('info', 'edit9.jpg')
        self.assertIn('Refocus: the result has disparity', '\n'.join(info['evidence']))
        # Without what makes it editable the photo's own packet is there again, byte for byte.
        self.render('edit9.jpg', 'plain.jpg', '--no-editable')
        with open('plain.jpg', 'rb') as file:
            self.assertIn((0xe1, STANDARD + packet(TITLE)), segments(file.read()))

    def test_ten_edits_of_a_turned_photo(self):
        self.jpeg('in.jpg', [(0xe1, b'Exif\0\0' + exif(6))])
        first = self.ten_edits('in.jpg', '--depth', 'upright.pgm')
        original = data(first, b'GImage:Data')
        self.assertEqual(scan(original), scan(self.base))
        exifs = [p for m, p in segments(original) if m == 0xe1]
        self.assertEqual([p[24:26] for p in exifs], [b'\0\x06'])

    def test_ten_edits_of_a_photo_with_gain_map_and_matte(self):
        """What lies behind the main picture goes on to make the light and the silhouette."""
        pictures.pgm('half.pgm', W, H, lambda x, y: 255 * (x > W // 2))
        self.succeeds('render', 'half.pgm', '--depth', 'depth.pgm', '--blur', '0', '--no-editable',
                      '-o', 'half.jpg')
        half = pictures.read_bytes('half.jpg')
        matte = half[:2] + segment(0xe1, STANDARD + packet(
            b' xmlns:a="http://ns.apple.com/pixeldatainfo/1.0/" a:AuxiliaryImageType='
            b'"urn:com:apple:photo:2018:aux:portraiteffectsmatte">')) + half[2:]
        gain = half[:2] + segment(0xe1, STANDARD + packet(
            b' xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/" hdrgm:Version="1.0" '
            b'hdrgm:GainMapMax="3" hdrgm:HDRCapacityMax="3">')) + half[2:]
        behind = [matte, gain]
        for orientation in 1, 6:
            depth = 'depth.pgm' if orientation == 1 else 'upright.pgm'
            self.jpeg('main.jpg', [(0xe1, b'Exif\0\0' + exif(orientation)),
                                   (0xe2, mpf(0, [0, 0]))])
            main = pictures.read_bytes('main.jpg')
            base = main.index(b'MPF\0MM') + 4
            at = [len(main) - base, len(main) + len(matte) - base]
            self.jpeg('main.jpg', [(0xe1, b'Exif\0\0' + exif(orientation)),
                                   (0xe2, mpf(len(main), list(zip(at, map(len, behind)))))])
            with open('in.jpg', 'wb') as file:
                file.write(pictures.read_bytes('main.jpg') + b''.join(behind))
            first = self.ten_edits('in.jpg', '--depth', depth)
            self.assertTrue(data(first, b'GImage:Data').endswith(b''.join(behind)))
            for option, value in ('--gain-map', 'ignore'), ('--matte', 'none'):
                other = self.render('edit9.jpg', 'other.jpg', *self.LENSES[0], option, value)
                self.assertNotEqual(scan(other), scan(first), option)

    def test_edits_of_what_lost_nothing(self):
        """Pixels that are no JPEG's go in as a PNG with all of their bits, where that is asked
        for."""
        deep = [b''.join(struct.pack('>H', 999 * x + 7 * y) * 3 for x in range(W)) for y in range(H)]
        pictures.png('deep.png', W, H, deep, colour=2, depth=16)
        for photo, bits in ('photo.ppm', 8), ('deep.png', 16):
            lens = self.LENSES[0]
            first, plain = (self.noisy(photo, name, *lens, '--depth', 'depth.pgm', *more)
                            for name, more in (('first.jpg', ('--editable',)), ('plain.jpg', ())))
            self.assertEqual(scan(first), scan(plain))
            self.assertNotIn(b'GImage', plain)
            original = data(first, b'GImage:Data')
            self.assertEqual((original[:4], original[24]), (b'\x89PNG', bits))
            again = self.noisy('first.jpg', 'again.jpg', *lens)
            self.assertEqual(again, first)

    def noisy(self, photo, out, *options):
        """As render(), where a line says that bits are lost."""
        self.assertEqual(self.run_it('render', photo, '-o', out, *options).returncode, 0)
        return pictures.read_bytes(out)

    def test_gain_map_of_the_result(self):
        """A lamp out of focus is as bright in the result of an HDR photo as in the light that was
        rendered, and the picture is that of one without a gain map."""
        lit = lambda x, y: x in range(8, 12) and y in range(8, 12)
        pictures.ppm('dim.ppm', W, H, lambda x, y: (255 if lit(x, y) else 60 + x, 90, 90))
        pictures.ppm('gains.ppm', W, H, lambda x, y: (255 if lit(x, y) else 0,) * 3)
        pictures.pgm('flat.pgm', W, H, lambda x, y: 51)
        for name in 'dim', 'gains':
            self.render(name + '.ppm', name + '.jpg', '--depth', 'flat.pgm', '--blur', '0',
                        '--jpeg-quality', '100')
        pictures.ultra_hdr('in.jpg', 'dim.jpg', 'gains.jpg', 3)
        lens = '--depth', 'flat.pgm', '--focus', '1', '--blur', '5'
        sharp = '--depth', 'flat.pgm', '--blur', '0'
        plain = self.render('in.jpg', 'plain.jpg', *lens, '--strip')
        self.assertNotIn(b'MPF', plain)
        self.render('in.jpg', 'light.pfm', *lens)
        light = pictures.read_pfm('light.pfm')[2]
        for more in ('--no-editable',), (), ('--resize', '%d' % (W // 2)):
            out = self.render('in.jpg', 'out.jpg', *lens, *more)
            index = next(p for m, p in segments(out) if m == 0xe2 and p[:4] == b'MPF\0')
            _, end, _, _, _, size, at, _ = struct.unpack('>8I', index[-32:])
            self.assertEqual((size, out.index(index) + 4 + at),
                             (self.length_of(out, b'GainMap'), end))
            self.assertEqual(out[end:end + 2], b'\xff\xd8')
            if '--resize' not in more:
                self.assertEqual(scan(out[:end]), scan(plain))
            if not more:  # what others see; here the original counts
                self.assertEqual(out[end:end + size], last[-size:])
                continue
            last = out
            self.render('out.jpg', 'again.pfm', *sharp)
            again = pictures.read_pfm('again.pfm')[2]
            means = [sum(v[::3]) / len(v) * 3 for v in (light, again)]
            self.assertAlmostEqual(means[1] / means[0], 1, delta=0.05, msg=more)

    @staticmethod
    def length_of(jpeg, semantic):
        """Item:Length of an item in a container directory, by what it is or by its URI."""
        item = jpeg[re.search(rb'Item:(Semantic|DataURI)="' + semantic, jpeg).start():]
        return int(item[item.index(b'Item:Length="') + 13:].split(b'"')[0])

    def test_ten_edits_of_dynamic_depth(self):
        """The map becomes GDepth, with its confidence."""
        wrong = [(x, y) for y in range(4, 9) for x in range(16, 21)]
        for name, code in ('map.png', 255), ('sure.png', 0):
            pictures.png(name, W // 2, H // 2, [
                bytes(code if ((x, y) in wrong) == (code == 0) and x >= W // 4 else 255 - code
                      for x in range(W // 2)) for y in range(H // 2)], colour=0)
        for confidence in 'DepthMap:ConfidenceURI="c"', '':
            self.jpeg('in.jpg', [])
            pictures.insert_dynamic(
                'in.jpg', 'DepthMap:Format="RangeInverse" DepthMap:Near="0.5" DepthMap:Far="4" '
                'DepthMap:Units="Meters" DepthMap:DepthURI="d" ' + confidence,
                [('d', pictures.read_bytes('map.png')), ('c', pictures.read_bytes('sure.png'))])
            first = self.ten_edits('in.jpg')
            text = join_extended(segments(first))[1]
            self.assertEqual(b'GDepth:Confidence=' in text, confidence != '')
            self.assertEqual(b''.join(payload for _, payload in segments(first)).count(b'<Camera:DepthMap'), 1)
            if confidence:
                with_it = scan(first)
        self.assertNotEqual(scan(first), with_it)

    def test_ten_edits_of_a_phones_photo(self):
        """GDepth, GImage and all else that the phone wrote stay as they are, turned or not."""
        for orientation in (1, 8):
            pictures.png('small.png', 24, 16, [bytes(20 + 200 * (x > 12) + y for x in range(24))
                                               for y in range(16)], colour=0)
            with open('small.png', 'rb') as file:
                depth = base64.b64encode(file.read())
            gimage = b' xmlns:GImage="http://ns.google.com/photos/1.0/image/"'
            text = packet(GDEPTH + gimage + b' GDepth:Data="' + depth + b'" GImage:Data="' +
                          base64.b64encode(self.base) + b'">')
            guid, parts = extended(text, 3000)
            phone = GDEPTH + b' xmlns:xmpNote="http://ns.adobe.com/xmp/note/" ' \
                b'xmpNote:HasExtendedXMP="' + guid + b'" GDepth:Format="RangeInverse" ' \
                b'GDepth:Near="3" GDepth:Far="70" GDepth:Mime="image/png" ' \
                b'xmlns:GFocus="http://ns.google.com/photos/1.0/focus/" ' \
                b'GFocus:BlurAtInfinity="0.02" GFocus:FocalDistance="5" ' \
                b'GFocus:FocalPointX="0.25" GFocus:FocalPointY="0.75">'
            self.jpeg('in.jpg', [(0xe1, b'Exif\0\0' + exif(orientation)),
                                 (0xe1, STANDARD + packet(TITLE, phone))] + parts)
            first = self.ten_edits('in.jpg')
            self.assertEqual([part for part in segments(first) if part in parts], parts)
            standard = [p for m, p in segments(first) if m == 0xe1 and p.startswith(STANDARD)]
            self.assertIn(phone, standard[0])
            one, other = (self.reports('info', name) for name in ('in.jpg', 'edit9.jpg'))
            self.assertIsNotNone(one['own_blur'])
            for key in ('focus_point', 'own_blur', 'depth'):
                self.assertEqual(one[key], other[key], key)
            for name in ('in.jpg', 'edit9.jpg'):
                result = self.run_it('render', name, '--f-number', '1.4', '-o', name + '.ppm')
                self.assertEqual(result.returncode, 0, result.stderr)
            with open('in.jpg.ppm', 'rb') as a, open('edit9.jpg.ppm', 'rb') as b:
                self.assertEqual(a.read(), b.read())

    def test_a_new_map_takes_the_place_of_the_old(self):
        self.jpeg('in.jpg', [])
        old = self.render('in.jpg', 'old.jpg', '--depth', 'depth.pgm')
        new = self.render('old.jpg', 'new.jpg', '--depth', 'mm.pgm', '--depth-unit', 'mm')
        self.assertEqual(data(new, b'GImage:Data'), data(old, b'GImage:Data'))
        self.assertNotEqual(data(new, b'GDepth:Data'), data(old, b'GDepth:Data'))
        self.assertEqual(b''.join(p for _, p in segments(new)).count(b'GDepth:Format'), 1)
        self.assertEqual(join_extended(segments(new))[1].count(b'GDepth:Data'), 1)
        self.assertEqual(self.reports('info', 'new.jpg')['depth']['near_m'], 0.5)

    def test_who_is_asked_for_and_who_is_not(self):
        self.jpeg('in.jpg', [])
        for options in ((), ('--editable',)):
            self.assertTrue(join_extended(segments(self.render(
                'in.jpg', 'out.jpg', '--depth', 'depth.pgm', *options)))[0])
        for options in (('--no-editable',), ('--strip',), ('--region', '0,0,16,16')):
            self.assertFalse(join_extended(segments(self.render(
                'in.jpg', 'out.jpg', '--depth', 'depth.pgm', *options)))[0])
        for options, why in ((('--strip',), 'it does not go with --strip; leave one out'),
                             (('--no-editable',), 'it does not go with --no-editable; leave one out'),
                             (('--region', '0,0,16,16'), 'it is for the whole photo, refocused; '
                              'leave --region and --view out')):
            self.fails(2, '--editable: ' + why, 'render', 'in.jpg', '--depth', 'depth.pgm',
                       '-o', 'no.jpg', '--editable', *options)
        self.fails(2, '--editable: it is for JPEG and HEIC; end the name of the output in .jpg or '
                   '.heic',
                   'render', 'in.jpg', '--depth', 'depth.pgm', '-o', 'no.png', '--editable')
        pictures.pfm_colour('photo.pfm', W, H, lambda x, y: (0.5,) * 3)
        self.fails(1, 'photo.pfm: --editable is for photos that are not of floats, by a build with '
                   'expat and libpng; leave it out',
                   'render', 'photo.pfm', '--depth', 'depth.pgm', '-o', 'no.jpg', '--editable')

    def test_xmp_without_room_stays(self):
        full = packet(TITLE, b'>' + b'<!--' + b'x' * 64300 + b'-->')
        for whole in (full, packet(TITLE)[:-90]):
            self.jpeg('in.jpg', [(0xe1, STANDARD + whole)])
            result = self.run_it('render', 'in.jpg', '--depth', 'depth.pgm', '-o', 'out.jpg')
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn('leaves no room', result.stderr)
            with open('out.jpg', 'rb') as file:
                out = segments(file.read())
            self.assertIn((0xe1, STANDARD + whole), out)
            self.assertEqual(join_extended(out), (None, b''))


if __name__ == '__main__':
    unittest.main()
