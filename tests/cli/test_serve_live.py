#!/usr/bin/env python3
"""A camera on the page of `refocus serve --live`, over HTTP. Usage: test_serve_live.py REFOCUS
[unittest arguments]"""
import concurrent.futures
import json
import socket
import time
import unittest

from serving import Server, Serving, until


class Live(Serving):
    """Frames of a camera: all clients look at one session, each with settings of its own."""
    CAMERA = ('--live', 'replay::size 64x48;fps 30', '--depth',
              'replay::format Z16;size 32x24;fps 30')

    def setUp(self):
        self.live = Server(*self.CAMERA)

    def tearDown(self):
        self.assertEqual(self.live.close(), (0, '', []))

    def frame(self, session, after, settings, kind='picture'):
        return self.live.post('frame?session=%s&size=0&kind=%s&after=%d' %
                              (session['session'], kind, after), settings)

    def test_frames(self):
        self.assertTrue(self.live.get('photos').json['live'])
        session = self.live.post('live').json
        self.assertEqual((session['live'], session['width'], session['height'], session['depth']),
                         (True, 64, 48, True))
        self.assertEqual(session['limits']['f_number'], [1, 22])
        self.assertEqual(self.live.post('live').json['session'], session['session'])
        self.assertEqual(len(self.live.children()), 1)
        numbers, seen = [0], set()
        for _ in range(5):
            answer = self.frame(session, numbers[-1], {'focus': 0.5, 'blur': 6})
            self.assertEqual((answer.status, answer.headers['Content-Type'], answer.body[:2]),
                             (200, 'image/jpeg', b'\xff\xd8'))
            numbers.append(int(answer.headers['Refocus-Frame']))
            seen.add(answer.body)
        self.assertEqual(numbers, sorted(set(numbers)))
        self.assertGreater(len(seen), 3, 'it stands still')

    def test_settings_of_each_client(self):
        # A still picture: what differs is what was asked for.
        server = Server('--live', 'file:noise.ppm', '--depth', 'map.pgm')
        session = server.post('live').json
        ask = lambda settings, kind='picture': server.post(
            'frame?session=%s&size=0&kind=%s&after=0' % (session['session'], kind), settings)
        near, far = {'focus': 1, 'blur': 9}, {'focus': 0, 'blur': 9}
        pictures_of = [ask(near).body, ask(far).body, ask(near, 'depth').body,
                       ask(near, 'blur').body, ask(near, 'peaking').body,
                       ask({'focus': 1, 'blur': 9, 'aperture': 'star'}).body]
        self.assertEqual(len(set(pictures_of)), 6)
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            both = list(pool.map(lambda i: ask(far if i % 2 else near).body, range(12)))
        self.assertEqual(both, pictures_of[:2] * 6)
        self.refused(400, 'settings', ask({'blur': -1}))
        focus = server.post('focus?session=' + session['session'], {'x': 0.1, 'y': 0.1}).json
        self.assertTrue(0 <= focus['focus'] <= 1)
        self.assertEqual(server.close(), (0, '', []))

    def test_still(self):
        session = self.live.post('live').json
        save = lambda kind: self.live.post('save?as=%s&session=%s' % (kind, session['session']), {})
        answer = save('jpeg')
        self.assertEqual(answer.status, 200)
        with open('still.jpg', 'wb') as out:
            out.write(answer.body)
        report = json.loads(self.succeeds('info', 'still.jpg', '--json'))
        self.assertEqual((report['picture'], report['depth']['source']), ([64, 48], 'gdepth'))
        opened = self.live.post('upload?name=still.jpg', answer.body).json
        self.assertEqual((opened['live'], opened['depth']), (False, True))
        self.assertEqual(self.live.picture(opened, 1, opened['settings']).status, 200)
        self.refused(400, 'JPEG', save('png'))
        self.assertEqual(save('settings').json['refocus'], 1)

    def test_refusals(self):
        session = self.live.post('live').json
        key = 'session=' + session['session']
        for name, body in (('picture?size=0&request=1&', {}), ('stroke?', {}), ('draft?', {}),
                           ('undo?', b''), ('redo?', b''), ('overlay?size=0&kind=depth&', {}),
                           ('pull?size=0&as=apng&', {})):
            self.refused(400, 'capture a photo first', self.live.post(name + key, body))
        for wrong in ('size=0&kind=picture', 'size=0&kind=picture&after=x', 'kind=depth&after=0',
                      'size=0&after=0', 'size=0&kind=other&after=0'):
            self.assertEqual(self.live.post('frame?%s&%s' % (key, wrong), {}).status, 400, wrong)
        photo = self.opened()
        self.refused(400, 'it is a photo', self.server.post(
            'frame?size=0&kind=picture&after=0&session=' + photo['session'], {}))
        self.refused(404, '--live', self.server.post('live'))
        self.assertFalse(self.server.get('photos').json['live'])

    def test_slow_clients_cost_nothing(self):
        session = self.live.post('live').json
        request = ('POST %sframe?session=%s&size=0&kind=picture&after=0 HTTP/1.1\r\nHost: %s\r\n'
                   'Content-Length: 2\r\n\r\n{}' % (self.live.path, session['session'],
                                                   self.live.host)).encode()
        lines = []
        for _ in range(20):  # ask, and take nothing
            lines.append(socket.create_connection(('127.0.0.1', self.live.port)))
            lines[-1].sendall(request)
        after = 0
        for _ in range(10):
            answer = self.frame(session, after, {'blur': 5})
            if answer.status == 503:  # more than wait for one camera
                time.sleep(0.1)
                continue
            self.assertEqual(answer.status, 200)
            after = int(answer.headers['Refocus-Frame'])
        self.assertGreater(after, 0)
        for line in lines:
            line.close()

    def test_nobody_looks(self):
        # The camera is free again after a while, and can be had again.
        session = self.live.post('live').json
        self.assertEqual(self.live.post('close?session=' + session['session']).status, 200)
        self.assertEqual(self.frame(session, 0, {}).status, 200, 'others look at it')
        self.assertTrue(until(lambda: self.live.children() == []))
        self.refused(410, 'open the photo again', self.frame(session, 0, {}))
        again = self.live.post('live').json
        self.assertEqual(self.frame(again, 0, {}).status, 200)

    def test_no_camera(self):
        server = Server('--live', 'replay::size 64x48;frames 3', '--depth', 'v4l2:/dev/video250')
        for _ in range(2):
            self.refused(422, 'v4l2:/dev/video250', server.post('live'))
        self.assertEqual(server.close(), (0, '', []))
        self.fails(2, '--depth: no depth is given; give a source or a depth map', 'serve', '--live', 'replay::size 64x48')
        self.fails(2, '--near: it goes with --live; give that too', 'serve', '--near', '1')
        for command in ('serve', ), ('view', '--page'):
            self.fails(2, "--depth: it goes with --live; a photo gets its map by 'refocus depth PHOTO "
                       "--depth MAP -o NEW.jpg'", *command, 'noise.ppm', '--depth', 'map.pgm')


if __name__ == '__main__':
    unittest.main()
