#!/usr/bin/env python3
"""usage: test_page_parts.py REFOCUS  -- what one part of the page of refocus serve does to another.

Exit status 77, after saying so, where Chromium, its driver or Selenium is missing."""
import os
import shutil
import sys
import unittest

import browser
from browser import difference
from page import Page, SCENE, refocus


class Parts(Page):
    def strokes(self, count):
        b = self.browser
        b.until(lambda: len(b.all('#strokes li')) == count, '%d strokes' % count)

    def slide(self, name, value):
        """Put a slider somewhere, 0 to 1000; returns what it says."""
        self.browser.run('''const slider = document.getElementById(arguments[0]);
            slider.value = arguments[1];
            slider.dispatchEvent(new Event('input', { bubbles: true }));''', name, value)
        self.browser.rest()
        return self.browser.find(name).get_attribute('aria-valuetext')

    def test_focus_follows_what_is_painted(self):
        """The slider goes over the depth there is now: it stayed at 0 %."""
        b = self.browser
        self.open('flat.jpg')
        b.drag([(0.5, 0.98), (0.5, 0.3)])  # from 80 % to 20 %
        self.strokes(1)
        self.tab('adjust')
        self.assertEqual([self.slide('focus', value) for value in (1000, 500, 0)],
                         ['80 %', '50 %', '20 %'])
        self.tab('paint')
        b.pick('brushes', 'object')
        self.slide('depth-from', 1000)
        b.drag([(0.5, 0.5), (0.6, 0.5)])
        self.strokes(2)
        self.tab('adjust')
        self.assertEqual(self.slide('focus', 1000), '100 %')
        self.tab('paint')
        b.click('undo')
        b.until(lambda: b.all('#strokes .undone'), 'undo')
        self.tab('adjust')
        self.assertEqual(self.slide('focus', 999), '80 %')

    def test_strokes_of_one_name(self):
        """What was painted on one `image.jpg` comes again on that one, and on no other."""
        b = self.browser
        paths = []
        for name, blur in ('a', '0'), ('b', '30'):
            os.mkdir(os.path.join(self.folder, name))
            paths.append(os.path.join(self.folder, name, 'image.jpg'))
            refocus('render', SCENE + 'allfocus.png', '--depth', SCENE + 'disparity.png', '--blur',
                    blur, '--strip', '-o', paths[-1])
        for i, path in enumerate((paths[0], paths[1], paths[0])):
            b.run("document.getElementById('name').textContent = ''")
            self.send(path)
            b.until(lambda: b.text('name') == 'image.jpg', 'photo that was sent')
            if i == 2:
                b.until(lambda: 'are there again' in b.text('said'), 'line')
            b.rest()
            self.assertEqual(len(b.all('#strokes li')), i // 2, i)
            if i == 0:
                b.drag([(0.5, 0.98), (0.5, 0.3)])
                self.strokes(1)

    def test_a_stroke_that_is_left(self):
        """Put down by keys, the brush leaves nothing behind when another tab or photo is opened."""
        b, keys = self.browser, browser.Keys
        self.open()
        b.pick('views', 'depth')
        depth = b.samples()

        def begin():
            self.tab('paint')
            b.pick('brushes', 'object')
            b.run("document.getElementById('stage').focus()")
            b.press(keys.ENTER, *[keys.ARROW_LEFT] * 4)
            self.changes(depth, 'the unfinished stroke', 0.5)
        begin()
        self.tab('adjust')
        b.run("document.getElementById('stage').focus()")
        b.press(keys.ESCAPE)  # the cross goes
        b.until(lambda: difference(depth, b.samples()) == 0, 'depth as before')
        begin()
        b.click('open')
        self.open('flat.jpg')
        b.run("document.getElementById('stage').focus()")
        b.press(keys.ENTER)
        self.assertEqual(b.text('said'), 'Brush down.')
        b.rest()
        self.assertEqual(b.all('#strokes li'), [])

    def test_steps_before_the_last_one_is_done(self):
        """A stroke in the list that is clicked twice is gone to once; keys go no farther than all."""
        b = self.browser
        self.open('flat.jpg')
        for i in range(4):
            b.drag([(0.2 + 0.1 * i, 0.98), (0.5, 0.3)])
            self.strokes(i + 1)

        def undone():
            b.rest()
            return len(b.all('#strokes .undone'))
        b.run("""const stroke = document.querySelectorAll('#strokes button')[2];
            stroke.click();
            stroke.click();""")
        self.assertEqual(undone(), 1)
        b.run("""for (let i = 0; i < 5; i++)
            dispatchEvent(new KeyboardEvent('keydown', { key: 'z', ctrlKey: true }));""")
        self.assertEqual(undone(), 4)
        self.assertEqual(b.text('said'), 'Undone.')
        b.run("""document.getElementById('redo').click();
            document.getElementById('redo').click();""")
        self.assertEqual(undone(), 2)

    def test_the_longest_film(self):
        """What it may take is told when key frames are set, not when it is saved."""
        b = self.browser
        self.open()
        b.rest()
        self.tab('pull')

        def seconds(value):
            """Set those to the second key frame; returns what they become, and what is said."""
            return b.run('''const wait = document.querySelector('#keys input');
                wait.value = arguments[0];
                wait.dispatchEvent(new Event('change'));
                return [wait.value, document.getElementById('said').textContent];''', value)
        b.click('mark')
        b.click('mark')
        self.assertEqual(seconds(7), ['7', 'Key frame 2 marked.'])
        self.assertEqual(seconds(25), ['20', 'A rack focus takes 20 seconds at the most.'])
        b.click('mark')
        self.assertEqual(len(b.all('#keys li')), 2)
        seconds(19.3)
        b.click('mark')
        self.assertEqual([one.get_attribute('value') for one in b.all('#keys input')],
                         ['19.3', '0.7'])

    def test_key_frames_of_each_view(self):
        """A focus can be marked while the depth is looked at, with its picture."""
        b = self.browser
        self.open()
        for view in ('depth', 'blur', 'peaking', 'picture'):
            b.pick('views', view)
            b.rest()
            self.tab('pull')
            b.click('mark')
        self.assertEqual(len(b.all('#keys li')), 4)
        pictures = b.run("""return [...document.querySelectorAll('#keys canvas')]
            .map((one) => one.toDataURL())""")
        self.assertEqual(len(set(pictures)), 1)

    def test_links(self):
        """A link is followed in the open tab, too; a photo that was sent has none."""
        b = self.browser
        self.open()
        b.rest()
        self.assertEqual(b.find('copy-link').get_property('hidden'), False)
        b.driver.get(self.address + '#photo=flat.jpg&blur=5')
        b.until(lambda: b.text('name') == 'flat.jpg', 'photo of the link')
        b.rest()
        self.assertEqual(b.find('blur').get_attribute('aria-valuetext'), '5 px')
        b.click('open')
        self.send(os.path.join(self.folder, 'elsewhere.jpg'))
        b.until(lambda: b.text('name') == 'elsewhere.jpg', 'photo that was sent')
        self.assertEqual(b.find('copy-link').get_property('hidden'), True)
        b.until(lambda: b.driver.current_url == self.address, 'address without the photo')
        self.allowed = ('status of 404', )
        b.driver.get(self.address + '#photo=nothing.jpg')
        b.until(lambda: 'no such photo' in b.text('said'), 'line')

    def test_opening_another_before_the_first_is_open(self):
        """A photo that is being opened says so; one that is being sent is given up."""
        b = self.browser
        flat, deep = self.card('flat.jpg'), self.card('deep.jpg')
        b.run('''const ask = window.fetch;
            window.fetch = async (address, ...more) => {
                if (/^(open|upload)[?]/.test(address))
                    await new Promise((release, refuse) => {
                        window.release = release;
                        more[0].signal?.addEventListener('abort', () => refuse(more[0].signal.reason));
                    });
                return ask(address, ...more);
            };''')
        flat.click()
        deep.click()
        self.assertEqual(b.text('said'), 'flat.jpg is still being opened.')
        b.run('window.release()')
        b.until(lambda: b.text('name') == 'flat.jpg', 'the first one')
        b.click('open')
        self.send(os.path.join(self.folder, 'elsewhere.jpg'))
        b.until(lambda: b.text('said').startswith('Sending elsewhere.jpg'), 'line')
        b.click('back')
        self.assertEqual(b.text('said'), 'elsewhere.jpg is not sent any more.')
        b.click('open')
        self.send(os.path.join(self.folder, 'elsewhere.jpg'))
        b.until(lambda: b.text('said').startswith('Sending elsewhere.jpg'), 'line')
        self.card('deep.jpg').click()
        b.run('window.release()')
        b.until(lambda: b.text('name') == 'deep.jpg', 'the other one')
        b.rest()

    def test_names_that_cannot_be_shown(self):
        """Files of the folder are counted; what is sent gets another name."""
        b = self.browser
        left = os.path.join(self.photos, 'a\\b.jpg')
        shutil.copy(os.path.join(self.photos, 'flat.jpg'), left)
        self.addCleanup(os.remove, left)
        self.load()
        self.card('deep.jpg')
        self.assertTrue(b.seen('unnamed'))
        self.assertIn(': 1.', b.text('unnamed'))
        for name, shown in ('.hidden.jpg', 'hidden.jpg'), ('back\\slash.jpg', 'back_slash.jpg'):
            path = os.path.join(self.folder, name)
            shutil.copy(os.path.join(self.photos, 'flat.jpg'), path)
            self.send(path)
            b.until(lambda: b.text('name') == shown, shown)
            b.click('open')

    def metric(self):
        """Send a photo whose depth is in metres."""
        path = os.path.join(self.folder, 'metric.jpg')
        refocus('depth', os.path.join(self.photos, 'flat.jpg'), '--depth', SCENE + 'disparity.png',
                '--near', '1', '--far', '8', '-o', path)
        self.send(path)
        self.browser.until(lambda: self.browser.text('name') == 'metric.jpg', 'photo with metres')

    def test_rack_focus_moves_the_aperture(self):
        b = self.browser
        self.metric()
        for aperture in (1000, 0):
            self.tab('adjust')
            self.slide('aperture', aperture)
            self.tab('pull')
            b.click('mark')
        moments = []
        for moment in (0, 500, 1000):
            self.slide('moment', moment)
            moments.append(b.samples())
        self.assertGreater(difference(moments[0], moments[1]), 0.5)
        self.assertGreater(difference(moments[1], moments[2]), 0.5)
        b.all('#keys .card')[0].click()
        self.assertEqual(difference(moments[0], b.samples()), 0)
        b.run("document.querySelector('[data-format=apng]').click()")
        b.until(lambda: b.text('said').startswith('Saved'), 'film')
        self.downloaded('.apng')


if __name__ == '__main__':
    if browser.missing():
        print('SKIPPED: ' + browser.missing())
        sys.exit(77)
    unittest.main()
