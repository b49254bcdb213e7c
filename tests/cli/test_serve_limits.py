#!/usr/bin/env python3
"""The command `refocus serve`: nobody's request is felt by others, and its command line. Usage:
test_serve_limits.py REFOCUS [unittest arguments]"""
import concurrent.futures
import http.client
import os
import random
import signal
import socket
import time
import unittest

import pictures
from case import Case
from serving import Server, Serving, until


def memory_mib(pid, word):
    """Memory that a process holds (VmRSS), or has held at the most (VmHWM)."""
    status = pictures.read_bytes('/proc/%d/status' % pid).decode()
    return int(status.split(word + ':')[1].split()[0]) // 1024


class Limits(Serving):
    @classmethod
    def setUpClass(cls):
        """Slow uploads, on a server of their own, are under way beside the other tests."""
        super().setUpClass()
        cls.slow = Server()
        cls.pool = concurrent.futures.ThreadPoolExecutor(2)
        cls.steady = cls.pool.submit(cls.upload, 66000, 16)
        cls.trickling = cls.pool.submit(cls.upload, 10, 1)

    @classmethod
    def tearDownClass(cls):
        cls.slow.close()
        cls.pool.shutdown()
        super().tearDownClass()

    @classmethod
    def upload(cls, piece, seconds):
        """Send a photo piece by piece for 75 seconds at the most: the first bytes of the answer."""
        body = b'P6\n330 330\n255\n' + bytes(330 * 330 * 3)
        end = time.monotonic() + 75
        with socket.create_connection(('127.0.0.1', cls.slow.port), timeout=120) as line:
            try:
                line.sendall(('POST %supload?name=x.ppm HTTP/1.1\r\nHost: %s\r\nContent-Length: %d'
                              '\r\n\r\n' % (cls.slow.path, cls.slow.host, len(body))).encode())
                for at in range(0, len(body), piece):
                    if time.monotonic() > end:
                        return b'never'
                    line.sendall(body[at:at + piece])
                    time.sleep(seconds)
                return line.recv(100)
            except ConnectionError:
                return b''

    def test_slow_uploads(self):
        """One that goes on is waited for, one that trickles is not."""
        self.assertRegex(self.steady.result(), rb'^HTTP/1.1 200 ')
        self.assertEqual(self.trickling.result(), b'')

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
        self.assertEqual(server.get('photos').json, {'folder': False, 'live': False, 'photos': [], 'unnamed': 0, 'open': None,
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

    def test_in_a_browser(self):
        """`view --page` opens the page by $BROWSER, else by xdg-open; without either it prints the
        link."""
        os.mkdir('programs')
        for name in 'one', 'xdg-open':
            path = os.path.join('programs', name)
            with open(path, 'w') as file:
                file.write('#!/bin/sh\necho noise; echo "%s $*" >"$OPENED.new"\n'
                           '/bin/mv "$OPENED.new" "$OPENED"\n' % name)
            os.chmod(path, 0o755)
        for i, (path, browser, opened) in enumerate((
                ('programs', 'one', 'one'), ('programs', 'no such', 'xdg-open'),
                ('programs', '', 'xdg-open'), ('', 'no such', None))):
            server = Server('photos/plain.ppm', command=('view', '--page'), BROWSER=browser,
                            PATH=os.path.abspath(path) if path else '/nowhere',
                            OPENED='opened-%d' % i)
            self.assertEqual([one['name'] for one in server.get('photos').json['photos']],
                             ['plain.ppm'])
            if opened:
                self.assertTrue(until(lambda: os.path.exists('opened-%d' % i)))
                self.assertEqual(pictures.read_bytes('opened-%d' % i).decode(),
                                 '%s %s\n' % (opened, server.link))
            self.assertEqual(server.children(), [])
            self.assertEqual(server.close(), (0, '', []))
            self.assertEqual(os.path.exists('opened-%d' % i), bool(opened))
        self.fails(2, "--blur: unknown option; 'refocus serve --help-all' lists them",
                   'view', 'photos/plain.ppm', '--page', '--blur', '3')

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

    @unittest.skipIf('REFOCUS_BRIEF' in os.environ, 'sanitizers take memory of their own')
    def test_little_memory(self):
        """A picture that is too large for its session is rendered in strips, and the memory of whole
        ones is given back when nobody asks for more."""
        row = bytes(x * x // 50 % 251 for x in range(3 * 2000))
        with open('large.ppm', 'wb') as file:
            file.write(b'P6\n2000 1500\n255\n')
            for y in range(1500):
                file.write(row[y // 2 * 3:] + row[:y // 2 * 3])
        self.succeeds('render', 'large.ppm', '--depth', 'map.pgm', '--blur', '0', '--no-editable', '-o',
                      'sharp.jpg')
        self.succeeds('depth', 'sharp.jpg', '--depth', 'map.pgm', '-o', 'large.jpg')
        settings = {'focus': 0.2, 'blur': 10}
        strips = self.rendered(settings, '--strip', '--low-memory', photo='large.jpg')
        whole = self.rendered(settings, '--strip', photo='large.jpg')
        peaks = []
        for limit, expected in ('110', strips), ('1000', whole):
            server = Server('large.jpg', '--session-memory', limit)
            session = server.open('large.jpg')
            pid, = server.children()
            before = memory_mib(pid, 'VmRSS')
            answer = server.picture(session, 1, settings)
            self.assertEqual(answer.status, 200)
            self.assertTrue(answer.body == expected)
            peaks.append(memory_mib(pid, 'VmHWM'))
            self.assertTrue(until(lambda: memory_mib(pid, 'VmRSS') < before + 30))
            self.assertTrue(server.picture(session, 2, settings).body == expected)
            self.assertEqual(server.close(), (0, '', []))
        self.assertLess(peaks[0], 110)
        self.assertLess(peaks[0] + 50, peaks[1])

    def test_killed_process(self):
        kept, lost = self.opened(), self.server.open('none.jpg')
        pid = max(self.server.children())
        os.kill(pid, signal.SIGKILL)
        self.assertTrue(until(lambda: pid not in self.server.children()))
        self.refused(410, 'ended|failed', self.server.picture(lost, 1, {}))
        self.assertEqual(self.server.picture(kept, 1, {}).status, 200)

    def test_killed_at_work(self):
        """What a request makes fail is told apart from a session that has ended."""
        lost = self.server.open('none.jpg')
        pid = max(self.server.children())
        os.kill(pid, signal.SIGSTOP)
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            asked = pool.submit(self.server.picture, lost, 1, {})
            time.sleep(0.5)
            os.kill(pid, signal.SIGKILL)
            self.refused(502, 'failed', asked.result())
        self.refused(410, 'ended', self.server.picture(lost, 2, {}))

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
    def test_photos_by_their_endings(self):
        """All that the library reads as a photo is listed, whatever the case of its ending."""
        os.mkdir('mixed')
        shown = ['a.' + ending for ending in (
            'jpg JPEG mpo png HEIC hif avif tif tiff exr webp jxl ppm pgm pfm dng cr2 CR3 crw nef nrw '
            'arw orf raf rw2 pef srw x3f 3fr iiq rwl').split()]
        for name in shown + ['a.txt', 'a.json', 'a.xmp', 'a.mp4', 'jpg', '.a.jpg']:
            open(os.path.join('mixed', name), 'wb').close()
        for name in b'a\\b.jpg', b'a\tb.jpg', b'a\xff.jpg', b'.a\tb.jpg', b'a\tb.txt':
            open(os.path.join(b'mixed', name), 'wb').close()
        server = Server('mixed')
        listed = server.get('photos').json
        self.assertEqual(sorted(photo['name'] for photo in listed['photos']), sorted(shown))
        self.assertEqual(listed['unnamed'], 3)
        self.assertEqual(server.close(), (0, '', []))

    def test_command_line(self):
        open('notes.txt', 'wb').close()
        for words, arguments in (
                (r"^refocus: nothing: No such file or directory\n$", ('nothing',)),
                (r"^refocus: serve: example.org is no address in numbers\n$",
                 ('--listen', 'example.org')),
                (r'^refocus: /dev/null: it is neither a photo nor a folder\n$', ('/dev/null',)),
                (r"^refocus: notes.txt: its name does not end as a photo's does, such as in .jpg\n$",
                 ('notes.txt',)),
                (r"^refocus: serve: port \d+ of 127.0.0.1 cannot be had: Address already in use\n$",
                 ('--port', None))):
            with socket.create_server(('127.0.0.1', 0)) as taken:
                port = str(taken.getsockname()[1])
                result = self.run_it('serve', *(port if word is None else word for word in arguments))
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, words)
        for arguments in ('--port', '65536'), ('--port', 'x'), ('--max-upload', '0'), ('a', 'b'):
            self.assertEqual(self.run_it('serve', *arguments).returncode, 2)

    def test_behind_another_server(self):
        """One that is encrypted passes requests on, with its own name as Host or with this one's."""
        origin = 'https://photos.example.org'
        with socket.create_server(('127.0.0.1', 0)) as free:
            port = free.getsockname()[1]
        server = Server('--origin', origin, '--port', str(port), command=('serve',))
        try:
            self.assertRegex(server.link, '^' + origin + r'/[0-9a-f]{32}/$')
            server.port = port
            own = '127.0.0.1:%d' % server.port
            for host, sender, status in (
                    ('photos.example.org', origin, 422), (own, origin, 422),
                    (own, 'http://' + own, 422), ('photos.example.org', None, 422),
                    ('photos.example.org', 'https://elsewhere', 403),
                    ('photos.example.org', origin + '.elsewhere', 403),
                    ('photos.example.org:1', origin, 404), ('elsewhere', origin, 404)):
                headers = {'Host': host, **({'Origin': sender} if sender else {})}
                self.assertEqual(server.post('upload?name=a.jpg', b'no photo', **headers).status,
                                 status, headers)
        finally:
            self.assertEqual(server.close(), (0, '', []))
        for wrong in 'photos.example.org', 'https://', 'https://a/b', 'ftp://a', 'https://a b':
            result = self.run_it('serve', '--origin', wrong)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, '^refocus: serve: .* is no origin such as https://')

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
        with open(os.path.join('temporary', *os.listdir('temporary'), 'left-by-a-reader'), 'w'):
            pass
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


if __name__ == '__main__':
    unittest.main()
