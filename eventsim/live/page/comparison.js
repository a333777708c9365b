"use strict";
/* The comparison: the same start in an engine that goes step by step, and what it does differently lit up. */

const STUCK_FRAMES = 10, MISSED = "#d55e00", ASTRAY = "#e69f00";

class Comparison {
  /* exact, other: the two worlds; frame: the time of a step; name: of the other engine; late: the steps by which it may tell a
     contact late; spread: those over which it may spread one; given: what the scene has, in words. */
  constructor(canvas, exact, other, stage, { frame, name, late, spread, given }) {
    this.name = name;
    this.given = given;
    this.exact = exact;
    this.other = other;
    this.frame = frame;
    this.drawing = new Drawing(canvas, other, stage);
    this.begun = sums(other, other.state(0)).energy;
    const start = other.state(0), square = start.vx.reduce((sum, vx, i) => sum + vx * vx + start.vy[i] * start.vy[i], 0);
    const flown = square > 0 ? (0.2 * stage.usualRadius) / Math.sqrt(square / other.count) : 0;
    this.matching = new Matching(exact, other, late * frame + flown, spread * frame);
    this.begunExact = sums(exact, exact.state(0)).energy;
  }

  /* Draw the other world, disks that overlap ringed in red, disks astray in yellow. The exact state is in exact.now. */
  draw(view) {
    const before = this._overlapping(this.other.state(Math.max(view.time - STUCK_FRAMES * this.frame, 0)));
    this.drawing.draw({ ...view, marked: -1 });
    const state = this.other.now, overlapping = this._overlapping(state);
    this.astray = this._astray(state);
    this.stuck = new Set([...overlapping.keys()].filter((pair) => before.has(pair)));
    this.overlapping = overlapping.size;
    this.energy = sums(this.other, state).energy;
    this._ring(state, this.astray, ASTRAY);
    this._ring(state, new Set([...overlapping.values()].flat()), MISSED);
  }

  /* Both worlds are known until a time: match what came before it. */
  known(time) { this.matching.advance(time); }

  /* What to say below the two pictures. */
  told(time) {
    const count = (world) => world.eventsUntil(time).toLocaleString("en"), drift = this.begun ? 100 * (this.energy / this.begun - 1) : 0;
    const { found, missed, surplus, astray } = this.matching.counts(time), number = (value) => value.toLocaleString("en");
    const should = this.begunExact ? 100 * (sums(this.exact, this.exact.now).energy / this.begunExact - 1) : 0;
    const lost = Math.abs(should) < 0.005 ? "" : ` (event-driven ${should < 0 ? "−" : "+"}${Math.abs(should).toFixed(2)} %)`;
    const energy = Math.abs(drift) < 0.005 ? "unchanged" : `<b>${drift < 0 ? "−" : "+"}${Math.abs(drift).toFixed(2)} %</b>`;
    return {
      exact: `<strong>event-driven</strong><br>${count(this.exact)} events, each at its time${this.given ? `<br>${this.given}` : ""}`,
      other: `<strong>${this.name}</strong><br>of disks in place: ${number(found)} contacts found, <b>${number(missed)}</b> missed, <b>${number(surplus)}</b> too many` +
        `<span class="faint" title="matched pair by pair within this time"> (± ${Number(this.matching.tolerance.toPrecision(2))})</span>; ${number(astray)} more are of disks astray<br>` +
        `<b>${this.overlapping}</b> pairs overlap, <b>${this.stuck.size}</b> stuck; <b class="astray">${this.astray.size}</b> of ${this.other.count} astray; energy ${energy}${lost}`,
    };
  }

  /* Pairs that overlap by more than a thousandth of their reach: number of the pair -> its disks. */
  _overlapping(state) {
    const found = new Map(), radius = this.other.disks.radius, n = this.other.count;
    for (let i = 0; i < n; i++) {
      for (let j = i + 1; j < n; j++) {
        const reach = 0.999 * (radius[i] + radius[j]), dx = state.x[i] - state.x[j], dy = state.y[i] - state.y[j];
        if (dx * dx + dy * dy < reach * reach) found.set(i * n + j, [i, j]);
      }
    }
    return found;
  }

  /* Disks that are further than their radius from where they should be. */
  _astray(state) {
    const found = new Set(), right = this.exact.now, radius = this.other.disks.radius;
    for (let i = 0; i < this.other.count; i++) {
      if (Math.hypot(state.x[i] - right.x[i], state.y[i] - right.y[i]) > radius[i]) found.add(i);
    }
    return found;
  }

  _ring(state, disks, colour) {
    const { context, ratio } = this.drawing;
    context.strokeStyle = colour;
    context.lineWidth = 3 * ratio;
    context.beginPath();
    for (const i of disks) this.drawing._circle(state.x[i], state.y[i], this.other.disks.radius[i]);
    context.stroke();
  }
}
