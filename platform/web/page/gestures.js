// Fingers, mouse and wheel on the stage: one finger taps or drags; two pinch and pan, or, moved side
// by side up or down, tilt, as on maps, and turn about each other.

const STILL = 8; // CSS pixels within which a finger has not moved
const APART = 12; // CSS pixels by which two fingers have moved against each other
const TWICE_MS = 300; // between the two taps of a double tap

/** Calls `on.tap(place)`, `on.twice(place)`, `on.begin(place)`, `on.drag(place, by)`, `on.end()`,
 * `on.cancel()`, `on.pinch(factor, place, by)`, `on.pan(by)` and `on.hover(place or null)`; places
 * are { x, y } on the stage. Two fingers also call, where `on.tilts()`, `on.tilt(y)` and, where
 * `on.turns()`, `on.turn(degrees)`, both from where they began, and `on.tiltEnd()`. A drag begins where the finger came down, or at once where
 * `on.atOnce()`. */
export function listenTo(element, on) {
    const fingers = new Map(); // of each pointer that is down, the place
    let start = null; // of the first finger, until another comes
    let pair = null; // two fingers: { a, b, moves, does }
    let dragging = false, panning = false, last = { time: 0, x: 0, y: 0 };

    const place = (event) => {
        const box = element.getBoundingClientRect();
        return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    const spread = (a, b) => ({ distance: Math.hypot(a.x - b.x, a.y - b.y) || 1,
        angle: Math.atan2(b.y - a.y, b.x - a.x), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });

    /** What two fingers do, once they have moved: together, or against each other. One move tells
     * nothing, since those of fingers that move together come one after the other. */
    const decide = (from, to) => {
        const [{ x, y }] = fingers.values();
        const by = { x: to.x - from.x, y: to.y - from.y };
        const apart = Math.hypot(x - pair.a.x - by.x, y - pair.a.y - by.y);
        const together = Math.hypot(by.x, by.y);

        if (pair.moves < 2 || Math.max(together - STILL, apart - APART) < 0)
            return null;
        if (together > 2 * apart)
            return Math.abs(by.y) > Math.abs(by.x) && on.tilts() ? 'tilt' : 'pinch';
        const stretched = Math.abs(to.distance - from.distance) / 2;
        return stretched < 0.7 * apart && on.turns() ? 'turn' : 'pinch';
    };

    const movePair = () => {
        const [a, b] = [...fingers.values()];
        const from = spread(pair.a, pair.b), to = spread(a, b);

        pair.moves++;
        pair.does ??= decide(from, to);
        if (pair.does === 'tilt') {
            on.tilt(to.y - from.y);
        } else if (pair.does === 'turn') {
            const degrees = (to.angle - from.angle) * 180 / Math.PI;
            on.turn(degrees - 360 * Math.round(degrees / 360));
        } else if (pair.does) {
            on.pinch(to.distance / from.distance, to, { x: to.x - from.x, y: to.y - from.y });
            Object.assign(pair, { a, b });
        }
    };
    const drop = () => {
        if (dragging)
            on.cancel();
        dragging = false;
        start = null;
    };

    element.addEventListener('pointerdown', (event) => {
        const at = place(event);
        if (event.pointerType === 'mouse' && event.button > 1)
            return;
        element.setPointerCapture(event.pointerId);
        fingers.set(event.pointerId, at);
        panning = event.button === 1;
        if (fingers.size > 1 || panning) {
            drop();
            const [a, b] = [...fingers.values()];
            pair = fingers.size === 2 ? { a, b, moves: 0, does: null } : null;
            return;
        }
        start = at;
        if (on.atOnce()) {
            dragging = true;
            on.begin(at);
        }
    });

    element.addEventListener('pointermove', (event) => {
        const at = place(event), was = fingers.get(event.pointerId);
        if (event.pointerType === 'mouse')
            on.hover(at);
        if (!was)
            return;
        const by = { x: at.x - was.x, y: at.y - was.y };
        if (pair) {
            fingers.set(event.pointerId, at);
            movePair();
            return;
        }
        if (panning) {
            on.pan(by);
        } else if (start) {
            if (!dragging) {
                if (Math.hypot(at.x - start.x, at.y - start.y) < STILL)
                    return;
                dragging = true;
                on.begin(start);
            }
            on.drag(at, by);
        }
        fingers.set(event.pointerId, at);
    });

    const up = (event) => {
        if (!fingers.delete(event.pointerId))
            return;
        if (pair)
            on.tiltEnd();
        pair = null;
        if (event.type === 'pointercancel') {
            drop();
        } else if (dragging) {
            dragging = false;
            on.end();
        } else if (start) {
            const at = place(event);
            const again = event.timeStamp - last.time < TWICE_MS &&
                Math.hypot(at.x - last.x, at.y - last.y) < 3 * STILL;
            if (again)
                on.twice(at);
            else
                on.tap(at);
            last = { time: again ? 0 : event.timeStamp, ...at };
        }
        start = null;
    };
    element.addEventListener('pointerup', up);
    element.addEventListener('pointercancel', up);
    element.addEventListener('pointerleave', () => on.hover(null));
    element.addEventListener('contextmenu', (event) => event.preventDefault());
    element.addEventListener('wheel', (event) => {
        const step = event.deltaY * (event.deltaMode === 1 ? 20 : event.ctrlKey ? 4 : 1);
        event.preventDefault();
        on.pinch(Math.exp(-step / 400), place(event), { x: 0, y: 0 });
    }, { passive: false });
}
