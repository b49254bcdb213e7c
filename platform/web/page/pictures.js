// The choice of the picture that is asked for next. One question is under way at a time, and the
// newest one comes next: a quick picture at once while something moves, a full one when all rests,
// then the picture before the blur for the divider, then small ones of looks.
import { picture, ServerError } from './server.js';
import { NAMES, over } from './settings.js';

const REST_MS = 180; // without a change, until all rests
const QUICK_MOST = 1024, QUICK_LEAST = 384; // sides of a quick picture
const SLOW_MS = 120; // a quick picture that takes longer is asked for smaller the next time

const key = (wanted) => JSON.stringify([wanted.session, wanted.depth, wanted.kind,
    wanted.settings]);

export class Pictures {
    /** `show(bitmap, wanted)` and `showBefore(bitmap)` take a picture, `busy(yes)` is told
     * when something is still to come, and `failed(error)` of failures. */
    constructor({ show, showBefore, busy, failed }) {
        Object.assign(this, { show, showBefore, busy, failed });
        this.wanted = null; // { session, depth, kind, settings, size, before }
        this.shown = { key: '', size: 0 };
        this.before = { session: '', size: 0 };
        this.looks = []; // { settings, size, done }
        this.quick = QUICK_MOST;
        this.held = false; // a finger is down
        this.quickAlone = false; // full pictures cost too much
        this.paused = 0; // questions of other kinds that are under way
        this.waiting = []; // called when the quick picture is there
        this.rested = 0;
        this.under = null; // the question under way
    }

    /** This is to be seen from now on. `size` is the longer side on the screen, 0 = 1:1. */
    want(wanted) {
        const changed = !this.wanted || key(this.wanted) !== key(wanted);

        this.wanted = wanted;
        if (changed) {
            this.rested = performance.now() + REST_MS;
            this.busy(true);
            if (this.under && !this.under.quick)
                this.under.abort.abort();
        }
        this.go();
    }

    /** While a finger is down, no full picture is asked for. */
    hold(held) {
        this.held = held;
        this.go();
    }

    /** The server lets a question about focus or depth stop a picture: none is asked for before
     * the answer. */
    async pauseFor(question) {
        this.paused++;
        this.under?.abort.abort();
        try {
            return await question();
        } finally {
            this.paused--;
            this.go();
        }
    }

    /** Until something of what is wanted now is seen. */
    seen() {
        return !this.wanted || this.shown.key === key(this.wanted) ? Promise.resolve()
            : new Promise((done) => this.waiting.push(done));
    }

    /** Small pictures of other settings, when there is nothing else to do; they replace those that
     * were asked for before. */
    wantLooks(looks) {
        this.looks = looks;
        this.go();
    }

    /** A picture like the last one may be another now, after an error or on a new session. */
    forget() {
        this.wanted = null;
        this.shown = { key: '', size: 0 };
        this.before = { session: '', size: 0 };
    }

    next() {
        const { wanted, shown } = this;

        if (!wanted)
            return null;
        const now = key(wanted);
        const covers = (size, wants) => size >= (wants || Infinity);
        const smaller = wanted.kind || (wanted.size && wanted.size <= this.quick) ? wanted.size
            : this.quick;
        if (shown.key !== now)
            return { what: 'picture', key: now, size: smaller, quick: true, ...this.job(wanted) };
        if (this.held || performance.now() < this.rested)
            return null;
        const full = !this.quickAlone;
        if (full && !covers(shown.size, wanted.size))
            return { what: 'picture', key: now, size: wanted.size, ...this.job(wanted) };
        if (wanted.before && (this.before.session !== wanted.session ||
                full && !covers(this.before.size, wanted.size)))
            return { what: 'before', size: full ? wanted.size : this.quick, quick: !full,
                session: wanted.session,
                settings: over(wanted.settings, { [NAMES.blur]: 0 }) };
        const look = this.looks.shift();
        return look ? { what: 'look', quick: true, session: wanted.session, ...look } : null;
    }

    job({ session, settings, kind }) {
        return { session, settings, kind };
    }

    async go() {
        if (this.under || this.paused)
            return;
        const job = this.next();
        if (!job) {
            this.wait();
            return;
        }
        this.under = { quick: job.quick, abort: new AbortController() };
        this.busy(true);
        const began = performance.now();
        try {
            const bitmap = await picture(job.session, job.settings,
                { kind: job.kind, size: job.size, quick: job.quick,
                    signal: this.under.abort.signal });
            this.adapt(job, performance.now() - began);
            this.take(job, bitmap);
        } catch (error) {
            this.give(job, error);
        }
        this.under = null;
        if (!this.wanted || this.shown.key === key(this.wanted))
            this.waiting.splice(0).forEach((done) => done());
        this.go();
    }

    /** Quick pictures become smaller where the server or the way to it is slow. */
    adapt(job, took) {
        if (job.what !== 'picture' || !job.quick)
            return;
        if (took > SLOW_MS && job.size === this.quick)
            this.quick = Math.max(QUICK_LEAST, Math.round(this.quick * 0.75));
        else if (took < SLOW_MS / 3)
            this.quick = Math.min(QUICK_MOST, Math.round(this.quick * 1.25));
    }

    take(job, bitmap) {
        if (job.what === 'look') {
            job.done(bitmap);
        } else if (job.session !== this.wanted?.session) {
            bitmap.close();
        } else if (job.what === 'before') {
            this.before = { session: job.session, size: job.size || Infinity };
            this.showBefore(bitmap);
        } else {
            // An overlay has one size alone.
            const size = job.kind ? Infinity : job.quick ? 0 : job.size || Infinity;
            this.shown = { key: job.key, size };
            this.show(bitmap, job);
        }
    }

    /** After an error this picture is not asked for again until something changes. */
    give(job, error) {
        if (error.name === 'AbortError' || error.status === 409) {
            if (job.what === 'look')
                this.looks.unshift(job);
            return;
        }
        if (!(error instanceof ServerError))
            console.error(error);
        if (job.what === 'picture')
            this.shown = { key: job.key, size: Infinity };
        else if (job.what === 'before')
            this.before = { session: job.session, size: Infinity };
        this.failed(error, job);
    }

    wait() {
        clearTimeout(this.timer);
        const left = this.rested - performance.now();
        if (this.wanted && !this.held && left > 0)
            this.timer = setTimeout(() => this.go(), left + 1);
        else if (!this.held)
            this.busy(false);
    }
}
