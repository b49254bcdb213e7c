#!/usr/bin/env python3
"""usage: session.py PROGRAM...  -- in a PipeWire session of our own, without a display, sound or cameras."""
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time

NEEDED = 'pipewire', 'wireplumber', 'dbus-run-session', 'pw-dump'


def enter():
    """Run the program again on a bus of its own, with a private XDG_RUNTIME_DIR."""
    missing = [program for program in NEEDED if not shutil.which(program)]
    if missing:
        print('SKIPPED: there is no %s' % ', '.join(missing))
        sys.exit(77)
    if 'RF_PIPEWIRE' in os.environ:
        return
    with tempfile.TemporaryDirectory(prefix='refocus-pipewire-') as folder:
        env = {**os.environ, 'RF_PIPEWIRE': folder, 'XDG_RUNTIME_DIR': folder,
               'XDG_CONFIG_HOME': folder, 'XDG_STATE_HOME': folder, 'PIPEWIRE_REMOTE': 'pipewire-0'}
        sys.exit(subprocess.call(['dbus-run-session', '--', sys.executable, *sys.argv], env=env))


class Session:
    """The daemon and the session manager."""
    def __init__(self, slow=1):
        self.slow = slow
        self.processes = []
        try:
            self.begin()
        except AssertionError:
            self.close()
            raise

    def begin(self):
        quiet = {'stdout': subprocess.DEVNULL, 'stderr': subprocess.DEVNULL}
        self.daemon = subprocess.Popen(['pipewire'], **quiet)
        self.processes.append(self.daemon)
        self.wait(self.listens, 'PipeWire')
        self.processes.append(subprocess.Popen(['wireplumber'], **quiet))
        self.wait(lambda: any(o['type'] == 'PipeWire:Interface:Client' and
                              o['info']['props'].get('application.name') == 'WirePlumber [export]'
                              for o in self.objects()), 'WirePlumber')

    def close(self):
        for process in reversed(self.processes):
            process.kill()
            process.wait()

    def wait(self, condition, what, seconds=40):
        end = time.monotonic() + seconds * self.slow
        while not condition():
            if time.monotonic() > end:
                raise AssertionError('%s did not come' % what)
            time.sleep(0.03)

    @staticmethod
    def listens():
        with socket.socket(socket.AF_UNIX) as client:
            return client.connect_ex(os.path.join(os.environ['XDG_RUNTIME_DIR'], 'pipewire-0')) == 0

    @staticmethod
    def objects():
        done = subprocess.run(['pw-dump'], capture_output=True, check=False)
        try:
            return json.loads(done.stdout)
        except ValueError:
            return []

    @staticmethod
    def nodes_of(objects):
        """Properties of the nodes by their names."""
        return {o['info']['props'].get('node.name'): {'id': o['id'], 'state': o['info']['state'],
                                                      **o['info']['props']}
                for o in objects if o['type'] == 'PipeWire:Interface:Node'}

    def nodes(self):
        return self.nodes_of(self.objects())

    def wait_node(self, name, state=None):
        """Properties of a node that is there and in this state; both are read from one listing."""
        found = {}

        def seen():
            found.update(self.nodes().get(name, {}))
            return bool(found) and state in (None, found['state'])

        self.wait(seen, 'the node ' + name)
        return found

    def wait_end(self, name):
        """An empty listing says nothing: pw-dump has not reached PipeWire."""
        def ended():
            objects = self.objects()
            return bool(objects) and name not in self.nodes_of(objects)

        self.wait(ended, 'the end of the node ' + name)


if __name__ == '__main__':
    enter()
    session = Session(float(os.environ.get('REFOCUS_SLOW', '1')))
    status = subprocess.call(sys.argv[1:])
    session.close()
    sys.exit(status)
