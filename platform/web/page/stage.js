// The picture on the screen: where it lies, how large, and what is drawn over it. Places in the
// photo are from 0 to 1 each way, places on the stage are CSS pixels.

const MOST = 8; // device pixels that a pixel of the photo may take

const clamp = (value, least, most) => Math.min(Math.max(value, least), most);

export class Stage {
    constructor(canvas, moved) {
        this.canvas = canvas;
        this.context = canvas.getContext('2d');
        this.moved = moved; // called when the place or the size of the picture has changed
        this.width = this.height = 1; // of the stage
        this.photo = null; // { width, height }
        this.after = this.before = null; // pictures
        this.divider = null; // from 0 to 1 of the stage, or null
        this.mark = null; // where the focus was set
        this.cursor = null; // of the keyboard
        this.line = null; // about which the focus tilts: [X, Y, X, Y], pixels of the photo
        this.path = null; // { points, radius, line }: a stroke under the finger
        this.selection = null; // a picture of what it selects, over that of the photo
        this.brush = null; // { x, y, radius } on the stage: where a stroke would go
        new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    }

    resize() {
        const { clientWidth, clientHeight } = this.canvas.parentElement;
        const fitted = this.photo && (!this.scale || this.fitted());
        const centre = this.photo && this.toPhoto(this.width / 2, this.height / 2);

        this.width = Math.max(1, clientWidth);
        this.height = Math.max(1, clientHeight);
        this.canvas.width = Math.round(this.width * devicePixelRatio);
        this.canvas.height = Math.round(this.height * devicePixelRatio);
        if (fitted)
            this.fit();
        else if (this.photo)
            this.show(this.scale, centre);
        this.draw();
    }

    open(photo) {
        this.after?.close();
        this.before?.close();
        this.photo = photo;
        this.scale = 0;
        this.after = this.before = this.divider = this.mark = this.cursor = this.path =
            this.selection = null;
        this.resize();
        this.fit();
    }

    // The place: `scale` is CSS pixels a pixel of the photo, `left` and `top` those of its corner.

    fitScale() {
        return Math.min(this.width / this.photo.width, this.height / this.photo.height,
            MOST / devicePixelRatio);
    }

    /** All of the photo is seen, so that there is nothing to pan to. */
    fitted() {
        return this.scale <= this.fitScale() * 1.001;
    }

    fit() {
        this.show(this.fitScale(), { x: 0.5, y: 0.5 });
    }

    /** A scale, with a place of the photo in the middle. */
    show(scale, at) {
        this.zoomTo(scale, this.width / 2, this.height / 2, at);
    }

    /** A scale, with a place of the photo at one of the stage. */
    zoomTo(scale, x, y, at = this.toPhoto(x, y)) {
        const { width, height } = this.photo;
        const keep = (from, size, room) => (size <= room ? (room - size) / 2
            : clamp(from, room - size, 0));

        this.scale = clamp(scale, Math.min(this.fitScale(), this.fullScale()),
            MOST / devicePixelRatio);
        this.left = keep(x - at.x * width * this.scale, width * this.scale, this.width);
        this.top = keep(y - at.y * height * this.scale, height * this.scale, this.height);
        this.draw();
        this.moved();
    }

    zoomBy(factor, x = this.width / 2, y = this.height / 2) {
        this.zoomTo(this.scale * factor, x, y);
    }

    pan(dx, dy) {
        this.zoomTo(this.scale, 0, 0, this.toPhoto(-dx, -dy));
    }

    /** A pixel of the photo is one of the screen. */
    fullScale() {
        return 1 / devicePixelRatio;
    }

    toPhoto(x, y) {
        return { x: (x - this.left) / (this.photo.width * this.scale),
            y: (y - this.top) / (this.photo.height * this.scale) };
    }

    toStage({ x, y }) {
        return { x: this.left + x * this.photo.width * this.scale,
            y: this.top + y * this.photo.height * this.scale };
    }

    /** The longer side of the picture in pixels of the screen, 0 when that is all it has. */
    sizeSeen() {
        const longer = Math.max(this.photo.width, this.photo.height);
        const seen = Math.ceil(longer * this.scale * devicePixelRatio);
        return seen >= longer ? 0 : seen;
    }

    // Drawing

    set(some) {
        Object.assign(this, some);
        this.draw();
    }

    /** A new picture or a new one before the blur; the old one's memory is given back. */
    setPicture(which, bitmap) {
        this[which]?.close();
        this[which] = bitmap;
        this.draw();
    }

    draw() {
        this.asked ??= requestAnimationFrame(() => {
            this.asked = null;
            this.paint();
        });
    }

    paint() {
        const c = this.context;

        c.setTransform(1, 0, 0, 1, 0, 0);
        c.clearRect(0, 0, this.canvas.width, this.canvas.height);
        c.scale(devicePixelRatio, devicePixelRatio);
        if (!this.photo)
            return;
        this.paintPicture(this.after, 0, this.width);
        if (this.divider !== null)
            this.paintPicture(this.before, 0, this.divider * this.width);
        this.paintPicture(this.selection, 0, this.width);
        if (this.path)
            this.paintPath(this.path);
        if (this.line)
            this.paintLine(this.line);
        if (this.mark)
            this.paintMark(this.toStage(this.mark));
        if (this.cursor)
            this.paintCursor(this.toStage(this.cursor));
        if (this.brush)
            this.ring(this.brush.x, this.brush.y, this.brush.radius);
    }

    paintPicture(bitmap, from, to) {
        const c = this.context;

        if (!bitmap)
            return;
        c.save();
        c.beginPath();
        c.rect(from, 0, to - from, this.height);
        c.clip();
        c.imageSmoothingEnabled = this.scale * devicePixelRatio < 3;
        c.imageSmoothingQuality = 'high';
        c.drawImage(bitmap, this.left, this.top, this.photo.width * this.scale,
            this.photo.height * this.scale);
        c.restore();
    }

    /** Light on dark, so that it is seen on any picture. */
    twice(trace) {
        const c = this.context;

        for (const [colour, width] of [['#000a', 4], ['#fff', 2]]) {
            c.strokeStyle = colour;
            c.lineWidth = width;
            c.beginPath();
            trace(c);
            c.stroke();
        }
    }

    ring(x, y, radius) {
        this.twice((c) => c.arc(x, y, radius, 0, 7));
    }

    paintMark({ x, y }) {
        const R = 20;

        this.ring(x, y, R);
        this.twice((c) => {
            for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
                c.moveTo(x + dx * (R - 6), y + dy * (R - 6));
                c.lineTo(x + dx * (R + 6), y + dy * (R + 6));
            }
        });
    }

    paintCursor({ x, y }) {
        this.twice((c) => {
            for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
                c.moveTo(x + dx * 4, y + dy * 4);
                c.lineTo(x + dx * 16, y + dy * 16);
            }
        });
    }

    paintLine([x0, y0, x1, y1]) {
        const place = (x, y) => this.toStage({ x: (x + 0.5) / this.photo.width,
            y: (y + 0.5) / this.photo.height });
        const from = place(x0, y0), to = place(x1, y1);

        this.twice((c) => {
            c.moveTo(from.x, from.y);
            c.lineTo(to.x, to.y);
        });
    }

    paintPath({ points, radius, line }) {
        const c = this.context;
        const places = points.map((point) => this.toStage(point));
        const trace = () => {
            c.moveTo(places[0].x, places[0].y);
            for (const { x, y } of places)
                c.lineTo(x, y);
        };

        if (line) {
            this.twice(trace);
            this.ring(places[0].x, places[0].y, 8);
            return;
        }
        c.lineCap = c.lineJoin = 'round';
        c.strokeStyle = this.selection ? '#ff7a1a33' : '#ff7a1a99';
        c.lineWidth = 2 * radius;
        c.beginPath();
        trace();
        c.stroke();
    }
}
