#!/usr/bin/env python3
"""The command `refocus serve`, over HTTP: what it answers, what it refuses, and that nobody's
request is felt by others. Usage: test_serve.py REFOCUS [unittest arguments]"""
import atexit
import concurrent.futures
import http.client
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import time
import unittest
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
    def __init__(self, *arguments):
        self.process = subprocess.Popen([REFOCUS, 'serve', *arguments, '--port', '0'], text=True,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE)
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


class Answers(Serving):
    def test_page(self):
        answer = self.server.get('')
        self.assertEqual(answer.status, 200)
        self.assertEqual(answer.headers['Content-Type'], 'text/html; charset=utf-8')
        self.assertIn(b'<!DOCTYPE html>', answer.body)

    def test_photos(self):
        listed = self.server.get('photos').json
        self.assertEqual([photo['name'] for photo in listed['photos']],
                         ['damaged.jpg', 'deep é.jpg', 'none.jpg', 'plain.ppm'])
        self.assertEqual((listed['folder'], listed['open'], listed['upload_limit']),
                         (True, None, 100 << 20))

    def test_thumbnails(self):
        for name, depth in ('deep é.jpg', 'yes'), ('none.jpg', 'no'):
            answer = self.server.get('thumbnail?photo=' + quote(name))
            self.assertEqual(answer.headers['Content-Type'], 'image/jpeg')
            self.assertEqual(answer.headers['Refocus-Depth'], depth)
            self.assertEqual(answer.body[:2], b'\xff\xd8')
        known = {photo['name']: photo['depth'] for photo in self.server.get('photos').json['photos']}
        self.assertEqual((known['deep é.jpg'], known['none.jpg']), (True, False))
        self.refused(422, 'damaged.jpg: ', self.server.get('thumbnail?photo=damaged.jpg'))
        self.assertTrue(until(lambda: not self.server.children()))

    def test_session(self):
        session = self.opened()
        self.assertEqual((session['width'], session['height'], session['depth']),
                         (WIDTH, HEIGHT, True))
        self.assertEqual(session['limits'], {'blur': 127, 'f_number': [1, 22],
                                             'highlights': [1, 16]})
        least, most = session['range']
        self.assertTrue(0 <= least < most <= 1)
        self.assertTrue(0 <= session['settings']['focus'] <= 1)
        self.assertIn('swirl', [look['name'] for look in session['presets']])
        self.assertFalse(self.opened('none.jpg')['depth'])

    def test_pictures_are_those_of_render(self):
        session = self.opened()
        base = session['settings']
        for request, more in enumerate((
                {}, {'focus': 0.9, 'blur': 12.5}, {'blur': 127}, {'bokeh': 'swirl', 'blur': 9},
                {'aperture': 'polygon:6:15', 'highlights': 4, 'blur': 8}, {'method': 'search'},
                {'tilt-angle': 30, 'tilt-line': [10, 20, 100, 60], 'focus-width': 0.1},
                {'quality': 'best', 'fill': 'textured'}, {'quality': 'preview'}), 1):
            settings = dict(base, **more)
            with self.subTest(more):
                answer = self.server.picture(session, request, settings)
                self.assertEqual(answer.status, 200, answer.body)
                self.assertEqual(answer.headers['Content-Type'], 'image/jpeg')
                self.assertTrue(answer.body == self.rendered(settings, '--strip'))
        answer = self.server.picture(session, 99, base, 100)
        self.assertTrue(answer.body == self.rendered(base, '--strip', '--resize', '100x100'))

    def test_f_number_in_place_of_blur(self):
        session = self.opened()
        self.assertNotIn('blur', session['first'])
        self.assertTrue(1 <= session['first']['f-number'] <= 22, session['first'])
        for request, settings in enumerate(({'focus': 0.5, 'f-number': 2},
                                             session['first']), 1):
            self.assertTrue(self.server.picture(session, request, settings).body ==
                            self.rendered(settings, '--strip'))
        self.assertNotIn('f-number', self.opened('none.jpg')['first'])

    def test_quick_pictures(self):
        session = self.opened()
        full = self.server.picture(session, 1, session['settings'], more='&quick=1').body
        small = self.server.picture(session, 2, session['settings'], 64, '&quick=1').body
        self.assertEqual((full[:2], small[:2]), (b'\xff\xd8', b'\xff\xd8'))
        self.assertLess(len(small), len(full))
        wide = self.server.picture(session, 3, dict(session['settings'], blur=60), 64, '&quick=1')
        self.assertNotEqual(wide.body, small)

    def test_focus(self):
        session = self.opened()
        ask = 'focus?session=' + session['session']
        near = self.server.post(ask, {'x': 0.5, 'y': 0.7}).json['focus']
        far = self.server.post(ask, {'x': 0.05, 'y': 0.1}).json['focus']
        self.assertGreater(near, far + 0.3)
        for body in {}, {'x': 2, 'y': 0}, {'x': 'a', 'y': 0}, [], b'', b'{', {'x': -1, 'y': 0}:
            self.refused(400, 'focus: give', self.server.post(ask, body))

    def test_overlays(self):
        session = self.opened()
        ask = 'overlay?session=%s&size=0&kind=' % session['session']
        pictures_ = [self.server.post(ask + kind, session['settings']).body
                     for kind in ('depth', 'blur', 'peaking')]
        self.assertEqual(len(set(pictures_)), 3)
        self.assertEqual({body[:2] for body in pictures_}, {b'\xff\xd8'})
        self.refused(400, 'kind: give', self.server.post(ask + 'other', {}))

    def test_saved_files_are_those_of_render(self):
        session = self.opened()
        settings = dict(session['settings'], focus=0.8, blur=11)
        ask = 'save?session=%s&as=' % session['session']
        jpeg = self.server.post(ask + 'jpeg', settings)
        self.assertTrue(jpeg.body == self.rendered(settings, '--editable'))
        self.assertEqual(jpeg.headers['Content-Disposition'],
                         "attachment; filename*=UTF-8''deep%20%C3%A9-refocused.jpg")
        self.assertTrue(self.server.post(ask + 'png', settings).body ==
                        self.rendered(settings, ending='png'))
        saved = self.server.post(ask + 'settings', settings)
        self.assertEqual({key: saved.json[key] for key in settings}, settings)
        self.assertTrue(self.server.picture(session, 1, saved.json).body ==
                        self.rendered(settings, '--strip'))
        subprocess.run([REFOCUS, 'depth', 'photos/deep é.jpg', '--full', '-o', 'full.png'],
                       check=True, stdout=subprocess.DEVNULL)
        self.assertTrue(self.server.post(ask + 'depth', settings).body ==
                        pictures.read_bytes('full.png'))
        self.refused(400, 'as: give', self.server.post(ask + 'exe', settings))

    def test_strokes(self):
        session = self.opened('none.jpg')
        ask = lambda name, body=None: self.server.post('%s?session=%s' % (name, session['session']),
                                                       body)
        ground = {'kind': 'all', 'gradient': [[80, 119, 0.9], [80, 10, 0.1]]}
        brush = {'kind': 'brush', 'radius': 12, 'points': [[40, 40], [60, 50]], 'disparity': 0.95}
        settings = {'focus': 0.95, 'blur': 9}
        before = self.server.picture(session, 1, settings).body
        self.assertEqual(ask('stroke', ground).json, {'strokes': 1, 'undone': 0})
        self.assertEqual(ask('stroke', brush).json, {'strokes': 2, 'undone': 0})
        painted = self.server.picture(session, 2, settings).body
        self.assertNotEqual(painted, before)
        file = self.server.get('strokes?session=' + session['session']).json
        self.assertEqual([stroke['kind'] for stroke in file['strokes']], ['all', 'brush'])
        with open('strokes.json', 'w') as out:
            json.dump(file, out)
        subprocess.run([REFOCUS, 'depth', 'photos/none.jpg', '--strokes', 'strokes.json', '-o',
                        'painted.png'], check=True, stdout=subprocess.DEVNULL)
        self.assertTrue(painted == self.rendered(settings, '--strip', '--depth', 'painted.png',
                                                 '--depth-edges', 'as-given',
                                                 photo='photos/none.jpg'))
        self.assertEqual(ask('undo').json, {'strokes': 1, 'undone': 1})
        self.assertEqual(ask('undo').json, {'strokes': 0, 'undone': 2})
        self.refused(409, 'none to undo', ask('undo'))
        self.assertTrue(self.server.picture(session, 3, settings).body == before)
        self.assertEqual(ask('redo').json, {'strokes': 1, 'undone': 1})
        self.assertEqual(ask('redo').json, {'strokes': 2, 'undone': 0})
        self.refused(409, 'none to do again', ask('redo'))
        self.assertTrue(self.server.picture(session, 4, settings).body == painted)
        ask('undo')
        self.assertEqual(ask('stroke', brush).json, {'strokes': 2, 'undone': 0})
        for wrong in ({'kind': 'other'}, {'kind': 'all', 'disparity': 2}, [], 3, b'', b'{"kind"',
                      {'kind': 'brush', 'radius': 5, 'points': []},
                      {'kind': 'brush', 'radius': 5, 'points': [[1e9, 0]], 'disparity': 0.5}):
            self.refused(400, 'stroke: ', ask('stroke', wrong))
        saved = self.server.post('save?as=jpeg&session=' + session['session'], settings)
        with open('saved.jpg', 'wb') as out:
            out.write(saved.body)
        report = json.loads(self.succeeds('info', 'saved.jpg', '--json'))
        self.assertEqual(report['depth']['source'], 'gdepth')

    def test_pull(self):
        session = self.opened()
        ask = 'pull?session=%s&size=0&as=' % session['session']
        keys = [{'time': 0, 'focus': 1}, {'time': 0.2, 'focus': 0, 'blur': 30, 'ease': 'in'}]
        film = self.server.post(ask + 'apng', {'keys': keys, 'blur': 12})
        self.assertEqual((film.status, film.headers['Content-Type']), (200, 'image/apng'))
        self.assertIn('-pull.apng', film.headers['Content-Disposition'])
        self.assertEqual(film.body[:8], b'\x89PNG\r\n\x1a\n')
        at = film.body.index(b'acTL') + 4
        self.assertEqual(int.from_bytes(film.body[at:at + 4], 'big'), 6)  # 0.2 s of 25 a second
        small = self.server.post(ask.replace('size=0', 'size=40') + 'apng', {'keys': keys})
        self.assertLess(len(small.body), len(film.body) / 2)
        self.assertIn('apng', session['films'])
        for name in session['films'][1:]:
            answer = self.server.post(ask + name, {'keys': keys})
            self.assertEqual(answer.status, 200, answer.body[:300])
        for body, words in (({}, 'give keys'), ([], 'no JSON object'), (b'{', 'no JSON object'),
                            ({'keys': []}, 'pull'), ({'keys': 3}, 'pull'),
                            ({'keys': [{'time': 0, 'focus': 1}, {'time': 21, 'focus': 0}]}, '20 sec'),
                            ({'keys': [{'time': 0, 'blur': 300}, keys[1]]}, '127'),
                            ({'keys': [{'time': 0, 'focus': 3}, keys[1]]}, 'focus'),
                            ({'keys': [{'time': 0, 'output': 3}, keys[1]]}, 'output'),
                            ({'keys': keys, 'aperture': '/etc/hostname'}, 'give disc')):
            self.refused(400, words, self.server.post(ask + 'apng', body))
        self.refused(400, 'as: give', self.server.post(ask + 'exe', {'keys': keys}))

    def test_upload(self):
        body = pictures.read_bytes('photos/deep é.jpg')
        answer = self.server.post('upload?name=' + quote('mine ü.jpg'), body)
        session = answer.json
        self.addCleanup(self.server.post, 'close?session=' + session['session'])
        self.assertEqual((session['name'], session['depth']), ('mine ü.jpg', True))
        self.assertTrue(self.server.picture(session, 1, session['settings']).body ==
                        self.rendered(session['settings'], '--strip'))
        self.assertNotIn('mine', self.server.get('photos').body.decode())

    def test_close(self):
        session = self.server.open('none.jpg')
        self.assertEqual(self.server.post('close?session=' + session['session']).json,
                         {'closed': True})
        self.refused(410, 'has ended', self.server.picture(session, 1, {}))
        self.refused(410, 'has ended', self.server.post('close?session=' + session['session']))


class Refusals(Serving):
    def test_every_answer_is_strict(self):
        for answer in (self.server.get(''), self.server.get('photos'), self.server.get('nothing'),
                       self.server.get('thumbnail?photo=none.jpg'), self.server.get('photos', path='/'),
                       self.server.ask('PUT', 'photos', b'x'), self.server.post('open?photo=x.jpg'),
                       self.server.post('photos', Origin='http://elsewhere')):
            for name, value in HEADERS.items():
                self.assertEqual(answer.headers[name], value, answer.status)

    def test_token(self):
        token = self.server.path[1:-1]
        other = ('1' if token[0] == '0' else '0') + token[1:]
        for path in '/', '/photos', '//', '/%s/' % other, '/%s' % token, '/%s/' % token.upper(), \
                '/%s/' % token[:-1], '/%s0/' % token:
            if path == self.server.path:
                continue
            for name in '', 'photos':
                answer = self.server.get(name, path=path)
                self.assertEqual((answer.status, answer.body), (404, b''), path)

    def test_host(self):
        port = self.server.port
        for host in 'elsewhere:%d' % port, '127.0.0.1', '127.0.0.1:%d' % (port ^ 1), 'localhost', \
                '127.0.0.1.elsewhere:%d' % port, '127.0.0.1:0%d0' % port, '[::1:%d' % port, ':', '', \
                'a' * 200, '127.0.0.1:%d@elsewhere' % port:
            answer = self.server.raw(('GET %sphotos HTTP/1.1\r\nHost: %s\r\n\r\n' %
                                      (self.server.path, host)).encode())
            self.assertRegex(answer, rb'^HTTP/1.1 4(04|00) ', host)
            self.assertNotIn(b'jpg', answer)
        for host in 'localhost:%d' % port, '[::1]:%d' % port, '192.168.7.9:%d' % port:
            self.assertEqual(self.server.get('photos', Host=host).status, 200, host)
        answer = self.server.raw(b'GET %sphotos HTTP/1.0\r\n\r\n' % self.server.path.encode())
        self.assertNotIn(b'jpg', answer)

    def test_origin(self):
        own = 'http://' + self.server.host
        self.assertEqual(self.server.post('open?photo=nothing.jpg', Origin=own).status, 404)
        for origin in 'http://elsewhere', 'null', own + '/', own + '.elsewhere', \
                own.replace('http', 'https'), 'http://localhost:%d' % self.server.port, '':
            answer = self.server.post('open?photo=none.jpg', Origin=origin)
            self.assertEqual((answer.status, answer.body), (403, b''), origin)
        for site in 'cross-site', 'same-site':
            self.assertEqual(self.server.get('photos', Sec_Fetch_Site=site).status, 403)
            self.assertEqual(self.server.get('', Sec_Fetch_Site=site).status, 200)
        self.assertEqual(self.server.get('photos', Sec_Fetch_Site='same-origin').status, 200)
        self.assertFalse(self.server.children())

    def test_methods(self):
        for method in 'PUT', 'DELETE', 'HEAD', 'OPTIONS', 'PATCH', 'TRACE', 'X':
            self.assertEqual(self.server.ask(method, 'photos').status, 405, method)
            self.assertEqual(self.server.ask(method, '').status, 405, method)
        self.assertEqual(self.server.get('open?photo=none.jpg').status, 405)
        self.assertEqual(self.server.post('photos').status, 405)
        self.assertEqual(self.server.post('').status, 405)

    def test_names_outside(self):
        folder = os.path.basename(os.getcwd())
        for name in ('../secret.ppm', '..%2fsecret.ppm', '..\\secret.ppm', '/etc/hostname',
                     os.path.abspath('secret.ppm'), './none.jpg', 'folder.jpg/../none.jpg', '..', '.',
                     '', 'none.jpg\0', '\0', '../%s/photos/none.jpg' % folder, 'link.ppm', 'host.jpg',
                     'pipe.jpg', 'folder.jpg', '.hidden.jpg', 'notes.txt', 'nothing.jpg', 'x' * 5000,
                     'a\nb.jpg', '\x7f.jpg', '%ff.jpg'):
            for ask in 'open', 'thumbnail':
                method = 'POST' if ask == 'open' else 'GET'
                answer = self.server.ask(method, '%s?photo=%s' % (ask, quote(name, safe='%')))
                self.assertEqual(answer.status, 404, (ask, name, answer.body))
        self.assertEqual(self.server.post('open').status, 404)
        self.assertFalse(self.server.children())

    def test_names_of_uploads(self):
        for name in '../x.jpg', '/x.jpg', '', '.x.jpg', 'a/b.jpg', 'a%00.jpg', '%ff.jpg', 'x' * 300:
            self.refused(400, 'name: ', self.server.post('upload?name=' + name, b'photo'))

    def test_damaged_uploads(self):
        good = pictures.read_bytes('photos/deep é.jpg')
        noise = random.Random(4)
        self.refused(400, 'no photo', self.server.post('upload?name=x.jpg', b''))
        for body in (b'x', bytes(1000), b'\xff\xd8\xff', good[:200], good[:len(good) // 2],
                     b'P6\n99999999 99999999\n255\n', b'\x89PNG\r\n\x1a\n' + bytes(50),
                     bytes(noise.randrange(256) for _ in range(5000))):
            answer = self.server.post('upload?name=x.jpg', body)
            self.refused(422, '^x.jpg: ', answer)
            self.assertNotIn('/proc', answer.json['error'])
        for _ in range(20):
            body = bytearray(good)
            for _ in range(20):
                body[noise.randrange(len(body))] = noise.randrange(256)
            answer = self.server.post('upload?name=x.jpg', bytes(body))
            self.assertIn(answer.status, (200, 422))
            if answer.status == 200:
                self.server.post('close?session=' + answer.json['session'])
        self.assertTrue(until(lambda: not self.server.children()))

    def test_settings(self):
        session = self.opened()
        for settings, words in (
                ({'fokus': 1}, "fokus: unknown setting; did you mean 'focus'"),
                ({'focus': 2}, 'focus: .*from 0 to 1'), ({'focus': None}, 'focus: '),
                ({'blur': 128}, '128 pixels are more than 127'), ({'blur': -1}, 'blur: '),
                ({'blur': 3, 'f-number': 2}, 'given twice'), ({'depth': '/etc/hostname'}, 'unknown'),
                ({'focus-map': 'photos/none.jpg'}, 'names a file'), ({'refocus': 2}, 'no settings'),
                ({'sharp-mask': '/dev/zero'}, 'names a file'),
                ({'aperture': '/etc/hostname'}, 'give disc'), ({'aperture': 5}, 'give disc'),
                ({'aperture': 'starlight.png'}, 'give disc'), ({'aperture': 'polygon:99'}, 'polygon'),
                ({'method': 'diffusion'}, 'too slow'), ({'method': 'x'}, 'method'),
                ({'output': 'x.jpg'}, 'unknown'), ({'threads': 64}, 'unknown'),
                ({'preset': 'x'}, 'unknown'), ([], 'no settings'), (b'', '$'), (b'{', 'not JSON'),
                (b'{"focus": 0.1, "focus": 0.2}', 'not JSON'), (b'[' * 100000, 'not JSON'),
                (b'\xff', 'not JSON')):
            for ask in 'picture?size=0&request=%d&' % next(self.numbers), \
                    'overlay?size=0&kind=blur&', 'save?as=jpeg&':
                with self.subTest(settings=settings if len(str(settings)) < 99 else '', ask=ask):
                    self.check_settings(ask, session, settings, words)

    def check_settings(self, ask, session, settings, words):
        answer = self.server.post('%ssession=%s' % (ask, session['session']), settings)
        if settings == b'':
            self.assertEqual(answer.status, 200)
        else:
            self.refused(400, words, answer)

    numbers = iter(range(1, 1 << 20))

    def test_arguments(self):
        session = self.opened()
        head = 'picture?session=%s' % session['session']
        for more in ('', '&size=0', '&request=1', '&size=-1&request=1', '&size=1x&request=1',
                     '&size=65536&request=1', '&size=0&request=0', '&size=0&request=99999999999',
                     '&size=0&request=1%00', '&size=%20&request=1'):
            self.refused(400, 'size|request', self.server.post(head + more, {}))
        self.assertEqual(self.server.post(head + '&size=9&request=7', {}).status, 200)
        for request in 7, 6, 1:
            self.refused(409, 'newer', self.server.post(head + '&size=9&request=%d' % request, {}))
        for id_ in '', 'x', session['session'][:-1], session['session'] + '0', '0' * 32, \
                session['session'].upper() + '%00':
            self.refused(410, 'ended', self.server.post('focus?session=' + id_, {'x': 0, 'y': 0}))

    def test_too_large(self):
        session = self.opened()
        head = '%sfocus?session=%s HTTP/1.1\r\nHost: %s\r\n' % (self.server.path, session['session'],
                                                                self.server.host)
        for length in (1 << 18) + 1, 1 << 40, 10 ** 30:
            answer = self.server.raw(('POST %sContent-Length: %d\r\n\r\n' % (head, length)).encode())
            self.assertRegex(answer, rb'^HTTP/1.1 (413|400) ', length)
        answer = self.server.post('focus?session=' + session['session'], bytes(1 << 18))
        self.refused(400, 'focus: ', answer)
        chunk = b'8000\r\n' + bytes(1 << 15) + b'\r\n'
        answer = self.server.raw(('POST %sTransfer-Encoding: chunked\r\n\r\n' % head).encode() +
                                 9 * chunk + b'0\r\n\r\n')
        self.assertRegex(answer, rb'^HTTP/1.1 413 ')


class Limits(Serving):
    def test_large_uploads(self):
        server = Server('--max-upload', '1')
        path = '%supload?name=x.ppm HTTP/1.1\r\nHost: %s\r\n' % (server.path, server.host)
        answer = server.raw(('POST %sContent-Length: 1048577\r\n\r\n' % path).encode())
        self.assertRegex(answer, rb'^HTTP/1.1 413 ')
        body = b'P6\n590 590\n255\n' + bytes(590 * 590 * 3)
        self.assertEqual(server.post('upload?name=x.ppm', body).status, 200)
        chunk = b'10000\r\n' + bytes(1 << 16) + b'\r\n'
        answer = server.raw(('POST %sTransfer-Encoding: chunked\r\n\r\n' % path).encode() +
                            17 * chunk + b'0\r\n\r\n')
        self.assertRegex(answer, rb'^HTTP/1.1 413 ')
        self.assertEqual(server.get('photos').json, {'folder': False, 'photos': [], 'open': None,
                                                     'upload_limit': 1 << 20})
        self.assertEqual(server.close(), (0, '', []))

    def test_one_photo(self):
        server = Server('photos/deep é.jpg')
        listed = server.get('photos').json
        self.assertEqual((listed['folder'], listed['open']), (False, 'deep é.jpg'))
        self.assertEqual([photo['name'] for photo in listed['photos']], ['deep é.jpg'])
        self.assertTrue(server.open('deep é.jpg')['depth'])
        self.assertEqual(server.post('open?photo=none.jpg').status, 404)
        self.assertEqual(server.close(), (0, '', []))

    def test_slow_clients(self):
        """They are hung up on, whatever they trickle, and others do not wait for them."""
        open_ = self.opened()
        files = self.server.files()
        head = '%s %s HTTP/1.1\r\nHost: %s\r\n'
        path = self.server.path
        begins = (b'', b'G', (head % ('GET', path, self.server.host)).encode(),
                  (head % ('POST', path + 'focus?session=' + open_['session'], self.server.host) +
                   'Content-Length: 1000\r\n\r\n').encode(),
                  (head % ('POST', path + 'focus?session=' + open_['session'], self.server.host) +
                   'Transfer-Encoding: chunked\r\n\r\n').encode())
        lines = [socket.create_connection(('127.0.0.1', self.server.port)) for _ in begins]
        for line, begin in zip(lines, begins):
            line.sendall(begin)
            line.setblocking(False)
        waiting = set(lines[1:])
        while waiting:  # until the test's own time is over
            self.assertEqual(self.server.get('photos').status, 200)
            time.sleep(0.2)
            for line in list(waiting):
                try:
                    line.send(b'1\r\n1\r\n' if line is lines[4] else b'x')
                    if line.recv(1000) == b'':
                        waiting.remove(line)
                except BlockingIOError:
                    pass
                except ConnectionError:
                    waiting.remove(line)
        lines[0].setblocking(True)
        self.assertEqual(lines[0].recv(1), b'')
        for line in lines:
            line.close()
        self.assertTrue(until(lambda: self.server.files() <= files))

    def test_many_connections(self):
        """One address has a share of the connections, and gives it back."""
        files = self.server.files()
        lines = [socket.create_connection(('127.0.0.1', self.server.port)) for _ in range(200)]
        self.assertTrue(until(lambda: self.server.files() > files + 20))
        self.assertLess(self.server.files(), files + 30)
        for line in lines:
            line.close()
        self.assertTrue(until(lambda: self.server.files() <= files))
        self.assertEqual(self.server.get('photos').status, 200)

    def test_newest_wins(self):
        pictures_ = 'P6\n2400 1800\n255\n'.encode() + os.urandom(2400 * 1800 * 3)
        session = self.server.post('upload?name=large.ppm', pictures_).json
        self.addCleanup(self.server.post, 'close?session=' + session['session'])
        self.server.post('stroke?session=' + session['session'],
                         {'kind': 'all', 'gradient': [[0, 0, 0], [2400, 0, 1]]})
        settings = {'focus': 0.5, 'blur': 40, 'quality': 'best'}
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            asked = []
            for request in range(1, 7):
                asked.append(pool.submit(self.server.picture, session, request, settings))
                time.sleep(0.05)
            statuses = [one.result().status for one in asked]
        self.assertEqual(statuses[-1], 200)
        self.assertEqual(set(statuses[:-1]) - {200, 409}, set())
        self.assertIn(409, statuses)

        def is_replaced(request):
            """Whether the focus came while the picture was under way; it may come before."""
            large = pool.submit(self.server.picture, session, request,
                                dict(settings, focus=request % 7 / 7))
            time.sleep(0.005 * (request % 20))
            focus = self.server.post('focus?session=' + session['session'], {'x': 0.5, 'y': 0.5})
            self.assertEqual(focus.status, 200)
            return large.result().status == 409

        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            self.assertTrue(any(is_replaced(request) for request in range(10, 70)))

    def test_eight_clients(self):
        settings = {'focus': 0.8, 'blur': 10}
        expected = self.rendered(settings, '--strip')

        def client(number):
            session = self.server.open('deep é.jpg')
            bodies = [self.server.picture(session, request, dict(settings, blur=2 * number + 1),
                                          more='&quick=1').body[:2] for request in range(1, 10)]
            full = self.server.picture(session, 10, settings)
            self.server.post('close?session=' + session['session'])
            return set(bodies) == {b'\xff\xd8'} and full.body == expected

        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            self.assertEqual(list(pool.map(client, range(8))), 8 * [True])

    def test_sessions_are_dropped(self):
        sessions = [self.server.open('none.jpg') for _ in range(17)]
        self.refused(410, 'ended', self.server.picture(sessions[0], 1, {}))
        self.assertEqual(self.server.picture(sessions[16], 1, {}).status, 200)
        for session in sessions:
            self.server.post('close?session=' + session['session'])

    @unittest.skipIf('REFOCUS_BRIEF' in os.environ, 'sanitizers take memory of their own')
    def test_memory(self):
        server = Server('photos', '--session-memory', '64')
        body = b'P6\n4000 3000\n255\n' + bytes(4000 * 3000 * 3)
        self.assertEqual(server.open('none.jpg')['depth'], False)
        answer = server.post('upload?name=large.ppm', body)
        if answer.status == 200:
            answer = server.picture(answer.json, 1, {})
        # It may have been dropped while nobody asked for anything: then it has ended.
        if answer.status == 410:
            self.refused(410, 'ended', answer)
        else:
            self.refused(503, 'needs more memory', answer)
        self.assertEqual(server.open('none.jpg')['depth'], False)
        self.assertEqual(server.close(), (0, '', []))

    def test_killed_process(self):
        kept, lost = self.opened(), self.server.open('none.jpg')
        pid = max(self.server.children())
        os.kill(pid, signal.SIGKILL)
        self.assertTrue(until(lambda: pid not in self.server.children()))
        self.refused(410, 'ended|failed', self.server.picture(lost, 1, {}))
        self.assertEqual(self.server.picture(kept, 1, {}).status, 200)

    def test_hostile_requests(self):
        noise = random.Random(7)
        session = self.opened()
        token = self.server.path
        host = self.server.host
        files = self.server.files()
        words = [token, '/', 'photos', 'open?photo=', '..%2f', '%00', 'thumbnail?photo=none.jpg',
                 'picture?session=' + session['session'], '&size=9', '&request=5', '\xff', ' ', '%',
                 'focus?session=', session['session'], '{"x": 0.5', ':', '\0', 'A' * 3000]

        def request():
            kind = noise.randrange(5)
            if kind == 0:
                return bytes(noise.randrange(256) for _ in range(noise.randrange(1, 400)))
            name = token + ''.join(noise.choice(words) for _ in range(noise.randrange(4)))
            lines = ['%s %s HTTP/1.%d' % (noise.choice(('GET', 'POST', 'PUT', 'get', '')), name,
                                          noise.randrange(3)),
                     'Host: ' + noise.choice((host, host, host, 'x', '')),
                     noise.choice(('Content-Length: 5', 'Content-Length: -1', 'Content-Length: 5x',
                                   'Transfer-Encoding: chunked', 'Origin: http://x', 'Expect: 100-continue',
                                   'Content-Length: 99999999999999999999', 'X: ' + 'y' * 9000,
                                   'Cookie: a=b', 'Transfer-Encoding: x'))]
            text = '\r\n'.join(lines) + noise.choice(('\r\n\r\n', '\n\n', '\r\n', ''))
            body = noise.choice(('', 'abcde', '5\r\nabcde\r\n0\r\n\r\n', 'ffffffffffffffff\r\n', '-1\r\n',
                                 '{}'))
            data = bytearray((text + body).encode('latin-1'))
            for _ in range(noise.randrange(3)):
                data[noise.randrange(len(data))] = noise.randrange(256)
            return bytes(data)

        for _ in range(1000):
            with socket.create_connection(('127.0.0.1', self.server.port), timeout=120) as line:
                line.sendall(request())
                line.settimeout(0.01)  # for an answer, where it is whole
                try:
                    line.recv(1000)
                except OSError:
                    pass
        self.assertTrue(until(lambda: self.server.get('photos').status == 200))
        self.assertEqual(self.server.picture(session, 999999, {}).status, 200)
        self.assertTrue(until(lambda: self.server.files() <= files + 1))

    def test_ends_while_busy(self):
        server = Server('photos')
        session = server.open('deep é.jpg')
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            large = b'P6\n3000 3000\n255\n' + os.urandom(3000 * 3000 * 3)
            upload = pool.submit(server.post, 'upload?name=large.ppm', large)
            self.assertEqual(server.picture(session, 1, {}).status, 200)
            self.assertTrue(until(lambda: len(server.children()) == 2 or upload.done()))
            self.assertEqual(server.close(), (0, '', []))
            try:
                self.assertIn(upload.result().status, (200, 503))
            except (ConnectionError, http.client.HTTPException):
                pass


class Lines(Case):
    def test_command_line(self):
        for words, arguments in (
                (r"^refocus: nothing: No such file or directory\n$", ('nothing',)),
                (r"^refocus: serve: example.org is no address in numbers\n$",
                 ('--listen', 'example.org')),
                (r'^refocus: /dev/null: it is neither a photo nor a folder\n$', ('/dev/null',)),
                (r"^refocus: serve: port \d+ of 127.0.0.1 cannot be had: Address already in use\n$",
                 ('--port', None))):
            with socket.create_server(('127.0.0.1', 0)) as taken:
                port = str(taken.getsockname()[1])
                result = self.run_it('serve', *(port if word is None else word for word in arguments))
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, words)
        for arguments in ('--port', '65536'), ('--port', 'x'), ('--max-upload', '0'), ('a', 'b'):
            self.assertEqual(self.run_it('serve', *arguments).returncode, 2)

    def test_leaves_no_files(self):
        os.mkdir('temporary')
        environment = os.environ.get('TMPDIR')
        os.environ['TMPDIR'] = os.path.abspath('temporary')
        try:
            server = Server()
        finally:
            if environment is None:
                del os.environ['TMPDIR']
            else:
                os.environ['TMPDIR'] = environment
        session = server.post('upload?name=photo.ppm', pictures.read_bytes('photo.ppm')).json
        self.assertEqual(len(os.listdir('temporary')), 1)
        self.assertEqual(server.picture(session, 1, {}).status, 200)
        self.assertEqual(server.post('upload?name=photo.ppm', b'damaged').status, 422)
        self.assertEqual(server.close(), (0, '', []))
        self.assertEqual(os.listdir('temporary'), [])

    def test_signals(self):
        for number, status in (signal.SIGINT, 0), (signal.SIGTERM, 0), (signal.SIGHUP, -signal.SIGHUP):
            server = Server()
            server.process.send_signal(number)
            self.assertEqual(server.process.wait(60), status)
            server.process.stdout.close()
            self.assertEqual(server.process.stderr.read(), '')
            server.process.stderr.close()

    def test_link(self):
        links = set()
        for address, pattern in (('127.0.0.1', r'127\.0\.0\.1'), ('::1', r'\[::1\]')):
            try:
                socket.create_server((address, 0), family=socket.AF_INET6 if ':' in address
                                     else socket.AF_INET).close()
            except OSError:
                continue
            server = Server('--listen', address)
            self.assertRegex(server.link, r'^http://%s:\d+/[0-9a-f]{32}/$' % pattern)
            links.add(server.path)
            self.assertEqual(server.close(), (0, '', []))
        self.assertGreater(len(links), 0)


if __name__ == '__main__':
    unittest.main()
