#!/usr/bin/env python3
"""First steps in Python, cell by cell: editors that know `# %%` run it like a notebook.

usage: first_steps.py [OUTPUT_FOLDER]
"""
# %% A photo that is sharp everywhere, and its depth
import pathlib
import sys

import numpy
import refocus

data = pathlib.Path(__file__).resolve().parent.parent / 'data' / 'nightlights'
out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else 'out')
out.mkdir(parents=True, exist_ok=True)
photo = refocus.photo_read(data / 'allfocus.png').image
disparity, report = refocus.depth_read(data / 'disparity.png').disparity(photo)
print('photo', photo.shape, photo.dtype, '- disparities', disparity.shape, disparity.dtype)

# %% One picture: what is at column 200, row 300 is sharp, the rest blurred by up to 20 pixels
picture = refocus.render(photo, disparity, focus_at=(200, 300), blur=20)
refocus.image_write(out / 'first.png', picture)

# %% Many pictures of one photo: prepare once, render as often as the lens changes
height, width = disparity.shape
with refocus.Renderer(width, height, max_blur_radius=20) as renderer:
    renderer.prepare(photo, disparity)
    settings = refocus.Settings(max_blur_radius=20, aperture=refocus.Aperture(blades=6))
    settings.highlights.estimate = 1
    settings.look.cat_eye = 0.4
    pull = numpy.empty((5, height, width, 3), numpy.uint8)
    for frame, focus in zip(pull, numpy.linspace(0, 1, len(pull))):
        settings.render.focus_disparity = focus
        renderer.render(settings, frame)  # into its place in the array: nothing is copied
refocus.image_write(out / 'pull.png', numpy.concatenate(pull[:, ::2, ::2], axis=1).copy())

# %% Distances become disparities; samples that a sensor does not have are filled
metres = refocus.depth_of_disparity(refocus.DepthRange(near_m=1, far_m=9), 0.5)
sensor = numpy.full((60, 80), 2500, numpy.uint16)
sensor[20:40, 30:50] = 1200
sensor[10:12] = 0
map_, report = refocus.depth_to_disparity(sensor, 'mm')
print(f'd = 0.5 is at {metres:.2f} m; the sensor saw {report.near_m:.2f} to {report.far_m:.2f} m, '
      f'{report.unknown} samples were filled')

# %% Errors say what is wrong
try:
    refocus.render(photo, disparity, focus=1.5, blur=20)
except refocus.ArgumentError as error:
    print('refused:', error)
