#!/usr/bin/env python3
"""Focus beyond a plain lens and bokeh, from the command line: every option at and beyond its limits, and
what equals a plain setting against it. Usage: test_controls.py REFOCUS [unittest arguments]"""
import os
import re
import unittest

import pictures
from case import Case, H, W


class Controls(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        pictures.pgm('ramp.pgm', W, H, lambda x, y: (x * 5 + y) & 255)
        pictures.pgm('slope.pgm', W, H, lambda x, y: 40 + 4 * x)
        pictures.pgm('level.pgm', 3, 2, lambda x, y: 51)
        pictures.pgm('black.pgm', 7, 5, lambda x, y: 0)
        pictures.pgm('white.pgm', 1, 1, lambda x, y: 255)

    def picture(self, *arguments):
        self.succeeds(*self.render('--blur', '6', *arguments))
        with open('out.ppm', 'rb') as file:
            return file.read()

    def check(self, option, good, bad, what, *more):
        for value in good:
            self.succeeds(*self.render(option, value, *more))
        os.remove('out.ppm')
        for value in bad:
            self.fails(2, "%s: '%s' cannot be used; give %s" % (option, value, what),
                       *self.render(option, value, *more))


class OfThePhoto(Controls):
    """What single methods take of the photo where no option says it."""
    def of(self, depth, *arguments):
        self.succeeds('render', 'photo.ppm', '--depth', depth, '-o', 'out.ppm', '--blur', '6', *arguments)
        return pictures.read_bytes('out.ppm')

    def test_scatter_counts_all_depths_the_same(self):
        """1 / z^2 where it is asked for alone, be the depth in metres or not."""
        for depth in (('metres.pfm', '--depth-unit', 'm'), ('depth.pgm', '--near', '0.5', '--far', '5')):
            scatter = (*depth, '--method', 'scatter', '--focus', '0.4')
            unweighted = self.of(*scatter)
            self.same(unweighted, self.of(*scatter, '--depth-ratio', '1'))
            self.differs(unweighted, self.of(*scatter, '--depth-ratio', '4'))
        scores = self.reports('compare', 'photo.ppm', '--depth', 'metres.pfm', '--depth-unit', 'm',
                              '--reference', 'out.ppm', '--blur', '6', '--focus', '0.4', '--methods',
                              'scatter,scatter:depth-ratio=1,scatter:depth-ratio=4')['methods']
        self.assertEqual(scores[1]['rmse'], scores[2]['rmse'])
        self.assertNotEqual(scores[1]['rmse'], scores[3]['rmse'])

    def test_attention_follows_the_focus(self):
        """What is focused on is what is looked at, unless it is said."""
        foveated = ('--method', 'foveated', '--attention-angle', '8')
        at = self.of('ramp.pgm', *foveated, '--focus-at', '36,9')
        focus = str(self.reports('render', 'photo.ppm', '--depth', 'ramp.pgm', '-o', 'out.ppm',
                                 '--focus-at', '36,9')['focus'])
        self.same(at, self.of('ramp.pgm', *foveated, '--focus', focus, '--attention', '36,9'))
        middle = self.of('ramp.pgm', *foveated, '--focus', focus)
        self.differs(at, middle)
        self.same(self.of('ramp.pgm', *foveated, '--focus-at', '36,9', '--attention', '3,3'),
                  self.of('ramp.pgm', *foveated, '--focus', focus, '--attention', '3,3'))
        rectangle = ('--focus-rectangle', '30,4,13,11')
        focus = str(self.reports('render', 'photo.ppm', '--depth', 'ramp.pgm', '-o', 'out.ppm',
                                 *rectangle)['focus'])
        self.same(self.of('ramp.pgm', *foveated, *rectangle),
                  self.of('ramp.pgm', *foveated, '--focus', focus, '--attention', '36,9'))


class Limits(Controls):
    def test_numbers(self):
        nonsense = ['x', '1x', '0x1', 'nan', ' 1', '1,5', '-', 'inf']
        for option in ('--focus-width', '--focus-transition', '--tilt-compress', '--far-clamp',
                       '--near-clamp'):
            self.check(option, ['0', '1', '0.25'], ['-0.001', '1.001'] + nonsense,
                       'a number from 0 to 1')
        self.check('--tilt-angle', ['-89', '0', '89'], ['-90', '90'] + nonsense,
                   'a number from -89 to 89')
        self.check('--blur-limit', ['0', '127', '944'], ['-1', '944.1'] + nonsense,
                   'a number from 0 to 944')

    def test_places(self):
        self.check('--focus-plane', ['0,0,47,0,0,31'],
                   ['0,0,47,0,0', '1,2,3,4,5,6,7', '-1,0,1,1,2,9', '0,0,1.5,1,3,9', 'x'],
                   'X,Y,X,Y,X,Y from 0 to 65534')
        self.check('--tilt-line', ['0,0,47,31', '5,9,5,3'],
                   ['0,0,47', '1,2,3,4,5', '-1,0,1,1', '70000,0,1,1'],
                   'X,Y,X,Y from 0 to 65534', '--tilt-angle', '10')
        self.check('--focus-rectangle', ['0,0,48,32', '47,31,1,1'],
                   ['0,0,1', '-1,0,1,1', '1,1,1,1,1'], 'X,Y,W,H from 0 to 65535')
        for rectangle in ('0,0,49,1', '48,0,1,1', '0,0,0,5'):
            self.fails(2, '--focus-rectangle: %s does not lie within the 48x32 pixels of '
                          'photo.ppm' % rectangle,
                       *self.render('--focus-rectangle', rectangle))
        for option, value, at, more in (('--focus-plane', '0,0,48,0,0,31', '48,0', ()),
                                        ('--tilt-line', '0,0,0,32', '0,32',
                                         ('--tilt-angle', '9'))):
            self.fails(2, '%s: %s lies outside of the picture; give 0,0 to 47,31' % (option, at),
                       *self.render(option, value, *more))
        self.fails(2, '--focus-plane: the three pixels lie on one line, or nearly; give others',
                   *self.render('--focus-plane', '0,0,1,1,2,2'))
        self.fails(2, '--tilt-line: both its ends are at one pixel; give two',
                   *self.render('--tilt-line', '4,4,4,4', '--tilt-angle', '9'))

    def test_bands(self):
        most = ','.join(['0.5'] * 15)
        self.check('--also-focus', ['0', '1', '0.2,0.9', '0.2:0.1,0.9:0:1', most],
                   ['x', '1.1', '-0.1', '0.2:', '0.2:2', '0.2:0.1:-1', '0.2:0.1:0.1:0.1', '0.2,',
                    ',0.2', '0.2;0.3', 'nan', '0x1', most + ',0.5'],
                   'up to 15 bands D, D:W or D:W:T with commas, each number from 0 to 1')

    def test_what_excludes_what(self):
        self.fails(2, '--focus-plane: the focus is given twice; leave --focus-plane or the other '
                      '--focus... out',
                   *self.render('--focus-plane', '0,0,9,0,0,9', '--focus', '1'))
        self.fails(2, '--focus-plane: the plane is given twice; give --focus-plane, or '
                      '--tilt-angle and --tilt-line',
                   *self.render('--focus-plane', '0,0,9,0,0,9', '--tilt-angle', '1'))
        self.fails(2, '--tilt-line: it goes with --tilt-angle; give that too',
                   *self.render('--tilt-line', '0,0,9,0'))
        self.fails(2, '--far-clamp: 0.6 is nearer than --near-clamp 0.5; give a number from 0 to '
                      '0.5', *self.render('--far-clamp', '0.6', '--near-clamp', '0.5'))
        self.fails(2, re.compile('^refocus: --focus-rectangle: the focus is given twice; '),
                   *self.render('--focus-rectangle', '0,0,9,9', '--focus', '1'))
        for method in ('raytrace', 'scatter', 'lightfield'):
            self.fails(2, re.compile('^refocus: --method: %s knows the focus of a plain lens only; '
                                     r'give sweep, search, blur(, \w+)* or \w+$' % method),
                       *self.render('--method', method, '--far-clamp', '0.3'))

    def test_maps(self):
        for option in ('--focus-map', '--sharp-mask'):
            self.succeeds(*self.render(option, 'level.pgm'))
            os.remove('out.ppm')
            self.fails(1, re.compile('^refocus: missing.png: '),
                       *self.render(option, 'missing.png'))
            self.fails(2, '%s: is empty; give FILE' % option, *self.render(option, ''))


class Results(Controls):
    def test_equal_to_a_plain_lens(self):
        plain = self.picture('--focus', '0.2')
        for same in (('--focus', '0.2', '--tilt-angle', '0', '--tilt-line', '3,5,40,9'),
                     ('--focus', '0.7', '--focus-map', 'level.pgm'),
                     ('--focus', '0.2', '--sharp-mask', 'black.pgm'),
                     ('--focus', '0.2', '--focus-width', '0', '--focus-transition', '0.3'),
                     ('--focus-plane', '1,1,20,2,5,30'),
                     ('--focus', '0.2', '--field', 'plane', '--field-angle', '90',
                      '--field-radius', '0', '--field-falloff', '1'),
                     ('--focus', '0.2', '--blur-limit', '6', '--far-clamp', '0')):
            self.same(self.picture(*same), plain, same)

    def test_each_does_something(self):
        plain = self.picture('--focus', '0.6')
        for other in (('--focus-width', '0.3'), ('--also-focus', '0.2'), ('--tilt-angle', '30'),
                      ('--tilt-compress', '0.5'), ('--focus-map', 'ramp.pgm'),
                      ('--sharp-mask', 'ramp.pgm'), ('--far-clamp', '0.4'),
                      ('--near-clamp', '0.8'), ('--blur-limit', '1')):
            self.differs(self.picture('--focus', '0.6', *other), plain, other)

    def test_all_sharp(self):
        with open('photo.ppm', 'rb') as file:
            photo = file.read()
        for sharp in (('--sharp-mask', 'white.pgm'), ('--blur-limit', '0'),
                      ('--focus', '0.6', '--focus-width', '0.5'),
                      ('--focus', '1', '--also-focus', '0.2'),
                      ('--focus', '0.2', '--near-clamp', '0.2'),
                      ('--tilt-compress', '1')):
            self.same(self.picture(*sharp), photo, sharp)

    def test_rectangle(self):
        def focus(rectangle):
            return self.reports(*self.render('--focus-rectangle', rectangle))['focus']

        self.assertAlmostEqual(focus('0,0,48,32'), 1, 4)
        self.assertAlmostEqual(focus('0,0,28,32'), 0.2, 4)
        self.assertAlmostEqual(focus('24,0,1,1'), 1, 4)

    def test_plane_of_three(self):
        """A plane through a slope keeps all of it sharp."""
        with open('photo.ppm', 'rb') as file:
            photo = file.read()
        self.succeeds('render', 'photo.ppm', '--depth', 'slope.pgm', '-o', 'out.ppm', '--blur',
                      '20', '--focus-plane', '4,4,40,5,20,28')
        with open('out.ppm', 'rb') as file:
            self.same(file.read(), photo)


class Bokeh(Controls):
    PRESETS = ('plain', 'classic', 'smooth', 'bubble', 'ring', 'swirl', 'cine', 'vintage',
               'heart', 'star', 'sparkle')

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        pictures.ppm('photo.ppm', W, H, lambda x, y: (255, 255, 250)
                     if x % 16 < 3 and y % 16 < 3 else (20 + x % 5 * 3, 15 + y % 3 * 4, 20))

    def test_numbers(self):
        nonsense = ['x', '1x', 'nan', ' 1', '1,5', '-', 'inf']
        self.check('--curvature', ['0', '1'], ['-0.1', '1.1'] + nonsense,
                   'a number from 0 to 1', '--aperture', 'polygon:5')
        self.check('--squeeze', ['0.5', '2'], ['0.49', '2.01'] + nonsense,
                   'a number from 0.5 to 2')
        self.check('--ring', ['0', '0.9'], ['-0.1', '0.91'] + nonsense, 'a number from 0 to 0.9')
        for option in ('--edge', '--edge-before'):
            self.check(option, ['-1', '0', '1'], ['-1.1', '1.1'] + nonsense,
                       'a number from -1 to 1')
        self.check('--cat-eye', ['0', '0.9'], ['-0.1', '0.91'] + nonsense,
                   'a number from 0 to 0.9')
        self.check('--fringe', ['-0.5', '0.5'], ['-0.51', '0.51'] + nonsense,
                   'a number from -0.5 to 0.5')
        self.check('--grain', ['0', '4', 'off'], ['-0.1', '4.1'] + nonsense,
                   "a number from 0 to 4, or 'off'")
        self.check('--highlight-stops', ['0', '4', '2.5'], ['-1', '4.1'] + nonsense,
                   'a number from 0 to 4')
        self.check('--highlights', ['1', '16', 'off', 'auto'], ['0', '0.9', '16.1'] + nonsense,
                   "a number from 1 to 16, or 'off', or 'auto'")
        self.check('--open-f-number', ['0.1', '2'], ['0', '-1', '1001'] + nonsense,
                   'a number above 0, at most 1000', '--f-number', '2', '--near', '1', '--far',
                   '2', '--focal-length', '50', '--aperture', 'polygon:6')

    def test_shapes(self):
        for shape in ('heart', 'star', 'star:3', 'star:16'):
            self.succeeds(*self.render('--aperture', shape))
        os.remove('out.ppm')
        for shape in ('star:2', 'star:17', 'star:', 'star:x', 'star:5:1'):
            self.fails(2, "--aperture: '%s' cannot be used; give star, or star:POINTS with 3 to "
                          "16 points" % shape, *self.render('--aperture', shape))

    def test_what_excludes_what(self):
        for option in (('--curvature', '0.5'), ('--open-f-number', '2', '--f-number', '4')):
            self.fails(2, '%s: it needs blades; give --aperture polygon:BLADES too' % option[0],
                       *self.render(*option))
        self.fails(2, '--open-f-number: it goes with --f-number; give that too',
                   *self.render('--open-f-number', '2', '--aperture', 'polygon:6'))
        self.fails(2, '--open-f-number: f/2 is wider than that; give a number above 0, at most 2',
                   *self.render('--open-f-number', '4', '--f-number', '2', '--aperture',
                                'polygon:6'))
        self.fails(2, '--highlight-stops: the light of highlights is given twice; give --highlights '
                      'or --highlight-stops',
                   *self.render('--highlight-stops', '2', '--highlights', '2'))
        for option in (('--cat-eye', '0.2'), ('--fringe', '0.1'), ('--edge', '0.5')):
            self.fails(2, '%s: it does not go with --method search; give sweep, or leave it out' %
                       option[0], *self.render(*option, '--method', 'search'))
        self.fails(2, "--rays: 'full' does not go with discs that differ before and behind the "
                      "focus; give a whole number from 1 to 1024",
                   *self.render('--edge', '0.5', '--rays', 'full'))
        self.fails(2, "--aperture: 'such a disc' does not go with --method scatter, which knows "
                      "a disc alone; leave one of them out",
                   *self.render('--squeeze', '0.5', '--method', 'scatter'))
        self.fails(2, re.compile("^refocus: --bokeh: 'hart' is not one of plain, .*; did you mean "
                                 "'heart'\\?"), *self.render('--bokeh', 'hart'))

    def test_presets(self):
        seen = {}
        for name in self.PRESETS:
            picture = self.picture('--focus', '1', '--bokeh', name)
            self.assertNotIn(picture, seen.values(), name)
            seen[name] = picture
        self.same(self.picture('--focus', '1'), seen['plain'])
        self.same(self.picture('--focus', '1', '--aperture', 'heart'), seen['heart'])
        self.same(self.picture('--focus', '1', '--bokeh', 'bubble', '--edge', '0', '--cat-eye',
                               '0'), seen['plain'])
        self.same(self.picture('--focus', '1', '--bokeh', 'ring', '--aperture', 'heart',
                               '--ring', '0'), seen['heart'])

    def test_off_is_nothing(self):
        plain = self.picture('--focus', '1')
        for off in (('--squeeze', '1'), ('--ring', '0'), ('--edge', '0'), ('--cat-eye', '0'),
                    ('--fringe', '0'), ('--grain', '0'), ('--star', '0')):
            self.same(self.picture('--focus', '1', *off), plain, off)

    def test_iris(self):
        lens = ('--near', '1', '--far', '2', '--focal-length', '300', '--f-number', '4',
                '--focus', '1')

        def through(*more):
            self.succeeds(*self.render(*lens, *more))
            with open('out.ppm', 'rb') as file:
                return file.read()

        six = ('--aperture', 'polygon:6:10')
        self.same(through(*six, '--open-f-number', '4'), through())
        self.differs(through(*six, '--open-f-number', '3.8'), through(*six))
        self.assertEqual(self.reports(*self.render('--highlight-stops', '3'))['highlights'], 8)


if __name__ == '__main__':
    unittest.main()
