// The place where several pictures of one photo differ most is found: looks are told apart there,
// and not in the middle, where most photos are sharp.

const SIDE = 120; // of the copies that are compared
const LEAST = 2; // codes of a mean difference that can be seen

function samples(bitmap, width, height) {
    const c = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });

    c.drawImage(bitmap, 0, 0, width, height);
    return c.getImageData(0, 0, width, height).data;
}

/** Sums from the corner of how far each pixel is from its mean over the pictures. */
function sums(pictures, width, height) {
    const total = new Float64Array((width + 1) * (height + 1));

    for (let y = 0; y < height; y++) {
        let row = 0;
        for (let x = 0; x < width; x++) {
            for (let channel = 0; channel < 3; channel++) {
                const i = 4 * (y * width + x) + channel;
                const mean = pictures.reduce((sum, one) => sum + one[i], 0) / pictures.length;
                row += pictures.reduce((sum, one) => sum + Math.abs(one[i] - mean), 0);
            }
            total[(y + 1) * (width + 1) + x + 1] = total[y * (width + 1) + x + 1] + row;
        }
    }
    return total;
}

/** The square of a part of the shorter side in which the bitmaps, of one size, differ most:
 * { x, y, side } in their pixels; undefined where they hardly differ anywhere. */
export function mostDifferent(bitmaps, part) {
    const [{ width: fullWidth, height: fullHeight }] = bitmaps;
    const scale = Math.min(1, SIDE / Math.max(fullWidth, fullHeight));
    const width = Math.max(1, Math.round(fullWidth * scale));
    const height = Math.max(1, Math.round(fullHeight * scale));
    const side = Math.max(1, Math.round(part * Math.min(width, height)));
    const total = sums(bitmaps.map((one) => samples(one, width, height)), width, height);
    const at = (x, y) => total[y * (width + 1) + x];
    let best = { x: (width - side) >> 1, y: (height - side) >> 1, sum: 0 };

    for (let y = 0; y + side <= height; y++) {
        for (let x = 0; x + side <= width; x++) {
            const sum = at(x + side, y + side) - at(x, y + side) - at(x + side, y) + at(x, y);
            if (sum > 1.001 * best.sum)
                best = { x, y, sum };
        }
    }
    if (best.sum < LEAST * 3 * side * side * bitmaps.length)
        return undefined;
    return { x: best.x / scale, y: best.y / scale, side: side / scale };
}
