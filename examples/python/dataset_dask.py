#!/usr/bin/env python3
"""Refocus a data set on many machines with Dask.

usage: dataset_dask.py FOLDER OUTPUT_FOLDER [SCHEDULER]

FOLDER holds one folder a scene, each with allfocus.png and disparity.png; OUTPUT_FOLDER, which all
machines see, gets SCENE-focusD.png. SCHEDULER is the address of a Dask scheduler, such as
tcp://10.0.0.1:8786, whose workers have this package; without it the work is done here, in two
threads: the package releases Python's lock while it renders.
"""
import pathlib
import sys
import threading

import refocus
from dask.distributed import Client, as_completed

FOCI, BLUR = (0.0, 0.5, 1.0), 12


def renderer_for(width, height):
    """The renderer of this thread of a worker, made anew when pictures have another size."""
    thread = threading.current_thread()
    if getattr(thread, 'size', None) != (width, height):
        thread.renderer = refocus.Renderer(width, height, BLUR, threads=1, thin=1)
        thread.size = width, height
    return thread.renderer


def refocus_scene(folder, out):
    """One scene at all foci: the unit of work. Pictures do not travel, only names do."""
    photo = refocus.photo_read(folder / 'allfocus.png').image
    disparity, _ = refocus.depth_read(folder / 'disparity.png').disparity()
    renderer = renderer_for(photo.shape[1], photo.shape[0])
    renderer.prepare(photo, disparity)
    settings = refocus.Settings(max_blur_radius=BLUR, thin={'enabled': 1},
                                highlights={'estimate': 1})
    for focus in FOCI:
        settings.render.focus_disparity = focus
        refocus.image_write(out / f'{folder.name}-focus{focus:.1f}.png', renderer.render(settings))
    return folder.name


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    folder, out = map(pathlib.Path, sys.argv[1:3])
    scenes = sorted(path.parent for path in folder.resolve().glob('*/disparity.png'))
    out.mkdir(parents=True, exist_ok=True)
    here = {'processes': False, 'n_workers': 1, 'threads_per_worker': 2, 'dashboard_address': None}
    with Client(sys.argv[3]) if len(sys.argv) == 4 else Client(**here) as client:
        # A scene that fails is named, and the others are done all the same.
        work = {client.submit(refocus_scene, scene, out.resolve(), pure=False): scene.name
                for scene in scenes}
        failed = 0
        for done in as_completed(work):
            if done.status == 'error':
                failed += 1
                print(f'{work[done]}: {done.exception()}', file=sys.stderr)
            else:
                print(done.result())
    print(f'{len(scenes) - failed} of {len(scenes)} scenes')
    return 1 if failed or not scenes else 0


if __name__ == '__main__':
    sys.exit(main())
