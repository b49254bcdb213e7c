#!/usr/bin/env python3
"""The refocus command: `stack` and `live` move a camera's lens for a focus stack.
Usage: test_stack.py REFOCUS [unittest arguments]"""
import contextlib
import glob
import json
import os
import signal
import subprocess
import time
import unittest

import case
import pictures
from case import H, W
from focus_stack import FocusStack, noise
from jpeg_files import HAS_PNG


class Stack(FocusStack):
    def test_a_camera_moves_its_lens(self):
        plan = self.reports(*self.stack('', '--dry-run'))
        self.assertEqual(plan, {'dioptres': True, 'least': 0.5, 'greatest': 2.5, 'average': 1,
                                'positions': [0.5, 1.5, 2.5]})
        self.assertIn(' 2       1.5, 0.667 m\n', self.succeeds(*self.stack('', '--dry-run')))
        self.succeeds('depth', '--focal-stack', *self.frames, '-o', 'd.pgm', '--photo', 'all.ppm')
        report = self.reports(*self.stack(';lens-speed 0.125', '--average', '2', '-o', 'e.pgm',
                                          '--photo', 'f.ppm', '--keep', 'kept'))
        self.assertEqual((report['depth']['near_m'], report['depth']['far_m']), (0.4, 2))
        for one, other in ('d.pgm', 'e.pgm'), ('all.ppm', 'f.ppm'):
            with open(one, 'rb') as a, open(other, 'rb') as b:
                self.same(a.read(), b.read(), other)
        with open('kept/stack.json') as file:
            kept = json.load(file)
        self.assertEqual(kept['positions'], [0.5, 1.5, 2.5])
        again = self.reports('depth', '--focal-stack', *('kept/' + f for f in kept['frames']),
                             '--positions', 'kept/stack.json', '-o', 'g.pgm')
        self.assertEqual(again['depth'], report['depth'])
        self.assertEqual(report['file'], 'kept/01.' + kept['frames'][1].split('.')[1])
        self.fails(1, 'kept: it is there already; give a new folder',
                   *self.stack('', '--keep', 'kept'))
        # Files that do not stay are not named.
        report = self.reports(*self.stack('', '-o', 'e.pgm'))
        self.assertEqual(report['file'], self.CAMERA)
        os.mkdir('flat')
        for name in self.frames:
            with open(os.path.join('flat', name), 'wb') as file:
                file.write(b'P6\n64 48\n255\n' + bytes([90]) * (64 * 48 * 3))
        flat = self.CAMERA.replace('%d', 'flat/%d')
        self.fails(1, flat + ': no part of the picture is sharper in one frame than in the others; '
                   'give frames of different focus', 'stack', '--camera', flat,
                   '--steps', '3', '-o', 'x.pgm')
        self.assertEqual([f for f in os.listdir('.') if f.startswith('.refocus')], [])

    @unittest.skipUnless(HAS_PNG, 'needs libpng')
    def test_the_example_for_a_pi(self):
        """Each half of its pictures is sharp in one and blurred in the other."""
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                              '../../examples/pi_focus_stack.sh')
        place = os.path.dirname(os.path.abspath(case.REFOCUS))
        path = {**os.environ, 'PATH': place + ':' + os.environ['PATH'], 'STEPS': '3', 'BLUR': '4'}
        self.assertEqual(subprocess.run([script], stderr=subprocess.DEVNULL).returncode, 2)
        run = subprocess.run([script, 'pi', self.CAMERA], env=path, stdout=subprocess.DEVNULL,
                             stderr=subprocess.PIPE)
        self.assertEqual((run.returncode, run.stderr), (0, b''))
        rough = {}
        for name in 'near', 'far', 'sharp':
            self.succeeds('render', f'pi/{name}.png', '--depth', 'depth.pgm', '--blur', '0', '-o',
                          'x.ppm')
            v = pictures.read_pnm('x.ppm')[2]
            for half in 0, 1:
                rough[name, half] = sum(abs(v[3 * (y * W + x)] - v[3 * (y * W + x + 1)])
                                        for y in range(4, H - 4)
                                        for x in range(half * W // 2 + 5, (half + 1) * W // 2 - 5))
        os.remove('x.ppm')
        for name, half in ('far', 0), ('near', 1):  # the left half is far
            self.assertGreater(rough[name, half], 0.8 * rough['sharp', half])
            self.assertLess(rough[name, 1 - half], 0.5 * rough['sharp', 1 - half])

    def test_a_range_and_frames_alone(self):
        self.assertEqual(self.reports(*self.stack('', '--range', '1,2', '--keep', 'two'))
                         ['positions'], [1, 1.5, 2])
        self.assertEqual(len(os.listdir('two')), 4)
        self.assertEqual(self.reports(*self.stack('', '--range', '0.75,1.25', '--dry-run'))
                         ['positions'], [0.75, 1, 1.25])

    def test_lenses_that_do_not_do_as_they_are_told(self):
        out = ('-o', 'x.pgm')
        sticky = self.CAMERA + ';lens-stop 1.5'
        self.fails(1, f'{sticky}: its lens stays at 1.5 where 2.5 was asked for; give a --range '
                   'that it can reach', *self.stack(';lens-stop 1.5', *out))
        wrong = self.CAMERA + ';lens-error 0.5'
        report = self.warns(f'{wrong}: its lens reports 1 where 0.5 was asked for; depth goes by '
                            'what it reports', *self.stack(';lens-error 0.5', '-o', 'w.pgm'))
        self.assertAlmostEqual(report['depth']['far_m'], 1)
        slow = self.CAMERA + ';lens-speed 0.001'
        self.fails(1, f'{slow}: its lens has not come to rest within 20 s',
                   *self.stack(';lens-speed 0.001', *out))
        ends = self.CAMERA + ';frames 40'
        self.fails(1, f'{ends}: the script is at its end', *self.stack(';frames 40', *out))
        self.fails(1, 'replay::size 64x48: its lens cannot be moved; focus by hand, and give the '
                   'pictures to refocus depth --focal-stack', 'stack', '--camera',
                   'replay::size 64x48', *out)
        self.fails(2, '--range: its lens goes from 0.5 to 2.5; give the farther one first',
                   *self.stack('', '--range', '2,1', *out))
        self.fails(2, '--camera: none is given; refocus live --list shows those that there are',
                   'stack', *out)
        self.fails(2, '--photo: it goes with -o; give that too',
                   *self.stack('', '--keep', 'no', '--photo', 'p.ppm'))

    def test_frames_that_are_damaged_or_of_another_size(self):
        drawn = 'replay::size 64x48;lens 0 2'
        def damaged(*frames):
            return ''.join(f';at {n} corrupt' for n in frames)
        report = self.reports('stack', '--camera', drawn + damaged(*range(3, 60)), '--steps', '2',
                              '--keep', 'some')
        self.assertEqual(report['positions'], [0, 2])
        for camera, why in (
                (drawn + ';at 90 format YUYV,320x240', 'its frames have changed their size'),
                (drawn + ';at 90 format YUYV,48x64', 'its frames have changed their size')):
            self.fails(1, f'{camera}: {why}', 'stack', '--camera', camera, '--steps', '2',
                       '--average', '64', '--keep', 'none')
        with open('damaged', 'w', encoding='utf-8') as file:
            file.write((drawn + damaged(*range(100)))[8:].replace(';', '\n'))
        self.fails(1, 'replay:damaged: all of its frames are damaged', 'stack', '--camera',
                   'replay:damaged', '--steps', '2', '--keep', 'none')

    def test_signals_leave_no_frames(self):
        """Of one the work ends by itself; where nobody reads its line, of the second one at once."""
        before = sorted(os.listdir('.'))
        reader, writer = os.pipe()
        # a second one that comes while a file is written is as none: then the first one, in 2 s
        for numbers, statuses in ((signal.SIGTERM,), [1]), ((signal.SIGINT, signal.SIGTERM),
                                                            [-signal.SIGTERM, -signal.SIGINT]):
            process = subprocess.Popen([case.REFOCUS, *self.stack(';at 60 stall 60000', '-o',
                                                                  'x.pgm')], stderr=writer)
            while not glob.glob('.refocus-stack-*/00.ppm') and process.poll() is None:
                time.sleep(0.01)
            time.sleep(0.1)
            process.send_signal(signal.SIGSTOP)
            for number in numbers:
                process.send_signal(number)
            process.send_signal(signal.SIGCONT)
            self.assertIn(process.wait(60), statuses)
            self.assertEqual(sorted(os.listdir('.')), before)
            os.set_blocking(writer, False)
            with contextlib.suppress(BlockingIOError):
                while os.write(writer, bytes(4096)):
                    pass
            os.set_blocking(writer, True)
        os.close(reader)
        os.close(writer)

    def live(self, *arguments, more=''):
        return ('live', '--camera', self.CAMERA + more, '--depth', 'stack:steps=3', *arguments)

    def test_live_takes_a_stack_first(self):
        """Frames go on as the middle one was taken, refocused by the depth of the stack."""
        look = ('--blur', '3', '--rays', '4', '--focus', '0')
        self.succeeds(*self.command[:-2], '-o', 'd.pgm', '--positions', '0.5,1.5,2.5')
        self.succeeds('render', '1.ppm', '--depth', 'd.pgm', '--depth-edges', 'as-given',
                      '--no-thin', *look, '-o', 'r.ppm')
        report = self.reports(*self.live(*look, '--fast', '--frames', '2', '--frames-policy',
                                         'every', '--out', 'l-%d.ppm', more=';lens-speed 0.25'))
        self.assertEqual((report['stacks'], report['lens_dioptres']), (1, 1.5))
        self.assertEqual((report['near_m'], report['far_m']), (0.4, 2))
        for n in range(2):
            self.same(pictures.read_bytes(f'l-{n}.ppm'), pictures.read_bytes('r.ppm'), 'live')

    def test_live_takes_a_stack_when_asked(self):
        run = subprocess.Popen([case.REFOCUS, *self.live('--json', '--out', 'a-%d.ppm',
                                                         more=';fps 200')],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
        try:
            for stacks in range(2):
                seen = len(os.listdir('.'))
                while len(os.listdir('.')) == seen and run.poll() is None:
                    time.sleep(0.02)
                run.stdin.write(b'stack\n' if stacks == 0 else b'quit\n')
                run.stdin.flush()
                if stacks == 0:
                    time.sleep(4)  # 3 x 0.3 s, and one for the exposure
            out, error = run.communicate(timeout=60)
        finally:
            run.kill()
        self.assertEqual((run.returncode, error), (0, b''))
        self.assertEqual(json.loads(out)['stacks'], 2)

    def test_live_says_why_there_is_no_stack(self):
        for more, why in ((';lens-stop 1.5', 'its lens stays at 1.5 where 2.5 was asked for; give '
                           'a --range that it can reach'),
                          (';lens-speed 0.001', 'its lens has not come to rest within 20 s'),
                          (';frames 40', 'the script is at its end')):
            self.fails(1, f'{self.CAMERA}{more}: {why}', *self.live('--fast', more=more))
        for k in range(2):
            pictures.ppm(f'same-{k}.ppm', W, H, lambda x, y: (noise(x, y),) * 3)
        alike = 'replay::stack same-%d.ppm 2;lens 0.5 2.5'
        self.fails(1, f'{alike}: no part of the picture is sharper in one frame than in the '
                   'others; give frames of different focus', 'live', '--camera', alike, '--depth',
                   'stack:steps=2,settle=0,average=2', '--fast', '--frames', '1')
        for camera in 'replay::size 64x48', 'file:0.ppm':
            self.fails(1, f'{camera}: its lens cannot be moved; focus by hand, and give the '
                       'pictures to refocus depth --focal-stack', 'live', '--camera', camera,
                       '--depth', 'stack:')
        parts = (' is no part of it; give stack: with steps=2 to 32, far=P and near=P of the lens, '
                 'average=1 to 64, settle=MS, and commas')
        for bad in 'steps=1', 'steps=', 'steps=nan', 'steps=9x', 'every=2', 'average=65', ',':
            self.fails(2, f"--depth: '{bad}'{parts}", 'live', '--camera', self.CAMERA, '--depth',
                       'stack:' + bad)
        self.fails(2, '--depth: far and near go together; give both', 'live', '--camera',
                   self.CAMERA, '--depth', 'stack:far=1')
        self.fails(2, '--autofocus: the lens takes a focus stack for --depth; leave it out', 'live',
                   '--camera', self.CAMERA, '--depth', 'stack:', '--autofocus', 'off')
        self.fails(2, '--depth: its lens goes from 0.5 to 2.5; give the farther one first', 'live',
                   '--camera', self.CAMERA, '--depth', 'stack:far=1,near=9')
        self.fails(2, '--depth-unit: it is not for depth of a focus stack; leave it out',
                   *self.live('--depth-unit', 'mm'))
        run = subprocess.run([case.REFOCUS, 'live', '--camera', 'replay::size 64x48;frames 9',
                              '--depth', 'depth.pgm'], input=b'stack\n', stderr=subprocess.PIPE,
                             timeout=60)
        self.assertEqual(run.stderr.decode().splitlines()[0], 'refocus: stack: depth is not of a '
                         'focus stack; begin with --depth stack:')


if __name__ == '__main__':
    unittest.main()
