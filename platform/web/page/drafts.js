// A stroke under the finger: the newest state of it goes to the server while it is made, one at a
// time, and what it selects is drawn over the picture.
import { model, draftChanged } from './model.js';
import { draft } from './server.js';
import { thePictures, theStage } from './viewer.js';

const TINT = [255, 122, 26, 110]; // red, green, blue, alpha

/** A picture of the runs of a selection. */
function drawn({ width, height, runs }) {
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext('2d');
    const image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    const [tint] = new Uint32Array(Uint8ClampedArray.from(TINT).buffer);

    for (let i = 0; i < runs.length; i += 2)
        pixels.fill(tint, runs[i], runs[i] + runs[i + 1]);
    context.putImageData(image, 0, 0);
    return canvas;
}

export class Drafts {
    constructor() {
        this.next = null; // { photo, what }
        this.sending = null; // a promise, while drafts are under way
        this.sent = null; // the photo that has a draft
    }

    /** The stroke as it is now; it replaces one that still waits. */
    send(photo, what) {
        this.next = { photo, what };
        this.sending ??= this.run().finally(() => (this.sending = null));
    }

    async run() {
        while (this.next) {
            const { photo, what } = this.next;
            this.next = null;
            try {
                const { selection } = await thePictures().pauseFor(() =>
                    draft(photo.session, what));
                this.sent = photo;
                if (photo === model.photo && theStage().path)
                    await this.show(what, selection);
            } catch {
                return; // the stroke itself will say what is wrong
            }
        }
    }

    /** What a brush selects is drawn over the photo; all else changes the picture. */
    async show(what, selection) {
        if (what.points && selection && model.view === 'picture') {
            theStage().set({ selection: drawn(selection) });
            return;
        }
        draftChanged();
        await thePictures().seen();
    }

    /** No more of them: the stroke itself follows, and replaces the last one. */
    async end() {
        this.next = null;
        await this.sending;
        this.sent = null;
    }

    /** The stroke will not be made. */
    async drop() {
        this.next = null;
        await this.sending;
        const photo = this.sent;
        this.sent = null;
        if (!photo || photo !== model.photo)
            return;
        await thePictures().pauseFor(() => draft(photo.session, {}));
        draftChanged();
    }
}
