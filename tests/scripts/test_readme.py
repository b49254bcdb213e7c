#!/usr/bin/env python3
"""usage: test_readme.py REFOCUS  -- each refocus command that README.md and the page of the command
(platform/cli/README.md) show, as it stands there.

REFOCUS is of a build with everything in it, as examples/quickstart.sh makes it. Pictures of the
names that the page uses are made in a folder of the test's own. A command succeeds, or lacks a
device that this machine does not have, and says so in one line; it never lacks a part of the
build."""
import json
import os
import random
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REFOCUS = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else 'refocus'
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../..')
sys.path.insert(0, os.path.join(ROOT, 'tests/cli'))
import pictures  # noqa: E402

# What may be missing on the machine, by what the command asks for: another camera is another
# reason, but the line begins with its name.
DEVICES = ((' estimate:', r'^refocus: model\.onnx: OpenCV finds no depth network .*$'),
           (' v4l2:', r'^refocus: v4l2:/dev/video\d: .*$'),
           (' libcamera:', r'^refocus: libcamera:0: .*$'),
           (' --out window', r'^refocus: window: .* display .*$'),
           (' view ', r'^refocus: .*: no display can be opened: .*$'))
# Where the display is missing for sure: a window would wait for somebody.
NO_DISPLAY = dict(os.environ, SDL_VIDEODRIVER='none')


def code_lines(page):
    """Lines of the page's indented blocks, those that end in a backslash joined, no comments."""
    block = re.sub(r'\\\n +', '', '\n'.join(line[4:] for line in page.splitlines()
                                             if line.startswith('    ')))
    return [re.sub(r' +# .*', '', line) for line in block.splitlines()]


def read(page):
    with open(os.path.join(ROOT, page), encoding='utf-8') as file:
        return file.read()


def lines_shown():
    """Lines of both pages, but for programs."""
    pages = read('README.md') + read('platform/cli/README.md')
    lines = code_lines(re.sub(r'(?s)```.*?```', '', pages))
    return [line for line in lines if re.match(r'[\w./-]+ *', line)]


def commands():
    return [line for line in lines_shown() if re.match(r'(build/platform/cli/)?refocus ', line)]


def texture(width, height, shift=0):
    """A P6 picture of noise in blocks, moved to the left by `shift` in its lower half."""
    noise = random.Random(5)
    wide = [[noise.randrange(256) for _ in range(width // 4 + 20)] for _ in range(height // 4 + 1)]
    rows = bytearray()
    for y in range(height):
        row = wide[y // 4]
        d = shift if y >= height // 2 else shift // 2
        for x in range(width):
            rows += bytes((row[(x + d) // 4],)) * 3
    return b'P6\n%d %d\n255\n' % (width, height) + bytes(rows)


def add_lens(jpeg):
    """EXIF of a phone's lens: 4.25 mm, like 26 mm on 36 x 24 mm."""
    pack = struct.pack
    tiff = (b'II*\0' + pack('<I', 8) +
            pack('<HHHIII', 1, 0x8769, 4, 1, 26, 0) +
            pack('<HHHIIHHIHHI', 2, 0x920a, 5, 1, 56, 0xa405, 3, 1, 26, 0, 0) +
            pack('<II', 425, 100))
    app1 = b'Exif\0\0' + tiff
    return jpeg[:2] + b'\xff\xe1' + pack('>H', len(app1) + 2) + app1 + jpeg[2:]


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='refocus-readme-')
        cls.addClassCleanup(cls.leave)
        os.chdir(cls.folder)
        os.symlink(os.path.join(ROOT, 'examples'), 'examples')
        pictures.pgm('depth.pgm', 48, 32, lambda x, y: 255 if x >= 24 else 51)
        for name, width, height, shift in (('photo', 640, 480, 0), ('street', 2000, 1333, 0),
                                           ('left', 320, 240, 0), ('right', 320, 240, 24)):
            with open(name + '.ppm', 'wb') as file:
                file.write(texture(width, height, shift))
            cls.make('render', name + '.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o',
                     name + '.jpg')
        for name, focus, blur in (('far', '0', '6'), ('middle', '0.5', '6'), ('near', '1', '6'),
                                  ('small-aperture', '1', '0'), ('wide-aperture', '1', '6')):
            cls.make('render', 'left.ppm', '--depth', 'depth.pgm', '--focus', focus, '--blur', blur,
                     '-o', name + '.jpg')
        cls.make('depth', 'photo.jpg', '--depth', 'depth.pgm', '--full', '--near', '1', '--far',
                 '9', '-o', 'with-depth.jpg')
        with open('photo.jpg', 'wb') as file:
            file.write(add_lens(pictures.read_bytes('with-depth.jpg')))
        with open('photo-strokes.json', 'w', encoding='utf-8') as file:
            json.dump({'refocus-strokes': 1, 'width': 640, 'height': 480,
                       'strokes': [{'kind': 'all', 'disparity': 0.2}]}, file)
        os.mkdir('photos')
        with open('model.onnx', 'wb') as file:
            file.write(b'no network')

    @classmethod
    def leave(cls):
        os.chdir('/')
        shutil.rmtree(cls.folder)

    @staticmethod
    def run_it(*arguments):
        return subprocess.run([REFOCUS, *arguments], stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120,
                              env=NO_DISPLAY)

    @classmethod
    def make(cls, *arguments):
        result = cls.run_it(*arguments)
        if result.returncode:
            raise AssertionError('%s: %s' % (arguments, result.stderr))

    def test_commands(self):
        shown = commands()
        self.assertGreater(len(shown), 8)
        for command in shown:
            with self.subTest(command):
                if ' serve ' in command or ' --page ' in command:
                    self.serve(*shlex.split(command)[1:])
                    continue
                result = self.run_it(*shlex.split(command)[1:])
                self.assertNotIn('this build', result.stderr)
                lines = [line for asks, line in DEVICES if asks in command]
                if ' file:' in command:
                    self.assertRegex(result.stderr, r'\A\d+ frames in, 1 out, .*\n\Z')
                    result.stderr = ''
                if result.returncode == 0 or not lines:
                    self.assertEqual((result.returncode, result.stderr), (0, ''))
                else:
                    self.assertEqual(result.returncode, 1)
                    self.assertRegex(result.stderr, '|'.join(lines))
                    self.assertEqual(result.stderr.count('\n'), 1)

    def serve(self, *arguments):
        """A server prints its link, and ends when it is told to."""
        with subprocess.Popen([REFOCUS, *arguments], stdin=subprocess.DEVNULL, text=True,
                              env=dict(NO_DISPLAY, BROWSER='true'), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as server:
            self.assertRegex(server.stdout.readline(), r'^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$')
            server.terminate()
            self.assertEqual((server.wait(60), server.stderr.read()), (0, ''))

    def test_other_lines(self):
        """What is no refocus command is run by another test, which is named here."""
        others = {r'examples/quickstart\.sh': 'scripts/test_quickstart.py',
                  r'tests/run\.sh': 'scripts/test_run.py',
                  r'apt-get install ': 'scripts/test_quickstart.py',
                  r'meson setup build && ninja -C build && meson test': 'headers/installed.sh',
                  r'cc program\.c ': 'headers/installed.sh',
                  r'gst-launch-1\.0 ': 'gstreamer/test_lines.py',
                  r'gegl ': 'gegl/test_lines.py',
                  r'pip install \./platform/python': 'python/wheel.sh'}
        lines = lines_shown()
        for line in lines:
            if line in commands():
                continue
            tests = [test for start, test in others.items() if re.match(start, line)]
            self.assertEqual(len(tests), 1, line)
            self.assertTrue(os.path.exists(os.path.join(ROOT, 'tests', tests[0])))
        self.assertGreater(len(lines), len(commands()))

    def test_front(self):
        """The first paragraphs say what it is made of."""
        page = ' '.join(read('README.md').split())
        for words in ('fixed-point, NEON-friendly C core', 'depth-guided randomized intersection '
                      'search and Gaussian-weighted blending', 'libcamera and V4L2', 'OpenCV'):
            self.assertIn(words, page[:1500])

    def test_names_each_source_of_depth(self):
        shown = '\n'.join(commands())
        for pattern in (r'live .*--camera v4l2:', r'live .*--camera libcamera:',
                        r'--depth estimate:\S+\.onnx', r'--upsample joint-bilateral',
                        r'live .*--camera file:', r'depth \S+ \S+\.jpg -o', r'--strokes ',
                        r'refocus view '):
            self.assertRegex(shown, pattern)

    def test_every_option_of_render(self):
        """The page of the command says that it explains them all."""
        page = read('platform/cli/README.md')
        help_all = self.run_it('render', '--help-all').stdout
        options = re.findall(r'^ +(?:-\w, )?(--[\w-]+)', help_all, re.M)
        self.assertGreater(len(options), 100)
        self.assertEqual([option for option in options
                          if not re.search(re.escape(option) + r'(?![\w-])', page)], [])

    def test_parts_of_the_build(self):
        """What the page speaks of and its commands reach only with the right file or device."""
        with open('photo.heic', 'wb') as file:
            file.write(b'\0\0\0\x18ftypheic\0\0\0\0mif1heic' + bytes(100))
        for line, arguments in (
                ('^refocus: photo.heic: ', ('render', 'photo.heic', '-o', 'out.jpg')),
                ('^refocus: model.onnx: OpenCV finds no depth network ',
                 ('depth', 'photo.jpg', '--estimate', 'model.onnx', '--network', 'midas-small',
                  '-o', 'out.png')),
                ('^refocus: window: .* display ',
                 ('live', '--camera', 'replay::size 64x48;frames 1', '--depth', 'depth.pgm',
                  '--out', 'window'))):
            with self.subTest(arguments):
                result = self.run_it(*arguments)
                self.assertNotIn('this build', result.stderr)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertRegex(result.stderr, line)

    def test_plugins_and_python(self):
        """The parts of the build that other programs load."""
        platform = Path(REFOCUS).parents[1]
        for plugin in ('gstreamer/libgstrefocus.so', 'gegl/refocus-lens-blur.so'):
            self.assertTrue((platform / plugin).exists(), plugin)
        if 'REFOCUS_SANITIZED' in os.environ:
            self.skipTest('a library with sanitizers wants an interpreter made with them')
        code = 'import refocus; print(refocus.file_formats())'
        for python in ('python3', '/usr/bin/python3'):  # the first one that has numpy
            if subprocess.run([python, '-c', 'import numpy'], stderr=subprocess.DEVNULL).returncode:
                continue
            formats = subprocess.run([python, '-c', code], text=True, check=True,
                                     stdout=subprocess.PIPE, env=dict(
                                         os.environ, PYTHONPATH=str(platform / 'python'))).stdout
            self.assertIn('TIFF', formats)
            return
        self.skipTest('no numpy')


if __name__ == '__main__':
    unittest.main()
