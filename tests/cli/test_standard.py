#!/usr/bin/env python3
"""`refocus render` from standard input and to standard output, and the size and the quality of what
it writes. Usage: test_standard.py REFOCUS [unittest arguments]"""
import os
import resource
import signal
import subprocess
import time
import unittest

import pictures
from case import Case, H, REFOCUS, W

BLUR = ('--depth', 'depth.pgm', '--blur', '5', '--focus', '1')


def light(code, most):
    value = code / most
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def code(value, most):
    value = value * 12.92 if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return int(min(value, 1) * most + 0.5)


def overlaps(at, size, new):
    """(pixel, share) of what lies under a pixel of the smaller side."""
    begin, end = at * size / new, (at + 1) * size / new
    pixels = [(i, min(i + 1, end) - max(i, begin)) for i in range(int(begin), size) if i < end]
    return [(i, share / (end - begin)) for i, share in pixels if share > 0]


def smaller(rows, width, height, new_width, new_height, most):
    """The mean of areas in linear light; rows of R, G, B in a line."""
    out = []
    for y in range(new_height):
        line = []
        for x in range(new_width):
            for c in range(3):
                line.append(code(sum(v * h * light(rows[j][3 * i + c], most)
                                     for j, v in overlaps(y, height, new_height)
                                     for i, h in overlaps(x, width, new_width)), most))
        out.append(line)
    return out


class Standard(Case):
    def piped(self, data, *arguments, status=0):
        result = subprocess.run([REFOCUS, 'render', *arguments], input=data, timeout=300,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, status, result.stderr)
        if not status:
            self.assertEqual(result.stderr, b'')
        return result.stdout if not status else result.stderr.decode()

    def test_info(self):
        """The same as of a file, but for its name; of photos and of depth maps."""
        for name in 'photo.ppm', 'depth.pgm', 'mm.pgm', 'metres.pfm':
            for more in (), ('--json',):
                with open(name, 'rb') as file:
                    piped = subprocess.run([REFOCUS, 'info', '-', *more], stdin=file,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                self.assertEqual((piped.returncode, piped.stderr), (0, ''), name)
                self.assertEqual(piped.stdout.replace('"-"', '"%s"' % name)
                                 .replace('file          -\n', 'file          %s\n' % name),
                                 self.succeeds('info', name, *more))
        broken = subprocess.run([REFOCUS, 'info', '-'], input=b'P6\n9 9\n255\n',
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual((broken.returncode, broken.stdout), (1, b''))
        self.assertRegex(broken.stderr, b'^refocus: -: [^\n]*\n$')

    def file(self, name, *arguments, photo='photo.ppm'):
        """The bytes that the command writes into a file of that name."""
        self.succeeds('render', photo, *BLUR, '-o', name, *arguments)
        data = pictures.read_bytes(name)
        os.remove(name)
        return data

    def rows(self, *arguments):
        data = self.file('small.ppm', *arguments).split(b'\n', 3)
        width, height = map(int, data[1].split())
        return [list(data[3][3 * width * y:3 * width * (y + 1)]) for y in range(height)]

    def test_both_ends(self):
        photo = pictures.read_bytes('photo.ppm')
        before = sorted(os.listdir('.'))
        self.same(self.piped(photo, '-', *BLUR, '-o', '-'), self.file('out.ppm'))
        self.same(self.piped(b'', 'photo.ppm', *BLUR, '-o-'), self.file('out.ppm'))
        for name in 'png', 'jpg', 'pfm':  # of the photo's kind, or as it is asked for
            whole = self.file('out.' + name)
            self.same(self.piped(photo, '-', *BLUR, '-o', '-', '--format', name), whole)
            with open('kind', 'wb') as file:
                file.write(whole)
            self.same(self.piped(whole, '-', *BLUR, '-o', '-'),
                      self.file('out.' + name, photo='kind'))
            os.remove('kind')
        self.piped(photo, '-', *BLUR, '-o', 'out.ppm')
        self.same(pictures.read_bytes('out.ppm'), self.file('out.ppm'))
        self.piped(photo, '-', *BLUR, '-o', '.', '--format', 'png')
        os.remove('stdin.png')
        self.assertEqual(sorted(os.listdir('.')), before)

    def test_nothing_is_left(self):
        """No temporary file, whatever becomes of standard output."""
        os.mkdir('temporary')
        environment = dict(os.environ, TMPDIR=os.path.abspath('temporary'))
        for out, status in ('/dev/full', 1), ('/dev/null', 0):
            with open(out, 'wb') as file:
                result = subprocess.run([REFOCUS, 'render', 'photo.ppm', *BLUR, '-o', '-'],
                                        stdout=file, stderr=subprocess.PIPE, env=environment)
            self.assertEqual(result.returncode, status)
            self.assertEqual(os.listdir('temporary'), [])
        os.rmdir('temporary')
        result = subprocess.run([REFOCUS, 'render', 'photo.ppm', *BLUR, '-o', '-'],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
        self.assertEqual((result.returncode, result.stdout), (1, b''))
        self.assertRegex(result.stderr.decode(), '^refocus: standard output: .*\n$')

    def test_its_name_in_messages(self):
        """The temporary file is nobody's business: neither where it cannot be written, nor in what is
        told of the picture."""
        old = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, old[1]))
        try:
            for restore in False, True:  # an error of the write, and a signal
                result = subprocess.run([REFOCUS, 'render', 'photo.ppm', *BLUR, '-o', '-'],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        restore_signals=restore)
                self.assertEqual((result.returncode, result.stdout, result.stderr), (
                    -signal.SIGXFSZ if restore else 1, b'',
                    b'refocus: standard output: cannot write it: File too large\n'))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, old)

    def test_its_name_in_warnings(self):
        jpeg = self.file('commented.jpg')
        jpeg = jpeg[:2] + b'\xff\xfe\0\6Leaf' + jpeg[2:]
        result = subprocess.run([REFOCUS, 'render', '-', *BLUR, '-o', '-', '--format', 'png'],
                                input=jpeg, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual((result.returncode, result.stderr), (
            0, b"refocus: standard output: it is written without the photo's comments; a JPEG "
            b'keeps them\n'))

    def test_nobody_else_reads_it(self):
        os.mkdir('temporary')
        environment = dict(os.environ, TMPDIR=os.path.abspath('temporary'))
        process = subprocess.Popen([REFOCUS, 'render', 'photo.ppm', *BLUR, '-o', '-'],
                                   stdout=subprocess.DEVNULL, env=environment,
                                   preexec_fn=lambda: os.umask(0))
        modes = set()
        while process.poll() is None:
            for entry in os.scandir('temporary'):
                try:
                    modes.add(entry.stat().st_mode & 0o077)
                except FileNotFoundError:
                    pass
        self.assertEqual(process.returncode, 0)
        self.assertLessEqual(modes, {0})
        os.rmdir('temporary')

    def test_info_of_floats(self):
        self.succeeds('render', 'photo.ppm', *BLUR, '-o', 'floats.pfm')
        self.assertIn(', upright, floats\n', self.succeeds('info', 'floats.pfm'))
        self.assertIn(', upright, 8 bits a channel\n', self.succeeds('info', 'photo.ppm'))
        os.remove('floats.pfm')

    def test_depth_is_a_file(self):
        self.fails(2, "--depth: '-' is standard input, which is for the photo; give a file",
                   'render', 'photo.ppm', '--depth', '-', '-o', 'x.ppm')

    def test_what_is_refused(self):
        photo = pictures.read_bytes('photo.ppm')
        for line, data, status, arguments in (
                ('-: it is empty', b'', 1, ('-', '-o', '-')),
                ('-: its content is of no known format', b'no picture', 1, ('-', '-o', '-')),
                ('-: its 48 x 32 pixels are more than the limit', photo, 1,
                 ('-', '-o', '-', '--max-pixels', '9')),
                ('-: it stands for one photo; give that alone', photo, 2,
                 ('-', 'photo.ppm', '-o', 'x-{n}.ppm')),
                ('-: it stands for one photo; give that alone', b'', 2,
                 ('photo.ppm', 'plain.ppm', '-o', '-')),
                ("--json: standard output is the picture's; give -o a file", b'', 2,
                 ('photo.ppm', '-o', '-', '--json')),
                ("--repeat: standard output is the picture's; give -o a file", b'', 2,
                 ('photo.ppm', '-o', '-', '--repeat', '2')),
                ('--format: x.ppm says the format by its end; leave it out, or end it in {ext}',
                 b'', 2, ('photo.ppm', '-o', 'x.ppm', '--format', 'png')),
                ('--jpeg-quality: it changes nothing of x.ppm, which is no JPEG or HEIC; '
                 'leave it out', b'', 2, ('photo.ppm', '-o', 'x.ppm', '--jpeg-quality', '50')),
                ('--jpeg-quality: it changes nothing of standard output, which is no JPEG or HEIC; '
                 'leave it out', b'', 2, ('photo.ppm', '-o', '-', '--jpeg-quality', '50'))):
            error = self.piped(data, *arguments, *BLUR, status=status)
            self.assertTrue(error.startswith('refocus: ' + line), error)
            self.assertEqual(error.count('\n'), 1)
        self.assertFalse(os.path.exists('x.ppm'))

    def test_a_folder_of_that_name(self):
        """- stays standard input and output."""
        data = pictures.read_bytes('photo.ppm')
        wanted = self.piped(data, '-', *BLUR, '-o', '-')
        os.mkdir('-')
        self.addCleanup(os.rmdir, '-')
        self.assertEqual(self.piped(data, '-', *BLUR, '-o', '-'), wanted)

    def test_closed_files(self):
        """Where a parent has closed standard files nothing else is opened in their place: messages
        would be written into it, and live would take commands from it."""
        def close():
            for file in range(3):
                os.close(file)

        live = subprocess.Popen([REFOCUS, 'live', '--camera', 'replay::size 64x48;fps 100',
                                 '--depth', 'depth.pgm', '--out', 'raw:frames.yuv'],
                                preexec_fn=close)
        try:
            for _ in range(6000):
                self.assertIsNone(live.poll())
                if os.path.exists('frames.yuv') and os.path.getsize('frames.yuv'):
                    break
                time.sleep(0.01)
            else:
                self.fail('live writes no frame')
            self.assertEqual([os.readlink('/proc/%d/fd/%d' % (live.pid, file))
                              for file in range(3)], 3 * ['/dev/null'])
        finally:
            live.terminate()
            live.wait()

    def test_sizes(self):
        full = self.rows()
        for size, width, height in (('50%', 24, 16), ('20', 20, 13), ('20x5', 8, 5),
                                    ('1', 1, 1), ('33.3%', 16, 11), ('47x99', 47, 31)):
            small = self.rows('--resize', size)
            wanted = smaller(full, W, H, width, height, 255)
            self.assertEqual((len(small[0]), len(small)), (3 * width, height), size)
            self.assertLessEqual(max(abs(a - b) for r, s in zip(small, wanted)
                                     for a, b in zip(r, s)), 0, size)
        for size in '48', '100%', '48x32', '65535', '999x999':  # never larger
            self.assertEqual(self.rows('--resize', size), full)
        report = self.reports(*self.render('--resize', '24'))
        self.assertEqual((report['width'], report['height']), (24, 16))
        os.remove('out.ppm')
        for size in ('0', '0x5', '5x0', '0%', '101%', '65536', '5x', 'x5', '', '5 %', '-5', '1e2',
                     '5%%', '.%', '1.2.3%', '20px', '99999999999'):
            line = ("--resize: '%s' cannot be used; give a width W, WxH, up to 65535, or "
                    "N%% up to 100%%" % size
                    if size else '--resize: is empty; give SIZE')
            self.fails(2, line, *self.render('--resize=' + size))

    def test_deep_sizes(self):
        """16 bits and floats keep what they have."""
        pictures.png('deep.png', W, H, [b''.join(
            int.to_bytes((997 * x + 211 * y * (c + 1)) % 65536, 2, 'big') for x in range(W)
            for c in range(3)) for y in range(H)], 16)
        still = ('render', 'deep.png', '--depth', 'depth.pgm', '--blur', '0', '-o')
        self.succeeds(*still, 'half.png', '--resize', '24')
        self.succeeds(*still, 'whole.png')
        def codes(name):
            return [[int.from_bytes(row[i:i + 2], 'big') for i in range(0, len(row), 2)]
                    for row in pictures.read_png(name)[4]]

        wanted = [value for row in smaller(codes('whole.png'), W, H, 24, 16, 65535)
                  for value in row]
        got = [value for row in codes('half.png') for value in row]
        self.assertEqual(len(got), len(wanted))
        self.assertLessEqual(max(abs(a - b) for a, b in zip(got, wanted)), 1)
        self.assertLess(abs(sum(got) - sum(wanted)) / len(got), 0.1)  # rounded, not cut
        pictures.pfm_colour('light.pfm', W, H, lambda x, y: (x / 7, 300.0 * (x == 9), y / 31))
        self.succeeds('render', 'light.pfm', '--depth', 'depth.pgm', '--blur', '0', '-o',
                      'half.pfm', '--resize', '50%')
        got = pictures.read_pfm('half.pfm')[2]
        for at, value in ((0, (0.5 / 7, 0, 0.5 / 31)), (4, (8.5 / 7, 150, 0.5 / 31))):
            for c in range(3):
                self.assertAlmostEqual(got[3 * at + c], value[c], 4)
        self.fails(1, '--resize: it goes with light by sRGB, linear or gamma; leave it or '
                   '--transfer out', 'render', 'deep.png', '--depth', 'depth.pgm', '-o', 'x.png',
                   '--transfer', 'pq', '--resize', '9')
        for name in 'deep.png', 'half.png', 'whole.png', 'light.pfm', 'half.pfm':
            os.remove(name)

    def test_quality(self):
        files = {q: self.file('out.jpg', *(['--jpeg-quality', str(q)] if q else []))
                 for q in (0, 1, 40, 89, 90, 95, 100)}
        self.same(files[0], files[95])
        sizes = [len(files[q]) for q in (1, 40, 89, 90, 95, 100)]
        self.assertEqual(sizes, sorted(sizes))
        for q, data in files.items():  # SOF0, its first component: 1x1, or 2x2 with less colour
            at = data.index(b'\xff\xc0')
            self.assertEqual(data[at + 11], 0x22 if 0 < q < 90 else 0x11, q)
        for bad in '0', '101', '9.5', 'x':
            self.fails(2, "--jpeg-quality: '%s' cannot be used; give a whole number from 1 to 100" %
                       bad, *self.render('--jpeg-quality', bad))


if __name__ == '__main__':
    unittest.main()
