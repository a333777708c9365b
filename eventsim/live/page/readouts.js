"use strict";
/* The read-outs: what can be measured in a world at the time that is shown. */

const BINS = 24, PRESSURE_SECONDS = 5, CURVE_POINTS = 60;

/* A sum of terms, of whose last bits nothing is left: 0 where it is below `share` of their magnitudes. */
class Sum {
  constructor() { this.value = this.size = 0; }

  add(term) { this.value += term; this.size += Math.abs(term); }

  known(share) { return Math.abs(this.value) > share * this.size ? this.value : 0; }
}

/* Kinetic energy, energy, momentum, mean square of it along x, across and along y, number, angular momentum and moment of inertia about
   (x0, y0), of the disks of finite positive mass.  corner: from which places are counted; the potential energy is 0 at (0, 0) of the
   scene's axes. */
function sums(world, state, x0, y0, share, corner = [0, 0]) {
  const [kinetic, energy, px, py, turning] = Array.from({ length: 5 }, () => new Sum());
  let count = 0, inertia = 0, xx = 0, xy = 0, yy = 0;
  for (let i = 0; i < world.count; i++) {
    const mass = world.disks.mass[i], vx = state.vx[i], vy = state.vy[i];
    if (!(mass < Infinity) || mass === 0) continue;
    kinetic.add(0.5 * mass * (vx ** 2 + vy ** 2));
    energy.add(0.5 * mass * (vx ** 2 + vy ** 2));
    if (hasHeight(world)) {
      energy.add(-mass * world.gravity[0] * (state.x[i] + corner[0]));
      energy.add(-mass * world.gravity[1] * (state.y[i] + corner[1]));
    }
    px.add(mass * vx);
    py.add(mass * vy);
    xx += mass * vx * vx;
    xy += mass * vx * vy;
    yy += mass * vy * vy;
    const x = state.x[i] - x0, y = state.y[i] - y0;
    turning.add(mass * x * vy);
    turning.add(-mass * y * vx);
    inertia += mass * (x * x + y * y);
    count++;
  }
  const told = { kinetic, energy, px, py, turning };
  for (const name in told) told[name] = told[name].known(share);
  return { ...told, count, inertia, xx, xy, yy };
}

/* Whether disks have a potential energy that their places tell: not where they fall along a period. */
function hasHeight(world) {
  return Boolean(world.gravity) && !world.gravity.some((pull, axis) => pull !== 0 && world.period[axis] !== null);
}

class Tally {
  /* Until each event, of disks of finite positive mass: the momentum that the boundary has taken up, the contacts between them, and
     the kinetic energy that events gave them.  borders: the first walls are those of the domain. */
  constructor(borders, world) {
    this.borders = borders;
    this.world = world;
    this.taken = new Column();
    this.met = new Column();
    this.given = new Column();
  }

  /* Take up rows that the world has taken up. */
  append(rows) {
    const { mass } = this.world.disks, heavy = (i) => i >= 0 && mass[i] > 0 && mass[i] < Infinity;
    for (let k = 0; k < rows.a.length; k++) {
      const count = this.taken.length, gain = (i, side) => (heavy(i) ? this._gain(i, count, side) : 0);
      this.taken.push(this.impulse(count) + (rows.kind[k] === 1 && rows.wall[k] < this.borders ? this._across(rows, k, count) : 0));
      this.met.push(this.contacts(count) + (rows.kind[k] === 0 && heavy(rows.a[k]) && heavy(rows.b[k]) ? 1 : 0));
      this.given.push(this.energy(count) + gain(rows.a[k], 0) + gain(rows.b[k], 1));
    }
  }

  /* The momentum across a side of the domain in a row: all that is exchanged, but where walls grip. */
  _across(rows, k, event) {
    if (!rows.spin_a) return rows.impulse[k];
    const disk = rows.a[k], { mass } = this.world.disks, { before, after } = this.world.change(disk, event, 0);
    const upright = this.borders === 4 && rows.wall[k] < 2; // left and right
    const change = upright ? after[0] - before[0] : after[1] - before[1];
    return mass[disk] < Infinity && change ? mass[disk] * Math.abs(change) : rows.impulse[k];
  }

  cut(count) { for (const column of [this.taken, this.met, this.given]) column.length = Math.min(column.length, count); }

  impulse(count) { return count ? this.taken.values[count - 1] : 0; }

  contacts(count) { return count ? this.met.values[count - 1] : 0; }

  energy(count) { return count ? this.given.values[count - 1] : 0; }

  /* The kinetic energy that an event gave to one of its disks. */
  _gain(i, event, side) {
    const gain = this.world.change(i, event, side);
    return 0.5 * this.world.disks.mass[i] * (gain.after[0] ** 2 + gain.after[1] ** 2 - gain.before[0] ** 2 - gain.before[1] ** 2);
  }
}

const WHOLE_AREA = "V is all of the box; Z of eventsim measure counts where centres can be, and is smaller by about 2 r / L";

class Readouts {
  constructor(list, canvas) {
    this.list = list;
    this.canvas = canvas;
    this.values = new Map();
    for (const name of ["events / s", "energy", "momentum", "temperature", "pressure", "p V / N kT"]) {
      const term = document.createElement("dt"), value = document.createElement("dd");
      term.textContent = name;
      if (name === "p V / N kT") term.title = WHOLE_AREA;
      this.values.set(name, value);
      if (name === "energy") this.energyTerm = term;
      list.append(term, value);
    }
  }

  /* view: what is shown; its state lies in world.now.  gas: what `measure` knows of the scene as a gas, and where it has a dash. */
  show(world, stage, gas, tally, view) {
    const state = world.now, [x0, y0] = gas.middle || stage.corner;
    const found = sums(world, state, x0 - stage.corner[0], y0 - stage.corner[1], gas.lastDigits, stage.corner);
    const drift = (gas.kept[0] ? found.px ** 2 : 0) + (gas.kept[1] ? found.py ** 2 : 0);
    const common = (drift ? drift / (2 * gas.mass) : 0) + (gas.middle && found.inertia ? found.turning ** 2 / (2 * found.inertia) : 0);
    const events = world.eventsUntil(view.time), from = Math.max(view.time - view.speed, 0);
    const lasted = view.time > 0 ? Math.min(view.time, view.speed) / view.speed : 1;
    const noTemperature = this._noTemperature(gas, found, tally.contacts(events));
    const thermal = found.kinetic - common, known = !noTemperature && thermal >= gas.lastDigits * found.kinetic;
    const temperature = known ? (2 * thermal) / gas.freedoms : 0;
    const noPressure = noTemperature || gas.noPressure;
    const pressure = noPressure ? null : this._pressure(world, stage, tally, view, events);
    const tell = (name, text) => { this.values.get(name).textContent = text; };
    tell("events / s", number((events - world.eventsUntil(from)) / lasted));
    this.energyName = hasHeight(world) ? "kin. + pot. energy" : "kinetic energy";
    this.energyTerm.textContent = this.energyName;
    this.energyTerm.title = hasHeight(world) ? "Kinetic and potential energy; this is 0 at (0, 0)" : "";
    tell("energy", number(found.energy, 6));
    tell("momentum", `${number(found.px)}, ${number(found.py)}`);
    tell("temperature", known ? number(temperature, 4) : "–");
    this.values.get("temperature").title = noTemperature || "";
    tell("pressure", pressure === null ? "–" : number(pressure));
    tell("p V / N kT", pressure === null || !temperature ? "–" : number((pressure * gas.area) / (found.count * temperature)));
    this.values.get("pressure").title = noPressure || "";
    this.values.get("p V / N kT").title = noPressure || WHOLE_AREA;
    this.energy = found.energy;
    this.temperature = known ? temperature : null;
    // So much of what an event gives the curves rise by, and between events they are flat; null where they are not.
    this.steps = { energy: hasHeight(world) || !world.gravity ? 1 : null, temperature: world.gravity ? null : 2 / gas.freedoms };
    this._drawSpeeds(world, state, temperature || (found.count ? found.kinetic / found.count : 0), gas.maxwell, view.dark ? stage.palettes.dark : stage.palettes.light);
  }

  /* Why there is no temperature, as `measure` says; null where there is one. */
  _noTemperature(gas, { count, xx, xy, yy }, contacts) {
    if (gas.noTemperature) return gas.noTemperature;
    const trace = xx + yy;
    if (trace > 0 && (xx / trace) * (yy / trace) - (xy / trace) ** 2 <= gas.onALine.share) return contacts ? gas.onALine.why : gas.onALine.never;
    if (count < gas.few.disks && 2 * contacts < gas.few.contacts * count) return `${contacts} contacts between disks: ${gas.few.why}`;
    return null;
  }

  /* Momentum that the hard boundary took up per length and time, over the last seconds; null where there is none. */
  _pressure(world, stage, tally, view, events) {
    const length = stage.hard.reduce((sum, [p, q]) => sum + Math.hypot(q[0] - p[0], q[1] - p[1]), 0);
    const from = Math.max(view.time - PRESSURE_SECONDS * view.speed, 0);
    if (!length || view.time === from) return null;
    return (tally.impulse(events) - tally.impulse(world.eventsUntil(from))) / (length * (view.time - from));
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
