#!/usr/bin/env python3
"""The refocus command: depth and an all-in-focus photo of a focus stack.
Usage: test_depth_stack.py REFOCUS [unittest arguments]"""
import json
import os
import shutil
import struct
import subprocess
import unittest

import case
import pictures
from case import H, W
from focus_stack import FRAMES, FocusStack, mean, noise
from jpeg_files import HAS_JPEG, HAS_PNG, HAS_XMP

# All that struct refocus_stack_result says of a stack.
STACK_WORDS = sorted(('alike', 'blur', 'by_rows', 'direction', 'disorder', 'exposure', 'matched',
                      'measured', 'moved', 'moving', 'order', 'order_margin', 'reference'))


class DepthOfAStack(FocusStack):
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

    def test_light_above_white(self):
        """A lamp of 6 times white: blurred frames tell of it; without it no gain map is written."""
        width, height, middle = 192, 96, 48

        def frame(name, radius, lamp):
            disc = [(u, v) for u in range(-4, 5) for v in range(-4, 5)
                    if u * u + v * v <= radius * radius]

            def light(x, y):
                inside = abs(x - 2 * middle) < 4 and abs(y - middle) < 4
                return lamp if inside else (noise(x, y) / 255 * 0.6 + 0.1) ** 2.2
            lights = [[light(x, y) for x in range(-4, width + 4)] for y in range(-4, height + 4)]

            def code(x, y):
                mean = sum(lights[y + v + 4][x + u + 4] for u, v in disc) / len(disc)
                coded = 12.92 * mean if mean < 0.0031308 else 1.055 * mean ** (1 / 2.4) - 0.055
                return (min(255, int(255 * coded + 0.5)),) * 3
            pictures.ppm(name, width, height, code)

        names = [f'lamp-{k}.ppm' for k in range(FRAMES)]
        for lamp in 6, 0.5:
            for k, name in enumerate(names):
                frame(name, 2 * k, lamp)
            self.succeeds('depth', '--focal-stack', *names, '--align', 'none', '--reference', '1',
                          '--order', 'given', '-o', 'd.pgm', '--photo', 'light.pfm')
            _, _, light = pictures.read_pfm('light.pfm')
            self.assertLess(abs(light[3 * (middle * width + 2 * middle)] / lamp - 1), 0.2)
            if HAS_JPEG and HAS_PNG and HAS_XMP:
                self.succeeds('depth', '--focal-stack', *names, '--align', 'none', '--reference',
                              '1', '--order', 'given', '-o', 'lamp.jpg')
                said = ' '.join(self.reports('info', 'lamp.jpg')['evidence'])
                self.assertEqual('gain map' in said, lamp > 1)
                os.remove('lamp.jpg')
        for name in names + ['light.pfm', 'd.pgm']:
            os.remove(name)

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

    @unittest.skipUnless(HAS_JPEG and HAS_PNG and HAS_XMP, 'needs TurboJPEG, libpng and expat')
    def test_a_jpeg_carries_its_depth(self):
        before = os.listdir('.')
        self.succeeds(*self.command, '-o', 'o.jpg', '--positions', '0,1,2')
        self.assertEqual(sorted(os.listdir('.')), sorted(before + ['o.jpg']))
        report = self.reports('info', 'o.jpg')
        self.assertEqual((report['depth']['width'], report['depth']['height']), (W, H))
        self.assertEqual(report['depth']['near_m'], 0.5)
        self.succeeds('render', 'o.jpg', '--focus', '1', '--blur', '4', '-o', 'r.ppm')

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
