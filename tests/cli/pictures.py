"""Small pictures, made and read with the standard library alone."""
import random
import struct
import zlib


def ppm(path, width, height, pixel):
    data = bytes(v for y in range(height) for x in range(width) for v in pixel(x, y))
    with open(path, 'wb') as file:
        file.write(b'P6\n%d %d\n255\n' % (width, height) + data)


def stereo_pair(left, right):
    """Grey noise of 160 x 96 pixels: what is near moves by 16 pixels, the others by 4."""
    rng = random.Random(3)
    noise = [[rng.randrange(256) for _ in range(200)] for _ in range(96)]

    def seen(x, y, shift):
        near = 50 <= x + (16 if shift else 0) < 110 and 24 <= y < 72
        return noise[y][x + 20 + ((16 if near else 4) if shift else 0)]
    for name, shift in (left, 0), (right, 1):
        ppm(name, 160, 96, lambda x, y, s=shift: (seen(x, y, s),) * 3)


def pgm(path, width, height, value, greatest=255):
    pack = '>H' if greatest > 255 else 'B'
    data = b''.join(struct.pack(pack, value(x, y)) for y in range(height)
                    for x in range(width))
    with open(path, 'wb') as file:
        file.write(b'P5\n%d %d\n%d\n' % (width, height, greatest) + data)


def pfm(path, width, height, value):
    rows = [struct.pack('<%df' % width, *(value(x, y) for x in range(width)))
            for y in range(height)]
    with open(path, 'wb') as file:
        file.write(b'Pf\n%d %d\n-1.0\n' % (width, height) + b''.join(reversed(rows)))


def pfm_colour(path, width, height, value):
    """value(x, y) is (R, G, B)."""
    rows = [struct.pack('<%df' % (3 * width), *(v for x in range(width) for v in value(x, y)))
            for y in range(height)]
    with open(path, 'wb') as file:
        file.write(b'PF\n%d %d\n-1.0\n' % (width, height) + b''.join(reversed(rows)))


def chunk(kind, content):
    """One of a PNG."""
    return struct.pack('>I', len(content)) + kind + content + \
        struct.pack('>I', zlib.crc32(kind + content))


def png(path, width, height, rows, depth=8, colour=2):
    with open(path, 'wb') as file:
        file.write(b'\x89PNG\r\n\x1a\n' +
                   chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, depth, colour,
                                              0, 0, 0)) +
                   chunk(b'IDAT', zlib.compress(b''.join(b'\0' + row for row in rows))) +
                   chunk(b'IEND', b''))


def insert_xmp(path, attributes):
    """An XMP packet of Google's depth behind the SOI of a JPEG."""
    places = ''.join(' xmlns:%s="http://ns.google.com/photos/1.0/%s/"' % place for place in (
        ('GDepth', 'depthmap'), ('GFocus', 'focus'), ('GImage', 'image')))
    packet = (b'http://ns.adobe.com/xap/1.0/\0' + (
        '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF '
        'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description%s %s/>'
        '</rdf:RDF></x:xmpmeta>' % (places, attributes)).encode())
    data = read_bytes(path)
    with open(path, 'wb') as file:
        file.write(data[:2] + b'\xff\xe1' + struct.pack('>H', len(packet) + 2) + packet +
                   data[2:])


def insert_mpf(path, parts):
    """Further pictures behind a JPEG, by an index (CIPA DC-007)."""
    data = read_bytes(path)
    segment = 4 + 4 + 8 + 2 + 12 + 4 + 16 * (len(parts) + 1)
    place = len(data) + segment - 10  # counted from the TIFF header, at 10
    entries = struct.pack('>IIIHH', 0x30000, len(data) + segment, 0, 0, 0)
    for part in parts:
        entries += struct.pack('>IIIHH', 0, len(part), place, 0, 0)
        place += len(part)
    index = (b'MPF\0MM\0*' + struct.pack('>IHHHIII', 8, 1, 0xb002, 7, len(entries), 26, 0) +
             entries)
    with open(path, 'wb') as file:
        file.write(data[:2] + b'\xff\xe2' + struct.pack('>H', len(index) + 2) + index + data[2:] +
                   b''.join(parts))


def insert_dynamic(path, attributes, items):
    """Dynamic Depth: a packet with the attributes of a DepthMap and a directory of items, pairs of
    URI and bytes, which are put behind the JPEG."""
    place = 'http://ns.google.com/photos/dd/1.0/'
    names = ''.join(' xmlns:%s="%s%s/"' % (name, place, name.lower())
                    for name in ('Container', 'Item', 'Camera', 'DepthMap'))
    listed = ''.join('<rdf:li><Container:Item Item:Mime="image/png" Item:Length="%d" '
                     'Item:DataURI="%s"/></rdf:li>' % (len(data), uri)
                     for uri, data in [('primary_image', b'')] + items)
    packet = (b'http://ns.adobe.com/xap/1.0/\0' + (
        '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF '
        'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description%s>'
        '<Container:Directory><rdf:Seq>%s</rdf:Seq></Container:Directory>'
        '<Camera:DepthMap %s/></rdf:Description></rdf:RDF></x:xmpmeta>' %
        (names, listed, attributes)).encode())
    data = read_bytes(path)
    with open(path, 'wb') as file:
        file.write(data[:2] + b'\xff\xe1' + struct.pack('>H', len(packet) + 2) + packet +
                   data[2:] + b''.join(item for _, item in items))


def ultra_hdr(path, photo, gain_map, stops):
    """Two JPEGs in one: gain_map is from 0 to so many stops."""
    packet = (b'http://ns.adobe.com/xap/1.0/\0<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF '
              b'xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description '
              b'xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/" hdrgm:Version="1.0" '
              b'hdrgm:GainMapMax="%d" hdrgm:HDRCapacityMax="%d"/></rdf:RDF></x:xmpmeta>'
              % (stops, stops))
    part = read_bytes(gain_map)
    with open(path, 'wb') as file:
        file.write(read_bytes(photo) + part[:2] + b'\xff\xe1' +
                   struct.pack('>H', len(packet) + 2) + packet + part[2:])


def read_bytes(path):
    with open(path, 'rb') as file:
        return file.read()


def read_pnm(path):
    """(width, height, samples) of a P5 or P6 file."""
    data = read_bytes(path)
    kind, width, height, greatest = data.split(None, 4)[:4]
    size = int(width) * int(height) * (3 if kind == b'P6' else 1)
    if int(greatest) > 255:
        return int(width), int(height), struct.unpack('>%dH' % size, data[-2 * size:])
    return int(width), int(height), tuple(data[-size:])


def read_pfm(path):
    data = read_bytes(path)
    kind, width, height, scale = data.split(None, 4)[:4]
    width, height = int(width), int(height)
    row = width * {b'Pf': 1, b'PF': 3}[kind]
    values = struct.unpack(('<' if float(scale) < 0 else '>') + '%df' % (row * height),
                           data[-4 * row * height:])
    return width, height, tuple(v for y in reversed(range(height))
                                for v in values[y * row:(y + 1) * row])


def read_png(path):
    """(width, height, bits, channels, rows of bytes); any filter, no interlace."""
    data = read_bytes(path)
    at, idat = 8, b''
    while at < len(data):
        size, name = struct.unpack('>I4s', data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if name == b'IHDR':
            width, height, bits, colour = struct.unpack('>IIBB', body[:10])
        if name == b'IDAT':
            idat += body
        at += 12 + size
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    step, row_size = channels * bits // 8, width * channels * bits // 8
    raw, rows, last = zlib.decompress(idat), [], bytes(row_size)
    for y in range(height):
        kind, row = raw[y * (row_size + 1)], bytearray(
            raw[y * (row_size + 1) + 1:(y + 1) * (row_size + 1)])
        for i in range(row_size):
            a = row[i - step] if i >= step else 0
            b = last[i]
            c = last[i - step] if i >= step else 0
            p = a + b - c
            near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, near)[kind]) & 255
        rows.append(bytes(row))
        last = bytes(row)
    return width, height, bits, channels, rows
