#!/usr/bin/env python3
"""Files of settings: what one says is what the command line says, and what is saved makes the
same picture again. Usage: test_settings.py REFOCUS [unittest arguments]"""
import json
import os
import re
import unittest

import pictures
from case import Case


class Settings(Case):
    def write(self, **members):
        with open('s.json', 'w') as file:
            json.dump({'refocus': 1, **members}, file)

    def picture(self, *arguments):
        self.succeeds('render', 'photo.ppm', '-o', 'out.ppm', *arguments)
        picture = pictures.read_pnm('out.ppm')
        os.remove('out.ppm')
        return picture

    def test_file_is_as_good_as_the_command_line(self):
        self.write(depth='depth.pgm', focus=0.25, blur=6, aperture='polygon:5:10', rays='full',
                   sigma='off', mirror=False, method='search', background=True,
                   region=[3, 4, 20, 10], iterations=3)
        expected = self.picture('--depth', 'depth.pgm', '--focus', '0.25', '--blur', '6',
                                '--aperture', 'polygon:5:10', '--rays', 'full', '--sigma', 'off',
                                '--method', 'search', '--background', '--region', '3,4,20,10',
                                '--iterations', '3')
        self.same(self.picture('--settings', 's.json'), expected)
        self.same(self.picture('--settings=s.json'), expected)

    def test_command_line_overrules(self):
        self.write(depth='depth.pgm', focus=0.25, blur=6)
        expected = self.picture('--depth', 'depth.pgm', '--focus', '1', '--blur', '6')
        self.same(self.picture('--settings', 's.json', '--focus', '1'), expected)
        self.same(self.picture('--focus', '1', '--settings', 's.json'), expected)
        self.differs(self.picture('--settings', 's.json'), expected)

    def test_numbers_have_a_point_in_every_locale(self):
        """Also where a comma would separate: on the command line, in settings and what is printed."""
        self.write(blur=4.5)
        command = 'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm', '--json'
        for how in ['--blur', '4.5'], ['--settings', 's.json']:
            done = self.run_it(*command, *how, env={**os.environ, 'LC_ALL': 'de_DE.UTF-8'})
            self.assertEqual((done.returncode, json.loads(done.stdout)['blur']), (0, 4.5), done.stderr)

    def test_saved_settings_make_the_same_picture_and_file(self):
        for more in ((), ('--focus', '0.1', '--blur', '5.3'),
                     ('--aperture', 'polygon:6:15', '--sigma', '128', '--quality', 'best'),
                     ('--highlights', 'off', '--region', '1,2,30,20'), ('--method', 'search', '--mirror'),
                     ('--focus', '0.30000000000000004', '--far', 'inf', '--near', '0.7')):
            first = self.picture('--depth', 'depth.pgm', *more, '--save-settings', 'a.json')
            self.same(self.picture('--settings', 'a.json', '--save-settings', 'b.json'), first)
            with open('a.json') as a, open('b.json') as b:
                text = a.read()
                self.assertEqual(text, b.read())
            for word in ('output', 'threads', 'json', 'settings'):
                self.assertNotIn('"%s"' % word, text)
        os.remove('a.json')
        os.remove('b.json')

    def test_what_render_saves_other_commands_take(self):
        for more in ((), ('--bokeh', 'swirl', '--raw-preview'), ('--quality', 'best', '--fill', 'smooth'),
                     ('--gain-map', 'ignore', '--no-dither')):
            self.picture('--depth', 'depth.pgm', *more, '--save-settings', 'a.json')
            with open('a.json') as file:
                self.assertEqual(json.load(file).get('raw-preview'), True if '--raw-preview' in more
                                 else None)
            self.succeeds('sheet', 'photo.ppm', '--settings', 'a.json', '-o', 'out.ppm')
            self.succeeds('pull', 'photo.ppm', '--settings', 'a.json', '-o', 'out.y4m', '--seconds',
                          '0.05')
            view = self.run_it('view', 'photo.ppm', '--settings', 'a.json', '--seconds', '0.1',
                               env={**os.environ, 'SDL_VIDEODRIVER': 'none'})
            self.assertNotIn('a.json', view.stderr)

    def test_errors_name_file_and_setting(self):
        def fails(line, text):
            with open('s.json', 'w') as file:
                file.write(text)
            self.fails(1, line, *self.render('--settings', 's.json'))

        fails("s.json: blurr: unknown setting; did you mean 'blur'?", '{"refocus":1,"blurr":1}')
        fails('s.json: zzz: unknown setting', '{"refocus":1,"zzz":1}')
        fails('s.json: threads: does not describe the picture; give it on the command line',
              '{"refocus":1,"threads":1}')
        fails("s.json: blur: '945' cannot be used; give a number from 0 to 944",
              '{"refocus":1,"blur":945}')
        fails("s.json: blend: 'foo' cannot be used; give one of linear, stored, gamma",
              '{"refocus":1,"blend":"foo"}')
        fails('s.json: mirror: give true or false', '{"refocus":1,"mirror":1}')
        fails('s.json: blur: give a number or a text', '{"refocus":1,"blur":null}')
        fails('s.json: region: give numbers, as [1, 2]', '{"refocus":1,"region":{}}')
        for text in ('{}', '{"refocus":2}', '{"refocus":"1"}', '[]', '3'):
            fails(re.compile('^refocus: s.json: (holds no settings: its member "refocus" should '
                             'be 1|is not JSON: line 1, )'), text)
        for text in ('', '{', '{"refocus":1,"blur":1,"blur":2}', '\x00'):
            fails(re.compile('^refocus: s.json: is not JSON: line '), text)
        os.remove('s.json')
        self.fails(1, re.compile('^refocus: s.json: cannot open it: '),
                   *self.render('--settings', 's.json'))
        self.fails(2, re.compile('^refocus: s.txt: no such format is written; '),
                   *self.render('--save-settings', 's.txt'))
        self.fails(1, re.compile('^refocus: no/s.json: the folder no cannot be written to '),
                   *self.render('--save-settings', 'no/s.json'))

    def test_files_that_are_too_large(self):
        with open('s.json', 'w') as file:
            file.write('{"refocus":1' + ' ' * (1 << 20) + '}')
        self.fails(1, 's.json: it is larger than the limit of 1048576 bytes',
                   *self.render('--settings', 's.json'))


if __name__ == '__main__':
    unittest.main()
