"use strict";
/* The read-outs: what can be measured in a world at the time that is shown. */

const BINS = 24, PRESSURE_SECONDS = 5, CURVE_POINTS = 60;

/* Kinetic energy, potential energy, momentum, number, angular momentum and moment of inertia about (x0, y0), of the disks of finite
   positive mass. */
function sums(world, state, x0, y0) {
  let kinetic = 0, potential = 0, px = 0, py = 0, count = 0, turning = 0, inertia = 0;
  for (let i = 0; i < world.count; i++) {
    const mass = world.disks.mass[i];
    if (!(mass < Infinity) || mass === 0) continue;
    kinetic += 0.5 * mass * (state.vx[i] ** 2 + state.vy[i] ** 2);
    if (world.gravity) potential -= mass * (world.gravity[0] * state.x[i] + world.gravity[1] * state.y[i]);
    px += mass * state.vx[i];
    py += mass * state.vy[i];
    const x = state.x[i] - x0, y = state.y[i] - y0;
    turning += mass * (x * state.vy[i] - y * state.vx[i]);
    inertia += mass * (x * x + y * y);
    count++;
  }
  return { kinetic, energy: kinetic + potential, px, py, count, turning, inertia };
}

class WallImpulses {
  /* The momentum that the boundary has taken up until each event. borders: the first walls are those of the domain. */
  constructor(borders) {
    this.borders = borders;
    this.total = new Column();
  }

  append(rows) {
    for (let k = 0; k < rows.a.length; k++) {
      const taken = rows.kind[k] === 1 && rows.wall[k] < this.borders ? rows.impulse[k] : 0;
      this.total.push(this.until(this.total.length) + taken);
    }
  }

  cut(count) { this.total.length = Math.min(this.total.length, count); }

  until(count) { return count ? this.total.values[count - 1] : 0; }
}

class Readouts {
  constructor(list, canvas) {
    this.list = list;
    this.canvas = canvas;
    this.values = new Map();
    for (const name of ["events / s", "energy", "momentum", "temperature", "pressure", "p V / N kT"]) {
      const term = document.createElement("dt"), value = document.createElement("dd");
      term.textContent = name;
      this.values.set(name, value);
      list.append(term, value);
    }
  }

  /* view: what is shown; its state lies in world.now.  gas: what `measure` knows of the scene as a gas, and where it has a dash. */
  show(world, stage, gas, impulses, view) {
    const state = world.now, [x0, y0] = gas.middle || stage.corner;
    const found = sums(world, state, x0 - stage.corner[0], y0 - stage.corner[1]);
    const drift = (gas.kept[0] ? found.px ** 2 : 0) + (gas.kept[1] ? found.py ** 2 : 0);
    const common = (drift ? drift / (2 * gas.mass) : 0) + (gas.middle && found.inertia ? found.turning ** 2 / (2 * found.inertia) : 0);
    const temperature = gas.noTemperature ? 0 : (2 * (found.kinetic - common)) / gas.freedoms;
    const events = world.eventsUntil(view.time), from = Math.max(view.time - view.speed, 0);
    const lasted = view.time > 0 ? Math.min(view.time, view.speed) / view.speed : 1;
    const pressure = this._pressure(world, stage, impulses, view, events);
    const tell = (name, text) => { this.values.get(name).textContent = text; };
    tell("events / s", number((events - world.eventsUntil(from)) / lasted));
    tell("energy", number(found.energy, 6));
    tell("momentum", `${number(found.px)}, ${number(found.py)}`);
    tell("temperature", gas.noTemperature ? "–" : number(temperature, 4));
    this.values.get("temperature").title = gas.noTemperature || "";
    tell("pressure", pressure === null ? "–" : number(pressure));
    const none = gas.noPressure || pressure === null || !temperature;
    tell("p V / N kT", none ? "–" : number((pressure * gas.area) / (found.count * temperature)));
    this.values.get("p V / N kT").title = gas.noPressure || "";
    this.energy = found.energy;
    this.temperature = temperature;
    this._drawSpeeds(world, state, temperature || (found.count ? found.kinetic / found.count : 0), gas.maxwell, view.dark ? stage.palettes.dark : stage.palettes.light);
  }

  /* Momentum that the hard boundary took up per length and time, over the last seconds; null where there is none. */
  _pressure(world, stage, impulses, view, events) {
    const length = stage.hard.reduce((sum, [p, q]) => sum + Math.hypot(q[0] - p[0], q[1] - p[1]), 0);
    const from = Math.max(view.time - PRESSURE_SECONDS * view.speed, 0);
    if (!length || view.time === from) return null;
    return (impulses.until(events) - impulses.until(world.eventsUntil(from))) / (length * (view.time - from));
  }

  /* The histogram, and the density of speeds in two dimensions: m v / kT exp(-m v^2 / 2 kT), averaged over the masses. */
  _drawSpeeds(world, state, temperature, maxwell, palette) {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect(), context = this.canvas.getContext("2d");
    const width = (this.canvas.width = Math.round(box.width * ratio)), height = (this.canvas.height = Math.round(box.height * ratio));
    const masses = new Map(), speeds = [];
    for (let i = 0; i < world.count; i++) {
      const mass = world.disks.mass[i];
      if (!(mass < Infinity) || mass === 0) continue;
      masses.set(mass, (masses.get(mass) || 0) + 1);
      speeds.push(Math.hypot(state.vx[i], state.vy[i]));
    }
    const lightest = Math.min(...masses.keys()), end = 3.6 * Math.sqrt(temperature / lightest);
    if (!(end > 0) || !(end < Infinity) || !width) return;
    const counts = new Float64Array(BINS), base = height - 14 * ratio;
    for (const speed of speeds) counts[Math.min(Math.floor((speed / end) * BINS), BINS - 1)]++;
    const density = (v) => {
      let sum = 0;
      for (const [mass, count] of masses) sum += ((count * mass * v) / temperature) * Math.exp((-mass * v * v) / (2 * temperature));
      return sum;
    };
    const curve = Array.from({ length: CURVE_POINTS + 1 }, (_, k) => (density((end * k) / CURVE_POINTS) * end) / BINS);
    const top = Math.max(Math.max(...curve) * 1.6, Math.min(Math.max(...counts), Math.max(...curve) * 2.5)), y = (n) => base * (1 - Math.min(n / top, 1));
    context.fillStyle = palette.faint;
    context.globalAlpha = 0.55;
    counts.forEach((n, k) => context.fillRect((width * k) / BINS, y(n), width / BINS - ratio, base - y(n)));
    context.globalAlpha = 1;
    if (maxwell) {
      context.strokeStyle = palette.arrow;
      context.lineWidth = 1.6 * ratio;
      context.beginPath();
      curve.forEach((n, k) => context[k ? "lineTo" : "moveTo"]((width * k) / CURVE_POINTS, y(n)));
      context.stroke();
    }
    context.fillStyle = palette.faint;
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    context.textBaseline = "bottom";
    context.fillText("0", 0, height);
    context.textAlign = "center";
    context.fillText(maxwell ? "speed, and Maxwell's curve" : "speed", width / 2, height);
    context.textAlign = "right";
    context.fillText(number(end), width, height);
  }
}

function number(value, places = 3) {
  const rounded = Number(value.toPrecision(places));
  return Math.abs(rounded) >= 1e6 ? rounded.toExponential(2) : rounded.toLocaleString("en", { maximumSignificantDigits: places });
}
