#!/usr/bin/env python3
"""The refocus command: depth of photos whose EXIF says where the lens was, or how wide open.
Usage: test_stack_exif.py REFOCUS [unittest arguments]"""
import os
import struct
import unittest

import pictures
from case import H, W
from focus_stack import FocusStack, mean
from jpeg_files import HAS_JPEG


@unittest.skipUnless(HAS_JPEG, 'needs TurboJPEG')
class StackExif(FocusStack):
    def with_distance(self, photo, name, metres):
        """A JPEG of it whose EXIF tells that subject distance, a fraction."""
        self.succeeds('render', photo, '--depth', 'depth.pgm', '--blur', '0', '--jpeg-quality',
                      '100', '-o', 'j.jpg')
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
            self.succeeds('render', 'a.ppm', '--depth', 'depth.pgm', '--blur', '0',
                          '--jpeg-quality', '100', '-o', 'j.jpg')
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

    def test_the_photo_is_of_the_frame_in_the_middle(self):
        """Its file says what the result says, also where the order is found."""
        names = ['0.ppm', '2.ppm', 'middle.jpg']
        self.with_distance('1.ppm', names[2], (3, 1))
        told = ('middle.jpg: frames are taken in the order 1 3 2; whether it begins with the '
                'farthest is not seen: give --positions if it does not')
        command = ('depth', '--focal-stack', *names, '--order', 'found', '--align', 'none', '-o',
                   'x.pgm', '--photo')
        report = self.warns(told, *command, 'x.jpg')
        self.assertEqual((report['stack']['reference'], report['file']), (3, names[2]))
        self.assertEqual(self.reports('info', 'x.jpg')['subject_distance'], 3)
        # all of its pixels are of the result, as where that frame was asked for
        self.warns(told, *command, 'found.ppm')
        self.warns(told, *command, 'asked.ppm', '--reference', '3')
        self.same(pictures.read_pnm('found.ppm'), pictures.read_pnm('asked.ppm'))
        for name in 'x.jpg', 'x.pgm', 'found.ppm', 'asked.ppm':
            os.remove(name)


if __name__ == '__main__':
    unittest.main()
