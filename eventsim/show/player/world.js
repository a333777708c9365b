"use strict";
/* The world: where all disks are at any time, from their starts and the rows of an event log.

   It knows nothing of drawing. A disk flies free between its anchors, so every state is a function of the time alone:
   forwards, backwards and in leaps give the same numbers. Rows may be appended at any time, in the order of the log.

   Times are counted from the start of the run. The clock of an anchor keeps whole epochs apart from the remainder, as
   the log does, so a late event has as many digits as an early one. Positions are relative to the domain's corner. */

class Column {
  /* A growing array of numbers. */
  constructor() {
    this.values = new Float64Array(1024);
    this.length = 0;
  }

  push(value) {
    if (this.length === this.values.length) {
      const longer = new Float64Array(2 * this.length);
      longer.set(this.values);
      this.values = longer;
    }
    this.values[this.length++] = value;
  }
}

class World {
  /* scene: {count, epochLength, period: [number | null, ...], gravity: [gx, gy] | null, disks: {x, y, vx, vy, radius, mass, spin},
     wallNames: as the log numbers them; slopes: the part of gravity that is left to a disk at rest on each wall, or null where none comes to rest; spin: undefined where disks have none}. */
  constructor(scene) {
    this.count = scene.count;
    this.epochLength = scene.epochLength;
    this.period = scene.period;
    this.gravity = scene.gravity;
    this.slopes = scene.slopes;
    this.disks = scene.disks;
    this.wallNames = scene.wallNames || [];
    this.anchor = {};
    for (const name of ["epoch", "remainder", "time", "x", "y", "vx", "vy", "gx", "gy", "contacts", "spin", "angle"]) this.anchor[name] = new Column();
    this.event = {};
    for (const name of ["time", "a", "b", "kind", "wall", "anchor"]) this.event[name] = new Column();
    this.anchorsOf = [];
    for (let i = 0; i < this.count; i++) {
      this.anchorsOf.push([]);
      this._anchor(i, 0, 0, scene.disks.x[i], scene.disks.y[i], scene.disks.vx[i], scene.disks.vy[i], this._pull(i), 0, scene.disks.spin ? scene.disks.spin[i] : 0, 0);
    }
    this.now = { x: new Float64Array(this.count), y: new Float64Array(this.count),
                 vx: new Float64Array(this.count), vy: new Float64Array(this.count),
                 angle: scene.disks.spin ? new Float64Array(this.count) : null };
  }

  /* Take up rows of the log, given as columns: epoch, remainder, a, b (-1: none), kind, wall, vxa, vya, vxb, vyb; of disks with spin, spin_a, spin_b; of an engine whose
     disks do not fly free also their places, xa, ya, xb, yb. */
  append(rows) {
    for (let k = 0; k < rows.a.length; k++) {
      const epoch = rows.epoch[k], remainder = rows.remainder[k];
      const rests = rows.kind[k] === REST, pull = rests ? this.slopes[rows.wall[k]] : this._pull(rows.a[k]);
      const met = rows.kind[k] <= WALL ? 1 : 0;
      this.event.anchor.push(this.anchor.time.length);
      this._turn(rows.a[k], epoch, remainder, rows.vxa[k], rows.vya[k], pull, met, rows.xa && [rows.xa[k], rows.ya[k]], rows.spin_a ? rows.spin_a[k] : 0);
      if (rows.b[k] >= 0) this._turn(rows.b[k], epoch, remainder, rows.vxb[k], rows.vyb[k], this._pull(rows.b[k]), met, rows.xa && [rows.xb[k], rows.yb[k]], rows.spin_b ? rows.spin_b[k] : 0);
      const last = this.event.time.length ? this.event.time.values[this.event.time.length - 1] : 0;
      this.event.time.push(Math.max(epoch * this.epochLength + remainder, last));
      for (const name of ["a", "b", "kind", "wall"]) this.event[name].push(rows[name][k]);
    }
  }

  /* Forget all rows but the first `count`. */
  cut(count) {
    const { a, b } = this.event;
    while (a.length > count) {
      for (const disk of [b.values[a.length - 1], a.values[a.length - 1]]) {
        if (disk < 0) continue;
        this.anchorsOf[disk].pop();
        for (const column of Object.values(this.anchor)) column.length--;
      }
      for (const column of Object.values(this.event)) column.length--;
    }
  }

  /* All disks at a time: {x, y, vx, vy, angle}, arrays that the next call overwrites. At the time of an event, after it.
     angle: by which disks have turned; null without spin. */
  state(time) {
    const { x, y, vx, vy, angle } = this.now;
    for (let i = 0; i < this.count; i++) {
      const k = this.anchorsOf[i][this.anchorBefore(i, time)];
      const lag = this._lag(k, time);
      x[i] = wrapped(this._place("x", k, lag), this.period[0]);
      y[i] = wrapped(this._place("y", k, lag), this.period[1]);
      vx[i] = this._velocity("x", k, lag);
      vy[i] = this._velocity("y", k, lag);
      if (angle) angle[i] = this.anchor.angle.values[k] + this.anchor.spin.values[k] * lag;
    }
    return this.now;
  }

  /* Where one disk is at a time, [x, y]. */
  placeOf(i, time) {
    const k = this.anchorsOf[i][this.anchorBefore(i, time)], lag = this._lag(k, time);
    return [wrapped(this._place("x", k, lag), this.period[0]), wrapped(this._place("y", k, lag), this.period[1])];
  }

  /* How many contacts, with disks or walls, a disk has had at a time: kicks and the beginning of rest are none. */
  contactsUntil(i, time) {
    return this.anchor.contacts.values[this.anchorsOf[i][this.anchorBefore(i, time)]];
  }

  /* Which of a disk's anchors holds at a time. */
  anchorBefore(i, time) {
    const list = this.anchorsOf[i], times = this.anchor.time.values;
    let low = 0, high = list.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[list[middle]] <= time) low = middle; else high = middle;
    }
    return low;
  }

  /* The time of a disk's last event, -Infinity before the first. */
  lastEvent(i, time) {
    const place = this.anchorBefore(i, time);
    return place ? this.anchor.time.values[this.anchorsOf[i][place]] : -Infinity;
  }

  /* How many events have happened at a time, its own included. */
  eventsUntil(time) {
    return bisect(this.event.time, (other) => other <= time);
  }

  /* The last contact at or before a time, with all that happened at its time: {events: [first, last], time, walls: names, sides: [{disk, x, y,
     before, after}, ...]}, velocities on both sides of it; null before the first. */
  contact(time) {
    const { kind, a, b, wall, anchor, time: times } = this.event;
    let last = this.eventsUntil(time) - 1;
    while (last >= 0 && kind.values[last] > WALL) last--;
    if (last < 0) return null;
    let first = last;
    while (first > 0 && times.values[first - 1] === times.values[last] && kind.values[first - 1] <= WALL) first--;
    const sides = new Map(), walls = new Set();
    for (let event = first; event <= last; event++) {
      if (kind.values[event] === WALL) walls.add(this.wallNames[wall.values[event]] || "a wall");
      [a.values[event], b.values[event]].filter((disk) => disk >= 0).forEach((disk, k) => {
        const after = anchor.values[event] + k, at = this.anchor, before = sides.has(disk) ? sides.get(disk).before : this.before(disk, after);
        sides.set(disk, { disk, x: at.x.values[after], y: at.y.values[after], before, after: [at.vx.values[after], at.vy.values[after]] });
      });
    }
    return { events: [first, last], time: times.values[last], walls: [...walls], sides: [...sides.values()] };
  }

  /* The velocities of a disk before and after an event in which it is the first (side 0) or the second (1). */
  change(disk, event, side) {
    const after = this.event.anchor.values[event] + side, { vx, vy } = this.anchor;
    return { before: this.before(disk, after), after: [vx.values[after], vy.values[after]] };
  }

  /* The velocity with which a disk came to an anchor. */
  before(disk, k) {
    const list = this.anchorsOf[disk], { epoch, remainder } = this.anchor, from = list[firstOf(list.length, (place) => list[place] >= k) - 1];
    const lag = (epoch.values[k] - epoch.values[from]) * this.epochLength + (remainder.values[k] - remainder.values[from]);
    return [this._velocity("x", from, lag), this._velocity("y", from, lag)];
  }

  /* The time of the next event after a time, of the last one before it; null where there is none. */
  nextEvent(time) {
    const k = this.eventsUntil(time);
    return k < this.event.time.length ? this.event.time.values[k] : null;
  }

  previousEvent(time) {
    const k = bisect(this.event.time, (other) => other < time);
    return k > 0 ? this.event.time.values[k - 1] : null;
  }

  /* Tell the way of disk i from one time to another as straight pieces: piece(x0, y0, x1, y1), not wrapped. */
  trace(i, from, to, piece) {
    const list = this.anchorsOf[i], times = this.anchor.time.values;
    for (let place = this.anchorBefore(i, from); place < list.length && times[list[place]] < to; place++) {
      const k = list[place], until = place + 1 < list.length ? Math.min(times[list[place + 1]], to) : to;
      const begin = Math.max(times[k], from), parts = this.gravity ? PARABOLA_PIECES : 1;
      let x0 = this._place("x", k, begin - times[k]), y0 = this._place("y", k, begin - times[k]);
      for (let part = 1; part <= parts; part++) {
        const lag = begin - times[k] + ((until - begin) * part) / parts;
        const x1 = this._place("x", k, lag), y1 = this._place("y", k, lag);
        piece(x0, y0, x1, y1);
        x0 = x1; y0 = y1;
      }
    }
  }

  _turn(i, epoch, remainder, vx, vy, pull, met, place, spin) {
    const k = this.anchorsOf[i][this.anchorsOf[i].length - 1];
    const lag = (epoch - this.anchor.epoch.values[k]) * this.epochLength + (remainder - this.anchor.remainder.values[k]);
    const x = wrapped(place ? place[0] : this._place("x", k, lag), this.period[0]);
    const y = wrapped(place ? place[1] : this._place("y", k, lag), this.period[1]);
    this._anchor(i, epoch, remainder, x, y, vx, vy, pull, this.anchor.contacts.values[k] + met, spin,
                 this.anchor.angle.values[k] + this.anchor.spin.values[k] * lag);
  }

  _anchor(i, epoch, remainder, x, y, vx, vy, pull, contacts, spin, angle) {
    const anchor = this.anchor;
    this.anchorsOf[i].push(anchor.time.length);
    anchor.epoch.push(epoch);
    anchor.remainder.push(remainder);
    anchor.time.push(epoch * this.epochLength + remainder);
    anchor.x.push(x); anchor.y.push(y);
    anchor.vx.push(vx); anchor.vy.push(vy);
    anchor.gx.push(pull[0]); anchor.gy.push(pull[1]);
    anchor.contacts.push(contacts);
    anchor.spin.push(spin); anchor.angle.push(angle);
  }

  _lag(k, time) {
    return time - this.anchor.epoch.values[k] * this.epochLength - this.anchor.remainder.values[k];
  }

  _pull(i) {
    return this.gravity && this.disks.mass[i] < Infinity ? this.gravity : WEIGHTLESS;
  }

  _place(axis, k, lag) {
    const { [axis]: at, ["v" + axis]: speed, ["g" + axis]: pull } = this.anchor;
    return at.values[k] + lag * (speed.values[k] + 0.5 * pull.values[k] * lag);
  }

  _velocity(axis, k, lag) {
    return this.anchor["v" + axis].values[k] + this.anchor["g" + axis].values[k] * lag;
  }
}

const PARABOLA_PIECES = 8, WEIGHTLESS = [0, 0];
const WALL = 1, REST = 2;  // kinds of rows: up to WALL contacts; from REST on a disk is supported by a wall

function wrapped(x, period) {
  if (period === null) return x;
  const inside = x - period * Math.floor(x / period);
  return inside < period ? inside : 0;
}

/* How many leading values of an ascending column satisfy a condition. */
function bisect(column, holds) {
  return firstOf(column.length, (place) => !holds(column.values[place]));
}

/* The first of so many places from which on something is so. */
function firstOf(count, so) {
  let low = 0, high = count;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (so(middle)) high = middle; else low = middle + 1;
  }
  return low;
}
