"use strict";
/* Matching: which contact of another engine is which of the true ones, pair by pair, with the least total difference of times.

   Contacts of the same two disks keep their order; none is matched over more than a tolerance. A contact is charged only where its
   disks are still in place: what happens to disks that have gone astray follows from what went wrong before. */

const IN_PLACE = 0.2;  // radii

class Matching {
  /* exact, other: worlds; tolerance: of times; spread: rows of the other that follow one of the same disks within this time are of
     the same contact, whose impulse goes over several steps. */
  constructor(exact, other, tolerance, spread) {
    this.spread = spread;
    this.exact = exact;
    this.other = other;
    this.tolerance = tolerance;
    this.taken = [0, 0];
    this.open = new Map();
    this.times = { found: [], missed: [], surplus: [], astray: [] };
  }

  /* Decide about all contacts before a time until which both worlds are known. */
  advance(limit) {
    const worlds = [this.exact, this.other];
    for (let which = 0; which < 2; which++) {
      const { time, a, b, kind, wall } = worlds[which].event;
      let k = this.taken[which];
      for (; k < time.length && time.values[k] <= limit; k++) {
        if (kind.values[k] > WALL) continue;
        const key = kind.values[k] === WALL ? `${a.values[k]}|${wall.values[k]}` : `${a.values[k]},${b.values[k]}`;
        if (!this.open.has(key)) this.open.set(key, { disks: kind.values[k] === WALL ? [a.values[k]] : [a.values[k], b.values[k]], lists: [[], []], last: -Infinity });
        const group = this.open.get(key), goesOn = which === 1 && time.values[k] <= group.last + this.spread;
        if (which === 1) group.last = time.values[k];
        if (!goesOn) group.lists[which].push(time.values[k]);
      }
      this.taken[which] = k;
    }
    for (const { disks, lists } of this.open.values()) this._decide(disks, lists, limit);
    for (const list of Object.values(this.times)) list.sort((x, y) => x - y);
  }

  /* How many contacts until a time were found, missed, are surplus, or belong to disks astray. */
  counts(time) {
    return Object.fromEntries(Object.entries(this.times).map(([name, list]) => [name, countUntil(list, time)]));
  }

  /* Take off the groups of contacts that nothing to come can belong to. */
  _decide(disks, lists, limit) {
    const [exact, other] = lists;
    while (exact.length || other.length) {
      let end = Math.min(exact.length ? exact[0] : Infinity, other.length ? other[0] : Infinity), i = 0, j = 0;
      for (let grown = true; grown;) {
        grown = false;
        while (i < exact.length && exact[i] <= end + this.tolerance) { end = Math.max(end, exact[i++]); grown = true; }
        while (j < other.length && other[j] <= end + this.tolerance) { end = Math.max(end, other[j++]); grown = true; }
      }
      if (end + this.tolerance >= limit) return;
      this._charge(disks, exact.splice(0, i), other.splice(0, j));
    }
  }

  _charge(disks, exact, other) {
    const { times } = this, pairs = assigned(exact, other, this.tolerance);
    const found = new Set(pairs.map(([i]) => i)), used = new Set(pairs.map(([, j]) => j));
    exact.forEach((time, i) => { (this._inPlace(disks, time) ? (found.has(i) ? times.found : times.missed) : times.astray).push(time); });
    other.forEach((time, j) => { if (!used.has(j)) (this._inPlace(disks, time) ? times.surplus : times.astray).push(time); });
  }

  /* Whether disks are where they should be just before a time. */
  _inPlace(disks, time) {
    const before = time - this.tolerance;
    return disks.every((i) => {
      const [x, y] = this.exact.placeOf(i, before), [u, v] = this.other.placeOf(i, before), [width, height] = this.exact.period;
      return Math.hypot(nearest(x - u, width), nearest(y - v, height)) <= IN_PLACE * this.exact.disks.radius[i];
    });
  }
}

/* The assignment in order that costs least: a pair costs its difference of times, a time that is left alone the tolerance. */
function assigned(exact, other, tolerance) {
  const n = exact.length, m = other.length;
  const cost = Array.from({ length: n + 1 }, (_, i) => Array.from({ length: m + 1 }, (_, j) => (i && j ? 0 : tolerance * (i + j))));
  for (let i = 1; i <= n; i++) {
    for (let j = 1; j <= m; j++) {
      const apart = Math.abs(exact[i - 1] - other[j - 1]), alone = Math.min(cost[i - 1][j], cost[i][j - 1]) + tolerance;
      cost[i][j] = apart <= tolerance ? Math.min(alone, cost[i - 1][j - 1] + apart) : alone;
    }
  }
  const pairs = [];
  for (let i = n, j = m; i && j;) {
    const apart = Math.abs(exact[i - 1] - other[j - 1]);
    if (apart <= tolerance && cost[i][j] === cost[i - 1][j - 1] + apart) pairs.unshift([--i, --j]);
    else if (cost[i][j] === cost[i - 1][j] + tolerance) i--;
    else j--;
  }
  return pairs;
}

function nearest(d, period) { return period === null ? d : d - period * Math.round(d / period); }

/* How many of ascending numbers are at most a value. */
function countUntil(list, value) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= value) low = middle + 1; else high = middle;
  }
  return low;
}
