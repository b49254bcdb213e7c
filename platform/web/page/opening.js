// Opening a photo: dropped, chosen from the device, from the folder of the server, or by a link.
import { $, announce, announceError, make } from './dom.js';
import { model, openPhoto, setTab } from './model.js';
import * as server from './server.js';
import { fromLink } from './settings.js';
import { strokesMade } from './painting.js';
import { onPicture, thePictures } from './viewer.js';
import { say } from './words.js';

const AT_ONCE = 2; // small pictures that are asked for at a time
const MOST_FAILURES = 2; // then full pictures are taken for what makes its process fail

let listed = { photos: [] };
let source = null; // { name } in the folder or { file }: what is open
let opening = null; // { name, abort } of what is under way; abort(), where it can be given up
let again = null; // a promise, once it was opened again
let failures = 0; // processes of this photo that have failed since its last full picture

export function showScreen(screen) {
    document.body.dataset.screen = screen;
    $('name').textContent = screen === 'open' ? say('title')
        : model.photo.live ? say('live') : model.photo.name;
    $('opening').hidden = screen !== 'open';
    $('editing').hidden = screen === 'open';
    for (const id of ['views', 'compare', 'save'])
        $(id).hidden = screen === 'open';
    $('capture').hidden = screen === 'open' || !model.photo.live;
    $('open').hidden = screen === 'open';
    $('back').hidden = !model.photo;
}

/** True when it was opened; if not, the line says why. */
async function open(what, look = null, own = {}, again = false) {
    const name = what.live ? say('live') : what.name ?? what.file.name;

    if (opening && !opening.abort) {
        announce(say('stillOpening', { name: opening.name }));
        return false;
    }
    if (what.file && listed.upload_limit && what.file.size > listed.upload_limit) {
        announce(say('tooLarge', { name, n: Math.floor(listed.upload_limit / (1 << 20)) }), true);
        return false;
    }
    const sending = what.file ? new AbortController() : null;
    const mine = { name, abort: sending && (() => sending.abort()) };
    let done = false;
    opening?.abort();
    opening = mine;
    announce(say(what.file ? 'sending' : 'opening', { name }));
    document.body.classList.add('waiting');
    try {
        const photo = what.file ? await server.uploadPhoto(what.file, sending.signal)
            : what.live ? await server.openLive() : await server.openPhoto(what.name);
        if (model.photo)
            server.close(model.photo.session);
        source = what;
        photo.sent = what.file ? `${what.file.size} ${what.file.lastModified}` : '';
        if (!again)
            failures = 0;
        thePictures().quickAlone = failures >= MOST_FAILURES;
        show(photo, look, own, again);
        done = true;
    } catch (error) {
        if (error.name !== 'AbortError')
            announceError(error);
    }
    if (opening === mine) {
        document.body.classList.remove('waiting');
        opening = null;
    }
    return done;
}

function show(photo, look, own, again) {
    document.title = say('titleOf', { name: photo.live ? say('live') : photo.name });
    model.photo = photo;
    showScreen('edit');
    openPhoto(photo, look, own, again);
    setTab(photo.depth ? 'adjust' : 'paint');
    announce(say(photo.live ? 'openedLive' : photo.depth ? 'opened' : 'openedFlat',
        { name: photo.name }));
    if (document.activeElement !== document.body)
        $('stage').focus({ preventScroll: true });
}

/** The photo is opened again, with the settings and the strokes that it had, and by quick pictures
 * alone where full ones make its process fail. */
async function openAgain() {
    const quick = failures >= MOST_FAILURES, { tab } = model;

    if (!await open(source, model.look?.name, model.own, true))
        return false;
    if (source.live)
        return true;
    setTab(tab);
    await strokesMade();
    announce(say(quick ? 'quickAlone' : 'openedAgain', { name: model.photo.name }), quick);
    return true;
}

/** A session is no more. True, once the photo is open in another one. */
async function onLost(session, failed) {
    if (!source || session !== model.photo.session)
        return Boolean(source);
    if (failed && failures++ === MOST_FAILURES) { // until something else is asked of it
        announce(say('failsAlways', { name: $('name').textContent }), true);
        return false;
    }
    if (!opening)
        again = openAgain();
    return again;
}

export const openFile = (file) => open({ file });
export const openLiveAgain = () => open({ live: true });

function card({ name, depth }) {
    const image = make('img', { alt: '', width: 160, height: 120 });
    const badge = make('span', { className: 'badge' });
    const button = make('button', { className: 'photo' }, image,
        make('span', { className: 'photo-name', textContent: name }), badge);
    const mark = (known) => {
        badge.hidden = known === null;
        badge.textContent = say(known ? 'withDepth' : 'withoutDepth');
        badge.classList.toggle('none', !known);
        button.setAttribute('aria-label', known === null ? name
            : say(known ? 'photoWith' : 'photoWithout', { name }));
    };

    mark(depth);
    button.addEventListener('click', () => open({ name }));
    return { name, image, mark, item: make('li', {}, button) };
}

/** Small pictures are asked for as their cards come into sight, a few at a time, so that opening a
 * photo does not wait for a folder. */
function fetchThumbnails(cards) {
    const inSight = [];
    let under = 0;

    const next = async () => {
        if (under === AT_ONCE || inSight.length === 0)
            return;
        const one = inSight.shift();
        under++;
        try {
            const { blob, depth } = await server.thumbnail(one.name);
            one.image.onload = () => URL.revokeObjectURL(one.image.src);
            one.image.src = URL.createObjectURL(blob);
            one.mark(depth);
        } catch {
            one.image.classList.add('missing');
        }
        under--;
        next();
    };
    const observer = new IntersectionObserver((entries) => {
        for (const entry of entries) {
            if (!entry.isIntersecting)
                continue;
            observer.unobserve(entry.target);
            inSight.push(cards.find(({ item }) => item === entry.target));
            next();
        }
    });

    for (const { item } of cards)
        observer.observe(item);
}

async function list() {
    listed = await server.listPhotos();
    const cards = listed.photos.map(card);

    $('live').hidden = !listed.live;
    $('folder').hidden = !listed.folder;
    $('unnamed').hidden = !listed.unnamed;
    $('unnamed').textContent = say('unnamed', { n: listed.unnamed });
    $('folder-empty').hidden = cards.length > 0;
    $('photos').replaceChildren(...cards.map(({ item }) => item));
    return cards;
}

function startDrop() {
    let over = 0; // how many elements deep the file is held
    const show = (by) => {
        over = Math.max(over + by, 0);
        $('drop').hidden = over === 0;
    };

    addEventListener('dragenter', (event) => {
        event.preventDefault();
        show(1);
    });
    addEventListener('dragleave', () => show(-1));
    addEventListener('dragover', (event) => event.preventDefault());
    addEventListener('drop', (event) => {
        const file = event.dataTransfer.files[0];
        event.preventDefault();
        show(-over);
        if (file)
            open({ file });
        else
            announce(say('noPhoto'), true);
    });
}

/** Open what the address of the page names, or, of none, what there is alone. */
async function follow({ photo, look, changes }) {
    const alone = listed.open ?? (listed.live && !listed.folder ? 'live' : null);
    const name = photo ?? alone;

    if (name)
        await open(listed.live && name === 'live' ? { live: true } : { name }, look,
            photo ? changes : {});
}

export async function startOpening() {
    startDrop();
    server.onLost(onLost);
    onPicture((bitmap, job) => {
        if (!job.quick && !job.kind)
            failures = 0;
    });
    showScreen('open');
    $('open').addEventListener('click', () => {
        showScreen('open');
        $('choose').focus();
    });
    $('back').addEventListener('click', () => {
        if (opening?.abort) {
            opening.abort();
            announce(say('givenUp', { name: opening.name }));
        }
        showScreen('edit');
        $('stage').focus();
    });
    $('choose').addEventListener('click', () => $('file').click());
    $('file').addEventListener('change', () => {
        const [file] = $('file').files;
        $('file').value = '';
        if (file)
            open({ file });
    });
    addEventListener('hashchange', () => follow(fromLink(location.hash)));
    addEventListener('pagehide', () => model.photo && server.close(model.photo.session));
    try {
        const cards = await list();
        await follow(fromLink(location.hash));
        fetchThumbnails(cards);
    } catch (error) {
        announceError(error);
    }
}
