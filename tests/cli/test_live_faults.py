#!/usr/bin/env python3
"""usage: test_live_faults.py REFOCUS  -- refocus live when cameras, depth or readers fail, and its commands."""
import json
import os
import shutil
import signal
import socket
import stat
import subprocess
import time
import unittest

from living import DEPTH, REFOCUS, SLOW, SMALL, Live, content, live
from onnx_file import network


class Faults(Live):
    def test_faults_are_recovered_from(self):
        script = ('replay::size 64x48;fps 50;frames 100;at 10 fail;at 20 vanish 300;at 30 corrupt;'
                  'at 35 drop 3;at 40 timestamp -200;at 50 queue-error;at 60 stride 99;at 70 late 30')
        # As fast as can be, nothing hangs on the clock: 100 frames but for 3 that do not come,
        # and 2 that went with a fault of the stream.
        r = self.report('--camera', script, '--depth', DEPTH, '--fast', '--frames-policy', 'every')
        self.assertEqual((r['frames_in'], r['camera_dropped'], r['dropped']), (95, 3, 0))
        self.assertEqual((r['colour']['recoveries'], r['colour']['corrupt'],
                          r['colour']['reordered'], r['frames_out']), (2, 1, 1, 94))
        self.assertEqual(r['buffers_lost'], 1)
        self.check_sum(r)
        # At the camera's pace: how many are dropped depends on the machine, what is counted not.
        r = self.report('--camera', script, '--depth', DEPTH)
        self.assertEqual(r['colour']['recoveries'], 2)
        self.assertLess(r['colour']['worst_recovery_ms'], 300 + 1000 * SLOW)
        self.assertGreater(r['frames_out'], 0)
        self.check_sum(r)

    def test_a_time_that_is_far_off_costs_no_frame(self):
        fast = ['--fast', '--frames-policy', 'every']
        for ms in 100000, -100000:
            fault = ';at 15 timestamp %d' % ms
            for fps, more in (30, fast), (10, ['--frames-policy', 'every']), (10, []):
                r = self.report('--camera', 'replay::size 64x48;fps %d;frames 20%s' % (fps, fault),
                                '--depth', DEPTH.replace('30', str(fps)), *more)
                self.check_sum(r)
                if more:  # the newest of a camera: a slow machine may leave out some
                    self.assertEqual((r['frames_out'], r['paired']), (20, 20), more)
                self.assertEqual((r['colour']['retimed'], r['colour']['damaged']), (1, 0))
            # One of the depth, after two that did not come: its frame still has it.
            r = self.report('--camera', 'replay::size 64x48;frames 60', '--depth',
                            DEPTH + ';at 13 drop 2' + fault, *fast)
            self.assertEqual((r['frames_out'], r['paired'], r['depth']['retimed']), (60, 58, 1))
        # The first of a camera that keeps our time: there is no frame before it.
        r = self.report('--camera', 'replay::size 64x48;fps 10;frames 5;at 0 timestamp 100000',
                        '--depth', DEPTH.replace('30', '10'), '--frames-policy', 'every')
        self.assertEqual((r['frames_out'], r['paired'], r['colour']['retimed']), (5, 5, 1))
        # All from there on: the camera's clock was set, and its frames go on.
        r = self.report('--camera', 'replay::size 64x48;frames 60;' +
                        ';'.join('at %d timestamp 100000' % n for n in range(15, 60)), '--depth',
                        DEPTH, *fast)
        self.assertEqual((r['frames_out'], r['paired'], r['colour']['retimed']), (60, 60, 1))

    def test_depth_may_be_late_vanish_and_end(self):
        depth = ('replay::format Y16;size 32x24;fps 30;frames 40;at 10 vanish 400;'
                 'at 20 late 80')
        r = self.report('--camera', 'replay::size 64x48;fps 30;frames 60', '--depth', depth,
                        '--fast', '--frames-policy', 'every')
        # Depth 10 went with the device, and depth ends with the 40th.
        self.assertEqual((r['frames_out'], r['paired'], r['unpaired']), (60, 39, 21))
        self.assertEqual(r['depth']['recoveries'], 1)
        self.check_sum(r)
        r = self.report('--camera', 'replay::size 64x48;fps 30;frames 60', '--depth', depth)
        self.assertEqual(r['depth']['recoveries'], 1)
        self.assertGreater(r['unpaired'], 0)
        self.check_sum(r)
        # No frame waits for a map that will not be there in time, or not at all.
        late = DEPTH + ''.join(';at %d timestamp -100' % n for n in range(70))
        for depth in late, DEPTH.replace('30', '5'):
            r = self.report('--camera', 'replay::size 64x48;fps 30;frames 60', '--depth', depth)
            self.assertLess(r['stages_ms']['pair']['median'], 15)
            self.check_sum(r)

    @unittest.skipUnless('RF_OPENCV' in os.environ, 'this build has no OpenCV')
    def test_a_network_makes_depth_of_every_nth_frame(self):
        with open('red.onnx', 'wb') as file:
            file.write(network())
        with open('photo.ppm', 'wb') as photo:  # red on the right: near
            photo.write(b'P6\n64 48\n255\n' +
                        (bytes([40, 90, 30]) * 32 + bytes([230, 90, 30]) * 32) * 48)
        args = ['--camera', 'replay::from file:photo.ppm;frames 30', '--focus', '1', '--blur', '6']
        for every, runs in (1, 30), (7, 5):
            r = self.report(*args, '--depth', 'estimate:red.onnx,every=%d' % every, '--fast',
                            '--frames-policy', 'every', '--out', 'raw:out.rgb')
            self.assertEqual((r['frames_in'], r['frames_out'], r['paired']), (30, 30, 30))
            self.assertEqual(r['depth']['frames'], runs)
            data = content('out.rgb')
            self.assertEqual(data, data[:64 * 48 * 3] * 30)
        # The far half is out of focus, the near one is not: by the depth that was made.
        with open('depth.pgm', 'wb') as depth:
            depth.write(b'P5\n2 1\n255\n\x00\xff')
        self.report(*args, '--depth', 'depth.pgm', '--fast', '--frames-policy', 'every', '--out',
                    'raw:fixed.rgb')
        fixed = content('fixed.rgb')[:64 * 48 * 3]
        far = [abs(a - b) for y in range(48) for a, b in
               zip(data[y * 192:y * 192 + 60], fixed[y * 192:y * 192 + 60])]
        self.assertLess(max(far), 3)
        # Y, U and V stay as they are; what the network sees of them is the same picture.
        with open('photo.y4m', 'wb') as video:
            video.write(b'YUV4MPEG2 W64 H48 F30:1 C420jpeg\n')
            for _ in range(30):
                video.write(b'FRAME\n' +
                            (bytes([60, 60, 100, 100]) * 8 + bytes([100, 100, 140, 140]) * 8) * 48 +
                            (bytes([100]) * 16 + bytes([80]) * 16) * 24 +
                            (bytes([110]) * 16 + bytes([200]) * 16) * 24)
        r = self.report('--camera', 'y4m:photo.y4m', *args[2:], '--depth', 'estimate:red.onnx',
                        '--fast', '--frames-policy', 'every', '--sigma', '400', '--out',
                        'y4m:out.y4m')
        self.assertEqual((r['rendered_in'], r['depth']['frames'], r['frames_out']),
                         ('YUV420', 30, 30))
        start = content('out.y4m').index(b'FRAME\n') + 6
        for y in range(0, 48, 5):
            row = content('out.y4m')[start + 64 * y:start + 64 * (y + 1)]
            self.assertLess(max(row[4:20]) - min(row[4:20]), 16)
            self.assertGreater(max(row[44:60]) - min(row[44:60]), 32)
        # Running freely the newest depth serves, and no frame waits for it.
        r = self.report('--camera', 'replay::size 64x48;fps 60;frames 60', '--depth',
                        'estimate:red.onnx,every=5')
        self.assertEqual(r['paired'] + r['unpaired'] + r['without_depth'] + r['dropped'] -
                         r['dropped_rendered'], 60 - r['camera_dropped'])
        self.check_sum(r)

    def test_networks_that_are_refused(self):
        camera = ['--camera', 'replay::size 64x48']
        for bad, words in (('estimate:', 'give estimate:MODEL'),
                           ('estimate:x,every=0', 'no number of frames'),
                           ('estimate:x,every=1e3', 'no number of frames'),
                           ('estimate:x,preset=best', 'no preset')):
            self.fails(2, words, *camera, '--depth', bad)
        self.fails(1, 'none.onnx', *camera, '--depth', 'estimate:none.onnx')

    def test_the_format_may_change(self):
        r = self.report('--camera', 'replay::size 64x48;frames 20;at 10 format YUYV,96x50',
                        '--depth', DEPTH, '--fast', '--frames-policy', 'every', '--out',
                        'f-%02d.ppm')
        self.assertEqual(r['frames_out'], 20)
        self.assertIn(b'64 48', content('f-09.ppm')[:20])
        self.assertIn(b'96 50', content('f-10.ppm')[:20])

    def test_a_stream_of_one_size_ends_with_one_line(self):
        self.fails(1, 'a stream of 64x48 has begun', '--camera',
                   'replay::size 64x48;frames 20;at 10 format YUYV,96x50', '--depth', DEPTH,
                   '--fast', '--frames-policy', 'every', '--out', 'y4m:out.y4m')

    def test_patience_ends(self):
        begin = time.monotonic()
        self.fails(1, 'gone', '--camera', 'replay::size 64x48;at 5 vanish 100000', '--depth', DEPTH,
                   '--patience', '0.5')
        self.assertLess(time.monotonic() - begin, 10 * SLOW)

    def test_commands(self):
        r = self.report('--camera', 'replay::size 64x48;frames 60;fps 60', '--depth', DEPTH,
                        stdin=b'focus 0.2\npull 0.9 0.3\nblur 2\nfocus-at 10,10\npull-at 3,4 1\n')
        self.assertEqual(r['commands'], 5)
        done = live('--camera', 'replay::size 64x48', '--depth', DEPTH, '--json',
                    stdin=b'focus 7\nfly\nblur 99\nquit\n')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stderr.decode().splitlines()), 3)

    def test_commands_before_the_first_frame_are_kept(self):
        frame = 64 * 48 * 3
        args = ['--camera', 'replay::size 64x48;frames 20;at 0 late 700', '--depth', DEPTH,
                '--fast', '--frames-policy', 'every', '--out', 'raw:out.rgb']

        def run(*more, stdin=b''):
            self.report(*args, *more, stdin=stdin)
            return content('out.rgb')
        centre, far, near = run(), run('--focus', '0.1'), run('--focus', '0.9')
        self.assertNotEqual(centre, far)
        self.assertEqual(run(stdin=b'focus 0.1\n'), far)
        self.assertEqual(run('--focus', '0.9', stdin=b'focus 0.1\n'), far)
        self.assertEqual(run('--focus', '0.9', stdin=b'blur 1\nblur 3\n'), near)
        # A pull begins at the first frame, with what was in focus without it.
        for more, begin in ([], centre), (['--focus', '0.9'], near):
            data = run(*more, stdin=b'pull 0.1 0.3\n')
            self.assertEqual(data[:frame], begin[:frame])
            self.assertEqual(data[-frame:], far[-frame:])
            self.assertNotIn(data[5 * frame:6 * frame], (begin[5 * frame:6 * frame],
                                                         far[5 * frame:6 * frame]))

    def test_commands_by_a_socket(self):
        run = subprocess.Popen([REFOCUS, 'live', *SMALL, '--json', '--camera',
                                'replay::size 64x48;fps 60', '--depth', DEPTH, '--no-commands',
                                '--socket', 'live.sock'], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
        self.wait_for(lambda: os.path.exists('live.sock'), run)
        mode = os.stat('live.sock').st_mode
        self.assertTrue(stat.S_ISSOCK(mode))
        self.assertEqual(mode & 0o077, 0)
        self.fails(1, 'it is there already', '--camera', 'replay::size 64x48', '--depth', DEPTH,
                   '--socket', 'live.sock')
        clients = [self.connect() for _ in range(3)]
        for n, client in enumerate(clients):
            client.sendall(b'focus 0.%d\nfl' % n)
        for client in clients:  # lines in pieces, and one that no command is as long as
            client.sendall(b'y\n\nblur 2\nblur 99\n' + b'blur 1' + b'0' * 300 + b'\n')
            answers = self.lines(client, 6)
            self.assertEqual([a == b'ok' for a in answers], [True, False, True, True, False, False])
            self.assertIn(b'--blur-most', answers[4])
        clients[0].close()
        more = [self.connect() for _ in range(6)]
        self.assertEqual(self.ask(more[-1], b'pull 0.3 2\n'), b'ok')
        with self.connect() as one_too_many:
            self.assertIn(b'too many', self.lines(one_too_many, 1)[0])
        self.assertEqual(self.ask(clients[1], b'quit\n'), b'ok')
        out, error = run.communicate(timeout=60 * SLOW)
        self.assertEqual((run.returncode, error), (0, b''))
        self.assertEqual(json.loads(out)['commands'], 3 * 6 + 2)
        self.assertFalse(os.path.exists('live.sock'))
        for client in clients + more:
            client.close()

    def test_a_socket_that_was_left_is_replaced(self):
        with socket.socket(socket.AF_UNIX) as left:
            left.bind('live.sock')
        args = ['--camera', 'replay::size 64x48;frames 5', '--depth', DEPTH, '--fast', '--socket']
        self.report(*args, 'live.sock')
        self.assertFalse(os.path.exists('live.sock'))
        with open('file', 'wb') as file:
            file.write(b'precious')
        self.fails(1, 'it is there already', *args, 'file')
        self.assertEqual(content('file'), b'precious')
        self.fails(1, 'No such file', *args, 'none/live.sock')
        self.fails(2, 'give a name of', *args, 'x' * 200)

    def wait_for(self, condition, run):
        until = time.monotonic() + 30 * SLOW
        while not condition():
            self.assertIsNone(run.poll())
            self.assertLess(time.monotonic(), until)
            time.sleep(0.02)

    def connect(self):
        client = socket.socket(socket.AF_UNIX)
        client.settimeout(30 * SLOW)
        client.connect('live.sock')
        return client

    def lines(self, client, count):
        data = b''
        while data.count(b'\n') < count:
            piece = client.recv(4096)
            self.assertTrue(piece)
            data += piece
        return data.split(b'\n')[:-1]

    def ask(self, client, line):
        client.sendall(line)
        return self.lines(client, 1)[0]

    def test_a_pull_goes_from_one_focus_to_the_other(self):
        # Near and far half; what is in focus is as it was, and the focus moves over.
        with open('depth.pgm', 'wb') as depth:
            depth.write(b'P5\n64 48\n255\n' + (bytes([255]) * 32 + bytes(32)) * 48)
        self.report('--camera', 'replay::format RGB24;size 64x48;frames 1', '--depth', DEPTH,
                    '--fast', '--frames-policy', 'every', '--blur', '0', '--out', 's-%d.ppm')
        run = subprocess.Popen([REFOCUS, 'live', *SMALL, '--camera', 'file:s-0.ppm', '--fps', '30',
                                '--depth', 'depth.pgm', '--focus', '1', '--out', 'raw:out.rgb'],
                               stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        time.sleep(0.7 * SLOW)
        run.stdin.write(b'pull 0 0.5\n')
        run.stdin.flush()
        time.sleep(1.5 * SLOW)
        run.communicate(b'quit\n', timeout=60 * SLOW)
        self.assertEqual(run.returncode, 0)
        sharp = content('s-0.ppm')[-64 * 48 * 3:]
        data = content('out.rgb')
        first, last = data[:64 * 48 * 3], data[-64 * 48 * 3:]

        def same(picture, begin, end):
            return all(picture[(y * 64 + x) * 3] == sharp[(y * 64 + x) * 3]
                       for y in range(48) for x in range(begin, end))
        self.assertTrue(same(first, 0, 24))
        self.assertFalse(same(first, 40, 64))
        self.assertTrue(same(last, 40, 64))
        self.assertFalse(same(last, 0, 24))
        between = {data[i:i + 64 * 48 * 3] for i in range(0, len(data), 64 * 48 * 3)}
        self.assertGreater(len(between), 3)

    def test_calibration_registers_depth(self):
        camera = {'width': 64, 'height': 48, 'fx': 60, 'fy': 60, 'cx': 31.5, 'cy': 23.5}
        depth = {'width': 32, 'height': 24, 'fx': 30, 'fy': 30, 'cx': 15.5, 'cy': 11.5}
        calibration = {'depth': depth, 'colour': camera, 'rotation': [1, 0, 0, 0, 1, 0, 0, 0, 1],
                       'translation_m': [0.02, 0, 0]}
        args = ['--camera', 'replay::size 64x48;frames 5', '--depth', DEPTH, '--fast',
                '--frames-policy', 'every']
        with open('c.json', 'w') as file:
            json.dump(calibration, file)
        r = self.report(*args, '--calibration', 'c.json')
        self.assertEqual(r['frames_out'], 5)
        for key, value in (('rotation', [2, 0, 0, 0, 1, 0, 0, 0, 1]), ('depth', {}),
                           ('translation_m', [1])):
            with open('bad.json', 'w') as file:
                json.dump({**calibration, key: value}, file)
            self.fails(1, key, *args, '--calibration', 'bad.json')
        calibration['depth']['width'] = 33
        with open('c.json', 'w') as file:
            json.dump(calibration, file)
        self.fails(1, '--calibration is for', *args, '--calibration', 'c.json')

    def test_a_closed_pipe_ends_it_with_one_line(self):
        run = subprocess.Popen([REFOCUS, 'live', *SMALL, '--camera', 'replay::size 64x48;fps 200',
                                '--depth', DEPTH, '--no-commands', '--out', 'y4m:-'],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertTrue(run.stdout.readline().startswith(b'YUV4MPEG2'))
        run.stdout.close()
        error = run.stderr.read()
        run.stderr.close()
        self.assertEqual(run.wait(timeout=60 * SLOW), 1)
        self.assertEqual(error.count(b'\n'), 1, error)
        self.assertIn(b'closed', error)

    def test_interrupt_ends_it_well(self):
        run = subprocess.Popen([REFOCUS, 'live', *SMALL, '--json', '--camera',
                                'replay::size 64x48;fps 60', '--depth', DEPTH, '--no-commands'],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(1 * SLOW)
        run.send_signal(signal.SIGINT)
        out, error = run.communicate(timeout=60 * SLOW)
        self.assertEqual(run.returncode, 0, error)
        self.assertGreater(json.loads(out)['frames_out'], 0)

    def ends_by_sigterm(self, *args, begun=None):
        """Report of a run that a signal ends while it does what takes for ever."""
        run = subprocess.Popen([REFOCUS, 'live', '--json', *args, '--no-commands'],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        end = begun() if begun else None
        time.sleep(1 * SLOW)
        self.assertIsNone(run.poll())
        run.send_signal(signal.SIGTERM)
        try:
            out, error = run.communicate(timeout=5 * SLOW)
        finally:
            run.kill()
            if end:
                end.close()
        self.assertEqual((run.returncode, error), (0, b''))
        return json.loads(out)

    def test_sigterm_ends_a_frame_that_takes_minutes(self):
        for more in [], ['--depth-edges', 'auto']:
            r = self.ends_by_sigterm('--camera', 'replay::size 2000x1500', '--depth', DEPTH,
                                     '--method', 'raytrace', '--blur', '60', '--rays', 'full', *more)
            self.assertGreater(r['frames_in'], 0)
            self.assertEqual(r['frames_out'], 0)

    def test_sigterm_ends_the_wait_for_a_source(self):
        still = ';at 0 stall 1e8'
        os.mkfifo('fifo')
        for camera, depth in (('y4m:fifo', DEPTH), ('raw:fifo,NV12,64x48', DEPTH),
                              ('replay::size 64x48', 'raw:fifo,Z16,32x24'),
                              ('replay::size 64x48' + still, DEPTH),
                              ('replay::size 64x48', DEPTH + still),
                              ('replay::size 64x48;at 0 late 1e8', DEPTH)):
            r = self.ends_by_sigterm(*SMALL, '--camera', camera, '--depth', depth,
                                     '--frames-policy', 'every')
            self.assertLessEqual(r['frames_out'], 1)  # a stall begins behind the first

        def half_a_frame():
            fifo = open('fifo', 'wb', buffering=0)
            fifo.write(b'YUV4MPEG2 W64 H48 F30:1\n' + (b'FRAME\n' + bytes(64 * 72)) * 2 + b'FRAME\n1')
            return fifo
        r = self.ends_by_sigterm(*SMALL, '--camera', 'y4m:fifo', '--depth', DEPTH,
                                 '--frames-policy', 'every', begun=half_a_frame)
        self.assertEqual((r['format'], r['frames_in'], r['frames_out']), ('YUV420', 2, 2))

    def test_sigterm_ends_the_wait_for_who_reads(self):
        """One is opened and never read, and one is never opened, so that there is no stream."""
        os.mkfifo('fifo')
        for out in 'y4m:/dev/stdout', 'y4m:fifo':
            run = subprocess.Popen([REFOCUS, 'live', *SMALL, '--camera', 'replay::size 640x480',
                                    '--depth', DEPTH, '--no-commands', '--socket', 'socket',
                                    '--out', out], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            time.sleep(1 * SLOW)
            self.assertTrue(os.path.exists('socket'))
            run.send_signal(signal.SIGTERM)
            try:
                run.wait(timeout=5 * SLOW)
            finally:
                run.kill()
                run.communicate()
            self.assertEqual(run.returncode, 1 if out == 'y4m:fifo' else 0)
            self.assertFalse(os.path.exists('socket'))

    def test_wrong_command_lines(self):
        camera = ['--camera', 'replay::size 64x48']
        self.fails(2, 'no source is given', '--depth', DEPTH)
        self.fails(2, 'no depth is given', *camera)
        self.fails(2, 'no such kind of source', '--camera', 'webcam', '--depth', DEPTH)
        self.fails(2, 'no such kind of sink', *camera, '--depth', DEPTH, '--out', 'screen')
        self.fails(2, 'the focus is given twice', *camera, '--depth', DEPTH, '--focus', '1',
                   '--focus-at', '3,3')
        self.fails(2, 'standard output is taken', *camera, '--depth', DEPTH, '--json', '--out',
                   'y4m:-')
        self.fails(2, 'less than --blur', *camera, '--depth', DEPTH, '--blur-most', '1')
        self.fails(1, 'it is not there', '--camera', 'y4m:none.y4m', '--depth', DEPTH)
        self.fails(1, 'not understood', '--camera', 'replay::jump', '--depth', DEPTH)
        if 'RF_WINDOW' in os.environ:
            for none in ({'SDL_VIDEODRIVER': 'none-such'}, {'DISPLAY': ':none'}):
                self.fails(1, 'no display', *camera, '--depth', DEPTH, '--out', 'window', env=none)
        else:
            self.fails(1, 'this build has no window', *camera, '--depth', DEPTH, '--out', 'window')
        if 'RF_OPENCV' not in os.environ:
            self.fails(1, 'this build has no OpenCV', *camera, '--depth', 'estimate:red.onnx')
        version = subprocess.run([REFOCUS, '--version'], capture_output=True, check=True).stdout
        for kind in ('v4l2', 'libcamera', 'pipewire'):
            if kind.encode() not in version:
                self.fails(1, 'this build has no ' + kind, '--camera', kind + ':0', '--depth',
                           DEPTH)
            else:
                self.fails(1, 'refocus: %s:99' % kind, '--camera', kind + ':99', '--depth', DEPTH)

    @unittest.skipIf('REFOCUS_SLOW' in os.environ, 'sanitizers come before what is preloaded')
    def test_modules_that_are_not_installed(self):
        library = os.path.join(os.path.dirname(REFOCUS), '../capture/librefocus-capture.so.0')
        version = subprocess.run([REFOCUS, '--version'], capture_output=True, check=True).stdout
        # It looks for modules beside itself.
        env = {**os.environ, 'LD_PRELOAD': shutil.copy(library, self.folder.name)}
        for kind in ('libcamera', 'pipewire'):
            if kind.encode() in version:
                self.fails(1, f'its module refocus-{kind} is not installed', '--camera',
                           kind + ':0', '--depth', DEPTH, env=env)

    def test_memory_is_constant(self):
        sizes = []
        for frames in '20', '400':
            r = self.report('--camera', 'replay::size 64x48;random 1;frames ' + frames, '--depth',
                            DEPTH, '--fast', '--frames-policy', 'every')
            sizes.append(r['peak_rss_kib'])
        self.assertLess(sizes[1], sizes[0] + 4096)


if __name__ == '__main__':
    unittest.main()
