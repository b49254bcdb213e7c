#!/usr/bin/env python3
"""refocus render --view and refocus pull --wiggle: small pictures whose result can be worked out.
Usage: test_pictures.py REFOCUS [unittest arguments]"""
import json
import os
import unittest

import pictures
from case import H, W, Case

NEAR_LINE, FAR_LINE, SHARP = (255, 0, 200), (255, 255, 255), (0, 255, 120)
EDGE = W // 2  # of depth.pgm: disparity 0.2 on the left, 1 on the right


def luma(pixel):
    return (2 * pixel[0] + 5 * pixel[1] + pixel[2]) // 8


class Picture(Case):
    def pixels(self, name):
        width, height, samples = pictures.read_pnm(name)
        return [[samples[3 * (y * width + x):][:3] for x in range(width)] for y in range(height)]

    def view(self, view, *arguments):
        self.succeeds(*self.render('--view', view, *arguments))
        return self.pixels('out.ppm')

    def test_overlay(self):
        photo, depth = self.pixels('photo.ppm'), self.view('depth')
        overlay = self.view('overlay')
        for y in range(H):
            for x in range(W):
                grey = luma(photo[y][x])
                self.assertEqual(overlay[y][x], tuple((v + grey + 1) // 2 for v in depth[y][x]))
        self.assertEqual(overlay[H:], depth[H:])  # the legend

    def test_metres_of_the_overlay(self):
        with_metres = self.view('overlay', '--near', '1', '--far', '3')
        self.differs(with_metres[H:], self.view('overlay')[H:])

    def test_peaking(self):
        photo = self.pixels('photo.ppm')
        marked = self.view('peaking', '--focus', '1', '--blur', '9')
        self.assertEqual((len(marked[0]), len(marked)), (W, H))
        count = 0
        for y in range(H):
            for x in list(range(EDGE - 2)) + list(range(EDGE + 2, W)):
                here = luma(photo[y][x])
                right = luma(photo[y][min(x + 1, W - 1)])
                below = luma(photo[min(y + 1, H - 1)][x])
                edge = x >= EDGE and max(abs(right - here), abs(below - here)) > 20
                self.assertEqual(marked[y][x], (32, 255, 64) if edge else (here,) * 3, (x, y))
                count += edge
        self.assertGreater(count, 20)
        self.assertLess(count, W * H // 2 - 20)
        # Half a pixel of blur is the limit: K |d - df| = 0.5 and a little less
        for blur, same in ('0.61', True), ('0.64', False):
            marks = self.view('peaking', '--focus', '1', '--blur', blur)
            left = sum(p == (32, 255, 64) for row in marks for p in row[:EDGE - 2])
            self.assertEqual(left > 0, same, blur)

    def test_moved_edges(self):
        photo = self.pixels('photo.ppm')
        grey = [[(luma(pixel),) * 3 for pixel in row] for row in photo]
        self.same(self.view('edges'), grey)  # sharp, and where the photo has them
        self.same(self.view('edges', '--depth-edges', 'as-given'), grey)
        # An edge of the photo in the middle of a ramp of 12 pixels: the left half of the ramp goes
        # farther, the right half nearer.
        pictures.ppm('step.ppm', 96, 64, lambda x, y: (40,) * 3 if x < 48 else (200,) * 3)
        pictures.pgm('ramp.pgm', 96, 64, lambda x, y: 50 + 15 * min(max(x - 42, 0), 12))
        self.succeeds('render', 'step.ppm', '--depth', 'ramp.pgm', '-o', 'e.ppm', '--view', 'edges')
        for row in self.pixels('e.ppm')[8:-8]:
            self.assertEqual(row[:40] + row[58:], [(40,) * 3] * 40 + [(200,) * 3] * 38)
            for pixel in row[44:48]:
                self.assertGreater(pixel[2], pixel[0])
            for pixel in row[49:53]:
                self.assertGreater(pixel[0], pixel[2])

    def test_lines_of_the_limits(self):
        for focus, line, where in ('1', FAR_LINE, EDGE), ('0.2', NEAR_LINE, EDGE - 1):
            rows = self.view('blur', '--focus', focus, '--blur', '9')[:H]
            other = NEAR_LINE if line == FAR_LINE else FAR_LINE
            for row in rows:
                self.assertNotIn(other, row)
                at = [x for x in range(W) if row[x] == line]
                self.assertEqual(len(at), 1)
                self.assertLessEqual(abs(at[0] - where), 1)
                self.assertIn(SHARP, row)

    def test_numbers_of_the_limits(self):
        pictures.ppm('wide.ppm', 330, 3, lambda x, y: (x & 255, 9, 9))
        pictures.pgm('wide.pgm', 330, 3, lambda x, y: x * 255 // 329)

        def legend(*arguments):
            self.succeeds('render', 'wide.ppm', '--depth', 'wide.pgm', '-o', 'w.ppm', '--view',
                          'blur', '--focus', '0.5', *arguments)
            return self.pixels('w.ppm')[3:]

        plain = legend('--blur', '20')
        colours = {p for row in plain for p in row}
        self.assertTrue({NEAR_LINE, FAR_LINE, SHARP} <= colours)
        self.differs(plain[25:], legend('--blur', '10')[25:])
        metres = legend('--blur', '20', '--near', '1', '--far', '2')
        self.differs(plain[25:], metres[25:])
        self.same(plain[:24], metres[:24])
        self.assertNotIn(NEAR_LINE, {p for row in legend('--blur', '0') for p in row})

    def warped(self, shift):
        """The photo with its left half moved, and what is missing mirrored from the far side."""
        rows = []
        for row in self.pixels('photo.ppm'):
            new = [None] * EDGE + row[EDGE:]
            for x in range(EDGE):
                if 0 <= x + shift < EDGE:
                    new[x + shift] = row[x]
            for k in range(abs(shift)):
                if shift < 0:
                    new[EDGE + shift + k] = row[EDGE - 1 - k]
                else:
                    new[shift - 1 - k] = row[k]
            rows.append(new)
        return rows

    def test_anaglyph(self):
        left, right = self.warped(-8), self.warped(8)
        got = self.view('anaglyph', '--focus', '1', '--blur', '0', '--parallax', '20')
        self.assertEqual(got, [[(a[0], b[1], b[2]) for a, b in zip(*rows)]
                               for rows in zip(left, right)])
        for x in range(3):  # in focus: both eyes see the same
            self.assertEqual(got[0][W - 1 - x], self.pixels('photo.ppm')[0][W - 1 - x])

    def test_no_parallax(self):
        plain = self.view('none', '--focus', '0.2', '--blur', '6')
        self.same(self.view('anaglyph', '--focus', '0.2', '--blur', '6', '--parallax', '0'), plain)
        self.differs(self.view('anaglyph', '--focus', '0.2', '--blur', '6'), plain)

    def test_large_parallax(self):
        """All of what is not in focus leaves the picture, or nothing is in focus at all."""
        pictures.pgm('far.pgm', W, H, lambda x, y: 0)
        for depth in 'depth.pgm', 'far.pgm':
            self.view('anaglyph', '--focus', '1', '--parallax', '256', '--depth', depth)
        photo = self.pixels('photo.ppm')
        got = self.view('anaglyph', '--focus', '1', '--blur', '0', '--parallax', '256', '--depth',
                        'far.pgm')
        for y in range(H):  # beyond the border lies its edge pixel
            a, b = photo[y][W - 1], photo[y][0]
            self.assertEqual(got[y], [(a[0], b[1], b[2])] * W)

    def test_parallax_limits(self):
        for bad in ('-1', '256.5', 'x', 'nan', 'inf'):
            self.fails(2, "--parallax: '%s' cannot be used; give a number from 0 to 256" % bad,
                       *self.render('--view', 'anaglyph', '--parallax', bad))
        for view in 'none', 'depth', 'peaking':
            self.fails(2, '--parallax: goes with --view anaglyph; give that too',
                       *self.render('--view', view, '--parallax', '3'))
        self.fails(2, '--region: a view always shows the whole; leave --region or --view out',
                   *self.render('--region', '0,0,1,1', '--view', 'anaglyph'))

    def test_settings_describe_the_anaglyph(self):
        got = self.view('anaglyph', '--parallax', '5', '--save-settings', 's.json')
        with open('s.json') as file:
            self.assertEqual(json.load(file)['parallax'], 5)
        self.succeeds('render', 'photo.ppm', '-o', 'out.ppm', '--settings', 's.json')
        self.same(self.pixels('out.ppm'), got)
        os.remove('s.json')

    def wiggle(self, *arguments):
        return ('pull', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'w-%d.ppm', '--blur', '0',
                '--wiggle', '20') + arguments

    def test_wiggle(self):
        report = self.reports(*self.wiggle('--focus', '1', '--seconds', '0.8', '--fps', '10'))
        self.assertEqual(report['frames'], 8)
        frames = []
        for i in range(8):
            frames.append(self.pixels('w-%d.ppm' % i))
            os.remove('w-%d.ppm' % i)
        self.same(frames[0], self.pixels('photo.ppm'))
        self.same(frames[4], frames[0])
        self.same(frames[2], self.warped(-8))
        self.same(frames[6], self.warped(8))
        self.same(frames[1], frames[3])
        self.differs(frames[1], frames[2])

    def test_wiggle_limits(self):
        self.fails(2, "--wiggle: '257' cannot be used; give a number from 0 to 256",
                   *self.wiggle('--wiggle', '257'))
        for more in (('--back',), ('--from', '1'), ('--to', '0'), ('--blur-from', '1'),
                     ('--blur-to', '1'), ('--keys', 'k.json')):
            self.fails(2, '--wiggle: is in place of --keys, --from, --to, --blur-from, --blur-to '
                       'and --back; leave them out', *self.wiggle(*more))
        self.succeeds(*self.wiggle('--seconds', '0.01', '--fps', '1'))
        os.remove('w-0.ppm')
        self.assertFalse(os.path.exists('w-1.ppm'))


if __name__ == '__main__':
    unittest.main()
