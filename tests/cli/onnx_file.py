"""A network that tests can run: an ONNX file, written field by field."""
import struct


def field(number, value):
    """A field of a protobuf message: a number, or bytes."""
    def varint(n):
        return bytes([n & 127 | 128]) + varint(n >> 7) if n > 127 else bytes([n])
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def network():
    """An ONNX file of a network for pictures of 320x192: y = R, by a 1 x 1 convolution."""
    def info(name, channels):
        shape = b''.join(field(1, field(1, n)) for n in (1, channels, 192, 320))
        return field(1, name) + field(2, field(1, field(1, 1) + field(2, shape)))
    kernel = field(1, b'kernel_shape') + field(8, 1) + field(8, 1) + field(20, 7)
    node = (field(1, b'x') + field(1, b'w') + field(2, b'y') + field(3, b'c') +
            field(4, b'Conv') + field(5, kernel))
    weights = (field(1, 1) + field(1, 3) + field(1, 1) + field(1, 1) + field(2, 1) +
               field(8, b'w') + field(9, struct.pack('<3f', 1, 0, 0)))
    graph = (field(1, node) + field(2, b'g') + field(5, weights) + field(11, info(b'x', 3)) +
             field(12, info(b'y', 1)))
    return field(1, 6) + field(7, graph) + field(8, field(2, 11))
