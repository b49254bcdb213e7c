#!/usr/bin/env python3
"""usage: test_lines.py PLUGIN_FOLDER [REFOCUS]  -- what users type: pipelines of gst-launch-1.0, with
the command REFOCUS beside them where there is one."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SCENE = TOP / 'examples/data/portrait'
EXAMPLES = TOP / 'examples/gstreamer'
DEPTH, NO_DEPTH = (shlex.quote(str(path)) for path in (SCENE / 'disparity.png', TOP / 'meson.build'))
PLUGINS = sys.argv.pop(1)
COMMAND = sys.argv.pop(1) if len(sys.argv) > 1 else None
SMALL = 'video/x-raw,width=96,height=64,framerate=25/1,format='
TIMEOUT = 60


class Lines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.environment = dict(os.environ, GST_PLUGIN_PATH=PLUGINS, LC_ALL='C',
                               GST_REGISTRY=os.path.join(cls.folder, 'registry'))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def run_words(self, words, **environment):
        done = subprocess.run(words, env=dict(self.environment, **environment), text=True,
                              timeout=TIMEOUT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout

    def launch(self, line, **environment):
        return self.run_words(['gst-launch-1.0', '-q', *shlex.split(line)], **environment)

    def passes(self, line, **environment):
        status, words = self.launch(line, **environment)
        self.assertEqual(status, 0, line + '\n' + words)
        return words

    def bytes_of(self, line):
        """What the one filesink of a line, OUT, writes."""
        path = os.path.join(self.folder, 'out')
        self.passes(line.replace('OUT', 'filesink location=' + path))
        return pathlib.Path(path).read_bytes()

    def test_formats(self):
        for form in 'NV12', 'YUY2', 'BGRx':
            self.passes(f'videotestsrc num-buffers=2 ! {SMALL}{form} ! refocus name=r ! fakesink '
                        f'videotestsrc num-buffers=2 pattern=ball ! {SMALL}GRAY16_LE ! r.depth')

    def test_ten_bits(self):
        """P010 in and out, with all that looks at frames: what is in focus comes out as it went in."""
        video = f'videotestsrc num-buffers=3 pattern=smpte75 ! {SMALL}P010_10LE,colorimetry=%s ! '
        depth = 'videotestsrc num-buffers=3 pattern=%s ! video/x-raw,format=GRAY16_LE,width=%d,height=%d,framerate=25/1 ! r.depth'
        for colour in 'bt709', 'bt2100-pq':
            frames = self.bytes_of(video % colour + 'OUT')
            self.assertEqual(len(frames), 3 * 96 * 64 * 3)
            for size in (96, 64), (33, 21), (200, 120):
                line = video % colour + 'refocus name=r blur=9 steady=0.5 %s ! OUT ' + depth
                self.assertTrue(frames == self.bytes_of(line % ('focus-x=0.5 focus-y=0.5', 'white', *size)), 'other bytes')
                blurred = self.bytes_of(line % ('focus=1 depth-edges=true', 'black', *size))
                self.assertEqual(len(blurred), len(frames))
                self.assertTrue(frames != blurred, 'nothing is blurred')

    def test_depth_of_other_sizes(self):
        """GRAY16 maps smaller and larger than frames, of another shape and rate."""
        for size in 'width=24,height=16', 'width=321,height=45', 'width=192,height=128':
            self.passes(f'videotestsrc num-buffers=3 ! {SMALL}NV12 ! refocus name=r steady=0.5 ! fakesink '
                        'videotestsrc num-buffers=3 pattern=ball ! '
                        f'video/x-raw,format=GRAY16_LE,{size},framerate=15/1 ! r.depth')

    def test_readme(self):
        """The line of the README, with pictures in place of cameras and no window."""
        text = (TOP / 'README.md').read_text(encoding='utf-8').replace('\\\n', ' ')
        line = re.search(r'^    gst-launch-1\.0 (.*)$', text, re.M)[1]
        for name, other in (('v4l2src device=/dev/video2',
                             'videotestsrc num-buffers=2 ! video/x-raw,format=GRAY16_LE'),
                            ('v4l2src', f'videotestsrc num-buffers=2 ! {SMALL}YUY2'),
                            ('autovideosink', 'fakesink')):
            self.assertIn(name, line)
            line = line.replace(name, other)
        self.passes(line)

    def test_same_bytes(self):
        """Depth of another size and rate: any run, any number of threads."""
        line = ('videotestsrc num-buffers=9 pattern=smpte ! %sI420 ! refocus name=r blur=8 threads=%d ! OUT '
                'videotestsrc num-buffers=4 pattern=ball motion=sweep ! '
                'video/x-raw,format=GRAY8,width=33,height=21,framerate=7/1 ! queue ! r.depth')
        first = self.bytes_of(line % (SMALL, 1))
        self.assertEqual(len(first), 9 * 96 * 64 * 3 // 2)
        self.assertEqual(first, self.bytes_of(line % (SMALL, 3)))

    def test_file_depth(self):
        path = os.path.join(self.folder, 'frames')
        self.passes(f'videotestsrc num-buffers=3 ! {SMALL}NV12 ! filesink location={path}')
        out = self.bytes_of(f'filesrc location={path} ! '
                            'rawvideoparse format=nv12 width=96 height=64 framerate=25/1 ! '
                            f'refocus depth-location={DEPTH} focus-x=0.5 focus-y=0.5 '
                            'near=0.9 far=20 f-number=2 steady=0.5 aperture=polygon:7 ! OUT')
        self.assertEqual(len(out), pathlib.Path(path).stat().st_size)
        self.assertNotEqual(out, pathlib.Path(path).read_bytes())

    def test_depth_on_its_side(self):
        """Depth of another shape is told of, once; the shape that frames are shown in is none."""
        for size, words in (('width=64,height=96', 1), ('width=96,height=64', 0),
                            ('width=64,height=96,pixel-aspect-ratio=2/1', 0)):
            line = (f'videotestsrc num-buffers=3 ! video/x-raw,format=NV12,{size} ! '
                    f'refocus name=r depth-location={DEPTH} ! fakesink')
            done = self.run_words(['gst-launch-1.0', *shlex.split(line)])
            self.assertEqual(done[0], 0, done[1])
            self.assertEqual(done[1].count('720x540 samples is stretched'), words, size + done[1])
        done = self.run_words(['gst-launch-1.0', *shlex.split(
            f'videotestsrc num-buffers=3 ! {SMALL}NV12 ! refocus name=r ! fakesink '
            'videotestsrc num-buffers=3 ! video/x-raw,format=GRAY8,width=64,height=96 ! r.depth')])
        self.assertEqual(done[1].count('64x96 samples is stretched'), 1, done[1])

    def test_far_is_infinity(self):
        """The range of a map may have no end; a number that is as good as that makes the same frames."""
        line = (f'videotestsrc num-buffers=2 ! {SMALL}NV12 ! refocus name=r depth-unit=mm near=0.5 far=%s '
                'f-number=2 focus-distance=2 ! OUT videotestsrc num-buffers=2 pattern=ball ! '
                f'{SMALL}GRAY16_LE ! r.depth')
        self.assertTrue(self.bytes_of(line % 'inf') == self.bytes_of(line % '1e300'), 'other bytes')

    def test_own_brightness_as_depth(self):
        self.passes(f'videotestsrc num-buffers=3 ! {SMALL}GRAY8 ! tee name=t ! queue ! '
                    'refocus name=r depth-edges=true ! fakesink t. ! queue ! r.depth')

    def test_converted_for_the_method(self):
        """Methods that render no Y, U and V make converters give R, G and B."""
        words = self.run_words(
            ['gst-launch-1.0', '-v', *shlex.split(
                f'videotestsrc num-buffers=1 ! {SMALL}NV12 ! videoconvert ! '
                f'refocus name=r method=blur depth-location={DEPTH} ! fakesink')])
        self.assertEqual(words[0], 0, words[1])
        self.assertRegex(words[1], r'GstRefocus:r[^\n]*src: caps =[^\n]*format=\(string\)(RGB|BGR)')

    def test_live(self):
        self.passes(f'videotestsrc is-live=true num-buffers=4 ! {SMALL}NV12 ! refocus name=r ! '
                    f'fakesink sync=true videotestsrc is-live=true num-buffers=2 ! '
                    'video/x-raw,format=GRAY8,width=96,height=64,framerate=10/1 ! r.depth')

    def test_leaks(self):
        words = self.passes(f'videotestsrc num-buffers=3 ! {SMALL}NV12 ! refocus name=r steady=0.5 ! '
                            f'fakesink videotestsrc num-buffers=2 ! {SMALL}GRAY8 ! r.depth',
                            GST_TRACERS='leaks', GST_DEBUG='GST_TRACER:7', GST_DEBUG_NO_COLOR='1')
        self.assertIn('object-alive', words)  # the tracer says what it would print
        self.assertEqual([line for line in words.splitlines()
                          if 'object-alive, ' in line and 'new format string' not in line], [])

    def test_errors(self):
        for line, why in (
                (f'videotestsrc num-buffers=1 ! {SMALL}NV12 ! refocus ! fakesink',
                 'no depth: link the pad depth, or give depth-location'),
                (f'videotestsrc ! refocus depth-location={self.folder}/none.png ! fakesink',
                 'none.png: cannot open it'),
                (f'videotestsrc ! refocus depth-location={NO_DEPTH} ! fakesink', 'meson.build: '),
                ('audiotestsrc ! refocus ! fakesink', 'could not link'),
                ('videotestsrc ! video/x-raw,format=ARGB ! refocus ! fakesink', "can't handle caps"),
                ('videotestsrc ! video/x-raw,interlace-mode=interleaved ! refocus ! fakesink',
                 "can't handle caps"),
                (f'videotestsrc num-buffers=1 ! refocus aperture=polygon:99 depth-location={DEPTH} '
                 '! fakesink', "aperture 'polygon:99' is not known")):
            status, words = self.launch(line)
            self.assertEqual(status in (1, 255), True, line)
            self.assertIn(why, words)

    def test_inspect(self):
        status, words = self.run_words(['gst-inspect-1.0', 'refocus'])
        self.assertEqual(status, 0)
        for word in ('depth', 'GRAY16_LE', 'focus-x', 'controllable', 'Refocus by depth', 'MIT'):
            self.assertIn(word, words)
        for line in words.splitlines():  # each says what it is for
            if line.startswith('  ') and ' : ' in line and not line.startswith('   '):
                self.assertGreater(len(line.split(' : ', 1)[1]), 3, line)

    @unittest.skipUnless(COMMAND, 'a build without the command')
    def test_photo_example(self):
        """The script's picture is the command's, pixel by pixel."""
        ours, theirs = (os.path.join(self.folder, name) for name in ('ours.png', 'theirs.png'))
        photo, depth = str(SCENE / 'allfocus.png'), str(SCENE / 'disparity.png')
        status, words = self.run_words([str(EXAMPLES / 'photo.sh'), photo, depth, ours])
        self.assertEqual(status, 0, words)
        status, words = self.run_words(
            [COMMAND, 'render', photo, '--depth', depth, '--depth-edges', 'as-given', '--focus', '0.9',
             '--blur', '20', '--rays', '128', '--no-thin', '-o', theirs])
        self.assertEqual(status, 0, words)
        self.assertEqual(*(self.bytes_of(f'filesrc location={path} ! pngdec ! videoconvert ! '
                                         'video/x-raw,format=RGB ! OUT') for path in (ours, theirs)))

    def test_camera_examples_say_how(self):
        for name in 'webcam.sh', 'libcamera.sh':
            status, words = self.run_words([str(EXAMPLES / name)])
            self.assertEqual(status, 2)
            self.assertIn('usage: ' + name, words)


if __name__ == '__main__':
    unittest.main()
