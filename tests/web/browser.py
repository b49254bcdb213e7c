"""A headless Chromium, by Selenium, that is shown the page of `refocus serve`. Raises SkipTest
where one of them is missing."""
import os
import shutil
import sys
import time
import unittest

# Debian has Selenium for its own Python.
DEBIAN = '/usr/lib/python3/dist-packages'
try:
    import selenium  # noqa: F401
except ImportError:
    sys.path.append(DEBIAN)
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = None

SLOW = float(os.environ.get('REFOCUS_SLOW', '1'))

# The picture as it is on the screen, small: its samples in one list.
SAMPLES = '''
const from = document.getElementById('canvas'), to = document.createElement('canvas');
to.width = 96; to.height = 72;
const c = to.getContext('2d', { willReadFrequently: true });
c.imageSmoothingQuality = 'high';
c.drawImage(from, 0, 0, 96, 72);
return [...c.getImageData(0, 0, 96, 72).data].filter((_, i) => i % 4 < 3);
'''

# The mean difference of neighbouring pixels of the screen, in a part of the stage.
SHARPNESS = '''
const canvas = document.getElementById('canvas'), [from, to, top, bottom] = arguments;
const x = Math.round(from * canvas.width), width = Math.round((to - from) * canvas.width);
const y = Math.round(top * canvas.height), height = Math.round((bottom - top) * canvas.height);
const copy = new OffscreenCanvas(width, height);
const c = copy.getContext('2d', { willReadFrequently: true });
c.drawImage(canvas, -x, -y);
const { data } = c.getImageData(0, 0, width, height);
let sum = 0;
for (let i = 4; i < data.length; i += 4)
    sum += Math.abs(data[i] - data[i - 4]);
return sum / (width * height);
'''


def missing():
    """A sentence about a part that is not there, or None."""
    if webdriver is None:
        return 'python3-selenium is not installed'
    for program in ('chromium', 'chromedriver'):
        if not shutil.which(program):
            return '%s is not installed' % program
    return None


class Browser:
    def __init__(self, downloads, width=1280, height=800):
        options = Options()
        options.binary_location = shutil.which('chromium')
        for argument in ('--headless=new', '--no-sandbox', '--disable-gpu', '--no-first-run',
                         '--disable-dev-shm-usage',
                         '--disable-background-networking', '--disable-component-update',
                         '--window-size=%d,%d' % (width, height)):
            options.add_argument(argument)
        options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
        self.driver = webdriver.Chrome(service=Service(shutil.which('chromedriver')),
                                       options=options)
        self.driver.set_script_timeout(60 * SLOW)
        self.command('Browser.setDownloadBehavior', behavior='allow', downloadPath=downloads)
        self.screen(width, height)

    def command(self, name, **values):
        return self.driver.execute_cdp_cmd(name, values)

    def screen(self, width, height, dark=False, touch=False, scale=1):
        self.command('Emulation.setDeviceMetricsOverride', width=width, height=height,
                     deviceScaleFactor=scale, mobile=touch)
        self.command('Emulation.setTouchEmulationEnabled', enabled=touch, maxTouchPoints=5)
        self.command('Emulation.setEmulatedMedia', features=[
            {'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}])

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, happened, what, seconds=30):
        end = time.monotonic() + seconds * SLOW
        while time.monotonic() < end:
            result = happened()
            if result:
                return result
            time.sleep(0.05)
        raise AssertionError('no %s; the page says: %s' % (what, self.text('said')))

    def find(self, name):
        return self.driver.find_element(By.ID, name)

    def all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def text(self, name):
        return self.run('return document.getElementById(arguments[0]).textContent', name)

    def seen(self, name):
        return self.find(name).is_displayed()

    def click(self, name):
        self.find(name).click()

    def pick(self, group, value):
        """Choose one of the radio buttons that look like chips or cards."""
        self.run('''document.querySelector(`#${arguments[0]} input[value="${arguments[1]}"]`)
            .parentElement.click()''', group, value)

    def press(self, *keys):
        ActionChains(self.driver).send_keys(*keys).perform()

    def press_with(self, modifier, key):
        ActionChains(self.driver).key_down(modifier).send_keys(key).key_up(modifier).perform()

    def at(self, x, y):
        """Offsets of a place of the photo, from 0 to 1, from the middle of the stage; the photo
        is fitted into it."""
        width, height, photo_width, photo_height = self.run('''
            const { clientWidth, clientHeight } = document.getElementById('stage');
            return [clientWidth, clientHeight, arguments[0], arguments[1]];''', *self.photo)
        scale = min(width / photo_width, height / photo_height)
        return round((x - 0.5) * photo_width * scale), round((y - 0.5) * photo_height * scale)

    photo = (720, 540)

    def tap(self, x, y):
        ActionChains(self.driver).move_to_element_with_offset(
            self.find('canvas'), *self.at(x, y)).click().perform()

    def drag(self, points):
        """Press at the first place of the photo, move over the others, release at the last."""
        chain = ActionChains(self.driver, duration=50)
        canvas = self.find('canvas')
        chain.move_to_element_with_offset(canvas, *self.at(*points[0])).click_and_hold()
        for point in points[1:]:
            chain.move_to_element_with_offset(canvas, *self.at(*point))
        chain.release().move_to_element(self.find('said')).perform()

    def rest(self):
        """Wait until nothing more is asked of the server for the picture."""
        time.sleep(0.1)
        self.until(lambda: self.find('stage').get_attribute('aria-busy') == 'false',
                   'picture at rest')
        self.run('return new Promise((done) => requestAnimationFrame(() => '
                 'requestAnimationFrame(done)))')

    def samples(self):
        """The picture at rest."""
        self.rest()
        return self.run(SAMPLES)

    def sharpness(self, left, right, top=0.2, bottom=0.8):
        self.rest()
        return self.run(SHARPNESS, left, right, top, bottom)

    def errors(self):
        """Lines of the console that are errors or warnings, since the last call."""
        return [line['message'] for line in self.driver.get_log('browser')
                if line['level'] in ('SEVERE', 'WARNING')]

    def requests(self):
        """Addresses that the page has asked for."""
        return self.run("return performance.getEntries().map((one) => one.name)"
                        ".filter((name) => /^[a-z]+:/.test(name))")

    def quit(self):
        self.driver.quit()


def difference(a, b):
    """Mean difference of two pictures' samples."""
    return sum(abs(x - y) for x, y in zip(a, b)) / len(a)


def need():
    reason = missing()
    if reason:
        raise unittest.SkipTest(reason)
