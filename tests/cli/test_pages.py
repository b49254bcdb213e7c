#!/usr/bin/env python3
"""What the refocus command says of itself: short and whole help, manual pages, completion of bash,
zsh and fish, all of one table of options. Usage: test_pages.py REFOCUS [unittest arguments]"""
import os
import re
import shutil
import subprocess
import unittest

from case import Case, REFOCUS

SCREEN = 24


class Pages(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        text = subprocess.run([REFOCUS, 'help'], capture_output=True, text=True, check=True).stdout
        commands, words = text.split('\n\n')[2:4]
        cls.commands = re.findall(r'(?m)^  (\w+) +\S', commands)
        cls.words = re.findall(r'(?m)^  (\w+) +\S', words)

    def options(self, command):
        return re.findall(r'(?m)^  (?:-\w, )?(--[\w-]+)', self.succeeds(command, '--help-all'))

    def test_help_fits_a_screen(self):
        self.assertEqual(len(self.commands), 11)
        self.assertEqual(self.words, ['help', 'version', 'man', 'completion'])
        for name in self.commands:
            text = self.succeeds(name, '--help')
            for again in (name, '-h'), (name, '--help', '--nonsense'), ('help', name):
                self.assertEqual(self.succeeds(*again), text)
            lines = text.splitlines()
            self.assertLessEqual(len(lines), SCREEN, name)
            self.assertLessEqual(max(map(len, lines)), 80)
            self.assertIn('refocus %s --help-all' % name, lines[-1])
            shown = re.findall(r'(?m)^  (?:-\w, )?(--[\w-]+)', text)
            self.assertGreater(len(shown), 0)
            self.assertEqual(set(shown) - set(self.options(name)), set())
        self.assertEqual(self.succeeds('--help'), self.succeeds('help'))
        self.fails(2, "help: 'rendr' is no subcommand; did you mean 'render'?", 'help', 'rendr')
        self.fails(2, "man: 'zzz' is no subcommand; 'refocus --help' lists them", 'man', 'zzz')
        self.fails(2, "verson: unknown subcommand; did you mean 'version'?", 'verson')

    def test_manual_has_every_option(self):
        for name in self.commands:
            page = self.succeeds('man', name)
            self.assertRegex(page, r'^\.TH REFOCUS-%s 1 ' % name.upper())
            listed = re.findall(r'(?m)^(?:\\fB\\-\w\\fR, )?\\fB((?:\\-|[\w])+)\\fR', page)
            listed = [word.replace('\\-', '-') for word in listed]
            self.assertEqual(set(self.options(name)) - set(listed), set(), name)
            for line in page.splitlines():  # requests are those of man(7) that are meant
                self.assertRegex(line, r"^(\.(TH|SH|SS|TP|PP|RS|RE)\b|[^.'])")
        whole = self.succeeds('man')
        for name in self.commands:
            self.assertIn('\\fBrefocus\\-%s\\fR(1)' % name, whole)

    def test_manual_is_well_formed(self):
        names = []
        for name in [None] + self.commands:
            names.append('%s.1' % name)
            with open(names[-1], 'w', encoding='utf-8') as file:
                file.write(self.succeeds('man', *([name] if name else [])))
        for line in (['mandoc', '-Tlint', '-W', 'warning'],
                     ['man', '--warnings', '-E', 'UTF-8', '-P', 'cat', '-l']):
            if shutil.which(line[0]):
                found = subprocess.run(line + names, capture_output=True, text=True)
                said = found.stdout if line[0] == 'mandoc' else found.stderr
                self.assertEqual([x for x in said.splitlines() if 'missing date' not in x], [])
        for name in names:
            os.remove(name)

    def complete_bash(self, *words):
        """What bash offers for the last of the words."""
        script = ('source ./refocus.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _refocus; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return subprocess.run(['bash', '-c', script, 'bash', *words], capture_output=True,
                              text=True, check=True).stdout.split()

    @unittest.skipUnless(shutil.which('bash'), 'there is no bash')
    def test_bash(self):
        with open('refocus.bash', 'w', encoding='utf-8') as file:
            file.write(self.succeeds('completion', 'bash'))
        self.assertEqual(self.complete_bash('refocus', ''), self.commands + self.words)
        self.assertEqual(self.complete_bash('refocus', 're'), ['render'])
        for name in self.commands:
            self.assertEqual(set(self.complete_bash('refocus', name, '-')), set(self.options(name)))
        self.assertEqual(self.complete_bash('refocus', 'render', 'x', '--focus-d'),
                         ['--focus-distance'])
        for words in ('--method', 's'), ('--method', '=', 's'):  # bash cuts --method=s so
            self.assertEqual(self.complete_bash('refocus', 'render', *words),
                             ['sweep', 'search', 'scatter'])
        self.assertIn('diffusion', self.complete_bash('refocus', 'render', '--method', '='))
        self.assertEqual(self.complete_bash('refocus', 'render', '--highlights', ''),
                         ['off', 'auto'])
        self.assertEqual(self.complete_bash('refocus', 'render', '--depth', ''), [])  # files
        self.assertEqual(self.complete_bash('refocus', 'help', 'p'), ['pull'])
        self.assertEqual(self.complete_bash('refocus', 'completion', ''), ['bash', 'zsh', 'fish'])
        self.assertEqual(subprocess.run(
            ['bash', '-c', 'source ./refocus.bash; complete -p refocus'], capture_output=True,
            text=True, check=True).stdout.split()[-3:], ['-F', '_refocus', 'refocus'])
        os.remove('refocus.bash')

    @unittest.skipUnless(shutil.which('fish'), 'there is no fish')
    def test_fish(self):
        with open('refocus.fish', 'w', encoding='utf-8') as file:
            text = self.succeeds('completion', 'fish')
            file.write(text)
        # An option says what it does, not only the methods that it is for.
        self.assertRegex(text, r"-l highlights .* -d 'sweep, search: light given back")
        self.assertNotRegex(text, r"-d '(sweep|search|diffusion|scatter)'")
        lines = ['refocus ' + name + ' --' for name in self.commands]
        lines += ['refocus ', 'refocus render --method s', 'refocus help p']
        said = subprocess.run(['fish', '--no-config', '-c', 'source refocus.fish; ' + '; '.join(
            'complete -C "%s"; echo ::' % line for line in lines)], capture_output=True, text=True,
            check=True, env=dict(os.environ, HOME=self.folder)).stdout.split('::\n')
        offered = [re.findall(r'(?m)^([\w-]+)', text) for text in said]
        for name, words in zip(self.commands, offered):
            self.assertEqual(set(words), set(self.options(name)), name)
        first, *others = offered[len(self.commands):-1]
        self.assertEqual(sorted(first), sorted(self.commands + self.words))
        self.assertEqual(others, [['scatter', 'search', 'sweep'], ['pull']])
        for name in os.listdir('.'):  # fish makes folders of its own in HOME
            if name.startswith('.'):
                shutil.rmtree(name)
        os.remove('refocus.fish')

    def test_zsh(self):
        text = self.succeeds('completion', 'zsh')
        self.assertTrue(text.startswith('#compdef refocus\n'))
        for name in self.commands:
            part = re.search(r'(?ms)^    %s\)\n        _arguments (.*?) ;;$' % name, text).group(1)
            self.assertEqual(set(re.findall(r"^ +'(?:\(.*?\)'\{-.*?,)?(--[\w-]+)", part, re.M)),
                             set(self.options(name)), name)
        self.assertRegex(text, r"'--method=\[[^]]*\]:NAME:\(sweep search .*\)'")
        if shutil.which('zsh'):
            with open('_refocus', 'w', encoding='utf-8') as file:
                file.write(text)
            subprocess.run(['zsh', '-n', '_refocus'], check=True)
            os.remove('_refocus')

    def test_unknown_shell(self):
        for arguments in ((), ('tcsh',), ('bash', 'zsh')):
            self.fails(2, 'completion: give the shell: bash, zsh or fish', 'completion', *arguments)

    def test_lost_output(self):
        """A full disk is no success, in a package's build least of all."""
        for arguments in (('man', 'render'), ('completion', 'bash'), ('help',)):
            with open('/dev/full', 'w') as full:
                self.assertEqual(subprocess.run([REFOCUS, *arguments], stdout=full,
                                                stderr=subprocess.PIPE).returncode, 1)


if __name__ == '__main__':
    unittest.main()
