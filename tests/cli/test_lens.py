#!/usr/bin/env python3
"""Focus and blur are what is asked for: by pixels, by a lens, by what the file says.
Usage: test_lens.py REFOCUS [unittest arguments]"""
import base64
import json
import os
import unittest

import pictures
from case import Case, H, W


class Lens(Case):
    def test_focus(self):
        def focus(*more):
            return self.reports(*self.render(*more))['focus']

        self.assertAlmostEqual(focus('--focus-at', '47,0'), 1, 4)
        self.assertAlmostEqual(focus('--focus-at', '0,31'), 0.2, 4)
        self.assertAlmostEqual(focus(), 1, 4)  # the centre lies on the right half
        near_far = ('--near', '0.5', '--far', '4')
        for metres, disparity in (('0.5', 1), ('4', 0), ('1', 3 / 7), ('2', 1 / 7)):
            self.assertAlmostEqual(focus('--focus-distance', metres, *near_far), disparity, 6)
        self.assertAlmostEqual(focus('--focus-distance', 'inf', '--near', '1', '--far', 'inf'),
                               0, 6)
        for metres in ('0.49', '4.1', 'inf'):
            self.fails(2, '--focus-distance: %s m lies outside of the depth of depth.pgm; give '
                          '0.5 to 4 m' % metres,
                       *self.render('--focus-distance', metres, *near_far))
        self.fails(1, 'depth.pgm: --focus-distance needs distances in metres, which it does not '
                      'say; give --near and --far, or --focus or --focus-at in its place',
                   *self.render('--focus-distance', '1', '--near', '1'))

    def test_subject(self):
        """Without a point, what stands before its surroundings beside the centre is in focus."""
        def focus(disparity):
            pictures.pgm('map.pgm', W, H, disparity)
            return 255 * self.reports('render', 'photo.ppm', '--depth', 'map.pgm', '-o',
                                      'out.ppm')['focus']

        def ground(y):
            return 20 + 4 * y

        def person(x):
            return 7 <= x < 19

        self.assertAlmostEqual(focus(lambda x, y: 204 if person(x) else 20), 204, 1)
        self.assertAlmostEqual(focus(lambda x, y: 204 if person(x) else ground(y)), 204, 0)
        self.assertAlmostEqual(focus(lambda x, y: 204 if person(x) else 230 if y > 28 else 20),
                               204, 1)  # a table in front of all
        # But the centre is, where nothing stands out, or on both sides, or is as large.
        self.assertAlmostEqual(focus(lambda x, y: ground(y)), ground(H // 2), 0)
        self.assertAlmostEqual(focus(lambda x, y: 204 if abs(2 * x - W) > 24 else 20), 20, 1)
        self.assertAlmostEqual(focus(lambda x, y: 204 if x < 2 else 20), 20, 1)
        self.assertAlmostEqual(focus(lambda x, y: 20 if person(x) else 204), 204, 1)
        os.remove('map.pgm')

    def test_focus_at_is_robust(self):
        """Wrong single samples do not win."""
        pictures.pgm('specks.pgm', W, H,
                     lambda x, y: 255 if (x, y) in ((10, 10), (0, 0), (1, 1)) else 51)
        for at in ('10,10', '0,0', '2,1'):
            report = self.reports('render', 'photo.ppm', '--depth', 'specks.pgm', '-o',
                                  'out.ppm', '--focus-at', at)
            self.assertAlmostEqual(report['focus'], 0.2, 4)

    def test_lens(self):
        def blur(*more):
            return self.reports(*self.render(*more))['blur']

        self.assertAlmostEqual(blur(), W / 50, 5)
        pictures.ppm('tall.ppm', H, W, lambda x, y: (5 * x, 5 * y, 90))
        pictures.pgm('tall.pgm', H, W, lambda x, y: 5 * y)
        tall = self.reports('render', 'tall.ppm', '--depth', 'tall.pgm', '-o', 'out.ppm')
        self.assertAlmostEqual(tall['blur'], W / 50, 5)  # by the larger side of that one, too
        lens = ('--near', '0.5', '--far', '4', '--f-number', '8', '--focal-length', '50')
        expected = 50 / 36 * W * (0.05 / 16) * (1 / 0.5 - 1 / 4)
        self.assertAlmostEqual(blur(*lens), expected, 5)
        self.assertAlmostEqual(blur(*lens, '--sensor-width', '18'), 2 * expected, 5)
        self.fails(1, 'depth.pgm: --focal-length needs distances in metres, which it does not '
                      'say; give --near and --far, or leave it out',
                   *self.render('--f-number', '2', '--focal-length', '50'))
        r = self.warns('--f-number: photo.ppm says no focal length; f/4 gives 0.5 pixels of blur, by '
                       'the default of 1.0 at f/2; --focal-length gives that of a lens',
                       *self.render('--f-number', '4', '--near', '1', '--far', '2'))
        self.assertAlmostEqual(r['blur'], W / 100, 5)

    WIDE = ('--near', '0.01', '--far', 'inf', '--focal-length', '85')

    def test_f_number_is_limited(self):
        """More blur than there can be is the most that there can be."""
        line = ('--f-number: f/0.5 gives 963 pixels of blur, limited to 944, the most, which '
                'f/0.51 has')
        report = self.warns(line, *self.render(*self.WIDE, '--f-number', '0.5'))
        limited = pictures.read_bytes('out.ppm')
        self.assertEqual((report['blur'], report['blur_from']), (944, 'lens'))
        self.assertAlmostEqual(report['f_number'], 0.5 * 963.3 / 944, 2)
        wide = self.reports(*self.render(*self.WIDE, '--f-number', '1.4'))
        self.assertEqual(wide['f_number'], 1.4)  # more than 127 pixels are rendered
        self.assertAlmostEqual(wide['blur'], 344, 0)
        self.succeeds(*self.render(*self.WIDE[:4], '--blur', '944'))
        self.same(pictures.read_bytes('out.ppm'), limited)
        other = self.warns('--f-number: f/1.4 gives 344 pixels of blur, limited to 127, the most, '
                           'which f/3.79 has',
                           *self.render(*self.WIDE, '--f-number', '1.4', '--method', 'search'))
        self.assertEqual(other['blur'], 127)
        self.fails(2, '--blur: 127.5 pixels are more than 127, the most of view, serve and all methods '
                      'but sweep', *self.render('--blur', '127.5', '--method', 'raytrace'))
        self.assertEqual(self.warns(line, 'pull', 'photo.ppm', '--depth', 'depth.pgm', '-o',
                                    'p.y4m', '--seconds', '0.1', *self.WIDE, '--f-number',
                                    '0.5')['blur_from'], 'lens')
        sheet = self.warns(line, 'sheet', 'photo.ppm', '--depth', 'depth.pgm', '-o', 's.ppm',
                           '--focuses', '0', *self.WIDE, '--f-numbers', '0.5,8')
        self.assertEqual(sheet['cells'], ['focus 0  f/0.5102', 'focus 0  f/8'])
        for name in ('p.y4m', 's.ppm'):
            os.remove(name)

    def test_f_number_without_metres(self):
        """The default blur stands for f/2."""
        line = ('--f-number: depth.pgm says no distances in metres; f/%s gives %s pixels of '
                'blur%s, by the default of 1.0 at f/2; --near and --far give that of a lens')
        for number, words, limit in (('0.5', '3.8', ''), ('2', '1.0', ''), ('4', '0.5', ''),
                                     ('0.01', '192.0', ''), ('0.001', '1920.0',
                                      ', limited to 944, the most, which f/0.00203 has')):
            report = self.warns(line % (number, words, limit),
                                *self.render('--focus', '1', '--f-number', number))
            self.assertAlmostEqual(report['blur'], min(W / 50 * 2 / float(number), 944), 4)
            self.assertEqual(report['blur_from'], 'default')

    def gdepth(self, attributes):
        """photo.jpg with depth of six grey bars, dark = near, and what GFocus says."""
        pictures.png('bars.png', W, H, [bytes(40 * (x // 8) for x in range(W))] * H, colour=0)
        with open('bars.png', 'rb') as file:
            data = base64.b64encode(file.read()).decode()
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o',
                      'photo.jpg')
        pictures.insert_xmp('photo.jpg', 'GDepth:Format="RangeInverse" GDepth:Mime="image/png" '
                            'GDepth:Data="%s" %s' % (data, attributes))

    def test_the_focus_point_of_info(self):
        """A point half a pixel into row 7 and column 7 is in those, as render takes it."""
        self.gdepth('GDepth:Near="1" GDepth:Far="2" GFocus:FocalPointX="%r" '
                    'GFocus:FocalPointY="%r"' % (7.5 / W, 7.5 / H))
        self.assertIn('focus point   7,7\n', self.succeeds('info', 'photo.jpg'))
        for name in ('photo.jpg', 'bars.png'):
            os.remove(name)

    def test_f_number_by_the_files_own_blur(self):
        """Of Google's Lens Blur: a range without a unit, and BlurAtInfinity. By hand:
        K = 0.1 (1/20 - 1/100) 25 of 48 pixels = 4.8."""
        self.gdepth('GDepth:Near="20" GDepth:Far="100" GFocus:FocalDistance="25" '
                    'GFocus:FocalPointX="0.5" GFocus:FocalPointY="0.5" '
                    'GFocus:BlurAtInfinity="0.1"')
        command = ('render', 'photo.jpg', '-o', 'out.ppm')
        blurs = []
        for number, words in (('1.4', '6.9'), ('2', '4.8'), ('8', '1.2')):
            report = self.warns(
                '--f-number: photo.jpg says no distances in metres; f/%s gives %s pixels of '
                'blur, by the file\'s own of 4.8 at f/2; --near and --far give that of a lens' %
                (number, words), *command, '--f-number', number)
            self.assertEqual((report['blur_from'], report['depth']['near_m']), ('file', None))
            blurs.append(report['blur'])
        for blur, number in zip(blurs, (1.4, 2, 8)):
            self.assertAlmostEqual(blur, 9.6 / number, 4)
        report = self.reports(*command)  # without an option: as the phone showed it
        self.assertAlmostEqual(report['blur'], 4.8, 4)
        self.assertEqual((report['blur_from'], report['f_number']), ('file', None))
        self.fails(1, 'photo.jpg: --focus-distance needs distances in metres, which it does not '
                      'say; give --near and --far, or --focus or --focus-at in its place',
                   *command, '--focus-distance', '30')
        info = self.reports('info', 'photo.jpg')
        self.assertEqual(info['depth']['near_m'], None)
        self.assertAlmostEqual(info['own_blur'], 0.1)
        self.assertAlmostEqual(info['depth']['blur'], 4.8, 4)
        self.assertIn('render takes  4.8 pixels of blur: the blur that the file names',
                      self.succeeds('info', 'photo.jpg'))
        # --near and --far are metres, whatever the file meant
        lens = self.reports(*command, '--f-number', '8', '--focal-length', '50', '--near', '0.5',
                            '--far', '4')
        self.assertEqual(lens['blur_from'], 'lens')
        self.assertAlmostEqual(lens['blur'], 50 / 36 * W * (0.05 / 16) * (1 / 0.5 - 1 / 4), 5)
        # saved with its depth once more, the blur is the same
        self.succeeds('depth', 'photo.jpg', '-o', 'again.jpg')
        again = self.run_it('render', 'again.jpg', '-o', 'out.ppm', '--f-number', '2', '--json')
        self.assertAlmostEqual(json.loads(again.stdout)['blur'], 4.8, 3)
        for name in ('photo.jpg', 'again.jpg', 'bars.png', 'out.ppm'):
            os.remove(name)

    def dynamic(self, unsure):
        """photo.jpg with Dynamic Depth of half its size: near on the left, and in the middle of
        the right a square that is wrong, of which the confidence is `unsure`."""
        width, height = W // 2, H // 2
        wrong = [(x, y) for y in range(height // 3, 2 * height // 3)
                 for x in range(3 * width // 4 - 1, 3 * width // 4 + 2)]
        pictures.png('map.png', width, height, [
            bytes(255 * (x >= width // 2 and (x, y) not in wrong) for x in range(width))
            for y in range(height)], colour=0)
        pictures.png('sure.png', width, height, [
            bytes(unsure if (x, y) in wrong else 255 for x in range(width))
            for y in range(height)], colour=0)
        pictures.ppm('halves.ppm', W, H, lambda x, y: (200, 30, 30) if x < W / 2 else (30, 30, 200))
        self.succeeds('render', 'halves.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o',
                      'photo.jpg')
        pictures.insert_dynamic(
            'photo.jpg', 'DepthMap:Format="RangeInverse" DepthMap:Near="0.5" DepthMap:Far="4" '
            'DepthMap:Units="Meters" DepthMap:DepthURI="d" DepthMap:ConfidenceURI="c"',
            [(name, pictures.read_bytes(file)) for name, file in (('d', 'map.png'),
                                                                  ('c', 'sure.png'))])

    def test_dynamic_depth(self):
        """Read with its metres; samples that the file is unsure of are made of those around."""
        middle = []
        for unsure in (255, 0):
            self.dynamic(unsure)
            report = self.reports('render', 'photo.jpg', '-o', 'out.ppm', '--f-number', '2',
                                  '--focal-length', '50')
            self.assertEqual((report['depth']['source'], report['blur_from']),
                             ('dynamic-depth', 'lens'))
            self.assertAlmostEqual(report['depth']['near_m'], 0.5)
            self.assertAlmostEqual(report['depth']['far_m'], 4)
            self.succeeds('depth', 'photo.jpg', '--full', '-o', 'full.pgm')
            width, _, samples = pictures.read_pnm('full.pgm')
            middle.append(samples[H // 2 * width + 3 * W // 4])
        self.assertGreater(middle[0], 60000)
        self.assertLess(middle[1], 2000)
        self.assertIn('a picture behind the main one', self.succeeds('info', 'photo.jpg'))
        for name in ('photo.jpg', 'halves.ppm', 'map.png', 'sure.png', 'out.ppm', 'full.pgm'):
            os.remove(name)

    def test_portrait_sensor(self):
        """36 mm go with the larger side, whichever that is."""
        pictures.ppm('tall.ppm', H, W, lambda x, y: (x, y, 0))
        pictures.pgm('tall.pgm', H, W, lambda x, y: y)
        report = self.reports('render', 'tall.ppm', '--depth', 'tall.pgm', '-o', 'out.ppm',
                              '--near', '0.5', '--far', '4', '--f-number', '8',
                              '--focal-length', '50')
        self.assertAlmostEqual(report['blur'], 50 / 36 * W * (0.05 / 16) * (1 / 0.5 - 1 / 4), 5)

    def test_depth_units(self):
        def depth(file, unit, *more):
            return self.reports('render', 'photo.ppm', '--depth', file, '--depth-unit', unit,
                                '-o', 'out.ppm', *more)['depth']

        mm = depth('mm.pgm', 'mm')
        self.assertEqual((mm['meaning'], mm['unknown']), ('distance', 1))
        self.assertAlmostEqual(mm['near_m'], 0.5)
        self.assertAlmostEqual(mm['far_m'], 2)
        self.assertAlmostEqual(depth('mm.pgm', '5000/m')['near_m'], 0.1)
        self.assertAlmostEqual(depth('metres.pfm', 'm')['far_m'], 2)
        wider = depth('metres.pfm', 'm', '--near', '0.25', '--far', 'inf')
        self.assertEqual((wider['near_m'], wider['far_m'], wider['clamped']),
                         (0.25, 'infinity', 0))
        self.assertEqual(depth('metres.pfm', 'm', '--far', '1')['clamped'], W * H // 2)
        for unit in ('feet', '0/m', '-5/m', '/m', 'nan/m', '5000', 'MM'):
            self.fails(2, "--depth-unit: '%s' is not known; give disparity, disparity/16, inverse, mm, m or a "
                          "number per metre such as 5000/m" % unit,
                       *self.render('--depth-unit', unit))
        # Dark is near: the left half, sharp when 1 is in focus.
        self.succeeds(*self.render('--depth-unit', 'inverse', '--focus', '0.8', '--blur', '6'))
        self.assertEqual(pictures.read_pnm('out.ppm')[2][:30],
                         pictures.read_pnm('photo.ppm')[2][:30])


if __name__ == '__main__':
    unittest.main()
