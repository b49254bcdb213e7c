#!/usr/bin/env python3
"""The command `refocus serve`, over HTTP: what it answers and what it refuses. Usage: test_serve.py
REFOCUS [unittest arguments]"""
import json
import os
import random
import subprocess
import unittest
from urllib.parse import quote

import pictures
from case import REFOCUS
from serving import HEADERS, HEIGHT, WIDTH, Serving, until


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
                                             'highlights': [1, 16], 'pull_seconds': 20})
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
        self.assertEqual(self.server.picture(session, 3, {'focus': 0.5, 'f-number': 4}).body,
                         self.server.picture(session, 4, {
                             'focus': 0.5, 'blur': session['f1_blur'] / 4}).body)
        flat = self.opened('none.jpg')
        self.assertNotIn('f-number', flat['first'])
        self.assertIsNone(flat['f1_blur'])

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
        self.assertIsNone(session['range'])
        made = ask('stroke', ground).json
        self.assertAlmostEqual(made['range'][0], 0.1, delta=0.001)
        self.assertAlmostEqual(made['range'][1], 0.9, delta=0.001)
        self.assertEqual(made, {'strokes': 1, 'undone': 0, 'range': made['range']})
        ground_range = made['range']
        made = ask('stroke', brush).json
        self.assertEqual(made, {'strokes': 2, 'undone': 0, 'range': made['range']})
        self.assertAlmostEqual(made['range'][1], 0.95, delta=0.001)
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
        self.assertEqual(ask('undo').json, {'strokes': 1, 'undone': 1, 'range': ground_range})
        self.assertEqual(ask('undo').json, {'strokes': 0, 'undone': 2, 'range': None})
        self.refused(409, 'none to undo', ask('undo'))
        self.assertTrue(self.server.picture(session, 3, settings).body == before)
        self.assertEqual(ask('redo').json, {'strokes': 1, 'undone': 1, 'range': ground_range})
        self.assertEqual(ask('redo').json, made)
        self.refused(409, 'none to do again', ask('redo'))
        self.assertTrue(self.server.picture(session, 4, settings).body == painted)
        ask('undo')
        self.assertEqual(ask('stroke', brush).json, made)
        for wrong in ({'kind': 'other'}, {'kind': 'all', 'disparity': 2}, [], 3, b'', b'{"kind"',
                      {'kind': 'brush', 'radius': 5, 'points': []},
                      {'kind': 'brush', 'radius': 5, 'points': [[1e9, 0]], 'disparity': 0.5}):
            self.refused(400, 'stroke: ', ask('stroke', wrong))
        saved = self.server.post('save?as=jpeg&session=' + session['session'], settings)
        with open('saved.jpg', 'wb') as out:
            out.write(saved.body)
        report = json.loads(self.succeeds('info', 'saved.jpg', '--json'))
        self.assertEqual(report['depth']['source'], 'gdepth')

    def test_drafts(self):
        # A stroke under the finger is as good as the stroke that it becomes, and then is gone.
        session = self.opened('none.jpg')
        ask = lambda name, body=None: self.server.post('%s?session=%s' % (name, session['session']),
                                                       body)
        picture = lambda request: self.server.picture(session, request,
                                                      {'focus': 0.95, 'blur': 9}).body
        brush = lambda points: {'kind': 'brush', 'radius': 12, 'points': points, 'disparity': 0.95}
        short, long = brush([[40, 40]]), brush([[40, 40], [60, 50], [90, 60]])
        before = picture(1)
        first, second = ask('draft', short).json, ask('draft', long).json
        self.assertEqual((first['strokes'], second['strokes']), (1, 1))
        self.assertGreater(sum(second['selection']['runs'][1::2]),
                           2 * sum(first['selection']['runs'][1::2]))
        selection = first['selection']
        self.assertEqual((selection['width'], selection['height']), (WIDTH, HEIGHT))
        inside = {(i % WIDTH, i // WIDTH) for start, length in
                  zip(selection['runs'][::2], selection['runs'][1::2])
                  for i in range(start, start + length)}
        self.assertEqual(inside, {(x, y) for x in range(WIDTH) for y in range(HEIGHT)
                                  if (x - 40) ** 2 + (y - 40) ** 2 <= 144})
        drafted = picture(2)
        self.assertNotEqual(drafted, before)
        self.refused(400, 'stroke: ', ask('draft', {'kind': 'other'}))
        self.assertTrue(picture(3) == before)
        ask('draft', short)
        made = ask('stroke', long).json
        self.assertEqual(made, {'strokes': 1, 'undone': 0, 'range': made['range']})
        self.assertTrue(picture(4) == drafted)
        ask('draft', {'kind': 'all', 'disparity': 0.5})
        self.assertEqual(ask('draft', {}).json, {'strokes': 1, 'undone': 0, 'selection': None})
        ask('draft', short)
        self.assertEqual(ask('undo').json, {'strokes': 0, 'undone': 1, 'range': None})
        ask('draft', short)
        self.assertEqual(len(self.server.get('strokes?session=' + session['session'])
                             .json['strokes']), 0)
        self.assertEqual(ask('redo').json, made)
        self.assertTrue(picture(5) == drafted)

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
                '/%s/' % token[:-1], '/%s0/' % token, \
                *('/%s%c%s/' % (token[:i], ord(token[i]) ^ 64, token[i + 1:]) for i in (0, 31)):
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
        for name in '', 'photos':
            head, get = self.server.ask('HEAD', name), self.server.get(name)
            self.assertEqual((head.status, head.body), (200, b''))
            self.assertEqual(head.headers['Content-Length'], str(len(get.body)))
        self.assertEqual(self.server.ask('HEAD', 'open?photo=none.jpg').status, 405)
        for method in 'PUT', 'DELETE', 'OPTIONS', 'PATCH', 'TRACE', 'X':
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
        for name in '../x.jpg', '/x.jpg', '', '.x.jpg', 'a/b.jpg', 'a%00.jpg', '%ff.jpg', 'a%7f.jpg', 'x' * 300:
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

        flat = self.opened('none.jpg')  # which has no metres
        for ask in 'picture?size=0&request=1&', 'picture?size=0&request=2&quick=1&', \
                'overlay?size=0&kind=blur&', 'save?as=jpeg&':
            self.check_settings(ask, flat, {'focus-distance': 2}, 'needs distances in metres')

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


if __name__ == '__main__':
    unittest.main()
