// The server: every question of the page to it, and what an error says.
import { say } from './words.js';

/** An answer of 400 or more, or none of this server: `status` is 0 then. The message is one line for people. */
export class ServerError extends Error {
    constructor(status, message) {
        super(message);
        this.status = status;
    }
}

/** An address that the server does not know for one of its own says nothing: that of the link
 * before it was started anew. */
async function explain(response) {
    const { status } = response;

    try {
        const { error } = await response.json();
        if (typeof error === 'string' && error)
            return new ServerError(status, error);
    } catch {
        // no JSON: the status has to do
    }
    return status === 404 ? new ServerError(0, say('anew'))
        : new ServerError(status, say('refused', { status }));
}

const ENDED = 410, FAILED = 502; // a session is no more: forgotten, or its process has failed
let lost = () => {}, opened = Promise.resolve(false);

/** `heard(session, failed)` is called when a session is no more: the server has forgotten it, which
 * it may do for memory, or its process has failed. It promises whether there is another one. */
export function onLost(heard) {
    lost = heard;
}

export const isLost = (error) => error.status === ENDED || error.status === FAILED;

function address(path, query) {
    const text = new URLSearchParams(query).toString();
    return text ? `${path}?${text}` : path;
}

async function ask(method, path, query, body, signal) {
    let response;

    try {
        response = await fetch(address(path, query), { method, body, signal });
    } catch (error) {
        if (error.name === 'AbortError')
            throw error;
        throw new ServerError(0, body instanceof File ? say('cutOff', { name: body.name })
            : say('unreachable'));
    }
    if (!response.ok) {
        const error = await explain(response);
        if (isLost(error))
            opened = lost(query?.session, error.status === FAILED);
        throw error;
    }
    return response;
}

/** The answer to a question, which is asked once more where the session had ended. */
export async function askAgain(question) {
    try {
        return await question();
    } catch (error) {
        if (error.status !== ENDED || !await opened)
            throw error;
        return question();
    }
}

const json = (value) => JSON.stringify(value);

export async function listPhotos() {
    return (await ask('GET', 'photos')).json();
}

/** A small picture of a photo in the folder, and whether it has depth. */
export async function thumbnail(photo) {
    const response = await ask('GET', 'thumbnail', { photo });
    return { blob: await response.blob(), depth: response.headers.get('Refocus-Depth') === 'yes' };
}

export async function openPhoto(name) {
    return (await ask('POST', 'open', { photo: name })).json();
}

/** The server takes no hidden names, and none with a path or control characters. */
const plain = (name) => name.replace(/[/\\\x00-\x1f\x7f]/g, '_').replace(/^\.+/, '') || 'photo';

/** The photo is sent until `signal` says that it is not wanted any more. */
export async function uploadPhoto(file, signal) {
    return (await ask('POST', 'upload', { name: plain(file.name) }, file, signal)).json();
}

/** The session of the camera, which others may look at, too. */
export async function openLive() {
    return (await ask('POST', 'live')).json();
}

/** A session that is left, even when the page is being closed. */
export function close(session) {
    fetch(address('close', { session }), { method: 'POST', keepalive: true }).catch(() => {});
}

export async function focusAt(session, x, y) {
    return (await (await ask('POST', 'focus', { session }, json({ x, y }))).json()).focus;
}

let request = 0;

/** A picture, or an overlay of a kind. `size` is its longer side, 0 = the photo's own; a quick one
 * is worked out at that size, others are made smaller. */
export async function picture(session, settings, { kind, size, quick, signal }) {
    const query = { session, size, request: ++request };

    if (kind)
        query.kind = kind;
    else if (quick)
        query.quick = 1;
    const response = await ask('POST', kind ? 'overlay' : 'picture', query, json(settings), signal);
    return createImageBitmap(await response.blob());
}

/** A frame of the camera that is newer than one, if it comes: { bitmap, number }. */
export async function frame(session, settings, { kind, size, after }) {
    const query = { session, kind, size, after };
    const response = await ask('POST', 'frame', query, json(settings));

    return { bitmap: await createImageBitmap(await response.blob()),
        number: Number(response.headers.get('Refocus-Frame')) };
}

export async function stroke(session, what) {
    return (await ask('POST', 'stroke', { session }, json(what))).json();
}

/** A stroke that is not finished, {} for none any more: { selection }, which is null or { width,
 * height, runs } with the first pixel and the length of each run. */
export async function draft(session, what) {
    return (await ask('POST', 'draft', { session }, json(what))).json();
}

export async function undo(session) {
    return (await ask('POST', 'undo', { session })).json();
}

export async function redo(session) {
    return (await ask('POST', 'redo', { session })).json();
}

export async function listStrokes(session) {
    return (await ask('GET', 'strokes', { session })).json();
}

/** A file: its bytes, and the name that the server gives it. */
async function file(path, query, body) {
    const response = await ask('POST', path, query, json(body));
    const header = response.headers.get('Content-Disposition') ?? '';
    const found = /filename\*=UTF-8''([^;]+)/i.exec(header);
    return { blob: await response.blob(),
        name: found ? decodeURIComponent(found[1]) : `refocus.${query.as}` };
}

export const save = (session, as, settings) => file('save', { session, as }, settings);
/** The frame of the camera, in focus everywhere, with its depth. */
export const capture = (session, settings) => save(session, 'jpeg', settings);
export const pull = (session, as, settings, keys) =>
    file('pull', { session, as, size: 0 }, { ...settings, keys });
