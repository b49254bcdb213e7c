"""Programs in place of meson, ninja, apt-get and the like, that write down what they are asked."""
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../..')

PROGRAMS = {
    # apt-get is found; nothing is installed but what is listed
    'dpkg-query': 'case " $STUB_INSTALLED " in *" ${!#} "*) echo installed ;; *) exit 1 ;; esac',
    'apt-get': ':',
    'id': 'echo 0',
    'date': 'echo 00:00',
    # `setup` makes a folder, `test` leaves results, `introspect` knows the last options
    'meson': r'''
for folder; do case $folder in -*) ;; *) [ "$folder" = setup ] || break ;; esac; done
case $1 in
    setup)
        case " $* " in *" $STUB_SETUP_FAILS "*) echo 'no such library'; exit 1 ;; esac
        mkdir -p "$folder"
        touch "$folder/build.ninja"
        for option; do case $option in -D*) echo "${option#-D}" >>"$folder/options" ;; esac; done
        ;;
    introspect)
        for folder; do :; done
        sed 's/\(.*\)=\(.*\)/{"name": "\1", "value": "\2"},/' "$folder/options" |
            sed '1s/^/[/; $s/,$/]/'
        ;;
    test)
        mkdir -p "$3/meson-logs"
        echo "$STUB_RESULTS" >"$3/meson-logs/testlog.json"
        # As Ctrl-C does, which meson takes for the end of its tests.
        [ -z "$STUB_INTERRUPT" ] || { trap : INT; kill -INT 0; }
        ;;
esac''',
    # makes the programs that a script goes on with
    'ninja': r'''
folder=
for argument; do
    [ "$before" != -C ] || folder=$argument
    before=$argument
done
for target in platform/cli/refocus examples/refocus_ppm; do
    mkdir -p "$folder/${target%/*}"
    printf '#!/bin/sh\necho "$0 $*" >>"$STUB_LOG"\n' >"$folder/$target"
    chmod +x "$folder/$target"
done''',
}


class Case(unittest.TestCase):
    """Runs a script of the project with these programs alone, beside those of the shell."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix='refocus-scripts-')
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.bin = os.path.join(self.folder, 'bin')
        self.log = os.path.join(self.folder, 'log')
        os.mkdir(self.bin)
        for name, body in PROGRAMS.items():
            path = os.path.join(self.bin, name)
            with open(path, 'w', encoding='utf-8') as file:
                file.write('#!/bin/bash\necho "%s $*" >>"$STUB_LOG"\n%s\n' % (name, body))
            os.chmod(path, 0o755)
        os.symlink(sys.executable, os.path.join(self.bin, 'python3'))
        for name in ('bash sh env mkdir dirname touch chmod sed grep tail head sort cat rm cmp '
                     'diff').split():
            for folder in os.environ['PATH'].split(':'):
                if os.access(os.path.join(folder, name), os.X_OK):
                    os.symlink(os.path.join(folder, name), os.path.join(self.bin, name))
                    break

    def run_script(self, script, *arguments, installed='', **more):
        """(exit status, standard output, the lines of what was asked of the programs)"""
        open(self.log, 'w', encoding='utf-8').close()
        environment = {'PATH': self.bin, 'HOME': self.folder, 'TMPDIR': self.folder,
                       'STUB_LOG': self.log,
                       'STUB_INSTALLED': installed, 'STUB_SETUP_FAILS': 'never', **more}
        result = subprocess.run([os.path.join(ROOT, script), *arguments], env=environment,
                                cwd=self.folder, stdin=subprocess.DEVNULL, text=True, timeout=240,
                                start_new_session=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)
        with open(self.log, encoding='utf-8') as file:
            return result.returncode, result.stdout, file.read().splitlines()
