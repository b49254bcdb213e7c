#!/usr/bin/env python3
"""usage: test_page_access.py REFOCUS  -- the page of refocus serve with a camera, by keys alone, and on each
screen.

Exit status 77, after saying so, where Chromium, its driver or Selenium is missing. With
REFOCUS_PAGE_SHOTS=FOLDER screenshots of all sizes are kept there."""
import os
import subprocess
import sys
import time
import unittest

import audit
import browser
from browser import SLOW, difference
from page import Page, REFOCUS, SCENE, SHOTS, SCREENS, FACE, WALL


class Access(Page):
    def test_live(self):
        b = self.browser
        server = subprocess.Popen(
            [REFOCUS, 'serve', '--port', '0', '--live', 'file:%sallfocus.png' % SCENE, '--depth',
             SCENE + 'disparity.png'], stdout=subprocess.PIPE, text=True)
        self.address = server.stdout.readline().strip()
        self.load()
        b.until(lambda: b.text('name') == 'Live view', 'live view')

        def frames():
            """Until frames have come that were asked for after this."""
            count = lambda: len([name for name in b.requests() if '/frame?' in name])
            before = count()
            b.run('performance.clearResourceTimings()')
            b.until(lambda: count() >= 3, 'frames, after %d' % before)
            return b.run(browser.SAMPLES)
        first = frames()
        self.assertGreater(max(first) - min(first), 100)
        # Settings that are refused stop it until there are others.
        self.allowed = ('status of 400', )
        self.load('#photo=live&blur=500')
        b.until(lambda: 'pixels' in b.text('said'), 'line that says what is wrong')
        b.click('reset')
        frames()
        self.assertTrue(b.text('said').startswith('Live: '), b.text('said'))
        b.tap(*FACE)
        b.until(lambda: b.text('said') == 'Focus set.', 'focus')
        near = frames()
        sharp = b.run(browser.SHARPNESS, 0.05, 0.3, 0.2, 0.8)
        b.tap(*WALL)
        b.until(lambda: b.run(browser.SHARPNESS, 0.05, 0.3, 0.2, 0.8) > 1.5 * sharp, 'wall in focus')
        b.find('blur').send_keys(browser.Keys.END)
        b.until(lambda: difference(near, b.run(browser.SAMPLES)) > 1, 'more blur')
        b.pick('views', 'depth')
        b.until(lambda: difference(near, b.run(browser.SAMPLES)) > 20, 'depth')
        b.pick('views', 'picture')
        for name in ('compare', 'save', 'tab-paint', 'tab-pull'):
            self.assertFalse(b.seen(name), name)
        self.assertEqual(audit.all_of_them(b), [])
        if SHOTS:
            b.driver.save_screenshot(os.path.join(SHOTS, 'desktop-live.png'))
        b.screen(390, 844, dark=True, touch=True, scale=3)
        frames()
        self.assertEqual(audit.all_of_them(b), [])
        if SHOTS:
            b.driver.save_screenshot(os.path.join(SHOTS, 'phone-live.png'))
        b.screen(1280, 800)
        b.click('capture')
        b.until(lambda: b.text('name').startswith('live-'), 'captured photo')
        self.assertEqual(b.find('tab-adjust').get_attribute('aria-selected'), 'true')  # with depth
        self.assertGreater(max(b.samples()), 100)
        self.assertTrue(b.seen('save'))
        b.click('open')
        b.click('live')
        b.until(lambda: b.text('name') == 'Live view', 'live view again')
        frames()
        del self.address
        self.load()
        server.terminate()
        self.assertEqual(server.wait(30 * SLOW), 0)
        server.stdout.close()

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

    def test_without_scripts(self):
        """The page says what it needs, and only then."""
        b = self.browser
        self.load()
        self.assertEqual(b.all('#unscripted'), [])
        b.command('Emulation.setScriptExecutionDisabled', value=True)
        try:
            b.driver.get(self.address)
            b.until(lambda: b.all('#unscripted') and 'JavaScript' in b.find('unscripted').text, 'sentence')
        finally:
            b.command('Emulation.setScriptExecutionDisabled', value=False)

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
