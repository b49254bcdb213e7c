#!/usr/bin/env python3
"""Settings of single methods, comparisons and ray statistics.
Usage: test_papers.py REFOCUS [unittest arguments]"""
import os
import re
import unittest

import pictures
from case import Case, H, REFOCUS, ROOT, W
from names import method_names

METHODS = method_names(REFOCUS)


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
                ("--middle-ratio: '1' cannot be used; give a number above 1, at most 1000",
                 '--middle-ratio',
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

    def test_compare_times_rendering_alone(self):
        """Whatever stands first is not charged what is done once for the photo: 72 of 188 ms."""
        scene = os.path.join(ROOT, 'examples/data/portrait/')
        for _ in range(5):
            first, second = self.reports(
                'compare', scene + 'allfocus.png', '--depth', scene + 'disparity.png',
                '--reference', scene + 'gt_df0.689_K20.png', '--focus', '0.689', '--blur', '20',
                '--threads', '1', '--methods', 'sweep,sweep:rays=65')['methods'][1:]
            if first['cpu_ms']['min'] < 1.5 * second['cpu_ms']['min']:
                return
        self.fail((first['cpu_ms'], second['cpu_ms']))

    def test_compare_gives_each_method_its_own(self):
        """Texture and thin structures of one entry, whatever the others and the quality beside are."""
        scene = os.path.join(ROOT, 'examples/data/portrait/')
        common = (scene + 'allfocus.png', '--depth', scene + 'disparity.png', '--focus', '0.689',
                  '--blur', '20')
        self.succeeds('render', *common, '--quality', 'best', '--grain', 'off', '-o', 'best.ppm')
        methods = self.reports('compare', *common, '--reference', 'best.ppm', '--quality',
                               'preview', '--methods', 'sweep,sweep:quality=best')['methods']
        self.assertGreater(methods[1]['rmse'], 0)
        self.assertEqual(methods[2]['rmse'], 0)
        os.remove('best.ppm')

    def test_compare(self):
        common = ('photo.ppm', '--depth', 'depth.pgm', '--blur', '4', '--focus', '0.2')
        self.succeeds('render', *common, '-o', 'gt.ppm')
        text = self.succeeds('compare', *common, '--reference', 'gt.ppm', '-o', 'crops.png')
        for method in METHODS:
            self.assertRegex(text, r'(?m)^%s +\S+ +\S+ +\S+ +\S+ +\d' % method)
        width = pictures.read_png('crops.png')[0]
        self.assertGreater(width, 12 * min(W, 96))
        # options that differ at their end are told apart above their crops
        alike = ','.join('search:rays=full:iterations=%d' % n for n in (1, 2))
        self.succeeds('compare', *common, '--reference', 'gt.ppm', '--methods', alike, '-o',
                      'crops.png')
        rows = pictures.read_png('crops.png')[4][22:76]
        one, other = ([row[3 * (4 + i * (2 * W + 4)):][:6 * W] for row in rows] for i in (2, 3))
        self.assertEqual(one[:36], other[:36])
        self.assertNotEqual(one, other)
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
        wide = ('compare', *common[:3], '--blur', '40', '--focus', '0.2', '--reference', 'gt.ppm',
                '--border', '0', '--methods')
        plain, auto, rays = self.reports(*wide, 'sweep,sweep:quality=auto,sweep:rays=256')[
            'methods'][1:]
        self.assertEqual(auto['rmse'], rays['rmse'])
        self.assertNotEqual(auto['rmse'], plain['rmse'])
        report = self.reports(*wide, 'sweep', '--quality', 'auto')
        self.assertEqual((report['methods'][1]['rmse'], report['rays']), (auto['rmse'], 256))
        self.fails(2, "--methods: 'swep' is no method; did you mean 'sweep'?", 'compare', *common,
                   '--reference', 'gt.ppm', '--methods', 'blur,swep')
        self.fails(2, '--blur: unknown option within --methods; it is the same for all of them, so '
                   'give it beside --methods',
                   'compare', *common, '--reference', 'gt.ppm', '--methods', 'search:mirror:blur=3')
        self.fails(2, '--rais: unknown option; did you mean --rays?', 'compare', *common,
                   '--reference', 'gt.ppm', '--methods', 'sweep:rais=3')
        for border in H // 2, 9999:
            self.fails(2, '--border: %d pixels at each side leave nothing of %dx%d to compare; give '
                       'fewer' % (border, W, H), 'compare', *common, '--reference', 'gt.ppm',
                       '--border', str(border))
        self.succeeds('compare', *common, '--reference', 'gt.ppm', '--methods', 'sweep', '--border',
                      str(H // 2 - 1))
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
