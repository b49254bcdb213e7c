// Fingers, mouse and wheel on the stage: one finger taps or drags, two pinch and pan.

const STILL = 8; // CSS pixels within which a finger has not moved
const TWICE_MS = 300; // between the two taps of a double tap

/** Calls `on.tap(place)`, `on.twice(place)`, `on.begin(place)`, `on.drag(place, by)`, `on.end()`,
 * `on.cancel()`, `on.pinch(factor, place, by)`, `on.pan(by)` and `on.hover(place or null)`; places
 * are { x, y } on the stage. A drag begins where the finger came down, or at once where
 * `on.atOnce()`. */
export function listenTo(element, on) {
    const fingers = new Map(); // of each pointer that is down, the place
    let start = null; // of the first finger, until another comes
    let dragging = false, panning = false, last = { time: 0, x: 0, y: 0 };

    const place = (event) => {
        const box = element.getBoundingClientRect();
        return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    const spread = () => {
        const [a, b] = [...fingers.values()];
        return { distance: Math.hypot(a.x - b.x, a.y - b.y) || 1,
            x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
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
        if (fingers.size === 2) {
            const from = spread();
            fingers.set(event.pointerId, at);
            const to = spread();
            on.pinch(to.distance / from.distance, to, { x: to.x - from.x, y: to.y - from.y });
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
