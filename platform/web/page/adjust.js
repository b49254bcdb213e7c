// The sliders for focus, blur, highlights, the band in focus and the tilt of its plane.
import { $, announce, make, slider } from './dom.js';
import { change, listen, model, reset, settings, tilted } from './model.js';
import { NAMES } from './settings.js';
import { STEEPEST, turnOf } from './tilt.js';
import { say } from './words.js';

const WIDEST_BAND = 0.5; // disparities to either side

/** A number as people write it: two figures, and no more. */
const short = (value) => (value < 9.95 ? Number(value.toFixed(1)) : Math.round(value));
const percent = (part) => Math.round(100 * part);

/** The blur is that of a lens, whose f-number is known. */
const metric = () => Boolean(model.photo.limits.f_number && settings()[NAMES.fNumber]);

/** Where the focus may be: all of it where there is no depth, or one alone. */
function range() {
    const [least, most] = model.photo.range ?? [0, 1];

    return least < most ? [least, most] : [0, 1];
}

// Each slider: `part(settings)` is where it stands from 0 to 1, `value(part)` what that means, and
// `text(settings)` what is said of it.
const SLIDERS = {
    focus: {
        ends: ['far', 'near'],
        part: (s) => (s[NAMES.focus] - range()[0]) / (range()[1] - range()[0]),
        value: (p) => ({ [NAMES.focus]: range()[0] + p * (range()[1] - range()[0]) }),
        text: (s) => say('focusAt', { n: percent(s[NAMES.focus]) }),
    },
    // More blur is to the right: f/16 left, f/1.4 right, a stop as wide as each other.
    aperture: {
        ends: ['sharp', 'soft'],
        shown: metric,
        part(s) {
            const [least, most] = model.photo.limits.f_number;
            return Math.log(most / s[NAMES.fNumber]) / Math.log(most / least);
        },
        value(p) {
            const [least, most] = model.photo.limits.f_number;
            return { [NAMES.fNumber]: Number((most * (least / most) ** p).toPrecision(3)) };
        },
        text: (s) => say('fNumber', { n: short(s[NAMES.fNumber]) }),
    },
    blur: {
        ends: ['sharp', 'soft'],
        shown: () => !metric(),
        part: (s) => Math.sqrt((s[NAMES.blur] ?? 0) / model.photo.limits.blur),
        value: (p) => ({ [NAMES.blur]: Number((model.photo.limits.blur * p * p).toFixed(2)) }),
        text: (s) => say('pixels', { n: short(s[NAMES.blur] ?? 0) }),
    },
    // The light that is given back, from none to the most, a doubling as wide as each other.
    highlights: {
        ends: ['off', 'most'],
        part(s) {
            const gain = s[NAMES.highlights];
            return typeof gain === 'number' ? Math.log(gain) / Math.log(mostLight()) : 0;
        },
        value: (p) => ({ [NAMES.highlights]: p === 0 ? 'off'
            : Number((mostLight() ** p).toFixed(2)) }),
        text(s) {
            const gain = s[NAMES.highlights];
            return gain === 'auto' ? say('autoValue') : typeof gain !== 'number' ? say('off')
                : say('highlightsAt', { n: short(gain) });
        },
    },
    band: {
        ends: ['thin', 'deep'],
        part: (s) => Math.sqrt((s[NAMES.band] ?? 0) / WIDEST_BAND),
        value: (p) => ({ [NAMES.band]: Number((WIDEST_BAND * p * p).toFixed(4)) }),
        text: (s) => say('bandAt', { n: short(100 * (s[NAMES.band] ?? 0)) }),
    },
    tilt: {
        part: (s) => ((s[NAMES.tilt] ?? 0) / STEEPEST + 1) / 2,
        value: (p) => tilted(Math.round((2 * p - 1) * STEEPEST)),
        text: (s) => say('tiltAt', { n: s[NAMES.tilt] ?? 0 }),
    },
    turn: {
        shown: () => Boolean(settings()[NAMES.tilt]),
        part: (s) => turnOf(s[NAMES.tiltLine]) / 180 + 0.5,
        value: (p) => tilted(settings()[NAMES.tilt], Math.round(180 * p - 90)),
        text: (s) => say('tiltAt', { n: turnOf(s[NAMES.tiltLine]) }),
    },
};

const mostLight = () => model.photo.limits.highlights[1];

export function startAdjust() {
    const auto = make('button', { id: 'auto', className: 'small', textContent: say('auto'),
        'aria-pressed': 'false', 'aria-label': say('autoName') });
    const rows = Object.entries(SLIDERS).map(([id, one]) => {
        const row = slider({ id, label: id, ends: one.ends,
            extra: id === 'highlights' ? auto : null, moved: (part) => change(one.value(part)) });
        $('sliders').append(row.row);
        return { one, row };
    });

    auto.addEventListener('click', () => change({ [NAMES.highlights]:
        settings()[NAMES.highlights] === 'auto' ? 'off' : 'auto' }));
    $('reset').addEventListener('click', () => {
        reset();
        announce(say('resetDone'));
    });
    listen(() => {
        const now = settings();
        for (const { one, row } of rows) {
            row.row.hidden = one.shown ? !one.shown() : false;
            if (!row.row.hidden)
                row.set(Math.min(Math.max(one.part(now), 0), 1), one.text(now));
        }
        auto.setAttribute('aria-pressed', now[NAMES.highlights] === 'auto');
    });
}
