// The picture and what is done on it: tap to focus, zoom and pan, the divider, overlays, and all of
// these by keys. While depth is painted, fingers belong to the brush.
import { $, announce, announceError, radios } from './dom.js';
import { listenTo } from './gestures.js';
import { change, focusOn, listen, model, setComparing, settings, setView, tilted }
    from './model.js';
import { Pictures } from './pictures.js';
import { focusAt } from './server.js';
import { NAMES } from './settings.js';
import { Stage } from './stage.js';
import { STEEPEST, turnOf } from './tilt.js';
import { say } from './words.js';

const VIEWS = { picture: 'viewPicture', depth: 'viewDepth', blur: 'viewBlur',
    peaking: 'viewPeaking' };
const STEP = 0.02, LEAP = 0.1; // of the stage, that keys move the cross
const BUSY_MS = 800; // of waiting, before it shows

let stage, pictures, brush = null, moment = null, busyTimer = 0;
const pictureListeners = [], busyFor = new Set();

/** The settings of a moment of the rack focus, or null: those of the controls. */
export function showMoment(some) {
    moment = some;
    ask();
}

/** While the tab for painting is open, its brush gets what fingers do: begin, drag, end, cancel,
 * hover, key. */
export function setBrush(some) {
    brush = some;
    stage.set({ brush: null, path: null, selection: null });
    $('stage-help').textContent = say(brush ? 'stagePaintHelp' : 'stageHelp');
}

export const onPicture = (heard) => pictureListeners.push(heard);
export const theStage = () => stage;
export const thePictures = () => pictures;

function ask() {
    if (!model.photo || model.photo.live)
        return; // live.js shows frames
    const kind = model.view === 'picture' || moment ? undefined : model.view;
    pictures.want({ session: model.photo.session, depth: model.depth, kind,
        settings: moment ?? settings(), size: stage.sizeSeen(), before: model.comparing });
}

/** A picture that failed: an overlay that this server lacks is not offered again. */
function failed(error, job) {
    if (error.status === 404 && job.kind) {
        $('views').querySelector(`[value=${job.kind}]`).parentElement.hidden = true;
        setView('picture');
    }
    announceError(error);
}

/** Something is still to come; each part of the page has its reason. */
export function setBusy(reason, is) {
    const yes = (is ? busyFor.add(reason) : (busyFor.delete(reason), busyFor)).size > 0;

    $('stage').setAttribute('aria-busy', yes);
    if (!yes) {
        clearTimeout(busyTimer);
        busyTimer = 0;
        $('busy').hidden = true;
    } else if (!busyTimer) {
        busyTimer = setTimeout(() => ($('busy').hidden = false), BUSY_MS);
    }
}

async function focus(place) {
    const { x, y } = stage.toPhoto(place.x, place.y), { photo } = model;

    if (x < 0 || y < 0 || x > 1 || y > 1)
        return;
    stage.set({ mark: { x, y } });
    setBusy('focus', true);
    try {
        const disparity = await pictures.pauseFor(() => focusAt(photo.session, x, y));
        if (photo === model.photo)
            focusOn(disparity, x, y);
    } catch (error) {
        if (error.status !== 409)
            announceError(error);
    }
    setBusy('focus', false);
}

/** Focus that follows the finger: the next place is asked for when the picture of the last one is
 * seen. */
let following = null;
async function follow(place) {
    const first = following === null;

    following = place;
    if (!first)
        return;
    while (following !== true) {
        const at = following;
        following = true;
        await focus(at);
        await pictures.seen();
    }
    following = null;
}

function zoomTwice(place) {
    if (stage.fitted())
        stage.zoomTo(stage.fullScale(), place.x, place.y);
    else
        stage.fit();
}

let tiltedFrom = null; // the tilt when two fingers began
/** What two fingers change of it; the line about which it turns is seen. */
function tilting(changed) {
    const now = settings();

    tiltedFrom ??= { tilt: now[NAMES.tilt] ?? 0, turn: turnOf(now[NAMES.tiltLine]) };
    change(changed(tiltedFrom));
    stage.set({ line: settings()[NAMES.tiltLine] ?? null });
}

const fingers = {
    atOnce: () => brush !== null,
    tap: (place) => (brush ? undefined : focus(place)),
    twice: (place) => (brush ? undefined : zoomTwice(place)),
    begin(place) {
        if (brush)
            brush.begin(stage.toPhoto(place.x, place.y));
        else if (stage.fitted())
            follow(place);
    },
    drag(place, by) {
        if (brush)
            brush.drag(stage.toPhoto(place.x, place.y));
        else if (stage.fitted())
            follow(place);
        else
            stage.pan(by.x, by.y);
    },
    end: () => brush?.end(),
    cancel: () => brush?.cancel(),
    pan: (by) => stage.pan(by.x, by.y),
    pinch(factor, place, by) {
        stage.pan(by.x, by.y);
        stage.zoomBy(factor, place.x, place.y);
    },
    hover: (place) => brush?.hover(place),
    // All of the photo is seen, so that there is nothing to pan to.
    tilts: () => !brush && stage.fitted(),
    turns: () => !brush && Boolean(settings()[NAMES.tilt]),
    tilt: (y) => tilting((from) => tilted(
        Math.min(Math.max(Math.round(from.tilt - 2 * STEEPEST * y / stage.height), -STEEPEST),
            STEEPEST), from.turn)),
    turn: (degrees) => tilting((from) => tilted(from.tilt, from.turn + Math.round(degrees))),
    tiltEnd() {
        stage.set({ line: null });
        tiltedFrom = null;
    },
};

/** The cross that arrow keys move; the picture follows it out of sight. */
function moveCursor(dx, dy) {
    const from = stage.cursor ? stage.toStage(stage.cursor)
        : { x: stage.width / 2 - dx * stage.width, y: stage.height / 2 - dy * stage.height };
    const to = stage.toPhoto(from.x + dx * stage.width, from.y + dy * stage.height);
    const at = { x: Math.min(Math.max(to.x, 0), 1), y: Math.min(Math.max(to.y, 0), 1) };

    stage.set({ cursor: at });
    const seen = stage.toStage(at);
    const out = (value, most) => (value < 0 ? -value : value > most ? most - value : 0);
    if (out(seen.x, stage.width) || out(seen.y, stage.height))
        stage.pan(out(seen.x, stage.width), out(seen.y, stage.height));
    brush?.moveTo(at);
}

function stageKey(event) {
    const far = event.shiftKey ? LEAP : STEP;
    const middle = stage.cursor ? stage.toStage(stage.cursor)
        : { x: stage.width / 2, y: stage.height / 2 };
    const keys = {
        ArrowLeft: () => moveCursor(-far, 0),
        ArrowRight: () => moveCursor(far, 0),
        ArrowUp: () => moveCursor(0, -far),
        ArrowDown: () => moveCursor(0, far),
        Enter: () => (brush ? brush.key(stage.toPhoto(middle.x, middle.y)) : focus(middle)),
        ' ': () => keys.Enter(),
        '+': () => stage.zoomBy(1.25, middle.x, middle.y),
        '=': () => keys['+'](),
        '-': () => stage.zoomBy(0.8, middle.x, middle.y),
        0: () => stage.fit(),
        1: () => stage.zoomTo(stage.fullScale(), middle.x, middle.y),
        b: () => model.photo.live || setComparing(!model.comparing),
        Escape: () => {
            brush?.cancel();
            stage.set({ cursor: null });
        },
    };

    if (event.target !== $('stage') || event.ctrlKey || event.metaKey || event.altKey ||
            !keys[event.key] || !model.photo)
        return;
    event.preventDefault();
    keys[event.key]();
}

function placeDivider(part) {
    const at = Math.min(Math.max(part, 0), 1), n = Math.round(at * 100);
    const divider = $('divider');

    stage.set({ divider: at });
    divider.style.left = `${at * 100}%`;
    divider.setAttribute('aria-valuenow', n);
    divider.setAttribute('aria-valuetext', say('dividerAt', { n }));
}

function startDivider() {
    const divider = $('divider');
    const box = () => $('stage').getBoundingClientRect();

    divider.addEventListener('pointerdown', (event) => {
        divider.setPointerCapture(event.pointerId);
        event.stopPropagation();
    });
    divider.addEventListener('pointermove', (event) => {
        if (divider.hasPointerCapture(event.pointerId))
            placeDivider((event.clientX - box().left) / box().width);
    });
    divider.addEventListener('keydown', (event) => {
        const by = { ArrowLeft: -0.02, ArrowDown: -0.02, ArrowRight: 0.02, ArrowUp: 0.02,
            PageUp: 0.1, PageDown: -0.1, Home: -1, End: 1 }[event.key];
        if (by === undefined)
            return;
        event.preventDefault();
        event.stopPropagation();
        placeDivider(stage.divider + by);
    });
}

function startButtons() {
    $('zoom-in').addEventListener('click', () => stage.zoomBy(1.5));
    $('zoom-out').addEventListener('click', () => stage.zoomBy(1 / 1.5));
    $('zoom-fit').addEventListener('click', () => stage.fit());
    $('zoom-full').addEventListener('click', () => stage.show(stage.fullScale(),
        model.mark ?? stage.toPhoto(stage.width / 2, stage.height / 2)));
    $('compare').addEventListener('click', () => setComparing(!model.comparing));
    // A finger that is down anywhere, on a slider, too, waits for no full picture.
    addEventListener('pointerdown', () => pictures.hold(true), true);
    for (const end of ['pointerup', 'pointercancel'])
        addEventListener(end, () => pictures.hold(false), true);
}

export function startViewer() {
    stage = new Stage($('canvas'), () => ask());
    pictures = new Pictures({
        failed,
        busy: (yes) => setBusy('picture', yes),
        show(bitmap, job) {
            stage.setPicture('after', bitmap);
            for (const heard of pictureListeners)
                heard(bitmap, job);
        },
        showBefore: (bitmap) => stage.setPicture('before', bitmap),
    });
    listenTo($('canvas'), fingers);
    $('stage').addEventListener('keydown', stageKey);
    startDivider();
    startButtons();
    const chooseView = radios($('views'), 'view',
        Object.entries(VIEWS).map(([value, word]) => ({ value, label: say(word) })), setView);
    chooseView('picture');
    listen((cause) => {
        if (cause === 'photo') {
            pictures.forget();
            stage.open(model.photo);
        }
        if (cause === 'mark')
            announce(say('focused'));
        chooseView(model.view);
        $('compare').setAttribute('aria-pressed', model.comparing);
        $('divider').hidden = !model.comparing;
        if (!model.comparing)
            stage.set({ divider: null });
        else if (stage.divider === null)
            placeDivider(0.5);
        stage.set({ mark: model.mark });
        ask();
    });
}
