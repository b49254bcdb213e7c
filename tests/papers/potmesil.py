"""The section of tests/papers.md on Potmesil & Chakravarty 1981; papers.py writes it."""
import json

from sections import table


def score_table(refocus, folders, compare, scene_views):
    """What the two parts of the paper that are beside the size of circles are worth."""
    rows = []
    for scene in folders:
        depths = json.loads((scene / "scene.json").read_text())
        ratio = depths["z1"] / depths["z0"]
        methods = [("uniform", "scatter:depth-ratio=1"),
                   ("uniform, 1/z²", f"scatter:depth-ratio={ratio}"),
                   ("Lommel, 1/z²", f"scatter:spread=lommel:depth-ratio={ratio}")]
        for view in scene_views(scene, (10, 20, 40)):
            scores = compare(refocus, methods, scene / "allfocus.png", scene / "disparity.png",
                             scene / view["file"], view["df"], view["K"])
            rows.append([scene.name, f"{view['K']:g}", f"{ratio:.1f}"]
                        + [f"{scores[label]['psnr']:.2f}" for label, _ in methods])
    return table(["scene", "K", "z1 / z0", "PSNR, uniform", "PSNR, uniform, 1/z²",
                  "PSNR, Lommel, 1/z²"], rows)


def airy_table():
    """1.22 lambda N of the paper's and a full-frame camera, in pixels."""
    rows = []
    for camera, width_mm, pixels, numbers in (("55 mm, 30 mm of film, the paper's", 30, 512,
                                               (5.6, 11, 22)),
                                              ("full frame", 36, 6000, (1.8, 5.6, 22))):
        for number in numbers:
            ring = 1.2197 * 0.55e-3 * number
            rows.append([camera, f"f/{number:g}", f"{1000 * ring:.2f}", pixels,
                         f"{ring * pixels / width_mm:.3f}"])
    return table(["camera", "aperture", "first dark ring at 550 nm, micrometres", "pixels across",
                  "ring, pixels"], rows)


def potmesil(refocus, folders, compare, scene_views):
    return ("## Potmesil & Chakravarty 1981\n\n"
            "All 12 rows of the paper's Table 1, limits of the depth of field, are tests of `lens.h`, "
            "and `refocus info` prints them. The light of a circle of confusion: evenly, by 1/z² as in "
            "eq. 20, and by Lommel's functions with rings of one pixel:\n\n"
            + score_table(refocus, folders, compare, scene_views) + "\nRings as lenses have them (eq. 12, 18):\n\n"
            + airy_table())
