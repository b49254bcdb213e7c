#!/usr/bin/env python3
"""The refocus command: depth and an all-in-focus photo of a focus stack.
Usage: test_depth_stack.py REFOCUS [unittest arguments]"""
import json
import os
import shutil
import struct
import subprocess
import time
import unittest

import case
import pictures
from case import Case, H, W

FRAMES = 3
# All that struct refocus_stack_result says of a stack.
STACK_WORDS = sorted(('alike', 'blur', 'by_rows', 'direction', 'disorder', 'exposure', 'matched',
                      'measured', 'moved', 'moving', 'order', 'order_margin', 'reference'))


def noise(x, y):
    return (x * 7919 + y * 104729 + x * y * 31) * 2654435761 >> 16 & 255


def mean(x, y, radius, grain=1):
    """The texture through a lens: the mean of a square."""
    span = range(-radius, radius + 1)
    return sum(noise((x + u) // grain, (y + v) // grain) for u in span
               for v in span) // len(span) ** 2


class DepthOfAStack(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # The left half is far, in focus in the first frame, the right one near.
        for k in range(FRAMES):
            pictures.ppm(f'{k}.ppm', W, H, lambda x, y: (
                mean(x, y, k if x < W // 2 else FRAMES - 1 - k),) * 3)
        cls.frames = [f'{k}.ppm' for k in range(FRAMES)]
        cls.command = ['depth', '--focal-stack', *cls.frames, '--align', 'none']

    def halves(self, name):
        width, height, samples = pictures.read_pnm(name)
        self.assertEqual((width, height), (W, H))
        # Depths between frames are told apart, so that the ends are so but for the last bits.
        return [(0 if v < 999 else v) for v in (sorted(samples[y * W + x] for y in range(H) for x in range(left, left + W // 2))
                [W * H // 4] for left in (0, W // 2))]

    def test_depth_and_photo(self):
        report = self.reports(*self.command, '-o', 'd.pgm', '--photo', 'all.ppm')
        self.assertEqual((report['width'], report['height']), (W, H))
        self.assertEqual(report['evidence'], [
            'focus stack: 3 frames, moved by up to 0.0 pixels, in the geometry of frame 2',
            'focus stack: nothing shows which end is far; the first is taken for it'])
        self.assertEqual(self.halves('d.pgm'), [0, 65535])
        photo = pictures.read_pnm('all.ppm')[2]
        right = sum(abs(photo[3 * (y * W + x)] - noise(x, y)) < 3 for y in range(H)
                    for x in range(W))
        self.assertGreater(right, 0.75 * W * H)
        self.succeeds(*self.command, '-o', 'c.ppm', '--view', 'confidence')
        os.remove('c.ppm')

    def test_edges_show_which_end_is_far(self):
        width, height = 96, 40
        left, right = 36, 60  # of a bright bar

        def frame(x, y, k):
            def spread(radius, of):
                span = range(-radius, radius + 1)
                return sum(of(x + u, y + v) for u in span for v in span) / len(span) ** 2

            def bar(x, y):
                return 150 + noise(x, y) / 8 if left <= x < right else 0
            covered = spread(2 - k, lambda x, y: left <= x < right)
            behind = spread(k, lambda x, y: 40 + noise(x, y) / 8)
            return (int(spread(2 - k, bar) + (1 - covered) * behind),) * 3

        for k in range(FRAMES):
            pictures.ppm(f'bar-{k}.ppm', width, height, lambda x, y: frame(x, y, k))
        names = [f'bar-{k}.ppm' for k in range(FRAMES)]
        for order, far in (names, 'first'), (names[::-1], 'last'):
            report = self.reports('depth', '--focal-stack', *order, '--align', 'none', '-o',
                                  'd.pgm')
            self.assertEqual(report['evidence'][1],
                             f'focus stack: edges show that the {far} frame is focused farthest')
            samples = pictures.read_pnm('d.pgm')[2]
            for y in range(4, height - 4):
                self.assertGreater(samples[y * width + 48], 60000)
                self.assertLess(samples[y * width + 16], 9999)
        self.warns('bar-1.ppm: frames are taken in the order 3 2 1, the farthest first', 'depth',
                   '--focal-stack', *names[::-1], '--align', 'none', '-o', 'd.pgm', '--order',
                   'found')
        report = self.reports('depth', '--focal-stack', *names[::-1], '--align', 'none', '-o',
                              'd.pgm', '--order', 'given')
        self.assertEqual(len(report['evidence']), 1)
        self.assertLess(pictures.read_pnm('d.pgm')[2][20 * width + 48], 9999)
        for name in names:
            os.remove(name)

    def test_what_lies_lower_is_doubtful(self):
        """Where that alone turns the order that was given, a line says so."""
        names = [f'floor-{k}.ppm' for k in range(FRAMES)]
        for k, name in enumerate(names):
            pictures.ppm(name, W, H, lambda x, y: (mean(x, y, abs(k - y * FRAMES // H)),) * 3)
        tells = ('focus stack: what lies lower, which is nearer in most pictures, tells that the %s '
                 'frame is focused farthest')
        turned = ('floor-1.ppm: the last frame is taken for the farthest, by what lies lower alone, '
                  'which is doubtful; if the first is the farthest, give --order given')
        command = ['depth', '--align', 'none', '-o', 'd.pgm', '--focal-stack']
        self.assertEqual(self.reports(*command, *names)['evidence'][1], tells % 'first')
        report = self.warns(turned, *command, *names[::-1])
        self.assertEqual(report['evidence'][1], tells % 'last')
        self.succeeds(*command, *names[::-1], '--order', 'given')
        self.warns('floor-1.ppm: frames are taken in the order 3 2 1, the farthest first, by what '
                   'lies lower alone, which is doubtful: give --positions if it is not',
                   *command, *names[::-1], '--order', 'found')
        for name in names:
            os.remove(name)

    def test_positions_are_dioptres_in_any_order(self):
        self.succeeds(*self.command, '-o', 'd.pgm')
        turned = ['depth', '--focal-stack', *self.frames[::-1], '--align', 'none']
        with open('p.json', 'w') as file:
            json.dump({'positions': [2, 1, 0.5]}, file)
        for given in ('2,1,0.5', 'p.json'):
            report = self.reports(*turned, '-o', 'e.pgm', '--positions', given)
            self.assertEqual((report['depth']['near_m'], report['depth']['far_m']), (0.5, 2))
        self.assertEqual(self.halves('e.pgm'), [0, 65535])

    def test_a_jpeg_carries_its_depth(self):
        result = self.run_it(*self.command, '-o', 'o.jpg', '--positions', '0,1,2')
        if result.returncode:  # a build without expat or libpng
            self.assertFalse(os.path.exists('o.jpg'))
            return
        report = self.reports('info', 'o.jpg')
        self.assertEqual((report['depth']['width'], report['depth']['height']), (W, H))
        self.assertEqual(report['depth']['near_m'], 0.5)
        self.assertEqual([n for n in os.listdir('.') if n.startswith('o.') and n != 'o.jpg'], [])
        self.succeeds('render', 'o.jpg', '--focus', '1', '--blur', '4', '-o', 'r.ppm')

    CAMERA = 'replay::stack %d.ppm 3;lens 0.5 2.5'

    def stack(self, more='', *arguments):
        return ('stack', '--camera', self.CAMERA + more, '--steps', '3', *arguments)

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

    def test_the_example_for_a_pi(self):
        """Each half of its pictures is sharp in one and blurred in the other."""
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                              '../../examples/pi_focus_stack.sh')
        place = os.path.dirname(os.path.abspath(case.REFOCUS))
        path = {**os.environ, 'PATH': place + ':' + os.environ['PATH'], 'STEPS': '3', 'BLUR': '4'}
        if self.run_it('render', '0.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o',
                       'x.png').returncode:
            self.skipTest('a build without PNG')
        os.remove('x.png')
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

    def live(self, *arguments, more=''):
        return ('live', '--camera', self.CAMERA + more, '--depth', 'stack:steps=3', *arguments)

    def test_live_takes_a_stack_first(self):
        """Frames go on as the middle one was taken, refocused by the depth of the stack."""
        look = ('--blur', '3', '--rays', '4', '--focus', '0')
        self.succeeds(*self.command[:-2], '-o', 'd.pgm', '--positions', '0.5,1.5,2.5')
        self.succeeds('render', '1.ppm', '--depth', 'd.pgm', '--depth-edges', 'as-given', *look,
                      '-o', 'r.ppm')
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

    def with_distance(self, photo, name, metres):
        """A JPEG of it whose EXIF tells that subject distance, a fraction."""
        if self.run_it('render', photo, '--depth', 'depth.pgm', '--blur', '0', '--jpeg-quality',
                       '100', '-o', 'j.jpg').returncode:
            self.skipTest('a build without JPEG')
        tiff = struct.pack('<2sHIHHHIIIHHHIIIII', b'II', 42, 8, 1, 0x8769, 4, 1, 26, 0,
                           1, 0x9206, 5, 1, 44, 0, *metres)
        jpeg = pictures.read_bytes('j.jpg')
        with open(name, 'wb') as file:
            file.write(jpeg[:2] + b'\xff\xe1' + struct.pack('>H', len(tiff) + 8) +
                       b'Exif\0\0' + tiff + jpeg[2:])

    def test_exif_says_where_the_lens_was(self):
        """The farthest of them is infinity, the greatest numerator."""
        names = []
        for k, metres in enumerate(((0xffffffff, 1), (4, 1), (2, 1))):
            names.append(f'exif-{k}.jpg')
            self.with_distance(f'{k}.ppm', names[-1], metres)
        self.assertEqual([self.reports('info', name)['subject_distance'] for name in names],
                         ['infinity', 4, 2])
        report = self.reports('depth', '--focal-stack', *names[::-1], '--align', 'none', '-o', 'x.pgm')
        self.assertEqual((report['depth']['near_m'], report['depth']['far_m']), (2, 'infinity'))
        self.assertEqual(report['evidence'][1], 'EXIF: the subject distances of the frames')
        report = self.reports('depth', '--focal-stack', names[0], *names, '--align', 'none', '-o',
                              'x.pgm')
        self.assertEqual(report['evidence'][1:], [
            'focus stack: nothing shows which end is far; the first is taken for it'])
        os.remove('x.pgm')

    def apertures(self, f_numbers, distance=4):
        """Photos of one focus, the left half in it, the right one blurred the more the wider."""
        names = []
        for f_number in f_numbers:
            radius = 8 // f_number - 1
            pictures.ppm('a.ppm', W, H, lambda x, y: (
                mean(x, y, 0 if x < W // 2 else radius),) * 3)
            if self.run_it('render', 'a.ppm', '--depth', 'depth.pgm', '--blur', '0',
                           '--jpeg-quality', '100', '-o', 'j.jpg').returncode:
                self.skipTest('a build without JPEG')
            tiff = struct.pack('<2sHIHHHIIIHHHIIHHIIIIIII', b'II', 42, 8, 1, 0x8769, 4, 1, 26, 0,
                               2, 0x829d, 5, 1, 56, 0x9206, 5, 1, 64, 0, f_number, 1, distance, 1)
            jpeg = pictures.read_bytes('j.jpg')
            names.append(f'aperture-{f_number}.jpg')
            with open(names[-1], 'wb') as file:
                file.write(jpeg[:2] + b'\xff\xe1' + struct.pack('>H', len(tiff) + 8) +
                           b'Exif\0\0' + tiff + jpeg[2:])
        return names

    def test_one_focus_and_several_apertures(self):
        names = self.apertures((2, 4, 8))
        info = self.reports('info', names[2])
        self.assertEqual((info['subject_distance'], info['f_number']), (4, 8))
        report = self.reports('depth', '--focal-stack', *names, '--align', 'none', '-o', 'd.pgm',
                              '--photo', 'sharp.ppm')
        self.assertEqual(report['evidence'][:2], [
            'focus stack: 3 frames, moved by up to 0.0 pixels, in the geometry of frame 3',
            'EXIF: the f-numbers of the frames, 2 to 8'])
        self.assertRegex(report['evidence'][2], '^apertures: the nearest surface is taken to be in '
                         r'focus; the widest aperture blurs by up to [234]\.\d pixels$')
        near, far = self.halves('d.pgm')
        self.assertGreater(near, 60000)
        self.assertLess(far, 20000)
        self.succeeds('render', names[2], '--depth', 'depth.pgm', '--blur', '0', '-o', 'same.ppm')
        self.assertEqual(pictures.read_pnm('sharp.ppm'), pictures.read_pnm('same.ppm'))
        self.reports('depth', '--focal-stack', *names, '--align', 'none', '-o', 'd.pgm',
                     '--in-focus', 'farthest')
        far, near = self.halves('d.pgm')
        self.assertLess(far, 5000)
        self.assertGreater(near, 45000)

    def test_apertures_that_exif_does_not_tell(self):
        names = self.apertures((2, 8), distance=0)
        for given in names, names[::-1]:
            report = self.reports('depth', '--focal-stack', *given, '--align', 'none', '-o',
                                  'd.pgm')
            self.assertIn('EXIF: the f-numbers of the frames, 2 to 8', report['evidence'])
        # Without EXIF the sharper one is the photo, and frames are of several focus if not asked.
        for k in range(2):
            pictures.ppm(f'a-{k}.ppm', W, H, lambda x, y: (
                mean(x, y, 0 if x < W // 2 else 3 * k, grain=3),) * 3)
        for given, frame in ((0, 1), 1), ((1, 0), 2):
            report = self.reports('depth', '--focal-stack', *(f'a-{k}.ppm' for k in given),
                                  '--in-focus', 'nearest', '--align', 'none', '-o', 'd.pgm')
            self.assertEqual(report['evidence'][0], 'focus stack: 2 frames, moved by up to 0.0 '
                             f'pixels, in the geometry of frame {frame}')
            near, far = self.halves('d.pgm')
            self.assertGreater(near - far, 40000)
        report = self.reports('depth', '--focal-stack', 'a-0.ppm', 'a-1.ppm', '--align', 'none',
                              '-o', 'd.pgm')
        self.assertFalse([e for e in report['evidence'] if e.startswith('apertures')])
        os.remove('d.pgm')

    def test_refuses_what_are_no_apertures(self):
        two, eight = self.apertures((2, 8))
        command = ['depth', '--focal-stack', '--in-focus', 'nearest', '-o', 'x.pgm']
        self.fails(1, f'{two}: two frames have an aperture of f/2; give each its own', *command,
                   two, two)
        self.fails(1, f'{two}: not all frames tell their f-numbers; give two frames, or photos '
                   'with EXIF', *command, two, eight, '0.ppm')
        for option, value in ('--positions', '1,2'), ('--reference', '1'), ('--order', 'found'):
            self.fails(2, f'{option}: frames of --in-focus differ in their apertures; leave it out',
                       *command, two, eight, option, value)
        self.fails(2, '--reference: frames differ in their apertures, and the photo is that of the '
                   'smallest one; leave it out', 'depth', '--focal-stack', two, eight, '-o',
                   'x.pgm', '--reference', '1')
        pictures.ppm('flat.ppm', W, H, lambda x, y: (90, 90, 90))
        self.fails(1, 'flat.ppm: no blur of the sharper frame is like the other one; give frames '
                   'of one focus and different apertures', *command, 'flat.ppm', 'flat.ppm')

    def test_says_when_the_order_is_wrong(self):
        for k in range(5):
            pictures.ppm(f'five-{k}.ppm', W, H, lambda x, y: (
                int(128 + (noise(x, y) - 128) * 0.6 ** (k if x < W // 2 else 4 - k)),) * 3)
        five = [f'five-{k}.ppm' for k in (3, 0, 4, 2, 1)]
        self.warns(f'{five[2]}: frames do not follow each other in focus; give the farthest first, '
                   '--positions, or --order found', 'depth', '--focal-stack', *five, '--align',
                   'none', '-o', 'x.pgm')
        report = self.warns(f'{five[3]}: frames are taken in the order 3 1 4 5 2; whether it begins '
                            'with the farthest is not seen: give --positions if it does not',
                            'depth', '--focal-stack', *five, '--align', 'none', '-o', 'y.pgm',
                            '--order', 'found')
        self.assertTrue(report['evidence'][0].endswith('in the geometry of frame 4'))
        self.assertEqual((report['file'], report['stack']['reference']), (five[3], 4))
        self.assertEqual(report['stack']['order'], [3, 1, 4, 5, 2])
        self.assertEqual([report['stack'][name] for name in ('moved', 'moving', 'blur')], [0] * 3)
        self.assertIs(report['stack']['by_rows'], True)
        self.assertLess(abs(report['stack']['direction']), 0.04)
        self.assertLess(report['stack']['disorder'], 0.5)
        for share in 'measured', 'alike', 'order_margin':
            self.assertTrue(0.05 < report['stack'][share] <= 1, share)
        self.reports('depth', '--focal-stack', *(f'five-{k}.ppm' for k in (4, 3, 2, 1, 0)),
                     '--align', 'none', '-o', 'x.pgm')
        self.same(pictures.read_bytes('x.pgm'), pictures.read_bytes('y.pgm'), 'order')
        os.remove('y.pgm')
        self.reports('depth', '--focal-stack', *five, '--align', 'none', '-o', 'x.pgm',
                     '--positions', '3,0,4,2,1')
        os.remove('x.pgm')

    def test_the_photo_is_of_the_frame_in_the_middle(self):
        """Its file says what the result says, also where the order is found."""
        names = ['0.ppm', '2.ppm', 'middle.jpg']
        self.with_distance('1.ppm', names[2], (3, 1))
        result = self.run_it('depth', '--focal-stack', *names, '--order', 'found', '--align',
                             'none', '-o', 'x.pgm', '--photo', 'x.jpg', '--json')
        report = json.loads(result.stdout)
        self.assertEqual((report['stack']['reference'], report['file']), (3, names[2]))
        self.assertEqual(self.reports('info', 'x.jpg')['subject_distance'], 3)
        os.remove('x.jpg')
        os.remove('x.pgm')

    def test_says_when_frames_show_other_places(self):
        pictures.ppm('other.ppm', W, H, lambda x, y: (noise(y + 900, x),) * 3)
        self.warns('other.ppm: not all frames lie on each other: the camera moved too far, or they '
                   'show different places; depth is wrong there', 'depth', '--focal-stack',
                   '0.ppm', 'other.ppm', '-o', 'x.pgm')
        for name in 'other.ppm', 'x.pgm':
            os.remove(name)

    def test_a_frame_comes_from_standard_input(self):
        """It is read for its EXIF first, and then for its pixels."""
        self.succeeds(*self.command, '-o', 'd.pgm')
        for k, frame in enumerate(self.frames):
            names = [*self.frames[:k], '-', *self.frames[k + 1:]]
            with open(frame, 'rb') as file:
                done = subprocess.run([case.REFOCUS, 'depth', '--focal-stack', *names, '--align',
                                       'none', '-o', 'x.pgm'], stdin=file, stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, timeout=300)
            self.assertEqual((done.returncode, done.stderr), (0, b''))
            self.same(pictures.read_pnm('x.pgm'), pictures.read_pnm('d.pgm'))

    def test_depth_and_photo_are_two_files(self):
        why = ': two results would be written to it; give each its own name'
        out = ('-o', 'both.pfm', '--photo')
        os.mkdir('links')
        os.symlink('../both.pfm', 'links/link.pfm')
        for there in False, True:
            for name in 'both.pfm', './both.pfm', 'links/link.pfm', os.path.abspath('both.pfm'):
                self.fails(2, name + why, *self.command, *out, name)
                self.fails(2, name + why, *self.stack('', *out, name))
            pictures.pfm('both.pfm', W, H, lambda x, y: 1)
        os.remove('both.pfm')
        shutil.rmtree('links')

    def test_frames_of_other_light(self):
        """They are matched, and the report says so; where that cannot be, a line does."""
        names = [f'light-{k}.ppm' for k in range(4)]
        for k, name in enumerate(names):
            def code(x, y, gain):
                return (int((90 + mean(x, y, k if x < W // 2 else 3 - k) / 3) * gain),) * 3
            pictures.ppm(name, W, H, lambda x, y: code(x, y, 1 if k else 0.8))
        command = ['depth', '--align', 'none', '--order', 'given', '-o', 'x.pgm', '--focal-stack']
        report = self.reports(*command, *names)
        self.assertRegex(report['evidence'][1], '^focus stack: frames of another exposure or white '
                         r'are matched to frame 3: \d, the farthest of 0\.[56]\d times its light$')
        self.assertIn(': %d, the farthest of %.2f' % (
            report['stack']['matched'], report['stack']['exposure']), report['evidence'][1])
        self.assertEqual(sorted(report['stack']), STACK_WORDS)
        # The light gets another colour on either side.
        def tinted(x, y, k, gain):
            checks = 80 + 60 * (x // 16 + y // 12 & 1)
            v = checks + mean(x, y, k if x < W // 2 else 3 - k) / 8
            return (int(v * gain), int(v), int(v / gain))
        for k, name in enumerate(names):
            pictures.ppm(name, W, H, lambda x, y: tinted(
                x, y, k, 1 if k == 2 else 1.4 if x < W // 2 else 0.7))
        self.fails(1, f'{names[2]}: something moves in most of the picture, or its light changed; '
                   'leave out the frames that differ, or give another --reference', *command,
                   *names)
        for k, name in enumerate(names):
            pictures.ppm(name, W, H, lambda x, y: tinted(
                x, y, k, 1 if k == 2 or x > 0.45 * W else 1.4))
        report = self.warns(f'{names[2]}: in much of the picture something moves, its light '
                            'changed, or frames do not follow each other: depth and photo are '
                            'doubtful', *command, *names)
        self.assertRegex(report['evidence'][1], r'^focus stack: something moves in [56]\d\.\d % of '
                         'the picture: frames that differ from frame 3 are left out there$')
        # Other frames show another place.
        for k, name in enumerate(names[:2]):
            pictures.ppm(name, W, H, lambda x, y: (128 + 90 * (-1) ** (x // 16 + y // 12 + k),) * 3)
        self.fails(1, f'{names[1]}: frames do not lie on each other: the camera moved too far, or '
                   'they show different places; give frames of one view', *command, *names[:3])
        for name in *names, 'x.pgm':
            os.remove(name)

    def test_bits_of_frames_are_told_once(self):
        names = [f'deep{k}.png' for k in range(FRAMES)]
        for k, name in enumerate(names):
            grey = pictures.read_pnm(f'{k}.ppm')[2]
            pictures.png(name, W, H, [struct.pack('>%dH' % (3 * W), *(
                257 * v for v in grey[3 * W * y:3 * W * (y + 1)])) for y in range(H)], depth=16)
        command = ('depth', '--align', 'none', '-o', 'd.pgm', '--focal-stack')
        self.warns(f'{names[1]}: it has 16 bits a channel; 8 are taken, dithered', *command, *names)
        # Also where the photo itself has 8, and is read first.
        self.warns(f'{names[0]}: it has 16 bits a channel; 8 are taken, dithered', *command, names[0],
                   self.frames[1], names[2])
        for name in (*names, 'd.pgm'):
            os.remove(name)

    def test_what_is_no_stack(self):
        out = ('-o', 'x.pgm')
        self.fails(2, '0.ppm: one frame is no focus stack; give two at least',
                   'depth', '--focal-stack', '0.ppm', *out)
        self.fails(1, '0.ppm: no part of the picture is sharper in one frame than in the others; '
                   'give frames of different focus', 'depth', '--focal-stack', '0.ppm', '0.ppm',
                   *out)
        pictures.ppm('small.ppm', W - 1, H, lambda x, y: (x, y, 0))
        self.fails(1, f'small.ppm: it is {W - 1}x{H}, and other frames are not; give frames of one '
                   'size', *self.command, 'small.ppm', *out)
        os.remove('small.ppm')
        pictures.ppm('tiny.ppm', 8, 8, lambda x, y: (x, y, 0))
        self.fails(1, 'tiny.ppm: it is too small; give frames of 16 x 16 pixels and more',
                   'depth', '--focal-stack', 'tiny.ppm', 'tiny.ppm', *out)
        os.remove('tiny.ppm')
        self.fails(2, '2.ppm: one file too many; give refocus depth FILE [RIGHT], or --focal-stack',
                   'depth', *self.frames, *out)
        self.fails(2, '--reference: there are 3 frames; give 1 to 3', *self.command, *out,
                   '--reference', '4')
        for option in (['--full'], ['--orient-depth', '90'], ['--invalid', 'zero'],
                       ['--speckle', '9']):
            self.fails(2, option[0] + ': it is not for depth of a focus stack; leave it out',
                       *self.command, *out, *option)
        self.fails(2, '32.ppm: a focus stack has 32 frames at the most; leave out every other one',
                   'depth', *out, '--focal-stack', *[f'{k}.ppm' for k in range(33)])
        for text, why in (('1,2', '2 positions for 3 frames; give one for each'),
                          ('1,2,1', '1 is there twice; give each frame its own'),
                          ('1,2,-1', '-1 is no focus in dioptres; give numbers from 0 to 1e6'),
                          ('1,nan,2', 'nan is no focus in dioptres; give numbers from 0 to 1e6'),
                          ('1;2;3', "'1;2;3' is no list of numbers; give dioptres with commas, "
                           'such as 0.2,0.5,1, or a .json file')):
            self.fails(2, '--positions: ' + why, *self.command, *out, '--positions', text)
        for text, why in (('{"a": 1}', 'it holds no positions; give [0.2, 0.5, 1] or '
                           '{"positions": [0.2, 0.5, 1]}, in dioptres'),
                          ('[1, "2", 3]', 'position 2 is no number; give dioptres')):
            with open('bad.json', 'w') as file:
                file.write(text)
            self.fails(1, 'bad.json: ' + why, *self.command, *out, '--positions', 'bad.json')
        self.fails(2, '--reference: it goes with --focal-stack; give that too',
                   'depth', 'depth.pgm', *out, '--reference', '1')


if __name__ == '__main__':
    unittest.main()
