// The rack focus: key frames that were marked, played on the page, and saved as an animation.
import { $, announce, announceError, make, slider } from './dom.js';
import { listen, model, restore, settings } from './model.js';
import { askAgain, pull } from './server.js';
import { inPixels, over, NAMES } from './settings.js';
import { drawSquare } from './looks.js';
import { saveFile } from './saving.js';
import { onPicture, showMoment } from './viewer.js';
import { say } from './words.js';

const MOVING = [NAMES.focus, NAMES.blur, NAMES.band]; // what differs from key to key
const USUAL = 1.5, LEAST = 0.1; // seconds from key to key
const THUMB = 128;

let keys = []; // { wait, own, look, settings, canvas }: wait is seconds from the one before
const latest = thumbnail(); // of the last picture, which is gone with the next one
let playing = 0, at = 0, time;

function thumbnail() {
    return make('canvas', { width: THUMB, height: THUMB, 'aria-hidden': 'true' });
}

/** The settings now; blur moves in pixels from key to key. */
const still = () => inPixels(settings(), model.photo);

const total = () => keys.reduce((sum, key) => sum + key.wait, 0);

/** Each key with its time from the beginning. */
function timed() {
    let sum = 0;

    return keys.map((key) => ({ ...key, time: (sum += key.wait) }));
}

/** The settings of a moment: slowly away from one key and slowly up to the next. */
function settingsAt(seconds) {
    const list = timed();
    const next = list.find((key) => key.time >= seconds) ?? list.at(-1);
    const last = list[Math.max(list.indexOf(next) - 1, 0)];
    const part = next === last ? 1 : (seconds - last.time) / (next.time - last.time);
    const smooth = part * part * (3 - 2 * part);
    const between = {};

    for (const name of MOVING) {
        const a = last.settings[name], b = next.settings[name];
        if (typeof a === 'number' && typeof b === 'number')
            between[name] = a + smooth * (b - a);
    }
    return over(still(), between);
}

function showTime() {
    const whole = total();

    time.set(whole ? at / whole : 0, say('timeAt', { n: at.toFixed(1) }));
}

function stop() {
    if (!playing)
        return;
    cancelAnimationFrame(playing);
    playing = 0;
    $('play').textContent = say('play');
}

function leave() {
    stop();
    showMoment(null);
}

function play() {
    const from = at >= total() ? 0 : at, began = performance.now();
    const frame = (now) => {
        at = Math.min(from + Math.max(now - began, 0) / 1000, total());
        showMoment(settingsAt(at));
        showTime();
        playing = requestAnimationFrame(frame);
        if (at >= total())
            stop();
    };

    $('play').textContent = say('stop');
    playing = requestAnimationFrame(frame);
}

/** Seconds that are left of the longest film beside so many. */
const left = (others) => Number((model.photo.limits.pull_seconds - others).toFixed(1));

const sayMost = () => announce(say('pullMost', { n: model.photo.limits.pull_seconds }), true);

function mark() {
    const canvas = thumbnail(), most = left(total());

    if (most < LEAST) {
        sayMost();
        return;
    }
    leave();
    canvas.getContext('2d').drawImage(latest, 0, 0);
    keys.push({ wait: keys.length ? Math.min(USUAL, most) : 0, own: { ...model.own }, look: model.look,
        settings: still(), canvas });
    announce(say('marked', { n: keys.length }));
    showKeys();
}

function remove(i) {
    leave();
    keys.splice(i, 1);
    if (keys.length)
        keys[0].wait = 0;
    announce(say('removed', { n: i + 1 }));
    showKeys();
    ($('keys').querySelectorAll('.remove')[Math.min(i, keys.length - 1)] ?? $('mark')).focus();
}

function keyItem(key, i) {
    const n = i + 1;
    const show = make('button', { className: 'card', 'aria-label': say('goTo', { n }) },
        key.canvas);
    const gone = make('button', { className: 'remove', textContent: '×',
        'aria-label': say('remove', { n }) });
    const wait = i === 0 ? make('span', { textContent: say('start') })
        : make('input', { type: 'number', min: LEAST, max: left(0), step: LEAST, value: key.wait,
            'aria-label': say('secondsTo', { n }) });

    show.addEventListener('click', () => {
        leave();
        restore(key.look, { ...key.own });
    });
    gone.addEventListener('click', () => remove(i));
    wait.addEventListener('change', () => {
        const wanted = Math.round(10 * (Number(wait.value) || USUAL)) / 10;
        const most = left(total() - key.wait);
        key.wait = Math.min(Math.max(wanted, LEAST), most);
        wait.value = key.wait;
        if (wanted > most)
            sayMost();
        at = 0;
        showTime();
    });
    return make('li', {}, show,
        make('span', { className: 'wait' }, wait, i ? say('seconds') : ''), gone);
}

function showKeys() {
    $('keys').replaceChildren(...keys.map(keyItem));
    $('playing').hidden = keys.length < 2;
    at = 0;
    showTime();
}

async function save(format, button) {
    const name = say(`format.${format}`) ?? format;
    const list = timed().map((key) => Object.fromEntries([['time', Number(key.time.toFixed(3))],
        ...MOVING.filter((of) => typeof key.settings[of] === 'number')
            .map((of) => [of, key.settings[of]])]));
    const fixed = still();

    for (const of of MOVING)
        delete fixed[of];
    leave();
    announce(say('pullWaits', { format: name }));
    button.disabled = true;
    try {
        saveFile(await askAgain(() => pull(model.photo.session, format, fixed, list)));
    } catch (error) {
        announceError(error);
        button.hidden = error.status === 404;
    }
    button.disabled = false;
}

function makeSaveButtons() {
    const { films = [] } = model.photo; // formats that the server can write

    $('pull-buttons').replaceChildren($('play'), ...films.map((format) => {
        const button = make('button', { 'data-format': format,
            textContent: say('savePull', { format: say(`format.${format}`) ?? format }) });
        button.addEventListener('click', () => save(format, button));
        return button;
    }));
}

export function startRack() {
    time = slider({ id: 'moment', label: 'time', moved(part) {
        stop();
        at = part * total();
        showMoment(settingsAt(at));
        showTime();
    } });
    $('time').append(time.row);
    $('mark').addEventListener('click', mark);
    $('play').addEventListener('click', () => (playing ? stop() : play()));
    onPicture((bitmap, job) => {
        if (!job.kind)
            drawSquare(latest, bitmap);
    });
    listen((cause) => {
        if (cause === 'photo') {
            leave();
            if (!model.again)
                keys = [];
            latest.width = THUMB; // empties it
            makeSaveButtons();
            showKeys();
        } else if (cause !== 'view') {
            leave();
        }
    });
}
