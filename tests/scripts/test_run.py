#!/usr/bin/env python3
"""usage: test_run.py  -- which builds tests/run.sh and .ci/run make, and how they end. Programs that
write down what they are asked stand in for the compilers and meson."""
import json
import os
import re
import signal
import unittest

import stubs

EVERYTHING = ('meson ninja-build pkg-config gcc g++ libc6-dev python3 libcmocka-dev clang '
              'libopencv-core-dev libopencv-imgproc-dev libopencv-calib3d-dev libopencv-dnn-dev '
              'libturbojpeg0-dev libpng-dev libexpat1-dev libheif-dev libjansson-dev '
              'libtiff-dev libopenexr-dev libwebp-dev libjxl-dev libraw-dev libzip-dev '
              'libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev gstreamer1.0-tools '
              'gstreamer1.0-plugins-base gstreamer1.0-plugins-good libgegl-dev gegl gimp '
              'libpipewire-0.3-dev pipewire pipewire-bin wireplumber dbus-daemon gstreamer1.0-pipewire '
              'libcamera-dev libmicrohttpd-dev libsdl2-dev libsdl2-ttf-dev fonts-dejavu-core xvfb xdotool '
              'libclang-rt-dev chromium chromium-driver python3-selenium')


def result(word):
    """What meson notes of a test that ends so; `word:lines`: with these of unittest."""
    word, _, lines = word.partition(':')
    return json.dumps({'name': 'suite / name', 'result': word, 'stdout': 'it says why',
                       'stderr': '\n' + lines.replace('_', ' ').replace(';', '\n')})


class Run(stubs.Case):
    LONG = {'contrib', 'fuzz', 'msan', 'integer'}

    def start(self, script, *arguments, results='OK', **more):
        builds = os.path.join(self.folder, 'builds')
        status, words, asked = self.run_script(
            script, *arguments, installed=EVERYTHING, REFOCUS_BUILDS=builds,
            STUB_RESULTS='\n'.join(result(word) for word in results.split()), **more)
        asked = [line.replace(builds + '/', '') for line in asked]
        return status, words.splitlines(), asked

    def builds(self, asked):
        """The folders that meson was to set up, each once."""
        found = []
        for line in asked:
            words = [word for word in line.split()[2:] if not word.startswith('-')]
            if line.startswith('meson setup ') and words[0] not in found:
                found.append(words[0])
        return found

    def test_one_build(self):
        status, words, asked = self.start('tests/run.sh')
        self.assertEqual((status, words[-1]), (0, '1 passed, 0 failed, 0 skipped'), words)
        self.assertEqual(self.builds(asked), ['gcc'])
        self.assertEqual(sum(line.startswith('meson test ') for line in asked), 1)

    def test_failures(self):
        status, words, asked = self.start('tests/run.sh', results='OK FAIL TIMEOUT SKIP')
        self.assertEqual((status, words[-1]), (1, '1 passed, 2 failed, 1 skipped'))
        status, words, asked = self.start('tests/run.sh', STUB_SETUP_FAILS='setup')
        self.assertEqual((status, words[-1]), (1, '0 passed, 1 failed, 0 skipped'))

    def test_skips_of_unittest(self):
        """They count, and a test that skips all it has did not pass."""
        for lines, counts, line in (
                ('Ran_9_tests_in_1s;;OK', '1 passed, 0 failed, 0 skipped', None),
                ('Ran_9_tests_in_1s;;OK_(skipped=3)', '1 passed, 0 failed, 3 skipped', '3 of 9'),
                ('Ran_9_tests_in_1s;;OK_(skipped=9)', '0 passed, 0 failed, 9 skipped', '9 of 9'),
                ('Ran_0_tests_in_1s;;OK_(skipped=1)', '0 passed, 0 failed, 1 skipped', '1 of 1'),
                ('Ran_9_tests_in_1s;;OK_(expected_failures=2,_skipped=1)',
                 '1 passed, 0 failed, 1 skipped', '1 of 9')):
            words = self.start('tests/run.sh', results='OK:' + lines)[1]
            self.assertEqual(words[-1], counts, lines)
            shown = [word for word in words if 'SKIPPED in' in word]
            self.assertEqual(shown, [f'    SKIPPED in suite / name: {line} cases'] if line else [])

    def test_ctrl_c_ends_it(self):
        """Also where this test was begun in the background of a script."""
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        status, words, asked = self.start('.ci/run', STUB_INTERRUPT='1')
        self.assertEqual(status, 130, words)
        self.assertEqual(self.builds(asked), ['gcc'])
        self.assertEqual(sum(line.startswith('meson test ') for line in asked), 1)

    def test_where_nothing_can_be_written(self):
        status, words, asked = self.run_script('tests/run.sh', REFOCUS_BUILDS='/dev/null/builds')
        self.assertEqual((status, words, asked), (2, '/dev/null/builds cannot be written: set '
                                                  'REFOCUS_BUILDS to a folder that can\n', []))

    def test_every_build(self):
        """All of them, by continuous integration, whose last line and status count."""
        status, words, asked = self.start('.ci/run', STUB_SETUP_FAILS='setup')
        self.assertEqual(status, 1)
        self.assertRegex(words[-1], r'^0 passed, \d+ failed, \d+ skipped$')
        self.assertLessEqual({'gcc', 'clang', 'minimal', 'bare', 'asan', 'tsan',
                              'quickstart', 'quickstart--core'}, set(self.builds(asked)))
        self.assertFalse(self.LONG & set(self.builds(asked)))
        self.assertEqual([name for name in os.listdir(self.folder) if 'readme' in name], [])

    def test_long(self):
        """What continuous integration has no time for: a sanitizer looks only with its list."""
        status, words, asked = self.start('tests/run.sh', '--long', STUB_SETUP_FAILS='setup')
        self.assertEqual(status, 1)
        self.assertLessEqual(self.LONG, set(self.builds(asked)))
        for build, name in (('msan', 'memory'), ('integer', 'integer')):
            setup = next(line for line in asked if line.startswith(f'meson setup {build} '))
            listed = re.search("-fsanitize-ignorelist='([^']+)'", setup)
            self.assertTrue(listed and listed[1].endswith(f'tests/sanitizers/{name}.txt'), setup)
            self.assertTrue(os.path.exists(listed[1]))

    def test_command_line(self):
        for arguments, expected in ((('--help',), 0), (('--quick',), 2), (('--full', 'x'), 2)):
            status, words, asked = self.start('tests/run.sh', *arguments)
            self.assertEqual(status, expected, arguments)
            self.assertTrue(words[0].startswith('usage: tests/run.sh '))
            self.assertTrue(any(re.match('  --full ', line) for line in words))
            self.assertEqual(asked, [])


if __name__ == '__main__':
    unittest.main()
