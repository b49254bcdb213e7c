"""Hostile files: small ones that ask for much memory or time. Each is made when it is needed."""
import base64
import hashlib
import struct
import zlib

MB = 1 << 20


def deflated(size, byte=b'\0'):
    """A zlib stream of so many equal bytes."""
    packer, parts = zlib.compressobj(9), []
    for at in range(0, size, MB):
        parts.append(packer.compress(byte * min(MB, size - at)))
    return b''.join(parts + [packer.flush()])


def chunk(kind, data=b''):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(width, height, channels=3, extra=b'', interlaced=0):
    """A PNG of zeros, with more chunks before its pixels."""
    header = struct.pack('>IIBBBBB', width, height, 8, 2 if channels == 3 else 0, 0, 0, interlaced)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + extra +
            chunk(b'IDAT', deflated((width * channels + 1) * height)) + chunk(b'IEND'))


def png_texts(kind, count, size):
    """Compressed texts that nobody asked for."""
    head = {b'zTXt': b'a\0\0', b'iTXt': b'a\0\1\0\0\0', b'iCCP': b'a\0\0'}[kind]
    return png(16, 16, extra=count * chunk(kind, head + deflated(size, b'x')))


def png_beyond(size):
    """More data than pixels: so many bytes behind the last row."""
    header = struct.pack('>IIBBBBB', 16, 16, 8, 2, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', deflated(size)) +
            chunk(b'IEND'))


def segment(marker, data=b''):
    return struct.pack('>BBH', 0xff, marker, len(data) + 2) + data


class Bits:
    """Entropy-coded data of equal codes."""

    def __init__(self):
        self.text = []

    def put(self, value, width):
        self.text.append(format(value, '0%db' % width))

    def bytes(self):
        text = ''.join(self.text)
        text += '1' * (-len(text) % 8)
        return int(text, 2).to_bytes(len(text) // 8, 'big').replace(b'\xff', b'\xff\0')


def progressive(width, height, scans, before=b''):
    """A grey progressive JPEG: the DC of all blocks, then scans of one empty bit each."""
    blocks = (width + 7) // 8 * ((height + 7) // 8)
    tables = segment(0xdb, b'\0' + b'\1' * 64)
    tables += segment(0xc2, struct.pack('>BHHB', 8, height, width, 1) + b'\1\x11\0')
    tables += segment(0xc4, b'\0' + b'\1' + bytes(15) + b'\0')  # DC: '0' is no difference
    # AC: runs of empty blocks, of 2^14 to 2^15 - 1 ('0') and of one ('10').
    tables += segment(0xc4, b'\x10' + b'\1\1' + bytes(14) + b'\xe0\0')
    empty, left = Bits(), blocks
    while left > 0:
        run = min(left, 32767)
        if run >= 16384:
            empty.put(0, 1)
            empty.put(run - 16384, 14)
            left -= run
        else:
            for _ in range(run):
                empty.put(2, 2)
            left -= run
    empty, data = empty.bytes(), []
    scans -= 1
    for k in range(1, 64):
        for bit in range(8, -1, -1):
            if scans > 0:
                scans -= 1
                last = 0 if bit == 8 else (bit + 1) << 4
                data.append(segment(0xda, bytes((1, 1, 0, k, k, last | bit))) + empty)
    first = segment(0xda, bytes((1, 1, 0, 0, 0, 0))) + bytes((blocks + 7) // 8)
    return b'\xff\xd8' + before + tables + first + b''.join(data) + b'\xff\xd9'


RDF = ('<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF '
       'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description ')
END = '</rdf:Description></rdf:RDF></x:xmpmeta>'
GOOGLE = 'http://ns.google.com/photos/1.0/'


def with_xmp(attributes, inside='', extended='', jpeg=None):
    """A JPEG with a packet of XMP, and perhaps an extended one."""
    packets, extended = b'', extended.encode()
    if extended:
        guid = hashlib.md5(extended).hexdigest().upper()
        attributes += ' xmlns:n="http://ns.adobe.com/xmp/note/" n:HasExtendedXMP="%s"' % guid
        for at in range(0, len(extended), 65000):
            packets += segment(0xe1, b'http://ns.adobe.com/xmp/extension/\0' + guid.encode() +
                               struct.pack('>II', len(extended), at) + extended[at:at + 65000])
    packet = RDF + attributes + '>' + inside + END
    packets = segment(0xe1, b'http://ns.adobe.com/xap/1.0/\0' + packet.encode()) + packets
    return (jpeg or progressive)(16, 16, 1, packets)


def gdepth(depth, original=None, elements=0):
    """GDepth with pictures in an extended packet, and perhaps elements that mean nothing."""
    attributes = ('xmlns:d="%sdepthmap/" d:Format="RangeInverse" d:Near="1" d:Far="9" '
                  'd:Mime="image/png"' % GOOGLE)
    text = 'xmlns:d="%sdepthmap/" d:Data="%s"' % (GOOGLE, base64.b64encode(depth).decode())
    if original:
        text += ' xmlns:i="%simage/" i:Data="%s"' % (GOOGLE, base64.b64encode(original).decode())
    return with_xmp(attributes, extended=RDF + text + '>' + '<a/>' * elements + END)


def dynamic(pictures, items=0, length=None):
    """Dynamic Depth: depth and original behind the photo, and perhaps items of nothing before."""
    place = '%sdd/1.0/' % GOOGLE.replace('1.0/', '')
    names = 'depth', 'original'
    listed = '<c:Item i:DataURI="nothing" i:Length="1"/>' * (items + 1)
    listed += ''.join('<c:Item i:Semantic="%s" i:Length="%d"/>' % (
        name.title(), length or len(picture)) for name, picture in zip(names, pictures))
    attributes = 'xmlns:c="%scontainer/" xmlns:i="%sitem/"' % (place, place)
    if items:
        return with_xmp(attributes, extended=RDF + attributes + '><c:Directory>' + listed +
                        '</c:Directory>' + END)
    return with_xmp(attributes, '<c:Directory>%s</c:Directory>' % listed) + b''.join(pictures)


def xmp_elements(count):
    return with_xmp('', extended=RDF + '>' + '<a/>' * count + END)


def xmp_deep(depth):
    return with_xmp('', extended=RDF + '>' + '<a>' * depth + '</a>' * depth + END)


def xmp_attributes(count):
    return with_xmp('', extended=RDF + ' '.join('a%d=""' % i for i in range(count)) + '>' + END)


def xmp_namespaces(count):
    return with_xmp('', extended=RDF + ' '.join('xmlns:a%d="%d"' % (i, i) for i in range(count)) +
                    '>' + END)


def jpeg_segments(count):
    return progressive(16, 16, 1, segment(0xef) * count)


def strokes(size, lines):
    return ('{"refocus-strokes": 1, "width": %d, "height": %d, "strokes": [%s]}' %
            (*size, ',\n'.join(lines))).encode()


def objects(size, count, kind='object', radius=30, reach=64):
    width, height = size
    lines = ['{"kind": "%s", "radius": %g, "reach": %g, "disparity": 0.5, "points": [[%d, %d]]}' %
             ('object' if i == 0 else kind, radius, reach, 7 * i % width, 11 * i % height)
             for i in range(count)]
    return strokes(size, lines)


def zigzag(size, count, kind, radius):
    points = ', '.join('[%d, %d]' % (i * 7 % size[0], i % 2 * (size[1] - 1)) for i in range(count))
    return strokes(size, ['{"kind": "%s", "radius": %g, "disparity": 1, "points": [%s]}' %
                          (kind, radius, points)])


def nested(depth):
    return b'[' * depth + b']' * depth
