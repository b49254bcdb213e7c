#!/usr/bin/env python3
"""usage: test_page_ends.py REFOCUS  -- what the page of refocus serve does when a session, its process or the
server ends.

Exit status 77, after saying so, where Chromium, its driver or Selenium is missing."""
import os
import signal
import subprocess
import sys
import time
import unittest
from urllib.parse import urlsplit

import browser
from browser import SLOW, difference
from page import Page, REFOCUS, WALL

# Full pictures are asked for once `release` is called.
HOLD = '''
const ask = window.fetch;
window.held = [];
window.fetch = async (address, ...more) => {
    if (/^picture\\?/.test(address) && !address.includes('quick=1'))
        await new Promise((release) => window.held.push(release));
    return ask(address, ...more);
};
'''


class Ends(Page):
    def children(self):
        with open('/proc/%d/task/%d/children' % (self.server.pid, self.server.pid)) as file:
            return [int(pid) for pid in file.read().split()]

    def kill_at_full_picture(self):
        """The process of the photo ends while it works on a full picture, as for want of memory."""
        b = self.browser
        b.until(lambda: b.run('return window.held.length > 0'), 'full picture')
        for pid in self.children():
            os.kill(pid, signal.SIGSTOP)
        b.run('window.held.splice(0).forEach((release) => release())')
        time.sleep(0.5 * SLOW)
        for pid in self.children():
            os.kill(pid, signal.SIGKILL)

    def test_full_pictures_that_fail(self):
        """They are given up after the second time: the photo was opened again and again."""
        b = self.browser
        self.allowed = ('status of', )  # Chromium reports what the server refuses
        self.open()
        b.run(HOLD)
        b.tap(*WALL)
        self.kill_at_full_picture()
        b.until(lambda: 'as it was' in b.text('said'), 'photo that is open again')
        self.kill_at_full_picture()
        b.until(lambda: 'quick pictures alone' in b.text('said'), 'line that says why')
        before = b.samples()
        b.find('blur').send_keys(browser.Keys.END)
        blurred = b.samples()
        self.assertGreater(difference(before, blurred), 0.05)
        b.click('compare')
        self.assertGreater(difference(blurred, b.samples()), 0.05)
        self.assertEqual(b.run('return window.held.length'), 0)
        # Opened anew, it is tried again.
        b.click('open')
        self.card('deep.jpg').click()
        b.until(lambda: b.run('return window.held.length > 0'), 'full picture')
        b.run('window.held.splice(0).forEach((release) => release())')
        b.rest()

    def test_key_frames_outlive_the_session(self):
        b = self.browser
        self.allowed = ('status of 4', )
        self.open()
        self.tab('pull')
        b.click('mark')
        b.tap(*WALL)
        b.rest()
        b.click('mark')
        self.close_session()
        b.pick('views', 'blur')
        b.until(lambda: 'as it was' in b.text('said'), 'photo that is open again')
        self.assertEqual(len(b.all('#keys li')), 2)
        self.assertTrue(b.seen('play'))
        b.click('open')
        self.open('flat.jpg')
        self.assertEqual(len(b.all('#keys li')), 0)

    def test_saving_when_the_session_has_ended(self):
        """What is saved is asked for again: a photo was opened, and nothing came."""
        b = self.browser
        self.allowed = ('status of 4', )
        self.open()
        b.tap(*WALL)
        b.rest()
        b.click('save')
        b.click('save-png')
        whole = self.downloaded('.png')
        self.close_session()
        b.click('save')
        b.click('save-png')
        self.assertTrue(self.downloaded('.png') == whole)
        self.assertIn('Saved', b.text('said'))
        self.tab('pull')
        b.click('mark')
        b.click('mark')
        b.rest()
        self.close_session()
        b.run("document.querySelector('[data-format=apng]').click()")
        self.assertGreater(len(self.downloaded('.apng')), 10000)

    def test_a_server_that_was_started_anew(self):
        """Its old link leads nowhere, which the page took for controls that the server lacks."""
        b = self.browser
        self.allowed = ('status of 404', )

        def start(port):
            server = subprocess.Popen([REFOCUS, 'serve', self.photos, '--port', port],
                                      stdout=subprocess.PIPE, text=True)
            self.addCleanup(server.stdout.close)
            self.addCleanup(server.wait, 30 * SLOW)
            self.addCleanup(server.terminate)
            return server, server.stdout.readline().strip()
        server, self.address = start('0')
        self.load()
        self.open()
        server.terminate()
        server.wait(30 * SLOW)
        start(str(urlsplit(self.address).port))
        b.pick('views', 'depth')
        b.until(lambda: 'started anew' in b.text('said'), 'line that says so')
        b.click('save')
        b.click('save-png')
        b.until(lambda: 'Saving' not in b.text('said'), 'answer')
        self.assertIn('started anew', b.text('said'))
        b.click('save')
        self.assertTrue(b.seen('save-png'))
        self.assertEqual(len([one for one in b.all('#views label') if one.is_displayed()]), 4)
        del self.address
        self.load()


if __name__ == '__main__':
    if browser.missing():
        print('SKIPPED: ' + browser.missing())
        sys.exit(77)
    unittest.main()
