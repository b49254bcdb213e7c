// The page knows this: the photo that is open, and how it is to look. Parts of the page change it
// by these functions and listen to it; none of them calls another.
import { NAMES, over, without } from './settings.js';
import { lineThrough, turnOf } from './tilt.js';

export const model = {
    // As the server told it: session, name, width, height, depth, limits, presets... And `sent`,
    // which tells photos that were sent from each other, '' of others.
    photo: null,
    again: false, // it was open before, in a session that is no more
    look: null, // the preset that was chosen
    own: {}, // settings that the person gave
    depth: 0, // rises whenever strokes change the depth
    view: 'picture', // or an overlay: depth, blur, peaking
    tab: 'adjust', // or look, paint, pull
    mark: null, // where the tap was that set the focus, { x, y } from 0 to 1
    comparing: false,
};

const listeners = [];

/** Call `heard` with what changed: photo, settings, depth, draft, view, tab, compare. */
export function listen(heard) {
    listeners.push(heard);
}

function tell(cause) {
    for (const heard of listeners)
        heard(cause);
}

/** The settings of the picture: those of the photo, the look over them, the person's over all. */
export function settings() {
    return over(over(model.photo.settings, model.look?.settings ?? {}), model.own);
}

export function openPhoto(photo, look, own, again) {
    Object.assign(model, {
        photo, own, again, look: photo.presets?.find((preset) => preset.name === look) ?? null,
        depth: 0, view: 'picture', mark: null, comparing: false,
    });
    tell('photo');
}

/** Settings that the person gives; undefined ones are no longer given. */
export function change(some) {
    model.own = over(model.own, some);
    for (const name of Object.keys(some))
        if (some[name] === undefined)
            delete model.own[name];
    if ('focus' in some)
        model.mark = null;
    tell('settings');
}

/** Settings of a plane of focus that is tilted by some degrees about a line through what was
 * tapped, which is turned from level. */
export function tilted(degrees, turn = turnOf(settings()[NAMES.tiltLine]), mark = model.mark) {
    // The other way about a line that points the other way is the same.
    if (Math.abs(turn) > 90)
        return tilted(-degrees, turn - 180 * Math.sign(turn), mark);
    return { [NAMES.tilt]: degrees || undefined,
        [NAMES.tiltLine]: degrees ? lineThrough(model.photo, mark, turn) : undefined };
}

/** Focus on what was tapped. */
export function focusOn(focus, x, y) {
    const { [NAMES.tilt]: tilt } = settings();

    change({ focus, ...(tilt ? tilted(tilt, undefined, { x, y }) : {}) });
    model.mark = { x, y };
    tell('mark');
}

/** A look overrules what the person gave before; what is given later overrules the look. */
export function chooseLook(preset) {
    model.look = preset;
    model.own = without(model.own, preset?.settings ?? {});
    tell('settings');
}

export function reset() {
    Object.assign(model, { look: null, own: {}, mark: null });
    tell('settings');
}

/** All of the settings at once, as of a key frame. */
export function restore(look, own) {
    Object.assign(model, { look, own, mark: null });
    tell('settings');
}

/** Strokes have changed the depth; `range` is that of its disparities. */
export function depthChanged(range) {
    model.depth++;
    Object.assign(model.photo, { depth: true, range });
    tell('depth');
}

/** A stroke that is not finished has changed the depth. */
export function draftChanged() {
    model.depth++;
    tell('draft');
}

export function setView(view) {
    model.view = view;
    tell('view');
}

export function setTab(tab) {
    model.tab = tab;
    tell('tab');
}

export function setComparing(on) {
    model.comparing = on;
    tell('compare');
}
