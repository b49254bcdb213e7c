// The save menu: files that the server makes, and the link to the settings.
import { $, announce, announceError, make } from './dom.js';
import { listen, model, settings } from './model.js';
import { askAgain, save } from './server.js';
import { toLink } from './settings.js';
import { say } from './words.js';

const FILES = { jpeg: 'saveJpeg', png: 'savePng', settings: 'saveSettings', depth: 'saveDepth' };
const LINK_MS = 300; // after the last change, the address of the page follows

/** Give a file to the person, as a download. */
export function saveFile({ blob, name }) {
    const address = URL.createObjectURL(blob);

    make('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
    announce(say('saved', { name }));
}

/** What the open menu covers in part cannot be hit. */
function open(yes) {
    for (const part of $('editing').children)
        part.inert = yes;
    $('save-menu').hidden = !yes;
    $('save').setAttribute('aria-expanded', yes);
}

async function saveAs(as, item) {
    open(false);
    $('save').focus();
    announce(say('saving'));
    try {
        saveFile(await askAgain(() => save(model.photo.session, as, settings())));
    } catch (error) {
        announceError(error);
        item.hidden = error.status === 404;
    }
}

/** The link to the photo; of one that was sent, which the server keeps for nobody, to the page. */
function link() {
    return new URL(model.photo.sent ? location.pathname
        : toLink(model.photo.name, model.look?.name, model.own), location).href;
}

/** Pages that come over a network without encryption may not write to the clipboard: there the
 * link is shown to be copied. */
async function copyLink(item) {
    try {
        await navigator.clipboard.writeText(link());
        open(false);
        $('save').focus();
        announce(say('linkCopied'));
    } catch {
        const field = make('input', { type: 'text', readOnly: true, value: link(),
            'aria-label': say('linkShown') });
        item.after(field);
        field.select();
        field.addEventListener('blur', () => field.remove());
    }
}

function item(word, chosen) {
    const button = make('button', {},
        make('span', { textContent: say(word) }),
        make('small', { textContent: say(`${word}More`) }));

    button.addEventListener('click', () => chosen(button));
    return button;
}

export function startSaving() {
    const menu = $('save-menu');
    let timer = 0;

    for (const [as, word] of Object.entries(FILES)) {
        const button = item(word, (chosen) => saveAs(as, chosen));
        button.id = `save-${as}`;
        menu.append(button);
    }
    const copy = item('link', copyLink);
    copy.id = 'copy-link';
    menu.append(copy);
    $('save').addEventListener('click', () => open(menu.hidden));
    addEventListener('keydown', (event) => {
        if (event.key === 'Escape' && !menu.hidden) {
            open(false);
            $('save').focus();
        }
    });
    addEventListener('pointerdown', (event) => {
        if (!menu.parentElement.contains(event.target))
            open(false);
    });
    menu.parentElement.addEventListener('focusout', (event) => {
        if (event.relatedTarget && !menu.parentElement.contains(event.relatedTarget))
            open(false);
    });
    listen(() => {
        copy.hidden = Boolean(model.photo.sent);
        clearTimeout(timer);
        timer = setTimeout(() => history.replaceState(null, '', link()), LINK_MS);
    });
}
