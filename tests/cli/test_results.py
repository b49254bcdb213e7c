#!/usr/bin/env python3
"""The refocus command: the pictures and reports that its options make, of `render`,
`compare` and `bench`. Usage: test_results.py REFOCUS [unittest arguments]"""
import base64
import json
import os
import re
import struct
import unittest

import pictures
from case import Case, H, REFOCUS, W
from names import cpu_names, method_names

METHODS = method_names(REFOCUS)


class Results(Case):
    def test_report(self):
        report = self.reports(*self.render('--focus', '0.25', '--blur', '4', '--threads', '2',
                                           '--repeat', '3'))
        for key, value in {'width': W, 'height': H, 'method': 'sweep', 'rays': 64,
                           'blur': 4.0, 'focus': 0.25, 'threads': 2,
                           'output': 'out.ppm'}.items():
            self.assertEqual(report[key], value, key)
        times = report['render_ms']
        self.assertTrue(0 < times['min'] <= times['median'] <= times['max'])
        self.assertGreater(report['prepare_ms'], 0)
        self.assertGreater(report['peak_rss_kib'], 500)
        self.assertIn(report['cpu'], cpu_names(REFOCUS)[1:])
        depth = report['depth']
        self.assertEqual((depth['unknown'], depth['clamped'], depth['near_m'], depth['far_m'],
                          depth['width'], depth['height']), (0, 0, None, None, W, H))
        for quality, rays in (('preview', 32), ('standard', 64), ('best', 128)):
            self.assertEqual(self.reports(*self.render('--quality', quality))['rays'], rays)
        self.assertEqual(self.reports(*self.render('--quality', 'best', '--rays', '7'))['rays'],
                         7)
        self.assertEqual(self.reports(*self.render('--rays', 'full', '--blur', '3'))['rays'],
                         'full')
        text = self.succeeds(*self.render('--repeat', '2'))
        self.assertRegex(text, r'^prepare [\d.]+ ms, render [\d.]+ ms \(median of 2; ')
        self.assertEqual(self.succeeds(*self.render()), '')

    def test_gain_map(self):
        """A highlight has the light of the map where it is blurred; what is sharp stays."""
        width, height, bright = 96, 64, range(40, 48)
        lit = lambda x, y: x in bright and y - 16 in range(8, 16)
        pictures.ppm('dim.ppm', width, height, lambda x, y: (255 if lit(x, y) else 90,) * 3)
        pictures.ppm('gains.ppm', width, height, lambda x, y: (255 if lit(x, y) else 0,) * 3)
        pictures.pgm('flat.pgm', width, height, lambda x, y: 51)
        sharp = '--depth', 'flat.pgm', '--focus', '0.2', '--blur', '20', '--highlights', 'off'
        blurred = '--depth', 'flat.pgm', '--focus', '1', '--blur', '20', '--highlights', 'off'
        for name in 'dim', 'gains':
            self.succeeds('render', name + '.ppm', *sharp, '-o', name + '.jpg')
        pictures.ultra_hdr('hdr.jpg', 'dim.jpg', 'gains.jpg', 3)
        for photo, use, more in (('hdr.jpg', True, ()), ('hdr.jpg', False, ('--gain-map', 'ignore')),
                                 ('dim.jpg', False, ())):
            report = self.reports('render', photo, *blurred, '-o', 'out.pfm', *more)
            self.assertEqual(report['gain_map'], use)
            values = pictures.read_pfm('out.pfm')[2]
            around = values[0]
            light = sum(v - around for v in values[1::3])
            self.assertAlmostEqual(light / (64 * ((8.11 if use else 1) - around)), 1, delta=0.05)
        self.succeeds('render', 'hdr.jpg', *sharp, '-o', 'sharp.png')
        self.succeeds('render', 'dim.jpg', *sharp, '-o', 'base.png')
        self.same(pictures.read_bytes('sharp.png'), pictures.read_bytes('base.png'))
        self.succeeds('render', 'hdr.jpg', *blurred, '-o', 'whole.ppm')
        self.succeeds('render', 'hdr.jpg', *blurred, '-o', 'part.ppm', '--region', '30,20,40,30')
        whole, part = (pictures.read_pnm(name)[2] for name in ('whole.ppm', 'part.ppm'))
        for y in range(30):
            at = 3 * ((20 + y) * width + 30)
            # dither counts rows and columns of the photo, not of the region
            self.same(part[3 * 40 * y:3 * 40 * (y + 1)], whole[at:at + 3 * 40])
        self.assertGreater(whole[3 * (28 * width + 44)], 170)
        self.succeeds('render', 'hdr.jpg', *blurred, '-o', 'round.ppm', '--no-dither')
        rounded = pictures.read_pnm('round.ppm')[2]
        self.assertLessEqual(max(abs(a - b) for a, b in zip(whole, rounded)), 1)
        self.differs(whole, rounded)
        pictures.pfm_colour('slope.pfm', width, height, lambda x, y: (0.2 + x / 10000,) * 3)
        for more, fewest, most in (('--no-dither',), 1, 3), ((), 20, 96):
            self.succeeds('render', 'slope.pfm', *blurred, '-o', 'slope.ppm', *more)
            row = pictures.read_pnm('slope.ppm')[2][:3 * width:3]
            changes = sum(a != b for a, b in zip(row, row[1:]))
            self.assertTrue(fewest <= changes <= most, (more, changes))
        for name, out in ('sheet', 'out.ppm'), ('pull', 'f%d.ppm'):
            more = ('--seconds', '0.05') if name == 'pull' else ()
            options = [o for o in blurred if o not in ('--focus', '1')]
            self.succeeds(name, 'hdr.jpg', *options, '-o', out, *more)
            own = 'out.ppm' if name == 'sheet' else 'f1.ppm'
            used = pictures.read_bytes(own)
            self.succeeds(name, 'hdr.jpg', *options, '-o', out, *more, '--gain-map', 'ignore')
            self.differs(used, pictures.read_bytes(own))
        scores = [self.reports('compare', 'hdr.jpg', *blurred, '--reference', 'whole.ppm',
                               '--methods', methods)['methods'][-1]['rmse']
                  for methods in ('sweep', 'sweep,blur')]
        self.assertEqual(scores[0], 0)
        self.fails(2, re.compile('^refocus: --gain-map: '), 'render', 'hdr.jpg', *blurred, '-o',
                   'out.ppm', '--gain-map', 'perhaps')

    def test_depth_edges(self):
        """A soft map is parted where the photo's edge is; an exact one stays, to the byte."""
        width, height, edge = 96, 64, 45
        pictures.ppm('edged.ppm', width, height, lambda x, y: (
            (180, 140 + (x * 7 ^ y * 5) % 23, 60) if x < edge else (40, 70, 90 + x * y % 19)))
        pictures.pgm('exact.pgm', width, height, lambda x, y: 200 if x < edge else 40)
        pictures.pgm('soft.pgm', width, height,
                     lambda x, y: 40 + 16 * min(max(edge + 5 - x, 0), 10))
        for depth, parted in ('exact.pgm', False), ('soft.pgm', True):
            command = ('render', 'edged.ppm', '--depth', depth, '--focus', '1', '--blur', '6')
            given = self.reports(*command, '-o', 'given.ppm', '--depth-edges', 'as-given')
            edges = self.reports(*command, '-o', 'auto.ppm', '--depth-edges', 'auto')['edges']
            self.succeeds(*command, '-o', 'default.ppm')
            picture = pictures.read_bytes('auto.ppm')
            self.same(picture, pictures.read_bytes('default.ppm'))
            (self.differs if parted else self.same)(picture, pictures.read_bytes('given.ppm'))
            self.assertIsNone(given['edges'])
            self.assertEqual(set(edges), {'softness_px', 'on_photo', 'grown_px', 'shift_x_px',
                                          'shift_y_px', 'bent', 'parted', 'changed', 'noise'})
            self.assertEqual((edges['grown_px'], edges['shift_x_px'], edges['shift_y_px'],
                              edges['bent'], edges['parted']), (0, 0, 0, False, parted))
            self.assertEqual((edges['softness_px'] > 1.25, edges['changed'] > 0.05),
                             (parted, parted))

    def test_matte(self):
        """A soft silhouette in focus stays soft by its matte, of any size and depth of samples."""
        width, height, edge = 96, 64, 45
        cover = [max(0, min(255, 51 * (edge + 2 - x))) for x in range(width)]
        pictures.ppm('mixed.ppm', width, height, lambda x, y: tuple(
            (a * cover[x] + b * (255 - cover[x])) // 255
            for a, b in ((200, 30 + 9 * (y % 8)), (150, 40), (60, 120 + 9 * (x % 8)))))
        pictures.pgm('map.pgm', width, height, lambda x, y: 200 if cover[x] > 127 else 40)
        pictures.pgm('matte.pgm', width, height, lambda x, y: cover[x])
        pictures.pgm('deep.pgm', width, height, lambda x, y: 257 * cover[x], 65535)
        pictures.pgm('none.pgm', width, height, lambda x, y: 0)
        pictures.pgm('tall.pgm', 40, 90, lambda x, y: 0)
        command = ('mixed.ppm', '--depth', 'map.pgm', '--focus', '0.784', '--blur', '12')
        without = self.reports('render', *command, '-o', 'without.ppm')
        report = self.reports('render', *command, '-o', 'with.ppm', '--matte', 'matte.pgm')['matte']
        self.assertIsNone(without['matte'])
        self.assertEqual((report['file'], report['width'], report['height']), ('matte.pgm', 96, 64))
        self.assertAlmostEqual(report['mixed'], 4 / 96)
        self.differs(pictures.read_bytes('with.ppm'), pictures.read_bytes('without.ppm'))
        for matte, same in ('deep.pgm', 'with.ppm'), ('none.pgm', 'without.ppm'):
            self.succeeds('render', *command, '-o', 'other.ppm', '--matte', matte)
            self.same(pictures.read_bytes('other.ppm'), pictures.read_bytes(same))
        self.succeeds('render', *command, '-o', 'other.ppm', '--matte', 'matte.pgm', '--no-thin')
        self.same(pictures.read_bytes('other.ppm'), pictures.read_bytes('with.ppm'))
        scores = [self.reports('compare', *command, '--reference', 'with.ppm', '--methods', 'sweep',
                               *matte)['methods'][-1]['rmse'] for matte in ((), ('--matte', 'matte.pgm'))]
        self.assertEqual((scores[0] > 0, scores[1]), (True, 0))
        for name, more in ('sheet', ()), ('pull', ('--to', '0.2', '--seconds', '0.2')):
            focus = () if name == 'sheet' else ('--from', '0.784')
            options = tuple(o for o in command if o not in ('--focus', '0.784')) + focus + more
            ending = '.ppm' if name == 'sheet' else '.y4m'
            for matte in (), ('--matte', 'matte.pgm'):
                self.succeeds(name, *options, '-o', 'p%d%s' % (len(matte), ending), *matte)
            self.differs(pictures.read_bytes('p0' + ending), pictures.read_bytes('p2' + ending))
        self.fails(1, re.compile('^refocus: tall.pgm: its 40x90 samples have another shape'), 'render',
                   *command, '-o', 'out.ppm', '--matte', 'tall.pgm')
        self.fails(1, re.compile('^refocus: absent.pgm: '), 'render', *command, '-o', 'out.ppm',
                   '--matte', 'absent.pgm')
        self.fails(2, re.compile('^refocus: matte.pgm: '), 'render', *command, '-o', 'matte.pgm',
                   '--matte', 'matte.pgm')
    def test_matte_of_the_photo(self):
        """An iPhone's portrait matte is used like a file, and left out on demand."""
        width, height = 96, 64
        cover = [max(0, min(255, 51 * (47 - x))) for x in range(width)]
        for name, pixel in (('mixed', lambda x, y: (200 * cover[x] // 255, 9 * (y % 8), 90)),
                            ('matte', lambda x, y: 3 * (cover[x],))):
            pictures.ppm(name + '.ppm', width, height, pixel)
            pictures.pgm('map.pgm', width, height, lambda x, y: 200 if cover[x] > 127 else 40)
            self.succeeds('render', name + '.ppm', '--depth', 'map.pgm', '--blur', '0', '-o',
                          name + '.jpg')
        pictures.insert_xmp('matte.jpg', 'xmlns:a="http://ns.apple.com/pixeldatainfo/1.0/" '
                            'a:AuxiliaryImageType="urn:com:apple:photo:2018:aux:'
                            'portraiteffectsmatte"')
        command = ('mixed.jpg', '--depth', 'map.pgm', '--focus', '0.784', '--blur', '12')
        self.succeeds('render', *command, '-o', 'file.ppm', '--matte', 'matte.jpg')
        pictures.insert_mpf('mixed.jpg', [pictures.read_bytes('matte.jpg')])
        report = self.reports('render', *command, '-o', 'own.ppm')['matte']
        self.assertEqual((report['file'], report['width'], report['height']),
                         ('mixed.jpg', width, height))
        self.same(pictures.read_bytes('own.ppm'), pictures.read_bytes('file.ppm'))
        report = self.reports('render', *command, '-o', 'none.ppm', '--matte', 'none')
        self.assertIsNone(report['matte'])
        self.differs(pictures.read_bytes('own.ppm'), pictures.read_bytes('none.ppm'))
        self.assertEqual(self.reports('info', 'mixed.jpg')['matte'], [width, height])
        self.assertIn('render uses it unless told --matte none', self.succeeds('info', 'mixed.jpg'))
        for name in ('mixed.jpg', 'matte.jpg', 'mixed.ppm', 'matte.ppm', 'map.pgm', 'file.ppm',
                     'own.ppm', 'none.ppm'):
            os.remove(name)

    def test_behind(self):
        """A bar before stripes: what it hides is shown where it melts away."""
        width, height = 96, 64
        bar = range(44, 52)
        stripes = lambda x, y: (230, 230, 220) if y // 4 % 2 else (20, 30, 60)
        pictures.ppm('bar.ppm', width, height,
                     lambda x, y: (150, 40, 30) if x in bar else stripes(x, y))
        pictures.ppm('stripes.ppm', width, height, stripes)
        pictures.pgm('bar.pgm', width, height, lambda x, y: 255 if x in bar else 0)
        pictures.pgm('wall.pgm', width, height, lambda x, y: 0)
        pictures.pgm('small.pgm', width // 2, height, lambda x, y: 0)
        command = ('--depth', 'bar.pgm', '--focus', '0', '--blur', '12', '--no-thin')
        render = ('render', 'bar.ppm', *command, '-o', 'out.ppm')
        behind = ('--behind', 'stripes.ppm', '--behind-depth')

        def contrast():
            pixels = pictures.read_bytes('out.ppm')[-3 * width * height:]
            rows = [pixels[3 * (y * width + 48)] for y in range(16, 48)]
            return max(rows) - min(rows)

        self.succeeds(*render)
        made_up = contrast()
        self.succeeds(*render, *behind, 'wall.pgm')
        self.assertGreater(contrast(), made_up + 20)
        self.succeeds('sheet', 'bar.ppm', '--depth', 'bar.pgm', '--blur', '12', *behind, 'wall.pgm', '-o',
                      'out.ppm')
        self.fails(2, '--behind: it goes with --behind-depth; give that too', *render, *behind[:2])
        self.fails(2, '--behind-depth: it goes with --behind; give that too', *render,
                   '--behind-depth', 'wall.pgm')
        self.fails(2, '--behind: no view shows it; leave it or --view out', *render, *behind,
                   'wall.pgm', '--view', 'depth')
        self.fails(2, '--behind: is what one eye cannot see; leave it or --wiggle out', 'pull',
                   'bar.ppm', *command, *behind, 'wall.pgm', '--wiggle', '3', '-o', 'p-%d.ppm')
        self.fails(1, "small.pgm: it is 48x64, the photo 96x64; give what is behind in the photo's "
                   'size', *render, *behind, 'small.pgm')
        self.fails(1, re.compile('^refocus: none.ppm: '), *render, '--behind', 'none.ppm', '--behind-depth', 'wall.pgm')

    def test_depth_edges_in_full(self):
        """`depth` looks at the photo with --full alone."""
        width, height, edge = 96, 64, 45
        pictures.ppm('edged.ppm', width, height,
                     lambda x, y: (180, 140, 60) if x < edge else (40, 70, 90))
        pictures.pgm('soft.pgm', width, height,
                     lambda x, y: 40 + 16 * min(max(edge + 5 - x, 0), 10))
        command = ('depth', 'edged.ppm', '--depth', 'soft.pgm', '-o', 'made.pgm')
        soft = tuple(v * 257 for v in pictures.read_pnm('soft.pgm')[2])
        for more in (), ('--full', '--depth-edges', 'as-given'):
            self.assertIsNone(self.reports(*command, *more)['edges'])
            self.same(pictures.read_pnm('made.pgm')[2], soft)
        self.assertTrue(self.reports(*command, '--full')['edges']['parted'])
        for i, value in enumerate(pictures.read_pnm('made.pgm')[2]):
            self.assertLess(abs(value / 65535 - (200 if i % width < edge else 40) / 255), 0.02)

    def test_nothing_to_blur(self):
        photo = pictures.read_pnm('photo.ppm')
        self.succeeds(*self.render('--blur', '0'))
        self.same(pictures.read_pnm('out.ppm'), photo)
        for method in METHODS:
            self.succeeds('render', 'plain.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm',
                          '--blur', '5', '--method', method)
            self.same(pictures.read_pnm('out.ppm'), pictures.read_pnm('plain.ppm'), method)

    def test_blur_happens_where_it_should(self):
        photo = pictures.read_pnm('photo.ppm')[2]
        self.succeeds(*self.render('--focus', '1', '--blur', '6'))
        near = pictures.read_pnm('out.ppm')[2]
        row = slice(16 * W * 3, 17 * W * 3)
        self.same(near[row][40 * 3:], photo[row][40 * 3:])   # sharp on the right
        self.differs(near[row][:20 * 3], photo[row][:20 * 3])  # and not on the left
        self.succeeds(*self.render('--focus', '0.2', '--blur', '6'))
        far = pictures.read_pnm('out.ppm')[2]
        self.same(far[row][:10 * 3], photo[row][:10 * 3])
        self.differs(far[row][30 * 3:], photo[row][30 * 3:])

    def test_options_change_the_picture(self):
        self.succeeds(*self.render('--focus', '1', '--blur', '6'))
        first = pictures.read_pnm('out.ppm')
        for more in (('--rays', '8'), ('--aperture', 'polygon:3'), ('--blend', 'stored'),
                     ('--blend', 'gamma'), ('--sigma', '40'), ('--method', 'search'),
                     ('--method', 'raytrace'), ('--focus', '0.4'), ('--blur', '3')):
            self.succeeds(*self.render('--focus', '1', '--blur', '6', *more))
            self.differs(pictures.read_pnm('out.ppm'), first, more)
        pictures.pgm('many.pgm', W, H, lambda x, y: (x // 5 * 37 + y // 4 * 51) & 255)
        search = ('--depth', 'many.pgm', '--method', 'search', '--focus', '0.2', '--blur', '6')
        self.succeeds(*self.render(*search))
        first = pictures.read_pnm('out.ppm')
        for more in (('--iterations', '1'), ('--mirror',), ('--background',)):
            self.succeeds(*self.render(*search, *more))
            self.differs(pictures.read_pnm('out.ppm'), first, more)

    def test_threads_do_not_change_the_picture(self):
        pictures_seen = set()
        for threads in ('1', '2', '3', '8'):
            self.succeeds(*self.render('--focus', '1', '--threads', threads, '--cpu', 'c'))
            pictures_seen.add(pictures.read_pnm('out.ppm'))
        self.assertEqual(len(pictures_seen), 1)

    def test_region_is_a_part_of_the_whole(self):
        self.succeeds(*self.render('--focus', '1', '--blur', '6'))
        whole = pictures.read_pnm('out.ppm')[2]
        self.succeeds(*self.render('--focus', '1', '--blur', '6', '--region', '11,5,20,9'))
        width, height, part = pictures.read_pnm('out.ppm')
        self.assertEqual((width, height), (20, 9))
        for y in range(9):
            at = ((y + 5) * W + 11) * 3
            self.same(part[y * 60:(y + 1) * 60], whole[at:at + 60])

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

    def test_deep_photos(self):
        """16 bits and floats come out as they went in; light above white is spread; white and the
        curve may be said; and where 8 bits are written, or asked for, so be it."""
        def light(x, y):
            return (20.0, 10.0, 1.5) if (x, y) == (10, 16) else (0.25 + x / 1000, 0.25, 0.125)
        pictures.pfm_colour('light.pfm', W, H, light)
        flat = b'P5\n%d %d\n255\n' % (W, H) + bytes(W * H)
        with open('flat.pgm', 'wb') as file:
            file.write(flat)
        command = ('render', 'light.pfm', '--depth', 'flat.pgm', '--focus', '1')
        self.succeeds(*command, '--blur', '0', '-o', 'out.pfm')
        self.assertEqual(pictures.read_pfm('out.pfm'), pictures.read_pfm('light.pfm'))
        self.succeeds(*command, '--blur', '6', '-o', 'out.pfm')
        before, after = pictures.read_pfm('light.pfm')[2], pictures.read_pfm('out.pfm')[2]
        self.assertLess(max(after), 1)
        for c in range(2):
            gained = sum(after[c::3]) - sum(before[c::3])
            self.assertLess(abs(gained), 0.03 * (20, 10)[c])
        self.succeeds(*command, '--blur', '0', '--white', '2', '-o', 'out.png')
        width, height, bits, channels, rows = pictures.read_png('out.png')
        self.assertEqual((width, height, bits, channels), (W, H, 16, 3))
        value = struct.unpack('>3H', rows[0][:6])[1] / 65535
        self.assertAlmostEqual(((value + 0.055) / 1.055) ** 2.4, 0.125, 3)
        self.succeeds(*command, '--blur', '0', '-o', 'out.ppm')
        greens = pictures.read_pnm('out.ppm')[2][1:3 * 64:3]
        self.assertEqual(set(greens), {136, 137})  # 136.96, dithered
        self.succeeds(*command, '--blur', '0', '--no-dither', '-o', 'out.ppm')
        self.assertEqual(set(pictures.read_pnm('out.ppm')[2][1:3 * 8:3]), {137})
        codes = [[(x * 1000 + y * 7 + c) % 65536 for x in range(W) for c in range(3)]
                 for y in range(H)]
        pictures.png('deep.png', W, H, [struct.pack('>%dH' % (3 * W), *row) for row in codes],
                     depth=16)
        for curve in 'auto', 'linear', 'pq', 'hlg', 'bt709', 'gamma', 'srgb':
            self.succeeds('render', 'deep.png', '--depth', 'flat.pgm', '--focus', '0', '--blur',
                          '3', '--transfer', curve, '-o', 'out.png')
            self.assertEqual([list(struct.unpack('>%dH' % (3 * W), row))
                              for row in pictures.read_png('out.png')[4]], codes)
        self.warns('deep.png: it has 16 bits a channel; 8 are taken, dithered', 'render',
                   'deep.png', '--depth', 'flat.pgm', '--method', 'search', '-o', 'out.png')
        self.assertEqual(pictures.read_png('out.png')[2], 8)
        for file, *more in ('photo.ppm', '--white', '2'), ('deep.png', '--transfer', 'pq', '--grain',
                                                           '1'):
            self.fails(1, more[0] + ': the option is for photos of more than 8 bits, rendered by the sweep '
                       'in linear light without --sigma, --grain, --star and --view; leave it out',
                       'render', file, '--depth', 'depth.pgm', '-o', 'out.png', *more)
        for name in ('light.pfm', 'flat.pgm', 'out.pfm', 'out.png', 'out.ppm', 'deep.png'):
            os.remove(name)

    def test_16_bits_are_told_and_dithered(self):
        """Once, whatever is made of the photo; the mean of a shallow gradient is kept."""
        def value(x, y):  # rounded to nearest it is 100 or 101 all over
            return 25700 + 120 + x // 8
        pictures.png('deep.png', W, H, [struct.pack('>%dH' % (3 * W), *(
            value(x, y) for x in range(W) for _ in range(3))) for y in range(H)], depth=16)
        line = 'deep.png: it has 16 bits a channel; 8 are taken, dithered'
        command = ('deep.png', '--depth', 'depth.pgm', '-o')
        self.warns(line, 'render', *command, 'out.ppm', '--blur', '0', '--repeat', '3')
        samples = pictures.read_pnm('out.ppm')[2]
        for top in range(0, H, 8):
            for left in range(0, W, 8):
                mean = sum(samples[3 * (y * W + x)] for y in range(top, top + 8)
                           for x in range(left, left + 8)) / 64
                self.assertAlmostEqual(mean, value(left, top) / 257, delta=1 / 64)
        self.warns(line, 'sheet', *command, 'out.ppm', '--blurs', '1,2')
        self.warns(line, 'pull', *command, 'p.y4m', '--seconds', '0.1')
        result = self.run_it('compare', 'deep.png', '--depth', 'depth.pgm', '--reference',
                             'photo.ppm', '--blur', '1')
        self.assertEqual((result.returncode, result.stderr), (0, 'refocus: ' + line + '\n'))
        self.assertEqual(self.reports('info', 'deep.png')['bits'], 16)
        self.assertEqual(self.reports('info', 'photo.ppm')['bits'], 8)
        # a depth map of 16 bits is not cut, and nothing is said of it
        pictures.png('deep-depth.png', W, H, [struct.pack('>%dH' % W, *(
            40000 + x for x in range(W)))] * H, depth=16, colour=0)
        self.succeeds('depth', 'deep-depth.png', '-o', 'd.png')
        rows = pictures.read_png('d.png')[4]
        self.assertEqual(struct.unpack('>%dH' % W, rows[0]), tuple(40000 + x for x in range(W)))
        self.succeeds('render', 'photo.ppm', '--depth', 'deep-depth.png', '-o', 'out.ppm')
        for name in ('deep.png', 'deep-depth.png', 'd.png', 'p.y4m', 'out.ppm'):
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
            self.fails(2, "--depth-unit: '%s' is not known; give disparity, inverse, mm, m or a "
                          "number per metre such as 5000/m" % unit,
                       *self.render('--depth-unit', unit))
        # Dark is near: the left half, sharp when 1 is in focus.
        self.succeeds(*self.render('--depth-unit', 'inverse', '--focus', '0.8', '--blur', '6'))
        self.assertEqual(pictures.read_pnm('out.ppm')[2][:30],
                         pictures.read_pnm('photo.ppm')[2][:30])

    def test_views(self):
        self.succeeds(*self.render('--view', 'depth'))
        width, height, values = pictures.read_pnm('out.ppm')
        self.assertEqual(width, W)
        self.assertGreater(height, H + 20)  # the legend
        self.assertNotEqual(values[:3], values[(W - 1) * 3:W * 3])
        self.assertEqual(values[:3], values[3:6])
        legend = values[H * W * 3:]
        self.assertIn((240, 240, 240), {legend[i:i + 3] for i in range(0, len(legend), 3)})
        self.succeeds(*self.render('--view', 'blur', '--focus', '1', '--blur', '9'))
        values = pictures.read_pnm('out.ppm')[2]
        self.assertEqual(values[(W - 1) * 3:W * 3], (0, 255, 120))  # sharp
        self.assertNotEqual(values[:3], (0, 255, 120))
        self.succeeds(*self.render('--view', 'none'))
        self.assertEqual(pictures.read_pnm('out.ppm')[1], H)

    def test_a_low_map(self):
        pictures.pgm('low.pgm', W // 4, H // 4, lambda x, y: 20 * x)
        report = self.reports('render', 'photo.ppm', '--depth', 'low.pgm', '-o', 'out.ppm')
        self.assertEqual((report['width'], report['depth']['width']), (W, W // 4))

    def test_bench_frames(self):
        report = self.reports('bench', '--frames', '--size', '48x32', '--repeat', '2',
                              '--threads', '2')
        rows = report['frames']
        self.assertEqual([(r['blur'], r['quality'], r['threads']) for r in rows],
                         [(k, q, 2) for k in (10, 20, 40)
                          for q in ('preview', 'standard', 'best')])
        for row in rows:
            self.assertEqual((row['width'], row['height']), (48, 32))
            self.assertTrue(all(row[t] > 0 for t in
                                ('memcpy_ms', 'box_ms', 'prepare_ms', 'render_ms')))
        text = self.succeeds('bench', 'photo.ppm', '--depth', 'depth.pgm', '--frames',
                             '--repeat', '1', '--threads', '1')
        self.assertEqual(len(re.findall(r'(?m)^ *%dx%d ' % (W, H), text)), 9)
        self.fails(2, '--frames: it does not go with --rays without a number; leave one of them '
                   'out', 'bench', '--frames', '--rays', '--size', '9x9')

    def test_bench_kernels(self):
        report = self.reports('bench', '--kernels')
        names = [k['kernel'] for k in report['kernels']]
        self.assertIn('sweep', names)
        self.assertEqual(len(set(names)), len(names))
        self.assertEqual({'search', 'search_weighted', 'count_hits', 'add_counted'} - set(names),
                         set())
        for kernel in report['kernels']:
            self.assertGreater(kernel['ns'], 0)
            self.assertGreater(kernel['ns_c'], 0)
        plain = self.reports('bench', '--kernels', '--cpu', 'c')
        self.assertEqual(plain['cpu'], 'c')
        self.assertRegex(self.succeeds('bench', '--kernels'), r'(?m)^sweep +\S+ +\S+ ns/ray sample')

    def test_bench(self):
        report = self.reports('bench', '--size', '64x40', '--repeat', '2', '--blur', '5')
        self.assertEqual((report['width'], report['height'], report['repeat'], report['blur']),
                         (64, 40, 2, 5.0))
        self.assertGreater(report['megapixels_per_second'], 0)
        self.assertEqual(report['photo'], None)
        report = self.reports('bench', 'photo.ppm', '--depth', 'depth.pgm', '--repeat', '1')
        self.assertEqual((report['photo'], report['width']), ('photo.ppm', W))
        self.assertRegex(self.succeeds('bench', '--size', '1x1', '--repeat', '1'),
                         r'^1x1, sweep, blur .*\ncreate .*\nprepare .*\nrender .*\n$')
        for size in ('0x5', '5', '5x65536', '5x5x5', 'axb'):
            self.fails(2, "--size: '%s' cannot be used; give WxH from 1 to 65535" % size,
                       'bench', '--size', size)


class Papers(Case):
    def test_options_of_single_methods(self):
        plain = {m: self.picture('--method', m) for m in METHODS}
        for method, *options in (('jittered', '--seed', '5'), ('jittered', '--cell', '3'),
                                 ('scatter', '--spread', 'lommel'),
                                 ('scatter', '--depth-ratio', '4'), ('scatter', '--star', '4'),
                                 ('interpolated', '--last-ratio', '3'),
                                 ('foveated', '--attention-angle', '0'),
                                 ('diffusion', '--field', 'sphere'),
                                 ('diffusion', '--field', 'picture', '--field-map', 'photo.ppm')):
            self.assertNotEqual(self.picture('--method', method, *options), plain[method], options)
        self.same(self.picture('--method', 'jittered', '--seed', '0'), plain['jittered'])
        self.same(self.picture('--method', 'diffusion', '--solver', 'series'),
                  plain['diffusion'])

    def picture(self, *options):
        self.succeeds(*self.render('--blur', '5', '--focus', '0.2', *options))
        return pictures.read_pnm('out.ppm')

    def test_refused(self):
        for why, *options in (
                ("--star: '1' cannot be used; give 0 for none, or 2 to 16 spikes", '--star', '1'),
                ("--middle-ratio: '1' cannot be used; give a number above 1", '--middle-ratio',
                 '1', '--method', 'interpolated'),
                ('--middle-ratio: 4 is not below --last-ratio 3; give the smaller number to '
                 '--middle-ratio', '--middle-ratio', '4', '--last-ratio', '3', '--method',
                 'interpolated'),
                ('--field: picture needs one; give a grey picture to --field-map', '--field',
                 'picture'),
                ('--field-map: it goes with --field picture; give that too', '--field-map', 'x'),
                ("--aperture: 'polygon:5' does not go with --method scatter, which knows a disc "
                 'alone; leave one of them out', '--aperture', 'polygon:5', '--method',
                 'scatter'),
                ('--attention: 5000,1 lies outside of the picture; give 0,0 to %d,%d'
                 % (W - 1, H - 1), '--attention', '5000,1', '--method', 'foveated')):
            self.fails(2, why, *self.render(*options))
        for option, value in (('--cell', '0'), ('--airy-radius', '0.1'), ('--layers', '9'),
                              ('--conductivity', '0'), ('--star-strength', '2'),
                              ('--field-falloff', '0'), ('--sharp-radius', '0.4')):
            self.fails(2, re.compile(r"^refocus: %s: '%s' cannot be used; give" % (option, value)),
                       *self.render(option, value))

    def test_compare(self):
        common = ('photo.ppm', '--depth', 'depth.pgm', '--blur', '4', '--focus', '0.2')
        self.succeeds('render', *common, '-o', 'gt.ppm')
        text = self.succeeds('compare', *common, '--reference', 'gt.ppm', '-o', 'crops.png')
        for method in METHODS:
            self.assertRegex(text, r'(?m)^%s +\S+ +\S+ +\S+ +\S+ +\d' % method)
        width = pictures.read_png('crops.png')[0]
        self.assertGreater(width, 12 * min(W, 96))
        report = self.reports('compare', *common, '--reference', 'gt.ppm', '--methods',
                              'blur,sweep,blur')
        self.assertEqual([m['method'] for m in report['methods']], ['photo', 'blur', 'sweep'])
        photo, blur, sweep = report['methods']
        self.assertEqual((sweep['psnr'], sweep['rmse']), ('infinity', 0))
        self.assertGreater(blur['psnr'], photo['psnr'])
        pictures.pgm('small.pgm', W // 2, H // 2, lambda x, y: 255 if x >= W // 4 else 51)
        small = ('photo.ppm', '--depth', 'small.pgm', '--blur', '4', '--focus', '0.2')
        self.succeeds('render', *small, '-o', 'small.ppm')
        report = self.reports('compare', *small, '--reference', 'small.ppm', '--methods', 'sweep')
        self.assertEqual(report['methods'][1]['rmse'], 0)
        self.fails(2, "--methods: 'swep' is no method; did you mean 'sweep'?", 'compare', *common,
                   '--reference', 'gt.ppm', '--methods', 'blur,swep')
        report = self.reports(
            'compare', *common, '--reference', 'gt.ppm', '--iterations', '3', '--methods',
            'search:rays=full:iterations=1,search,jittered:cell=4:seed=7,search:mirror,sweep:rays=8')
        self.assertEqual([m['label'] for m in report['methods'][1:]],
                         ['search:rays=full:iterations=1', 'search', 'jittered:cell=4:seed=7',
                          'search:mirror', 'sweep:rays=8'])
        self.assertEqual([m['method'] for m in report['methods'][1:4]],
                         ['search', 'search', 'jittered'])
        # each is what render makes of the same options
        for row, options in ((1, ('--method', 'search', '--rays', 'full', '--iterations', '1')),
                             (2, ('--method', 'search', '--iterations', '3')),
                             (3, ('--method', 'jittered', '--cell', '4', '--seed', '7')),
                             (5, ('--rays', '8'))):
            self.succeeds('render', *common, *options, '-o', 'own.ppm')
            own = self.reports('compare', *common, '--reference', 'own.ppm', '--iterations', '3',
                               '--methods', report['methods'][row]['label'])
            self.assertEqual(own['methods'][1]['rmse'], 0)
        for why, methods in (("--rays: 'none' cannot be used; give", 'search:rays=none'),
                             ('--ray: unknown option; did you mean --rays?', 'search:ray=3'),
                             ('--mirror: takes no value', 'search:mirror=1'),
                             ('--threads: unknown option', 'search:threads=1'),
                             ("--aperture: 'disk' is not known", 'sweep:aperture=disk'),
                             ('--methods: there are too many; give at most 32',
                              ','.join('sweep:rays=%d' % i for i in range(1, 40)))):
            self.fails(2, re.compile('^refocus: ' + re.escape(why)), 'compare', *common,
                       '--reference', 'gt.ppm', '--methods', methods)
        self.fails(2, '--reference: there is nothing to compare with; give --reference GT',
                   'compare', *common)
        pictures.ppm('tiny.ppm', 4, 3, lambda x, y: (x, y, 0))
        self.fails(1, 'tiny.ppm: it has 4x3 pixels, the photo %dx%d; give one of the same size'
                   % (W, H), 'compare', *common, '--reference', 'tiny.ppm')


    def test_ray_statistics(self):
        report = self.reports('bench', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '6',
                              '--focus', '0.2', '--rays')
        self.assertEqual(report['rays'] % report['pixels'], 0)
        self.assertAlmostEqual(sum(report['found_after']) + report['never'], 1)
        self.assertGreater(report['found_after'][0], 0.5)
        self.assertGreater(report['hidden'], 0)
        for set_of_all, own in zip(report['in_set'], report['front_most']):
            self.assertGreaterEqual(set_of_all, own)  # both may lie a pixel beside
        text = self.succeeds('bench', '--rays', '--size', '60x40', '--blur', '3')
        self.assertRegex(text, r'(?m)^ +1 +\d+\.\d+ %')
        report = self.reports('bench', '--rays', '5', '--size', '60x40', '--repeat', '1')
        self.assertEqual(report['rays'], 5)


if __name__ == '__main__':
    unittest.main()
