"""Photos of kinds that the command reads and does not write, put together byte by byte."""
import struct


def _bits(parts):
    """Bytes of (value, length) pairs, as a JPEG has them in a scan."""
    text = ''.join(format(value, '0%db' % length) if length else '' for value, length in parts)
    text += '1' * (-len(text) % 8)
    packed = bytes(int(text[i:i + 8], 2) for i in range(0, len(text), 8))
    return packed.replace(b'\xff', b'\xff\0')


def cmyk_jpeg(name, width, height, pixel, black=0, adobe=True):
    """A JPEG of CMYK, flat in blocks of 8 x 8; pixel(x, y) is R, G, B, over which black lies. Adobe
    stores what the inks leave, and says so."""
    # The code of each category of DC, by annex K.3 of ITU-T T.81, and one for the end of a block.
    lengths, codes, code = (0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0), [], 0
    for length, count in enumerate(lengths, 1):
        for _ in range(count):
            codes.append((code, length))
            code += 1
        code <<= 1
    parts, last = [], [0] * 4
    for y in range(0, height, 8):
        for x in range(0, width, 8):
            for c, value in enumerate(tuple(pixel(x, y)) + (255 - black,)):
                value = value if adobe else 255 - value
                step = value - 128 - last[c]
                last[c] += step
                size = abs(step).bit_length()
                parts += [codes[size], (step if step > 0 else step + (1 << size) - 1, size), (0, 1)]

    def segment(marker, payload):
        return struct.pack('>BBH', 0xff, marker, len(payload) + 2) + payload
    with open(name, 'wb') as file:
        file.write(
            b'\xff\xd8' + (segment(0xee, b'Adobe\0\x64\0\0\0\0\0') if adobe else b'') +
            segment(0xdb, b'\0' + b'\x08' * 64) +
            segment(0xc0, struct.pack('>BHHB', 8, height, width, 4) +
                    b''.join(bytes((c, 0x11, 0)) for c in range(1, 5))) +
            segment(0xc4, b'\0' + bytes(lengths) + bytes(range(12))) +
            segment(0xc4, b'\x10\1' + bytes(15) + b'\0') +
            segment(0xda, b'\4' + b''.join(bytes((c, 0)) for c in range(1, 5)) + b'\0\x3f\0') +
            _bits(parts) + b'\xff\xd9')
    return name


def dng(name, width, height, pixel, preview=b''):
    """A camera raw of 16 bits: one sensor of red, green, green and blue, whose colours are those
    of sRGB's primaries; a JPEG may lie behind, where readers without a raw converter find it."""
    matrix = (32405, -15371, -4985, -9693, 18760, 416, 556, -2040, 10572)
    samples = b''.join(struct.pack('<H', int(65535 * (pixel(x, y)[(x & 1) + (y & 1)] / 255) ** 2.2))
                       for y in range(height) for x in range(width))
    at = 8 + len(samples)
    values = struct.pack('<18i', *(v for m in matrix for v in (m, 10000))) + b'Model X\0'
    entries = [(254, 4, 1, 0), (256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 16),
               (259, 3, 1, 1), (262, 3, 1, 32803), (273, 4, 1, 8), (274, 3, 1, 1), (277, 3, 1, 1),
               (278, 4, 1, height), (279, 4, 1, len(samples)), (33421, 3, 2, 2 | 2 << 16),
               (33422, 1, 4, 1 << 8 | 1 << 16 | 2 << 24), (50706, 1, 4, 1 | 4 << 8),
               (50708, 2, 8, at + 72), (50721, 10, 9, at)]
    with open(name, 'wb') as file:
        file.write(b'II*\0' + struct.pack('<I', at + len(values)) + samples + values +
                   struct.pack('<H', len(entries)) +
                   b''.join(struct.pack('<HHII', *entry) for entry in entries) + bytes(4) + preview)
    return name
