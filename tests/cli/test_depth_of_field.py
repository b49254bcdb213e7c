#!/usr/bin/env python3
"""usage: test_depth_of_field.py REFOCUS  -- `info` tells the depth of field: by hand with metres, and
by what is rendered without."""
import base64
import os
import re
import struct
import unittest

import case
import pictures
from case import H, W

FOCAL_35MM = 28


@unittest.skipUnless('RF_XMP' in os.environ, 'needs libjpeg and libpng')
class DepthOfField(case.Case):
    def photo(self, name, attributes, exif=b''):
        """A photo with six grey bars of depth, dark = near: disparities 1, 0.843, ... 0.216."""
        pictures.png('bars.png', W, H, [bytes(40 * (x // 8) for x in range(W))] * H, colour=0)
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o', name)
        data = base64.b64encode(pictures.read_bytes('bars.png')).decode()
        pictures.insert_xmp(name, 'GDepth:Format="RangeInverse" GDepth:Mime="image/png" '
                            'GDepth:Data="%s" %s' % (data, attributes))
        if exif:
            whole = pictures.read_bytes(name)
            with open(name, 'wb') as file:
                file.write(whole[:2] + b'\xff\xe1' + struct.pack('>H', len(exif) + 2) + exif +
                           whole[2:])
        return name

    # the Exif IFD at 26 holds FocalLengthIn35mmFilm alone
    EXIF = (b'Exif\0\0MM\0*\0\0\0\x08\0\1\x87\x69\0\4\0\0\0\1\0\0\0\x1a\0\0\0\0'
            b'\0\1\xa4\x05\0\3\0\0\0\1\0' + bytes([FOCAL_35MM]) + b'\0\0\0\0\0\0')

    def setUp(self):
        metric = 'GDepth:Near="0.5" GDepth:Far="4" GDepth:Units="m"'
        self.metric = self.photo('metric.jpg', metric)
        self.phone = self.photo('phone.jpg', metric, self.EXIF)
        self.plain = self.photo('plain.jpg', 'GDepth:Near="20" GDepth:Far="100"')

    def field(self, *arguments):
        return self.reports('info', *arguments)['depth_of_field']

    LENS = ('--f-number', '8', '--focal-length', '50')

    def test_by_hand(self):
        """H = 1000 * 0.05 / 8 = 6.25 m; 1 / (1 + 1 / H), 1 / (1 - 1 / H)."""
        field = self.field(self.metric, *self.LENS, '--focus-distance', '1')
        for name, value in (('hyperfocal_m', 6.25), ('focus_m', 1), ('near_m', 6.25 / 7.25),
                            ('far_m', 6.25 / 5.25), ('f_number', 8), ('focal_length_mm', 50),
                            ('focus', 3 / 7), ('sharp_px', 50 / 36 * W / 2000)):
            self.assertAlmostEqual(field[name], value, 6, name)
        text = self.succeeds('info', self.metric, *self.LENS, '--focus-distance', '1')
        self.assertIn('sharp         0.8621 m to 1.19 m, the depth of field about 1 m\n', text)
        self.assertIn('hyperfocal    6.25 m, by 50 mm at f/8\n', text)
        # beyond the hyperfocal distance all is sharp from half of it, or less, on
        field = self.field(self.metric, *self.LENS, '--far', 'inf', '--focus', '0')
        self.assertEqual([field[n] for n in ('focus_m', 'near_m', 'far_m')],
                         ['infinity', 6.25, 'infinity'])
        self.assertIn('sharp         6.25 m and beyond, the depth of field about infinity\n',
                      self.succeeds('info', self.metric, *self.LENS, '--far', 'inf', '--focus', '0'))

    def test_metres_and_disparities_say_the_same(self):
        for more in (), ('--focus', '0.5'), ('--blur', '3'), self.LENS, ('--focus-at', '40,3'):
            field = self.field(self.metric, *more)
            for metres, disparity in (('near_m', 'nearest'), ('far_m', 'farthest')):
                if 0 < field[disparity] < 1:
                    self.assertAlmostEqual(field[disparity],
                                           (1 / field[metres] - 1 / 4) / (1 / 0.5 - 1 / 4), 6)
                    self.assertAlmostEqual(field['blur'] * abs(field[disparity] - field['focus']),
                                           field['sharp_px'], 6)

    def test_as_rendered(self):
        """Focus and blur are those of `render`, by the same options and without any."""
        for name in self.metric, self.phone, self.plain:
            for more in (), ('--focus-at', '2,2'), ('--focus-rectangle', '30,4,9,9'), ('--blur', '7'):
                field = self.field(name, *more)
                rendered = self.reports('render', name, '-o', 'out.ppm', *more)
                self.assertAlmostEqual(field['blur'], rendered['blur'], 5)
                self.assertAlmostEqual(field['focus'], rendered['focus'], 3)

    def test_a_simulated_f_number_is_limited(self):
        """f/0.5 has 28 / 36 * 48 * 0.028 * (1 / 0.005 - 1 / 4) = 208.8 pixels of blur; those of 127,
        the most without an option, have an f-number that is as much greater."""
        name = self.photo('limited.jpg', 'GDepth:Near="0.005" GDepth:Far="4" GDepth:Units="m" xmlns:'
                          'Refocus="urn:librefocus:edit:1.0/" Refocus:SimulatedFNumber="0.5"', self.EXIF)
        self.assertEqual(self.reports('info', name)['simulated_f_number'], 0.5)
        report = self.reports('render', name, '-o', 'out.ppm')
        self.assertEqual((report['blur'], report['blur_from']), (127, 'file'))
        self.assertAlmostEqual(report['f_number'], 0.5 * 208.8 / 127, 2)
        self.assertIn('127.0 pixels of blur: the f/0.822 that its phone simulates\n',
                      self.succeeds('info', name))
        os.remove(name)

    def test_focal_length_of_the_file(self):
        field = self.field(self.phone, '--f-number', '2', '--focus', '0.5')
        self.assertAlmostEqual(field['hyperfocal_m'], FOCAL_35MM / 2, 5)
        self.assertAlmostEqual(field['f_number'], 2, 6)
        self.assertIn(', by 28 mm in 35 mm terms at f/2\n',
                      self.succeeds('info', self.phone, '--f-number', '2'))
        self.assertIn(', by 43.27 mm, as a normal lens has, at f/', self.succeeds('info', self.metric))

    def test_without_metres(self):
        """The eye resolves 1/1000 of the diagonal, the distance of a normal lens."""
        field = self.field(self.plain, '--blur', '3', '--focus', '0.5')
        reach = (W * W + H * H) ** 0.5 / 2000 / 3
        self.assertAlmostEqual(field['nearest'], 0.5 + reach, 6)
        self.assertAlmostEqual(field['farthest'], 0.5 - reach, 6)
        for name in 'focus_m', 'near_m', 'far_m', 'hyperfocal_m', 'f_number':
            self.assertIsNone(field[name])
        text = self.succeeds('info', self.plain, '--blur', '3', '--focus', '0.5')
        self.assertIn('sharp         disparities %.3f to %.3f, the depth of field about 0.500 by 3.0 '
                      'pixels of blur\n' % (0.5 - reach, 0.5 + reach), text)
        self.assertNotIn('hyperfocal', text)
        metric = self.field(self.plain, '--near', '0.5', '--far', '4', *self.LENS)
        self.assertAlmostEqual(metric['hyperfocal_m'], 6.25, 6)

    def test_no_blur_and_no_depth(self):
        field = self.field(self.metric, '--blur', '0')
        self.assertEqual((field['nearest'], field['farthest'], field['near_m']), (1, 0, None))
        self.assertIn('sharp         everything, for there is no blur\n',
                      self.succeeds('info', self.metric, '--blur', '0'))
        for name in 'photo.ppm', 'mm.pgm':
            self.assertIsNone(self.field(name))
            self.fails(1, '%s: it is no photo with depth, so that it has no depth of field; leave '
                       'focus and blur out' % name, 'info', name, '--focus', '0.5')

    def test_what_is_refused(self):
        info = ('info', self.metric)
        self.fails(2, 'metric.jpg: near 4 m is not nearer than far 4 m; give --near and --far', *info,
                   '--near', '4')
        self.fails(2, re.compile('--near: 5 m is not nearer than --far 2 m'), *info, '--near', '5',
                   '--far', '2')
        self.fails(2, re.compile('--focus-at: the focus is given twice'), *info, '--focus', '1',
                   '--focus-at', '3,4')
        self.fails(2, '--focus-at: 48,4 lies outside of metric.jpg; give 0,0 to 47,31', *info,
                   '--focus-at', '48,4')
        self.fails(2, re.compile('--focus-distance: 9 m lies outside'), *info, '--focus-distance', '9')
        self.fails(1, 'plain.jpg: --focal-length needs distances in metres, which it does not say; '
                   'give --near and --far, or leave it out', 'info', self.plain, *self.LENS)
        self.warns('--f-number: metric.jpg says no focal length; f/4 gives 0.5 pixels of blur, by the '
                   'default of 1.0 at f/2; --focal-length gives that of a lens', *info, '--f-number',
                   '4')


if __name__ == '__main__':
    unittest.main()
