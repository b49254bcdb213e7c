#!/usr/bin/env python3
"""usage: test_page.py REFOCUS  -- the page of refocus serve in a headless Chromium.

Exit status 77, after saying so, where Chromium, its driver or Selenium is missing. With
REFOCUS_PAGE_SHOTS=FOLDER screenshots of all sizes are kept there."""
import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import audit
import browser
from browser import SLOW, Browser, difference

ROOT = os.environ.get('REFOCUS_SOURCE_ROOT', os.path.join(os.path.dirname(__file__), '../..'))
SCENE = os.path.join(os.path.abspath(ROOT), 'examples/data/portrait/')
SHOTS = os.environ.get('REFOCUS_PAGE_SHOTS')
REFOCUS = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else 'refocus'
SCREENS = {  # width, height, touch, device pixels of a CSS pixel
    'small-phone': (320, 568, True, 2), 'phone': (390, 844, True, 3),
    'phone-on-its-side': (844, 390, True, 3), 'tablet': (820, 1180, True, 2),
    'desktop': (1440, 900, False, 1),
}
FACE, WALL = (0.56, 0.5), (0.08, 0.3)  # a near and a far place of the photo
os.environ['XDG_CONFIG_HOME'] = os.devnull


def refocus(*arguments):
    subprocess.run([REFOCUS, *arguments], check=True, stdout=subprocess.DEVNULL)


class Page(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='refocus-page-')
        cls.photos = os.path.join(cls.folder, 'photos')
        cls.saved = os.path.join(cls.folder, 'saved')
        os.mkdir(cls.photos)
        os.mkdir(cls.saved)
        deep = os.path.join(cls.photos, 'deep.jpg')
        refocus('render', SCENE + 'allfocus.png', '--depth', SCENE + 'disparity.png', '--blur',
                '0', '--editable', '-o', deep)
        refocus('render', deep, '--blur', '0', '--strip', '-o',
                os.path.join(cls.photos, 'flat.jpg'))
        shutil.copy(deep, os.path.join(cls.folder, 'elsewhere.jpg'))
        cls.server = subprocess.Popen([REFOCUS, 'serve', cls.photos, '--port', '0'],
                                      stdout=subprocess.PIPE, text=True)
        cls.address = cls.server.stdout.readline().strip()
        cls.browser = Browser(cls.saved)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.server.terminate()
        status = cls.server.wait(30 * SLOW)
        cls.server.stdout.close()
        shutil.rmtree(cls.folder)
        if status not in (0, -15):
            raise AssertionError('the server ended with %d' % status)

    def setUp(self):
        self.allowed = ()  # errors of the console that a test provokes
        b = self.browser
        b.screen(1280, 800)
        self.load()

    def tearDown(self):
        errors = [line for line in self.browser.errors()
                  if not any(word in line for word in self.allowed)]
        self.assertEqual(errors, [])
        origin = re.match(r'http://[^/]+/', self.address).group()
        for name in self.browser.requests():
            self.assertTrue(name.startswith((origin, 'blob:' + origin)), name)

    def load(self, fragment=''):
        self.browser.driver.get('about:blank')
        self.browser.errors()
        self.browser.driver.get(self.address + fragment)

    def card(self, name):
        def find():
            return [card for card in self.browser.all('.photo') if name in card.text]
        return self.browser.until(find, 'card of ' + name)[0]

    def open(self, name='deep.jpg'):
        self.card(name).click()
        self.browser.until(lambda: self.browser.text('name') == name, 'open ' + name)
        return self.browser.samples()

    def tab(self, name):
        self.browser.click('tab-' + name)

    def changes(self, before, what, least=0.05):
        """The picture becomes another one; returns it."""
        after = self.browser.samples()
        self.assertGreater(difference(before, after), least, what)
        return after

    def downloaded(self, ending):
        def find():
            return [name for name in os.listdir(self.saved) if name.endswith(ending)]
        name = self.browser.until(find, 'file ' + ending, 60)[0]
        path = os.path.join(self.saved, name)
        with open(path, 'rb') as file:
            data = file.read()
        os.remove(path)
        return data

    # Things that a person does

    def test_opening(self):
        b = self.browser
        deep, flat = self.card('deep.jpg'), self.card('flat.jpg')
        b.until(lambda: 'no depth' in flat.text and '\ndepth' in '\n' + deep.text, 'marks')
        b.until(lambda: b.run("return [...document.querySelectorAll('.photo img')]"
                              ".every((one) => one.naturalWidth > 0)"), 'thumbnails')
        picture = self.open()
        self.assertGreater(max(picture) - min(picture), 100)
        self.assertTrue(b.seen('canvas'))
        b.click('open')
        self.assertTrue(b.seen('choose'))
        self.assertFalse(b.seen('canvas'))
        b.click('back')
        self.assertEqual(difference(picture, b.samples()), 0)

    def test_a_photo_from_elsewhere(self):
        b = self.browser
        self.card('deep.jpg')
        b.run("document.getElementById('file').hidden = false")
        b.find('file').send_keys(os.path.join(self.folder, 'elsewhere.jpg'))
        b.until(lambda: b.text('name') == 'elsewhere.jpg', 'upload')
        self.assertGreater(max(b.samples()), 100)

    def test_what_is_no_photo(self):
        b = self.browser
        path = os.path.join(self.folder, 'junk.jpg')
        with open(path, 'w') as file:
            file.write('no photo')
        self.allowed = ('status of 4', )  # Chromium reports what the server refuses
        self.card('deep.jpg')
        b.run("document.getElementById('file').hidden = false")
        b.find('file').send_keys(path)
        b.until(lambda: 'error' in b.find('said').get_attribute('class'), 'line of the error')
        self.assertNotIn('\n', b.text('said'))
        self.assertGreater(len(b.text('said')), 10)
        self.open()  # and all goes on

    def test_a_dropped_photo(self):
        b = self.browser
        self.card('flat.jpg')
        with open(os.path.join(self.photos, 'flat.jpg'), 'rb') as file:
            data = base64.b64encode(file.read()).decode()
        b.run('''
            const bytes = Uint8Array.from(atob(arguments[0]), (c) => c.charCodeAt(0));
            const dataTransfer = new DataTransfer();
            dataTransfer.items.add(new File([bytes], 'dropped.jpg'));
            for (const name of ['dragenter', 'dragover', 'drop'])
                document.body.dispatchEvent(new DragEvent(name, { dataTransfer, bubbles: true,
                    cancelable: true }));''', data)
        b.until(lambda: b.text('name') == 'dropped.jpg', 'drop')
        self.assertFalse(b.seen('drop'))
        self.assertGreater(max(b.samples()), 100)

    def test_a_server_that_is_gone(self):
        b = self.browser
        server = subprocess.Popen([REFOCUS, 'serve', self.photos, '--port', '0'],
                                  stdout=subprocess.PIPE, text=True)
        b.driver.get(server.stdout.readline().strip())
        self.open()
        server.terminate()
        server.wait(30 * SLOW)
        server.stdout.close()
        b.tap(*WALL)
        b.until(lambda: 'does not answer' in b.text('said'), 'line of the error')
        b.errors()
        self.load()

    def test_a_session_that_is_gone(self):
        # Closed behind the page's back: all comes again, with the strokes.
        b = self.browser
        self.open('flat.jpg')
        b.drag([(0.5, 0.98), (0.5, 0.3)])
        b.until(lambda: len(b.all('#strokes li')) == 1, 'ground')
        b.pick('views', 'depth')
        depth = b.samples()
        self.allowed = ('status of 4', )
        b.run('''const name = performance.getEntriesByType('resource')
                .findLast((one) => one.name.includes('/overlay?')).name;
            return fetch(name.replace('/overlay?', '/close?'), { method: 'POST' })
                .then((answer) => answer.text())''')
        b.pick('views', 'blur')
        b.until(lambda: 'as it was' in b.text('said'), 'opening again')
        b.pick('views', 'depth')
        self.assertEqual(difference(depth, b.samples()), 0)

    def test_tap(self):
        b = self.browser
        before = self.open()
        b.tap(*FACE)
        near = self.changes(before, 'a tap')
        face = float(b.find('focus').get_attribute('value'))
        b.tap(*WALL)
        self.changes(near, 'another tap')
        self.assertGreater(face, 100 + float(b.find('focus').get_attribute('value')))
        # The place in focus is sharper than with the focus elsewhere.
        sharp = b.sharpness(0.05, 0.12)
        b.tap(*FACE)
        self.assertGreater(sharp, 1.5 * b.sharpness(0.05, 0.12))

    def test_focus_follows_the_finger(self):
        before = self.open()
        self.browser.drag([FACE, (0.4, 0.4), (0.2, 0.3), WALL])
        self.changes(before, 'a drag')

    def test_each_slider(self):
        b = self.browser
        picture = self.open()
        b.tap(*FACE)
        picture = self.changes(picture, 'a tap')
        sliders = [one for one in b.all('#sliders input') if one.is_displayed()]
        self.assertEqual(len(sliders), 5)
        for slider in sliders:
            name = slider.get_attribute('id')
            told = slider.get_attribute('aria-valuetext')
            # To an end where it is not yet, as a finger does.
            x = 0.45 if float(slider.get_attribute('value')) < 900 else -0.45
            browser.ActionChains(b.driver).move_to_element(slider).click_and_hold().move_by_offset(
                round(x * slider.size['width']), 0).release().perform()
            picture = self.changes(picture, name, 0.002)
            self.assertNotEqual(slider.get_attribute('aria-valuetext'), told, name)
        b.click('reset')
        self.changes(picture, 'reset')

    def test_tilt_turns_about_what_was_tapped(self):
        b = self.browser
        self.open()
        b.tap(*WALL)
        sharp, level = b.sharpness(0.04, 0.12, 0.28, 0.32), b.samples()
        b.find('tilt').send_keys(*[browser.Keys.PAGE_UP] * 4)
        self.changes(level, 'tilt')
        self.assertGreater(b.sharpness(0.04, 0.12, 0.28, 0.32), 0.9 * sharp)
        b.until(lambda: 'tilt-line' in b.driver.current_url, 'line in the link')

    def test_before_and_after(self):
        b = self.browser
        self.open()
        b.tap(*FACE)
        blurred = b.sharpness(0.05, 0.3)
        right = b.sharpness(0.8, 0.95)
        b.click('compare')
        self.assertGreater(b.sharpness(0.05, 0.3), 1.5 * blurred)
        self.assertAlmostEqual(b.sharpness(0.8, 0.95), right, delta=0.01)
        divider = b.find('divider')
        browser.ActionChains(b.driver).drag_and_drop_by_offset(divider, 440, 0).perform()
        self.assertGreater(b.sharpness(0.8, 0.95), 1.5 * right)
        self.assertGreater(int(divider.get_attribute('aria-valuenow')), 90)
        b.click('compare')
        self.assertFalse(divider.is_displayed())
        self.assertAlmostEqual(b.sharpness(0.05, 0.3), blurred, delta=0.01)

    def test_looks(self):
        b = self.browser
        picture = self.open()
        b.tap(*FACE)
        picture = self.changes(picture, 'a tap')
        self.tab('look')
        b.until(lambda: b.run('''
            const empty = document.createElement('canvas');
            empty.width = empty.height = 192;
            const nothing = empty.toDataURL();
            return [...document.querySelectorAll('#looks canvas')].every(
                (one) => one.toDataURL() !== nothing)'''), 'pictures of the looks', 60)
        looks = [one.get_attribute('value') for one in b.all('#looks input')]
        self.assertGreater(len(looks), 4)
        self.assertEqual(len(set(map(b.run, [
            "return document.querySelectorAll('#looks canvas')[%d].toDataURL()" % i
            for i in range(len(looks))]))), len(looks), 'looks that look the same')
        b.pick('looks', 'ring')
        picture = self.changes(picture, 'ring', 0.02)
        b.pick('shapes', 'star')
        self.changes(picture, 'star', 0.02)

    def test_overlays(self):
        b = self.browser
        photo = self.open()
        for kind in ('depth', 'blur', 'peaking'):
            b.pick('views', kind)
            self.changes(photo, kind, 5)
        b.pick('views', 'picture')
        self.assertEqual(difference(photo, b.samples()), 0)

    def test_zoom_and_pan(self):
        b = self.browser
        fitted = self.open()
        b.click('zoom-full')
        full = self.changes(fitted, '1:1', 1)
        b.click('zoom-in')
        zoomed = self.changes(full, 'in', 1)
        b.drag([(0.5, 0.5), (0.4, 0.5), (0.3, 0.4)])
        self.changes(zoomed, 'pan', 1)
        b.click('zoom-fit')
        self.assertEqual(difference(fitted, b.samples()), 0)
        b.run('''document.getElementById('canvas').dispatchEvent(new WheelEvent('wheel',
            { deltaY: -400, clientX: 300, clientY: 300, bubbles: true, cancelable: true }))''')
        self.changes(fitted, 'wheel', 1)

    def test_two_fingers(self):
        b = self.browser
        b.screen(390, 844, touch=True)
        fitted = self.open()

        def fingers(kind, *places):
            b.command('Input.dispatchTouchEvent', type=kind, touchPoints=[
                {'x': x, 'y': y, 'id': i} for i, (x, y) in enumerate(places)])
        fingers('touchStart', (180, 300))
        fingers('touchStart', (180, 300), (220, 300))
        for spread in (30, 60, 90):
            fingers('touchMove', (180 - spread, 300), (220 + spread, 300))
        fingers('touchEnd')
        zoomed = self.changes(fitted, 'pinch', 1)
        focus = b.find('focus').get_attribute('value')
        fingers('touchStart', (200, 300))
        for x in (180, 150, 100):
            fingers('touchMove', (x, 300))
        fingers('touchEnd')
        self.changes(zoomed, 'pan by a finger', 1)
        self.assertEqual(b.find('focus').get_attribute('value'), focus)

    def test_painting(self):
        b = self.browser
        flat = self.open('flat.jpg')
        self.assertEqual(b.find('tab-paint').get_attribute('aria-selected'), 'true')
        self.assertTrue(b.find('undo').get_property('disabled'))
        b.pick('views', 'depth')
        empty = b.samples()
        b.drag([(0.5, 0.98), (0.5, 0.3)])
        b.until(lambda: len(b.all('#strokes li')) == 1, 'ground')
        ground = self.changes(empty, 'the ground')
        b.pick('brushes', 'object')
        b.drag([(0.45, 0.4), (0.5, 0.45), (0.55, 0.5), (0.5, 0.6)])
        b.until(lambda: len(b.all('#strokes li')) == 2, 'object')
        painted = self.changes(ground, 'an object')
        b.click('undo')
        b.until(lambda: b.all('#strokes .undone'), 'undo')
        self.assertEqual(difference(ground, b.samples()), 0)
        b.click('redo')
        b.until(lambda: not b.all('#strokes .undone'), 'redo')
        self.assertEqual(difference(painted, b.samples()), 0)
        b.pick('brushes', 'more')
        b.drag([(0.3, 0.8), (0.5, 0.8), (0.7, 0.8)])
        b.until(lambda: len(b.all('#strokes li')) == 3, 'more')
        self.changes(painted, 'more', 0.02)
        b.all('#strokes button')[0].click()
        b.until(lambda: len(b.all('#strokes .undone')) == 2, 'back by the list')
        self.assertEqual(difference(ground, b.samples()), 0)
        b.pick('views', 'picture')
        self.tab('adjust')
        b.tap(0.5, 0.95)
        self.changes(flat, 'blur by painted depth')

    def test_the_stroke_is_seen_under_the_finger(self):
        b = self.browser
        picture = self.open()
        self.tab('paint')
        canvas = b.find('canvas')
        browser.ActionChains(b.driver).move_to_element_with_offset(
            canvas, *b.at(*WALL)).click_and_hold().move_by_offset(60, 40).perform()
        seen = b.run(browser.SAMPLES)
        self.assertGreater(difference(picture, seen), 0.1)
        browser.ActionChains(b.driver).release().perform()
        b.until(lambda: len(b.all('#strokes li')) == 1, 'stroke')

    def test_rack_focus(self):
        b = self.browser
        self.open()
        b.tap(*FACE)
        near = b.samples()
        self.tab('pull')
        b.click('mark')
        b.tap(*WALL)
        far = self.changes(near, 'a tap')
        b.click('mark')
        self.assertEqual(len(b.all('#keys li')), 2)
        b.all('#keys .card')[0].click()
        b.rest()
        b.click('play')
        pictures = []
        while b.text('play') == 'Stop':
            pictures.append(b.run(browser.SAMPLES))
            time.sleep(0.1)
        self.assertGreater(len({tuple(one) for one in pictures}), 2, 'it does not move')
        self.assertLess(difference(far, b.samples()), 0.5 * difference(near, far))
        for button in b.all('#pull-buttons [data-format]'):
            name = button.get_attribute('data-format')
            button.click()
            data = self.downloaded('.' + name)
            self.assertGreater(len(data), 10000, name)
            at, magic = {'gif': (0, b'GIF89a'), 'apng': (0, b'\x89PNG'), 'mp4': (4, b'ftyp'),
                         'webm': (0, b'\x1aE\xdf\xa3')}[name]
            self.assertEqual(data[at:at + len(magic)], magic)

    def test_saving(self):
        b = self.browser
        self.open()
        b.tap(*FACE)
        b.rest()
        for name, ending, magic in (('jpeg', '.jpg', b'\xff\xd8\xff'), ('png', '.png', b'\x89PNG'),
                                    ('settings', '.json', b'{'), ('depth', '.png', b'\x89PNG')):
            b.click('save')
            b.click('save-' + name)
            data = self.downloaded(ending)
            self.assertEqual(data[:len(magic)], magic, name)
            if name == 'jpeg':  # it is editable: the depth is in it
                self.assertIn(b'GDepth', data)
            if name == 'settings':
                self.assertGreater(json.loads(data)['focus'], 0.3)

    def test_link(self):
        b = self.browser
        self.open()
        b.tap(*WALL)
        picture = b.samples()
        focus = b.find('focus').get_attribute('value')
        b.until(lambda: 'focus=' in b.driver.current_url, 'link')
        fragment = b.driver.current_url.split('#')[1]
        self.load('#' + fragment)
        b.until(lambda: b.text('name') == 'deep.jpg', 'photo of the link')
        b.rest()
        self.assertEqual(b.find('focus').get_attribute('value'), focus)
        b.run('document.activeElement.blur()')
        b.tap(*WALL)  # the mark is drawn again
        self.assertLess(difference(picture, b.samples()), 1)

    # Needs that everybody has

    def walk(self):
        """Tab through the page; returns what was met."""
        b, met = self.browser, []
        for _ in range(80):
            b.press(browser.Keys.TAB)
            at = b.run(audit.FOCUS)
            if at is None:
                continue
            if any(at['what'] == one['what'] for one in met):
                break
            self.assertTrue(at['shows'], at['what'] + ' does not show that it has the focus')
            met.append(at)
        return met

    def test_keys_alone(self):
        b, keys = self.browser, browser.Keys
        deep = self.card('deep.jpg')
        b.until(lambda: 'depth' in deep.text, 'marks')
        for _ in range(10):
            b.press(keys.TAB)
            if 'deep.jpg' in b.run(audit.FOCUS)['what']:
                break
        b.press(keys.ENTER)
        b.until(lambda: b.text('name') == 'deep.jpg', 'open by Enter')
        picture = b.samples()
        self.assertEqual(b.run(audit.FOCUS)['id'], 'stage')
        b.press(*[keys.ARROW_RIGHT] * 3, keys.ENTER)
        picture = self.changes(picture, 'focus by Enter')
        b.press('+', '+')
        picture = self.changes(picture, 'zoom by +', 1)
        b.press('0', 'b')
        b.until(lambda: b.seen('divider'), 'divider by b')
        b.press(keys.TAB)
        self.assertEqual(b.run(audit.FOCUS)['id'], 'divider')
        b.press(*[keys.ARROW_RIGHT] * 5)
        self.assertEqual(b.find('divider').get_attribute('aria-valuenow'), '60')
        while b.run(audit.FOCUS)['id'] != 'tab-adjust':
            b.press(keys.TAB)
        b.press(keys.TAB)
        self.assertEqual(b.run(audit.FOCUS)['id'], 'focus')
        b.press(keys.END)
        picture = self.changes(picture, 'focus by End')
        b.press_with(keys.SHIFT, keys.TAB)
        b.press(keys.ARROW_RIGHT, keys.ARROW_RIGHT)
        self.assertTrue(b.seen('paint'))
        b.run("document.getElementById('stage').focus()")
        b.press(keys.ENTER, *[keys.ARROW_RIGHT] * 4, *[keys.ARROW_DOWN] * 3, keys.ENTER)
        b.until(lambda: len(b.all('#strokes li')) == 1, 'stroke by keys')
        b.press_with(keys.CONTROL, 'z')
        b.until(lambda: b.all('#strokes .undone'), 'undo by keys')
        while b.run(audit.FOCUS)['id'] != 'save':
            b.press_with(keys.SHIFT, keys.TAB)
        b.press(keys.ENTER, keys.TAB, keys.TAB, keys.TAB, keys.ENTER)
        self.assertEqual(self.downloaded('.json')[:1], b'{')

    def test_tab_comes_to_everything(self):
        b = self.browser
        self.open()
        for tab in ('adjust', 'look', 'paint', 'pull'):
            self.tab(tab)
            if tab == 'pull':
                b.click('mark')
                b.click('mark')
            wanted = b.run(audit.TABBED)
            b.run('document.activeElement.blur()')
            met = {one['what'] for one in self.walk()}
            self.assertEqual([one for one in wanted if one not in met], [], tab)

    def test_screens(self):
        b = self.browser
        for name, (width, height, touch, scale) in SCREENS.items():
            for dark in (False, True):
                b.screen(width, height, dark, touch, scale)
                self.load()
                card = self.card('flat.jpg')
                b.until(lambda: 'no depth' in card.text, 'marks')
                self.complete(name, dark, 'open')
                self.open()
                self.complete(name, dark, 'adjust')
                b.click('compare')
                self.tab('look')
                b.rest()
                time.sleep(0.6)
                self.complete(name, dark, 'look')
                b.click('compare')
                self.tab('paint')
                self.complete(name, dark, 'paint')
                self.tab('pull')
                b.click('mark')
                b.click('mark')
                self.complete(name, dark, 'pull')
                b.click('save')
                self.complete(name, dark, 'save')

    def complete(self, screen, dark, part):
        """All checks of the page as it is seen now."""
        shade = 'dark' if dark else 'light'
        self.browser.rest() if part != 'open' else None
        self.assertEqual(audit.all_of_them(self.browser), [], (screen, shade, part))
        if SHOTS:
            self.browser.driver.save_screenshot(
                os.path.join(SHOTS, '%s-%s-%s.png' % (screen, shade, part)))


if __name__ == '__main__':
    if browser.missing():
        print('SKIPPED: ' + browser.missing())
        sys.exit(77)
    unittest.main()
