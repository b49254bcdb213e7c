#!/usr/bin/env python3
"""usage: test_live.py REFOCUS  -- cameras of PipeWire in, a camera of PipeWire out."""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import session

REFOCUS = None
SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))
WIDTH, HEIGHT, FRAMES = 64, 48, 12
BYTES = {'NV12': 3 / 2, 'YUV420': 3 / 2, 'YUYV': 2, 'RGB24': 3, 'BGRX': 4}
GST = {'NV12': 'NV12', 'YUV420': 'I420', 'YUYV': 'YUY2', 'RGB24': 'RGB', 'BGRX': 'BGRx'}
SHARP = ['--depth', 'depth.pgm', '--blur', '0']
BLURRED = ['--depth', 'depth.pgm', '--blur', '3', '--rays', '4', '--focus', '0']
have_gst = shutil.which('gst-launch-1.0') and subprocess.run(
    ['gst-inspect-1.0', 'pipewiresrc'], capture_output=True, check=False).returncode == 0


def content(name):
    with open(name, 'rb') as file:
        return file.read()


def cut(data, form, width=WIDTH, height=HEIGHT):
    size = int(width * height * BYTES[form])
    return [data[i:i + size] for i in range(0, len(data) - size + 1, size)]


class Pipewire(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        os.chdir(self.folder.name)
        self.started = []
        self.session = session.Session(SLOW)
        with open('depth.pgm', 'wb') as depth:
            depth.write(b'P5\n4 4\n255\n' + bytes(16 * i for i in range(16)))

    def tearDown(self):
        for process in self.started:
            process.kill()
            process.communicate()
        self.session.close()
        os.chdir('/')
        self.folder.cleanup()

    def start(self, *args):
        process = subprocess.Popen(
            [REFOCUS, 'live', '--json', *args], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE)
        self.started.append(process)
        return process

    def end(self, process, code=0):
        """Its report, or its one line."""
        out, err = process.communicate(timeout=60 * SLOW)
        self.started.remove(process)
        self.assertEqual(process.returncode, code, err)
        if code == 0:
            self.assertEqual(err, b'')
            return json.loads(out)
        lines = err.decode().splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertRegex(lines[0], r'^refocus: .+: .+')
        return lines[0]

    def live(self, *args):
        return self.end(self.start(*args))

    def stop(self, process):
        """The report after SIGTERM, which is obeyed at once."""
        begin = time.monotonic()
        process.send_signal(signal.SIGTERM)
        report = self.end(process)
        self.assertLess(time.monotonic() - begin, 0.2 if SLOW == 1 else 5)
        return report

    def make_frames(self, form):
        """A file of different frames, and what `refocus live` makes of them."""
        self.live('--camera', 'replay::format %s;size %dx%d;frames %d' % (
            form, WIDTH, HEIGHT, FRAMES), *SHARP, '--fast', '--frames-policy', 'every', '--out',
                  'raw:in.raw,own')
        self.live('--camera', 'raw:in.raw,%s,%dx%d,30' % (form, WIDTH, HEIGHT), *BLURRED, '--out',
                  'raw:out.raw,own')
        frames = cut(content('in.raw'), form), cut(content('out.raw'), form)
        self.assertEqual([len(set(f)) for f in frames], [FRAMES, FRAMES])
        return frames

    def camera(self, form, *more, out='pipewire:test', look=None):
        """A camera that shows the frames of the file again and again."""
        process = self.start('--camera', 'raw:in.raw,%s,%dx%d,30' % (form, WIDTH, HEIGHT), '--loop',
                             *(look or SHARP), '--out', out, *more)
        self.session.wait_node(out[len('pipewire:'):] or 'Refocused camera')
        return process

    def check_order(self, frames, expected, least=6):
        """They are some of the expected ones, bit for bit, one after the other."""
        self.assertGreaterEqual(len(frames), least)
        numbers = [expected.index(f) for f in frames]
        steps = [(b - a) % len(expected) for a, b in zip(numbers, numbers[1:])]
        self.assertGreater(min(steps), 0, numbers)
        self.assertGreaterEqual(len(set(numbers)), least, numbers)

    def test_in_and_out_are_the_bytes_of_files(self):
        for form in 'NV12', 'YUYV', 'YUV420', 'RGB24':
            with self.subTest(form):
                sharp, blurred = self.make_frames(form)
                source = self.camera(form)
                middle = self.start('--camera', 'pipewire:test', *BLURRED, '--out', 'pipewire:')
                node = self.session.wait_node('Refocused camera')
                self.assertEqual([node[k] for k in ('media.class', 'media.role', 'node.description')],
                                 ['Video/Source', 'Camera', 'Refocused camera'])
                r = self.live('--camera', 'pipewire:Refocused camera', '--format', form, *SHARP,
                              '--frames', '8', '--frames-policy', 'every', '--out', 'raw:end.raw,own')
                self.assertEqual([r[k] for k in ('format', 'width', 'height', 'frames_out')],
                                 [form, WIDTH, HEIGHT, 8])
                self.check_order(cut(content('end.raw'), form), blurred)
                r = self.stop(middle)
                self.assertEqual((r['rendered_in'], r['format']), (form, form))
                self.stop(source)
                self.assertNotEqual(sharp, blurred)

    @unittest.skipUnless(have_gst, 'GStreamer has no pipewiresrc')
    def test_gstreamer_sees_the_camera(self):
        for form, seen in ('NV12', 'NV12'), ('NV12', 'YUV420'), ('YUYV', 'YUYV'), ('RGB24', 'BGRX'):
            with self.subTest(form + ' as ' + seen):
                _, blurred = self.make_frames(form)
                if seen != form:  # the same pictures in another order of bytes
                    self.live('--camera', 'raw:in.raw,%s,%dx%d,30' % (form, WIDTH, HEIGHT),
                              *BLURRED, '--out', 'raw:seen.raw,' + seen)
                    blurred = cut(content('seen.raw'), seen)
                source = self.camera(form, look=BLURRED)
                subprocess.run(
                    ['gst-launch-1.0', '-q', 'pipewiresrc',
                     'path=%d' % self.session.nodes()['test']['id'], 'num-buffers=10', '!',
                     'video/x-raw,format=' + GST[seen], '!', 'filesink', 'location=gst.raw'],
                    check=True, timeout=30 * SLOW, stdout=subprocess.DEVNULL)
                self.check_order(cut(content('gst.raw'), seen), blurred)
                self.stop(source)

    @unittest.skipUnless(have_gst, 'GStreamer has no pipewiresink')
    def test_a_camera_of_gstreamer(self):
        made = ['videotestsrc', 'pattern=ball', 'num-buffers=300']
        caps = 'video/x-raw,format=NV12,width=%d,height=%d,framerate=30/1' % (WIDTH, HEIGHT)
        subprocess.run(['gst-launch-1.0', '-q', *made, '!', caps, '!', 'filesink',
                        'location=ball.raw'], check=True, timeout=30 * SLOW)
        camera = subprocess.Popen(
            ['gst-launch-1.0', '-q', *made, 'is-live=true', '!', caps, '!', 'pipewiresink',
             'mode=provide', 'stream-properties=p,media.class=Video/Source,node.name=ball'])
        self.started.append(camera)
        self.session.wait_node('ball')
        r = self.live('--camera', 'pipewire:ball', *SHARP, '--frames', '8', '--frames-policy',
                      'every', '--out', 'raw:end.raw,own')
        self.assertEqual((r['format'], r['frames_out'], r['colour']['corrupt']), ('NV12', 8, 0))
        expected = set(cut(content('ball.raw'), 'NV12'))
        frames = cut(content('end.raw'), 'NV12')
        self.assertGreater(len(set(frames)), 4)
        self.assertLessEqual(set(frames), expected)

    @unittest.skipUnless(have_gst, 'GStreamer has no pipewiresink')
    def test_depth_of_grey_of_16_bits(self):
        """A depth camera of GRAY16 beside the camera: the picture is that of the same depth in a file."""
        made = ['gst-launch-1.0', '-q', 'videotestsrc', 'pattern=smpte75']
        then = ['!', 'video/x-raw,format=GRAY16_LE,width=%d,height=%d,framerate=30/1' % (WIDTH, HEIGHT), '!']
        self.make_frames('NV12')
        subprocess.run([*made, 'num-buffers=1', *then, 'filesink', 'location=depth.raw'], check=True,
                       timeout=30 * SLOW)
        little = content('depth.raw')
        with open('same.pgm', 'wb') as depth:
            depth.write(b'P5\n%d %d\n65535\n' % (WIDTH, HEIGHT) +
                        bytes(little[i ^ 1] for i in range(len(little))))
        look = ['--depth-unit', 'disparity', *BLURRED[2:]]
        self.live('--camera', 'raw:in.raw,NV12,%dx%d,30' % (WIDTH, HEIGHT), '--depth', 'same.pgm', *look,
                  '--out', 'raw:expected.raw,own')
        source = self.camera('NV12')
        self.started.append(subprocess.Popen(
            [*made, 'is-live=true', *then, 'pipewiresink', 'mode=provide',
             'stream-properties=p,media.class=Video/Source,node.name=depth']))
        self.session.wait_node('depth')
        r = self.live('--camera', 'pipewire:test', '--depth', 'pipewire:depth', *look, '--frames', '8', '--out',
                      'raw:end.raw,own')
        self.assertEqual((r['format'], r['frames_out']), ('NV12', 8))
        self.check_order(cut(content('end.raw'), 'NV12'), cut(content('expected.raw'), 'NV12'), 4)
        self.stop(source)

    def test_nobody_has_to_look(self):
        self.make_frames('NV12')
        r = self.live('--camera', 'raw:in.raw,NV12,%dx%d,30' % (WIDTH, HEIGHT), '--loop', *SHARP,
                      '--frames', '30', '--out', 'pipewire:test')
        self.assertEqual((r['frames_out'], r['sink_dropped']), (30, 0))

    def test_who_looks_may_leave_and_come(self):
        sharp, _ = self.make_frames('NV12')
        source = self.camera('NV12')
        for _ in range(12):  # more often than there are buffers
            self.live('--camera', 'pipewire:test', *SHARP, '--frames', '8', '--out', 'raw:end.raw,own')
            self.check_order(cut(content('end.raw'), 'NV12'), sharp)
        watcher = self.start('--camera', 'pipewire:test', *SHARP, '--out', 'null')
        self.session.wait_node('test', 'running')
        watcher.kill()
        both = [self.start('--camera', 'pipewire:test', *SHARP, '--frames', '8', '--out',
                           'raw:%d.raw,own' % i) for i in range(2)]
        for i, process in enumerate(both):
            self.end(process)
            self.check_order(cut(content('%d.raw' % i), 'NV12'), sharp)
        stays = self.start('--camera', 'pipewire:test', *SHARP, '--out', 'null')
        for _ in range(12):
            self.live('--camera', 'pipewire:test', *SHARP, '--frames', '2', '--out', 'null')
        r = self.stop(stays)
        self.assertEqual((r['colour']['recoveries'], r['colour']['timeouts']), (0, 0))
        self.assertEqual(self.stop(source)['sink_recoveries'], 0)

    def test_the_size_may_change(self):
        source = self.start('--camera', 'replay::format NV12;size 64x48;at 60 format NV12,32x24',
                            *SHARP, '--out', 'pipewire:test')
        self.session.wait_node('test')
        watcher = self.start('--camera', 'pipewire:test', *SHARP, '--out', 'f-%d.ppm', '--frames', '90')
        r = self.end(watcher)
        self.assertEqual((r['frames_out'], r['colour']['recoveries']), (90, 0))
        sizes = [content('f-%d.ppm' % i)[3:8] for i in range(90)]
        self.assertEqual(sizes, sorted(sizes, reverse=True))
        self.assertEqual(set(sizes), {b'64 48', b'32 24'})
        self.stop(source)

    def test_a_camera_that_goes_and_comes(self):
        self.make_frames('NV12')
        source = self.camera('NV12')
        watcher = self.start('--camera', 'pipewire:test', *SHARP, '--out', 'null')
        self.session.wait_node('test', 'running')
        source.kill()
        self.session.wait_end('test')
        source = self.camera('NV12')
        self.session.wait_node('test', 'running')
        time.sleep(0.3 * SLOW)
        self.assertEqual(self.stop(watcher)['colour']['recoveries'], 1)
        watcher = self.start('--camera', 'pipewire:test', '--patience', '0.5', *SHARP, '--out', 'null')
        self.session.wait_node('test', 'running')
        source.kill()
        self.assertIn("PipeWire has no node 'test' that gives video", self.end(watcher, 1))

    def test_the_daemon_goes_and_comes(self):
        self.make_frames('NV12')
        source = self.camera('NV12')
        self.session.close()
        self.session = session.Session(SLOW)
        self.session.wait_node('test')
        self.assertEqual(self.stop(source)['sink_recoveries'], 1)
        source = self.camera('NV12', '--patience', '0.3')
        self.session.close()
        self.assertIn('no PipeWire runs for this user', self.end(source, 1))

    def test_a_daemon_that_is_stopped(self):
        self.session.daemon.send_signal(signal.SIGSTOP)
        watcher = self.start('--camera', 'pipewire:', *SHARP, '--out', 'null')
        self.assertIn('PipeWire does not answer', self.end(watcher, 1))
        watcher = self.start('--camera', 'pipewire:', *SHARP, '--out', 'null')
        time.sleep(0.3 * SLOW)
        self.stop(watcher)
        camera = self.start('--camera', 'replay::size 64x48', *SHARP, '--out', 'pipewire:')
        time.sleep(0.5 * SLOW)
        self.assertGreater(self.stop(camera)['frames_out'], 0)

    def test_what_is_refused(self):
        def fails(words, *args):
            self.assertIn(words, self.end(self.start(*SHARP, *args), 1))

        self.make_frames('NV12')
        fails("PipeWire has no node 'none' that gives video", '--camera', 'pipewire:none')
        source = self.camera('NV12')
        fails('the node has no RGB24', '--camera', 'pipewire:test', '--format', 'RGB24')
        listed = subprocess.run([REFOCUS, 'live', '--list'], capture_output=True, check=True).stdout
        self.assertIn(b'pipewire:test', listed)
        if listed.count(b'pipewire:') == 1:  # the command's own camera is none to begin with
            fails('PipeWire has no camera', '--camera', 'pipewire:')
        self.stop(source)
        self.session.close()
        fails('no PipeWire runs for this user', '--camera', 'pipewire:')
        fails('no PipeWire runs for this user', '--camera', 'replay::size 64x48', '--out', 'pipewire:')


if __name__ == '__main__':
    session.enter()
    REFOCUS = os.path.abspath(sys.argv.pop(1))
    unittest.main()
