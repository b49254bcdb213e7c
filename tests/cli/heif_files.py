"""HEIF files that no encoder here makes: laid out as phones do."""
import struct

from pictures import read_bytes


def box(kind, *parts):
    content = b''.join(parts)
    return struct.pack('>I4s', 8 + len(content), kind) + content


def full(kind, version, flags, *parts):
    return box(kind, struct.pack('>I', version << 24 | flags), *parts)


def boxes(data, at, end):
    """(kind, content, end) of each box."""
    while at < end:
        size, kind = struct.unpack('>I4s', data[at:at + 8])
        yield kind, at + 8, at + size
        at += size


def find(data, at, end, kind):
    return next((content, to) for name, content, to in boxes(data, at, end) if name == kind)


def coded(path):
    """Configuration and samples of the one picture of a HEIC that libheif wrote."""
    data = read_bytes(path)
    at, end = find(data, 0, len(data), b'meta')
    properties = find(data, *find(data, at + 4, end, b'iprp'), b'ipco')
    configuration = data[slice(*find(data, *properties, b'hvcC'))]
    samples = data[slice(*find(data, 0, len(data), b'mdat'))]
    return configuration, samples


def tiff(model):
    """EXIF that says a camera of three letters."""
    return b'MM\0*\0\0\0\x08' + struct.pack('>HHHI3sxI', 1, 0x110, 2, 4, model, 0)


def representation():
    """Depth representation SEI: the inverse of z, 0.5 m to 4 m (ISO/IEC 23008-2, G.14.2.6)."""
    def element(power):
        return '0' + format(31 + power, '07b') + '00000' + '0'
    bits = '1100' + '1' + element(-1) + element(2)
    bits += '1' + '0' * (-(len(bits) + 1) % 8)
    payload = int(bits, 2).to_bytes(len(bits) // 8, 'big')
    nal = b'\x4e\x01' + bytes((177, len(payload))) + payload + b'\x80'
    return struct.pack('>II', len(nal) + 4, len(nal)) + nal


def container(path, items, references, properties, hidden, main=1, inside=(), groups=b''):
    """A HEIC of items, (number, kind, data, properties); of properties, which are counted from 1,
    those with bit 7 are essential. Data of the kinds in `inside` lie in the description itself."""
    information = b''.join(full(b'infe', 2, number in hidden, struct.pack(
        '>HH4s', number, 0, kind), b'\0application/rdf+xml\0' if kind == b'mime' else b'\0')
        for number, kind, _, _ in items)
    references = b''.join(box(kind, struct.pack('>HH%dH' % len(to), number, len(to), *to))
                          for kind, number, to in references)
    owners = [(number, own) for number, _, _, own in items if own]
    associations = full(b'ipma', 0, 0, struct.pack('>I', len(owners)), *(
        struct.pack('>HB%dB' % len(own), number, len(own), *own) for number, own in owners))

    def header(offset):
        places, within = b'', 0
        for number, kind, data, _ in items:
            is_inside = kind in inside
            places += struct.pack('>HHHHII', number, is_inside, 0, 1,
                                  within if is_inside else offset, len(data))
            within, offset = (within + len(data), offset) if is_inside else (
                within, offset + len(data))
        return box(b'ftyp', b'heic\0\0\0\0mif1heic') + full(
            b'meta', 0, 0, full(b'hdlr', 0, 0, b'\0\0\0\0pict' + bytes(13)),
            full(b'pitm', 0, 0, struct.pack('>H', main)),
            full(b'iinf', 0, 0, struct.pack('>H', len(items)), information),
            full(b'iref', 0, 0, references),
            box(b'iprp', box(b'ipco', *properties), associations), groups,
            box(b'idat', *(data for _, kind, data, _ in items if kind in inside)),
            full(b'iloc', 1, 0, struct.pack('>BBH', 0x44, 0, len(items)), places))
    with open(path, 'wb') as file:
        file.write(header(len(header(0)) + 8) +
                   box(b'mdat', *(data for _, kind, data, _ in items if kind not in inside)))


def size_of(width, height=None):
    return full(b'ispe', 0, 0, struct.pack('>II', width, height or width))


def pair_beside(path, picture, photo_size, left, right, size):
    """A photo that has a stereo pair beside it, as an iPhone's since iOS 26; of each file the one
    picture. EXIF is of the left one."""
    (config, photo), (view_config, view) = coded(picture), coded(left)
    items = [(1, b'hvc1', photo, (0x81, 3)), (2, b'hvc1', coded(right)[1], (0x82, 4)),
             (3, b'hvc1', view, (0x82, 4)), (4, b'Exif', struct.pack('>I', 0) + tiff(b'eye'), ())]
    properties = (box(b'hvcC', config), box(b'hvcC', view_config), size_of(*photo_size), size_of(*size))
    container(path, items, ((b'cdsc', 4, (3,)),), properties, (4,), groups=box(
        b'grpl', full(b'ster', 0, 0, struct.pack('>IIII', 9, 2, 3, 2))))


def phone(path, picture, depth, side, model):
    """A picture and its depth, each a grid of 2 x 2 tiles of side x side pixels: files of one such
    tile. EXIF describes the picture, and what a gain map makes of it, as iPhones say since iOS 18,
    and depth is of both, as since iOS 26; here the map is the depth."""
    (config, tile), (depth_config, depth_tile) = coded(picture), coded(depth)
    grid = struct.pack('>BBBBHH', 0, 0, 1, 1, 2 * side, 2 * side)
    main, aux, toned, exif = 9, 10, 11, 12
    items = [(i, b'hvc1', tile, (0x81, 3)) for i in range(1, 5)]
    items += [(i, b'hvc1', depth_tile, (0x82, 3)) for i in range(5, 9)]
    items += [(main, b'grid', grid, (4,)), (aux, b'grid', grid, (4, 0x85)),
              (toned, b'tmap', b'\0' * 62, (4,)),
              (exif, b'Exif', struct.pack('>I', 0) + tiff(model), ())]
    references = ((b'dimg', main, range(1, 5)), (b'dimg', aux, range(5, 9)),
                  (b'auxl', aux, (main, toned)), (b'dimg', toned, (main, aux)),
                  (b'cdsc', exif, (main, toned)))
    properties = (box(b'hvcC', config), box(b'hvcC', depth_config), size_of(side),
                  size_of(2 * side),
                  full(b'auxC', 0, 0, b'urn:mpeg:hevc:2015:auxid:2\0', representation()))
    container(path, items, references, properties,
              [number for number, _, _, _ in items if number not in (main, toned)], main)


def tone_map(stops):
    """ISO 21496-1: one range of gains for all channels, 0 to so many stops, without offsets."""
    def fraction(value):
        return struct.pack('>II', value, 1)
    return struct.pack('>BHHB', 0, 0, 0, 0x40) + fraction(0) + fraction(stops) + (
        fraction(0) + fraction(stops) + fraction(1) + fraction(0) + fraction(0))


def with_gain_map(path, picture, gain, side, gain_side, metadata=None, xmp=None, quarters=0):
    """A photo and its gain map, files of one picture each. Metadata of a tone map say what the map
    means, or a packet beside an auxiliary image, as Samsung's phones write it. Both are turned by
    so many quarters anticlockwise."""
    (config, photo), (gain_config, gain_photo) = coded(picture), coded(gain)
    items = [(1, b'hvc1', photo, (0x81, 3, 0x86)),
             (2, b'hvc1', gain_photo, (0x82, 4, 0x85, 0x86) if xmp else (0x82, 4, 0x86))]
    references = []
    if metadata:
        items.append((3, b'tmap', metadata, (3,)))
        references.append((b'dimg', 3, (1, 2)))
    if xmp:
        items.append((4, b'mime', xmp, ()))
        references += [(b'auxl', 2, (1,)), (b'cdsc', 4, (2,))]
    properties = (box(b'hvcC', config), box(b'hvcC', gain_config), size_of(side),
                  size_of(gain_side),
                  full(b'auxC', 0, 0, b'urn:com:samsung:photo:2024:aux:hdrgainmap\0'),
                  box(b'irot', bytes((quarters,))))
    container(path, items, references, properties, (2, 4), inside=(b'tmap',))
