#!/usr/bin/env python3
"""What render and bench give: reports, pictures and times.
Usage: test_results.py REFOCUS [unittest arguments]"""
import re
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
            self.assertEqual(self.reports(*self.render('--quality', quality, '--blur', '40'))['rays'],
                             rays)
        for blur, rays in ((20, 64), (30, 144), (40, 256), (100, 256)):
            self.assertEqual(self.reports(*self.render('--blur', str(blur)))['rays'], rays)
        self.assertEqual(self.reports(*self.render('--blur', '40', '--rays', '9'))['rays'], 9)
        self.assertEqual(self.reports(*self.render('--blur', '40', '--method', 'search'))['rays'], 64)
        self.assertEqual(self.reports(*self.render('--quality', 'best', '--rays', '7'))['rays'],
                         7)
        self.assertEqual(self.reports(*self.render('--rays', 'full', '--blur', '3'))['rays'],
                         'full')
        text = self.succeeds(*self.render('--repeat', '2'))
        self.assertRegex(text, r'^prepare [\d.]+ ms, render [\d.]+ ms \(median of 2; ')
        self.assertEqual(self.succeeds(*self.render()), '')

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
        self.assertEqual({'search', 'search_weighted'} - set(names), set())
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
        for more, rays in ((), 64), (('--quality', 'auto'), 144):
            self.assertEqual(self.reports('bench', '--size', '64x40', '--repeat', '2', '--blur',
                                          '30', *more)['rays'], rays)
        report = self.reports('bench', 'photo.ppm', '--depth', 'depth.pgm', '--repeat', '1')
        self.assertEqual((report['photo'], report['width']), ('photo.ppm', W))
        self.assertRegex(self.succeeds('bench', '--size', '1x1', '--repeat', '1'),
                         r'^1x1, sweep, blur .*\ncreate .*\nprepare .*\nrender .*\n$')
        for size in ('0x5', '5', '5x65536', '5x5x5', 'axb'):
            self.fails(2, "--size: '%s' cannot be used; give WxH from 1 to 65535" % size,
                       'bench', '--size', size)


if __name__ == '__main__':
    unittest.main()
