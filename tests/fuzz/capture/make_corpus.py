#!/usr/bin/env python3
"""Writes the seeds of the targets of this folder and of ../cli into their corpora."""
import json
from pathlib import Path

HERE = Path(__file__).resolve().parent
FRAME = bytes(range(16)) + b'\x80' * 8


def write(folder, seeds):
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in seeds.items():
        (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def y4m(header, *frames):
    return b'YUV4MPEG2' + header + b'\n' + b''.join(b'FRAME\n' + f for f in frames)


def calibration(**changes):
    camera = {'width': 16, 'height': 12, 'fx': 15, 'fy': 15, 'cx': 7.5, 'cy': 5.5}
    return json.dumps({'depth': camera, 'colour': {**camera, 'width': 32, 'height': 24},
                       'rotation': [1, 0, 0, 0, 1, 0, 0, 0, 1],
                       'translation_m': [0.02, 0, 0], **changes})


def main():
    write(HERE / 'corpus' / 'y4m', {
        'two': y4m(b' W4 H4 F30:1 Ip A1:1 C420jpeg', FRAME, FRAME),
        'odd': y4m(b' W3 H3 F30000:1001', b'y' * 9 + b'uuuuvvvv'),
        'mono': y4m(b' W4 H2 F0:0 Cmono XCOLORRANGE=FULL', b'12345678'),
        'mono16': y4m(b' W2 H2 Cmono16', b'12345678'),
        'parameters': b'YUV4MPEG2 W4 H4\nFRAME Ip Xwhat\n' + FRAME,
        'cut': y4m(b' W4 H4', FRAME, FRAME[:7]),
        'no_frame': y4m(b' W4 H4', FRAME) + b'FRANE\n' + FRAME,
        'large': y4m(b' W65536 H4'),
        'negative': y4m(b' W-4 H4 F-1:-1'),
        'other': y4m(b' W4 H4 C444', FRAME * 2),
        'long': y4m(b' X' + b'x' * 1100 + b' W4 H4', FRAME),
    })
    write(HERE / 'corpus' / 'raw', {
        'nv12': b'NV12,4x4,30\n' + FRAME * 2,
        'yuyv': b'yuyv,4x2\n' + FRAME,
        'rgb': b'RGB24,4x2\n' + FRAME * 3,
        'commas': b'a,b,UYVY,2x2,12.5\n' + FRAME,
        'grey': b'GREY,5x3,0.001\n' + FRAME,
        'z16': b'Z16,3x2\n' + FRAME,
        'no_rate': b'NV21,4x4,0\n' + FRAME,
        'mjpeg': b'MJPEG,4x4\n' + FRAME,
        'large': b'RGBX,65535x65535\n',
        'empty': b'BGR24,1x1\n',
    })
    write(HERE / 'corpus' / 'script', {
        'every_fault': 'size 16x8;fps 50;frames 100;seed 3;sequence 4294967290\n'
                       'at 1 drop 2; at 4 corrupt; at 5 late 1; at 6 timestamp -500\n'
                       'at 7 stall 1; at 8 fail; at 9 vanish 1; at 10 queue-error\n'
                       'at 11 stride 99; at 12 format YUYV,32x20; at 13 memory',
        'random': 'size 8x8;random 50;seed 9;frames 24',
        'errors': 'start-errors 2;size 1x1;frames 3;at 2 drop 5',
        'depth': 'format Z16;size 7x5 # of a sensor\n\n; ;at 3 format Y16,9x3',
        'lost': 'size 8x8;' + ';'.join('at %d queue-error' % n for n in range(8)),
        'strides': 'size 9x9;stride 64;at 1 stride 3',
        'from': 'from y4m:none.y4m;jpeg none.jpg',
        'itself': 'from replay::from replay:x',
        'wrong': 'size 0x4',
        'many': ';'.join('at %d corrupt' % n for n in range(300)),
    })
    write(HERE / 'corpus' / 'pattern', {
        'four': 'frames-%04d.png', 'blank': 'f%3d', 'none': 'photo.jpg', 'twenty': '%020d',
        'many': '%021d', 'text': '%s', 'two': '%d-%d', 'percent': '%%d', 'long': 'x' * 250 + '%d',
        'overflow': '%99999999999999999999d', 'negative': '%-4d',
    })
    cli = HERE.parent / 'cli' / 'corpus'
    write(cli / 'commands', {
        'all': 'focus 0.5\nfocus-at 320,240\npull 0.9 2\npull-at 3,4 1\nblur 7\nquit\n',
        'wrong': 'focus 7\nfly\nblur 99\nfocus-at 1\npull 1 2 3\nblur nan\nfocus -0\n',
        'blanks': ' \t focus\t0.25\r\n\n\r\nblur  3 \npull 0.5  2\n',
        'numbers': 'focus 1e-320\npull 0x1p-1 inf\npull-at 1e308,-1e308 3600\nfocus-at nan,1\n',
        'long': 'x' * 300 + '\nblur 1' + '0' * 400 + '\nfocus 1\n',
        'bytes': bytes(range(256)) + b'\nfocus 0\0.5\n',
        'no_end': 'focus 0.5',
    })
    write(cli / 'calibration', {
        'sound': calibration(),
        'turned': calibration(rotation=[0, -1, 0, 1, 0, 0, 0, 0, 1]),
        'behind': calibration(translation_m=[0, 0, -1e300]),
        'scaled': calibration(rotation=[2, 0, 0, 0, 1, 0, 0, 0, 1]),
        'short': calibration(rotation=[1, 0, 0]),
        'words': calibration(translation_m=['a', None, True]),
        'tiny': calibration(colour={'width': 1, 'height': 1, 'fx': 1e-300, 'fy': 1e300, 'cx': 0,
                                    'cy': -1e308}),
        'large': calibration(depth={'width': 1 << 40, 'height': -1, 'fx': 0, 'fy': 0, 'cx': 0,
                                    'cy': 0}),
        'array': '[1, 2]', 'cut': calibration()[:60], 'empty': '',
    })


if __name__ == '__main__':
    main()
