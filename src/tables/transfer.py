#!/usr/bin/env python3
"""Writes transfer.inc: the curves between 8-bit codes and the values that are averaged.

to_light[c]  Q12 value of code c: round(4095 x(c / 255)), but at least one more than the
             value before, so that every code has a value of its own (gamma 2.2 has no slope
             at 0). Stored values are 16 c.
boundary[c]  the least Q14 value that is written as code c + 1: the curve at the middle
             between the codes, kept between 4 to_light[c] and 4 to_light[c + 1], so that
             a value that was not averaged comes back as its code.
"""

def srgb(x):
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4

def gamma(x):
    return x ** 2.2

def stored(x):
    return 16 * 255 * x / 4095

def table(curve):
    light = []
    for code in range(256):
        value = int(4095 * curve(code / 255) + 0.5)
        light.append(max(value, light[-1] + 1) if light else value)
    boundary = []
    for code in range(255):
        middle = int(4 * 4095 * curve((code + 0.5) / 255) + 0.5)
        boundary.append(min(max(middle, 4 * light[code] + 2), 4 * light[code + 1] - 1))
    return light, boundary

def rows(values):
    for at in range(0, len(values), 12):
        yield "    " + ", ".join(str(v) for v in values[at:at + 12]) + ","

def write(name, curve):
    light, boundary = table(curve)
    print(f"static const uint16_t {name}_to_light[256] = {{", *rows(light), "};", sep="\n")
    print(f"static const uint16_t {name}_boundary[255] = {{", *rows(boundary), "};", sep="\n")

print("/* Written by transfer.py; see there. */")
write("srgb", srgb)
write("stored", stored)
write("gamma", gamma)
