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


def phone(path, picture, depth, side, model):
    """A picture and its depth, each a grid of 2 x 2 tiles of side x side pixels: files of one such
    tile. EXIF describes the picture, and what a gain map makes of it, as iPhones say since iOS 18;
    here the map is the depth."""
    (config, tile), (depth_config, depth_tile) = coded(picture), coded(depth)
    grid = struct.pack('>BBBBHH', 0, 0, 1, 1, 2 * side, 2 * side)
    main, aux, toned, exif = 9, 10, 11, 12
    items = [(i, b'hvc1', tile, (0x81, 3)) for i in range(1, 5)]
    items += [(i, b'hvc1', depth_tile, (0x82, 3)) for i in range(5, 9)]
    items += [(main, b'grid', grid, (4,)), (aux, b'grid', grid, (4, 0x85)),
              (toned, b'tmap', b'\0' * 62, (4,)),
              (exif, b'Exif', struct.pack('>I', 0) + tiff(model), ())]
    information = b''.join(full(b'infe', 2, number not in (main, toned), struct.pack(
        '>HH4sx', number, 0, kind)) for number, kind, _, _ in items)
    references = b''.join(box(kind, struct.pack('>HH%dH' % len(to), number, len(to), *to))
                          for kind, number, to in (
        (b'dimg', main, range(1, 5)), (b'dimg', aux, range(5, 9)), (b'auxl', aux, (main,)),
        (b'dimg', toned, (main, aux)), (b'cdsc', exif, (main, toned))))
    properties = box(b'ipco', box(b'hvcC', config), box(b'hvcC', depth_config),
                     full(b'ispe', 0, 0, struct.pack('>II', side, side)),
                     full(b'ispe', 0, 0, struct.pack('>II', 2 * side, 2 * side)),
                     full(b'auxC', 0, 0, b'urn:mpeg:hevc:2015:auxid:2\0', representation()))
    owners = [(number, own) for number, _, _, own in items if own]
    associations = full(b'ipma', 0, 0, struct.pack('>I', len(owners)), *(
        struct.pack('>HB%dB' % len(own), number, len(own), *own) for number, own in owners))

    def header(offset):
        places = b''
        for number, _, data, _ in items:
            places += struct.pack('>HHHII', number, 0, 1, offset, len(data))
            offset += len(data)
        return box(b'ftyp', b'heic\0\0\0\0mif1heic') + full(
            b'meta', 0, 0, full(b'hdlr', 0, 0, b'\0\0\0\0pict' + bytes(13)),
            full(b'pitm', 0, 0, struct.pack('>H', main)),
            full(b'iinf', 0, 0, struct.pack('>H', len(items)), information),
            full(b'iref', 0, 0, references), box(b'iprp', properties, associations),
            full(b'iloc', 0, 0, struct.pack('>BBH', 0x44, 0, len(items)), places))
    with open(path, 'wb') as file:
        file.write(header(len(header(0)) + 8) + box(b'mdat', *(data for _, _, data, _ in items)))
