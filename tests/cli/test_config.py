#!/usr/bin/env python3
"""The configuration file and presets: what they say is what the command line says, which overrules
them, and every mistake is told with its file and line. Usage: test_config.py REFOCUS [unittest
arguments]"""
import os
import re
import unittest

import pictures
from case import Case

FILE = 'xdg/refocus/config'


class Config(Case):
    def setUp(self):
        os.makedirs('xdg/refocus', exist_ok=True)
        os.environ['XDG_CONFIG_HOME'] = os.path.abspath('xdg')

    def write(self, text, file=FILE):
        with open(file, 'w', encoding='utf-8') as out:
            out.write(text)

    def picture(self, *arguments):
        self.succeeds(*self.render(*arguments))
        return pictures.read_bytes('out.ppm')

    def test_section_of_the_command(self):
        expected = self.picture('--config', 'none', '--blur', '5', '--focus', '1', '--no-dither')
        self.write('# mine\n[sheet]\nblur = 20\n\n[render]\n  blur=5 \r\nfocus = 1\nno-dither = yes\n'
                   'threads = 1')
        self.same(self.picture(), expected)
        self.differs(self.picture('--config', 'none'), expected)
        self.write('\ufeff[render]\nblur = 5\nfocus = 1\nno-dither = yes\n')
        self.same(self.picture(), expected)
        self.write('[render]\nblur = 5\nfocus = 1\n', 'other')
        self.write('[render]\nblurr = 5\n')
        self.same(self.picture('--config', 'other'), expected)
        self.assertIn('--preset', self.succeeds('render', '--help'))  # whatever the file says

    def test_command_line_overrules(self):
        expected = self.picture('--blur', '5', '--focus-at', '40,9')
        self.write('[render]\nf-number = 2\nfocus = 0.5\n[preset mine]\nblur = 5\n')
        self.same(self.picture('--blur', '5', '--focus-at', '40,9'), expected)
        self.same(self.picture('--preset', 'mine', '--focus-at=40,9'), expected)
        self.same(self.picture('--preset=mine', '--blur', '7', '--focus', '0'),
                  self.picture('--blur', '7', '--focus', '0'))
        self.fails(2, '--f-number: the blur is given twice; give --blur or --f-number',
                   *self.render('--blur', '5', '--f-number', '2'))

    def test_file_of_settings(self):
        """It is the same picture for everybody."""
        self.write('{"refocus": 1, "focus": 1}', 's.json')
        self.write('[render]\nblur = 5\n')
        self.same(self.picture('--settings', 's.json'),
                  self.picture('--config', 'none', '--focus', '1'))
        self.same(self.picture('--settings', 's.json', '--config', FILE),
                  self.picture('--focus', '1'))

    def test_presets(self):
        self.write('')
        names = ['portrait', 'close-up', 'night', 'swirl', 'cinema', 'mirror', 'draft', 'paper']
        text = self.succeeds('render', '--help-all')
        found = {}
        for name in names:
            self.assertRegex(text, r'\n {28,}%s ' % name)
            result = self.run_it(*self.render('--preset', name, '--rays', '16', '--near', '1',
                                              '--far', '9', '--blur', '6'))
            self.assertEqual((result.returncode, result.stderr), (0, ''), name)
            found[name] = pictures.read_bytes('out.ppm')
        self.differs(found['cinema'], found['swirl'])
        self.same(found['draft'], self.picture('--config', 'none', '--quality', 'preview',
                                               '--rays', '16', '--near', '1', '--far', '9',
                                               '--blur', '6'))
        # the user's own comes first, and goes with every command that has its options
        self.write('[preset draft]\nblur = 5\nlow-memory = no\n[preset other]\nblur = 3\n')
        self.same(self.picture('--preset', 'draft'), self.picture('--blur', '5'))
        self.succeeds('sheet', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'sheet.ppm', '--preset',
                      'draft')
        self.fails(2, "--preset: 'potrait' is not known; did you mean portrait?",
                   *self.render('--preset', 'potrait'))
        self.fails(2, "--preset: 'othr' is not known; did you mean other?",
                   *self.render('--preset', 'othr'))
        self.fails(2, "--preset: 'zzzzzzz' is not known; 'refocus render --help-all' lists those "
                   'built in', *self.render('--preset', 'zzzzzzz'))

    def test_mistakes(self):
        path = os.path.abspath(FILE)
        for text, line in (
                ('[render]\n\nblurr = 5', "3: blurr: unknown setting; did you mean 'blur'?"),
                ('[render]\nblurs = 5', "2: blurs: unknown setting; did you mean 'blur'?"),
                ('[render]\nblur = big', None),
                ('[render]\nblur', "2: blur: is no 'key = value', and no [section]"),
                ('[rendr]\n', "1: rendr: unknown section; give a subcommand's, or [preset NAME]"),
                ('[render\n', '1: [render: is no [section]'),
                ('blur = 5', '1: blur = 5: it is in no section; put [render] or [preset NAME] before'),
                ('[render]\noutput = x.png',
                 '2: output: it is for one call alone; give it on the command line'),
                ('[render]\njson = maybe', "2: json: 'maybe' cannot be used; give yes or no"),
                ('[preset a]\nx = 1', None)):
            self.write(text)
            expected = path + ':' + line if line else re.compile(r'^refocus: %s:2: ' % path)
            self.fails(1, expected,
                       *self.render('--preset', 'a' if '[preset' in text else 'draft'))
        self.write('[render]\n' + '\0' * 9)
        self.fails(1, path + ': is no text: it holds bytes of 0', *self.render())
        self.write('[' * 5000)
        self.fails(1, re.compile(r'^refocus: %s:1: \[+' % path), *self.render())
        self.write('x' * ((1 << 20) + 1))
        self.fails(1, path + ': it is larger than the limit of 1048576 bytes', *self.render())
        self.fails(1, re.compile('^refocus: nowhere: '), *self.render('--config', 'nowhere'))
        self.write('[render]\nblur = 5', 'mine.ppm')
        self.fails(2, re.compile('^refocus: '), 'render', 'photo.ppm', '--depth', 'depth.pgm', '--config',
                   'mine.ppm', '-o', 'mine.ppm')


if __name__ == '__main__':
    unittest.main()
