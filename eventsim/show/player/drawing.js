"use strict";
/* The drawing: one state of a world on a canvas. It keeps no time and asks nobody for events. */

const GLOW_SECONDS = 0.2, TRAIL_SECONDS = 1, TRAIL_BANDS = 6, SMALLEST = 1.5, EDGED = 3, ASIDE = 5, BACK = 0.95;

class Drawing {
  /* stage: {shown: [x0, y0, x1, y1], corner, size | null, period, walls, hard, open, species, fastest, kinds, amounts, few, darkEnough,
     palettes: {light, dark}}; lines are lists of [x, y] on the scene's axes. */
  constructor(canvas, world, stage) {
    this.canvas = canvas;
    this.world = world;
    this.stage = stage;
    this.context = canvas.getContext("2d");
    this.order = new Int32Array(world.count);
    this.shade = new Int32Array(world.count);
    this.resize();
  }

  /* Fit the scene into the canvas at the screen's own resolution. */
  resize() {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    this.canvas.width = Math.max(Math.round(box.width * ratio), 1);
    this.canvas.height = Math.max(Math.round(box.height * ratio), 1);
    const [x0, y0, x1, y1] = this.stage.shown;
    this.scale = Math.min(this.canvas.width / (x1 - x0), this.canvas.height / (y1 - y0));
    this.left = (this.canvas.width - this.scale * (x1 - x0)) / 2 - this.scale * x0;
    this.bottom = (this.canvas.height + this.scale * (y1 - y0)) / 2 + this.scale * y0;
    this.ratio = ratio;
  }

  /* Draw the world at a time. view: {time, speed, colour, dark, trails, flash, arrows, impulse, marked: disk | -1}. */
  draw(view) {
    const context = this.context, palette = view.dark ? this.stage.palettes.dark : this.stage.palettes.light;
    this.palette = palette;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = palette.paper;
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    context.save();
    this._clip(palette);
    const state = this.world.state(view.time);
    if (view.trails) this._drawTrails(view);
    this._drawDisks(state, view);
    if (view.arrows) this._drawArrows(state);
    if (view.impulse) this._drawContact(this.world.contact(view.time));
    if (view.marked >= 0) this._mark(state, view.marked);
    this._drawLines(this.stage.walls, 2, []);
    context.restore();
    this._drawLines(this.stage.hard, 2, []);
    this._drawLines(this.stage.open, 1.2, [5, 5]);
  }

  /* The disk under a point of the canvas in CSS pixels, -1 if there is none. */
  diskAt(clientX, clientY, time) {
    const box = this.canvas.getBoundingClientRect(), state = this.world.state(time);
    const px = (clientX - box.left) * this.ratio, py = (clientY - box.top) * this.ratio;
    for (let i = this.world.count - 1; i >= 0; i--) {
      const radius = Math.max(this.world.disks.radius[i] * this.scale, 4 * this.ratio);
      for (const [x, y] of this._images(state.x[i], state.y[i], this.world.disks.radius[i])) {
        if (Math.hypot(this._x(x) - px, this._y(y) - py) <= radius) return i;
      }
    }
    return -1;
  }

  /* The place on the scene's axes under a point of the canvas in CSS pixels. */
  placeAt(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    return [((clientX - box.left) * this.ratio - this.left) / this.scale, (this.bottom - (clientY - box.top) * this.ratio) / this.scale];
  }

  _x(x) { return this.left + this.scale * (x + this.stage.corner[0]); }
  _y(y) { return this.bottom - this.scale * (y + this.stage.corner[1]); }

  /* Fill the inside of the domain; along a period nothing is drawn outside of it. */
  _clip(palette) {
    const { size, shown, corner } = this.stage, [ox, oy] = corner;
    const [x0, y0, x1, y1] = size ? [ox, oy, ox + size[0], oy + size[1]] : shown;
    const rectangle = [this.left + this.scale * x0, this.bottom - this.scale * y1, this.scale * (x1 - x0), this.scale * (y1 - y0)];
    this.context.fillStyle = palette.inside;
    this.context.fillRect(...rectangle);
    if (this.stage.period[0] !== null) {
      this.context.beginPath();
      this.context.rect(...rectangle);
      this.context.clip();
    }
  }

  _drawLines(lines, width, dashes) {
    const context = this.context;
    context.strokeStyle = this.palette.wall;
    context.lineWidth = width * this.ratio;
    context.lineCap = "round";
    context.lineJoin = "round";
    context.setLineDash(dashes.map((length) => length * this.ratio));
    context.beginPath();
    for (const line of lines) {
      line.forEach(([x, y], k) => {
        context[k ? "lineTo" : "moveTo"](this.left + this.scale * x, this.bottom - this.scale * y);
      });
    }
    context.stroke();
    context.setLineDash([]);
  }

  /* Disks of one colour are one path: a canvas is slow at changing colours, not at circles. */
  _drawDisks(state, view) {
    const context = this.context, radii = this.world.disks.radius, colours = this._shades(state, view);
    const starts = new Int32Array(colours.length + 1);
    for (let i = 0; i < this.world.count; i++) starts[this.shade[i] + 1]++;
    for (let c = 0; c < colours.length; c++) starts[c + 1] += starts[c];
    const next = starts.slice();
    for (let i = 0; i < this.world.count; i++) this.order[next[this.shade[i]]++] = i;
    const edged = this.stage.usualRadius * this.scale > EDGED * this.ratio;
    context.strokeStyle = this.palette.edge;
    context.lineWidth = 0.7 * this.ratio;
    for (let c = 0; c < colours.length; c++) {
      if (starts[c] === starts[c + 1]) continue;
      context.fillStyle = colours[c];
      context.beginPath();
      for (let place = starts[c]; place < starts[c + 1]; place++) {
        const i = this.order[place];
        this._circle(state.x[i], state.y[i], radii[i]);
      }
      context.fill();
      if (edged) context.stroke();
    }
    if (state.angle) this._drawSpokes(state);
    if (view.flash) this._drawGlow(state, view);
  }

  /* A line from the middle of each disk to its edge, which turns with it; dark in white, so that it is seen on every colour. */
  _drawSpokes(state) {
    const context = this.context, radii = this.world.disks.radius;
    context.beginPath();
    for (let i = 0; i < this.world.count; i++) {
      const r = radii[i] * this.scale, dx = r * Math.cos(state.angle[i]), dy = -r * Math.sin(state.angle[i]);
      for (const [ix, iy] of this._images(state.x[i], state.y[i], radii[i])) {
        const px = this._x(ix), py = this._y(iy);
        context.moveTo(px, py);
        context.lineTo(px + dx, py + dy);
      }
    }
    for (const [colour, width] of [["#ffffff", 2.6], ["#000000", 1.1]]) {
      context.strokeStyle = colour;
      context.lineWidth = width * this.ratio;
      context.stroke();
    }
  }

  _circle(x, y, r) {
    const context = this.context, radius = Math.max(r * this.scale, SMALLEST * this.ratio);
    if (this.stage.period[0] === null) {
      const px = this._x(x), py = this._y(y);
      context.moveTo(px + radius, py);
      context.arc(px, py, radius, 0, 2 * Math.PI);
      return;
    }
    for (const [ix, iy] of this._images(x, y, r)) {
      const px = this._x(ix), py = this._y(iy);
      context.moveTo(px + radius, py);
      context.arc(px, py, radius, 0, 2 * Math.PI);
    }
  }

  /* Where a disk is seen: once, and again across each periodic boundary that it touches. */
  _images(x, y, r) {
    let places = [[x, y]];
    this.stage.period.forEach((length, axis) => {
      if (length === null) return;
      const value = axis ? y : x, shifts = [0];
      if (value - r < 0) shifts.push(length);
      if (value + r > length) shifts.push(-length);
      places = places.flatMap((place) => shifts.map((s) => (axis ? [place[0], place[1] + s] : [place[0] + s, place[1]])));
    });
    return places;
  }

  /* Give every disk a shade; return the colours of the shades. */
  _shades(state, view) {
    const { shade, world, stage } = this, n = world.count;
    if (view.colour === "species") {
      for (let i = 0; i < n; i++) shade[i] = stage.species[i] % stage.kinds.length;
      return stage.kinds;
    }
    if (view.colour === "index" && n <= stage.few) {
      for (let i = 0; i < n; i++) shade[i] = i;
      return stage.kinds;
    }
    const last = stage.amounts.length - 1, put = (i, share) => { shade[i] = Math.round(last * Math.min(Math.max(share, 0), 1)); };
    const [low, high] = stage.masses;
    let most = 1;
    if (view.colour === "contacts") {
      for (let i = 0; i < n; i++) most = Math.max(most, world.contactsUntil(i, view.time));
    }
    for (let i = 0; i < n; i++) {
      if (view.colour === "speed") put(i, Math.hypot(state.vx[i], state.vy[i]) / stage.fastest);
      else if (view.colour === "contacts") put(i, world.contactsUntil(i, view.time) / most);
      else if (view.colour === "mass") put(i, high > low ? (Math.min(world.disks.mass[i], high) - low) / (high - low) : 0.5);
      else put(i, (stage.darkEnough * i) / (n - 1));
    }
    return stage.amounts;
  }

  _drawGlow(state, view) {
    const context = this.context, span = GLOW_SECONDS * view.speed;
    context.fillStyle = this.palette.glow;
    for (let i = 0; i < this.world.count; i++) {
      const age = (view.time - this.world.lastEvent(i, view.time)) / span;
      if (age >= 1) continue;
      context.globalAlpha = 1 - age;
      context.beginPath();
      this._circle(state.x[i], state.y[i], this.world.disks.radius[i]);
      context.fill();
    }
    context.globalAlpha = 1;
  }

  _drawTrails(view) {
    const context = this.context, span = (TRAIL_SECONDS * view.speed) / TRAIL_BANDS;
    context.strokeStyle = this.palette.trail;
    context.lineWidth = 1.2 * this.ratio;
    for (let band = TRAIL_BANDS; band > 0; band--) {
      const from = Math.max(view.time - band * span, 0), to = Math.max(view.time - (band - 1) * span, 0);
      context.globalAlpha = 0.85 * (1 - (band - 1) / TRAIL_BANDS);
      context.beginPath();
      for (let i = 0; i < this.world.count; i++) this.world.trace(i, from, to, (...ends) => this._piece(...ends));
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /* A straight piece of a way, drawn in every image of the domain that it passes through. */
  _piece(x0, y0, x1, y1) {
    const [lx, ly] = this.stage.period;
    const cells = (p, q, length) => (length === null ? [0, 0] : [Math.floor(Math.min(p, q) / length), Math.floor(Math.max(p, q) / length)]);
    const [i0, i1] = cells(x0, x1, lx), [j0, j1] = cells(y0, y1, ly);
    for (let i = i0; i <= i1; i++) {
      for (let j = j0; j <= j1; j++) {
        const dx = i * (lx || 0), dy = j * (ly || 0);
        this.context.moveTo(this._x(x0 - dx), this._y(y0 - dy));
        this.context.lineTo(this._x(x1 - dx), this._y(y1 - dy));
      }
    }
  }

  _drawArrows(state) {
    const context = this.context, [x0, y0, x1, y1] = this.stage.shown;
    const time = (0.08 * Math.max(x1 - x0, y1 - y0)) / this.stage.fastest;
    context.strokeStyle = this.palette.arrow;
    context.lineWidth = 1.2 * this.ratio;
    context.beginPath();
    for (let i = 0; i < this.world.count; i++) {
      const speed = Math.hypot(state.vx[i], state.vy[i]), rim = speed ? this.world.disks.radius[i] / speed : 0; // a slow one is seen, too
      if (speed) this._arrow(state.x[i] + rim * state.vx[i], state.y[i] + rim * state.vy[i], state.vx[i] * time, state.vy[i] * time);
    }
    context.stroke();
  }

  _arrow(x, y, dx, dy) {
    const context = this.context, px = this._x(x), py = this._y(y), ax = dx * this.scale, ay = -dy * this.scale;
    context.moveTo(px, py);
    context.lineTo(px + ax, py + ay);
    context.moveTo(px + ax - 0.3 * (ax - 0.5 * ay), py + ay - 0.3 * (ay + 0.5 * ax));
    context.lineTo(px + ax, py + ay);
    context.lineTo(px + ax - 0.3 * (ax + 0.5 * ay), py + ay - 0.3 * (ay - 0.5 * ax));
  }

  /* The last contact, where it was: outlines of its disks, the velocities with which they came (dashed) and left; the longest has a
     fixed length. */
  _drawContact(found) {
    if (found === null) return;
    const context = this.context, [x0, y0, x1, y1] = this.stage.shown;
    const fastest = Math.max(...found.sides.flatMap(({ before, after }) => [Math.hypot(...before), Math.hypot(...after)]));
    const longest = Math.max(0.16 * Math.min(x1 - x0, y1 - y0), 2 * this.stage.usualRadius), time = fastest ? longest / fastest : 0, dashes = [5 * this.ratio, 4 * this.ratio];
    const stroke = (colour, width, dashed, lines) => {
      context.beginPath();
      for (const side of found.sides) lines(side);
      context.strokeStyle = this.palette.paper; // a halo, so that it is seen on every disk
      context.lineWidth = (width + 2.5) * this.ratio;
      context.stroke();
      context.strokeStyle = colour;
      context.lineWidth = width * this.ratio;
      context.setLineDash(dashed ? dashes : []);
      context.stroke();
      context.setLineDash([]);
    };
    stroke(this.palette.faint, 1.2, true, ({ disk, x, y }) => this._circle(x, y, this.world.disks.radius[disk]));
    stroke(this.palette.ink, 2, true, (side) => {
      const { x, y, before } = side, [dx, dy] = this._aside(side);
      if (before.some(Boolean)) this._arrow(x + dx - before[0] * time, y + dy - before[1] * time, before[0] * time, before[1] * time);
    });
    stroke(this.palette.arrow, 2.4, false, (side) => {
      const { x, y, after } = side, [dx, dy] = this._aside(side);
      if (after.some(Boolean)) this._arrow(x - dx, y - dy, after[0] * time, after[1] * time);
    });
  }

  /* By how much the arrow before is moved to one side and that after to the other: of a disk that goes back the way it came they
     would lie on each other. */
  _aside({ before, after }) {
    const came = Math.hypot(...before), left = Math.hypot(...after);
    if (!(came && left) || before[0] * after[0] + before[1] * after[1] > -BACK * came * left) return [0, 0];
    const apart = (ASIDE * this.ratio) / this.scale;
    return [(-apart * before[1]) / came, (apart * before[0]) / came];
  }

  _mark(state, i) {
    this.context.strokeStyle = this.palette.glow;
    this.context.lineWidth = 2.5 * this.ratio;
    this.context.beginPath();
    this._circle(state.x[i], state.y[i], this.world.disks.radius[i]);
    this.context.stroke();
  }
}
