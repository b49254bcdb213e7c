"""`refocus live` for tests: in an empty folder, by scripted cameras."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

REFOCUS = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else 'refocus'
SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))
SMALL = ['--blur', '3', '--rays', '4']
DEPTH = 'replay::format Z16;size 32x24;fps 30'


def content(name):
    with open(name, 'rb') as file:
        return file.read()


def live(*args, stdin=None, timeout=120, env=None, common=SMALL):
    return subprocess.run([REFOCUS, 'live', *common, *args], input=stdin, capture_output=True,
                          timeout=timeout * SLOW, env={**os.environ, **(env or {})},
                          stdin=None if stdin is not None else subprocess.DEVNULL)


class Live(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        os.chdir(self.folder.name)

    def tearDown(self):
        os.chdir('/')
        self.folder.cleanup()

    def report(self, *args, **more):
        done = live('--json', *args, **more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def check_sum(self, r):
        """Every frame that came in went out, or is counted where it was left."""
        left = (r['dropped'] + r['colour']['corrupt'] + r['colour']['damaged'] +
                r['without_depth'] + r['sink_dropped'])
        self.assertEqual(r['frames_in'], r['frames_out'] + left, r)
        self.assertEqual(r['paired'] + r['unpaired'], r['frames_out'] + r['sink_dropped'] +
                         r['dropped_rendered'], r)

    def fails(self, code, words, *args, **more):
        done = live(*args, **more)
        self.assertEqual(done.returncode, code, done.stderr)
        lines = done.stderr.decode().splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertRegex(lines[0], r'^refocus: .+: .+')
        self.assertIn(words, lines[0])
        self.assertEqual(done.stdout, b'')
