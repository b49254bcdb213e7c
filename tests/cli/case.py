"""What the tests of the refocus command share: a folder of small pictures, and how a command
succeeds, reports or fails. Usage of a test: TEST.py REFOCUS [unittest arguments]"""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
import zlib

import pictures

REFOCUS = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else 'refocus'
ROOT = os.environ.get('REFOCUS_SOURCE_ROOT', os.path.join(os.path.dirname(__file__), '../..'))
PHOTOS = os.environ.get('REFOCUS_PHOTOS', os.path.join(ROOT, '../shared/photos'))
W, H = 48, 32
os.environ['XDG_CONFIG_HOME'] = os.devnull  # nobody's own configuration
# What nohup and the background of a script ignore, commands would ignore, too: a signal that has a
# handler is theirs as usual.
for ignored in signal.SIGHUP, signal.SIGINT:
    if signal.getsignal(ignored) == signal.SIG_IGN:
        signal.signal(ignored, lambda *_: None)


class Case(unittest.TestCase):
    """Runs in a folder of its own with photo.ppm, depth.pgm and friends. With REFOCUS_BRIEF every
    third test runs, chosen by its name: for sanitizers, which take half a second for a command."""

    def run(self, result=None):
        name = self._testMethodName
        if 'REFOCUS_BRIEF' in os.environ and zlib.crc32(name.encode()) % 3:
            return result
        return super().run(result)

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='refocus-cli-')
        os.chdir(cls.folder)
        pictures.ppm('photo.ppm', W, H,
                     lambda x, y: ((x * 5) & 255, (y * 8) & 255, ((x ^ y) & 7) * 32))
        pictures.pgm('depth.pgm', W, H, lambda x, y: 255 if x >= W // 2 else 51)
        pictures.pgm('mm.pgm', W, H,
                     lambda x, y: 0 if (x, y) == (3, 3) else 500 if x < 24 else 2000, 65535)
        pictures.pfm('metres.pfm', W, H, lambda x, y: 0.5 if x < 24 else 2.0)
        pictures.ppm('plain.ppm', W, H, lambda x, y: (90, 160, 30))

    @classmethod
    def tearDownClass(cls):
        os.chdir('/')
        shutil.rmtree(cls.folder)

    def run_it(self, *arguments, **more):
        return subprocess.run([REFOCUS, *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=300,
                              stdin=subprocess.DEVNULL, **more)

    def succeeds(self, *arguments):
        result = self.run_it(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ''), arguments)
        return result.stdout

    def warns(self, line, *arguments):
        """Success with this one line on standard error; returns the report of --json."""
        result = self.run_it(*arguments, '--json')
        self.assertEqual((result.returncode, result.stderr), (0, 'refocus: ' + line + '\n'),
                         arguments)
        return json.loads(result.stdout)

    def reports(self, *arguments):
        """The object that --json prints, alone on standard output."""
        return json.loads(self.succeeds(*arguments, '--json'))

    def fails(self, status, line, *arguments):
        """Exactly this line, this status, nothing printed, no file made or changed."""
        before = {name: os.stat(name).st_mtime_ns for name in os.listdir('.')}
        result = self.run_it(*arguments)
        after = {name: os.stat(name).st_mtime_ns for name in os.listdir('.')}
        self.assertEqual(result.stdout, '', arguments)
        if isinstance(line, str):
            self.assertEqual(result.stderr, 'refocus: ' + line + '\n', arguments)
        else:
            self.assertRegex(result.stderr, line, arguments)
        self.assertEqual(result.stderr.count('\n'), 1, arguments)
        self.assertTrue(result.stderr.startswith('refocus: '), arguments)
        self.assertEqual(result.returncode, status, arguments)
        self.assertEqual(before, after, arguments)

    def differs(self, a, b, what=None):
        self.assertFalse(a == b, what)  # without pages of samples

    def same(self, a, b, what=None):
        self.assertTrue(a == b, what)

    def render(self, *arguments):
        return ('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm') + arguments
