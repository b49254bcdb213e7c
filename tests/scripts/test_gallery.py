#!/usr/bin/env python3
"""usage: test_gallery.py [REFOCUS]  -- the page examples/gallery.html is what its script makes, shows
what it names, and asks nobody for anything; REFOCUS takes the commands that it shows."""
import html.parser
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = TOP / 'examples/gallery.html'
MOST_BYTES = 1 << 20  # of the page and its pictures
COMMAND = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else None
# A command that writes down what it is asked, and an empty picture.
STAND_IN = '''#!/bin/sh
echo "$*" >> "$ASKED"
while [ $# -gt 1 ]; do shift; done
: > "$1"
'''


class Reader(html.parser.HTMLParser):
    """What the page holds: [(tag, attributes)], tags that are open, and the text of each <code>."""
    EMPTY = ('meta', 'img', 'input')

    def __init__(self, text):
        super().__init__()
        self.tags, self.open, self.commands = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in self.EMPTY:
            self.open.append(tag)
        if tag == 'code':
            self.commands.append('')

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if 'code' in self.open:
            self.commands[-1] += data

    def all(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]


def jpeg_size(path):
    """Width and height of a JPEG."""
    data = path.read_bytes()
    assert data[:2] == b'\xff\xd8' and data[-2:] == b'\xff\xd9', path
    at = 2
    while data[at + 1] not in (0xc0, 0xc2):
        at += 2 + int.from_bytes(data[at + 2:at + 4], 'big')
    return int.from_bytes(data[at + 7:at + 9], 'big'), int.from_bytes(data[at + 5:at + 7], 'big')


class Gallery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = PAGE.read_text(encoding='utf-8')
        cls.page = Reader(cls.text)

    def test_usage(self):
        done = subprocess.run([TOP / 'examples/gallery.sh'], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (2, ''))
        self.assertRegex(done.stderr, r'^usage: gallery.sh BUILD \[page \[FOLDER\]\]\nMakes .*')

    def test_made_by_the_script(self):
        with tempfile.TemporaryDirectory() as folder:
            command = pathlib.Path(folder, 'build/platform/cli/refocus')
            command.parent.mkdir(parents=True)
            command.write_text(STAND_IN)
            command.chmod(0o755)
            asked = os.path.join(folder, 'asked')
            subprocess.run([TOP / 'examples/gallery.sh', f'{folder}/build', 'page', f'{folder}/out'],
                           check=True, stdout=subprocess.DEVNULL, env=dict(os.environ, ASKED=asked))
            self.assertEqual(pathlib.Path(folder, 'out/gallery.html').read_text(encoding='utf-8'),
                             self.text, 'run examples/gallery.sh BUILD page')
            made = {path.name for path in pathlib.Path(folder, 'out/gallery').iterdir()}
            lines = pathlib.Path(asked).read_text(encoding='utf-8').splitlines()
        self.assertEqual(made, {path.name for path in PAGE.parent.glob('gallery/page-*')})
        self.assertEqual(len(lines), len(made))
        for command in self.page.commands:  # what is shown is what was asked for
            options = ' '.join(shlex.split(command)[5:-2])
            self.assertEqual(any(options in line for line in lines), True, command)

    def test_pictures(self):
        pictures = self.page.all('img')
        self.assertEqual(len(self.page.all('figure')), 10)
        self.assertEqual(len(pictures), 20)
        self.assertEqual(len(self.page.commands), 10)
        for picture in pictures:
            path = PAGE.parent / picture['src']
            self.assertEqual(jpeg_size(path), (int(picture['width']), int(picture['height'])), path)
            self.assertGreater(len(picture['alt']), 10)
        used = {PAGE.parent / picture['src'] for picture in pictures}
        self.assertEqual(used, set(PAGE.parent.glob('gallery/page-*')))
        self.assertLess(sum(path.stat().st_size for path in used) + PAGE.stat().st_size, MOST_BYTES)

    def test_dividers(self):
        lines = self.page.all('input')
        self.assertEqual(len(lines), 10)
        self.assertEqual({line['type'] for line in lines}, {'range'})
        self.assertEqual(len({(line['aria-label'], i) for i, line in enumerate(lines)}), 10)
        self.assertEqual(self.page.open, [])

    def test_nothing_from_outside(self):
        self.assertNotRegex(self.text, r'//[a-z]|url\(|@import|fetch\(|<link|<iframe')
        for _, attributes in self.page.tags:
            for name in 'src', 'href':
                self.assertNotRegex(attributes.get(name) or '', r'^/|:|\.\.')

    @unittest.skipUnless(COMMAND, 'a build without the command')
    def test_commands(self):
        for command in self.page.commands:
            with tempfile.TemporaryDirectory() as folder:
                words = shlex.split(command)
                self.assertEqual(words[0], 'refocus')
                done = subprocess.run(
                    [COMMAND, *words[1:-1], f'{folder}/out.jpg', '--quality', 'preview'], text=True,
                    cwd=TOP / 'examples/data', stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.assertEqual((done.returncode, done.stdout), (0, ''), command)
                self.assertEqual(jpeg_size(pathlib.Path(folder, 'out.jpg')), (720, 540))


if __name__ == '__main__':
    unittest.main()
