#!/usr/bin/env python3
"""Several photos in one call of `refocus render`: their names, what fails, what is never written
twice, and signals. Usage: test_many.py REFOCUS [unittest arguments]"""
import json
import os
import pty
import re
import shutil
import signal
import subprocess
import time
import unittest

import pictures
from case import Case, H, REFOCUS, W


class Many(Case):
    def setUp(self):
        for i, name in enumerate(('a.ppm', 'b.ppm', 'c.ppm')):
            pictures.ppm(name, W, H, lambda x, y, i=i: (x * 5 & 255, y * 8 & 255, 80 * i))
        os.makedirs('out')

    def tearDown(self):
        shutil.rmtree('out')

    def many(self, *arguments, photos=('a.ppm', 'b.ppm', 'c.ppm'), depth='depth.pgm'):
        return ('render', *photos, '--depth', depth, '--blur', '4', *arguments)

    def renders(self, rendered, failed, *arguments, lines=(), **more):
        """The exit status and the lines follow from the numbers; returns standard output."""
        result = self.run_it(*self.many(*arguments, **more))
        self.assertEqual(sorted(result.stderr.splitlines()[:-1]), sorted(lines), arguments)
        self.assertEqual(result.stderr.splitlines()[-1],
                         '%d rendered, %d failed' % (rendered, failed))
        self.assertEqual(result.returncode, 1 if failed else 0)
        return result.stdout

    def written(self):
        return sorted(os.listdir('out'))

    def test_folder(self):
        self.renders(3, 0, '-o', 'out')
        self.assertEqual(self.written(), ['a.ppm', 'b.ppm', 'c.ppm'])
        for name in self.written():
            self.succeeds('render', name, '--depth', 'depth.pgm', '--blur', '4', '-o', 'out.ppm')
            self.same(pictures.read_bytes('out/' + name), pictures.read_bytes('out.ppm'), name)
        self.succeeds(*self.many('-o', 'out/', photos=['b.ppm']))  # one is no batch: no last line
        os.remove('out.ppm')

    def test_a_folder_of_photos(self):
        """It is not taken for a photo, whether the folder of the results is there or not."""
        os.makedirs('photos', exist_ok=True)
        for output in 'out', 'none', 'new.png':
            self.fails(1, 'photos: it is a folder; give the names of the photos in it', 'render',
                       'photos', '-o', output)
        os.rmdir('photos')

    def test_patterns(self):
        self.renders(3, 0, '-o', 'out/{n}-{name}-{blur}-{quality}-{{x}.png', '--jobs', '2')
        self.assertEqual(self.written(), ['%d-%s-4-auto-{x}.png' % (i + 1, name)
                                          for i, name in enumerate('abc')])
        self.succeeds(*self.many('-o', 'out/{name}.{ext}', photos=['a.ppm']))
        self.assertIn('a.ppm', self.written())
        os.makedirs('deep{n}')
        self.renders(3, 0, '-o', 'deep{n}')  # a folder is taken as it is
        self.assertEqual(sorted(os.listdir('deep{n}')), ['a.ppm', 'b.ppm', 'c.ppm'])
        shutil.rmtree('deep{n}')
        shutil.copy('a.ppm', 'raw.cr2')
        self.renders(2, 0, '-o', 'out', photos=['raw.cr2', 'b.ppm'])  # not written so: jpg
        self.assertIn('raw.jpg', self.written())
        os.remove('raw.cr2')

    def test_many_numbers(self):
        """{n} sorts as it counts."""
        names = ['%d.ppm' % i for i in range(10)]
        for name in names:
            shutil.copy('a.ppm', name)
        self.renders(10, 0, '-o', 'out/{n}.ppm', photos=names)
        self.assertEqual(self.written(), ['%02d.ppm' % (i + 1) for i in range(10)])
        for name in names:
            os.remove(name)

    def test_each_depth(self):
        for name, near in ('a', 0), ('b', 255):
            pictures.pgm(name + '-depth.pgm', W, H, lambda x, y, v=near: v if x < 9 else 255 - v)
        self.renders(2, 0, '-o', 'out', '--focus', '1', depth='{name}-depth.pgm',
                     photos=['a.ppm', 'b.ppm'])
        for name in 'ab':
            self.succeeds('render', name + '.ppm', '--depth', name + '-depth.pgm', '--blur', '4',
                          '--focus', '1', '-o', 'one.ppm')
            self.same(pictures.read_bytes('one.ppm'), pictures.read_bytes('out/%s.ppm' % name))
            os.remove(name + '-depth.pgm')
        os.remove('one.ppm')

    def test_failures_do_not_stop_the_rest(self):
        with open('bad.ppm', 'w') as file:
            file.write('no picture')
        known = self.run_it('info', 'bad.ppm').stderr.strip()
        self.assertTrue(known.startswith('refocus: bad.ppm: '))
        gone = 'refocus: gone.ppm: cannot open it: No such file or directory'
        photos = ['bad.ppm', 'a.ppm', 'gone.ppm', 'c.ppm']
        for jobs in (), ('--jobs', '1'), ('--jobs', '4'):
            self.assertEqual(self.renders(2, 2, '-o', 'out/{n}.ppm', *jobs, photos=photos,
                                          lines=[known, gone]), '')
            self.assertEqual(self.written(), ['2.ppm', '4.ppm'])
        pictures.ppm('small.ppm', 21, 14, lambda x, y: (x, y, 9))
        self.renders(1, 1, '-o', 'out', '--focus-at', '30,30', photos=['a.ppm', 'small.ppm'], lines=[
            'refocus: small.ppm: --focus-at: 30,30 lies outside of small.ppm; give 0,0 to 20,13'])
        report = json.loads(self.renders(2, 1, '-o', 'out', '--json', lines=[known],
                                         photos=['a.ppm', 'bad.ppm', 'c.ppm']))
        self.assertEqual((report['rendered'], report['failed']), (2, 1))
        self.assertEqual([photo['photo'] for photo in report['photos']],
                         ['a.ppm', 'bad.ppm', 'c.ppm'])
        self.assertEqual(report['photos'][1], {'photo': 'bad.ppm', 'output': 'out/bad.ppm',
                                               'failed': True})
        self.assertEqual(report['photos'][2]['width'], W)
        os.remove('bad.ppm')
        os.remove('small.ppm')

    def test_no_place_is_written_twice(self):
        def refused(line, *arguments, **more):
            self.fails(2, line, *self.many(*arguments, **more))
            self.assertEqual(self.written(), written)

        os.symlink('real.ppm', 'out/1.ppm')
        os.symlink('real.ppm', 'out/2.ppm')
        os.symlink('out', 'way')
        written = self.written()
        both = 'out/%s: %s and %s would both be written there; give a name with {n}'
        refused(both % ('4.ppm', 'a.ppm', 'b.ppm'), '-o', 'out/{blur}.ppm', photos=['a.ppm',
                                                                                    'b.ppm'])
        refused(both % ('a.ppm', 'a.ppm', './a.ppm'), '-o', 'out', photos=['a.ppm', './a.ppm'])
        refused(both % ('2.ppm', 'a.ppm', 'b.ppm'), '-o', 'out/{n}.ppm', photos=['a.ppm', 'b.ppm'])
        lost = ': it is an input too and would be lost; give another name'
        refused('./a.ppm' + lost, '-o', '.')
        shutil.copy('a.ppm', '2.ppm')
        refused('way/../2.ppm' + lost, '-o', 'way/../{n}.ppm', photos=['2.ppm', 'b.ppm'])
        refused('out/../2.ppm' + lost, '-o', 'out/../{n}.ppm', photos=['b.ppm', 'a.ppm', '2.ppm'])
        os.remove('2.ppm')
        os.remove('way')

    def test_what_is_refused(self):
        for status, line, arguments in (
                (2, '-o: there is no folder nix for 3 photos; make it, or give a name with {name}',
                 ('-o', 'nix')),
                (2, '-o: there is no folder nix/; make it', ('-o', 'nix/')),
                (2, '-o: {zz} is not known; give {name}, {ext}, {n} or an option such as {blur}; '
                 '{{ is a brace', ('-o', 'out/{zz}.ppm')),
                (2, '-o: {nane} is not known; did you mean {name}? {{ is a brace',
                 ('-o', 'out/{nane}.ppm')),
                (2, '--depth: {f-nmber} is not known; did you mean {f-number}? {{ is a brace',
                 ('-o', 'out', '--depth', '{f-nmber}.pgm')),
                (2, "-o: '{name.ppm' lacks a closing brace; {{ is a brace", ('-o', 'out/{name.ppm')),
                (2, '-o: {focus} has no value that can be part of a name; give --focus one, or '
                 'leave it out', ('-o', 'out/{focus}{n}.ppm')),
                (2, '-o: {depth} has no value that can be part of a name; give --depth one, or '
                 'leave it out', ('-o', 'out/{depth}{n}.ppm', '--depth', './depth.pgm')),
                (2, '-o: {json} has no value that can be part of a name; give --json one, or '
                 'leave it out', ('-o', 'out/{json}{n}.ppm', '--json')),
                (2, '-o: the name is too long; give a shorter one',
                 ('-o', 'out/' + 'x' * 4090 + '{n}.ppm')),
                (2, '-o: the output has no name; give -o OUT', ()),
                (2, '--repeat: it times one photo; give one, or leave it out',
                 ('-o', 'out', '--repeat', '3')),
                (1, re.compile('^refocus: none/a.ppm: the folder none cannot be written to '),
                 ('-o', 'none/{name}.ppm')),
                (2, re.compile('^refocus: --jobs: .0. cannot be used; give a whole number from 1 '),
                 ('-o', 'out', '--jobs', '0'))):
            self.fails(status, line, *self.many(*arguments))
            self.assertEqual(self.written(), [])
        self.fails(2, '-o: there is no folder nix/; make it', *self.many('-o', 'nix/',
                                                                         photos=['a.ppm']))

    def test_settings(self):
        self.renders(3, 0, '-o', 'out', '--save-settings', 'out/look.json', '--rays', '9')
        with open('out/look.json', encoding='utf-8') as file:
            self.assertEqual(json.load(file)['rays'], 9)

    def long(self, **more):
        """A batch that takes minutes, once its first two processes run."""
        process = subprocess.Popen(
            [REFOCUS, *self.many('-o', 'out', '--jobs', '2', '--method', 'raytrace', '--rays',
                                 'full', '--blur', '127', photos=[self.large(i) for i in '123'])],
            stderr=subprocess.PIPE, text=True, start_new_session=True, **more)
        self.addCleanup(self.end, process)
        while len(self.children(process)) < 2:
            time.sleep(0.01)
        time.sleep(0.1)
        return process

    @staticmethod
    def end(process):
        """The batch of a test that failed meanwhile does not go on."""
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.communicate()

    @staticmethod
    def large(name):
        with open(name + '.ppm', 'wb') as file:
            file.write(b'P6 600 400 255 ' + bytes(range(240)) * 3000)
        return name + '.ppm'

    @staticmethod
    def children(process):
        with open('/proc/%d/task/%d/children' % (process.pid, process.pid)) as file:
            return [int(word) for word in file.read().split()]

    def test_signals(self):
        for number, to_all, status in ((signal.SIGTERM, False, 1), (signal.SIGINT, True, 1),
                                       (signal.SIGHUP, False, -signal.SIGHUP)):
            process = self.long()
            children = self.children(process)
            (os.killpg if to_all else os.kill)(process.pid, number)
            error = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, status, error)
            self.assertEqual(error.splitlines()[-1], '0 rendered, 2 failed, 1 not begun')
            for child in children:
                self.assertFalse(os.path.exists('/proc/%d' % child))
            self.assertEqual(self.written(), [])

    def test_ended_process(self):
        process = self.long()
        for _ in range(3):
            children = self.children(process)
            while not children and process.poll() is None:
                children = self.children(process)
            os.kill(children[0], signal.SIGKILL)
            while children[0] in self.children(process):
                time.sleep(0.01)
        error = process.communicate(timeout=60)[1].splitlines()
        self.assertEqual(process.returncode, 1)
        self.assertEqual(sorted(error), ['0 rendered, 3 failed'] + [
            'refocus: %d.ppm: its process was ended by signal 9, for want of memory if by nobody' %
            i for i in (1, 2, 3)])
        self.assertEqual(self.written(), [])

    def test_progress(self):
        """On a terminal, and wiped before each line."""
        master, slave = pty.openpty()
        process = subprocess.Popen([REFOCUS, *self.many('-o', 'out', photos=['a.ppm', 'gone.ppm'])],
                                   stderr=slave)
        os.close(slave)
        said = b''
        try:
            while True:
                said += os.read(master, 4096)
        except OSError:  # the terminal has no other side any more
            os.close(master)
        self.assertEqual(process.wait(), 1)
        self.assertRegex(said, rb'\] +0 % 0 of 2, a\.ppm')
        self.assertRegex(said, rb'\] +50 % 1 of 2, gone\.ppm')
        self.assertRegex(said, rb'\r\x1b\[Krefocus: gone\.ppm: cannot open it')
        self.assertRegex(said, rb'\r\x1b\[K1 rendered, 1 failed\r\n$')


if __name__ == '__main__':
    unittest.main()
