#!/usr/bin/env python3
"""The refocus command: --upsample in every command that has it makes the picture of the map that
`depth --full` makes of it. Usage: test_upsample.py REFOCUS [unittest arguments]"""
import json
import os
import subprocess
import unittest

import pictures
from case import Case, REFOCUS

WIDTH, HEIGHT, EDGE = 96, 64, 45
FILTERS = 'bilinear', 'joint-bilateral', 'guided', 'fast-global', 'joint-bilateral-full'
LENS = '--focus', '0.5', '--blur', '16'


class Upsample(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.opencv = 'OpenCV' in subprocess.run([REFOCUS, '--version'], capture_output=True,
                                                text=True, check=True).stdout
        pictures.ppm('edged.ppm', WIDTH, HEIGHT, lambda x, y: (
            (180, 140 + (x * 7 ^ y * 5) % 23, 60) if x < EDGE else (40, 70, 90 + x * y % 19)))
        pictures.pgm('small.pgm', 12, 8, lambda x, y: 200 + y if 8 * x + 4 < EDGE else 40 + y)

    def setUp(self):
        if not self.opencv:
            self.skipTest('this build has no OpenCV')

    def enlarge(self, way, name, *more):
        self.succeeds('depth', 'edged.ppm', '--depth', 'small.pgm', '--full', '--upsample', way,
                      '-o', name, *more)

    def test_each_filter(self):
        """Contrib's are there, or it is said what is missing, by each command."""
        made = {}
        self.enlarge('core', 'full.pgm', '--depth-edges', 'as-given')
        made['core'] = pictures.read_pnm('full.pgm')
        for way in FILTERS:
            command = ('depth', 'edged.ppm', '--depth', 'small.pgm', '--full', '--upsample', way,
                       '--depth-edges', 'as-given', '-o', 'full.pgm')
            result = self.run_it(*command)
            if way not in FILTERS[:2] and result.returncode:
                missing = '--upsample: %s: the module refocus-ximgproc.so is not there; build it ' \
                          'with -Dximgproc=enabled, or use another filter' % way
                self.fails(1, missing, *command)
                self.fails(1, missing, 'render', 'edged.ppm', '--depth', 'small.pgm', '--upsample',
                           way, '-o', 'new.ppm')
                self.fails(1, missing, 'live', '--camera', 'file:edged.ppm', '--depth',
                           'small.pgm', '--upsample', way, '--frames', '1')
                continue
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            made[way] = pictures.read_pnm('full.pgm')
            self.assertEqual(made[way][:2], (WIDTH, HEIGHT))
        self.assertGreaterEqual(len(made), 3)
        self.assertEqual(len(set(made.values())), len(made))

    def test_each_command(self):
        for edges in 'as-given', 'auto':
            edged = ('--depth-edges', edges)
            self.enlarge('joint-bilateral', 'full.pgm', *edged)
            self.enlarge('joint-bilateral', 'given.pgm', '--depth-edges', 'as-given')
            for command, out, *more in (
                    ('render', 'out.ppm', *LENS), ('sheet', 'out.ppm'),
                    ('pull', 'out-%d.ppm', '--from', '0.2', '--to', '0.8', '--seconds', '0.2',
                     '--blur', '16')):
                shown = out.replace('%d', '2')
                of = {}
                for name, *how in (('small', 'small.pgm', '--upsample', 'joint-bilateral', *edged),
                                   ('full', 'given.pgm', *edged),
                                   ('core', 'small.pgm', '--upsample', 'core', *edged),
                                   ('default', 'small.pgm', *edged)):
                    self.succeeds(command, 'edged.ppm', '--depth', *how, '-o', out, *more)
                    of[name] = pictures.read_bytes(shown)
                self.same(of['small'], of['full'], (command, edges))
                self.same(of['core'], of['default'], (command, edges))
                self.differs(of['small'], of['core'], (command, edges))
        scores = [self.reports('compare', 'edged.ppm', '--reference', 'edged.ppm', '--methods',
                               'sweep', '--border', '0', '--depth', *how, *LENS)['methods']
                  for how in (('small.pgm', '--upsample', 'joint-bilateral'), ('given.pgm',),
                              ('small.pgm',))]
        rmse = [[row.get('rmse') for row in rows] for rows in scores]
        self.assertEqual(rmse[0], rmse[1])
        self.assertNotEqual(rmse[0], rmse[2])

    def test_map_of_the_photos_size(self):
        """There is nothing to enlarge: no filter is asked for, and edges are placed as ever."""
        pictures.pgm('soft.pgm', WIDTH, HEIGHT,
                     lambda x, y: 40 + 16 * min(max(EDGE + 5 - x, 0), 10))
        made = []
        for more in (), ('--upsample', 'joint-bilateral'), ('--upsample', 'guided'):
            report = self.reports('render', 'edged.ppm', '--depth', 'soft.pgm', *LENS, '-o',
                                  'out.ppm', *more)
            self.assertTrue(report['edges']['parted'])
            made.append(pictures.read_bytes('out.ppm'))
        self.same(made[0], made[1])
        self.same(made[0], made[2])

    def test_live(self):
        """Each frame is the photo that render makes, and frames of Y, U and V go by RGB."""
        self.enlarge('joint-bilateral', 'given.pgm', '--depth-edges', 'as-given')
        for edges in 'as-given', 'auto':
            made = []
            for how in (('small.pgm', '--upsample', 'joint-bilateral'), ('given.pgm',),
                        ('small.pgm',)):
                self.reports('live', '--camera', 'file:edged.ppm', '--frames', '1', '--depth',
                             *how, '--depth-edges', edges, *LENS, '--out', 'live-%d.ppm')
                made.append(pictures.read_bytes('live-0.ppm'))
            self.same(made[0], made[1])
            self.differs(made[0], made[2])
        for form in 'NV12', 'YUYV':
            camera = 'replay::format %s;size 64x48;frames 3' % form
            report = self.reports('live', '--camera', camera,
                                  '--fast', '--frames-policy', 'every', '--depth', 'small.pgm',
                                  '--upsample', 'joint-bilateral', *LENS)
            self.assertEqual((report['frames_out'], report['rendered_in']), (3, 'RGB24'))

    def test_view(self):
        """The focus of the middle is that of the map, in a window that nobody sees."""
        self.enlarge('bilinear', 'given.pgm', '--depth-edges', 'as-given')
        focus = []
        for how in ('small.pgm', '--upsample', 'bilinear'), ('given.pgm',), ('small.pgm',):
            result = self.run_it('view', 'edged.ppm', '--seconds', '0.2', '--json', '--focus-at',
                                 '%d,32' % EDGE, '--depth-edges', 'as-given', '--depth', *how,
                                 env=dict(os.environ, SDL_VIDEODRIVER='dummy'))
            if 'the window cannot be loaded' in result.stderr:
                self.skipTest(result.stderr)
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            focus.append(json.loads(result.stdout)['focus'])
        self.assertEqual(focus[0], focus[1])
        self.assertNotEqual(focus[0], focus[2])

    def test_file_of_settings(self):
        command = ('render', 'edged.ppm', '--depth', 'small.pgm', '--depth-edges', 'as-given', *LENS,
                   '-o', 'out.ppm')
        self.succeeds(*command, '--upsample', 'bilinear', '--save-settings', 's.json')
        first = pictures.read_bytes('out.ppm')
        self.succeeds(*command, '--settings', 's.json')
        self.same(pictures.read_bytes('out.ppm'), first)
        self.succeeds(*command)
        self.differs(pictures.read_bytes('out.ppm'), first)

    def test_behind_stays(self):
        """What is behind has the photo's size; the filter is for the photo's map alone."""
        pictures.ppm('wall.ppm', WIDTH, HEIGHT, lambda x, y: (40, 70, 90))
        pictures.pgm('wall.pgm', WIDTH, HEIGHT, lambda x, y: 40)
        self.succeeds('render', 'edged.ppm', '--depth', 'small.pgm', '--upsample', 'bilinear',
                      '--behind', 'wall.ppm', '--behind-depth', 'wall.pgm', *LENS, '-o', 'out.ppm')
        self.assertEqual(pictures.read_pnm('out.ppm')[:2], (WIDTH, HEIGHT))


if __name__ == '__main__':
    unittest.main()
