#!/usr/bin/env python3
"""The refocus command: every option at and beyond its limits, every error line, no
leftovers. Usage: test_cli.py REFOCUS [unittest arguments]"""
import base64
import json
import os
import re
import shutil
import struct
import subprocess
import unittest

import pictures
from case import Case, H, REFOCUS, W

METHODS = ('sweep', 'search', 'raytrace', 'jittered', 'lightfield', 'blur', 'scatter', 'foveated',
           'interpolated', 'diffusion')


class Usage(Case):
    SUBCOMMANDS = ('render', 'sheet', 'pull', 'depth', 'info', 'compare', 'bench', 'view')
    PAPERS = ('--cell --seed --spread --airy-radius --depth-ratio --star --star-length '
              '--star-angle --star-strength --sharp-radius --middle-ratio --last-ratio '
              '--attention --attention-angle --picture-angle --attention-depth --field '
              '--field-at --field-disparity --field-radius --field-falloff --field-angle '
              '--field-map --layers --solver --conductivity ')
    CONTROLS = ('--focus-width --focus-transition --also-focus --focus-plane --tilt-line '
                '--tilt-angle --tilt-compress --focus-map --sharp-mask --far-clamp --near-clamp '
                '--blur-limit --bokeh --curvature --open-f-number --squeeze --ring --edge '
                '--edge-before --cat-eye --fringe --grain --highlight-stops ')

    def test_help(self):
        text = self.succeeds('--help')
        self.assertEqual(text, self.succeeds('-h'))
        for name in self.SUBCOMMANDS:
            self.assertRegex(text, r'(?m)^  %s +\S' % name)
        self.fails(2, re.compile(r'^refocus: poster: unknown subcommand; '), 'poster', 'photo.ppm')

    def test_help_lists_every_option(self):
        options = {
            'render': self.PAPERS + self.CONTROLS +
                      '-o --output --depth --depth-unit --near --far --invalid --speckle '
                      '--focus --focus-at --focus-rectangle '
                      '--focus-distance --blur --f-number --focal-length --sensor-width '
                      '--method --rays --iterations --quality --aperture --blend --sigma '
                      '--highlights --mirror --background --no-thin --threads --cpu --repeat --json --view '
                      '--parallax --region --settings --save-settings -h --help',
            'depth': '-o --output --depth --depth-unit --near --far --invalid --speckle --full '
                     '--snap --upsample --estimate --preset --input-size --input-mean --input-scale '
                     '--far-is-large --match --strokes --stereo-file --side-by-side --view '
                     '--focus-at --blur --json -h --help',
            'sheet': self.PAPERS + self.CONTROLS +
                     '-o --output --depth --depth-unit --near --far --invalid --speckle '
                     '--kind --focuses --blurs --f-numbers --apertures --sigmas '
                     '--cell-width --region --focus --focus-at --focus-rectangle '
                     '--focus-distance --blur --f-number --focal-length --sensor-width --method --rays --iterations '
                     '--quality --aperture --blend --sigma --highlights --mirror --background --no-thin '
                     '--threads --cpu --json --settings --save-settings -h --help',
            'pull': self.PAPERS + self.CONTROLS +
                    '-o --output --depth --depth-unit --near --far --invalid --speckle '
                    '--from --to --blur-from --blur-to --keys --seconds --fps --ease --back '
                    '--wiggle '
                    '--focus --focus-at --focus-rectangle --focus-distance --blur --f-number '
                    '--focal-length --sensor-width --method --rays --iterations --quality --aperture --blend '
                    '--sigma --highlights --mirror --background --no-thin --threads --cpu --json '
                    '--settings --save-settings -h --help',
            'view': self.PAPERS + self.CONTROLS +
                    '-o --output --depth --depth-unit --near --far --invalid --speckle --strokes '
                    '--focus --focus-at --focus-rectangle --focus-distance --blur --f-number '
                    '--focal-length --sensor-width --method --rays --iterations --quality '
                    '--aperture --blend --sigma --highlights --mirror --background --no-thin --threads '
                    '--cpu --json --settings --size --fullscreen --seconds -h --help',
            'info': '--json -h --help',
            'compare': self.PAPERS + '-o --output --reference --methods --border --depth '
                       '--depth-unit --near --far --focus --focus-at --focus-rectangle '
                       '--focus-distance --blur --f-number --focal-length --sensor-width --rays --iterations '
                       '--quality --aperture --blend --sigma --highlights --mirror --background --no-thin '
                       '--threads --cpu --repeat --json -h --help',
            'bench': self.PAPERS + '--frames --kernels --size --depth --depth-unit --near --far '
                     '--focus --focus-at --focus-rectangle '
                     '--focus-distance --blur --method --rays --iterations --quality '
                     '--aperture --blend --sigma --highlights --mirror --background --no-thin --threads --cpu '
                     '--repeat --json -h --help',
        }
        for name, expected in options.items():
            text = self.succeeds(name, '--help')
            self.assertEqual(text, self.succeeds(name, 'x', '--help', '--nonsense'))
            listed = set(re.findall(r'(?m)^  (-\w|--[\w-]+)(?=[ ,\n])', text))
            listed |= set(re.findall(r'(?m)^  -\w, (--[\w-]+)', text))
            self.assertEqual(listed, set(expected.split()))
            self.assertLessEqual(max(map(len, text.splitlines())), 80)
            for word in set(expected.split()) - {'-h', '--help'}:  # and the parser knows it
                error = self.run_it(name, word + '=' if word.startswith('--') else word)
                self.assertNotIn('unknown', error.stderr)
        for method in METHODS:
            self.assertIn(method, self.succeeds('render', '--help'))

    def test_version(self):
        self.assertRegex(self.succeeds('--version'), r'^refocus \d+\.\d+\.\d+\nfiles: \S')

    def test_wrong_beginnings(self):
        self.fails(2, "subcommand: none is given; 'refocus --help' lists them")
        self.fails(2, "rendr: unknown subcommand; did you mean 'render'?", 'rendr')
        self.fails(2, "nifo: unknown subcommand; did you mean 'info'?", 'nifo')
        self.fails(2, "zzz: unknown subcommand; 'refocus --help' lists them", 'zzz')
        self.fails(2, ': unknown subcommand; \'refocus --help\' lists them', '')
        self.fails(2, '--json: unknown option; give a subcommand first, or --help', '--json')

    def test_options_that_cannot_be_parsed(self):
        self.fails(2, '--focsu: unknown option; did you mean --focus?', 'render', '--focsu=1')
        self.fails(2, '--bulr: unknown option; did you mean --blur?', *self.render('--bulr', '3'))
        self.fails(2, '--iter: unknown option; did you mean --iterations?',
                   *self.render('--iter', '3'))
        self.fails(2, "-x: unknown option; 'refocus render --help' lists them",
                   *self.render('-x'))
        self.fails(2, '--focus: has no value; give D', *self.render('--focus'))
        self.fails(2, '--focus: has no value; give D', *self.render('--focus', '--json'))
        self.fails(2, "--json: takes no value; leave '=1' out", *self.render('--json=1'))
        self.fails(2, '--depth: is empty; give FILE', *self.render('--depth='))
        self.fails(2, 'two.ppm: one file too many; give refocus render PHOTO -o OUT [options]',
                   'render', 'photo.ppm', 'two.ppm')
        self.fails(2, 'render: no file; give refocus render PHOTO -o OUT [options]', 'render')
        self.fails(2, 'info: no file; give refocus info FILE [--json]', 'info')
        self.fails(2, 'info: a file name is empty; give refocus info FILE [--json]', 'info', '')
        self.fails(2, '-o: the output has no name; give -o OUT', 'render', 'photo.ppm')
        self.fails(2, "--method: 'swep' is not one of " + ', '.join(METHODS) + "; did you mean "
                      "'sweep'?", *self.render('--method', 'swep'))
        self.fails(2, "--blend: 'foo' cannot be used; give one of linear, stored, gamma",
                   *self.render('--blend', 'foo'))

    def test_odd_spellings(self):
        shutil.copy('photo.ppm', '-odd.ppm')
        self.succeeds('render', '--depth=depth.pgm', '-oout.ppm', '--', '-odd.ppm')
        os.remove('-odd.ppm')
        os.remove('out.ppm')


class Limits(Case):
    def check(self, option, good, bad, what, *more):
        for value in good:
            self.succeeds(*self.render(option, value, *more))
        os.remove('out.ppm')
        for value in bad:
            self.fails(2, "%s: '%s' cannot be used; give %s" % (option, value, what),
                       *self.render(option, value, *more))

    def test_numbers(self):
        nonsense = ['x', '1x', '0x1', 'nan', ' 1', '1 ', '1,5', '-', '1e', 'inf']
        unit = ['-0.001', '1.001'] + nonsense
        self.check('--focus', ['0', '1', '0.5', '1e-3'], unit, 'a number from 0 to 1')
        self.check('--blur', ['0', '0.3', '127'], ['-1', '127.1', '1e99'] + nonsense,
                   'a number from 0 to 127')
        self.check('--near', ['1e-9', '1e9'], ['0', '-1', '1.1e9'] + nonsense,
                   'a number above 0, at most 1e+09')
        self.check('--far', ['1e-9', '7', 'inf'], ['0', '-1', '-inf', 'nan', 'x'],
                   'a number above 0')
        self.check('--sigma', ['1', '128', '1e30', 'off'], ['0', '0.99', 'on'] + nonsense,
                   "a number from 1 to 1e+30, or 'off'")
        self.check('--f-number', ['1000', '1.4'], ['0', '-2', '1001'] + nonsense,
                   'a number above 0, at most 1000', '--near', '1', '--far', '2',
                   '--focal-length', '50')

    def test_whole_numbers(self):
        nonsense = ['1.5', 'x', '', '1e', 'inf', '0x2']
        self.check('--rays', ['1', '1024', 'full'], ['0', '-1', '1025', 'ful'] + nonsense,
                   "a whole number from 1 to 1024, or 'full'", '--blur', '3')
        self.check('--iterations', ['1', '64'], ['0', '65'] + nonsense,
                   'a whole number from 1 to 64', '--method', 'search')
        self.check('--threads', ['0', '1', '2', '64'], ['-1', '65'] + nonsense,
                   'a whole number from 0 to 64')
        self.check('--repeat', ['1', '3'], ['0', '-1', '10001'] + nonsense,
                   'a whole number from 1 to 10000')

    def test_positions(self):
        self.check('--focus-at', ['0,0', '47,31', '3x4'],
                   ['1', '1,', ',1', '1;2', '1,2,3', '1.5,2', 'a,b'], 'X,Y')
        for at in ('-1,0', '48,0', '0,32', '1e9,0'):
            self.fails(2, '--focus-at: %s lies outside of photo.ppm; give 0,0 to 47,31' %
                       at.replace('1e9', '1e+09'), *self.render('--focus-at', at))
        for region in ('0,0,49,1', '0,0,1,33', '48,0,1,1', '0,0,0,5', '0,0,5,0'):
            self.fails(2, '--region: %s does not lie within the 48x32 pixels of photo.ppm' %
                       region, *self.render('--region', region))
        self.check('--region', ['0,0,48,32', '47,31,1,1'],
                   ['-1,0,3,3', '1,2,3', '1,2,3,4,5', '0,0,1.5,1', '0,0,70000,1'],
                   'X,Y,W,H from 0 to 65535')

    def test_what_excludes_what(self):
        twice = ('the focus is given twice; give one of --focus, --focus-at, --focus-distance '
                 'and --focus-rectangle')
        self.fails(2, '--focus-at: ' + twice,
                   *self.render('--focus', '1', '--focus-at', '1,1'))
        self.fails(2, '--focus-distance: ' + twice,
                   *self.render('--focus', '1', '--focus-distance', '1'))
        self.fails(2, '--f-number: the blur is given twice; give --blur or --f-number',
                   *self.render('--blur', '1', '--f-number', '2'))
        self.fails(2, '--focal-length: it goes with --f-number; give that too',
                   *self.render('--focal-length', '50'))
        self.fails(2, '--sensor-width: it goes with --focal-length; give that too',
                   *self.render('--sensor-width', '36', '--f-number', '2'))
        self.fails(2, '--near: 3 m is not nearer than --far 2 m; give the smaller number to '
                      '--near', *self.render('--near', '3', '--far', '2'))
        self.fails(2, '--region: a view always shows the whole; leave --region or --view out',
                   *self.render('--region', '0,0,1,1', '--view', 'depth'))
        self.fails(2, '--size: the photo has a size of its own; leave one of them out',
                   'bench', 'photo.ppm', '--size', '10x10')
        self.fails(2, 'bench: --depth, --depth-unit, --near, --far and --focus-distance go '
                      'with a photo; give one', 'bench', '--depth', 'depth.pgm')

    def test_light_is_given_back_with_care(self):
        # two stops: paper and petals are found as often as lamps in photos of cameras
        self.assertEqual(self.reports(*self.render())['highlights'], 4)
        self.assertEqual(self.reports(*self.render('--sigma', '60'))['highlights'], 4)
        self.assertEqual(self.reports(*self.render('--highlights', 'off'))['highlights'], 1)

    def test_what_would_change_nothing(self):
        for method, other, *option in (
                ('search', 'sweep', '--iterations', '1'), ('search', 'blur', '--mirror'),
                ('search', 'sweep', '--background'), ('sweep', 'search', '--highlights', '2'),
                ('sweep', 'scatter', '--highlight-stops', '2'),
                ('sweep, search, raytrace, lightfield, blur', 'jittered', '--rays', '8'),
                ('jittered', 'sweep', '--cell', '3'),
                ('scatter', 'sweep', '--spread', 'lommel'),
                ('scatter', 'sweep', '--depth-ratio', '3'),
                ('sweep, scatter', 'search', '--star', '4'),
                ('interpolated', 'sweep', '--last-ratio', '3'),
                ('foveated', 'sweep', '--attention', '1,1'),
                ('diffusion', 'sweep', '--layers', '3')):
            self.fails(2, '%s: it changes nothing with --method %s; give %s, or leave it out' %
                       (option[0], other, method), *self.render('--method', other, *option))
            self.succeeds(*self.render(*option, '--blur', '3', '--method',
                                       method.rsplit(' ')[-1]))
            os.remove('out.ppm')
        self.fails(2, '--seed: it changes nothing with --method sweep; give jittered, or '
                   '--grain, or leave it out', *self.render('--seed', '3'))
        self.succeeds(*self.render('--seed', '3', '--grain', '1'))
        self.succeeds(*self.render('--seed', '3', '--method', 'jittered'))
        # a file of settings may hold what it likes
        self.succeeds(*self.render('--method', 'search', '--iterations', '1', '--save-settings',
                                   's.json'))
        self.succeeds('render', 'photo.ppm', '-o', 'out.ppm', '--settings', 's.json', '--method',
                      'sweep')
        os.remove('s.json')
        os.remove('out.ppm')
        for option, value, needs, more in (
                ('--star-length', '9', '--star', '4'), ('--star-angle', '9', '--bokeh', 'sparkle'),
                ('--star-strength', '1', '--star', '4'),
                ('--field-radius', '0', '--field', 'plus'), ('--field-at', '1,1', '--field', 'plus'),
                ('--field-disparity', '1', '--field', 'plus'),
                ('--tilt-line', '0,0,9,9', '--tilt-angle', '5')):
            self.fails(2, '%s: it goes with %s; give that too' %
                       (option, needs if needs != '--bokeh' else '--star'),
                       *self.render(option, value))
            self.succeeds(*self.render(option, value, needs, more))
        os.remove('out.ppm')

    def test_an_aperture_overrules_a_preset(self):
        made = {}
        for name, *more in (('disc',), ('preset', '--bokeh', 'heart'),
                            ('both', '--bokeh', 'heart', '--aperture', 'disc')):
            self.succeeds(*self.render('--blur', '9', '--focus', '1', *more))
            made[name] = pictures.read_pnm('out.ppm')
        self.same(made['both'], made['disc'])
        self.differs(made['both'], made['preset'])
        os.remove('out.ppm')

    def test_what_commands_would_pass_over(self):
        pull = ('pull', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'p-%d.ppm')
        sheet = ('sheet', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'p.ppm')
        depth = ('depth', 'photo.ppm', '-o', 'd.png')
        place = ': --from and --to are in its place; leave it out'
        for option, value in (('--focus', '0.5'), ('--focus-at', '1,1'),
                              ('--focus-distance', '2'), ('--focus-rectangle', '1,1,2,2')):
            self.fails(2, option + place, *pull, option, value)
            self.fails(2, option + ': --focuses is in its place; give that, or another --kind',
                       *sheet, option, value)
        self.fails(2, '--focus-at' + place, *pull, '--focus-at', '1,1', '--tilt-angle', '9',
                   '--tilt-line', '0,0,9,9')
        self.fails(2, '--ease: is for the way from --from to --to; leave it or --wiggle out',
                   *pull, '--wiggle', '3', '--ease', 'in')
        self.fails(2, "--repeat: unknown option; 'refocus pull --help' lists them", *pull, '--repeat', '3')
        self.fails(2, '--blur: --blurs is in its place; leave one of them out', *sheet, '--blur',
                   '3', '--blurs', '3')
        self.fails(2, '--aperture: --apertures is in its place; leave it out', *sheet,
                   '--aperture', 'heart', '--kind', 'aperture')
        for option, value in ('--sigma', '9'), ('--blend', 'linear'):
            self.fails(2, option + ': the sheet has cells for several; leave it out', *sheet,
                       option, value, '--kind', 'sigma')
        self.fails(2, '--upsample: it goes with --full; give that too', *depth, '--depth',
                   'depth.pgm', '--upsample', 'core')
        for option, value in (('--snap', '2'), ('--depth-unit', 'mm'), ('--speckle', '4'),
                              ('--invalid', 'zero'), ('--upsample', 'core')):
            self.fails(2, option + ': --strokes alone paint over nothing; give --depth, or leave '
                       'it out', *depth, '--strokes', 's.json', option, value)
        for option, value in (('--input-size', '64,64'), ('--input-mean', '1,2,3'),
                              ('--input-scale', '1'), ('--far-is-large', None)):
            self.fails(2, option + ': it goes with --estimate; give that too', *depth, '--depth',
                       'depth.pgm', option, *([value] if value else []))
        self.fails(2, '--match: it is for stereo pairs; give RIGHT, --side-by-side or '
                   '--stereo-file, or leave it out', *depth, '--depth', 'depth.pgm', '--match',
                   'plain')
        self.fails(2, '--depth-unit: it is for depth that is read from a file; leave it out',
                   *depth, '--stereo-file', '--depth-unit', 'mm')
        self.fails(2, "--upsample: depth of a stereo pair has the photo's size; leave it out",
                   *depth, '--stereo-file', '--full', '--upsample', 'core')
        self.fails(2, '--focus-at: it is kept in a photo alone; give -o a .jpg, or leave it out',
                   *depth, '--depth', 'depth.pgm', '--focus-at', '1,1')
        self.fails(2, '--blur: the table of --frames has its own; leave it out', 'bench',
                   '--frames', '--blur', '3')
        self.fails(2, '--size: it does not go with --kernels; leave it out', 'bench', '--kernels',
                   '--size', '9x9')
        self.fails(2, '--kernels: it takes no photo; leave one of them out', 'bench', '--kernels',
                   'photo.ppm')
        for option in '--fast', '--loop':
            self.fails(2, option + ': it is for files and scripts, not of cameras; leave it out',
                       'live', '--camera', 'v4l2:9', '--depth', 'depth.pgm', option)
        self.fails(2, '--dmabuf: it is for V4L2 cameras; leave it out', 'live', '--camera',
                   'file:x-%d.ppm', '--depth', 'depth.pgm', '--dmabuf')

    def test_inputs_are_never_written_over(self):
        pictures.pgm('map.pgm', W, H, lambda x, y: x)
        with open('keys.json', 'w') as file:
            file.write('{"refocus-pull": 1, "keys": [{"time": 0, "focus": 1}, {"time": 1}]}')
        for option, file, more in (
                ('--depth', 'depth.pgm', ()), ('--focus-map', 'map.pgm', ()),
                ('--sharp-mask', 'map.pgm', ()), ('--aperture', 'map.pgm', ()),
                ('--field-map', 'map.pgm', ('--field', 'picture')), ('--settings', 's.json', ())):
            if file == 's.json':
                with open(file, 'w') as settings:
                    settings.write('{"refocus": 1}')
            other = os.path.join('.', file)
            name = other.rsplit('.', 1)[0] + '.ppm'  # the same file by another name
            if not os.path.exists(name):
                os.link(file, name)
            for command, out in ('render', name), ('sheet', name), ('pull', None):
                depth = ('--depth', 'depth.pgm') if option != '--depth' else ()
                if out:
                    self.fails(2, re.compile('it is an input'), command, 'photo.ppm', *depth,
                               option, file, *more, '-o', out)
                json_name = name[:-4] + '.json'
                if not os.path.exists(json_name):
                    os.link(file, json_name)
                self.fails(2, re.compile('it is an input'), command, 'photo.ppm', *depth, option,
                           file, *more, '-o', 'o-%d.ppm' if command == 'pull' else 'o.ppm',
                           '--save-settings', json_name)
        self.fails(2, re.compile('it is an input'), 'pull', 'photo.ppm', '--depth', 'depth.pgm',
                   '--keys', 'keys.json', '-o', 'o-%d.ppm', '--save-settings', 'keys.json')
        for name in ('map.pgm', 'map.ppm', 'map.json', 'depth.ppm', 'depth.json', 's.ppm',
                     's.json', 'keys.json'):
            os.remove(name)

    def test_apertures(self):
        pictures.pgm('mask.pgm', 9, 5, lambda x, y: 255 if x > 2 else 0)
        pictures.pgm('widest.pgm', 255, 1, lambda x, y: 255)
        pictures.pgm('wide.pgm', 256, 1, lambda x, y: 255)
        pictures.pgm('black.pgm', 5, 5, lambda x, y: 0)
        for shape in ('disc', 'polygon:3', 'polygon:16', 'polygon:6:15', 'polygon:5:-7.5',
                      'mask.pgm', 'widest.pgm'):
            self.succeeds(*self.render('--aperture', shape))
        os.remove('out.ppm')
        for shape in ('polygon:', 'polygon:2', 'polygon:17', 'polygon:6:', 'polygon:6:x',
                      'polygon:6:1:2', 'polygon:99999999999999999999', 'polygon:6:nan'):
            self.fails(2, "--aperture: '%s' cannot be used; give polygon:BLADES or "
                          "polygon:BLADES:DEGREES with 3 to 16 blades" % shape,
                       *self.render('--aperture', shape))
        self.fails(2, "--aperture: 'dics' is not known; give disc, polygon:BLADES, "
                      "polygon:BLADES:DEGREES, heart, star or a mask picture",
                   *self.render('--aperture', 'dics'))
        self.fails(1, 'wide.pgm: 256x1 pixels are too many for an aperture; give at most '
                      '255x255', *self.render('--aperture', 'wide.pgm'))
        self.fails(1, 'black.pgm: no pixel of the aperture is open; give white where light '
                      'passes', *self.render('--aperture', 'black.pgm'))
        self.fails(1, re.compile('^refocus: missing.png: '),
                   *self.render('--aperture', 'missing.png'))


class Results(Case):
    def test_report(self):
        report = self.reports(*self.render('--focus', '0.25', '--blur', '4', '--threads', '2',
                                           '--repeat', '3'))
        for key, value in {'width': W, 'height': H, 'method': 'sweep', 'rays': 64,
                           'blur': 4.0, 'focus': 0.25, 'threads': 2,
                           'output': 'out.ppm'}.items():
            self.assertEqual(report[key], value, key)
        times = report['render_ms']
        self.assertTrue(0 < times['min'] <= times['median'] <= times['max'])
        self.assertGreater(report['prepare_ms'], 0)
        self.assertGreater(report['peak_rss_kib'], 500)
        self.assertIn(report['cpu'], ('c', 'neon', 'sse41', 'avx2', 'avx512'))
        depth = report['depth']
        self.assertEqual((depth['unknown'], depth['clamped'], depth['near_m'], depth['far_m'],
                          depth['width'], depth['height']), (0, 0, None, None, W, H))
        for quality, rays in (('preview', 32), ('standard', 64), ('best', 128)):
            self.assertEqual(self.reports(*self.render('--quality', quality))['rays'], rays)
        self.assertEqual(self.reports(*self.render('--quality', 'best', '--rays', '7'))['rays'],
                         7)
        self.assertEqual(self.reports(*self.render('--rays', 'full', '--blur', '3'))['rays'],
                         'full')
        text = self.succeeds(*self.render('--repeat', '2'))
        self.assertRegex(text, r'^prepare [\d.]+ ms, render [\d.]+ ms \(median of 2; ')
        self.assertEqual(self.succeeds(*self.render()), '')

    def test_nothing_to_blur(self):
        photo = pictures.read_pnm('photo.ppm')
        self.succeeds(*self.render('--blur', '0'))
        self.same(pictures.read_pnm('out.ppm'), photo)
        for method in METHODS:
            self.succeeds('render', 'plain.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm',
                          '--blur', '5', '--method', method)
            self.same(pictures.read_pnm('out.ppm'), pictures.read_pnm('plain.ppm'), method)

    def test_blur_happens_where_it_should(self):
        photo = pictures.read_pnm('photo.ppm')[2]
        self.succeeds(*self.render('--focus', '1', '--blur', '6'))
        near = pictures.read_pnm('out.ppm')[2]
        row = slice(16 * W * 3, 17 * W * 3)
        self.same(near[row][40 * 3:], photo[row][40 * 3:])   # sharp on the right
        self.differs(near[row][:20 * 3], photo[row][:20 * 3])  # and not on the left
        self.succeeds(*self.render('--focus', '0.2', '--blur', '6'))
        far = pictures.read_pnm('out.ppm')[2]
        self.same(far[row][:10 * 3], photo[row][:10 * 3])
        self.differs(far[row][30 * 3:], photo[row][30 * 3:])

    def test_options_change_the_picture(self):
        self.succeeds(*self.render('--focus', '1', '--blur', '6'))
        first = pictures.read_pnm('out.ppm')
        for more in (('--rays', '8'), ('--aperture', 'polygon:3'), ('--blend', 'stored'),
                     ('--blend', 'gamma'), ('--sigma', '40'), ('--method', 'search'),
                     ('--method', 'raytrace'), ('--focus', '0.4'), ('--blur', '3')):
            self.succeeds(*self.render('--focus', '1', '--blur', '6', *more))
            self.differs(pictures.read_pnm('out.ppm'), first, more)
        pictures.pgm('many.pgm', W, H, lambda x, y: (x // 5 * 37 + y // 4 * 51) & 255)
        search = ('--depth', 'many.pgm', '--method', 'search', '--focus', '0.2', '--blur', '6')
        self.succeeds(*self.render(*search))
        first = pictures.read_pnm('out.ppm')
        for more in (('--iterations', '1'), ('--mirror',), ('--background',)):
            self.succeeds(*self.render(*search, *more))
            self.differs(pictures.read_pnm('out.ppm'), first, more)

    def test_threads_do_not_change_the_picture(self):
        pictures_seen = set()
        for threads in ('1', '2', '3', '8'):
            self.succeeds(*self.render('--focus', '1', '--threads', threads, '--cpu', 'c'))
            pictures_seen.add(pictures.read_pnm('out.ppm'))
        self.assertEqual(len(pictures_seen), 1)

    def test_region_is_a_part_of_the_whole(self):
        self.succeeds(*self.render('--focus', '1', '--blur', '6'))
        whole = pictures.read_pnm('out.ppm')[2]
        self.succeeds(*self.render('--focus', '1', '--blur', '6', '--region', '11,5,20,9'))
        width, height, part = pictures.read_pnm('out.ppm')
        self.assertEqual((width, height), (20, 9))
        for y in range(9):
            at = ((y + 5) * W + 11) * 3
            self.same(part[y * 60:(y + 1) * 60], whole[at:at + 60])

    def test_focus(self):
        def focus(*more):
            return self.reports(*self.render(*more))['focus']

        self.assertAlmostEqual(focus('--focus-at', '47,0'), 1, 4)
        self.assertAlmostEqual(focus('--focus-at', '0,31'), 0.2, 4)
        self.assertAlmostEqual(focus(), 1, 4)  # the centre lies on the right half
        near_far = ('--near', '0.5', '--far', '4')
        for metres, disparity in (('0.5', 1), ('4', 0), ('1', 3 / 7), ('2', 1 / 7)):
            self.assertAlmostEqual(focus('--focus-distance', metres, *near_far), disparity, 6)
        self.assertAlmostEqual(focus('--focus-distance', 'inf', '--near', '1', '--far', 'inf'),
                               0, 6)
        for metres in ('0.49', '4.1', 'inf'):
            self.fails(2, '--focus-distance: %s m lies outside of the depth of depth.pgm; give '
                          '0.5 to 4 m' % metres,
                       *self.render('--focus-distance', metres, *near_far))
        self.fails(1, 'depth.pgm: --focus-distance needs distances in metres, which it does not '
                      'say; give --near and --far, or --focus or --focus-at in its place',
                   *self.render('--focus-distance', '1', '--near', '1'))

    def test_focus_at_is_robust(self):
        """Wrong single samples do not win."""
        pictures.pgm('specks.pgm', W, H,
                     lambda x, y: 255 if (x, y) in ((10, 10), (0, 0), (1, 1)) else 51)
        for at in ('10,10', '0,0', '2,1'):
            report = self.reports('render', 'photo.ppm', '--depth', 'specks.pgm', '-o',
                                  'out.ppm', '--focus-at', at)
            self.assertAlmostEqual(report['focus'], 0.2, 4)

    def test_lens(self):
        def blur(*more):
            return self.reports(*self.render(*more))['blur']

        self.assertAlmostEqual(blur(), W / 50, 5)
        lens = ('--near', '0.5', '--far', '4', '--f-number', '8', '--focal-length', '50')
        expected = 50 / 36 * W * (0.05 / 16) * (1 / 0.5 - 1 / 4)
        self.assertAlmostEqual(blur(*lens), expected, 5)
        self.assertAlmostEqual(blur(*lens, '--sensor-width', '18'), 2 * expected, 5)
        self.fails(1, 'depth.pgm: --focal-length needs distances in metres, which it does not '
                      'say; give --near and --far, or leave it out',
                   *self.render('--f-number', '2', '--focal-length', '50'))
        self.fails(1, 'photo.ppm: --f-number needs a focal length, which it does not say; give '
                      '--focal-length and --sensor-width, or --blur',
                   *self.render('--f-number', '2', '--near', '1', '--far', '2'))

    WIDE = ('--near', '0.01', '--far', 'inf', '--focal-length', '85')

    def test_f_number_is_limited(self):
        """More blur than there can be is the most that there can be."""
        line = ('--f-number: f/1.4 gives 344 pixels of blur, limited to 127, the most, which '
                'f/3.79 has')
        report = self.warns(line, *self.render(*self.WIDE, '--f-number', '1.4'))
        limited = pictures.read_bytes('out.ppm')
        self.assertEqual((report['blur'], report['blur_from']), (127, 'lens'))
        self.assertAlmostEqual(report['f_number'], 1.4 * 344 / 127, 2)
        least = self.reports(*self.render(*self.WIDE, '--f-number', '3.8'))
        self.assertEqual(least['f_number'], 3.8)  # and what it says does work
        self.assertLess(126, least['blur'])
        self.assertLess(least['blur'], 127)
        self.succeeds(*self.render(*self.WIDE[:4], '--blur', '127'))
        self.same(pictures.read_bytes('out.ppm'), limited)
        self.assertEqual(self.warns(line, 'pull', 'photo.ppm', '--depth', 'depth.pgm', '-o',
                                    'p.y4m', '--seconds', '0.1', *self.WIDE, '--f-number',
                                    '1.4')['blur_from'], 'lens')
        sheet = self.warns(line, 'sheet', 'photo.ppm', '--depth', 'depth.pgm', '-o', 's.ppm',
                           '--focuses', '0', *self.WIDE, '--f-numbers', '1.4,8')
        self.assertEqual(sheet['cells'], ['focus 0  f/3.793', 'focus 0  f/8'])
        for name in ('p.y4m', 's.ppm'):
            os.remove(name)

    def test_f_number_without_metres(self):
        """The default blur stands for f/2."""
        line = ('--f-number: depth.pgm says no distances in metres; f/%s gives %s pixels of '
                'blur%s, by the default of 1.0 at f/2; --near and --far give that of a lens')
        for number, words, limit in (('0.5', '3.8', ''), ('2', '1.0', ''), ('4', '0.5', ''),
                                     ('0.01', '192.0',
                                      ', limited to 127, the most, which f/0.0151 has')):
            report = self.warns(line % (number, words, limit),
                                *self.render('--focus', '1', '--f-number', number))
            self.assertAlmostEqual(report['blur'], min(W / 50 * 2 / float(number), 127), 5)
            self.assertEqual(report['blur_from'], 'default')

    def gdepth(self, attributes):
        """photo.jpg with depth of six grey bars, dark = near, and what GFocus says."""
        pictures.png('bars.png', W, H, [bytes(40 * (x // 8) for x in range(W))] * H, colour=0)
        with open('bars.png', 'rb') as file:
            data = base64.b64encode(file.read()).decode()
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '0', '-o',
                      'photo.jpg')
        pictures.insert_xmp('photo.jpg', 'GDepth:Format="RangeInverse" GDepth:Mime="image/png" '
                            'GDepth:Data="%s" %s' % (data, attributes))

    def test_f_number_by_the_files_own_blur(self):
        """Of Google's Lens Blur: a range without a unit, and BlurAtInfinity. By hand:
        K = 0.1 (1/20 - 1/100) 25 of 48 pixels = 4.8."""
        self.gdepth('GDepth:Near="20" GDepth:Far="100" GFocus:FocalDistance="25" '
                    'GFocus:FocalPointX="0.5" GFocus:FocalPointY="0.5" '
                    'GFocus:BlurAtInfinity="0.1"')
        command = ('render', 'photo.jpg', '-o', 'out.ppm')
        blurs = []
        for number, words in (('1.4', '6.9'), ('2', '4.8'), ('8', '1.2')):
            report = self.warns(
                '--f-number: photo.jpg says no distances in metres; f/%s gives %s pixels of '
                'blur, by the file\'s own of 4.8 at f/2; --near and --far give that of a lens' %
                (number, words), *command, '--f-number', number)
            self.assertEqual((report['blur_from'], report['depth']['near_m']), ('file', None))
            blurs.append(report['blur'])
        for blur, number in zip(blurs, (1.4, 2, 8)):
            self.assertAlmostEqual(blur, 9.6 / number, 4)
        self.assertAlmostEqual(self.reports(*command)['blur'], W / 50, 5)
        self.fails(1, 'photo.jpg: --focus-distance needs distances in metres, which it does not '
                      'say; give --near and --far, or --focus or --focus-at in its place',
                   *command, '--focus-distance', '30')
        info = self.reports('info', 'photo.jpg')
        self.assertEqual(info['depth']['near_m'], None)
        self.assertAlmostEqual(info['own_blur'], 0.1)
        # --near and --far are metres, whatever the file meant
        lens = self.reports(*command, '--f-number', '8', '--focal-length', '50', '--near', '0.5',
                            '--far', '4')
        self.assertEqual(lens['blur_from'], 'lens')
        self.assertAlmostEqual(lens['blur'], 50 / 36 * W * (0.05 / 16) * (1 / 0.5 - 1 / 4), 5)
        # saved with its depth once more, the blur is the same
        self.succeeds('depth', 'photo.jpg', '-o', 'again.jpg')
        again = self.run_it('render', 'again.jpg', '-o', 'out.ppm', '--f-number', '2', '--json')
        self.assertAlmostEqual(json.loads(again.stdout)['blur'], 4.8, 3)
        for name in ('photo.jpg', 'again.jpg', 'bars.png', 'out.ppm'):
            os.remove(name)

    def test_16_bits_are_told_and_dithered(self):
        """Once, whatever is made of the photo; the mean of a shallow gradient is kept."""
        def value(x, y):  # rounded to nearest it is 100 or 101 all over
            return 25700 + 120 + x // 8
        pictures.png('deep.png', W, H, [struct.pack('>%dH' % (3 * W), *(
            value(x, y) for x in range(W) for _ in range(3))) for y in range(H)], depth=16)
        line = 'deep.png: it has 16 bits a channel; 8 are taken, dithered'
        command = ('deep.png', '--depth', 'depth.pgm', '-o')
        self.warns(line, 'render', *command, 'out.ppm', '--blur', '0', '--repeat', '3')
        samples = pictures.read_pnm('out.ppm')[2]
        for top in range(0, H, 8):
            for left in range(0, W, 8):
                mean = sum(samples[3 * (y * W + x)] for y in range(top, top + 8)
                           for x in range(left, left + 8)) / 64
                self.assertAlmostEqual(mean, value(left, top) / 257, delta=1 / 64)
        self.warns(line, 'sheet', *command, 'out.ppm', '--blurs', '1,2')
        self.warns(line, 'pull', *command, 'p.y4m', '--seconds', '0.1')
        result = self.run_it('compare', 'deep.png', '--depth', 'depth.pgm', '--reference',
                             'photo.ppm', '--blur', '1')
        self.assertEqual((result.returncode, result.stderr), (0, 'refocus: ' + line + '\n'))
        self.assertEqual(self.reports('info', 'deep.png')['bits'], 16)
        self.assertEqual(self.reports('info', 'photo.ppm')['bits'], 8)
        # a depth map of 16 bits is not cut, and nothing is said of it
        pictures.png('deep-depth.png', W, H, [struct.pack('>%dH' % W, *(
            40000 + x for x in range(W)))] * H, depth=16, colour=0)
        self.succeeds('depth', 'deep-depth.png', '-o', 'd.png')
        rows = pictures.read_png('d.png')[4]
        self.assertEqual(struct.unpack('>%dH' % W, rows[0]), tuple(40000 + x for x in range(W)))
        self.succeeds('render', 'photo.ppm', '--depth', 'deep-depth.png', '-o', 'out.ppm')
        for name in ('deep.png', 'deep-depth.png', 'd.png', 'p.y4m', 'out.ppm'):
            os.remove(name)

    def test_portrait_sensor(self):
        """36 mm go with the larger side, whichever that is."""
        pictures.ppm('tall.ppm', H, W, lambda x, y: (x, y, 0))
        pictures.pgm('tall.pgm', H, W, lambda x, y: y)
        report = self.reports('render', 'tall.ppm', '--depth', 'tall.pgm', '-o', 'out.ppm',
                              '--near', '0.5', '--far', '4', '--f-number', '8',
                              '--focal-length', '50')
        self.assertAlmostEqual(report['blur'], 50 / 36 * W * (0.05 / 16) * (1 / 0.5 - 1 / 4), 5)

    def test_depth_units(self):
        def depth(file, unit, *more):
            return self.reports('render', 'photo.ppm', '--depth', file, '--depth-unit', unit,
                                '-o', 'out.ppm', *more)['depth']

        mm = depth('mm.pgm', 'mm')
        self.assertEqual((mm['meaning'], mm['unknown']), ('distance', 1))
        self.assertAlmostEqual(mm['near_m'], 0.5)
        self.assertAlmostEqual(mm['far_m'], 2)
        self.assertAlmostEqual(depth('mm.pgm', '5000/m')['near_m'], 0.1)
        self.assertAlmostEqual(depth('metres.pfm', 'm')['far_m'], 2)
        wider = depth('metres.pfm', 'm', '--near', '0.25', '--far', 'inf')
        self.assertEqual((wider['near_m'], wider['far_m'], wider['clamped']),
                         (0.25, 'infinity', 0))
        self.assertEqual(depth('metres.pfm', 'm', '--far', '1')['clamped'], W * H // 2)
        for unit in ('feet', '0/m', '-5/m', '/m', 'nan/m', '5000', 'MM'):
            self.fails(2, "--depth-unit: '%s' is not known; give disparity, inverse, mm, m or a "
                          "number per metre such as 5000/m" % unit,
                       *self.render('--depth-unit', unit))
        # Dark is near: the left half, sharp when 1 is in focus.
        self.succeeds(*self.render('--depth-unit', 'inverse', '--focus', '0.8', '--blur', '6'))
        self.assertEqual(pictures.read_pnm('out.ppm')[2][:30],
                         pictures.read_pnm('photo.ppm')[2][:30])

    def test_views(self):
        self.succeeds(*self.render('--view', 'depth'))
        width, height, values = pictures.read_pnm('out.ppm')
        self.assertEqual(width, W)
        self.assertGreater(height, H + 20)  # the legend
        self.assertNotEqual(values[:3], values[(W - 1) * 3:W * 3])
        self.assertEqual(values[:3], values[3:6])
        legend = values[H * W * 3:]
        self.assertIn((240, 240, 240), {legend[i:i + 3] for i in range(0, len(legend), 3)})
        self.succeeds(*self.render('--view', 'blur', '--focus', '1', '--blur', '9'))
        values = pictures.read_pnm('out.ppm')[2]
        self.assertEqual(values[(W - 1) * 3:W * 3], (0, 255, 120))  # sharp
        self.assertNotEqual(values[:3], (0, 255, 120))
        self.succeeds(*self.render('--view', 'none'))
        self.assertEqual(pictures.read_pnm('out.ppm')[1], H)

    def test_a_low_map(self):
        pictures.pgm('low.pgm', W // 4, H // 4, lambda x, y: 20 * x)
        report = self.reports('render', 'photo.ppm', '--depth', 'low.pgm', '-o', 'out.ppm')
        self.assertEqual((report['width'], report['depth']['width']), (W, W // 4))

    def test_bench_frames(self):
        report = self.reports('bench', '--frames', '--size', '48x32', '--repeat', '2',
                              '--threads', '2')
        rows = report['frames']
        self.assertEqual([(r['blur'], r['quality'], r['threads']) for r in rows],
                         [(k, q, 2) for k in (10, 20, 40)
                          for q in ('preview', 'standard', 'best')])
        for row in rows:
            self.assertEqual((row['width'], row['height']), (48, 32))
            self.assertTrue(all(row[t] > 0 for t in
                                ('memcpy_ms', 'box_ms', 'prepare_ms', 'render_ms')))
        text = self.succeeds('bench', 'photo.ppm', '--depth', 'depth.pgm', '--frames',
                             '--repeat', '1', '--threads', '1')
        self.assertEqual(len(re.findall(r'(?m)^ *%dx%d ' % (W, H), text)), 9)
        self.fails(2, '--frames: it does not go with --rays without a number; leave one of them '
                   'out', 'bench', '--frames', '--rays', '--size', '9x9')

    def test_bench_kernels(self):
        report = self.reports('bench', '--kernels')
        names = [k['kernel'] for k in report['kernels']]
        self.assertIn('sweep', names)
        self.assertEqual(len(set(names)), len(names))
        for kernel in report['kernels']:
            self.assertGreater(kernel['ns'], 0)
            self.assertGreater(kernel['ns_c'], 0)
        plain = self.reports('bench', '--kernels', '--cpu', 'c')
        self.assertEqual(plain['cpu'], 'c')
        self.assertRegex(self.succeeds('bench', '--kernels'), r'(?m)^sweep +\S+ +\S+ ns/ray sample')

    def test_bench(self):
        report = self.reports('bench', '--size', '64x40', '--repeat', '2', '--blur', '5')
        self.assertEqual((report['width'], report['height'], report['repeat'], report['blur']),
                         (64, 40, 2, 5.0))
        self.assertGreater(report['megapixels_per_second'], 0)
        self.assertEqual(report['photo'], None)
        report = self.reports('bench', 'photo.ppm', '--depth', 'depth.pgm', '--repeat', '1')
        self.assertEqual((report['photo'], report['width']), ('photo.ppm', W))
        self.assertRegex(self.succeeds('bench', '--size', '1x1', '--repeat', '1'),
                         r'^1x1, sweep, blur .*\ncreate .*\nprepare .*\nrender .*\n$')
        for size in ('0x5', '5', '5x65536', '5x5x5', 'axb'):
            self.fails(2, "--size: '%s' cannot be used; give WxH from 1 to 65535" % size,
                       'bench', '--size', size)


class Papers(Case):
    def test_options_of_single_methods(self):
        plain = {m: self.picture('--method', m) for m in METHODS}
        for method, *options in (('jittered', '--seed', '5'), ('jittered', '--cell', '3'),
                                 ('scatter', '--spread', 'lommel'),
                                 ('scatter', '--depth-ratio', '4'), ('scatter', '--star', '4'),
                                 ('interpolated', '--last-ratio', '3'),
                                 ('foveated', '--attention-angle', '0'),
                                 ('diffusion', '--field', 'sphere'),
                                 ('diffusion', '--field', 'picture', '--field-map', 'photo.ppm')):
            self.assertNotEqual(self.picture('--method', method, *options), plain[method], options)
        self.same(self.picture('--method', 'jittered', '--seed', '0'), plain['jittered'])
        self.same(self.picture('--method', 'diffusion', '--solver', 'series'),
                  plain['diffusion'])

    def picture(self, *options):
        self.succeeds(*self.render('--blur', '5', '--focus', '0.2', *options))
        return pictures.read_pnm('out.ppm')

    def test_refused(self):
        for why, *options in (
                ("--star: '1' cannot be used; give 0 for none, or 2 to 16 spikes", '--star', '1'),
                ("--middle-ratio: '1' cannot be used; give a number above 1", '--middle-ratio',
                 '1', '--method', 'interpolated'),
                ('--middle-ratio: 4 is not below --last-ratio 3; give the smaller number to '
                 '--middle-ratio', '--middle-ratio', '4', '--last-ratio', '3', '--method',
                 'interpolated'),
                ('--field: picture needs one; give a grey picture to --field-map', '--field',
                 'picture'),
                ('--field-map: it goes with --field picture; give that too', '--field-map', 'x'),
                ("--aperture: 'polygon:5' does not go with --method scatter, which knows a disc "
                 'alone; leave one of them out', '--aperture', 'polygon:5', '--method',
                 'scatter'),
                ('--attention: 5000,1 lies outside of the picture; give 0,0 to %d,%d'
                 % (W - 1, H - 1), '--attention', '5000,1', '--method', 'foveated')):
            self.fails(2, why, *self.render(*options))
        for option, value in (('--cell', '0'), ('--airy-radius', '0.1'), ('--layers', '9'),
                              ('--conductivity', '0'), ('--star-strength', '2'),
                              ('--field-falloff', '0'), ('--sharp-radius', '0.4')):
            self.fails(2, re.compile(r"^refocus: %s: '%s' cannot be used; give" % (option, value)),
                       *self.render(option, value))

    def test_compare(self):
        common = ('photo.ppm', '--depth', 'depth.pgm', '--blur', '4', '--focus', '0.2')
        self.succeeds('render', *common, '-o', 'gt.ppm')
        text = self.succeeds('compare', *common, '--reference', 'gt.ppm', '-o', 'crops.png')
        for method in METHODS:
            self.assertRegex(text, r'(?m)^%s +\S+ +\S+ +\S+ +\S+ +\d' % method)
        width = pictures.read_png('crops.png')[0]
        self.assertGreater(width, 12 * min(W, 96))
        report = self.reports('compare', *common, '--reference', 'gt.ppm', '--methods',
                              'blur,sweep,blur')
        self.assertEqual([m['method'] for m in report['methods']], ['photo', 'blur', 'sweep'])
        photo, blur, sweep = report['methods']
        self.assertEqual((sweep['psnr'], sweep['rmse']), ('infinity', 0))
        self.assertGreater(blur['psnr'], photo['psnr'])
        self.fails(2, "--methods: 'swep' is no method; did you mean 'sweep'?", 'compare', *common,
                   '--reference', 'gt.ppm', '--methods', 'blur,swep')
        report = self.reports(
            'compare', *common, '--reference', 'gt.ppm', '--iterations', '3', '--methods',
            'search:rays=full:iterations=1,search,jittered:cell=4:seed=7,search:mirror,sweep:rays=8')
        self.assertEqual([m['label'] for m in report['methods'][1:]],
                         ['search:rays=full:iterations=1', 'search', 'jittered:cell=4:seed=7',
                          'search:mirror', 'sweep:rays=8'])
        self.assertEqual([m['method'] for m in report['methods'][1:4]],
                         ['search', 'search', 'jittered'])
        # each is what render makes of the same options
        for row, options in ((1, ('--method', 'search', '--rays', 'full', '--iterations', '1')),
                             (2, ('--method', 'search', '--iterations', '3')),
                             (3, ('--method', 'jittered', '--cell', '4', '--seed', '7')),
                             (5, ('--rays', '8'))):
            self.succeeds('render', *common, *options, '-o', 'own.ppm')
            own = self.reports('compare', *common, '--reference', 'own.ppm', '--iterations', '3',
                               '--methods', report['methods'][row]['label'])
            self.assertEqual(own['methods'][1]['rmse'], 0)
        for why, methods in (("--rays: 'none' cannot be used; give", 'search:rays=none'),
                             ('--ray: unknown option; did you mean --rays?', 'search:ray=3'),
                             ('--mirror: takes no value', 'search:mirror=1'),
                             ('--threads: unknown option', 'search:threads=1'),
                             ("--aperture: 'disk' is not known", 'sweep:aperture=disk'),
                             ('--methods: there are too many; give at most 32',
                              ','.join('sweep:rays=%d' % i for i in range(1, 40)))):
            self.fails(2, re.compile('^refocus: ' + re.escape(why)), 'compare', *common,
                       '--reference', 'gt.ppm', '--methods', methods)
        self.fails(2, '--reference: there is nothing to compare with; give --reference GT',
                   'compare', *common)
        pictures.ppm('tiny.ppm', 4, 3, lambda x, y: (x, y, 0))
        self.fails(1, 'tiny.ppm: it has 4x3 pixels, the photo %dx%d; give one of the same size'
                   % (W, H), 'compare', *common, '--reference', 'tiny.ppm')


    def test_ray_statistics(self):
        report = self.reports('bench', 'photo.ppm', '--depth', 'depth.pgm', '--blur', '6',
                              '--focus', '0.2', '--rays')
        self.assertEqual(report['rays'] % report['pixels'], 0)
        self.assertAlmostEqual(sum(report['found_after']) + report['never'], 1)
        self.assertGreater(report['found_after'][0], 0.5)
        self.assertGreater(report['hidden'], 0)
        text = self.succeeds('bench', '--rays', '--size', '60x40', '--blur', '3')
        self.assertRegex(text, r'(?m)^ +1 +\d+\.\d+ %')
        report = self.reports('bench', '--rays', '5', '--size', '60x40', '--repeat', '1')
        self.assertEqual(report['rays'], 5)


class DepthAndInfo(Case):
    def test_depth(self):
        report = self.reports('depth', 'depth.pgm', '-o', 'd.pgm')
        self.assertEqual(report['depth']['unknown'], 0)
        expected = tuple(65535 if x >= W // 2 else 13107 for y in range(H) for x in range(W))
        self.same(pictures.read_pnm('d.pgm'), (W, H, expected))
        self.succeeds('depth', 'depth.pgm', '-o', 'd.pfm')
        width, height, values = pictures.read_pfm('d.pfm')
        self.assertEqual((width, height), (W, H))
        self.assertTrue(all(abs(v - e / 65535) < 1e-6 for v, e in zip(values, expected)))
        self.succeeds('depth', 'depth.pgm', '-o', 'd.png', '--depth-unit', 'inverse')
        width, height, bits, channels, rows = pictures.read_png('d.png')
        self.assertEqual((width, height, bits, channels), (W, H, 16, 1))
        self.assertEqual((rows[0][:2], rows[0][-2:]), (b'\xcc\xcc', b'\0\0'))
        text = self.succeeds('depth', 'mm.pgm', '-o', 'd.png', '--depth-unit', 'mm')
        self.assertEqual(text, 'size     48x32\nnear     0.5 m\nfar      2 m\n'
                               'filled   1 samples without a value, 0.1 %\n'
                               'clamped  0 samples beyond the range, 0.0 %\n')
        self.fails(2, 'd.tif: no such format is written; end the name in .png, .pgm, .pfm, .jpg '
                   'or .jpeg', 'depth', 'depth.pgm', '-o', 'd.tif')
        self.fails(1, 'd.jpg: depth is saved into JPEG photos; the photo is none',
                   'depth', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'd.jpg')
        self.fails(2, "--invalid: 'zero,7' is not known; give zero, max or 2047, or several with "
                   'commas', 'depth', 'depth.pgm', '-o', 'd.png', '--invalid', 'zero,7')
        self.assertFalse(os.path.exists('d.jpg') or os.path.exists('d.tif'))

    def test_depth_repair(self):
        whole = self.reports('depth', 'mm.pgm', '-o', 'a.png')['depth']
        less = self.reports('depth', 'mm.pgm', '-o', 'b.png', '--invalid', 'zero')['depth']
        self.assertEqual((whole['unknown'], less['unknown']), (0, 1))
        self.succeeds('depth', 'mm.pgm', '-o', 'c.png', '--invalid', 'zero', '--view',
                      'confidence')
        width, height, bits, channels, rows = pictures.read_png('c.png')
        self.assertEqual((width, height, bits, channels), (W, H, 8, 3))
        self.assertEqual(sum(row.count(b'\0\0\0') for row in rows), less['unknown'])

    def test_depth_of_pictures(self):
        self.fails(1, re.compile(r'^refocus: depth.pgm: (the two pictures do not match|too few '
                                 r'pixels|it is a depth map, not a photo|the pictures are too '
                                 r'small|this build has no OpenCV)'),
                   'depth', 'photo.ppm', 'depth.pgm', '-o', 'd.png')
        self.fails(2, 'photo.ppm: its depth is given twice; give one of RIGHT, --side-by-side, '
                   '--stereo-file, '
                   '--estimate and --depth', 'depth', 'photo.ppm', 'photo.ppm', '-o', 'd.png',
                   '--depth', 'depth.pgm')
        self.fails(1, re.compile(r'^refocus: photo.ppm: (it is no stereo file|this build)'),
                   'depth', 'photo.ppm', '--stereo-file', '-o', 'd.png')
        self.fails(2, "--input-size: '8,8' cannot be used; give W,H from 32 to 2048", 'depth',
                   'photo.ppm', '--estimate', 'no.onnx', '--input-size', '8,8', '-o', 'd.png')
        self.fails(2, re.compile("^refocus: --upsample: 'magic' cannot be used"), 'depth',
                   'photo.ppm', '--depth', 'depth.pgm', '--full', '--upsample', 'magic', '-o',
                   'd.png')
        self.succeeds('depth', 'photo.ppm', '--depth', 'depth.pgm', '--snap', '2', '-o', 'd.png')
        os.remove('d.png')
        self.fails(1, re.compile(r'^refocus: no.onnx: (it cannot be read; give an ONNX file|this '
                                 r'build has no OpenCV)'),
                   'depth', 'photo.ppm', '-o', 'd.png', '--estimate', 'no.onnx')

    def strokes(self, name, *strokes, width=W, height=H):
        with open(name, 'w') as file:
            json.dump({'refocus-strokes': 1, 'width': width, 'height': height,
                       'strokes': strokes}, file)

    def test_depth_of_strokes(self):
        ground = {'kind': 'all', 'gradient': [[0, 0, 0], [0, H - 1, 1]]}
        brush = {'kind': 'brush', 'radius': 3, 'points': [[5, 5]], 'disparity': 1}
        self.strokes('s.json', ground, brush)
        report = self.reports('depth', 'photo.ppm', '--strokes', 's.json', '-o', 'a.png')
        self.assertEqual(report['evidence'], ['painted: 2 strokes'])
        self.assertEqual((report['width'], report['height']), (W, H))
        width, height, bits, channels, rows = pictures.read_png('a.png')
        self.assertEqual((width, height, bits, channels), (W, H, 16, 1))
        for y, row in enumerate(rows):
            self.assertLessEqual(abs(int.from_bytes(row[-2:], 'big') - 65535 * y / (H - 1)), 1)
        self.assertEqual(rows[5][10:12], b'\xff\xff')
        # over a depth map: the last strokes alone change it
        self.strokes('s.json', brush)
        self.succeeds('depth', 'photo.ppm', '--depth', 'depth.pgm', '--strokes', 's.json', '-o',
                      'b.png')
        self.succeeds('depth', 'depth.pgm', '-o', 'c.png')
        over, under = pictures.read_png('b.png')[4], pictures.read_png('c.png')[4]
        self.assertEqual(sum(over[y][2 * x:2 * x + 2] != under[y][2 * x:2 * x + 2]
                             for y in range(H) for x in range(W)), 29)
        self.succeeds('depth', 'photo.ppm', '--strokes', 's.json', '-o', 'v.png', '--view',
                      'confidence')
        self.strokes('s.json', {'kind': 'object', 'radius': 3, 'points': [[12, 12]],
                                'disparity': 0.5})
        self.succeeds('depth', 'plain.ppm', '--strokes', 's.json', '-o', 'd.pfm')

    def test_depth_of_bad_strokes(self):
        command = ('depth', 'photo.ppm', '-o', 'new.png', '--strokes')
        self.strokes('s.json', width=640)
        self.fails(1, 's.json: its strokes are of a picture of 640x32, the photo has 48x32',
                   *command, 's.json')
        self.strokes('s.json', {'kind': 'all', 'disparity': 2})
        self.fails(1, 's.json: strokes[0].disparity must be a number from 0 to 1', *command,
                   's.json')
        self.fails(1, 'no.json: cannot open it: No such file or directory', *command, 'no.json')
        self.fails(1, '.: cannot read it: Is a directory', *command, '.')
        self.fails(1, re.compile(r'^refocus: photo.ppm: line 1 is no JSON: '), *command,
                   'photo.ppm')
        for content, why in ((b'', 'it is empty'), (b' ' * (64 << 20) + b' ',
                                                    'it is larger than the limit of 67108864 bytes')):
            with open('s.json', 'wb') as file:
                file.write(content)
            self.fails(1, 's.json: ' + why, *command, 's.json')
        self.fails(2, '--strokes: they are not painted over half a picture; give LEFT and RIGHT',
                   *command, 's.json', '--side-by-side')
        os.remove('s.json')

    def test_depth_into_jpeg(self):
        self.succeeds('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'p.jpg', '--blur', '0')
        self.succeeds('depth', 'p.jpg', '--depth', 'depth.pgm', '-o', 'd0.jpg', '--focus-at',
                      '3,4', '--blur', '5', '--near', '0.5', '--far', '7')
        self.succeeds('depth', 'd0.jpg', '-o', 'd0.png')
        self.succeeds('depth', 'depth.pgm', '-o', 'd.png')
        self.assertEqual(pictures.read_png('d0.png'), pictures.read_png('d.png'))
        for i in range(10):
            self.succeeds('depth', 'd%d.jpg' % i, '-o', 'd%d.jpg' % (i + 1))
        with open('d0.jpg', 'rb') as first, open('d10.jpg', 'rb') as last, \
                open('p.jpg', 'rb') as photo:
            first, photo = first.read(), photo.read()
            self.assertEqual(first, last.read())
        rest = first.replace(first[20:20 + len(first) - len(photo)], b'', 1)
        self.assertEqual(rest, photo)
        info = self.reports('info', 'd10.jpg')
        self.assertEqual(info['depth']['near_m'], 0.5)

    def test_info(self):
        info = self.reports('info', 'photo.ppm')
        self.assertEqual((info['container'], info['picture'], info['depth'], info['orientation'],
                          info['camera'], info['file']),
                         ('PPM', [W, H], None, 1, None, 'photo.ppm'))
        info = self.reports('info', 'metres.pfm')
        self.assertEqual((info['container'], info['depth']['width'], info['depth']['sample']),
                         ('PFM', W, 'float'))
        self.assertTrue(info['evidence'])
        text = self.succeeds('info', 'mm.pgm')
        self.assertIn('depth size    48x32, 16-bit\n', text)
        self.assertIn('because ', text)
        self.fails(1, re.compile('^refocus: missing: '), 'info', 'missing')

    def test_odd_names(self):
        """A name cannot break the one line or the terminal."""
        name = 'a\nb\x1b[31m.ppm'
        shutil.copy('photo.ppm', name)
        self.assertNotIn('\x1b', self.succeeds('info', name))
        self.assertEqual(self.reports('info', name)['file'], 'a?b?[31m.ppm')
        self.fails(1, re.compile(r'^refocus: a\?b\?\[31m.ppm: it carries no depth'), 'render',
                   name, '-o', 'out.ppm')
        os.remove(name)
        raw = b'\xff.ppm'
        shutil.copy(b'photo.ppm', raw)
        result = subprocess.run([REFOCUS, 'info', raw, '--json'], stdout=subprocess.PIPE)
        self.assertEqual(json.loads(result.stdout)['file'], '?.ppm')
        os.remove(raw)


class Failures(Case):
    def test_inputs(self):
        for command, out in (('render', 'out.ppm'), ('depth', 'out.png'), ('depth', 'out.pgm')):
            self.fails(1, 'photo.ppm: it carries no depth; give a depth map to --depth, or make '
                       "one by 'refocus depth PHOTO -o MAP.png' with --estimate MODEL.onnx or "
                       '--strokes FILE.json', command, 'photo.ppm', '-o', out)
        self.fails(1, re.compile('^refocus: missing.jpg: .*No such file'), 'render',
                   'missing.jpg', '-o', 'out.ppm')
        self.fails(1, re.compile('^refocus: missing.png: .*No such file'), 'render',
                   'photo.ppm', '--depth', 'missing.png', '-o', 'out.ppm')
        self.fails(1, re.compile('^refocus: photo.ppm: '), 'render', 'photo.ppm', '--depth',
                   'photo.ppm', '-o', 'out.ppm')  # in colour
        os.mkdir('folder')
        self.fails(1, re.compile('^refocus: folder: '), 'render', 'folder', '-o', 'out.ppm')
        os.rmdir('folder')
        for name, data in (('empty.jpg', b''), ('text.jpg', b'not a picture\n'),
                           ('cut.ppm', pictures.read_bytes('photo.ppm')[:100])):
            with open(name, 'wb') as file:
                file.write(data)
            for arguments in (('render', name, '--depth', 'depth.pgm', '-o', 'out.ppm'),
                              ('render', 'photo.ppm', '--depth', name, '-o', 'out.ppm'),
                              ('depth', name, '-o', 'out.png'), ('info', name)):
                self.fails(1, re.compile('^refocus: %s: ' % name), *arguments)
        pictures.pgm('holes.pgm', 4, 4, lambda x, y: 0)
        self.fails(1, 'holes.pgm: no sample of the depth map holds a value; give another '
                      '--depth or --depth-unit', 'render', 'photo.ppm', '--depth', 'holes.pgm',
                   '--depth-unit', 'mm', '-o', 'out.ppm')
        self.fails(1, re.compile('^refocus: metres.pfm: '), 'render', 'metres.pfm', '-o',
                   'out.ppm')

    def test_cpu(self):
        states = [self.run_it(*self.render('--cpu', name)) for name in
                  ('c', 'neon', 'sse41', 'avx2', 'avx512', 'auto')]
        self.assertEqual((states[0].returncode, states[5].returncode), (0, 0))
        for state in states:
            self.assertIn(state.returncode, (0, 1))
            if state.returncode == 1:
                self.assertRegex(state.stderr, r'^refocus: --cpu: this processor or build has '
                                               r'no \w+; give auto\n$')
        self.assertIn(1, [state.returncode for state in states])  # no processor has them all
        os.remove('out.ppm')

    def test_outputs(self):
        self.fails(2, 'out.tif: no such format is written; end the name in .jpg, .jpeg, .png or '
                      '.ppm', 'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.tif')
        self.fails(1, re.compile('^refocus: none/out.ppm: the folder none cannot be written to '
                                 r'\(No such file or directory\); give another place'), 'render',
                   'photo.ppm', '--depth', 'depth.pgm', '-o', 'none/out.ppm')
        os.mkdir('dir.ppm')
        self.fails(1, 'dir.ppm: it is a folder; give the name of a file', 'render', 'photo.ppm',
                   '--depth', 'depth.pgm', '-o', 'dir.ppm')
        os.rmdir('dir.ppm')
        if os.geteuid() != 0:
            os.mkdir('locked', 0o500)
            self.fails(1, re.compile('^refocus: locked/out.ppm: the folder locked cannot be '),
                       'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'locked/out.ppm')
            os.rmdir('locked')

    def test_inputs_are_not_overwritten(self):
        lost = ': it is an input too and would be lost; give another name'
        os.link('photo.ppm', 'link.ppm')
        shutil.copy('depth.pgm', 'depth.png')
        for name in ('photo.ppm', './photo.ppm', 'link.ppm'):
            self.fails(2, name + lost, 'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', name)
        self.fails(2, 'depth.png' + lost, 'render', 'photo.ppm', '--depth', 'depth.png', '-o',
                   'depth.png')
        self.fails(2, 'depth.pgm' + lost, 'depth', 'depth.pgm', '-o', 'depth.pgm')
        os.remove('link.ppm')

    def test_full_output(self):
        if not os.path.exists('/dev/full'):
            self.skipTest('no /dev/full here')
        with open('/dev/full', 'w') as full:
            result = subprocess.run([REFOCUS, 'info', 'photo.ppm', '--json'], stdout=full,
                                    stderr=subprocess.PIPE, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, '^refocus: (standard output|--json): .*\n$')

    def test_what_was_there_stays(self):
        """A failure after the checks leaves the old file at OUT whole."""
        with open('old.ppm', 'wb') as file:
            file.write(b'old')
        self.fails(1, re.compile('^refocus: text.pgm: '), 'render', 'photo.ppm', '--depth',
                   self.text_file(), '-o', 'old.ppm')
        self.assertEqual(pictures.read_bytes('old.ppm'), b'old')

    def text_file(self):
        with open('text.pgm', 'w') as file:
            file.write('P5\n')
        return 'text.pgm'


if __name__ == '__main__':
    unittest.main()
