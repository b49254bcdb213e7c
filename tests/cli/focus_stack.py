"""A small focus stack, as files and as a camera sees it, for tests of what makes depth of it."""
import pictures
from case import Case, H, W

FRAMES = 3


def noise(x, y):
    return (x * 7919 + y * 104729 + x * y * 31) * 2654435761 >> 16 & 255


def mean(x, y, radius, grain=1):
    """The texture through a lens: the mean of a square."""
    span = range(-radius, radius + 1)
    return sum(noise((x + u) // grain, (y + v) // grain) for u in span
               for v in span) // len(span) ** 2


class FocusStack(Case):
    CAMERA = 'replay::stack %d.ppm 3;lens 0.5 2.5'

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # The left half is far, in focus in the first frame, the right one near.
        for k in range(FRAMES):
            pictures.ppm(f'{k}.ppm', W, H, lambda x, y: (
                mean(x, y, k if x < W // 2 else FRAMES - 1 - k),) * 3)
        cls.frames = [f'{k}.ppm' for k in range(FRAMES)]
        cls.command = ['depth', '--focal-stack', *cls.frames, '--align', 'none']

    def halves(self, name):
        width, height, samples = pictures.read_pnm(name)
        self.assertEqual((width, height), (W, H))
        # Depths between frames are told apart, so that the ends are so but for the last bits.
        return [(0 if v < 999 else v) for v in (sorted(samples[y * W + x] for y in range(H) for x in range(left, left + W // 2))
                [W * H // 4] for left in (0, W // 2))]

    def stack(self, more='', *arguments):
        return ('stack', '--camera', self.CAMERA + more, '--steps', '3', *arguments)
