#!/usr/bin/env python3
"""usage: test_page.py REFOCUS  -- what a person does on the page of refocus serve, in a headless Chromium.

Exit status 77, after saying so, where Chromium, its driver or Selenium is missing."""
import base64
import json
import math
import os
import subprocess
import sys
import time
import unittest

import browser
from browser import SLOW, difference
from page import Page, REFOCUS, SHOTS, FACE, WALL


class Use(Page):
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
        self.assertIn('refocus depth PHOTO --depth MAP -o NEW.jpg', b.text('opening'))
        self.assertFalse(b.seen('canvas'))
        b.click('back')
        self.assertEqual(difference(picture, b.samples()), 0)

    def test_a_photo_from_elsewhere(self):
        b = self.browser
        self.card('deep.jpg')
        self.send(os.path.join(self.folder, 'elsewhere.jpg'))
        b.until(lambda: b.text('name') == 'elsewhere.jpg', 'upload')
        self.assertGreater(max(b.samples()), 100)

    def test_what_is_no_photo(self):
        b = self.browser
        path = os.path.join(self.folder, 'junk.jpg')
        with open(path, 'w') as file:
            file.write('no photo')
        self.allowed = ('status of 4', )  # Chromium reports what the server refuses
        self.card('deep.jpg')
        self.send(path)
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
        b.click('open')
        self.send(os.path.join(self.folder, 'elsewhere.jpg'))
        b.until(lambda: 'before all of elsewhere.jpg was sent' in b.text('said'), 'line of it')
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
        self.close_session()
        b.pick('views', 'blur')
        b.until(lambda: 'as it was' in b.text('said'), 'opening again')
        b.pick('views', 'depth')
        self.assertEqual(difference(depth, b.samples()), 0)

    def test_strokes_outlive_the_page(self):
        """Painting is not lost by loading anew, by leaving, and by opening another photo."""
        b = self.browser
        self.open('flat.jpg')
        b.drag([(0.5, 0.98), (0.5, 0.3)])
        b.until(lambda: len(b.all('#strokes li')) == 1, 'ground')
        b.pick('brushes', 'object')
        b.drag([(0.45, 0.4), (0.5, 0.45), (0.55, 0.5), (0.5, 0.6)])
        b.until(lambda: len(b.all('#strokes li')) == 2, 'object')
        b.click('undo')
        b.until(lambda: b.all('#strokes .undone'), 'undo')
        b.pick('views', 'depth')
        depth = b.samples()
        for step in 'anew', 'left', 'another':
            if step == 'anew':
                b.driver.refresh()
            elif step == 'left':
                self.load()
            else:
                b.click('open')
                self.open('deep.jpg')
                b.click('open')
            if step != 'anew':  # the link has the photo
                self.open('flat.jpg')
            b.until(lambda: len(b.all('#strokes li')) == 1, 'strokes that come again')
            b.pick('views', 'depth')
            self.assertEqual(difference(depth, b.samples()), 0)
        b.click('undo')
        b.until(lambda: b.find('undo').get_property('disabled'), 'undo of what came again')

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

    def fingers(self, kind, *places):
        self.browser.command('Input.dispatchTouchEvent', type=kind, touchPoints=[
            {'x': x, 'y': y, 'id': i} for i, (x, y) in enumerate(places)])

    def two_fingers(self, *pairs):
        """Two fingers come down at the first pair of places and move over the others."""
        self.fingers('touchStart', pairs[0][0])
        self.fingers('touchStart', *pairs[0])
        for pair in pairs[1:]:
            self.fingers('touchMove', *pair)
            time.sleep(0.05)
        self.fingers('touchEnd')

    def value(self, slider):
        return int(self.browser.find(slider).get_attribute('aria-valuetext').rstrip('°'))

    def test_two_fingers_tilt(self):
        b = self.browser
        b.screen(390, 844, touch=True)
        level = self.open()
        self.assertFalse(b.seen('turn'))
        # Up, side by side, in steps as large as those of a quick hand.
        self.two_fingers(*[((150, 320 - y), (230, 320 - y)) for y in (0, 9, 25, 60, 90)])
        tilted = self.changes(level, 'tilt')
        tilt = self.value('tilt')
        self.assertGreater(tilt, 5)
        b.until(lambda: 'tilt-angle=%d' % tilt in b.driver.current_url, 'tilt in the link')
        self.assertEqual(self.value('turn'), 0)
        # Turned about each other by 40 degrees.
        self.two_fingers(*[[(190 + r * math.cos(angle), 260 + r * math.sin(angle))
                            for r in (-60, 60)] for angle in (0, 0.1, 0.25, 0.4, 0.55, 0.698)])
        turned = self.changes(tilted, 'turn')
        self.assertAlmostEqual(self.value('turn'), 40, delta=2)
        self.assertEqual(self.value('tilt'), tilt)
        # A pinch neither tilts nor turns, and nothing else zooms.
        self.two_fingers(*[((190 - x, 260 - x / 4), (190 + x, 260 + x / 4))
                           for x in (20, 40, 60, 90)])
        self.changes(turned, 'pinch', 1)
        self.assertEqual((self.value('tilt'), self.value('turn')), (tilt, 40))
        self.two_fingers(*[((150, 320 - y), (230, 320 - y)) for y in (0, 30, 60)])
        self.assertEqual(self.value('tilt'), tilt, 'what is zoomed is moved')

    def test_two_fingers(self):
        b = self.browser
        b.screen(390, 844, touch=True)
        fitted = self.open()
        fingers = self.fingers
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
            canvas, *b.at(0.5, 0.4)).click_and_hold().move_by_offset(60, 40).perform()
        self.assertGreater(difference(picture, b.run(browser.SAMPLES)), 0.1)

        def changed():
            """The part of the stage that looks different from before."""
            now = b.run(browser.SAMPLES)
            return 3 * sum(picture[i:i + 3] != now[i:i + 3]
                           for i in range(0, len(now), 3)) / len(now)
        width, height = b.find('canvas').size['width'], b.find('canvas').size['height']
        path = (math.hypot(60, 40) * 40 + math.pi * 20 ** 2) / (width * height)
        b.until(lambda: changed() > 1.2 * path, 'selection')
        if SHOTS:
            b.driver.save_screenshot(os.path.join(SHOTS, 'desktop-selection.png'))
        browser.ActionChains(b.driver).move_by_offset(20, 20).release().perform()
        b.until(lambda: len(b.all('#strokes li')) == 1, 'stroke')

    def test_a_line_changes_the_picture_under_the_finger(self):
        b = self.browser
        self.open('flat.jpg')
        b.pick('views', 'depth')
        flat = b.samples()
        actions = browser.ActionChains(b.driver, duration=50)
        actions.move_to_element_with_offset(b.find('canvas'), *b.at(0.5, 0.98)).click_and_hold()
        actions.move_by_offset(0, -200).perform()
        b.until(lambda: difference(flat, b.run(browser.SAMPLES)) > 20, 'depth')
        self.assertEqual(b.all('#strokes li'), [])
        # A second finger, or a cross that is taken away, ends it without a stroke.
        b.press(browser.Keys.ESCAPE)
        b.until(lambda: difference(flat, b.run(browser.SAMPLES)) < 0.1, 'depth as before')
        browser.ActionChains(b.driver).release().perform()
        self.assertEqual(b.all('#strokes li'), [])

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


if __name__ == '__main__':
    if browser.missing():
        print('SKIPPED: ' + browser.missing())
        sys.exit(77)
    unittest.main()
