#!/usr/bin/env python3
"""The refocus command: every option at and beyond its limits, every error line, no
leftovers. Usage: test_cli.py REFOCUS [unittest arguments]"""
import os
import random
import re
import shutil
import subprocess
import unittest

import pictures
from case import Case, H, REFOCUS, W
from names import cpu_names, method_names, methods_with_rays

METHODS = method_names(REFOCUS)


class Usage(Case):
    SUBCOMMANDS = ('render', 'sheet', 'pull', 'depth', 'info', 'compare', 'bench', 'view', 'serve',
                   'stack')
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
                      '-o --output --depth --depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory --invalid --speckle --behind --behind-depth --estimate --network --input-size --input-mean --input-scale --far-is-large --stereo --stereo-file --match --pair-order --strokes '
                      '--upsample --depth-edges --orient-depth --matte --gain-map --no-dither --focus --focus-at --focus-rectangle '
                      '--focus-distance --blur --f-number --focal-length --sensor-width '
                      '--method --rays --iterations --quality --aperture --blend --sigma '
                      '--highlights --mirror --background --no-thin --fill --threads --cpu --repeat --json --view '
                      '--low-memory --parallax --region --jobs --format --resize --jpeg-quality --config --preset --settings --save-settings --strip --editable --no-editable --transfer --white -h --help --help-all',
            'depth': '-o --output --depth --depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory --invalid --speckle --full '
                     '--orient-depth --depth-edges --upsample --estimate --network --input-size --input-mean --input-scale '
                     '--far-is-large --match --pair-order --strokes --focal-stack --positions --reference --align --order --in-focus --photo --stereo-file --side-by-side --view '
                     '--focus-at --blur --json -h --help --help-all',
            'stack': '-o --output --photo --keep --camera --steps --range --average --settle --size '
                     '--dry-run --json -h --help --help-all',
            'sheet': self.PAPERS + self.CONTROLS +
                     '-o --output --depth --depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory --invalid --speckle --behind --behind-depth --estimate --network --input-size --input-mean --input-scale --far-is-large --stereo --stereo-file --match --pair-order --strokes '
                     '--upsample --depth-edges --orient-depth --matte --gain-map --no-dither --transfer --white --kind --focuses --blurs --f-numbers --apertures --sigmas '
                     '--cell-width --region --focus --focus-at --focus-rectangle '
                     '--focus-distance --blur --f-number --focal-length --sensor-width --method --rays --iterations '
                     '--quality --aperture --blend --sigma --highlights --mirror --background --no-thin --fill '
                     '--threads --cpu --json --config --preset --settings --save-settings -h --help --help-all',
            'pull': self.PAPERS + self.CONTROLS +
                    '-o --output --depth --depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory --invalid --speckle --behind --behind-depth --estimate --network --input-size --input-mean --input-scale --far-is-large --stereo --stereo-file --match --pair-order --strokes '
                    '--upsample --depth-edges --orient-depth --matte --gain-map --no-dither --transfer --white --from --to --blur-from --blur-to --keys --seconds --fps --ease --back '
                    '--wiggle '
                    '--focus --focus-at --focus-rectangle --focus-distance --blur --f-number '
                    '--focal-length --sensor-width --method --rays --iterations --quality --aperture --blend '
                    '--sigma --highlights --mirror --background --no-thin --fill --threads --cpu --json '
                    '--config --preset --settings --save-settings -h --help --help-all',
            'view': self.PAPERS + self.CONTROLS +
                    '-o --output --depth --depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory --invalid --speckle --estimate --network --input-size --input-mean --input-scale --far-is-large --stereo --stereo-file --match --pair-order --strokes '
                    '--upsample --depth-edges --orient-depth --matte --gain-map --no-dither --transfer --white '
                    '--focus --focus-at --focus-rectangle --focus-distance --blur --f-number '
                    '--focal-length --sensor-width --method --rays --iterations --quality '
                    '--aperture --blend --sigma --highlights --mirror --background --no-thin --fill --threads '
                    '--cpu --json --config --preset --settings --size --fullscreen --seconds --page --font --dpi -h --help --help-all',
            'serve': '--port --listen --origin --live --depth --depth-unit --near --far --max-upload --session-memory --upsample --depth-edges --max-side --max-pixels '
                     '--raw-preview --max-memory --threads --cpu -h --help --help-all',
            'info': '--depth --depth-unit --near --far --orient-depth --invalid --speckle --focus --focus-at --focus-rectangle --focus-distance --blur --f-number '
                    '--focal-length --sensor-width --max-side --max-pixels --raw-preview --max-memory --json -h --help --help-all',
            'compare': self.PAPERS + '-o --output --reference --methods --border --depth '
                       '--depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory --upsample --depth-edges --orient-depth --matte --gain-map --no-dither --transfer --white --focus --focus-at --focus-rectangle '
                       '--focus-distance --blur --f-number --focal-length --sensor-width --rays --iterations '
                       '--quality --aperture --blend --sigma --highlights --mirror --background --no-thin --fill '
                       '--threads --cpu --repeat --json -h --help --help-all',
            'bench': self.PAPERS + '--frames --kernels --size --depth --depth-unit --near --far --max-side --max-pixels --raw-preview --max-memory '
                     '--focus --focus-at --focus-rectangle '
                     '--focus-distance --blur --method --rays --iterations --quality '
                     '--aperture --blend --sigma --highlights --mirror --background --no-thin --fill --threads --cpu '
                     '--repeat --json -h --help --help-all',
        }
        for name, expected in options.items():
            text = self.succeeds(name, '--help-all')
            file = () if name == 'stack' else ('x',)
            self.assertEqual(text, self.succeeds(name, *file, '--help-all', '--nonsense'))
            listed = set(re.findall(r'(?m)^  (-\w|--[\w-]+)(?=[ ,\n])', text))
            listed |= set(re.findall(r'(?m)^  -\w, (--[\w-]+)', text))
            self.assertEqual(listed, set(expected.split()))
            self.assertLessEqual(max(map(len, text.splitlines())), 80)
            for word in set(expected.split()) - {'-h', '--help', '--help-all'}:  # and the parser knows it
                error = self.run_it(name, word + '=' if word.startswith('--') else word)
                self.assertNotIn('unknown', error.stderr)
            for method in METHODS if '--method' in listed else ():
                self.assertRegex(text, r'(?m)^ {28}%s +\w' % method)

    def test_version(self):
        text = self.succeeds('--version')
        self.assertRegex(text, r'^refocus \d+\.\d+\.\d+\nfiles: \S')
        for word in '-V', '-v', 'version':
            self.assertEqual(self.succeeds(word), text)

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
        shutil.copy('photo.ppm', '-x.ppm')
        self.fails(2, '-x.ppm: unknown option; a file of this name is given as ./-x.ppm', 'render',
                   '-x.ppm')
        self.fails(2, "-x: unknown option; 'refocus render --help-all' lists them",
                   *self.render('-x'))
        self.fails(2, '--focus: has no value; give D', *self.render('--focus'))
        self.fails(2, '--focus: has no value; give D', *self.render('--focus', '--json'))
        self.fails(2, "--json: takes no value; leave '=1' out", *self.render('--json=1'))
        self.fails(2, '--depth: is empty; give FILE', *self.render('--depth='))
        self.fails(2, 'two.ppm: one file too many; give refocus sheet PHOTO -o OUT [options]',
                   'sheet', 'photo.ppm', 'two.ppm')
        self.fails(2, 'render: no file; give refocus render PHOTO... -o OUT [options]', 'render')
        self.fails(2, 'info: no file; give refocus info FILE|- [options]', 'info')
        self.fails(2, 'info: a file name is empty; give refocus info FILE|- [options]', 'info', '')
        self.fails(2, '-o: the output has no name; give -o OUT', 'render', 'photo.ppm')
        self.fails(2, re.compile("^refocus: --method: 'swep' is not one of " + ', '.join(METHODS) +
                                 ".*; did you mean 'sweep'\\?"),
                   *self.render('--method', 'swep'))
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
        self.check('--blur', ['0', '0.3', '127', '128', '944'], ['-1', '944.1', '1e99'] + nonsense,
                   'a number from 0 to 944')
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

    def test_limits_of_files(self):
        for order in (('info', 'photo.ppm'), self.render()):
            self.succeeds(*order, '--max-side', '48', '--max-pixels', '1536', '--max-memory', '1')
            for option, value, what in (('--max-side', 47, 'a side; scale it down'),
                                        ('--max-pixels', 1535, 'pixels')):
                self.fails(1, 'photo.ppm: its 48 x 32 pixels are more than the limit of %d %s' %
                           (value, what), *order, option, str(value))
        self.check('--max-pixels', ['1e5', '4294836225'], ['0', '-1', '1.5', '4294836226'],
                   'a whole number from 1 to 4294836225')
        with open('large.ppm', 'wb') as file:  # 1.2 MB, and as much again for its pixels
            file.write(b'P6 640 640 255 ' + bytes(3 * 640 * 640))
        self.fails(1, 'large.ppm: decoding it needs 2457615 bytes, more than the limit of 2097152',
                   'info', 'large.ppm', '--max-memory', '2')
        self.succeeds('info', 'large.ppm', '--max-memory', '3')

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
        self.assertEqual(self.reports(*self.render())['highlights'], 'auto')
        self.assertEqual(self.reports(*self.render('--highlights', 'auto'))['highlights'], 'auto')
        self.assertEqual(self.reports(*self.render('--highlights', '4'))['highlights'], 4)
        self.assertEqual(self.reports(*self.render('--highlights', 'off'))['highlights'], 1)
        for method, given, said in (('search', 'auto', 'auto'), ('search', '3', 3), ('blur', None, 1)):
            more = ('--highlights', given) if given else ()
            self.assertEqual(self.reports(*self.render('--method', method, *more))['highlights'],
                             said)

    def test_what_would_change_nothing(self):
        for method, other, *option in (
                ('search', 'sweep', '--iterations', '1'), ('search', 'blur', '--mirror'),
                ('search', 'sweep', '--background'), ('sweep, search', 'blur', '--highlights', '2'),
                ('sweep, search', 'scatter', '--highlight-stops', '2'),
                (', '.join(methods_with_rays(REFOCUS)), 'jittered', '--rays', '8'),
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
        os.remove('out.ppm')

    def test_grain_by_default(self):
        noise = random.Random(5)
        width, height = 160, 120

        def picture(sigma, *options):
            pixels = [min(max(round(120 + noise.gauss(0, sigma)), 0), 255)
                      for i in range(width * height)]
            with open('noisy.ppm', 'wb') as f:
                f.write(b'P6 %d %d 255\n' % (width, height) +
                        bytes(v for v in pixels for c in range(3)))
            with open('noisy.pgm', 'wb') as f:
                f.write(b'P5 %d %d 255\n' % (width, height) +
                        bytes(40 if i % width < 80 else 200 for i in range(width * height)))
            out = []
            for more in [], ['--grain', '1'], ['--grain', 'off'], ['--grain', '0']:
                self.succeeds('render', 'noisy.ppm', '--depth', 'noisy.pgm', '--focus', '1',
                              '--blur', '12', *more, '-o', 'out.ppm')
                with open('out.ppm', 'rb') as f:
                    out.append(f.read())
            self.assertEqual(out[0], out[1])
            self.assertEqual(out[2], out[3])
            return out[0] != out[2]
        self.assertTrue(picture(4))
        self.assertFalse(picture(0.5))
        for name in 'noisy.ppm', 'noisy.pgm':
            os.remove(name)
        self.succeeds(*self.render())
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
        self.fails(2, "--repeat: unknown option; 'refocus pull --help-all' lists them", *pull, '--repeat',
                   '3')
        self.fails(2, '--blur: --blurs is in its place; leave one of them out', *sheet, '--blur',
                   '3', '--blurs', '3')
        self.fails(2, '--aperture: --apertures is in its place; leave it out', *sheet,
                   '--aperture', 'heart', '--kind', 'aperture')
        for option, value in ('--sigma', '9'), ('--blend', 'linear'):
            self.fails(2, option + ': the sheet has cells for several; leave it out', *sheet,
                       option, value, '--kind', 'sigma')
        self.fails(2, '--upsample: it goes with --full; give that too', *depth, '--depth',
                   'depth.pgm', '--upsample', 'core')
        self.fails(2, '--depth-edges: it goes with --full; give that too', *depth, '--depth',
                   'depth.pgm', '--depth-edges', 'auto')
        self.fails(2, "--depth-edges: 'sharp' cannot be used; give one of auto, as-given",
                   *self.render('--depth-edges', 'sharp'))
        for option, value in (('--depth-unit', 'mm'), ('--speckle', '4'),
                              ('--invalid', 'zero'), ('--upsample', 'core')):
            self.fails(2, option + ': --strokes alone paint over nothing; give --depth, or leave '
                       'it out', *depth, '--strokes', 's.json', option, value)
        for option, value in (('--input-size', '64,64'), ('--input-mean', '123.675,116.28,103.53'),
                              ('--input-scale', '1'), ('--far-is-large', None)):
            self.fails(2, option + ': it goes with --estimate; give that too', *depth, '--depth',
                       'depth.pgm', option, *([value] if value else []))
        self.fails(2, '--match: it is for stereo pairs; give RIGHT, --side-by-side or '
                   '--stereo-file, or leave it out', *depth, '--depth', 'depth.pgm', '--match',
                   'plain')
        self.fails(2, '--pair-order: it is for stereo pairs; give RIGHT, --side-by-side or '
                   '--stereo-file, or leave it out', *depth, '--depth', 'depth.pgm', '--pair-order',
                   'auto')
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
        self.fails(2, re.compile("^refocus: --aperture: 'dics' is not known; give disc, "
                                 "polygon:BLADES, polygon:BLADES:DEGREES, heart, star.* or a mask "
                                 "picture"), *self.render('--aperture', 'dics'))
        self.fails(1, 'wide.pgm: 256x1 pixels are too many for an aperture; give at most '
                      '255x255', *self.render('--aperture', 'wide.pgm'))
        self.fails(1, 'black.pgm: no pixel of the aperture is open; give white where light '
                      'passes', *self.render('--aperture', 'black.pgm'))
        self.fails(1, re.compile('^refocus: missing.png: '),
                   *self.render('--aperture', 'missing.png'))


class Failures(Case):
    def test_inputs(self):
        for command, out in (('render', 'out.ppm'), ('depth', 'out.png'), ('depth', 'out.pgm')):
            self.fails(1, 'photo.ppm: it carries no depth; give a depth map to --depth, MODEL.onnx '
                       'to --estimate or the other picture of a stereo pair to --stereo, or make a '
                       "map by 'refocus depth PHOTO -o MAP.png' with --focal-stack or --strokes",
                       command, 'photo.ppm', '-o', out)
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
        states = [self.run_it(*self.render('--cpu', name)) for name in cpu_names(REFOCUS)]
        self.assertEqual((states[0].returncode, states[1].returncode), (0, 0))
        for state in states:
            self.assertIn(state.returncode, (0, 1))
            if state.returncode == 1:
                self.assertRegex(state.stderr, r'^refocus: --cpu: this processor or build has '
                                               r'no \w+; give auto\n$')
        self.assertIn(1, [state.returncode for state in states])  # no processor has them all
        os.remove('out.ppm')

    def test_outputs(self):
        self.fails(2, re.compile('^refocus: out.bmp: no such format is written; end the name in '
                                 r'\.jpg, \.jpeg, \.png(, \.\w+)* or \.\w+$'),
                   'render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.bmp')
        self.fails(1, re.compile('^refocus: none/out.ppm: the folder none cannot be written to '
                                 r'\(No such file or directory\); give another place'), 'render',
                   'photo.ppm', '--depth', 'depth.pgm', '-o', 'none/out.ppm')
        os.mkdir('dir.ppm')
        self.fails(1, 'dir.ppm: it is a folder; give the name of a file', 'sheet', 'photo.ppm',
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
