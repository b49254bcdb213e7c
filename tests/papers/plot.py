"""Curves as an SVG file."""


def plot(path, title, x_label, y_label, curves, y_from=0.0):
    """Curves {name: [(x, y)]} as an SVG file."""
    w, h, left, top, right, bottom = 640, 360, 60, 34, 150, 44
    xs = [x for c in curves.values() for x, _ in c]
    ys = [y for c in curves.values() for _, y in c]
    x0, x1, y0, y1 = min(xs), max(xs), y_from, max(ys) * 1.05
    if x1 == x0:
        x1 = x0 + 1

    def at(x, y):
        return (left + (x - x0) / (x1 - x0) * (w - left - right),
                h - bottom - (y - y0) / (y1 - y0) * (h - top - bottom))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" '
           f'fill="white"/><text x="{left}" y="20" font-size="14">{title}</text>']
    for i in range(6):
        y = y0 + (y1 - y0) * i / 5
        px, py = at(x0, y)
        out.append(f'<path d="M{px:.1f} {py:.1f}H{w - right}" stroke="#ddd"/>'
                   f'<text x="{left - 6}" y="{py + 4:.1f}" text-anchor="end">{y:.3g}</text>')
    for x in sorted(set(xs)):
        px, py = at(x, y0)
        out.append(f'<text x="{px:.1f}" y="{h - bottom + 16}" text-anchor="middle">{x:.3g}</text>')
    out.append(f'<text x="{(left + w - right) / 2}" y="{h - 8}" text-anchor="middle">{x_label}'
               f'</text><text transform="translate(14 {h / 2}) rotate(-90)" '
               f'text-anchor="middle">{y_label}</text>')
    colours = ["#1b6ca8", "#d1495b", "#2a9d4a", "#e08e00", "#7b4fb5", "#555555"]
    for i, (name, curve) in enumerate(curves.items()):
        points = " ".join("{:.1f},{:.1f}".format(*at(x, y)) for x, y in sorted(curve))
        colour = colours[i % len(colours)]
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" '
                   f'stroke-width="2"/><text x="{w - right + 8}" y="{top + 14 + 18 * i}" '
                   f'fill="{colour}">{name}</text>')
    path.write_text("\n".join(out) + "\n</svg>\n", encoding="utf-8")
