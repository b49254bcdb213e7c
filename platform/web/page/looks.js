// The chooser of looks, each on a picture of this very photo, and of the aperture's shape.
import { mostDifferent } from './differ.js';
import { $, make, radios } from './dom.js';
import { change, chooseLook, listen, model, settings } from './model.js';
import { NAMES, over, without } from './settings.js';
import { thePictures } from './viewer.js';
import { say } from './words.js';

const SIZE = 640, SHOWN = 192; // sides of a small picture, and of what is shown of it
const PART = 0.36; // is shown of the shorter side
const BLUR = 0.08; // of the longer side: enough for the shape of highlights to be seen
const REST_MS = 400; // after the last change
const SHAPES = ['', 'disc', 'polygon:5', 'polygon:6', 'polygon:7', 'polygon:8', 'heart', 'star'];
const SVG = 'http://www.w3.org/2000/svg';

function shapeName(shape) {
    const blades = /^polygon:(\d+)/.exec(shape);

    return blades ? say('shapePolygon', { n: blades[1] }) : say(`shape.${shape || 'look'}`);
}

/** The outline of a shape, in a square from -1 to 1. */
function outline(shape) {
    const round = (n, radius) => Array.from({ length: n }, (_, i) => {
        const angle = 2 * Math.PI * i / n - Math.PI / 2;
        return `${radius(i) * Math.cos(angle)},${radius(i) * Math.sin(angle)}`;
    }).join('L');

    if (shape.startsWith('polygon:'))
        return `M${round(Number(shape.slice(8)), () => 0.9)}Z`;
    if (shape === 'star')
        return `M${round(10, (i) => (i % 2 ? 0.4 : 0.95))}Z`;
    if (shape === 'heart')
        return 'M0,.85C-1.3,-.1 -.85,-.8 -.45,-.8C-.2,-.8 0,-.6 0,-.4C0,-.6 .2,-.8 .45,-.8' +
            'C.85,-.8 1.3,-.1 0,.85Z';
    return 'M-.85,0A.85,.85 0 1 1 .85,0A.85,.85 0 1 1 -.85,0Z';
}

function drawing(shape) {
    const svg = document.createElementNS(SVG, 'svg'), path = document.createElementNS(SVG, 'path');

    svg.setAttribute('viewBox', '-1 -1 2 2');
    svg.setAttribute('aria-hidden', 'true');
    path.setAttribute('d', outline(shape));
    if (shape === '')
        path.setAttribute('class', 'dashed');
    svg.append(path);
    return svg;
}

function middle({ width, height }) {
    const side = Math.min(width, height);

    return { x: (width - side) / 2, y: (height - side) / 2, side };
}

/** A square of a picture, the middle one if none is given, into a small canvas. */
export function drawSquare(canvas, bitmap, { x, y, side } = middle(bitmap)) {
    const c = canvas.getContext('2d');

    c.imageSmoothingQuality = 'high';
    c.drawImage(bitmap, x, y, side, side, 0, 0, canvas.width, canvas.height);
}

let cards = [], chooseCard = () => {}, drawn = '', timer = 0;

function makeCards() {
    $('looks').replaceChildren();
    drawn = '';
    cards = (model.photo.presets ?? []).map((preset) => ({ preset,
        canvas: make('canvas', { width: SHOWN, height: SHOWN, 'aria-hidden': 'true' }) }));
    chooseCard = radios($('looks'), 'look', cards.map(({ preset, canvas }) => ({
        value: preset.name, label: say(`look.${preset.name}`) ?? preset.name, picture: canvas,
    })), (name) => chooseLook(cards.find(({ preset }) => preset.name === name).preset));
    for (const { preset, canvas } of cards)
        canvas.parentElement.title = preset.summary ?? '';
    $('looks').hidden = $('looks-title').hidden = cards.length === 0;
}

/** Each card, once all are there, shows the place where they differ most. */
function lookClosely(bitmaps) {
    const place = mostDifferent([...bitmaps.values()], PART);

    for (const [canvas, bitmap] of bitmaps) {
        drawSquare(canvas, bitmap, place);
        bitmap.close();
    }
}

/** Ask for the small pictures where the chooser is seen and they are out of date. */
function drawCards() {
    const { photo, depth, own } = model;
    const blur = { [NAMES.blur]: Math.min(BLUR * Math.max(photo.width, photo.height),
        photo.limits.blur) };
    const now = JSON.stringify([photo.session, depth, own]);

    clearTimeout(timer);
    if (model.tab !== 'look' || now === drawn || photo.live)
        return;
    timer = setTimeout(() => {
        drawn = now;
        const bitmaps = new Map(); // by canvas
        thePictures().wantLooks(cards.map(({ preset, canvas }) => ({
            size: SIZE,
            settings: over(over(over(photo.settings, preset.settings),
                without(own, preset.settings)), blur),
            done(bitmap) {
                drawSquare(canvas, bitmap);
                bitmaps.set(canvas, bitmap);
                if (bitmaps.size === cards.length)
                    lookClosely(bitmaps);
            },
        })));
    }, REST_MS);
}

/** The preset that the picture has now: the one that was chosen, or whose look it is. */
function present() {
    const now = settings();
    const same = ({ preset }) => Object.entries(preset.settings)
        .every(([name, value]) => now[name] === value);

    return model.look ?? cards.find(same)?.preset;
}

export function startLooks() {
    const chooseShape = radios($('shapes'), 'shape', SHAPES.map((shape) => ({ value: shape,
        label: shapeName(shape), picture: drawing(shape) })),
    (shape) => change({ [NAMES.aperture]: shape || undefined }));

    listen((cause) => {
        if (cause === 'photo')
            makeCards();
        chooseCard(present()?.name);
        chooseShape(model.own[NAMES.aperture] ?? '');
        drawCards();
    });
}
