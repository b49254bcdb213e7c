#!/usr/bin/env python3
"""usage: test_debian.py [BUILD]  -- Debian's packages are built with all that README.md installs, hold
each module, and development files depend on what their pkg-config files name; Buildroot's recipe."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEBIAN = ROOT / 'platform/packages/debian'
BUILD = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
PACKAGES = {'libturbojpeg': 'libturbojpeg0-dev', 'expat': 'libexpat1-dev', 'libpng': 'libpng-dev',
            'libheif': 'libheif-dev', 'jansson': 'libjansson-dev'}


def field(package, name):
    """The packages in a field of a paragraph of control."""
    text = next(part for part in (DEBIAN / 'control').read_text().split('\n\n')
                if re.match(rf'(Source|Package): {package}\n', part))
    found = re.search(rf'^{name}: (.*(?:\n .*)*)', text, re.M).group(1)
    return {re.match(r'[^ (<]+', word.strip()).group() for word in found.split(',')}


class Debian(unittest.TestCase):
    def test_built_with_all_of_the_readme(self):
        line = re.search(r'    apt-get install ((?:.*\\\n)*.*)', (ROOT / 'README.md').read_text())
        needed = {word for word in line.group(1).split() if word.endswith('-dev')}
        self.assertGreater(len(needed), 20)
        self.assertEqual(needed - field('librefocus', 'Build-Depends'), {'libcmocka-dev'})

    def are_with_the_libraries(self, package, names):
        """Modules are in that package, and not in the command's."""
        lines = (DEBIAN / f'librefocus-{package}.install').read_text().split()
        self.assertEqual(set(lines), {f'usr/lib/*/refocus/refocus-{name}.so' for name in names})
        rules = (DEBIAN / 'rules').read_text()
        listed = re.search(f'^{package.upper()} = (.*)', rules, re.M).group(1)
        self.assertEqual(set(listed.split()), names)
        self.assertIn(f'$({package.upper()}:%=-Xrefocus-%.so)', rules)
        self.assertIn(f'librefocus-{package}', field('librefocus0', 'Recommends'))

    def test_formats_are_with_the_libraries(self):
        self.are_with_the_libraries('formats', {
            path.parent.name for path in (ROOT / 'platform').glob('*/meson.build')
            if 'codecs +=' in path.read_text()})

    def test_cameras_are_with_the_libraries(self):
        loaded = re.findall(r'"refocus/refocus-(\w+)"',
                            (ROOT / 'platform/capture/modules.c').read_text())
        self.are_with_the_libraries('cameras', set(loaded))

    def test_development_files_depend_on_what_they_name(self):
        named = set()
        for path in (BUILD / 'meson-private').glob('refocus*.pc') if BUILD else ():
            for line in re.findall(r'^Requires(?:\.private)?: (.*)', path.read_text(), re.M):
                named |= {word.split()[0] for word in line.split(',')}
        for name in sorted(named):
            if not name.startswith('refocus'):
                self.assertIn(PACKAGES[name], field('librefocus-dev', 'Depends'))

    def test_buildroot_can_give_what_the_recipe_takes(self):
        """The JPEG library is a choice of Buildroot's user: selecting a member does nothing."""
        recipe = (ROOT / 'platform/packages/buildroot/Config.in').read_text()
        self.assertNotIn('select BR2_PACKAGE_JPEG_TURBO', recipe)
        self.assertIn('depends on BR2_PACKAGE_JPEG_TURBO', recipe)
        self.assertIn('depends on !BR2_STATIC_LIBS', recipe)


if __name__ == '__main__':
    unittest.main()
