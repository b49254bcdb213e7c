#!/usr/bin/env python3
"""refocus pull: frames are what render makes of the same setting, every kind of file holds them
all, and nothing partial stays. Usage: test_pull.py REFOCUS [unittest arguments]"""
import fractions
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import time
import unittest
import zlib

import pictures
from case import H, REFOCUS, W, Case


class Pull(Case):
    def pull(self, *arguments):
        return ('pull', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '6') + arguments

    def frames(self, count):
        names = ['f-%02d.ppm' % i for i in range(count)]
        self.assertEqual(sorted(n for n in os.listdir('.') if n.startswith('f-')), names)
        frames = [pictures.read_pnm(name) for name in names]
        for name in names:
            os.remove(name)
        return frames

    def rendered(self, *arguments):
        self.succeeds(*self.render(*arguments))
        picture = pictures.read_pnm('out.ppm')
        os.remove('out.ppm')
        return picture

    def test_frames_are_renders(self):
        report = self.reports(*self.pull('-o', 'f-%02d.ppm', '--from', '0.75', '--to', '0.25',
                                         '--blur-to', '3', '--seconds', '0.5', '--fps', '8',
                                         '--ease', 'linear'))
        self.assertEqual((report['frames'], report['width'], report['height']), (5, W, H))
        frames = self.frames(5)
        for i, (focus, blur) in enumerate(((.75, 6), (.625, 5.25), (.5, 4.5), (.375, 3.75),
                                           (.25, 3))):
            self.same(frames[i], self.rendered('--focus', str(focus), '--blur', str(blur)))

    def test_rays_go_with_the_blur(self):
        self.succeeds(*self.pull('-o', 'f-%02d.ppm', '--from', '0.2', '--to', '0.2', '--blur-to',
                                 '40', '--seconds', '0.2', '--fps', '10', '--ease', 'linear'))
        for frame, blur in zip(self.frames(3), ('6', '23', '40')):
            self.same(frame, self.rendered('--focus', '0.2', '--blur', blur))

    def test_there_and_back(self):
        self.succeeds(*self.pull('-o', 'f-%02d.ppm', '--seconds', '0.3', '--fps', '10', '--back'))
        frames = self.frames(6)
        self.same(frames[1], frames[5])
        self.same(frames[2], frames[4])
        self.differs(frames[0], frames[3])

    def test_easing(self):
        for ease, middle in (('smooth', 0.5), ('linear', 0.5), ('in', 0.75), ('out', 0.25)):
            self.succeeds(*self.pull('-o', 'f-%02d.ppm', '--seconds', '0.2', '--fps', '10',
                                     '--ease', ease))
            self.same(self.frames(3)[1], self.rendered('--blur', '6', '--focus', str(middle)))

    def test_keys(self):
        self.keys([{'time': 0, 'focus': 1}, {'time': 0.1, 'blur': 2},
                   {'time': 0.2, 'focus': 0, 'blur': 8, 'ease': 'linear'}])
        self.succeeds(*self.pull('-o', 'f-%02d.ppm', '--keys', 'k.json', '--fps', '20'))
        frames = self.frames(5)
        for i, (focus, blur) in enumerate(((1, 2), (.75, 2), (.5, 2), (.25, 5), (0, 8))):
            self.same(frames[i], self.rendered('--focus', str(focus), '--blur', str(blur)))

    def keys(self, keys, **more):
        with open('k.json', 'w') as file:
            json.dump({'refocus-pull': 1, 'keys': keys, **more}, file)

    def test_controls(self):
        self.keys([{'time': 0, 'focus': 0.6, 'focus-width': 0}, {'time': 0.2, 'focus-width': 0.4}])
        self.succeeds(*self.pull('-o', 'f-%02d.ppm', '--keys', 'k.json', '--fps', '10',
                                 '--aperture', 'heart', '--cat-eye', '0.5'))
        frames = self.frames(3)
        for i, width in enumerate(('0', '0.2', '0.4')):
            self.same(frames[i], self.rendered('--focus', '0.6', '--blur', '6', '--aperture',
                                               'heart', '--cat-eye', '0.5', '--focus-width',
                                               width))
        self.differs(frames[0], frames[2])
        self.fails(2, re.compile('--focus-plane: '),
                   *self.pull('-o', 'f-%02d.ppm', '--focus-plane', '1,1,9,9,30,5'))

    def test_damaged_keys(self):
        two = {'time': 1}

        def fails(line, keys, **more):
            self.keys(keys, **more)
            self.fails(1, line, *self.pull('-o', 'f-%02d.ppm', '--keys', 'k.json'))

        fails("k.json: keys[0]: focs is no parameter; did you mean 'focus'?",
              [{'time': 0, 'focs': 1}, two])
        fails('k.json: keys[1]: blur has to be a number from 0 to 944',
              [{'time': 0}, {'time': 1, 'blur': 945}])
        fails('k.json: keys[0]: ease has to be one of smooth, linear, in, out',
              [{'time': 0, 'ease': 'x'}, two])
        for time_ in (0, -1, 'x', 3601):
            fails('k.json: keys[1]: time has to be seconds, later than those of the key before, '
                  'at most 3600', [{'time': 0}, {'time': time_}])
        fails("k.json: 'keys' has to be a list of 2 to 1024 keys", [{'time': 0}])
        fails("k.json: 'kyes' is no member; did you mean 'keys'?", [{'time': 0}, two], kyes=1)
        with open('k.json', 'w') as file:
            file.write('{}')
        self.fails(1, 'k.json: holds no keys: its member "refocus-pull" should be 1',
                   *self.pull('-o', 'f-%02d.ppm', '--keys', 'k.json'))
        self.fails(2, re.compile('^refocus: --keys: is in place of --from'),
                   *self.pull('-o', 'f-%02d.ppm', '--keys', 'k.json', '--to', '1'))

    def test_names(self):
        for name in ('f.png', 'f-%s.png', 'f-%d-%d.png', 'f-%0444d.png', 'f-%.bmp', 'f', '%n.png'):
            self.fails(2, re.compile('no such animation is written'), *self.pull('-o', name))
        self.fails(2, '-o: the output has no name; give -o OUT', *self.pull())
        self.fails(1, re.compile('^refocus: no/a.y4m: the folder no cannot be written'),
                   *self.pull('-o', 'no/a.y4m'))

    def test_y4m(self):
        self.succeeds(*self.pull('-o', 'a.y4m', '--seconds', '0.2', '--fps', '10'))
        with open('a.y4m', 'rb') as file:
            data = file.read()
        os.remove('a.y4m')
        self.assertRegex(data, rb'^YUV4MPEG2 W%d H%d F(10:1|10000:1000) ' % (W, H))
        self.assertEqual(data.count(b'FRAME\n'), 3)
        self.succeeds(*self.pull('-o', 'a.y4m', '--seconds', '0.1', '--fps', '30000/1001'))
        with open('a.y4m', 'rb') as file:
            self.assertIn(b' F30000:1001 ', file.read(80))
        os.remove('a.y4m')
        for fps in '30/', '/2', '30/0', '30/-1', '30/1/1', '1/2', '30/inf':
            self.fails(2, "--fps: '%s' cannot be used; give a number from 1 to 240" % fps,
                       *self.pull('-o', 'a.y4m', '--fps', fps))

    def test_apng(self):
        for fps, delay in ('10', (1, 10)), ('30', (1, 30)), ('23.976', (125, 2997)), ('30000/1001', (1001, 30000)):
            self.check_apng(fps, delay)

    def check_apng(self, fps, delay):
        self.succeeds(*self.pull('-o', 'a.apng', '--seconds', str(float(2 / fractions.Fraction(fps))), '--fps', fps))
        with open('a.apng', 'rb') as file:
            data = file.read()
        os.remove('a.apng')
        at, kinds, numbers, pixels = 8, [], [], []
        while at < len(data):
            size, kind = struct.unpack('>I4s', data[at:at + 8])
            body = data[at + 8:at + 8 + size]
            self.assertEqual(struct.unpack('>I', data[at + 8 + size:at + 12 + size])[0],
                             zlib.crc32(kind + body))
            kinds.append(kind)
            if kind == b'fcTL':
                numbers.append(struct.unpack('>I', body[:4])[0])
                self.assertEqual(struct.unpack('>II', body[4:12]), (W, H))
                self.assertEqual(struct.unpack('>HH', body[20:24]), delay)
                pixels.append(b'')
            elif kind == b'fdAT':
                numbers.append(struct.unpack('>I', body[:4])[0])
                pixels[-1] += body[4:]
            elif kind == b'IDAT':
                pixels[-1] += body
            elif kind == b'acTL':
                self.assertEqual(struct.unpack('>II', body), (3, 0))
            at += size + 12
        self.assertEqual(numbers, list(range(len(numbers))))
        self.assertEqual((kinds[0], kinds[1], kinds[-1]), (b'IHDR', b'acTL', b'IEND'))
        self.assertEqual([len(zlib.decompress(p)) for p in pixels], [(W * 3 + 1) * H] * 3)

    def test_encoder(self):
        folder = os.path.join(self.folder, 'bin')
        os.mkdir(folder)
        for script, status in (('cat > "$last"', 0), ('exit 3', 1), ('cat >/dev/null; exit 1', 1)):
            with open(os.path.join(folder, 'ffmpeg'), 'w') as file:
                file.write('#!/bin/sh\nfor last; do :; done\nlast=${last#file:}\n' + script)
            os.chmod(os.path.join(folder, 'ffmpeg'), 0o755)
            result = self.run_it(*self.pull('-o', 'a.mp4', '--seconds', '0.2', '--fps', '10'),
                                 env={**os.environ, 'PATH': folder + ':' + os.environ['PATH']})
            self.assertEqual(result.returncode, status, result.stderr)
            self.assertEqual(os.path.exists('a.mp4'), status == 0)
            if status == 0:
                self.assertEqual(os.path.getsize('a.mp4'), W * H * 3 * 3)
                os.remove('a.mp4')
            self.assertEqual([n for n in os.listdir('.') if 'tmp' in n], [])
        result = self.run_it(*self.pull('-o', 'a.mp4'), env={**os.environ, 'PATH': '/nonexistent'})
        self.assertEqual((result.returncode, result.stderr.count('\n')), (1, 1))
        self.assertIn('a.mp4: there is no ffmpeg program', result.stderr)
        shutil.rmtree(folder)

    @unittest.skipUnless(shutil.which('ffmpeg') and shutil.which('ffprobe'), 'there is no ffmpeg')
    def test_colours_of_films(self):
        """A film says by what its Y, U and V are R, G and B, and they are the photo's."""
        colours = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (200, 120, 40), (90, 90, 90)]
        with open('colours.ppm', 'wb') as file:
            file.write(b'P6\n80 32\n255\n' + b''.join(bytes(c) * 16 for c in colours) * 32)
        with open('flat.pgm', 'wb') as file:
            file.write(b'P5\n80 32\n255\n' + bytes([9]) * 80 * 32)
        encoders = subprocess.run(['ffmpeg', '-encoders'], capture_output=True, text=True).stdout
        for name, encoder in ('a.mp4', 'libx264'), ('a.webm', 'libvpx'):
            if encoder not in encoders:
                continue
            self.succeeds('pull', 'colours.ppm', '--depth', 'flat.pgm', '-o', name, '--seconds', '0.2',
                          '--fps', '10')
            said = subprocess.run(['ffprobe', '-v', 'error', '-of', 'json', '-show_streams', name],
                                  capture_output=True, check=True).stdout
            stream = json.loads(said)['streams'][0]
            self.assertEqual([stream['color_' + of] for of in ('space', 'primaries', 'transfer', 'range')],
                             ['bt709', 'bt709', 'iec61966-2-1', 'tv'])
            subprocess.run(['ffmpeg', '-v', 'error', '-y', '-i', name, '-frames:v', '1', '-vf',
                            'scale=in_color_matrix=bt709:in_range=tv,format=rgb24', 'frame.ppm'], check=True)
            with open('frame.ppm', 'rb') as file:
                frame = file.read()[-80 * 32 * 3:]
            for i, colour in enumerate(colours):
                at = (16 * 80 + 16 * i + 8) * 3
                self.assertLessEqual(max(abs(a - b) for a, b in zip(frame[at:at + 3], colour)), 4)
            os.remove(name)

    def test_interrupted(self):
        for name, *more in (('f-%02d.ppm',), ('a.y4m',), ('a.apng',), ('a.y4m', '--wiggle', '9')):
            before = sorted(os.listdir('.'))
            process = subprocess.Popen([REFOCUS, *self.pull('-o', name, '--seconds', '3600', *more)],
                                       stderr=subprocess.PIPE, text=True)
            while sorted(os.listdir('.')) == before and process.poll() is None:
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            self.assertIn('interrupted', process.communicate(timeout=60)[1])
            self.assertEqual(process.returncode, 1)
            self.assertEqual(sorted(os.listdir('.')), before)

    def test_settings_describe_the_pull(self):
        self.succeeds(*self.pull('-o', 'f-%02d.ppm', '--seconds', '0.2', '--fps', '10', '--from',
                                 '0.9', '--save-settings', 's.json'))
        frames = self.frames(3)
        self.succeeds('pull', 'photo.ppm', '-o', 'f-%02d.ppm', '--settings', 's.json')
        self.same(self.frames(3), frames)
        os.remove('s.json')


if __name__ == '__main__':
    unittest.main()
