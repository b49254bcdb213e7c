#!/usr/bin/env python3
"""usage: test_pages.py  -- scores that moved are found in pages, and nothing else; what the scripts that
write pages say without scenes or a build; the README's table is of the pages."""
import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS))
import pages  # noqa: E402

PAGE = """# A page
## Methods

| run | what | PSNR | SSIM | ms |
| --- | --- | --- | --- | --- |
| `a` | one | 30.00 | 0.9600 | 5 |
| `b` | two | 28.50 | 0.9500 | 6 |

| run | what | PSNR | SSIM | ms |
| --- | --- | --- | --- | --- |
| `a` | one | 44.00 | 0.9900 | 5 |

## SSIM of each view

| scene | df | `a` |
| --- | --- | --- |
| fence | 0.5 | 0.9700 |
"""


class Check(unittest.TestCase):
    def check(self, old, new):
        """What check() says, line by line, and how it ends."""
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / 'page.md'
            page.write_text(old, encoding='utf-8')
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                try:
                    pages.check(page, new, 'make it')
                except SystemExit as end:
                    return out.getvalue().splitlines(), end.code
        return out.getvalue().splitlines(), 0

    def test_what_holds(self):
        """Rounding, times, and rows that were not measured."""
        for old, new in (('', ''), ('30.00', '30.05'), ('0.9700', '0.9691'), (' 6 |', ' 9 |'),
                         ('| `b` | two | 28.50 | 0.9500 | 6 |\n', '')):
            words, status = self.check(PAGE, PAGE.replace(old, new, 1))
            self.assertEqual((len(words), status), (1, 0), (old, new, words))

    def test_what_moved(self):
        for old, new, row in (('28.50', '28.44', 'Methods: `b`, two: PSNR: the page has 28.50, '
                                                 'measured 28.44'),
                              ('0.9900', '0.9889', 'Methods: `a`, one: SSIM: the page has 0.9900'),
                              ('0.9700', '0.9720', 'SSIM of each view: fence, 0.5: `a`: '),
                              ('28.50', 'inf', 'Methods: `b`, two: PSNR: '),
                              ('| `b`', '| `c`', 'Methods: `c`, two: PSNR: the page has no such')):
            words, status = self.check(PAGE, PAGE.replace(old, new, 1))
            self.assertTrue(words and words[0].startswith(row), (row, words))
            self.assertIn('make it', status)

    def test_nothing_measured(self):
        self.assertIn('nothing', self.check(PAGE, '# A page\n')[1])


class Scripts(unittest.TestCase):
    def say(self, *command, scenes=pages.DATA):
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                              env=dict(os.environ, REFOCUS_SCENES=str(scenes)))
        return done.returncode, done.stderr.splitlines()

    def test_without_scenes_or_build(self):
        with tempfile.TemporaryDirectory() as empty:
            for script in 'quality/run.py', 'quality/depth.py', 'papers/papers.py':
                for scenes in empty, pages.DATA:
                    status, words = self.say(sys.executable, TESTS / script, empty, '--check',
                                             scenes=scenes)
                    self.assertEqual(status, 1, words)
                    self.assertRegex(words[-1], r'^\w+\.py: .*' + empty)
                    self.assertNotIn('Traceback', ''.join(words))

    def test_pages(self):
        for arguments in (), ('--check',), ('/nowhere', 'quality'):
            status, words = self.say(TESTS / 'pages.sh', *arguments)
            self.assertEqual(status, 2)
            self.assertTrue(words[0].startswith('usage: tests/pages.sh '))
        with tempfile.TemporaryDirectory() as build:
            cli = Path(build) / 'platform' / 'cli'
            cli.mkdir(parents=True)
            (cli / 'refocus').touch(0o755)
            status, words = self.say(TESTS / 'pages.sh', build, 'no-such-page')
            self.assertEqual((status, words), (1, ["tests/pages.sh: no page 'no-such-page'"]))

    def test_readme(self):
        status, words = self.say(sys.executable, TESTS / 'readme_measured.py', '--check')
        self.assertEqual((status, words), (0, []))


if __name__ == '__main__':
    unittest.main()
