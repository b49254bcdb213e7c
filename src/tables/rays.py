#!/usr/bin/env python3
"""Writes rays.inc: sets of rays of a disc for sizes that tiles choose from (renderer/rays.c).

A set is evenly spread over the disc, and so are its projections onto every axis: what one
straight edge after the other lets through grows by even steps, which rounding to whole pixels
would show as streaks along it, above all along upright and level ones. Vogel's spiral is even in
two dimensions and along the radius alone. From it on, points are moved along one direction after
the other to where those of that rank would lie (sliced optimal transport, as Paulin et al. 2020),
every fourth direction along an axis of the picture, and a part of the way along the radius. Their
order stays that of the spiral, of which every second one is an even set, too.
"""
import math
import random
from pathlib import Path

SIZES = (24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
DIRECTIONS = 16  # whose moves are averaged


def share_below(x):
    """Of the area of the unit disc."""
    return 0.5 + (x * math.sqrt(max(0.0, 1 - x * x)) + math.asin(x)) / math.pi


def moment_below(x):
    return -2 * max(0.0, 1 - x * x) ** 1.5 / (3 * math.pi)


def places(count):
    """Where the points of each rank lie along an axis: the means of strips of equal area."""
    edges = []
    for i in range(count + 1):
        low, high = -1.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if share_below(middle) < i / count else (low, middle)
        edges.append(low)
    return [count * (moment_below(b) - moment_below(a)) for a, b in zip(edges, edges[1:])]


def vogel(count):
    points = []
    for n in range(count):
        radius, turns = math.sqrt((n + 0.5) / count), n * 0.38196601125010515
        points.append((radius * math.cos(2 * math.pi * turns),
                       radius * math.sin(2 * math.pi * turns)))
    return points


def ranks(values):
    return enumerate(sorted(range(len(values)), key=values.__getitem__))


def moved(points, rng, to, part):
    """Along some directions, averaged, and then along the radius."""
    count = len(points)
    move = [[0.0, 0.0] for _ in points]
    for _ in range(DIRECTIONS):
        turn = (rng.randrange(2) * math.pi / 2 if rng.random() < 0.25
                else rng.random() * math.pi)
        c, s = math.cos(turn), math.sin(turn)
        along = [x * c + y * s for x, y in points]
        for rank, i in ranks(along):
            move[i][0] += (to[rank] - along[i]) * c
            move[i][1] += (to[rank] - along[i]) * s
    points = [(x + 2 * part / DIRECTIONS * mx, y + 2 * part / DIRECTIONS * my)
              for (x, y), (mx, my) in zip(points, move)]
    radii = [math.hypot(x, y) for x, y in points]
    for rank, i in ranks(radii):
        grow = 1 + 0.6 * part * (math.sqrt((rank + 0.5) / count) / radii[i] - 1)
        points[i] = (points[i][0] * grow, points[i][1] * grow)
    return points


def spread(count):
    rng, points, to = random.Random(1), vogel(count), places(count)
    passes = 4000 if count <= 128 else 1000
    for n in range(passes):  # in full first, then less and less
        points = moved(points, rng, to, min(1, 2 * (1 - n / passes)))
    return points


def q15(x):
    return max(-32767, min(32767, math.floor(x * 32768 + 0.5)))


def main():
    lines, first = ["/* Written by rays.py; see there. */"], 0
    lines += [f"static const struct {{\n    int count, first;\n}} disc_sets[{len(SIZES)}] = {{"]
    for count in SIZES:
        lines.append(f"    {{{count}, {first}}},")
        first += count
    lines += ["};", f"static const int16_t disc_points[{first}][2] = {{"]
    for count in SIZES:
        points = spread(count)
        for n in range(0, count, 4):
            lines.append("    " + ", ".join(
                "{%d, %d}" % (q15(x / max(1, math.hypot(x, y))), q15(y / max(1, math.hypot(x, y))))
                for x, y in points[n:n + 4]) + ",")
    lines.append("};")
    Path(__file__).with_name("rays.inc").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
