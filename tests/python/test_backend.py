#!/usr/bin/env python3
"""usage: test_backend.py  -- the options of meson that a wheel is built with."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / 'platform/python'))
import backend  # noqa: E402


class Options(unittest.TestCase):
    def test_libraries_that_are_there_are_used(self):
        given = backend.options([])
        for name in 'png', 'jpeg', 'xmp':
            self.assertFalse([option for option in given if option.startswith(f'-D{name}=')])
        for name in 'heic', 'tiff', 'opencv', 'gstreamer', 'tools', 'tests':
            self.assertIn(f'-D{name}=disabled', given)
        self.assertEqual(backend.options(['-Dheic=enabled'])[-1], '-Dheic=enabled')

    @unittest.skipUnless(shutil.which('meson'), 'no meson')
    def test_meson_takes_them(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(['meson', 'setup', folder, TOP, *backend.options([])], text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout[-1000:])

    def test_modules_are_refused(self):
        folders = {path.parent.name for path in (TOP / 'platform').glob('*/meson.build')
                   if 'codecs +=' in path.read_text()}
        self.assertEqual(set(backend.MODULES), folders)
        for name in folders:
            with self.assertRaisesRegex(ValueError, f'-D{name}: this format is a module'):
                backend.options([f'-D{name}=enabled'])


if __name__ == '__main__':
    unittest.main()
