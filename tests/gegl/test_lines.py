#!/usr/bin/env python3
"""usage: test_lines.py PLUGIN_FOLDER GEGL_FOLDER [REFOCUS]  -- what users type: the command of GEGL
with the operation, beside the command REFOCUS where there is one; and GIMP, where it is installed."""
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = TOP / 'examples/data'
sys.path.insert(0, str(TOP / 'tests/cli'))
import pictures  # noqa: E402
PLUGINS, GEGL_PLUGINS = sys.argv.pop(1), sys.argv.pop(1)
COMMAND = sys.argv.pop(1) if len(sys.argv) > 1 else None
GIMP = shutil.which('gimp-console-2.10')
OWN = 'refocus:lens-blur'
TIMEOUT = 120


def read_ppm(path):
    """Width, height and the samples of R, G and B, of 8 bits where they all are such codes."""
    data = pathlib.Path(path).read_bytes()
    head = re.match(rb'P6\s+(?:#[^\n]*\n\s*)*(\d+)\s+(\d+)\s+(\d+)\s', data)
    samples = data[head.end():]
    if int(head[3]) == 65535 and samples[::2] == samples[1::2]:
        samples = samples[::2]
    return int(head[1]), int(head[2]), samples


class Lines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.environment = dict(os.environ, GEGL_PATH=f'{PLUGINS}:{GEGL_PLUGINS}', LC_ALL='C',
                               HOME=cls.folder, XDG_CONFIG_HOME=cls.folder)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def run_words(self, words, **environment):
        done = subprocess.run([str(word) for word in words], text=True, timeout=TIMEOUT,
                              env=dict(self.environment, **environment), errors='replace',
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout

    def gegl(self, *words, **environment):
        """What it says, but for its own remarks on what its command does not free: how many those are
        depends on when its threads end."""
        status, text = self.run_words(['gegl', *words], **environment)
        self.assertEqual(status, 0, text)
        return ''.join(line + '\n' for line in text.splitlines()
                       if line and 'gegl_tile_cache_destroy' not in line and 'EEEEeEeek' not in line)

    def refocused(self, photo, depth, *properties):
        out = os.path.join(self.folder, 'ours.ppm')
        self.assertEqual(self.gegl(photo, '-o', out, '--', OWN, *properties, 'aux=[', 'gegl:load',
                                   f'path={depth}', ']'), '')
        return read_ppm(out)

    def rendered(self, photo, depth, *options):
        out = os.path.join(self.folder, 'theirs.ppm')
        status, words = self.run_words([COMMAND, 'render', photo, '--depth', depth, '-o', out,
                                        *options])
        self.assertEqual(status, 0, words)
        return read_ppm(out)

    def test_info(self):
        text = self.gegl('--info', OWN)
        for words in ('Refocus', 'focus-x', 'pixels', '(default: 20.000000)'):
            self.assertIn(words, text)
        self.assertIn(OWN, self.gegl('--list-all').split())

    def test_two_copies(self):
        """A build beside the one that is installed: the first on the path is used, and nothing warns."""
        head, once = self.gegl('--info', OWN).split('\nProperties:\n')
        head_of_two, twice = self.gegl(
            '--info', OWN, GEGL_PATH=f'{PLUGINS}:{PLUGINS}:{GEGL_PLUGINS}').split('\nProperties:\n')
        # GEGL prints an address among the keys of every operation, so that the heads differ.
        for text in head, head_of_two:
            self.assertNotRegex(text, r'RefocusLensBlur|WARNING|CRITICAL')
        self.assertEqual(twice, once)

    @unittest.skipUnless(COMMAND, 'a build without the command')
    def test_same_as_the_command(self):
        portrait, lights = SCENES / 'portrait', SCENES / 'nightlights'
        for scene, depth, properties, options in (
                (portrait, 'disparity', 'focus=0.689 blur=20', '--focus 0.689 --blur 20'),
                (lights, 'disparity', 'focus=0.966 blur=22 aperture=polygon blades=7 rotation=15 '
                 'curvature=0.4',
                 '--focus 0.966 --blur 22 --aperture polygon:7:15 --curvature 0.4'),
                (lights, 'disparity', 'focus=0.966 blur=22 highlights=3 aperture=heart quality=best',
                 '--focus 0.966 --blur 22 --highlights 3 --aperture heart --quality best'),
                (lights, 'disparity', 'focus=0.3 blur=15 edge=0.7 cat-eye=0.4 squeeze=0.7 ring=0.3 '
                 'fringe=0.1', '--focus 0.3 --blur 15 --edge 0.7 --cat-eye 0.4 --squeeze 0.7 '
                 '--ring 0.3 --fringe 0.1'),
                (portrait, 'disparity', 'focus=0.3 depth-unit=inverse focus-width=0.1 '
                 'quality=preview', '--focus 0.3 --blur 20 --depth-unit inverse --focus-width 0.1 '
                 '--quality preview'),
                (portrait, 'disparity', 'focus-x=0.556 focus-y=0.3 focus-width=0.05 '
                 'focus-transition=0.2', '--focus-at 400,162 --blur 20 --focus-width 0.05 '
                 '--focus-transition 0.2'),
                (portrait, 'depth_lowres', 'focus=0.1', '--depth-unit disparity --focus 0.1 '
                 '--blur 20'),
                (portrait, 'disparity', 'focus=0.1 depth-edges=false', '--focus 0.1 --blur 20 '
                 '--depth-edges as-given')):
            with self.subTest(properties):
                photo, depth = scene / 'allfocus.png', scene / f'{depth}.png'
                ours = self.refocused(photo, depth, *properties.split())
                theirs = self.rendered(photo, depth, *options.split())
                self.assertEqual(ours[:2], theirs[:2])
                self.assertEqual(ours[2] == theirs[2], True)

    def test_depth_edges(self):
        """A map that is soft is made sharp, unless it is to be taken as it is given."""
        pictures = []
        for edges in 'true', 'false':
            out = os.path.join(self.folder, f'{edges}.ppm')
            self.assertEqual(self.gegl(
                SCENES / 'portrait/allfocus.png', '-o', out, '--', OWN, 'focus=0.689', f'depth-edges={edges}',
                'depth-values=perceptual', 'aux=[', 'gegl:load', f'path={SCENES}/portrait/disparity.png',
                'gegl:gaussian-blur', 'std-dev-x=4', 'std-dev-y=4', ']'), '')
            pictures.append(read_ppm(out))
        self.assertEqual(pictures[0] == pictures[1], False)

    def test_no_depth(self):
        photo, out = SCENES / 'portrait/allfocus.png', os.path.join(self.folder, 'as-it-is.ppm')
        text = self.gegl(photo, '-o', out, '--', OWN, 'blur=20')
        self.assertRegex(text, r'\A[^\n]*refocus:lens-blur: choose a depth map as aux input[^\n]*\n\Z')
        same = os.path.join(self.folder, 'same.ppm')
        self.gegl(photo, '-o', same, '--', 'gegl:nop')
        self.assertEqual(read_ppm(out) == read_ppm(same), True)

    def test_readme(self):
        """The line of the README, with a scene in place of its pictures."""
        text = (TOP / 'README.md').read_text(encoding='utf-8')
        line = re.search(r'^    gegl (.*)$', text, re.M)[1]
        out = os.path.join(self.folder, 'readme.png')
        for name, other in (('photo.jpg', SCENES / 'portrait/allfocus.png'), ('out.png', out),
                            ('depth.png', SCENES / 'portrait/disparity.png')):
            self.assertIn(name, line)
            line = line.replace(name, shlex.quote(str(other)))
        self.assertEqual(self.gegl(*shlex.split(line)), '')
        self.assertGreater(os.path.getsize(out), 1000)

    def test_scores(self):
        """The scores beside GEGL's own blurs that the page of platform has."""
        page = (TOP / 'platform/README.md').read_text(encoding='utf-8')
        rows = re.findall(r'^\| (\w+) \| ([\d.]+), (\d+) \| [\d.]+ dB \| \*\*([\d.]+) dB\*\*',
                          page, re.M)
        self.assertEqual(len(rows), 4)
        for scene, focus, blur, stated in rows:
            folder = SCENES / scene
            ours = self.refocused(folder / 'allfocus.png', folder / 'disparity.png',
                                  f'focus={focus}', f'blur={blur}')[2]
            true = b''.join(pictures.read_png(folder / f'gt_df{focus}_K{blur}.png')[4])
            squares = sum((a - b) ** 2 for a, b in zip(ours, true)) / len(true)
            self.assertEqual(len(ours), len(true))
            self.assertAlmostEqual(10 * math.log10(255 ** 2 / squares), float(stated), delta=0.05)

    def test_in_a_chain(self):
        """A part of the result, scaled input and a map of another size."""
        out = os.path.join(self.folder, 'chain.ppm')
        self.assertEqual(self.gegl(
            SCENES / 'portrait/allfocus.png', '-o', out, '--', 'gegl:scale-ratio', 'x=0.25', 'y=0.25', OWN,
            'blur=5', 'aux=[', 'gegl:load', f'path={SCENES}/portrait/disparity.png', ']',
            'gegl:crop', 'x=20', 'y=30', 'width=50', 'height=40'), '')
        self.assertEqual(read_ppm(out)[:2], (50, 40))

    @unittest.skipUnless(GIMP, 'GIMP is not installed')
    def test_gimp(self):
        """No procedure of GIMP 2.10 runs an operation of GEGL in batch, but it loads them all."""
        trace = os.path.join(self.folder, 'loads')
        status, words = self.run_words(
            [GIMP, '-i', '-n', '-d', '-f', '-s', '-b', '(gimp-quit 0)'], LD_DEBUG='files',
            LD_DEBUG_OUTPUT=trace)
        self.assertEqual(status, 0, words)
        self.assertNotIn('refocus', words)
        loads = ''.join(path.read_text(errors='replace')
                        for path in pathlib.Path(self.folder).glob('loads.*'))
        self.assertIn(f'calling init: {PLUGINS}/refocus-lens-blur.so', loads)


if __name__ == '__main__':
    unittest.main()
