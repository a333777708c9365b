"use strict";
/* Energy and temperature against time, as far as they were shown. */

const MOST_POINTS = 600;

class Series {
  constructor(canvas) {
    this.canvas = canvas;
    this.forget();
  }

  /* Begin anew: the run is another one. */
  forget() { this.points = []; }

  /* What was seen behind a time did not happen. */
  cut(time) { this.points = this.points.filter((point) => point.time <= time); }

  /* Take what is shown at a time, kept in the order of time; of too many every other one is forgotten. */
  take(time, energy, temperature) {
    let place = this.points.length;
    while (place > 0 && this.points[place - 1].time > time) place--;
    if (place > 0 && this.points[place - 1].time === time) return;
    this.points.splice(place, 0, { time, energy, temperature });
    if (this.points.length > MOST_POINTS) this.points = this.points.filter((_, k) => k % 2 === 0);
  }

  /* The points of a curve, [time, value], on a line of so many pixels: where it changes at events alone (`step`: by so much of the
     energy that they give, null where it does not), it is level between them.  Of the events of a pixel the first has a place. */
  curve(key, world, tally, step, pixels) {
    const known = this.points.filter((point) => point[key] !== null), found = [], times = world.event.time.values;
    const pixel = known.length ? known[known.length - 1].time / pixels : 0;
    known.forEach((point, place) => {
      const before = known[place - 1];
      if (before && step !== null) {
        const first = world.eventsUntil(before.time), end = world.eventsUntil(point.time);
        for (let k = first, next; k < end; k = next) {
          const time = times[k], until = (Math.floor(time / pixel) + 1) * pixel;
          next = Math.min(Math.max(bisect(world.event.time, (other) => other < until), k + 1), end);
          const value = next < end ? before[key] + step * (tally.energy(next) - tally.energy(first)) : point[key];
          found.push([time, found[found.length - 1][1]], [time, value]);
        }
        if (first === end) found.push([point.time, before[key]]); // nothing happened: what differs are last bits
      }
      found.push([point.time, point[key]]);
    });
    return found;
  }

  /* Draw what is known of both, each from 0 to its largest value, over a line of times; and the time that is shown.
     energyName: which energy it is; start: the scene's clock at time 0; world, tally, steps: see `curve`. */
  draw(palette, now, energyName, start, world, tally, steps) {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect(), context = this.canvas.getContext("2d");
    const width = (this.canvas.width = Math.round(box.width * ratio)), height = (this.canvas.height = Math.round(box.height * ratio));
    if (!width || !this.points.length) return;
    const base = height - 42 * ratio, last = this.points[this.points.length - 1].time || 1;
    const curves = [["energy", energyName, palette.ink], ["temperature", "temperature", palette.arrow]];
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    context.textBaseline = "bottom";
    curves.forEach(([key, name, colour], place) => {
      const known = this.curve(key, world, tally, steps[key], width), values = known.map(([, value]) => value);
      if (!known.length) return;
      const low = Math.min(...values, 0), high = Math.max(...values, 0), y = (value) => base - (base - 4 * ratio) * ((value - low) / (high - low || 1));
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = (place ? 1.5 : 2.5) * ratio;
      context.textAlign = "left";
      context.fillText(`${name} ${number(low)} to ${number(high)}`, 0, height - (place ? 0 : 14) * ratio);
      context.beginPath();
      known.forEach(([time, value], k) => context[k ? "lineTo" : "moveTo"]((width * time) / last, y(value)));
      context.stroke();
    });
    context.fillStyle = palette.faint;
    context.fillRect(0, base, width, ratio);
    for (const [time, at, align] of [[0, 0, "left"], [last, width, "right"]]) {
      context.textAlign = align;
      context.fillText(`t = ${number(start + time)}`, at, base + 14 * ratio);
    }
    context.fillRect((width * Math.min(now, last)) / last, 0, ratio, base);
  }
}
