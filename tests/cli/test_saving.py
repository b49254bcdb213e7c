#!/usr/bin/env python3
"""What saving leaves behind: nothing after any signal that ends the command, and the mode, the
owner and the links of what is replaced. Usage: test_saving.py REFOCUS [unittest arguments]"""
import json
import os
import resource
import shutil
import signal
import stat
import subprocess
import time
import unittest

import pictures
from case import Case, REFOCUS

ENDING = ['SIGHUP', 'SIGQUIT', 'SIGALRM', 'SIGVTALRM', 'SIGPROF', 'SIGUSR1', 'SIGUSR2', 'SIGXCPU',
          'SIGPOLL', 'SIGPWR', 'SIGSTKFLT', 'SIGRTMIN', 'SIGRTMAX']
STUCK = '#!/bin/sh\nfor out; do :; done\n: >"${out#file:}"\necho $$ >process\nexec sleep 600\n'


# Who starts the tests in the background, or by nohup, may have these ignored, and children would
# inherit that.
for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)


def no_core():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Saving(Case):
    def listing(self):
        return sorted(os.listdir('.'))

    def pull(self, name, *more):
        return ('pull', 'photo.ppm', '--depth', 'depth.pgm', '-o', name, '--threads', '1', *more)

    def start(self, *arguments, **more):
        return subprocess.Popen([REFOCUS, *arguments], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True,
                                **{'preexec_fn': no_core, **more})

    def started(self, *arguments, **more):
        """Once it has begun a file."""
        before, process = self.listing(), self.start(*arguments, **more)
        while self.listing() == before and process.poll() is None:
            time.sleep(0.01)
        self.assertIsNone(process.poll())
        return process

    def ended(self, process, number):
        error = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, -number, error)
        return error

    def test_signals(self):
        """Nothing is left, and the process ends by the signal."""
        before = self.listing()
        for name in ENDING:
            number = getattr(signal, name, None)
            if number is None:
                continue
            for out in ('a.y4m', 'f-%03d.png', 'a.apng')[:1 if name != 'SIGHUP' else 3]:
                process = self.started(*self.pull(out, '--seconds', '3600'))
                process.send_signal(number)
                self.assertIn('interrupted; nothing was written', self.ended(process, number))
                self.assertEqual(self.listing(), before, name)

    @unittest.skipIf('REFOCUS_SLOW' in os.environ, 'sanitizers come before what is preloaded')
    def test_a_signal_within_a_png(self):
        """Its rows end soon after it, however many there are, and no part of it stays."""
        side = 8000
        with open('tall.ppm', 'wb') as file:
            file.write(b'P6\n8 %d\n255\n' % side + bytes(range(24)) * side)
        pictures.pgm('flat.pgm', 2, 2, lambda x, y: 128)
        before = self.listing()
        env = {**os.environ, 'LD_PRELOAD': os.environ['REFOCUS_SIGNAL_IN_PNG']}
        still = ('tall.ppm', '--depth', 'flat.pgm', '--blur', '1')
        live = ('live', '--json', '--camera', 'file:tall.ppm', '--depth', 'file:flat.pgm', '--loop',
                '--no-commands', '--blur', '1', '--out', 'l%03d.png')
        for status, *command in ((1, 'render', *still, '--focus', '1', '-o', 'out.png'),
                                 (1, 'pull', *still, '--seconds', '3600', '-o', 'f%03d.png'),
                                 (1, 'pull', *still, '--seconds', '3600', '-o', 'f.apng'),
                                 (0, *live)):
            process = self.start(*command, '--threads', '1', env=env)
            out, error = process.communicate(timeout=300)
            self.assertEqual(process.returncode, status, (command, error))
            if status:
                self.assertRegex(error, r'^refocus: \S+: interrupted; nothing was written\n$')
            else:
                self.assertEqual((error, json.loads(out)['frames_out']), ('', 0))
            self.assertLess(os.stat('rows').st_size, side)  # each row after the signal waits
            os.remove('rows')
            self.assertEqual(self.listing(), before, command)
        os.remove('tall.ppm')

    @unittest.skipIf('REFOCUS_SLOW' in os.environ, 'sanitizers come before what is preloaded')
    def test_a_signal_while_saving_hangs(self):
        """In a library, on a slow disk: it is not waited for, and nothing of the file stays."""
        self.succeeds('depth', 'depth.pgm', '-o', 'd.png')  # what is there stays as it was
        with open('d.png', 'rb') as file:
            old = file.read()
        before = self.listing()
        still = ('photo.ppm', '--depth', 'depth.pgm', '--threads', '1')
        brief = (*still, '--seconds', '0.1', '-o')
        live = ('live', '--json', '--camera', 'file:photo.ppm', '--depth', 'file:depth.pgm',
                '--loop', '--no-commands', '--out', 'l%03d.')
        endings = [ending for ending in ('ppm', 'png', 'jpg', 'tif', 'exr', 'heic')
                   if self.run_it('render', *still, '-o', 'x.' + ending).returncode == 0]
        for name in set(self.listing()) - set(before):
            os.remove(name)
        hangs = [(at, 'out.' + ending, ('render', *still, '-o', 'out.' + ending))
                 for at in ('fsync', 'rename') for ending in endings]
        hangs += [(at, name, ('pull', *brief, name)) for at in ('fsync', 'rename')
                  for name in ('a.y4m', 'f%03d.ppm', 'a.apng') if (at, name) != ('fsync', 'f%03d.ppm')]
        hangs += [('fsync', 'd.png', ('depth', 'depth.pgm', '-o', 'd.png')),
                  ('rename', 'sheet.png', ('sheet', *still, '-o', 'sheet.png'))]
        if 'jpg' in endings:
            hangs += [('encode', 'out.jpg', ('render', *still, '-o', 'out.jpg')),
                      ('encode', None, (*live[:-1], live[-1] + 'jpg'))]
        hangs += [('rename', None, (*live[:-1], live[-1] + 'ppm'))]
        for at, name, command in hangs:
            for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
                env = {**os.environ, 'LD_PRELOAD': os.environ['REFOCUS_SIGNAL_IN_SAVE'],
                       'REFOCUS_STALL': at, 'REFOCUS_SIGNAL': str(int(number))}
                process = self.start(*command, env=env)
                out, error = process.communicate(timeout=60)
                by_signal = -number if number == signal.SIGHUP else None
                self.assertEqual(process.returncode, by_signal or (1 if name else 0), (at, command))
                if name:
                    line = 'refocus: %s: interrupted; nothing was written\n' % name
                    self.assertEqual(error, line, (at, command))
                else:
                    report = json.loads(out)
                    self.assertEqual((error, report['frames_out']), ('', 0), command)
                    self.assertGreater(report['sink_dropped'], 0)
                self.assertEqual(self.listing(), before, (at, command))
        with open('d.png', 'rb') as file:
            self.assertEqual(file.read(), old)
        os.remove('d.png')

    def test_first_signal_of_two(self):
        """Ctrl-C ends with status 1, as ever; a second one, of any kind, at once."""
        before = self.listing()
        for name, second in (('a.y4m', signal.SIGINT), ('f-%03d.ppm', signal.SIGHUP),
                             ('a.apng', signal.SIGTERM)):
            process = self.started(*self.pull(name, '--seconds', '3600'))
            process.send_signal(signal.SIGINT)
            time.sleep(0.002)
            process.send_signal(second)
            process.communicate(timeout=60)
            self.assertIn(process.returncode, (1, -second))
            self.assertEqual(self.listing(), before, name)

    def test_ignored_signals(self):
        """As nohup has it."""
        def ignore():
            signal.signal(signal.SIGHUP, signal.SIG_IGN)

        process = self.started(*self.pull('a.y4m', '--seconds', '40'), preexec_fn=ignore)
        process.send_signal(signal.SIGHUP)
        self.assertEqual((process.communicate(timeout=60)[1], process.returncode), ('', 0))
        os.remove('a.y4m')

    def test_a_pipe_is_no_photo(self):
        """One that nobody writes to would be waited for, for ever."""
        os.mkfifo('pipe.ppm')
        self.fails(1, 'pipe.ppm: it is a pipe, socket or device; give the name of a file', 'render',
                   'pipe.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm')
        os.remove('pipe.ppm')

    def test_waiting_for_an_encoder(self):
        """That does not read, and has made its file: both go."""
        before = self.listing()
        for first, second, status in ((signal.SIGHUP, None, -signal.SIGHUP),
                                      (signal.SIGINT, None, 1),
                                      (signal.SIGINT, signal.SIGTERM, -signal.SIGTERM)):
            os.mkdir('bin')
            with open('bin/ffmpeg', 'w') as file:
                file.write(STUCK)
            os.chmod('bin/ffmpeg', 0o755)
            process = self.start(*self.pull('a.mp4', '--seconds', '3600'),
                                 env={**os.environ, 'PATH': 'bin:' + os.environ['PATH']})
            while not os.path.exists('process'):
                time.sleep(0.01)
            time.sleep(0.5)
            self.assertIsNone(process.poll())
            with open('process') as file:
                encoder = int(file.read())
            process.send_signal(signal.SIGSTOP)  # so that the second comes with the first
            process.send_signal(first)
            if second:
                process.send_signal(second)
            process.send_signal(signal.SIGCONT)
            self.ended(process, -status)
            for _ in range(500):  # until its new parent has taken it up
                try:
                    with open('/proc/%d/stat' % encoder) as file:
                        if file.read().rsplit(')')[1].split()[0] == 'Z':
                            break
                except OSError:
                    break
                time.sleep(0.01)
            else:
                self.fail('the encoder lives')
            os.remove('process')
            shutil.rmtree('bin')
            self.assertEqual(self.listing(), before)

    def test_files_that_may_not_grow(self):
        def limit():
            no_core()
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

        before = self.listing()
        for command in (('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm'),
                        self.pull('a.y4m'), self.pull('f-%03d.ppm'), self.pull('a.apng'),
                        ('depth', 'depth.pgm', '-o', 'd.pgm')):
            error = self.ended(self.start(*command, preexec_fn=limit), signal.SIGXFSZ)
            self.assertIn('File too large', error)
            self.assertEqual(self.listing(), before, command)

    def test_reports_that_nobody_reads(self):
        """Quietly by SIGPIPE; and as a failure where that is ignored."""
        def ignore():
            signal.signal(signal.SIGPIPE, signal.SIG_IGN)

        for preexec, expected in ((None, (-signal.SIGPIPE, '')), (ignore, (
                1, 'refocus: standard output: Broken pipe; make room for it\n'))):
            end, other = os.pipe()
            os.close(end)
            result = subprocess.run([REFOCUS, 'info', 'photo.ppm'], stdout=other, text=True,
                                    stderr=subprocess.PIPE, preexec_fn=preexec, timeout=60)
            os.close(other)
            self.assertEqual((result.returncode, result.stderr), expected)

    COMMANDS = (
        ('out.ppm', ('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.ppm')),
        ('out.jpg', ('sheet', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'out.jpg', '--cell-width',
                     '24')),
        ('d.png', ('depth', 'depth.pgm', '-o', 'd.png')),
        ('s.json', ('render', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'other.ppm',
                    '--save-settings', 's.json')),
        ('a.y4m', ('pull', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'a.y4m', '--seconds', '0.1')),
        ('a.apng', ('pull', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'a.apng', '--seconds',
                    '0.1')),
        ('f-1.ppm', ('pull', 'photo.ppm', '--depth', 'depth.pgm', '-o', 'f-%d.ppm', '--seconds',
                     '0.1')),
    )

    def remove_all(self):
        for name in self.listing():
            if name not in ('photo.ppm', 'depth.pgm', 'mm.pgm', 'metres.pfm', 'plain.ppm'):
                os.remove(name)

    def test_the_last_byte_does_not_fit(self):
        """What is in a buffer until the file is closed is missed, too."""
        before = self.listing()
        for name, command in self.COMMANDS:
            self.succeeds(*command)
            most = os.stat(name).st_size - 1
            self.remove_all()

            def limit():
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

            error = self.ended(self.start(*command, preexec_fn=limit), -1)
            self.assertRegex(error, '^refocus: .*File too large', name)
            self.assertEqual(self.listing(), before, name)

    def test_mode_and_owner_are_kept(self):
        root = os.geteuid() == 0
        for name, command in self.COMMANDS:
            self.succeeds(*command)
            fresh = os.stat(name)
            mask = os.umask(0)
            os.umask(mask)
            self.assertEqual(stat.S_IMODE(fresh.st_mode), 0o666 & ~mask, name)
            os.chmod(name, 0o640)
            if root:
                os.chown(name, 4711, 4712)
            self.succeeds(*command)
            kept = os.stat(name)
            self.assertNotEqual(kept.st_ino, fresh.st_ino, name)  # it is another file
            self.assertEqual(stat.S_IMODE(kept.st_mode), 0o640, name)
            if root:
                self.assertEqual((kept.st_uid, kept.st_gid), (4711, 4712), name)
            self.remove_all()

    def test_links_stay(self):
        for name, command in self.COMMANDS:
            os.mkdir('there')
            for _ in range(2):  # what is not there yet, and what is
                if not os.path.lexists(name):
                    os.symlink('there/file', name)
                self.succeeds(*command)
                self.assertTrue(os.path.islink(name), name)
                self.assertGreater(os.path.getsize('there/file'), 20, name)
                self.assertEqual(os.listdir('there'), ['file'], name)
            shutil.rmtree('there')
            self.remove_all()

    def test_only_files_are_replaced(self):
        """Devices least of all: for root they would be files from then on."""
        why = 'it is a pipe, socket or device; give the name of a file'
        for name, command in self.COMMANDS:
            os.mkfifo(name)
            line = name.replace('f-1', 'f-%d') + ': ' + why
            self.fails(1, line, *command)
            os.remove(name)
            os.symlink('/dev/null', name)
            self.fails(1, line, *command)
            self.assertTrue(stat.S_ISCHR(os.stat('/dev/null').st_mode))
            self.remove_all()

    @unittest.skipUnless(shutil.which('strace'), 'no strace to count what is synced')
    def test_files_are_synced(self):
        """The file, then its name, then its folder."""
        trace = ['strace', '-f', '-y', '-e', 'trace=fsync,rename,renameat,renameat2', '-o', 'trace']
        if subprocess.run([*trace, 'true'], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest('strace may not trace')
        # The leak sanitizer traces the process itself, which cannot be done twice.
        untraced_leaks = dict(os.environ, ASAN_OPTIONS=':'.join(
            [os.environ.get('ASAN_OPTIONS', ''), 'detect_leaks=0']))
        for name, command in self.COMMANDS:
            result = subprocess.run([*trace, REFOCUS, *command], stderr=subprocess.PIPE, text=True,
                                    env=untraced_leaks)
            self.assertEqual((result.returncode, result.stderr), (0, ''))
            with open('trace') as file:
                calls = [line.split(None, 1)[1] for line in file if '(' in line and ' = 0' in line]
            at = [i for i, call in enumerate(calls) if 'rename' in call and '"%s")' % name in call]
            self.assertEqual(len(at), 1, (name, calls))
            temporary = calls[at[0]].split('"')[1]
            self.assertRegex(calls[at[0] - 1], r'^fsync\(\d+<.*/%s>' % temporary.replace('.', r'\.'))
            self.assertRegex(calls[at[0] + 1], r'^fsync\(\d+<%s>' % os.path.realpath('.'))
            self.remove_all()


if __name__ == '__main__':
    unittest.main()
