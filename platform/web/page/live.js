// The live view of a camera: the newest frame with the settings of the controls, one question at a
// time, so that a slow way to the server shows fewer frames and no older ones; and its capture,
// which is opened as a photo.
import { $, announce, announceError } from './dom.js';
import { listen, model, settings } from './model.js';
import { askAgain, capture, frame, isLost } from './server.js';
import { openFile, openLiveAgain } from './opening.js';
import { theStage } from './viewer.js';
import { say } from './words.js';

const PAUSE_MS = 500; // after an error that may pass

let running = false;
let complained = false; // the line says why there is no frame

/** An error that a while may mend: too much is asked, or the server cannot be reached. */
const passes = (error) => error.status === 503 || error.status === 0 || error.status === 409;

async function run() {
    const { photo } = model;
    let after = 0;

    running = true;
    while (model.photo === photo) {
        if (document.hidden || document.body.dataset.screen === 'open') {
            await new Promise((done) => setTimeout(done, PAUSE_MS));
            continue;
        }
        try {
            const { bitmap, number } = await frame(photo.session, settings(),
                { kind: model.view, size: theStage().sizeSeen(), after });
            after = number;
            if (model.photo === photo)
                theStage().setPicture('after', bitmap);
            else
                bitmap.close();
            if (complained)
                announce(say('openedLive'));
            complained = false;
        } catch (error) {
            if (isLost(error))
                break; // it is opened again by others
            announceError(error);
            complained = true;
            if (!passes(error))
                break;
            await new Promise((done) => setTimeout(done, PAUSE_MS));
        }
    }
    running = false;
    if (model.photo?.live && model.photo !== photo)
        run();
}

async function take() {
    $('capture').disabled = true;
    announce(say('capturing'));
    try {
        const { blob } = await askAgain(() => capture(model.photo.session, settings()));
        const time = new Date().toISOString().slice(0, 19).replaceAll(':', '-');
        await openFile(new File([blob], `live-${time}.jpg`, { type: 'image/jpeg' }));
    } catch (error) {
        announceError(error);
    }
    $('capture').disabled = false;
}

export function startLive() {
    $('capture').addEventListener('click', take);
    $('live').addEventListener('click', openLiveAgain);
    listen((cause) => {
        if (cause === 'photo') {
            $('tab-pull').hidden = Boolean(model.photo.live);
            document.body.classList.toggle('live', Boolean(model.photo.live));
        }
        // Settings that were refused stopped it; these may be better.
        if (['photo', 'settings', 'view'].includes(cause) && model.photo.live && !running)
            run();
    });
}
