// The line in the photo about which a tilted plane of focus turns.

export const STEEPEST = 45; // degrees that a plane of focus may be tilted
const LEAST = 8; // pixels of a line whose direction is worth something

/** The direction of a line [X, Y, X, Y], or of none, in degrees from level. */
export function turnOf(line) {
    if (!line)
        return 0;
    const [x0, y0, x1, y1] = line;
    return Math.round(Math.atan2(y1 - y0, x1 - x0) * 180 / Math.PI);
}

/** The line of that direction through a place from 0 to 1, from side to side of the photo;
 * undefined: the photo's own, level through its middle or what it was focused on. */
export function lineThrough({ width, height }, place, turn) {
    if (!place && !turn)
        return undefined;
    const at = place ?? { x: 0.5, y: 0.5 }, angle = turn * Math.PI / 180;
    const x = at.x * (width - 1), y = at.y * (height - 1);
    const dx = Math.cos(angle), dy = Math.sin(angle);
    // How far the line is inside, from the place on, by the two sides of one axis.
    const inside = (from, step, most) => (Math.abs(step) < 1e-6 ? [-Infinity, Infinity]
        : [-from / step, (most - from) / step].sort((a, b) => a - b));
    const across = inside(x, dx, width - 1), down = inside(y, dy, height - 1);
    const from = Math.max(across[0], down[0]), to = Math.min(across[1], down[1]);

    if (to - from < LEAST)
        return lineThrough({ width, height }, null, turn || 1);
    return [x + from * dx, y + from * dy, x + to * dx, y + to * dy].map(Math.round);
}
