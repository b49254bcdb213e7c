"""JPEGs of segments, with XMP packets, EXIF and indices of pictures in them."""
import hashlib
import os
import struct
import subprocess

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

