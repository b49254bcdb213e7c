// Strokes outlive the session that they were made in: they are kept for each photo as long as the tab
// is there, also when the page is left or loaded anew.
const here = new Map();

/** The link of another server leads to other photos, and all that phones send may have one name. */
const key = ({ name, width, height, sent }) =>
    `${location.pathname}${name} ${width}x${height} ${sent}`;

export function keepStrokes(photo, strokes) {
    const text = JSON.stringify(strokes);

    here.set(key(photo), text);
    try {
        sessionStorage.setItem(key(photo), text);
    } catch {
        // there is no room, or none allowed: until the page is left they are kept all the same
    }
}

export function keptStrokes(photo) {
    let text = here.get(key(photo));

    try {
        text ??= sessionStorage.getItem(key(photo));
    } catch {
        // none allowed
    }
    return JSON.parse(text ?? '[]');
}
