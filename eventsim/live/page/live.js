"use strict";
/* The live player: a player whose events are still to come. It plays as far as they are known and waits there for more. */

const REPORT_MS = 150, READOUT_MS = 200, STEP_TRIES = 40;

class LivePlayer extends Player {
  /* description: as of the player, and {usualSpeed, borders, begin, app}; begin() makes another world at the same start. */

  /* Begin with a world at its start; what is said about colours and speed stays as it was. */
  open(world, description) {
    const factor = this.usualSpeed ? this.view.speed / this.usualSpeed : 1;
    this.app = description.app;
    this.gas = description.gas;
    super.open(world, { ...description, duration: description.usualSpeed, seconds: 1 });
    this.view.speed = factor * this.usualSpeed;
    this.tally = new Tally(description.borders, this.world);
    this.horizons = [0];
    this.duration = 0;
    this.ended = null;
    this.awaited = null;
    this.script = { frames: 0, spent: 0, worst: 0, starved: 0 };
    this.comparison = null;
    if (description.tracks > 1) {
      this.horizons.push(0);
      const { late, spread, rate, opponent, settings } = description;
      const told = { frame: this.usualSpeed / rate, name: OPPONENTS[opponent], late, spread, given: settings };
      this.comparison = new Comparison(this.part("frames"), world, description.begin(), this.stage, told);
    }
  }

  /* Take up rows of a track: all of them until `horizon`; ended: why there will be no more, or null. */
  take(track, rows, horizon, ended) {
    if (track === 0) {
      this.world.append(rows);
      this.tally.append(rows);
      this.ended = ended;
    } else {
      this.comparison.other.append(rows);
    }
    // What an engine has given up does not hold back the other.
    this.horizons[track] = ended !== null && track > 0 ? Infinity : horizon;
    if (this.comparison) this.comparison.known(Math.min(...this.horizons));
    this._extend();
  }

  /* Forget all rows but the first `count`: from `time` on, things go differently. */
  cut(count, time) {
    this.world.cut(count);
    this.tally.cut(count);
    this.horizons[0] = time;
    this.ended = null;
    this.app.series.cut(time);
    this.duration = Math.min(this.duration, time);
    this.seek(this.view.time);
  }

  /* Go to a time as soon as it is known, and play on from there or not. */
  await(time, playing) {
    this.pause();
    this.awaited = { time, playing, event: false, tries: 0 };
    this._report(true);
    this._extend();
  }

  play() {
    if (this.playing) return;
    if (this.direction < 0 && this.view.time <= 0) this.direction = 1;
    this.awaited = null;
    this.playing = true;
    this.before = null;
    requestAnimationFrame((now) => this._tick(now));
    this._label();
    this._report(true);
  }

  pause() {
    super.pause();
    this._show();
    this._report(true);
  }

  seek(time) {
    super.seek(time);
    this._report(false);
  }

  /* As the player's, but where the next event is not known yet it is waited for. */
  step(direction) {
    const known = direction < 0 || this.ended !== null || this.world.nextEvent(this.view.time) !== null;
    if (known) {
      this.awaited = null;
      super.step(direction);
      return;
    }
    this.pause();
    this.awaited = { time: this.duration, playing: false, event: true, tries: 0 };
    this._report(true);
  }

  show() { this._show(); }

  /* The time that the server is to know about: it simulates ahead of it. */
  get wanted() { return this.awaited ? Math.max(this.awaited.time, this.view.time) : this.view.time; }

  /* More is known: play on, or go to what was waited for. */
  _extend() {
    this.duration = Math.max(Math.min(...this.horizons), 0);
    const awaited = this.awaited;
    if (awaited && awaited.event) {
      if (this.world.nextEvent(this.view.time) !== null || this.ended !== null || awaited.tries++ > STEP_TRIES) {
        this.awaited = null;
        super.step(1);
      } else {
        awaited.time = this.duration;
        this._report(true);
      }
    } else if (awaited && (this.duration >= awaited.time || this.ended !== null)) {
      this.awaited = null;
      this.seek(awaited.time);
      if (awaited.playing) this.play();
    } else if (!this.playing) this._show();
  }

  _tick(now) {
    if (!this.playing) return;
    const begun = performance.now();
    if (this.before !== null) {
      const time = this.view.time + (this.direction * this.view.speed * (now - this.before)) / 1000;
      this.view.time = Math.min(Math.max(time, 0), this.duration);
      if (time < 0 || (time > this.duration && this.ended !== null)) this.pause();
      else if (time > this.duration) this.script.starved += now - this.before;
    }
    this.before = now;
    this._show();
    this._report(false);
    const spent = performance.now() - begun;
    this.script.frames++;
    this.script.spent += spent;
    this.script.worst = Math.max(this.script.worst, spent);
    if (this.playing) requestAnimationFrame((next) => this._tick(next));
  }

  _show() {
    this.part("scrub").max = String(this.duration);
    super._show();
    this.part("clock").textContent = `t = ${digits(this.start + this.view.time, 10 * this.usualSpeed)}`;
    if (this.comparison) this.comparison.draw(this.view);
    if (this.hand) this.hand.draw(this.drawing, this.world.now);
    const now = performance.now();
    if (this.playing && now - (this.read || 0) < READOUT_MS) return;
    this.read = now;
    this.app.tell(this);
  }

  resize() {
    if (this.comparison) this.comparison.drawing.resize();
    super.resize();
    this.app.resized();
  }

  /* Tell the server how far the page has come; not more often than it needs to know. */
  _report(now) {
    const time = performance.now();
    if (!now && time - (this.reported || 0) < REPORT_MS) return;
    this.reported = time;
    this.app.report(this);
  }

  _connect() {
    this.hand = new Hand(this, () => this.part("drag").value, (held) => this.app.dragged(held));
    super._connect();
    this.part("reset").addEventListener("click", () => this.app.reset());
    for (const name of ["play", "back", "forward", "reverse", "canvas", "reset"]) this.part(name).addEventListener("click", () => this.app.controlled());
    for (const name of ["scrub", "speed"]) this.part(name).addEventListener("change", () => this.app.controlled());
  }

  /* While a disk is dragged it is the one of which is told. */
  _hover(event) {
    const { held, dragged } = this.hand;
    if (!held || !dragged || held.disk < 0) { super._hover(event); return; }
    this.pointer = { x: event.clientX, y: event.clientY };
    this._mark(held.disk);
  }

  _words(i) {
    const { held, dragged } = this.hand, number = (value) => Number(value.toPrecision(4));
    if (!held || !dragged || held.tool !== "throw") return super._words(i);
    const velocity = this.thrown(held);
    return [...super._words(i), `thrown at  ${number(Math.hypot(...velocity))}   (${velocity.map(number).join(", ")})`];
  }

  /* The velocity that a drag gives: with it the disk would come as far in a second of playing. */
  thrown({ dx, dy }) { return [dx / this.usualSpeed, dy / this.usualSpeed]; }

  _key(event) {
    if (this.part("menu").contains(event.target) && event.target.tagName !== "BUTTON") return;
    const app = { u: () => this.app.undo(), f: () => this.app.full(), "?": () => this.app.keys(), Escape: () => this.app.keys(false) };
    if (event.key in app && !event.ctrlKey && !event.metaKey && !event.altKey) { app[event.key](); return; }
    super._key(event);
    this.app.controlled();
  }
}
