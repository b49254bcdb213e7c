// Small parts that the panels are made of.
import { say } from './words.js';

export const $ = (id) => document.getElementById(id);

/** An element with properties, and attributes where there is no such property. */
export function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);

    for (const [name, value] of Object.entries(properties)) {
        if (name in element)
            element[name] = value;
        else
            element.setAttribute(name, value);
    }
    element.append(...children);
    return element;
}

/** One line that is seen and read aloud; an error stays until the next line. */
export function announce(text, isError = false) {
    const line = $('said');

    line.textContent = text;
    line.classList.toggle('error', isError);
}

export function announceError(error) {
    announce(error.message, true);
}

const STEPS = 1000;

/** A slider with its name and value; `moved(part)` is told of parts from 0 to 1. Its `set(part,
 * text)` shows a value. */
export function slider({ id, label, ends, moved, extra }) {
    const input = make('input', { type: 'range', id, min: 0, max: STEPS, step: 1 });
    const output = make('output', { id: `${id}-value` });
    const name = make('label', { htmlFor: id, textContent: say(label) });
    const row = make('div', { className: 'slider' },
        make('div', { className: 'slider-head' }, name, output, ...(extra ? [extra] : [])), input);

    if (ends)
        row.append(make('div', { className: 'ends', 'aria-hidden': 'true' },
            ...ends.map((end) => make('span', { textContent: say(end) }))));
    output.setAttribute('for', id);
    input.addEventListener('input', () => moved(input.value / STEPS));
    return {
        row, input, name,
        set(part, text) {
            const value = Math.round(part * STEPS);
            if (Number(input.value) !== value)
                input.value = value;
            input.style.setProperty('--part', `${part * 100}%`);
            input.setAttribute('aria-valuetext', text);
            output.value = text;
        },
    };
}

/** Radio buttons that look like chips or cards. Options are { value, label, picture }; the
 * picture, an element, comes before the label. Returns `choose(value)`, which shows a choice. */
export function radios(root, name, options, picked) {
    const inputs = options.map(({ value, label, picture }) => {
        const input = make('input', { type: 'radio', name, value, className: 'unseen' });

        root.append(make('label', {}, input, ...(picture ? [picture] : []),
            make('span', { textContent: label })));
        input.addEventListener('change', () => picked(value));
        return input;
    });
    return (value) => {
        for (const input of inputs)
            input.checked = input.value === String(value);
    };
}
