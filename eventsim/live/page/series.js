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

  /* Draw what is known of both, each from 0 to its largest value, over a line of times; and the time that is shown.
     energyName: which energy it is; start: the scene's clock at time 0. */
  draw(palette, now, energyName, start) {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect(), context = this.canvas.getContext("2d");
    const width = (this.canvas.width = Math.round(box.width * ratio)), height = (this.canvas.height = Math.round(box.height * ratio));
    if (!width || !this.points.length) return;
    const base = height - 42 * ratio, last = this.points[this.points.length - 1].time || 1;
    const curves = [["energy", energyName, palette.ink], ["temperature", "temperature", palette.arrow]];
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    context.textBaseline = "bottom";
    curves.forEach(([key, name, colour], place) => {
      const known = this.points.filter((point) => point[key] !== null), values = known.map((point) => point[key]);
      if (!known.length) return;
      const low = Math.min(...values, 0), high = Math.max(...values, 0), y = (value) => base - (base - 4 * ratio) * ((value - low) / (high - low || 1));
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = (place ? 1.5 : 2.5) * ratio;
      context.textAlign = "left";
      context.fillText(`${name} ${number(low)} to ${number(high)}`, 0, height - (place ? 0 : 14) * ratio);
      context.beginPath();
      known.forEach((point, k) => context[k ? "lineTo" : "moveTo"]((width * point.time) / last, y(point[key])));
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
