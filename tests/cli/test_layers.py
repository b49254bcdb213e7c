#!/usr/bin/env python3
"""What the photo knows beside its depth: edges, mattes, what is behind, gain maps, deep pixels.
Usage: test_layers.py REFOCUS [unittest arguments]"""
import os
import re
import struct
import unittest

import pictures
from case import Case, H, W


class Layers(Case):
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
                                          'shift_y_px', 'bent', 'parted', 'changed', 'noise',
                                          'specks'})
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
        self.matte_is_kept(command[0], command[1:], width, height)
        for name in ('mixed.jpg', 'matte.jpg', 'mixed.ppm', 'matte.ppm', 'map.pgm', 'file.ppm',
                     'own.ppm', 'none.ppm', 'given.pgm', 'a.jpg', 'b.jpg', 'c.jpg', 'again.ppm',
                     'given.ppm'):
            os.remove(name)

    def matte_is_kept(self, photo, options, width, height):
        """One that is given counts in later edits in place of the photo's own, until another is
        given."""
        for first, second in (0, 200), (64, 0):
            pictures.pgm('given.pgm', width, height, lambda x, y: (first if y < 30 else second) +
                         (x > 40) * 55)
            self.succeeds('render', photo, *options, '-o', 'given.ppm', '--matte', 'given.pgm')
            self.succeeds('render', photo if first == 0 else 'c.jpg', *options, '-o', 'a.jpg',
                          '--matte', 'given.pgm')
            self.succeeds('render', 'a.jpg', '-o', 'b.jpg', '--blur', '1', '--matte', 'none')
            self.succeeds('render', 'b.jpg', '-o', 'c.jpg', '--blur', '2')
            report = self.reports('render', 'c.jpg', *options, '-o', 'again.ppm')['matte']
            self.assertEqual((report['file'], report['width'], report['height']),
                             ('c.jpg', width, height))
            self.same(pictures.read_bytes('again.ppm'), pictures.read_bytes('given.ppm'))
            self.assertIn('a matte in the file', self.succeeds('info', 'c.jpg'))

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
        for curve, *more in ('auto',), ('linear',), ('pq',), ('hlg',), ('bt709',), ('gamma',), (
                'srgb',), ('linear', '--white', '2'), ('pq', '--white', '900'):
            self.succeeds('render', 'deep.png', '--depth', 'flat.pgm', '--focus', '0', '--blur',
                          '3', '--transfer', curve, *more, '-o', 'out.png')
            self.assertEqual([list(struct.unpack('>%dH' % (3 * W), row))
                              for row in pictures.read_png('out.png')[4]], codes)
        self.warns('deep.png: it has 16 bits a channel; 8 are taken, dithered', 'render',
                   'deep.png', '--depth', 'flat.pgm', '--method', 'scatter', '-o', 'out.png')
        self.assertEqual(pictures.read_png('out.png')[2], 8)
        for file, *more in ('photo.ppm', '--white', '2'), ('deep.png', '--transfer', 'pq', '--grain',
                                                           '1'):
            self.fails(1, more[0] + ': the option is for photos of more than 8 bits, rendered by sweep, '
                       'search, blur or interpolated in linear light without --sigma, --grain, --star, '
                       '--view and --wiggle; leave it out',
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


if __name__ == '__main__':
    unittest.main()
