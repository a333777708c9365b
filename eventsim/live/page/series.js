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

  /* Draw both, each from 0 to its largest value, and the time that is shown. */
  draw(palette, now) {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect(), context = this.canvas.getContext("2d");
    const width = (this.canvas.width = Math.round(box.width * ratio)), height = (this.canvas.height = Math.round(box.height * ratio));
    if (!width || !this.points.length) return;
    const base = height - 14 * ratio, last = this.points[this.points.length - 1].time || 1;
    const curves = [["energy", palette.ink], ["temperature", palette.arrow]];
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    context.textBaseline = "bottom";
    curves.forEach(([name, colour], number) => {
      const most = Math.max(...this.points.map((point) => Math.abs(point[name])));
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = (number ? 1.5 : 2.5) * ratio;
      context.textAlign = number ? "right" : "left";
      context.fillText(name, number ? width : 0, height);
      if (!(most > 0)) return;
      context.beginPath();
      this.points.forEach((point, k) => context[k ? "lineTo" : "moveTo"]((width * point.time) / last, base - (base - 4 * ratio) * (point[name] / most)));
      context.stroke();
    });
    context.fillStyle = palette.faint;
    context.fillRect((width * Math.min(now, last)) / last, 0, ratio, base);
  }
}
