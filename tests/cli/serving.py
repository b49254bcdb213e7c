"""A server of `refocus serve` for tests, what it answers, and photos that it has."""
import atexit
import http.client
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import time
from urllib.parse import quote, urlsplit

import pictures
from case import Case, REFOCUS

HEADERS = {
    'Content-Security-Policy':
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    'X-Content-Type-Options': 'nosniff', 'Referrer-Policy': 'no-referrer',
    'Cache-Control': 'no-store'}
WIDTH, HEIGHT = 160, 120


class Answer:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    @property
    def json(self):
        return json.loads(self.body)


class Server:
    """A server and the requests that a page would send."""
    def __init__(self, *arguments, command=('serve', '--port', '0'), **environment):
        self.process = subprocess.Popen([REFOCUS, *command, *arguments], text=True,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, env={**os.environ, **environment})
        atexit.register(self.process.kill)  # where a test has failed
        self.link = self.process.stdout.readline().strip()
        parts = urlsplit(self.link)
        self.port, self.path, self.host = parts.port, parts.path, parts.netloc

    def connect(self):
        return http.client.HTTPConnection('127.0.0.1', self.port, timeout=300)

    def ask(self, method, name, body=None, path=None, **headers):
        connection = self.connect()
        if body is not None and not isinstance(body, bytes):
            body = json.dumps(body).encode()
        headers = {key.replace('_', '-'): value for key, value in headers.items()}
        connection.request(method, (path or self.path) + name, body, headers)
        answer = connection.getresponse()
        result = Answer(answer.status, answer.headers, answer.read())
        connection.close()
        return result

    def get(self, name, **headers):
        return self.ask('GET', name, **headers)

    def post(self, name, body=None, **headers):
        return self.ask('POST', name, body if body is not None else b'', **headers)

    def open(self, photo):
        return self.post('open?photo=' + quote(photo)).json

    def picture(self, session, request, settings, size=0, more=''):
        return self.post('picture?session=%s&size=%d&request=%d%s' %
                         (session['session'], size, request, more), settings)

    def raw(self, data):
        """Send bytes as they are; the first bytes of the answer, b'' where there is none."""
        with socket.create_connection(('127.0.0.1', self.port), timeout=120) as line:
            try:
                line.sendall(data)
                return line.recv(65536)
            except ConnectionError:
                return b''

    def children(self):
        """Processes of open photos."""
        path = '/proc/%d/task/%d/children' % (self.process.pid, self.process.pid)
        return [int(pid) for pid in pictures.read_bytes(path).split()]

    def files(self):
        return len(os.listdir('/proc/%d/fd' % self.process.pid))

    def close(self):
        children = self.children()
        self.process.send_signal(signal.SIGTERM)
        status = self.process.wait(120)
        words = self.process.stderr.read()
        self.process.stdout.close()
        self.process.stderr.close()
        return status, words, [pid for pid in children if os.path.exists('/proc/%d' % pid)]


def until(test):
    """Wait until something holds, for as long as a slow machine may take."""
    for _ in range(6000):
        try:
            if test():
                return True
        except (ConnectionError, http.client.HTTPException):
            pass
        time.sleep(0.02)
    return False


def state(folder):
    return {name: (os.lstat(os.path.join(folder, name)).st_mtime_ns,
                   os.lstat(os.path.join(folder, name)).st_size) for name in os.listdir(folder)}


class Serving(Case):
    """A folder with a photo that has depth, one that has none, and what is not for others."""
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        noise = random.Random(3)
        codes = [noise.randrange(256) for _ in range(40 * 30)]
        pictures.ppm('noise.ppm', WIDTH, HEIGHT,
                     lambda x, y: (codes[y // 4 * 40 + x // 4], (3 * x) & 255, (2 * y) & 255))
        pictures.pgm('map.pgm', WIDTH // 2, HEIGHT // 2,
                     lambda x, y: 220 if 20 < x < 50 and y > 14 else 40 + y // 2)
        os.mkdir('photos')
        for arguments in (('render', 'noise.ppm', '--depth', 'map.pgm', '--blur', '0', '-o',
                           'photos/none.jpg', '--no-editable'),
                          ('depth', 'photos/none.jpg', '--depth', 'map.pgm', '-o', 'photos/deep é.jpg',
                           '--near', '1', '--far', '8')):
            subprocess.run([REFOCUS, *arguments], check=True, stdout=subprocess.DEVNULL)
        shutil.copy('noise.ppm', 'photos/plain.ppm')
        shutil.copy('noise.ppm', 'secret.ppm')
        with open('photos/damaged.jpg', 'wb') as file:
            file.write(pictures.read_bytes('photos/none.jpg')[:300] + bytes(200))
        os.symlink('../secret.ppm', 'photos/link.ppm')
        os.symlink('/etc/hostname', 'photos/host.jpg')
        os.mkfifo('photos/pipe.jpg')
        os.mkdir('photos/folder.jpg')
        for name in 'notes.txt', '.hidden.jpg':
            with open('photos/' + name, 'w') as file:
                file.write('private')
        cls.before = state('photos')
        cls.server = Server('photos')

    @classmethod
    def tearDownClass(cls):
        status = cls.server.close()
        left = state('photos') == cls.before
        super().tearDownClass()
        if status != (0, '', []) or not left:
            raise AssertionError('the server ended with %s, its folder %s' % (status, left))

    def opened(self, photo='deep é.jpg'):
        """A session; the first settings are "first", in pixels of blur "settings"."""
        session = self.server.open(photo)
        self.addCleanup(self.server.post, 'close?session=' + session['session'])
        session['first'] = dict(session['settings'])
        if session['settings'].pop('f-number', None):
            session['settings']['blur'] = 6
        return session

    def refused(self, status, words, answer):
        self.assertEqual(answer.status, status, answer.body[:300])
        self.assertEqual(set(answer.json), {'error'})
        self.assertRegex(answer.json['error'], words)

    def rendered(self, settings, *options, photo='photos/deep é.jpg', ending='jpg'):
        """The file that the command makes of a photo with settings."""
        with open('settings.json', 'w') as file:
            json.dump(dict(settings, refocus=1), file)
        subprocess.run([REFOCUS, 'render', photo, '--settings', 'settings.json', '-o',
                        'rendered.' + ending, *options], check=True, stderr=subprocess.DEVNULL)
        return pictures.read_bytes('rendered.' + ending)
