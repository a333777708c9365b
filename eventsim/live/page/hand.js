"use strict";
/* The hand: a disk is dragged, to be thrown or to be put elsewhere. */

const DRAGGED = 5;

class Hand {
  /* player: whose canvas it reaches into. done(disk, dx, dy): a disk was dragged so far, in lengths of the scene. */
  constructor(player, done) {
    this.player = player;
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
  draw(drawing, state, throws) {
    if (!this.held || !this.dragged) return;
    const { context, ratio, scale } = drawing, { disk, dx, dy } = this.held;
    const x = drawing._x(state.x[disk]), y = drawing._y(state.y[disk]), radius = drawing.world.disks.radius[disk];
    context.strokeStyle = drawing.palette.ink;
    context.lineWidth = 2.5 * ratio;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + dx * scale, y - dy * scale);
    if (!throws) {
      context.moveTo(x + (dx + radius) * scale, y - dy * scale);
      context.arc(x + dx * scale, y - dy * scale, radius * scale, 0, 2 * Math.PI);
    }
    context.stroke();
  }

  _take(event) {
    this.dragged = false;
    const disk = this.player.drawing.diskAt(event.clientX, event.clientY, this.player.view.time);
    if (disk < 0) return;
    this.player.canvas.setPointerCapture(event.pointerId);
    this.held = { disk, x: event.clientX, y: event.clientY, dx: 0, dy: 0 };
  }

  _drag(event) {
    if (!this.held) return;
    const dx = event.clientX - this.held.x, dy = event.clientY - this.held.y, length = this.player.drawing.ratio / this.player.drawing.scale;
    if (!this.dragged && Math.hypot(dx, dy) < DRAGGED) return;
    this.dragged = true;
    this.player.pause();
    Object.assign(this.held, { dx: dx * length, dy: -dy * length });
    this.player.show();
  }

  _let() {
    const held = this.held;
    this.held = null;
    if (held && this.dragged) this.done(held.disk, held.dx, held.dy);
  }
}
