#!/usr/bin/env python3
"""usage: test_live_files.py REFOCUS  -- refocus live from files to files: what is damaged, ends or is in the way."""
import json
import os
import random
import signal
import struct
import subprocess
import time
import unittest

from living import REFOCUS, SLOW, SMALL, Live, content, live

PHOTO = bytes((x * 37 + y * 91 + x * y * 13) % 199 for y in range(48) for x in range(64))


def frame(n):
    """A frame of 64x48 in 4:2:0, each another one."""
    return b'FRAME\n' + bytes((v + 3 * n) % 220 + 16 for v in PHOTO) + bytes([128]) * (32 * 24 * 2)


def write(name, data):
    with open(name, 'wb') as file:
        file.write(data)


class Files(Live):
    def setUp(self):
        super().setUp()
        write('in.y4m', b'YUV4MPEG2 W64 H48 F30:1 C420jpeg\n' + b''.join(map(frame, range(10))))
        write('depth.pgm', b'P5\n64 48\n255\n' + bytes(range(0, 256, 4)) * 48)
        write('depth.y4m', b'YUV4MPEG2 W4 H1 F30:1 Cmono\n' + b'FRAME\nabcd' * 10)

    def test_inputs_are_not_written_over(self):
        for n in range(3):
            write('f-%03d.ppm' % n, b'P6\n64 48\n255\n' + bytes(64 * 48 * 3))
        write('map-1.ppm', b'P6\n64 48\n255\n' + bytes(64 * 48 * 3))
        os.symlink('in.y4m', 'link')
        video = ['--camera', 'y4m:in.y4m', '--depth', 'depth.pgm']
        pictures = ['--camera', 'file:f-%03d.ppm', '--depth', 'depth.pgm']
        before = {name: content(name) for name in os.listdir()}
        for args in (video + ['--out', 'y4m:in.y4m'], video + ['--out', 'raw:./in.y4m,NV12'],
                     video + ['--out', 'y4m:link'], video + ['--out', 'y4m:depth.pgm'],
                     video[:2] + ['--depth', 'y4m:depth.y4m', '--out', 'raw:depth.y4m'],
                     pictures + ['--out', 'f-%03d.ppm'],
                     video[:2] + ['--depth', 'map-1.ppm', '--out', 'map-%d.ppm'],
                     video + ['--focus-map', 'map-1.ppm', '--out', 'map-%d.ppm'],
                     video + ['--sharp-mask', 'map-1.ppm', '--out', 'map-%d.ppm'],
                     video + ['--aperture', 'map-1.ppm', '--out', 'map-%d.ppm'],
                     ['--camera', 'replay::from y4m:in.y4m', *video[2:], '--out', 'y4m:in.y4m']):
            self.fails(2, 'it is an input too and would be lost; give another name', *args)
        args = ['--camera', 'replay::size 64x48', '--depth', 'replay::format Z16;size 32x24']
        self.fails(2, 'it is an input too', *args, '--calibration', 'map-1.ppm', '--out', 'map-%d.ppm')
        self.assertEqual({name: content(name) for name in os.listdir()}, before)
        self.report(*pictures, '--out', 'f-%02d.ppm')
        self.assertTrue(os.path.exists('f-02.ppm'))

    def test_a_gap_in_a_sequence(self):
        for n in 0, 1, 3:
            write('f-%d.ppm' % n, b'P6\n64 48\n255\n' + bytes(64 * 48 * 3))
        self.fails(1, 'f-2.ppm is missing, and there is f-3.ppm', '--camera', 'file:f-%d.ppm',
                   '--depth', 'depth.pgm', '--out', 'o-%d.ppm')
        self.assertEqual([n for n in range(5) if os.path.exists('o-%d.ppm' % n)], [0, 1])

    def test_a_run_that_fails_is_reported(self):
        write('cut.y4m', content('in.y4m') + frame(10)[:3000])
        args = ['--depth', 'depth.pgm', '--out', 'y4m:out.y4m', '--json']
        done = live('--camera', 'y4m:cut.y4m', *args)
        self.assertEqual(done.returncode, 1)
        r = json.loads(done.stdout)
        self.assertEqual('refocus: %s\n' % r['error'], done.stderr.decode())
        self.assertEqual((r['frames_in'], r['frames_out']), (10, 10))
        self.assertNotIn('error', self.report('--camera', 'y4m:in.y4m', *args[:-1]))
        self.fails(1, 'it is not there', '--camera', 'y4m:none.y4m', *args)  # no frame: no report

    def test_a_focus_outside_of_the_picture(self):
        args = ['--depth', 'depth.pgm', '--out', 'y4m:out.y4m', '--focus-at']
        for at in '64,0', '0,48', '-1,5', 'inf,5':
            self.fails(2, '--focus-at: %s lies outside of the 64x48 pixels of the camera; give 0,0 to '
                       '63,47' % at, '--camera', 'y4m:in.y4m', *args, at)
            self.assertFalse(os.path.exists('out.y4m'))
        self.report('--camera', 'y4m:in.y4m', *args, '63,47')

    def test_a_stream_without_frames(self):
        header = b'YUV4MPEG2 W64 H48 F30:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n'
        write('none.y4m', content('in.y4m').split(b'FRAME')[0])
        args = ['--depth', 'depth.pgm', '--out', 'y4m:out.y4m']
        self.assertEqual(self.report('--camera', 'y4m:none.y4m', *args)['frames_out'], 0)
        self.assertEqual(content('out.y4m'), header)
        os.remove('out.y4m')
        # A signal before the first frame: of a camera the size is known, of a pipe it is not.
        os.mkfifo('pipe')
        for camera, out in ('replay::size 64x48;at 0 late 100000', header), ('y4m:pipe', None):
            run = subprocess.Popen([REFOCUS, 'live', *SMALL, '--no-commands', '--camera', camera, *args],
                                   stderr=subprocess.DEVNULL)
            time.sleep(0.5 * SLOW)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(60 * SLOW), 0)
            self.assertEqual(os.path.exists('out.y4m'), out is not None)
            if out:
                self.assertEqual(content('out.y4m'), out)
                os.remove('out.y4m')
        # A failure before the first frame leaves no file, and one that was there as it was.
        write('none.y4m', content('none.y4m') + b'FRAME\nabc')
        self.fails(1, 'it ends within frame 0', '--camera', 'y4m:none.y4m', *args)
        self.assertFalse(os.path.exists('out.y4m'))
        write('out.y4m', b'precious')
        self.fails(1, 'it ends within frame 0', '--camera', 'y4m:none.y4m', *args)
        self.assertEqual(content('out.y4m'), b'precious')

    def test_a_pipe_is_read_once(self):
        args = ['--depth', 'depth.pgm', '--out', 'y4m:out.y4m']
        for camera in 'y4m:-', 'raw:-,NV12,64x48':
            self.fails(2, 'a pipe has no beginning to go back to', '--camera', camera, *args, '--loop',
                       '--frames', '30', stdin=content('in.y4m'))
        self.fails(2, 'a pipe has no beginning to go back to', '--camera', 'y4m:in.y4m', '--depth',
                   'y4m:-', *args[2:], '--loop', '--frames', '30', stdin=content('depth.y4m'))
        with open('in.y4m', 'rb') as file:  # a file on standard input is none
            done = subprocess.run([REFOCUS, 'live', *SMALL, '--camera', 'y4m:-', *args, '--loop',
                                   '--frames', '30'], stdin=file, stderr=subprocess.DEVNULL)
        self.assertEqual((done.returncode, content('out.y4m').count(b'FRAME')), (0, 30))

    def test_names_are_said_once(self):
        for camera in 'y4m:none.y4m', 'raw:none.raw,NV12,64x48,30', 'y4m:depth.pgm':
            done = live('--camera', camera, '--depth', 'depth.pgm')
            self.assertTrue(done.stderr.decode().startswith('refocus: %s: it is not ' % camera))
        for out in 'y4m:none/o.y4m', 'raw:none/o.raw,NV12':
            self.fails(1, 'refocus: %s: it is not there' % out, '--camera', 'y4m:in.y4m', '--depth',
                       'depth.pgm', '--out', out)

    def test_no_depth_at_all(self):
        write('none.y4m', b'YUV4MPEG2 W4 H1 F30:1 Cmono\n')
        for more in [], ['--frames-policy', 'newest']:
            self.fails(1, 'y4m:none.y4m: it ended without a depth map', '--camera', 'y4m:in.y4m',
                       '--depth', 'y4m:none.y4m', '--out', 'y4m:out.y4m', *more)

    def test_samples_without_a_value(self):
        """65535 of distances does not become 65.5 m from map to map, nor what is said to hold no value."""
        def maps(*codes):
            flat = [2000] * 12 * 48 + [1000] * 20 * 48
            data = b''
            for code, count in codes:
                samples = flat[:1000] + [code] * count + flat[1000 + count:]
                data += b''.join(struct.pack('<H', v) for v in samples)
            write('depth.raw', data)
            r = self.report('--camera', 'y4m:in.y4m', '--depth', 'raw:depth.raw,Z16,48x32,30',
                            '--focus-at', '2,40', '--out', 'y4m:out.y4m', *more)
            return r['far_m'], content('out.y4m')
        more = []
        plain = maps(*[(1000, 0)] * 10)
        self.assertEqual(plain[0], 2)
        self.assertEqual(maps(*[(65535, 14), (65535, 17)] * 5), plain)  # 16 are a hundredth
        self.assertGreater(maps(*[(65535, 200)] * 10)[0], 60)
        for codes, code in ('max', 65535), ('zero,2047', 2047), (
                '65520,-1', 65520):
            more = ['--invalid', codes]
            self.assertEqual(maps(*[(code, 200)] * 10), plain)
        self.fails(2, "--invalid: 'most' is not known", '--camera', 'y4m:in.y4m', '--depth', 'depth.pgm',
                   '--invalid', 'most')

    def test_what_a_header_says_is_carried_on(self):
        video = content('in.y4m')
        write('in.y4m', video.replace(b'F30:1 C420jpeg', b'F30000:1001 Ip A128:117 C420mpeg2'))
        args = ['--camera', 'y4m:in.y4m', '--depth', 'depth.pgm', '--out', 'y4m:out.y4m']
        self.report(*args)
        self.assertEqual(content('out.y4m').split(b'\n')[0],
                         b'YUV4MPEG2 W64 H48 F30000:1001 Ip A128:117 C420mpeg2 XCOLORRANGE=LIMITED')
        self.report(*args, '--fps', '12.5')
        self.assertIn(b' F25:2 Ip A128:117', content('out.y4m')[:80])
        write('in.y4m', video.replace(b'C420jpeg', b'C420jpeg XCOLORRANGE=FULL'))
        self.report(*args)
        self.assertTrue(content('out.y4m').split(b'\n')[0].endswith(b' XCOLORRANGE=FULL'))

    def test_pictures_have_the_rate_of_the_other_source(self):
        """Picture n goes with frame n, whatever the rate of the film."""
        video, rates = content('in.y4m'), (b'F25:1', b'F60:1', b'F10:1', b'F24000:1001')
        for n in range(10):
            write('d-%d.pgm' % n, b'P5\n1 1\n255\n%c' % (25 * n))
            write('f-%d.pgm' % n, b'P5\n64 48\n255\n' + PHOTO[n:] + PHOTO[:n])
        write('depth.raw', b''.join(b'%c' % (25 * n) for n in range(10)))

        def run(camera, depth, *args):
            self.report('--camera', camera, '--depth', depth, '--focus', '0', '--out', 'y4m:out.y4m', *args)
            return content('out.y4m').split(b'FRAME\n', 1)

        pictures = 'y4m:in.y4m', 'file:d-%d.pgm'
        expected = run(*pictures)[1]
        write('mono.y4m', b'YUV4MPEG2 W1 H1 F30:1 Cmono\n' + b''.join(b'FRAME\n%c' % (25 * n) for n in range(10)))
        shown = run('file:f-%d.pgm', 'y4m:mono.y4m')[1]
        mono = content('mono.y4m')
        for rate in rates:
            write('in.y4m', video.replace(b'F30:1', rate))
            write('mono.y4m', mono.replace(b'F30:1', rate))
            for depth in 'file:d-%d.pgm', 'raw:depth.raw,GREY,1x1':
                self.assertEqual(run('y4m:in.y4m', depth)[1], expected, rate)
            header, frames = run('file:f-%d.pgm', 'y4m:mono.y4m')
            self.assertIn(b' %s ' % rate, header)
            self.assertEqual(frames, shown, rate)
        self.assertNotEqual(run('y4m:in.y4m', 'raw:depth.raw,GREY,1x1,30')[1], expected)  # it says so itself
        self.assertIn(b' F50:1 ', run(*pictures, '--fps', '50')[0])
        self.assertIn(b' F30:1 ', run('file:f-%d.pgm', 'file:d-%d.pgm')[0])
        write('in.y4m', video.replace(b'F30:1', b'F99999:1'))
        self.assertIn(b' F10000:1 ', run(*pictures)[0])

    def test_a_depth_picture_may_be_damaged_or_missing(self):
        for n in range(10):
            write('d-%d.pgm' % n, b'P5\n1 1\n255\n%c' % (25 * n))
        args = ['--camera', 'y4m:in.y4m', '--depth', 'file:d-%d.pgm', '--focus', '0', '--out', 'y4m:out.y4m', '--json']
        held = {3: 2, 5: 4, 9: 8}
        for n, last in held.items():
            write('d-%d.pgm' % n, content('d-%d.pgm' % last))
        self.report(*args)
        expected = content('out.y4m')
        write('d-5.pgm', b'P5\n1 1\n255\n')
        write('d-9.pgm', b'')
        os.remove('d-3.pgm')
        for _ in range(3):
            done = live(*args)
            self.assertEqual(done.returncode, 0)
            self.assertEqual(done.stderr.decode().splitlines(), [
                'refocus: file:d-%d.pgm: d-3.pgm is missing, and there is d-4.pgm; number them without a gap; '
                'the depth before it holds'])
            self.assertEqual(content('out.y4m'), expected)
            r = json.loads(done.stdout)
            self.assertEqual((r['depth']['corrupt'], r['paired'], r['unpaired']), (3, 7, 3))
        done = live(*args, '--frames-policy', 'newest')
        self.assertEqual(done.returncode, 0)
        write('d-0.pgm', b'')
        self.fails(1, 'd-0.pgm: ', *args)

    def test_the_matrix_of_streams_that_do_not_say_theirs(self):
        """Of HD it is that of BT.709, of less BT.601, as players take it; also in what is written."""
        y, u, v = 150, 90, 180
        for width, height, hd in (1278, 10, False), (1280, 10, True), (10, 576, False), (10, 578, True):
            kr, kb = (0.2126, 0.0722) if hd else (0.299, 0.114)
            luma, cb, cr = (y - 16) * 255 / 219, (u - 128) * 255 / 112, (v - 128) * 255 / 112
            red, blue = luma + cr * (1 - kr), luma + cb * (1 - kb)
            rgb = red, (luma - kr * red - kb * blue) / (1 - kr - kb), blue
            planes = [bytes([c]) * n for c, n in ((y, width * height), (u, width * height // 4), (v, width * height // 4))]
            write('in.y4m', b'YUV4MPEG2 W%d H%d F30:1 C420jpeg\nFRAME\n' % (width, height) + b''.join(planes))
            write('in.raw', b''.join(planes))
            for camera in 'y4m:in.y4m', 'raw:in.raw,YUV420,%dx%d' % (width, height):
                args = ['--camera', camera, '--depth', 'depth.pgm', '--out']
                shown = []
                for more in [], ['--matrix', 'bt709' if hd else 'bt601'], ['--matrix', 'bt601' if hd else 'bt709']:
                    self.report(*args, 'raw:out.rgb', *more)
                    shown.append(content('out.rgb'))
                self.assertTrue(all(abs(a - b) <= 1 for a, b in zip(shown[0][:3], rgb)), (shown[0][:3], rgb))
                self.assertEqual(shown[0], shown[1])
                self.assertTrue(any(abs(a - b) > 8 for a, b in zip(shown[0], shown[2])))
                # By way of R, G and B, too, colours go out as they came in.
                for out, more in ('y4m:out', []), ('y4m:out', ['--grain', '1']), ('raw:out,YUV420', ['--grain', '1']):
                    self.report(*args, out, *more)
                    codes = content('out').split(b'FRAME\n')[-1]
                    self.assertEqual(len(codes), width * height * 3 // 2)
                    self.assertTrue(all(abs(a - b) <= 1 for a, b in zip(codes, b''.join(planes))))

    def test_each_frame_has_grain_of_its_own(self):
        noise = random.Random(1)
        one = bytes(int(noise.gauss(110, 5)) for _ in range(96 * 80))
        write('in.y4m', b'YUV4MPEG2 W96 H80 F30:1 C420jpeg\n' + (b'FRAME\n' + one + bytes([128]) * 48 * 40 * 2) * 3)
        write('far.pgm', b'P5\n1 1\n255\n\0')

        def frames(*args):
            done = live('--camera', 'y4m:in.y4m', '--depth', 'far.pgm', '--focus', '1', '--grain', '1', '--out',
                        'raw:out.rgb', *args, common=['--blur', '10'])
            self.assertEqual(done.returncode, 0, done.stderr)
            out = content('out.rgb')
            return [out[i:i + 96 * 80 * 3] for i in range(0, len(out), 96 * 80 * 3)]
        grainy = frames('--seed', '5')
        self.assertEqual(len(set(grainy)), 3)
        self.assertEqual(frames('--seed', '5', '--threads', '3'), grainy)
        self.assertEqual([frames('--seed', str(5 + n), '--frames', '1')[0] for n in range(3)], grainy)

    def test_frames_before_a_fault_come_out(self):
        """Whichever of both is cut or damaged, and however far ahead it was read."""
        video, depth = content('in.y4m'), content('depth.y4m')
        size = len(frame(0))

        def run(words, whole, *args, code=1):
            for _ in range(3):
                self.fails(code, words, *args, '--out', 'y4m:out.y4m')
                out = content('out.y4m')
                self.assertEqual(out.count(b'FRAME\n'), whole)
                self.assertEqual(len(out) - out.index(b'FRAME'), whole * size)
        write('cut.y4m', video + frame(10)[:3000])
        run('refocus: y4m:cut.y4m: it ends within frame 10', 10, '--camera', 'y4m:cut.y4m', '--depth', 'depth.pgm')
        write('cut.y4m', video + b'FROM\n' + video)
        run('frame 10 does not begin with FRAME', 10, '--camera', 'y4m:cut.y4m', '--depth', 'depth.pgm')
        write('cut.y4m', depth[:-52])
        run('it ends within frame 4', 4, '--camera', 'y4m:in.y4m', '--depth', 'y4m:cut.y4m')
        write('cut.y4m', depth.replace(b'F30:1', b'F10:1')[:-72])  # the last whole one is at 0.1 s
        run('it ends within frame 2', 4, '--camera', 'y4m:in.y4m', '--depth', 'y4m:cut.y4m')
        write('cut.y4m', b'YUV4MPEG2 W4 H1 F30:1 Cmono\nFRAME\nab')
        self.fails(1, 'it ends within frame 0', '--camera', 'y4m:in.y4m', '--depth', 'y4m:cut.y4m',
                   '--out', 'y4m:out.y4m')
        for n in range(5):
            write('f-%d.ppm' % n, b'P6\n64 48\n255\n' + bytes(64 * 48 * 3 * (n < 4)))
        run('refocus: file:f-%d.ppm: f-4.ppm: ', 4, '--camera', 'file:f-%d.ppm', '--depth', 'depth.pgm')
        # As a camera would: what was taken is written, the newest alone if it has to be.
        write('cut.y4m', video + frame(10)[:3000])
        done = live('--camera', 'y4m:cut.y4m', '--depth', 'depth.pgm', '--frames-policy', 'newest',
                    '--out', 'y4m:out.y4m')
        self.assertEqual(done.returncode, 1)
        self.assertIn(b'FRAME', content('out.y4m'))


if __name__ == '__main__':
    unittest.main()
