#!/usr/bin/env python3
"""What render keeps of the photo's file: segments of a JPEG and chunks of a PNG, byte for byte.
Usage: test_keep.py REFOCUS [unittest arguments]"""
import base64
import hashlib
import os
import re
import struct
import subprocess
import unittest
import zlib
from xml.etree import ElementTree

import pictures
from case import Case, H, REFOCUS, W

VERSION = subprocess.run([REFOCUS, '--version'], stdout=subprocess.PIPE, text=True).stdout
HAS_JPEG, HAS_PNG, HAS_XMP = 'JPEG' in VERSION, 'PNG' in VERSION, 'RF_XMP' in os.environ

STANDARD, EXTENDED = b'http://ns.adobe.com/xap/1.0/\0', b'http://ns.adobe.com/xmp/extension/\0'
RDF = b'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"'

RDF_NAME = '{http://www.w3.org/1999/02/22-rdf-syntax-ns#}'


def segments(jpeg):
    """(marker, payload) of each segment before the first scan."""
    found, at = [], 2
    assert jpeg[:2] == b'\xff\xd8'
    while jpeg[at + 1] != 0xda:
        size = struct.unpack('>H', jpeg[at + 2:at + 4])[0]
        found.append((jpeg[at + 1], jpeg[at + 4:at + 2 + size]))
        at += 2 + size
    return found


def segment(marker, payload):
    return struct.pack('>BBH', 0xff, marker, len(payload) + 2) + payload


def packet(*properties):
    """An XMP packet with padding; each property is the inside of an rdf:Description."""
    return b'<?xpacket begin="\xef\xbb\xbf" id="W5M0MpCehiHzreSzNTczkc9d"?>\n<x:xmpmeta ' \
        b'xmlns:x="adobe:ns:meta/">\n <rdf:RDF ' + RDF + b'>' + b''.join(
            b'\n  <rdf:Description rdf:about=""' + p + b'</rdf:Description>' for p in properties) + \
        b'\n </rdf:RDF>\n</x:xmpmeta>\n' + b' ' * 50 + b'\n<?xpacket end="w"?>'


def extended(text, step):
    guid = hashlib.md5(text).hexdigest().upper().encode()
    return guid, [(0xe1, EXTENDED + guid + struct.pack('>II', len(text), at) + text[at:at + step])
                  for at in range(0, len(text), step)]


def join_extended(found):
    guids, text = set(), b''
    for marker, payload in found:
        if marker == 0xe1 and payload.startswith(EXTENDED):
            rest = payload[len(EXTENDED):]
            guids.add(rest[:32])
            assert struct.unpack('>I', rest[36:40])[0] == len(text)
            text += rest[40:]
    assert len(guids) <= 1
    assert not guids or guids == {hashlib.md5(text).hexdigest().upper().encode()}
    return guids.pop() if guids else None, text


def mpf(main_size, pictures_behind):
    """An index of pictures: (offset from its MM, size) of each behind the main one."""
    entries = b''.join(struct.pack('>IIIHH', 0, size, at, 0, 0) for at, size in
                       [(0, main_size)] + [p or (0, 0) for p in pictures_behind])
    return b'MPF\0MM\0*\0\0\0\x08' + struct.pack('>H', 3) + \
        struct.pack('>HHI4s', 0xb000, 7, 4, b'0100') + \
        struct.pack('>HHII', 0xb001, 4, 1, len(entries) // 16) + \
        struct.pack('>HHII', 0xb002, 7, len(entries), 50) + bytes(4) + entries


def exif(orientation):
    """Orientation, sides 9 x 9, and a thumbnail's directory behind."""
    main = struct.pack('>H', 2) + struct.pack('>HHIHH', 0x112, 3, 1, orientation, 0) + \
        struct.pack('>HHII', 0x8769, 4, 1, 38) + struct.pack('>I', 99)
    settings = struct.pack('>H', 2) + struct.pack('>HHII', 0xa002, 4, 1, 9) + \
        struct.pack('>HHIHH', 0xa003, 3, 1, 9, 0) + struct.pack('>I', 0)
    return b'MM\0*' + struct.pack('>I', 8) + main + settings


TITLE = b' xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:title>Gr&#252;n &lt;3</dc:title>'
GDEPTH = b' xmlns:GDepth="http://ns.google.com/photos/1.0/depthmap/"'
OTHERS = [(0xfe, b'a comment'), (0xed, b'Photoshop 3.0\0008BIM\4\4\0\0\0\0\0\5\34\2x\0\0'),
          (0xe5, b'Samsung\0' + bytes(range(256))), (0xe0, b'CIFF0001'), (0xe2, b'FPXR\0\0\1'),
          (0xfe, b''), (0xeb, bytes(65533))]


class Keep(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        pictures.pgm('upright.pgm', H, W, lambda x, y: 255 if y >= W // 2 else 51)
        if HAS_JPEG:
            subprocess.run([REFOCUS, 'render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0',
                            '-o', 'base.jpg'], check=True)
            with open('base.jpg', 'rb') as file:
                cls.base = file.read()

    def jpeg(self, name, parts):
        with open(name, 'wb') as file:
            file.write(self.base[:20] + b''.join(segment(*part) for part in parts) +
                       self.base[20:])

    def rendered(self, photo, *options, out='out.jpg'):
        self.succeeds('render', photo, '--blur', '3', '-o', out, *options)
        with open(out, 'rb') as file:
            return file.read()

    def kept(self, photo, *options):
        """Segments of the result that a picture without metadata has not."""
        plain = segments(self.base)
        return [part for part in segments(self.rendered(photo, '--depth', 'depth.pgm',
                                                       '--no-editable', *options))
                if part not in plain and part[0] not in (0xc0, 0xc4, 0xdb)]


@unittest.skipUnless(HAS_JPEG, 'needs TurboJPEG')
class Jpeg(Keep):
    def test_unknown_segments_stay_byte_for_byte(self):
        self.jpeg('in.jpg', OTHERS)
        self.assertEqual(self.kept('in.jpg'), OTHERS)
        os.rename('out.jpg', 'again.jpg')
        self.assertEqual(self.kept('again.jpg'), OTHERS)

    def test_segments_of_the_old_pixels_go(self):
        self.jpeg('in.jpg', [(0xee, b'Adobe\0\x64\0\0\0\0\1'), (0xe0, b'JFXX\0\x10x'),
                             (0xe2, b'MPF\0MM\0*\0\0\0\x08\0\0'),
                             (0xe2, b'urn:iso:std:iso:ts:21496:-1\0\0\0')])
        self.assertEqual(self.kept('in.jpg'), [])

    def test_exif_and_density_are_true_of_the_result(self):
        parts = segments(self.base)
        self.assertEqual(parts[0][1][:5], b'JFIF\0')
        for turned in (False, True):
            self.jpeg('in.jpg', [(0xe1, b'Exif\0\0' + exif(8 if turned else 1))])
            with open('in.jpg', 'r+b') as file:
                file.seek(13)
                file.write(b'\1\1\x2c\1\x2c')
            out = segments(self.rendered('in.jpg', '--no-editable', '--depth',
                                         'upright.pgm' if turned else 'depth.pgm'))
            block = out[1][1][6:]
            self.assertEqual(out[0][1][7:12], b'\1\1\x2c\1\x2c')
            self.assertEqual(struct.unpack('>H', block[18:20])[0], 1)
            self.assertEqual(struct.unpack('>I', block[34:38])[0], 0)
            sides = sorted([block[40:52], block[52:64]])
            self.assertEqual([struct.unpack('>HH', s[:4]) for s in sides][0][0], 0xa002)
            values = [struct.unpack('>I' if s[3] == 4 else '>H', s[8:12] if s[3] == 4 else s[8:10])
                      for s in sides]
            self.assertEqual(values, [(H,), (W,)] if turned else [(W,), (H,)])

    def test_strip(self):
        icc = b'ICC_PROFILE\0\1\1' + b'\0' * 12 + b'mntrRGB ' + bytes(108)
        self.jpeg('in.jpg', OTHERS + [(0xe1, b'Exif\0\0' + exif(1)), (0xe2, icc),
                                      (0xe1, STANDARD + packet(TITLE))])
        kept = self.kept('in.jpg', '--strip')
        self.assertEqual([part for part in kept if part != (0xe2, icc)], [])


@unittest.skipUnless(HAS_JPEG and HAS_XMP, 'needs TurboJPEG and expat')
class Xmp(Keep):
    def test_packets_without_places_stay_byte_for_byte(self):
        guid, chunks = extended(packet(TITLE, b'>' + b'<!-- %s -->' % (b'x' * 90000)), 50000)
        note = b' xmlns:xmpNote="http://ns.adobe.com/xmp/note/" xmpNote:HasExtendedXMP="' + \
            guid + b'">'
        parts = [(0xe1, STANDARD + packet(TITLE, note))] + chunks[::-1] + OTHERS
        self.jpeg('in.jpg', parts)
        self.assertEqual(self.kept('in.jpg'), parts)

    def test_damaged_packets_stay(self):
        for bad in (packet(TITLE)[:-90], b'\xfe\xff' + packet(TITLE).decode().encode('utf-16-be')):
            self.jpeg('in.jpg', [(0xe1, STANDARD + bad)])
            self.assertEqual(self.kept('in.jpg'), [(0xe1, STANDARD + bad)])

    def test_what_points_elsewhere_is_cut_and_the_rest_stays(self):
        attribute = b' xmlns:C="http://ns.google.com/photos/1.0/container/"'
        dead = [(b'<C:Directory><rdf:Seq><rdf:li rdf:parseType="Resource"><C:Item/></rdf:li>'
                 b'</rdf:Seq></C:Directory>', attribute),
                (b"\n   hdrgm:Version = '1.0'", b' xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/"'),
                (b' D:a="1"', b' xmlns:D="http://ns.google.com/photos/dd/1.0/device/"'),
                (b' g:MicroVideoOffset="5"', b' xmlns:g="http://ns.google.com/photos/1.0/camera/"')]
        for text, declared in dead:
            element = text.startswith(b'<')
            whole = declared + (b'>' + text if element else text + b'>')
            mixed = declared + b' xmlns:q="q:" q:a="&quot;=\'>"' + \
                (b'>' + text if element else text + b'>') + b'<q:b>1</q:b>'
            rest = mixed.replace(text, b'')
            self.jpeg('in.jpg', [(0xe1, STANDARD + packet(TITLE, whole, mixed))])
            result = self.run_it('render', 'in.jpg', '--depth', 'depth.pgm', '-o', 'out.jpg',
                                 '--no-editable')
            self.assertEqual((result.returncode, 'gain map' in result.stderr),
                             (0, b'hdrgm' in text), result.stderr)
            editable = self.run_it('render', 'in.jpg', '--depth', 'depth.pgm', '-o', 'edit.jpg')
            self.assertEqual((editable.returncode, 'gain map' in editable.stderr),
                             (0, b'hdrgm' in text), editable.stderr)
            with open('out.jpg', 'rb') as file:
                out = segments(file.read())
            expected = packet(TITLE, whole, rest).replace(
                b'<rdf:Description rdf:about=""' + whole + b'</rdf:Description>', b'')
            self.assertIn((0xe1, STANDARD + expected), out, text)
            self.jpeg('in.jpg', [(0xe1, STANDARD + packet(whole))])
            result = self.run_it('render', 'in.jpg', '--depth', 'depth.pgm', '-o', 'out.jpg',
                                 '--no-editable')
            with open('out.jpg', 'rb') as file:
                self.assertNotIn(0xe1, [marker for marker, _ in segments(file.read())])

    def test_extended_packet_that_loses_its_depth(self):
        data = b'GDepth:Extra="' + base64.b64encode(bytes(99999)) + b'"'
        audio = b' xmlns:A="http://ns.google.com/photos/1.0/audio/" A:Data="' + b'QUJD' * 20000 + b'"'
        for text, left in ((packet(GDEPTH + b' ' + data + b'>'), False),
                           (packet(GDEPTH + b' ' + data + audio + b'>', TITLE), True)):
            guid, chunks = extended(text, 60000)
            note = b' xmlns:xmpNote="http://ns.adobe.com/xmp/note/" xmpNote:HasExtendedXMP="' + \
                guid + b'"'
            self.jpeg('in.jpg', [(0xe1, STANDARD + packet(TITLE, note + b'>'))] + chunks)
            kept = self.kept('in.jpg')
            standard = [p for m, p in kept if m == 0xe1 and p.startswith(STANDARD)]
            found, joined = join_extended(kept)
            self.assertEqual(len(standard), 1)
            self.assertIn(TITLE, standard[0])
            self.assertNotIn(guid, standard[0])
            if left:
                self.assertEqual(joined, text.replace(b' ' + data, b''))
                self.assertEqual(standard[0].count(b'HasExtendedXMP="' + found + b'"'), 1)
                os.rename('out.jpg', 'again.jpg')
                self.assertEqual(self.kept('again.jpg'), kept)
            else:
                self.assertEqual((found, joined), (None, b''))
                self.assertNotIn(b'HasExtendedXMP', standard[0])

    def test_orientation_and_sides_of_xmp(self):
        tiff = b' xmlns:tiff="http://ns.adobe.com/tiff/1.0/" tiff:Orientation="8" tiff:Make="M"' \
            b' tiff:ImageWidth="48">'
        self.jpeg('in.jpg', [(0xe1, STANDARD + packet(tiff)), (0xe1, b'Exif\0\0' + exif(8))])
        self.succeeds('render', 'in.jpg', '--depth', 'upright.pgm', '-o', 'out.jpg',
                      '--no-editable')
        with open('out.jpg', 'rb') as file:
            out = segments(file.read())
        self.assertIn((0xe1, STANDARD + packet(tiff.replace(b' tiff:Orientation="8"', b'').replace(
            b' tiff:ImageWidth="48"', b''))), out)


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
            with open('small.png', 'wb') as file:
                rows = b''.join(b'\0' + bytes(20 + 200 * (x > 12) + y for x in range(24))
                                for y in range(16))
                file.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 24, 16, 8, 0,
                                                                              0, 0, 0)) +
                           chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))
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


def chunk(kind, content):
    return struct.pack('>I', len(content)) + kind + content + \
        struct.pack('>I', zlib.crc32(kind + content))


def chunks(png):
    found, at = [], 8
    while at < len(png):
        size = struct.unpack('>I', png[at:at + 4])[0]
        found.append((png[at + 4:at + 8], png[at + 8:at + 8 + size]))
        at += size + 12
    return found


@unittest.skipUnless(HAS_PNG, 'needs libpng')
class Png(Keep):
    XMP = b'XML:com.adobe.xmp\0\0\0\0\0'

    def png(self, name, parts):
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o', name)
        with open(name, 'rb') as file:
            data = file.read()
        with open(name, 'wb') as file:
            file.write(data[:33] + b''.join(chunk(*part) for part in parts[:-1]) + data[33:-12] +
                       chunk(*parts[-1]) + data[-12:])

    def test_chunks_stay_byte_for_byte(self):
        stay = [(b'gAMA', struct.pack('>I', 45455)), (b'pHYs', b'\0\0\x0b\x13\0\0\x0b\x13\1'),
                (b'tEXt', b'Title\0Leaves'), (b'zTXt', b'Long\0\0' + zlib.compress(b'x' * 500)),
                (b'iTXt', self.XMP + packet(TITLE)), (b'prVt', bytes(40)), (b'tIME', bytes(7))]
        go = [(b'bKGD', bytes(6)), (b'prVT', bytes(40)), (b'sBIT', b'\5\5\5')]
        self.png('in.png', go + stay)
        out = chunks(self.rendered('in.png', '--depth', 'depth.pgm', out='out.png'))
        self.assertEqual([part for part in out if part[0] not in (b'IHDR', b'IDAT', b'IEND')], stay)

    def test_colours(self):
        """A PNG keeps what a PNG says; light is written as sRGB; other formats leave it out."""
        adobe = struct.pack('>8I', 31270, 32900, 64000, 33000, 21000, 71000, 15000, 6000)
        linear, bt2020_pq = (b'gAMA', struct.pack('>I', 100000)), (b'cICP', b'\x09\x10\0\1')
        says = ' by which the photo has other colours than sRGB; a PNG keeps them'
        rows = [b''.join(struct.pack('>3H', 900 * x, 700 * x + 80 * y, 500) for x in range(W))
                for y in range(H)]
        for more, by in ([linear], 'gAMA and cHRM'), ([(b'cHRM', adobe)], 'gAMA and cHRM'), (
                [bt2020_pq, linear], 'cICP'), ([linear, (b'sRGB', b'\0')], None):
            self.png('in.png', more + [(b'tEXt', b'Title\0Leaves')])
            out = chunks(self.rendered('in.png', '--depth', 'depth.pgm', out='out.png'))
            self.assertEqual([part for part in out if part in more], more)
            if HAS_JPEG:
                call = ('render', 'in.png', '--depth', 'depth.pgm', '-o', 'out.jpg')
                if by:
                    self.warns('out.jpg: it is written without %s,%s' % (by, says), *call)
                else:
                    self.succeeds(*call)
        pictures.png('deep.png', W, H, rows, depth=16)
        whole = pictures.read_bytes('deep.png')
        with open('deep.png', 'wb') as file:
            file.write(whole[:33] + chunk(*bt2020_pq) + chunk(b'mDCV', bytes(24)) + whole[33:])
        for name in ('out.png', 'out.jpg') if HAS_JPEG else ('out.png',):
            self.rendered('deep.png', '--depth', 'depth.pgm', out=name)
        out = chunks(self.rendered('deep.png', '--depth', 'depth.pgm', out='out.png'))
        self.assertEqual([part[0] for part in out if part[0] in (b'cICP', b'mDCV')], [])

    @unittest.skipUnless(HAS_JPEG, 'needs TurboJPEG')
    def test_what_a_jpeg_alone_holds_is_told(self):
        """By all formats but JPEG and those that hold nothing; a TIFF has no maker's note either."""
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o', 'x.jpg')
        plain = pictures.read_bytes('x.jpg')
        note = (b'Exif\0\0MM\0*\0\0\0\x08\0\1\x87\x69\0\4\0\0\0\1\0\0\0\x1a\0\0\0\0'
                b'\0\1\x92\x7c\0\7\0\0\0\4note\0\0\0\0')
        iptc, comment = (0xed, b'Photoshop 3.0\0' + b'8BIM\4\4\0\0\0\0\0\0'), (0xfe, b'by hand')
        endings = [e for e, name in (('.png', ' PNG '), ('.tif', ' TIFF '), ('.heic', ' HEIC '))
                   if name in VERSION]
        for parts, words in ([iptc], 'IPTC'), ([comment], 'comments'), (
                [iptc, comment], 'IPTC and comments'), ([(0xed, b'Other')], None):
            with open('in.jpg', 'wb') as file:
                file.write(plain[:2] + segment(0xe1, note) +
                           b''.join(segment(*part) for part in parts) + plain[2:])
            out = segments(self.rendered('in.jpg', '--depth', 'depth.pgm', out='out.jpg'))
            self.assertEqual([part for part in out if part in parts], parts)
            self.rendered('in.jpg', '--depth', 'depth.pgm', out='out.ppm')
            for ending in endings:
                told = []
                if words:
                    told.append("it is written without the photo's %s; a JPEG keeps them" % words)
                if ending == '.tif':
                    told.append("the maker's note of EXIF is not written into a TIFF")
                call = ('render', 'in.jpg', '--depth', 'depth.pgm', '--no-editable', '-o',
                        'out' + ending)
                if told:
                    self.warns('out%s: %s' % (ending, '; '.join(told)), *call)
                else:
                    self.succeeds(*call)
                    self.assertIn(b'note', pictures.read_bytes('out' + ending))

    @unittest.skipUnless(HAS_JPEG and HAS_XMP, 'needs TurboJPEG and expat')
    def test_xmp_goes_from_png_to_jpeg_and_back(self):
        self.png('in.png', [(b'iTXt', self.XMP + packet(TITLE))])
        out = segments(self.rendered('in.png', '--depth', 'depth.pgm'))
        self.assertIn((0xe1, STANDARD + packet(TITLE)), out)
        out = chunks(self.rendered('out.jpg', '--depth', 'depth.pgm', out='out.png'))
        self.assertIn((b'iTXt', self.XMP + packet(TITLE)), out)


if __name__ == '__main__':
    unittest.main()
