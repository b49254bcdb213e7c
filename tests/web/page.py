"""The page of `refocus serve` for tests: photos, a server and a headless Chromium."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

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
        b.run('sessionStorage.clear()')  # what other tests painted

    def tearDown(self):
        asked = self.browser.requests()
        sessions = [found.group() for found in map(re.compile('session=[0-9a-f]+').search, asked)
                    if found]
        # what was on its way to a photo that the page has left since
        left = tuple(f'{session}&' for session in sessions if session != sessions[-1])
        errors = [line for line in self.browser.errors()
                  if not any(word in line for word in self.allowed)
                  and not ('410 (Gone)' in line and
                           any(session in line.replace(' ', '&') for session in left))]
        self.assertEqual(errors, [])
        origin = re.match(r'http://[^/]+/', self.address).group()
        for name in asked:
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

    def send(self, path):
        """Send a file of the device."""
        self.browser.run("document.getElementById('file').hidden = false")
        self.browser.find('file').send_keys(path)

    def close_session(self):
        """The session ends behind the page's back."""
        self.browser.run("""const name = performance.getEntriesByType('resource')
                .findLast((one) => /[/](picture|overlay)[?]/.test(one.name)).name;
            return fetch(name.replace(/[/](picture|overlay)[?]/, '/close?'), { method: 'POST' })
                .then((answer) => answer.text())""")

    def tab(self, name):
        self.browser.click('tab-' + name)

    def changes(self, before, what, least=0.05):
        """The picture becomes another one; returns it."""
        self.browser.until(lambda: difference(before, self.browser.samples()) > least, what)
        return self.browser.samples()

    def downloaded(self, ending):
        def find():
            return [name for name in os.listdir(self.saved) if name.endswith(ending)]
        name = self.browser.until(find, 'file ' + ending, 60)[0]
        path = os.path.join(self.saved, name)
        with open(path, 'rb') as file:
            data = file.read()
        os.remove(path)
        return data
