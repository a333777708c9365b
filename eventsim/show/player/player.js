"use strict";
/* The player: time that passes, forwards or backwards, and what the user does to it. */

const COLOURS = ["speed", "species", "mass", "contacts", "index"];
const FASTEST_CHANGE = 64, MOST_TOLD = 4;

class Player {
  /* root: the element with the player's markup. description: see page.py. */
  constructor(root, world, description) {
    this.root = root;
    this.part = (name) => root.querySelector(`[data-part="${name}"]`);
    this.canvas = this.part("canvas");
    this.view = { dark: description.dark, trails: description.trails, flash: description.flash, arrows: description.arrows, impulse: description.impulse,
                  colour: description.colour };
    this.open(world, description);
    this._connect();
    this._show();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  /* Begin with a world at its start. */
  open(world, description) {
    this.world = world;
    this.stage = description.stage;
    this.start = description.startTime;
    this.duration = description.duration;
    this.trusted = description.trusted;
    this.usualSpeed = description.duration / description.seconds;
    Object.assign(this.view, { time: 0, speed: this.usualSpeed, marked: -1 });
    this.direction = 1;
    this.playing = false;
    this.drawing = new Drawing(this.canvas, world, this.stage);
  }

  /* Follow the size of the canvas. */
  resize() {
    this.drawing.resize();
    this._show();
  }

  /* The state at the time that is shown, on the scene's axes: {time, x, y, vx, vy}. */
  state() {
    const now = this.world.state(this.view.time), [cx, cy] = this.stage.corner;
    return { time: this.start + this.view.time, x: Array.from(now.x, (x) => x + cx), y: Array.from(now.y, (y) => y + cy),
             vx: Array.from(now.vx), vy: Array.from(now.vy) };
  }

  /* Go to a time, counted from the start of the run. */
  seek(time) {
    this.view.time = Math.min(Math.max(time, 0), this.duration);
    this._show();
  }

  play() {
    if (this.playing) return;
    if (this.direction > 0 && this.view.time >= this.duration) this.view.time = 0;
    if (this.direction < 0 && this.view.time <= 0) this.view.time = this.duration;
    this.playing = true;
    this.before = null;
    requestAnimationFrame((now) => this._tick(now));
    this._label();
  }

  pause() {
    this.playing = false;
    this._label();
  }

  toggle() {
    if (this.playing) this.pause(); else this.play();
  }

  reverse() {
    this.direction = -this.direction;
    this._label();
  }

  /* Go to the next event, +1, or to the one before, -1; to the end or the beginning where there is none. */
  step(direction) {
    this.pause();
    const event = direction > 0 ? this.world.nextEvent(this.view.time) : this.world.previousEvent(this.view.time);
    this.seek(event !== null ? event : direction > 0 ? this.duration : 0);
  }

  setSpeed(factor) {
    const bounded = Math.min(Math.max(factor, 1 / FASTEST_CHANGE), FASTEST_CHANGE);
    this.view.speed = this.usualSpeed * bounded;
    this.part("speed").value = String(Math.log2(bounded));
    this._label();
    this._show();
  }

  _tick(now) {
    if (!this.playing) return;
    if (this.before !== null) {
      const time = this.view.time + (this.direction * this.view.speed * (now - this.before)) / 1000;
      this.view.time = Math.min(Math.max(time, 0), this.duration);
      if (this.view.time !== time) this.pause();
    }
    this.before = now;
    this._show();
    if (this.playing) requestAnimationFrame((next) => this._tick(next));
  }

  _show() {
    const events = this.world.eventsUntil(this.view.time), all = this.world.event.time.length;
    this.drawing.draw(this.view);
    this.part("scrub").value = String(this.view.time);
    this.part("clock").textContent = `t = ${digits(this.start + this.view.time, this.duration)}`;
    this.part("events").textContent = `${events.toLocaleString("en")} of ${all.toLocaleString("en")} event${all === 1 ? "" : "s"}`;
    if (this.trusted) this._trust();
    this._tell_contact();
    if (this.view.marked >= 0) this._tell();
  }

  /* Say whether the places that are shown are those of the scene, or only their statistics are. */
  _trust() {
    const { event, time } = this.trusted, lost = this.start + this.view.time >= time;
    this.part("trust").textContent = lost
      ? `beyond the digits since event ${event.toLocaleString("en")}: statistics hold`
      : `positions hold until event ${event.toLocaleString("en")}`;
  }

  _label() {
    this.part("play").textContent = this.playing ? "❚❚" : this.direction > 0 ? "▶" : "◀";
    this.part("play").title = this.playing ? "Pause (space)" : "Play (space)";
    this.part("reverse").setAttribute("aria-pressed", String(this.direction < 0));
    this.part("rate").textContent = `× ${Number(this.view.speed.toPrecision(2))}`;
    this.part("trails").parentElement.title = `Where disks have been in the last second of the film: ${Number(this.view.speed.toPrecision(2))} on the scene's clock`;
    this.part("rate").title = "So much of the scene's clock passes in a second: × 1 is real time, if its unit is a second (key 1)";
  }

  _connect() {
    const on = (name, event, action) => this.part(name).addEventListener(event, action);
    this.part("scrub").max = String(this.duration);
    on("play", "click", () => this.toggle());
    on("reverse", "click", () => this.reverse());
    on("back", "click", () => this.step(-1));
    on("forward", "click", () => this.step(1));
    on("scrub", "input", () => this.seek(Number(this.part("scrub").value)));
    on("speed", "input", () => this.setSpeed(2 ** Number(this.part("speed").value)));
    const colour = this.part("colour");
    for (const name of COLOURS) colour.append(new Option(name, name, false, name === this.view.colour));
    on("colour", "change", () => { this.view.colour = colour.value; this._key_of_colours(); this._show(); });
    this._key_of_colours();
    for (const name of ["trails", "flash", "arrows", "impulse", "dark"]) {
      this.part(name).checked = this.view[name];
      on(name, "change", () => this._switch(name, this.part(name).checked));
    }
    this._switch("dark", this.view.dark);
    on("canvas", "pointermove", (event) => this._hover(event));
    on("canvas", "pointerleave", () => { this.pointer = null; this._mark(-1); });
    on("canvas", "click", () => this.toggle());
    window.addEventListener("keydown", (event) => this._key(event));
    // A button that was pressed by hand has the keyboard then: the space bar plays, Enter presses it again.
    window.addEventListener("keyup", (event) => { if (event.key === " " && event.target.tagName === "BUTTON") event.preventDefault(); });
    this.root.querySelectorAll("select").forEach((list) => this._give_back(list));
    this._label();
  }

  /* A list gives the keyboard back once something is chosen from it by hand. */
  _give_back(list) {
    let hand = false;
    list.addEventListener("pointerdown", () => { hand = true; });
    list.addEventListener("keydown", () => { hand = false; });
    list.addEventListener("change", () => { if (hand) list.blur(); });
  }

  /* Say what the colours mean: the ends of a scale, or a dot for each species. */
  _key_of_colours() {
    const { amounts, kinds, speciesNames, fastest, masses, few } = this.stage, number = (value) => String(Number(value.toPrecision(3)));
    const scale = (low, high) => [low, dot(`linear-gradient(90deg, ${amounts.join(", ")})`, "scale"), high];
    const keys = {
      speed: () => scale("0", `≥ ${number(fastest)}`),
      mass: () => (masses[0] < masses[1] ? scale(number(masses[0]), `${this.world.disks.mass.some((mass) => mass === Infinity) ? "≥ " : ""}${number(masses[1])}`) : []),
      contacts: () => scale("few", "many"),
      index: () => (this.world.count > few ? scale("0", String(this.world.count - 1))
                    : kinds.slice(0, this.world.count).flatMap((colour, k) => [dot(colour, ""), k ? String(k) : "disk 0"])),
      species: () => speciesNames.slice(0, 4).flatMap((name, k) => [dot(kinds[k % kinds.length], ""), name]),
    };
    this.part("key").replaceChildren(...keys[this.view.colour]());
    this.part("key").title = this.view.colour === "species" ? speciesNames.join("; ") : this.part("key").textContent;
  }

  _switch(name, value) {
    this.view[name] = value;
    if (name === "dark") this.root.classList.toggle("dark", value);
    this._show();
  }

  _key(event) {
    const actions = {
      " ": () => this.toggle(),
      ArrowRight: () => this.step(1),
      ArrowLeft: () => this.step(-1),
      ArrowUp: () => this.setSpeed((2 * this.view.speed) / this.usualSpeed),
      ArrowDown: () => this.setSpeed((0.5 * this.view.speed) / this.usualSpeed),
      Home: () => this.seek(0),
      End: () => this.seek(this.duration),
      1: () => this.setSpeed(1 / this.usualSpeed),
      r: () => this.reverse(),
      c: () => { this.part("impulse").checked = !this.view.impulse; this._switch("impulse", !this.view.impulse); },
    };
    if (!(event.key in actions) || event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    event.preventDefault();
    actions[event.key]();
  }

  _hover(event) {
    this.pointer = { x: event.clientX, y: event.clientY };
    this._mark(this.drawing.diskAt(event.clientX, event.clientY, this.view.time));
  }

  _mark(disk) {
    this.part("tip").hidden = disk < 0;
    if (disk < 0 && this.view.marked < 0) return;
    this.view.marked = disk;
    this._show();
  }

  /* Write what the last contact did, in the corner of the picture: the numbers beside the arrows. */
  _tell_contact() {
    const told = this.part("told"), found = this.view.impulse ? this.world.contact(this.view.time) : null;
    told.hidden = found === null;
    if (found === null) return;
    const number = (value) => (Math.abs(value) < 1e-12 * this.stage.fastest ? "0" : String(Number(value.toPrecision(4))));
    const pair = (v) => `(${v.map(number).join(", ")})`;
    const { mass } = this.world.disks, [first, last] = found.events;
    const change = ({ before, after }) => Math.hypot(after[0] - before[0], after[1] - before[1]), [one] = found.sides;
    const changed = found.sides.filter((side) => change(side) > 1e-12 * this.stage.fastest), sides = changed.length ? changed : found.sides;
    const names = sides.slice(0, MOST_TOLD).map((side) => side.disk).join(", ");
    const what = sides.length > 1 ? `disks ${names}${sides.length > MOST_TOLD ? ", ..." : ""}` : `disk ${one.disk} at ${found.walls.join(" and ")}`;
    const event = first === last ? `event ${first}` : `events ${first} to ${last}`;
    const lines = sides.slice(0, MOST_TOLD).map(({ disk, before, after }) => `disk ${disk}  v ${pair(before)} \u2192 ${pair(after)}`);
    const light = sides.find((side) => mass[side.disk] < Infinity);
    if (first === last && light) lines.push(`momentum exchanged  ${number(mass[light.disk] * change(light))}`);
    told.textContent = [`${event}, t = ${digits(this.start + found.time, this.duration || this.usualSpeed)}: ${what}`, ...lines].join("\n");
    const box = this.root.getBoundingClientRect(), canvas = this.canvas.getBoundingClientRect();
    // In the corner that is farthest from the contact.
    const [x0, y0, x1, y1] = this.stage.shown, [cx, cy] = this.stage.corner, left = 2 * (one.x + cx) > x0 + x1, low = 2 * (one.y + cy) > y0 + y1;
    told.style.left = `${left ? canvas.left - box.left + 8 : canvas.right - box.left - told.offsetWidth - 8}px`;
    told.style.top = `${low ? canvas.bottom - box.top - told.offsetHeight - 8 : canvas.top - box.top + 8}px`;
  }

  /* Write what is known of the marked disk beside the pointer. */
  _tell() {
    const tip = this.part("tip"), box = this.root.getBoundingClientRect();
    tip.textContent = this._words(this.view.marked).join("\n");
    if (!this.pointer) return;
    const left = this.pointer.x - box.left, top = this.pointer.y - box.top;
    tip.style.left = `${left + 16 + tip.offsetWidth < box.width ? left + 16 : Math.max(left - 16 - tip.offsetWidth, 0)}px`;
    tip.style.top = `${Math.min(top + 12, box.height - tip.offsetHeight)}px`;
  }

  /* What is known of a disk at the time that is shown, a line each. */
  _words(i) {
    const now = this.world.now, disks = this.world.disks, [cx, cy] = this.stage.corner, number = (value) => Number(value.toPrecision(6));
    return [
      `disk ${i}   radius ${number(disks.radius[i])}   mass ${number(disks.mass[i])}`,
      `position  ${number(now.x[i] + cx)}, ${number(now.y[i] + cy)}`,
      `velocity  ${number(now.vx[i])}, ${number(now.vy[i])}`,
      `speed  ${number(Math.hypot(now.vx[i], now.vy[i]))}   contacts ${this.world.contactsUntil(i, this.view.time)}`,
    ];
  }
}

function dot(background, kind) {
  const element = document.createElement("i");
  element.className = kind;
  element.style.background = background;
  return element;
}

/* A time with as many digits as tell apart the steps of a thousandth of a duration. */
function digits(time, duration) {
  return time.toFixed(Math.min(Math.max(3 - Math.floor(Math.log10(duration)), 0), 12));
}
