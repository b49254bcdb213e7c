// Settings: a plain object with the names that `refocus render --settings` has. What they are
// called, how two of them are put together, and how they travel in a link.

export const NAMES = {
    focus: 'focus',
    blur: 'blur',
    fNumber: 'f-number',
    highlights: 'highlights',
    band: 'focus-width',
    aperture: 'aperture',
    tilt: 'tilt-angle',
    tiltLine: 'tilt-line',
};

/** `change` over `base`. The blur is given in pixels or as an f-number, whichever came last. */
export function over(base, change) {
    const settings = { ...base, ...change };

    if (change[NAMES.fNumber] != null)
        delete settings[NAMES.blur];
    else if (change[NAMES.blur] != null)
        delete settings[NAMES.fNumber];
    return settings;
}

/** Settings whose blur is given in pixels: an f-number has a share of the photo's blur of f/1. */
export function inPixels(settings, { f1_blur: most, limits }) {
    const number = settings[NAMES.fNumber];

    return number && most ? over(settings, { [NAMES.blur]: Math.min(most / number, limits.blur) })
        : settings;
}

/** The `changes` of which `other` does not speak. */
export function without(changes, other) {
    const left = {};

    for (const [name, value] of Object.entries(changes)) {
        const blur = name === NAMES.blur || name === NAMES.fNumber;
        if (!(name in other) && !(blur && (NAMES.blur in other || NAMES.fNumber in other)))
            left[name] = value;
    }
    return left;
}

const round = (value) => (typeof value === 'number' ? Number(value.toPrecision(4)) : value);

/** The part of an address behind #: the photo's name, the look and the settings that were
 * changed. */
export function toLink(photo, look, changes) {
    const query = new URLSearchParams({ photo });

    if (look)
        query.set('look', look);
    for (const [name, value] of Object.entries(changes))
        query.set(name, typeof value === 'string' ? value : JSON.stringify(round(value)));
    return `#${query}`;
}

/** The other way: { photo, look, changes }. */
export function fromLink(hash) {
    const link = { photo: null, look: null, changes: {} };

    for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ''))) {
        if (name === 'photo' || name === 'look') {
            link[name] = text;
        } else {
            try {
                link.changes[name] = JSON.parse(text);
            } catch {
                link.changes[name] = text;
            }
        }
    }
    return link;
}
