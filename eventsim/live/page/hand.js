"use strict";
/* The hand: a disk is dragged, to be thrown or to be put elsewhere; a disk or a wall is drawn. */

const DRAGGED = 5, SNAP = 10;

class Hand {
  /* player: whose canvas it reaches into. tool(): "throw", "move", "disk" or "wall". done(held): it let go; held: {tool, disk, from, to,
     dx, dy}, places and lengths on the scene's axes. */
  constructor(player, tool, done) {
    this.player = player;
    this.tool = tool;
    this.done = done;
    this.held = null;
    this.dragged = false;
    const on = (event, action) => player.canvas.addEventListener(event, action);
    on("pointerdown", (event) => this._take(event));
    on("pointermove", (event) => this._drag(event));
    on("pointerup", () => this._let());
    on("pointercancel", () => { this.held = null; });
    on("click", (event) => { if (this.dragged) event.stopImmediatePropagation(); });
  }

  /* Draw what letting go would do. */
  draw(drawing, state) {
    if (!this.held || !this.dragged) return;
    const { context, ratio, scale } = drawing, { tool, disk, dx, dy, from, to } = this.held, draws = tool === "disk" || tool === "wall";
    const [cx, cy] = drawing.stage.corner, x = drawing._x(draws ? from[0] - cx : state.x[disk]), y = drawing._y(draws ? from[1] - cy : state.y[disk]);
    const ex = draws ? drawing._x(to[0] - cx) : x + dx * scale, ey = draws ? drawing._y(to[1] - cy) : y - dy * scale;
    const circle = (mx, my, radius) => { context.moveTo(mx + radius, my); context.arc(mx, my, radius, 0, 2 * Math.PI); };
    context.strokeStyle = drawing.palette.ink;
    context.lineWidth = 2.5 * ratio;
    context.beginPath();
    if (tool === "disk") circle(x, y, this.radius(this.held) * scale);
    else { context.moveTo(x, y); context.lineTo(ex, ey); }
    if (tool === "move") circle(ex, ey, drawing.world.disks.radius[disk] * scale);
    context.stroke();
  }

  /* The radius of a disk that is drawn: as far as the hand went from its middle, the usual one where it stood still. */
  radius({ dx, dy }) { return this.dragged ? Math.hypot(dx, dy) : this.player.stage.usualRadius; }

  _take(event) {
    this.dragged = false;
    const tool = this.tool(), { drawing, view } = this.player, draws = tool === "disk" || tool === "wall";
    const disk = draws ? -1 : drawing.diskAt(event.clientX, event.clientY, view.time);
    if (disk < 0 && !draws) return;
    this.player.canvas.setPointerCapture(event.pointerId);
    const from = this._place(event, tool);
    this.held = { tool, disk, from, to: from, x: event.clientX, y: event.clientY, dx: 0, dy: 0 };
  }

  _drag(event) {
    if (!this.held) return;
    const dx = event.clientX - this.held.x, dy = event.clientY - this.held.y, length = this.player.drawing.ratio / this.player.drawing.scale;
    if (!this.dragged && Math.hypot(dx, dy) < DRAGGED) return;
    this.dragged = true;
    this.player.pause();
    Object.assign(this.held, { dx: dx * length, dy: -dy * length, to: this._place(event, this.held.tool) });
    this.player.show();
  }

  _let() {
    const held = this.held;
    this.held = null;
    if (!held || (!this.dragged && held.tool !== "disk")) return;
    if (held.tool === "disk") held.radius = this.radius(held);
    this.dragged = true; // the click that follows is part of this
    this.done(held);
  }

  /* Where the pointer is, on the scene's axes. Walls stay in the domain and begin and end at ends that are near. */
  _place(event, tool) {
    const { drawing, stage } = this.player, place = drawing.placeAt(event.clientX, event.clientY);
    if (tool !== "wall") return place;
    const near = (SNAP * drawing.ratio) / drawing.scale, away = ([x, y]) => Math.hypot(x - place[0], y - place[1]);
    const ends = stage.walls.flatMap((line) => [line[0], line[line.length - 1]]).filter((end) => away(end) < near);
    if (ends.length) return ends.reduce((best, end) => (away(end) < away(best) ? end : best));
    if (!stage.size) return place;
    return place.map((value, axis) => {
      const low = stage.corner[axis], high = low + stage.size[axis];
      return value - low < near ? low : high - value < near ? high : value;
    });
  }
}
