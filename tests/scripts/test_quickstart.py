#!/usr/bin/env python3
"""usage: test_quickstart.py  -- what examples/quickstart.sh installs and builds, and in which folder
it begins anew. Programs that write down what they are asked stand in for apt-get and meson."""
import os
import re
import subprocess
import unittest

import stubs

SCRIPT = 'examples/quickstart.sh'
# Options that cost nothing on the first day when they are off.
NOT_ASKED = {'simd', 'tests', 'ximgproc'}


def feature_options():
    with open(os.path.join(stubs.ROOT, 'meson_options.txt'), encoding='utf-8') as file:
        return set(re.findall(r"^option\('(\w+)', type: 'feature'", file.read(), re.M)) - NOT_ASKED


def packages(name):
    """A list of tests/packages.sh."""
    script = '. tests/packages.sh; echo "${%s[@]}"' % name
    return set(subprocess.run(['bash', '-c', script], cwd=stubs.ROOT, text=True, check=True,
                              stdout=subprocess.PIPE).stdout.split())


def setups(asked):
    return [line.split() for line in asked if line.startswith('meson setup ')]


def enabled(words):
    return {word[2:-8] for word in words if re.fullmatch(r'-D\w+=enabled', word)}


class Quickstart(stubs.Case):
    def setUp(self):
        super().setUp()
        self.build = os.path.join(self.folder, 'build')
        self.folders = {'REFOCUS_BUILD': self.build,
                        'REFOCUS_OUT': os.path.join(self.folder, 'out')}

    def start(self, *arguments, **more):
        return self.run_script(SCRIPT, *arguments, **self.folders, **more)

    def old_folder(self, options):
        os.mkdir(self.build)
        with open(os.path.join(self.build, 'options'), 'w', encoding='utf-8') as file:
            file.write(''.join(option + '\n' for option in options))
        open(os.path.join(self.build, 'build.ninja'), 'w', encoding='utf-8').close()

    def installed(self, asked):
        lines = [line for line in asked if line.startswith('apt-get ') and ' install ' in line]
        return {word for line in lines for word in line.split() if not word.startswith('-')} - {
            'apt-get', 'install'}

    def test_new_folder(self):
        status, words, asked = self.start()
        self.assertEqual(status, 0, words)
        self.assertEqual(len(setups(asked)), 1)
        self.assertEqual(enabled(setups(asked)[0]), feature_options())
        for package in ('libheif-dev', 'libsdl2-dev', 'libcamera-dev', 'libopencv-dnn-dev',
                        'libopencv-calib3d-dev', 'libpng-dev', 'libturbojpeg0-dev',
                        'libexpat1-dev', 'libjansson-dev', 'g++'):
            self.assertIn(package, self.installed(asked))
        self.assertEqual(sum('refocus render ' in line for line in asked), 3)
        ninja = [line for line in asked if line.startswith('ninja ')]
        self.assertEqual([line.split()[-3:] for line in ninja],
                         [['command', 'plugins', 'python-package']])

    def test_folder_that_lacks_something(self):
        self.old_folder(['tools=enabled', 'png=enabled', 'heic=auto'])
        status, words, asked = self.start()
        self.assertEqual(status, 0, words)
        self.assertEqual([words[2] for words in setups(asked)], ['--reconfigure'])
        self.assertEqual(enabled(setups(asked)[0]), feature_options())

    def test_folder_that_remembers_too_much(self):
        self.old_folder(['tools=enabled'])
        status, words, asked = self.start(STUB_SETUP_FAILS='--reconfigure')
        self.assertEqual(status, 0, words)
        self.assertEqual([words[2] for words in setups(asked)], ['--reconfigure', '--wipe'])

    def test_folder_that_has_all(self):
        self.old_folder([name + '=enabled' for name in feature_options()])
        status, words, asked = self.start()
        self.assertEqual(status, 0, words)
        self.assertEqual(setups(asked), [])

    def test_core(self):
        status, words, asked = self.start('--core')
        self.assertEqual(status, 0, words)
        # meson is a program here, as it would be in any other place but its package.
        self.assertLessEqual(self.installed(asked), {'meson', 'ninja-build', 'gcc', 'libc6-dev'})
        self.assertIn('gcc', self.installed(asked))
        self.assertIn('-Dauto_features=disabled', setups(asked)[0])
        self.assertTrue(any('examples/refocus_ppm ' in line for line in asked))

    def test_library_that_cannot_be_had(self):
        status, words, asked = self.start(STUB_SETUP_FAILS='setup')
        self.assertEqual(status, 1)
        self.assertIn('no such library', words)
        self.assertFalse(any(line.startswith('ninja ') for line in asked))

    def test_command_line(self):
        for arguments, expected in ((('--help',), 0), (('--nix',), 2), (('--core', 'x'), 2)):
            status, words, asked = self.start(*arguments)
            self.assertEqual(status, expected, arguments)
            self.assertTrue(words.startswith('usage: examples/quickstart.sh'))
            self.assertIn('--core', words)
            self.assertEqual(setups(asked), [])

    def test_readme_names_the_same_packages(self):
        with open(os.path.join(stubs.ROOT, 'README.md'), encoding='utf-8') as file:
            line = re.search(r'apt-get install ((?:.*\\\n)*.*)\n', file.read()).group(1)
        shown = set(line.replace('\\\n', ' ').split())
        needed = packages('core_packages') | packages('feature_packages')
        self.assertEqual(needed - shown, {'libc6-dev'})  # gcc brings it
        self.assertEqual(shown - needed, {'libcmocka-dev'})


if __name__ == '__main__':
    unittest.main()
