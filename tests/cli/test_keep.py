#!/usr/bin/env python3
"""What render keeps of the photo's file: segments of a JPEG and chunks of a PNG, byte for byte.
Usage: test_keep.py REFOCUS [unittest arguments]"""
import base64
import os
import struct
import unittest
import zlib

import pictures
from case import H, W
from jpeg_files import (GDEPTH, HAS_JPEG, HAS_PNG, HAS_XMP, Keep, OTHERS, STANDARD, TITLE, VERSION,
                        exif, extended, join_extended, packet, segment, segments)
from pictures import chunk


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
