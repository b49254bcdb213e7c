// Depth by a finger: the ground first, then objects over it. Each stroke is seen under the finger
// with what it selects, and can be taken back.
import { $, announce, announceError, make, radios, slider } from './dom.js';
import { Drafts } from './drafts.js';
import { keepStrokes, keptStrokes } from './kept.js';
import { depthChanged, listen, model } from './model.js';
import { listStrokes, redo, stroke, undo } from './server.js';
import { setBrush, setBusy, theStage, thePictures } from './viewer.js';
import { say } from './words.js';

const TOOLS = ['ground', 'object', 'gradient', 'more', 'less'];
const LINES = ['ground', 'gradient']; // drawn as a straight line, along which the depth runs
const LEAST = 3, MOST = 90; // radius of the brush, CSS pixels
const APART = 2; // CSS pixels between two points of a stroke

const tool = { kind: 'object', radius: 20, from: 0.8, to: 0.2 };
let done = [], undone = []; // strokes: { kind, what }, as the person and the server call them
let path = null; // points of the stroke that is being made
let queue = Promise.resolve(); // strokes go one after another
const drafts = new Drafts();
let chooseTool = () => {}, rows = {};

/** A stroke in the words of the server: pixels of the photo. */
function inPixels({ kind, points, radius }) {
    const { width, height } = model.photo;
    const pixel = ({ x, y }) => [Math.round(Math.min(Math.max(x, 0), 1) * (width - 1) * 10) / 10,
        Math.round(Math.min(Math.max(y, 0), 1) * (height - 1) * 10) / 10];
    const places = points.map(pixel);
    const slope = [[...places[0], tool.from], [...places.at(-1), tool.to]];
    const flat = places[0].join() === places.at(-1).join();

    if (kind === 'ground')
        return flat ? { kind: 'all', disparity: tool.from } : { kind: 'all', gradient: slope };
    if (kind === 'gradient')
        return flat ? { kind: 'fill', disparity: tool.from } : { kind: 'fill', gradient: slope };
    const brush = { kind, radius, points: places };
    return kind === 'object' ? { ...brush, disparity: tool.from } : brush;
}

/** The server's kinds have other names here; a session may have been painted before. */
const called = { all: 'ground', fill: 'gradient' };

function later(work) {
    setBusy('strokes', true);
    queue = queue.then(work).catch((error) => {
        if (error.status !== 404) {
            announceError(error);
            return;
        }
        $('tab-paint').hidden = true;
        if (model.tab === 'paint')
            $('tab-adjust').click();
    }).finally(() => setBusy('strokes', false));
    return queue;
}

function send(made) {
    const { photo } = model, what = inPixels(made);

    later(async () => {
        let range;
        try {
            await drafts.end();
            ({ range } = await thePictures().pauseFor(() => stroke(photo.session, what)));
        } finally {
            theStage().set({ path: null, selection: null });
        }
        if (photo !== model.photo)
            return;
        done.push({ kind: made.kind, what });
        undone = [];
        announce(say('painted', { kind: say(made.kind) }));
        depthChanged(range);
    });
}

/** When all strokes so far are made. */
export const strokesMade = () => queue;

/** Make the strokes that are kept again, on a session that is new. */
async function paintAgain(photo) {
    const strokes = keptStrokes(photo);
    let range;

    for (const { what } of strokes) {
        if (photo !== model.photo)
            return;
        ({ range } = await thePictures().pauseFor(() => stroke(photo.session, what)));
    }
    if (strokes.length === 0 || photo !== model.photo)
        return;
    done = strokes;
    depthChanged(range);
    announce(say('strokesAgain', { name: photo.name }));
}

/** Back or forth until so many strokes are done: `wanted()` is asked once those before it are made. */
function goTo(wanted) {
    const { photo } = model;

    later(async () => {
        const number = Math.min(Math.max(wanted(), 0), done.length + undone.length);
        const back = number < done.length;
        let range;
        if (photo !== model.photo || number === done.length)
            return;
        while (done.length !== number) {
            ({ range } = await thePictures().pauseFor(() => (back ? undo : redo)(photo.session)));
            if (photo !== model.photo)
                return;
            if (back)
                undone.push(done.pop());
            else
                done.push(undone.pop());
        }
        announce(say(back ? 'undone' : 'redone'));
        depthChanged(range);
    });
}

const step = (by) => goTo(() => done.length + by);

function showList() {
    const all = [...done, ...[...undone].reverse()];

    $('undo').disabled = done.length === 0;
    $('redo').disabled = undone.length === 0;
    $('strokes-none').hidden = all.length > 0;
    $('strokes').replaceChildren(...all.map(({ kind }, i) => {
        const values = { n: i + 1, kind: say(kind) };
        const button = make('button', { textContent: say('strokeAt', values),
            className: i < done.length ? '' : 'undone',
            'aria-label': say(i < done.length ? 'backTo' : 'forthTo', values) });
        if (i === done.length - 1)
            button.setAttribute('aria-current', 'step');
        button.addEventListener('click', () => goTo(() => i + 1));
        return make('li', {}, button);
    }));
}

/** More and less need an object, a slope needs something painted. */
function needs(kind) {
    return kind === 'ground' || kind === 'object' ||
        (kind === 'gradient' ? done.length > 0 : done.some((one) => one.kind === 'object'));
}

function showTool() {
    const line = LINES.includes(tool.kind);

    chooseTool(tool.kind);
    for (const input of $('brushes').querySelectorAll('input'))
        input.disabled = !needs(input.value);
    $('brush-help').textContent = say(`${tool.kind}Help`);
    rows.size.row.hidden = line;
    rows.from.row.hidden = tool.kind === 'more' || tool.kind === 'less';
    rows.to.row.hidden = !line;
    rows.from.name.textContent = say(line ? 'depthStart' : 'depth');
    rows.size.set(Math.sqrt((tool.radius - LEAST) / (MOST - LEAST)),
        say('pixels', { n: Math.round(2 * tool.radius) }));
    rows.from.set(tool.from, say('focusAt', { n: Math.round(100 * tool.from) }));
    rows.to.set(tool.to, say('focusAt', { n: Math.round(100 * tool.to) }));
}

function pick(kind) {
    tool.kind = kind;
    showTool();
}

function showPath() {
    theStage().set({ selection: path && theStage().selection, path: path && { points: path.points, radius: tool.radius,
        line: LINES.includes(path.kind) } });
}

/** A stroke so far goes to the server once those before it are done. */
function sendDraft() {
    const { photo } = model;

    queue.then(() => path && drafts.send(photo, inPixels(path)));
}

const brush = {
    begin(at) {
        const radius = Math.min(Math.max(tool.radius / theStage().scale, 0.5), 4096);
        path = { kind: tool.kind, points: [at], radius };
        showPath();
    },
    drag(at) {
        const stage = theStage();
        if (!path)
            return;
        const last = stage.toStage(path.points.at(-1)), here = stage.toStage(at);
        if (LINES.includes(path.kind))
            path.points = [path.points[0], at];
        else if (Math.hypot(here.x - last.x, here.y - last.y) >= APART)
            path.points.push(at);
        showPath();
        sendDraft();
    },
    end() {
        if (path)
            send(path);
        path = null;
    },
    cancel() {
        if (path)
            later(() => drafts.drop());
        path = null;
        showPath();
    },
    hover: (place) => theStage().set({ brush: place && !LINES.includes(tool.kind)
        ? { ...place, radius: tool.radius } : null }),
    /** Enter puts the brush down and lifts it. */
    key(at) {
        if (path) {
            brush.drag(at);
            brush.end();
        } else {
            brush.begin(at);
            announce(say('penDown'));
        }
    },
    moveTo: (at) => brush.drag(at),
};

function readStrokes() {
    const { photo } = model;

    done = [];
    undone = [];
    $('tab-paint').hidden = Boolean(photo.live);
    pick(photo.depth ? 'object' : 'ground');
    showList();
    if ($('tab-paint').hidden)
        return;
    later(async () => {
        const { strokes = [] } = await listStrokes(photo.session);
        if (strokes.length === 0)
            await paintAgain(photo);
        if (photo !== model.photo || strokes.length === 0)
            return;
        done = strokes.map((what) => ({ kind: called[what.kind] ?? what.kind, what }));
        showList();
        showTool();
    });
}

export function startPainting() {
    chooseTool = radios($('brushes'), 'brush', TOOLS.map((value) => ({ value, label: say(value) })),
        pick);
    rows = {
        size: slider({ id: 'brush-size', label: 'size', moved(part) {
            tool.radius = LEAST + part * part * (MOST - LEAST);
            showTool();
        } }),
        from: slider({ id: 'depth-from', label: 'depth', ends: ['far', 'near'], moved(part) {
            tool.from = part;
            showTool();
        } }),
        to: slider({ id: 'depth-to', label: 'depthEnd', ends: ['far', 'near'], moved(part) {
            tool.to = part;
            showTool();
        } }),
    };
    $('brush-sliders').append(...Object.values(rows).map((row) => row.row));
    $('undo').addEventListener('click', () => step(-1));
    $('redo').addEventListener('click', () => step(1));
    addEventListener('keydown', (event) => {
        if (model.tab !== 'paint' || !(event.ctrlKey || event.metaKey) || event.altKey)
            return;
        const letter = event.key.toLowerCase(), forth = letter === 'y' ||
            (letter === 'z' && event.shiftKey);
        if (letter !== 'z' && letter !== 'y')
            return;
        event.preventDefault();
        if (forth ? undone.length : done.length)
            step(forth ? 1 : -1);
    });
    listen((cause) => {
        if (cause === 'photo')
            readStrokes();
        if (cause === 'photo' || cause === 'tab' && model.tab !== 'paint')
            brush.cancel();
        if (cause === 'photo' || cause === 'tab')
            setBrush(model.tab === 'paint' ? brush : null);
        if (cause === 'depth') {
            keepStrokes(model.photo, done);
            thePictures().forget();
            showList();
            showTool();
        }
    });
}
