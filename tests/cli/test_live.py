#!/usr/bin/env python3
"""usage: test_live.py REFOCUS  -- the pictures of refocus live, by scripted cameras alone."""
import json
import os
import struct
import subprocess
import unittest

from living import DEPTH, REFOCUS, SLOW, SMALL, Live, content, live

ROOT = os.environ.get('REFOCUS_SOURCE_ROOT', os.path.join(os.path.dirname(__file__), '../..'))


class Pictures(Live):
    def test_every_frame_is_rendered_and_paired(self):
        r = self.report('--camera', 'replay::size 64x48;frames 40', '--depth', DEPTH, '--fast',
                        '--frames-policy', 'every', '--out', 'y4m:out.y4m')
        self.assertEqual((r['frames_in'], r['frames_out'], r['dropped']), (40, 40, 0))
        self.assertEqual((r['paired'], r['unpaired'], r['without_depth']), (40, 0, 0))
        frame = 64 * 48 * 3 // 2 + len('FRAME\n')
        header = content('out.y4m').split(b'\n')[0] + b'\n'
        self.assertIn(b'W64 H48', header)
        self.assertEqual(os.path.getsize('out.y4m'), len(header) + 40 * frame)
        for stage in ('convert', 'depth', 'prepare', 'render', 'output'):
            self.assertGreaterEqual(r['stages_ms'][stage]['median'], 0)

    def test_the_lens_of_the_camera(self):
        """Positions are those of the last frame; a camera that comes back is told again."""
        script = 'replay::format NV12;size 32x24;frames 12;lens 0 4;lens-speed 0.5;'

        def lens(*args, more=''):
            r = self.report('--camera', script + more, '--depth', DEPTH, '--fast',
                            '--frames-policy', 'every', *args)
            self.assertEqual(r['lens']['position'], r['lens_dioptres'])
            return r['lens']
        self.assertEqual(lens(), {'autofocus': None, 'position': 0.0, 'dioptres': True,
                                  'least': 0.0, 'greatest': 4.0})
        for how, where in ('off', 0), ('once', 2), ('continuous', 2), ('fixed:3.25', 3.25):
            found = lens('--autofocus', how)
            self.assertEqual((found['autofocus'], found['position']), (how.split(':')[0], where))
        self.assertEqual(lens('--autofocus', 'fixed:1', more='at 5 fail')['position'], 1)
        listed = live('--list', '--camera', script, common=[])
        self.assertIn(b'lens, --autofocus off, fixed:0 to 4 dioptres, once, continuous\n',
                      listed.stdout)
        listed = json.loads(live('--list', '--camera', script, '--json', common=[]).stdout)
        self.assertEqual(listed['camera'], script)
        self.assertEqual({type(mode[key]) for mode in listed['modes']
                          for key in ('width', 'height')}, {int})
        self.assertIsInstance(json.loads(live('--list', '--json', common=[]).stdout)['cameras'], list)
        listed = live('--list', common=[])
        self.assertEqual(listed.stderr, b'' if listed.stdout else
                         b'refocus: --list: no camera is there; --camera replay:SCRIPT plays pictures '
                         b'instead\n')
        self.assertIsNone(self.report('--camera', 'replay::size 32x24;frames 2', '--depth', DEPTH,
                                      '--fast')['lens'])
        base = ['--camera', script, '--depth', DEPTH, '--autofocus']
        for how in 'on', 'fixed', 'fixed:', 'fixed:1x', 'fixed:nan', 'once:1', 'of', 'offf':
            self.fails(2, 'give off, once, continuous or fixed:POSITION', *base, how)
        self.fails(2, '4.5 is no position of its lens; give 0 to 4', *base, 'fixed:4.5')
        self.fails(1, 'its lens does not move; leave it out', '--camera', 'replay::size 32x24',
                   '--depth', DEPTH, '--autofocus', 'once')

    def write_subject(self, frames, hidden=()):
        """A square of texture that moves by 3, 1 pixels a frame before a wall of another, and comes
        nearer: disparities 90 + 4 t of 255 before 40. Returns where it ends."""
        def texture(x, y, seed):
            x, y = x // 3, y // 3
            return (x * x * 7 + y * y * 11 + x * y * (seed + 3) + 31 * seed) // 9 % 97
        for t in range(frames):
            left, up = 20 + 3 * t, 15 + t
            photo, depth = bytearray(), bytearray()
            for y in range(72):
                for x in range(128):
                    inside = t not in hidden and 0 <= x - left < 24 and 0 <= y - up < 20
                    code = (120 + texture(x - left, y - up, 5) if inside else
                            30 + texture(x, y, 2)) + (x * 3 + y * 5 + 7 * t) % 3
                    photo += bytes([code] * 3)
                    depth.append(90 + 4 * t if inside else 40)
            with open('in-%d.ppm' % t, 'wb') as file:
                file.write(b'P6\n128 72\n255\n' + photo)
            with open('depth-%d.pgm' % t, 'wb') as file:
                file.write(b'P5\n128 72\n255\n' + depth)
        return left, up

    def test_the_focus_follows_a_subject(self):
        left, up = self.write_subject(20)
        base = ['--camera', 'file:in-%d.ppm', '--depth', 'file:depth-%d.pgm', '--depth-unit',
                'disparity', '--out', 'y4m:out.y4m']
        subject = ['--focus-rectangle', '20,15,24,20']
        still = self.report(*base, '--focus-at', '30,25')
        self.assertNotIn('tracked', still)
        r = self.report(*base, *subject)
        x, y, width, height = r['tracked']['rectangle']
        self.assertLess(abs(x - left) + abs(y - up), 2)
        self.assertEqual((width, height, r['tracked']['lost']), (24, 20, 0))
        self.assertGreater(r['tracked']['likeness'], 0.9)
        # It comes nearer by 4 codes a frame, which the focus is behind by a time constant.
        self.assertGreater(r['focus'], still['focus'] + 30 / 255)
        once = content('out.y4m')
        self.assertEqual(self.report(*base, *subject)['focus'], r['focus'])
        self.assertEqual(content('out.y4m'), once)
        # By a command it is the same, and another focus ends it.
        command = self.report(*base, stdin=b'focus-rectangle 20,15,24,20\n')
        self.assertEqual((command['tracked'], command['focus']), (r['tracked'], r['focus']))
        ended = self.report(*base, *subject, stdin=b'focus 0.25\n')
        self.assertEqual((ended['focus'], 'tracked' in ended), (0.25, False))

    def test_a_subject_that_is_lost_leaves_the_focus(self):
        self.write_subject(6)
        base = ['--camera', 'file:in-%d.ppm', '--depth', 'file:depth-%d.pgm', '--depth-unit',
                'disparity', '--out', 'y4m:out.y4m', '--focus-rectangle']
        seen = self.report(*base, '20,15,24,20')
        self.write_subject(12, hidden=range(6, 12))
        r = self.report(*base, '20,15,24,20')
        self.assertEqual((seen['tracked']['lost'], r['tracked']['lost']), (0, 6))
        self.assertEqual((r['focus'], r['tracked']['rectangle']),
                         (seen['focus'], seen['tracked']['rectangle']))
        for t in range(12):
            with open('in-%d.ppm' % t, 'wb') as file:
                file.write(b'P6\n128 72\n255\n' + bytes([90] * (3 * 128 * 72)))
        self.assertEqual(self.report(*base, '20,15,24,20')['tracked']['lost'], 12)
        self.fails(2, '110,15,24,20 does not lie within the 128x72 pixels', *base, '110,15,24,20')
        self.fails(2, 'does not lie within', *base, '1,1,0,9')
        done = live(*base, '9,9,20,20', stdin=b'focus-rectangle 1,2,3\nfocus-rectangle 99,9,30,9\n')
        self.assertIn(b'give X,Y,W,H', done.stderr)
        self.assertIn(b'99,9,30,9 does not lie within', done.stderr)

    def test_the_pictures_do_not_depend_on_threads(self):
        outs = []
        for threads in '1', '3':
            self.report('--camera', 'replay::size 64x48;frames 6', '--depth', DEPTH, '--fast',
                        '--frames-policy', 'every', '--focus', '0.7', '--threads', threads,
                        '--out', 'raw:out.rgb')
            outs.append(content('out.rgb'))
        self.assertEqual(len(outs[0]), 6 * 64 * 48 * 3)
        self.assertEqual(outs[0], outs[1])

    def test_raw_frames_in_the_camera_s_own_format(self):
        sizes = {'NV12': 64 * 48 * 3 // 2, 'YUYV': 64 * 48 * 2, 'RGB24': 64 * 48 * 3}
        args = ['--depth', DEPTH, '--fast', '--frames-policy', 'every']
        for form, size in sizes.items():
            camera = ['--camera', 'replay::format %s;size 64x48;frames 4' % form]
            r = self.report(*camera, *args, '--focus', '0.7', '--out', 'raw:own.raw,own')
            self.assertEqual(r['rendered_in'], form)
            own = content('own.raw')
            self.assertEqual(len(own), 4 * size)
            self.report(*camera, *args, '--focus', '0.7', '--out', 'raw:named.raw,' + form)
            self.assertEqual(content('named.raw'), own)
            # Without blur it is what came; read again it is the same once more.
            self.report(*camera, *args, '--blur', '0', '--out', 'raw:sharp.raw,own')
            sharp = content('sharp.raw')
            self.assertNotEqual(sharp, own)
            self.report('--camera', 'raw:sharp.raw,%s,64x48,30' % form, *args, '--blur', '0',
                        '--out', 'raw:again.raw,own')
            self.assertEqual(content('again.raw'), sharp)
        # Neither another sampling nor another order takes a detour by RGB.
        camera = ['--camera', 'replay::format NV12;size 64x48;frames 4']
        r = self.report(*camera, *args, '--out', 'raw:packed.raw,YUYV')
        self.assertEqual((r['rendered_in'], len(content('packed.raw'))),
                         ('NV12', 4 * sizes['YUYV']))
        r = self.report(*camera, *args, '--out', 'raw:packed.raw,RGBX')
        self.assertEqual(r['rendered_in'], 'RGB24')
        r = self.report(*camera, *args, '--out', 'raw:planes.raw,yuv420')
        self.assertEqual((r['rendered_in'], len(content('planes.raw'))),
                         ('NV12', 4 * sizes['NV12']))
        self.fails(2, 'NV99', '--camera', 'replay::size 64x48', '--depth', DEPTH, '--out', 'raw:x,NV99')
        self.assertFalse(os.path.exists('x'))

    @unittest.skipUnless('RF_JPEG' in os.environ, 'this build has no JPEG')
    def test_mjpeg_keeps_its_y_u_and_v(self):
        with open('photo.ppm', 'wb') as photo:  # slopes: nothing that JPEG would change much
            photo.write(b'P6\n64 48\n255\n' + bytes(40 + 2 * x + y for y in range(48)
                                                    for x in range(64) for _ in range(3)))
        with open('depth.pgm', 'wb') as depth:
            depth.write(b'P5\n1 1\n255\n\x80')
        frames = {}
        for quality, form in ('80', 'YUV420'), ('95', 'RGB24'):  # of 4:2:0, and of 4:4:4
            subprocess.run([REFOCUS, 'render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0',
                            '--strip', '--jpeg-quality', quality, '-o', 'photo.jpg'], check=True)
            for out in 'RGB24', 'own':
                r = self.report('--camera', 'replay::jpeg photo.jpg;frames 3', '--depth', DEPTH,
                                '--fast', '--frames-policy', 'every', '--blur', '0', '--out',
                                'raw:out.raw,' + out)
                self.assertEqual(r['rendered_in'], 'RGB24' if out == 'RGB24' else form)
                frames[out] = content('out.raw')
            if form == 'YUV420':  # codes of the full range, in Y as in the greys of the picture
                self.assertEqual(len(frames['own']), 3 * 64 * 48 * 3 // 2)
                self.assertEqual(frames['own'][:64 * 48], frames['RGB24'][1:64 * 48 * 3:3])
            else:
                self.assertEqual(frames['own'], frames['RGB24'])

    def test_edges_of_the_depth(self):
        # A wall, before it on the right another one, whose edge the depth has as a ramp.
        with open('photo.raw', 'wb') as photo:
            photo.write(bytes((200 if x < 48 else 60) + (x * 37 + y * 91) % 23 for y in range(48)
                              for x in range(96) for _ in range(3)) * 2)
        for name, off in ('ramp.raw', lambda x: min(max(x - 42, 0), 12)), ('step.raw',
                                                                          lambda x: 12 * (x > 47)):
            with open(name, 'wb') as depth:
                depth.write(b''.join(struct.pack('<H', 3000 - 150 * off(x)) for _ in range(48)
                                     for x in range(96)) * 2)

        def run(depth, *more, form='RGB24', out='raw:out.rgb'):
            r = self.report('--camera', 'raw:photo.raw,%s,96x48,30' % form, '--depth',
                            'raw:%s,Z16,96x48,30' % depth, '--near', '1', '--far', '4', '--blur',
                            '7', '--focus', '0', '--out', out, *more)
            self.assertGreaterEqual(r['frames_out'], 2)
            return content('out.rgb')
        soft, exact = run('ramp.raw'), run('step.raw')
        self.assertEqual(run('step.raw', '--depth-edges', 'auto'), exact)
        self.assertEqual(run('ramp.raw', '--depth-edges', 'as-given'), soft)
        placed = run('ramp.raw', '--depth-edges', 'auto')
        off = [sum(abs(a - b) for a, b in zip(picture, exact)) for picture in (soft, placed)]
        self.assertLess(off[1], off[0] / 4)
        yuv = [run('ramp.raw', '--depth-edges', how, form='YUYV') for how in ('as-given', 'auto')]
        self.assertNotEqual(yuv[0], yuv[1])

    def test_steady_depth(self):
        outs = []
        for more in [], ['--steady', '0'], ['--steady', '0.9']:
            r = self.report('--camera', 'replay::size 64x48;frames 12', '--depth', DEPTH, '--fast',
                            '--frames-policy', 'every', '--focus', '0.7', '--out', 'raw:out.rgb',
                            *more)
            self.assertEqual((r['frames_out'], r['paired']), (12, 12))
            self.assertEqual(r['stages_ms']['steady'] is not None, '0.9' in more)
            outs.append(content('out.rgb'))
        self.assertEqual(outs[0], outs[1])
        self.assertEqual(len(outs[0]), len(outs[2]))
        for form in 'NV12', 'NV21', 'YUV420', 'YUYV', 'UYVY':  # Y is the guide then
            r = self.report('--camera', 'replay::format %s;size 64x48;frames 12' % form, '--depth',
                            DEPTH, '--fast', '--frames-policy', 'every', '--steady', '0.9')
            self.assertEqual((r['frames_out'], r['rendered_in']),
                             (12, 'YUYV' if form == 'UYVY' else form))
            self.assertIsNotNone(r['stages_ms']['steady'])
        self.fails(2, '--steady', '--camera', 'replay:', '--depth', DEPTH, '--steady', '0.99')

    def test_live_is_what_render_makes(self):
        self.report('--camera', 'replay::format RGB24;size 64x48;frames 1', '--depth', DEPTH,
                    '--fast', '--frames-policy', 'every', '--blur', '0', '--out', 'sharp-%d.ppm')
        with open('depth.pgm', 'wb') as depth:
            depth.write(b'P5\n64 48\n255\n' + bytes(range(64)) * 48)
        self.report('--camera', 'file:sharp-0.ppm', '--depth', 'depth.pgm', '--focus', '0.5',
                    '--frames', '1', '--out', 'live-%d.ppm')
        subprocess.run([REFOCUS, 'render', 'sharp-0.ppm', '--depth', 'depth.pgm', '--focus',
                        '0.5', *SMALL, '-o', 'render.ppm'], check=True)
        self.assertEqual(content('live-0.ppm'), content('render.ppm'))
        self.assertNotEqual(content('live-0.ppm'), content('sharp-0.ppm'))
        fence = os.path.join(ROOT, 'examples/data/fence')
        common = ('--depth', fence + '/disparity.png', '--focus', '0.3', '--blur', '15')
        for quality in 'standard', 'best':
            self.report('--camera', 'file:' + fence + '/allfocus.png', *common, '--quality',
                        quality, '--frames', '1', '--out', 'live-%d.ppm', common=[])
            for thin in ['--no-thin'], []:  # a still has thin structures at best
                subprocess.run([REFOCUS, 'render', fence + '/allfocus.png', *common, '--quality',
                                quality, '--depth-edges', 'as-given', '--fill', 'smooth', '--grain',
                                'off', *thin, '-o', 'render.ppm'], check=True)
                self.assertEqual(content('live-0.ppm') == content('render.ppm'),
                                 bool(thin) == (quality == 'standard'), (quality, thin))
        for option in ['--no-thin'], ['--fill', 'smooth']:  # it goes by --quality
            self.fails(2, option[0] + ': unknown option', '--camera', 'replay:', '--depth', DEPTH,
                       *option)
        for quality in 'auto', 'standard':
            subprocess.run([REFOCUS, 'render', 'sharp-0.ppm', '--depth', 'depth.pgm', '--focus',
                            '0.5', '--blur', '40', '--quality', quality, '-o', quality + '.ppm'],
                           check=True)
            for given in ['--quality', quality], *([[]] if quality == 'standard' else []):
                self.report('--camera', 'file:sharp-0.ppm', '--depth', 'depth.pgm', '--focus',
                            '0.5', '--blur', '40', *given, '--frames', '1', '--out',
                            'live-%d.ppm', common=[])
                self.assertEqual(content('live-0.ppm'), content(quality + '.ppm'), given)
        self.assertNotEqual(content('auto.ppm'), content('standard.ppm'))

    def test_best_frames_of_yuv_have_no_halo(self):
        """A bright figure in focus, half of whose last column is the dark wall's."""
        row, near = b'\x28' * 23 + b'\x80' + b'\xdc' * 16 + b'\x80' + b'\x28' * 23, 24
        with open('frame.nv12', 'wb') as frame:
            frame.write(row * 48 + b'\x80' * (64 * 24))
        with open('figure.pgm', 'wb') as depth:
            depth.write(b'P5\n64 48\n255\n' + (b'\x20' * near + b'\xe0' * 16 + b'\x20' * 24) * 48)
        for quality in ('standard', '--rays', '128'), ('best',):
            self.report('--camera', 'raw:frame.nv12,NV12,64x48,30', '--depth', 'figure.pgm',
                        '--focus', '0.878', '--blur', '12', '--quality', *quality, '--frames', '1',
                        '--out', f'raw:{quality[0]}.nv12,own', common=[])
        rays, best = content('standard.nv12'), content('best.nv12')
        for x in range(16, 22):  # beside the figure
            self.assertGreater(rays[24 * 64 + x], 0x2a)
            self.assertLess(best[24 * 64 + x], 0x2a)

    def test_the_report_is_described(self):
        with open(os.path.join(ROOT, 'platform/README.md'), encoding='utf-8') as file:
            described = file.read().split('### The report\n')[1].split('###')[0]
        r = self.report('--camera', 'replay::size 64x48;frames 3', '--depth', DEPTH, '--fast',
                        '--frames-policy', 'every', '--focus-rectangle', '9,9,20,20')
        words = {*r, *r['colour'], *r['depth'], *r['tracked'], *r['stages_ms'], *r['latency_ms'],
                 'stacks', 'error', 'autofocus', 'position', 'dioptres', 'least', 'greatest'}
        self.assertEqual([word for word in words if '`%s`' % word not in described and
                          '"%s"' % word not in described], [])
        r = self.report('--camera', 'replay::size 64x48;fps 2;frames 2', '--depth', DEPTH)
        self.assertLess(r['fps'], 3 if SLOW == 1 else 99)  # Half a second lies between two frames.

    def test_the_looks_of_render(self):
        photo = bytes((x * 37 + y * 91 + x * y * 13) % 199 + (56 if x % 9 == 4 and y % 9 == 4 else 0)
                      for y in range(48) for x in range(64) for _ in range(3))
        with open('photo.ppm', 'wb') as file:
            file.write(b'P6\n64 48\n255\n' + photo)
        with open('depth.pgm', 'wb') as file:
            file.write(b'P5\n64 48\n255\n' + bytes(range(0, 256, 4)) * 48)
        common = '--depth', 'depth.pgm', '--near', '1', '--far', '10'
        looks = (['--bokeh', 'cine'], ['--bokeh', 'vintage', '--cat-eye', '0.5'],
                 ['--aperture', 'polygon:5', '--curvature', '0.5', '--squeeze', '0.7'],
                 ['--tilt-angle', '30'], ['--tilt-angle', '-30', '--tilt-line', '9,9,20,40'],
                 ['--focus-width', '0.2', '--also-focus', '0.9:0.1', '--blur-limit', '2'],
                 ['--sharp-mask', 'depth.pgm'], ['--focus-map', 'depth.pgm'],
                 ['--field', 'cylinder', '--field-at', '20,20'], ['--star', '4', '--grain', '2'],
                 ['--method', 'scatter', '--spread', 'lommel'],
                 ['--method', 'foveated', '--attention', '9,9'])
        focused = [['--focus', '0.4', '--blur', '5', *look] for look in looks]
        focused += [['--focus-distance', '2', '--blur', '5'],
                    ['--focus-distance', '2', '--f-number', '2', '--focal-length', '90'],
                    ['--focus-at', '9,9', '--tilt-angle', '30', '--blur', '5'],
                    ['--focus-at', '9,9', '--method', 'foveated', '--blur', '5']]
        pictures = set()
        for look in focused:
            done = subprocess.run([REFOCUS, 'render', 'photo.ppm', *common, '--quality', 'preview',
                                   *look, '-o', 'render.ppm'], capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.report('--camera', 'file:photo.ppm', *common, '--quality', 'preview', '--frames',
                        '1', '--out', 'live-%d.ppm', *look, common=[])
            self.assertEqual(content('live-0.ppm'), content('render.ppm'), look)
            self.assertFalse(content('live-0.ppm') in pictures, look)
            pictures.add(content('live-0.ppm'))

        def refused(code, words, *look, depth=common):
            self.fails(code, words, '--camera', 'file:photo.ppm', '--frames', '1', '--out',
                       'none-%d.ppm', *depth, *look, common=[])
            self.assertFalse(os.path.exists('none-0.ppm'))
        # The light of a lamp that is wider than in the frame before follows slowly.
        for n in range(2):
            with open('lamp-%d.ppm' % n, 'wb') as file:
                file.write(b'P6\n64 48\n255\n' + bytes(255 if 20 <= y < 22 and 30 <= x < 37 + n else 40
                                                       for y in range(48) for x in range(64) for _ in range(3)))
        lamps = '--depth', 'depth.pgm', '--focus', '1', '--blur', '6', '--highlights', '6', '--quality', 'preview'
        subprocess.run([REFOCUS, 'render', 'lamp-1.ppm', *lamps, '-o', 'render.ppm'], check=True)
        for camera, frame, alone in ('lamp-%d.ppm', 1, False), ('lamp-1.ppm', 0, True):
            self.report('--camera', 'file:' + camera, *lamps, '--out', 'live-%d.ppm', '--frames', str(frame + 1),
                        common=[])
            self.assertEqual(content('live-%d.ppm' % frame) == content('render.ppm'), alone)
        refused(2, 'outside of the picture', '--field', 'plane', '--field-at', '64,2')
        refused(2, 'outside of the picture', '--tilt-angle', '9', '--tilt-line', '1,1,2,48')
        refused(2, '--focus-plane', '--focus-plane', '1,1,9,9,20,1')
        refused(2, 'plain lens only', '--method', 'scatter', '--tilt-angle', '9')
        refused(2, '--focus-distance', '--focus', '1', '--focus-distance', '2')
        for bare in ['depth.pgm'], ['raw:depth.pgm,GREY,64x48,30']:
            refused(1, 'need a depth in metres', '--focus-distance', '2', depth=['--depth', *bare])
        # The lens stays as it is while the range moves, and a command takes its place.
        args = ['--camera', 'replay::size 64x48;frames 9', '--depth', DEPTH, '--fast',
                '--frames-policy', 'every', '--f-number', '2', '--focal-length', '24']
        r = self.report(*args, common=[])
        span = 1 / r['near_m'] - 1 / r['far_m']
        self.assertAlmostEqual(r['blur'], 24 / 36 * 64 * 0.006 * span, delta=1e-4)
        self.assertEqual(self.report(*args, stdin=b'blur 3\n', common=[])['blur'], 3)

    def test_the_newest_frame_wins(self):
        # Far more than can be rendered: what is left is dropped by the camera, or here.
        r = self.report('--camera', 'replay::size 320x240;fps 4000;frames 1000', '--depth', DEPTH,
                        '--blur', '20', '--rays', '64')
        self.assertGreater(r['dropped'] + r['camera_dropped'], 500)
        self.assertGreater(r['frames_out'], 0)
        self.assertLessEqual(r['frames_in'] + r['camera_dropped'], 1000)
        self.check_sum(r)

    def test_from_files_to_files_every_frame_by_its_own_time(self):
        frame = 64 * 48 * 3
        self.report('--camera', 'replay::format YUV420;size 64x48;fps 20;frames 40', '--depth',
                    DEPTH, '--fast', '--frames-policy', 'every', '--blur', '0', '--out',
                    'y4m:in.y4m')
        with open('depth.raw', 'wb') as depth:  # something near goes by, at 15 maps a second
            for t in range(30):
                depth.write(b''.join(struct.pack('<H', 900 + 10 * t if t < x < t + 9 else
                                                 3000 + 20 * x)
                                     for y in range(24) for x in range(32)))
        with open('script', 'wb') as script:
            script.write(b'focus 0.2\npull 0.9 1\n')
        args = ['--camera', 'y4m:in.y4m', '--depth', 'raw:depth.raw,Z16,32x24,15', '--blur', '6',
                '--out', 'raw:out.rgb']

        def run(*more, stdin=b''):
            r = self.report(*args, *more, stdin=stdin)
            self.assertEqual((r['frames_in'], r['frames_out'], r['dropped']), (40, 40, 0))
            return content('out.rgb')
        plain = run('--fast', '--focus', '0.55')
        self.assertEqual(len(plain), 40 * frame)
        self.assertEqual(run('--focus', '0.55'), plain)
        pulls = []
        for more in [], ['--threads', '1'], ['--rays', '4', '--steady', '0']:
            with open('script', 'rb') as script:
                done = subprocess.run([REFOCUS, 'live', *SMALL, *args, *more], stdin=script,
                                      stderr=subprocess.DEVNULL, timeout=60 * SLOW)
            self.assertEqual(done.returncode, 0)
            pulls.append(content('out.rgb'))
        self.assertEqual(pulls, pulls[:1] * 3)
        # Half a second on, by the times of the frames, the pull is half way.
        self.assertEqual(pulls[0][10 * frame:11 * frame], plain[10 * frame:11 * frame])
        self.assertNotEqual(pulls[0][:10 * frame], plain[:10 * frame])
        self.assertEqual(pulls[0][20 * frame:], run('--focus', '0.9')[20 * frame:])
        # Where the frames come from standard input and go to standard output it is the same.
        done = live('--camera', 'y4m:-', *args[2:-1], 'raw:-', '--focus', '0.55',
                    stdin=content('in.y4m'))
        self.assertEqual((done.returncode, done.stdout), (0, plain), done.stderr)
        for more, frames in (['--frames', '7'], 7), (['--duration', '0.5'], 10):
            self.report(*args, *more)
            self.assertEqual(len(content('out.rgb')), frames * frame)
        # What is asked for goes before: as a camera would, or without an end.
        r = self.report(*args, '--frames-policy', 'newest', '--fast', '--rays', '64')
        self.assertLessEqual(r['frames_out'], 40)
        self.check_sum(r)
        r = self.report(*args, '--loop', '--frames', '90')
        self.assertEqual(r['frames_out'], 90)

    def test_the_range_follows_who_walks_in(self):
        # A wall from 3 m on the left to 3.6; from half a second on somebody at 1 m before it.
        width, frames = 128, 75
        frame = width * 48 * 3
        with open('photo.raw', 'wb') as photo:
            photo.write(bytes((x * 37 + y * 91 + x * y * 13) % 199 for y in range(48)
                              for x in range(width) for _ in range(3)) * frames)
        with open('depth.raw', 'wb') as depth:
            for t in range(frames):
                depth.write(b''.join(struct.pack('<H', 1000 if t >= 15 and 48 <= x < 56 and y > 4
                                                 else 3000 + 10 * x)
                                     for y in range(24) for x in range(64)))
        args = ['--camera', 'raw:photo.raw,RGB24,128x48,30', '--depth',
                'raw:depth.raw,Z16,64x24,30', '--focus-at', '2,24', '--blur', '4', '--blur-most',
                '40', '--highlights', 'off', '--out', 'raw:out.rgb']
        sharp = content('photo.raw')[:frame]

        def apart(a, b, x0, x1):
            """Mean difference of two pictures between two columns."""
            return sum(abs(a[(y * width + x) * 3] - b[(y * width + x) * 3]) for y in range(12, 48)
                       for x in range(x0, x1)) / 36 / (x1 - x0)
        for more in [], ['--steady', '0.8']:
            r = self.report(*args, *more)
            data = content('out.rgb')
            self.assertEqual(len(data), frames * frame)
            pictures = [data[i:i + frame] for i in range(0, len(data), frame)]
            # The wall at 3 m is in focus, and stays so; the person is not.
            for picture in pictures:
                self.assertLess(apart(picture, sharp, 0, 4), 1)
            self.assertGreater(apart(pictures[-1], sharp, 98, 110), 20)
            self.assertAlmostEqual(r['near_m'], 1, delta=0.03)
            self.assertAlmostEqual(r['far_m'], 3.63, delta=0.1)
            self.assertAlmostEqual(r['focus'], (1 / 3.02 - 1 / 3.63) / (1 - 1 / 3.63), delta=0.01)
            # Nothing moves while nothing comes, and what stands still is blurred as before.
            self.assertEqual(pictures[:15], pictures[:1] * 15)
            steps = [apart(a, b, 24, 50) for a, b in zip(pictures, pictures[1:])]
            self.assertGreater(apart(pictures[0], sharp, 24, 50), 20)
            self.assertLess(max(steps), 2)
        # What is given stays.
        r = self.report(*args, '--near', '0.5', '--far', 'inf')
        self.assertEqual((r['near_m'], r['far_m'], r['blur']), (0.5, 'infinity', 4))


if __name__ == '__main__':
    unittest.main()
