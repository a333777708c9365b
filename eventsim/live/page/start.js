"use strict";
/* The start of the page: menu, link and player brought together. */

const RESIZE_MS = 350, WAIT_MS = 1500, MARGIN = 4, LEAST = 60, LONGEST_FILE = 900_000;

class LiveView {
  constructor(root) {
    this.root = root;
    this.part = (name) => root.querySelector(`[data-part="${name}"]`);
    this.menu = new Menu(this.part("menu"), this.part, () => this.size());
    this.readouts = new Readouts(this.part("readouts"), this.part("histogram"));
    this.series = new Series(this.part("series"));
    this.player = null;
    this.acts = [];
    this.gone = null;
    this.joined = false; // a world that somebody else began: how, this page does not know
    this.world = null;
    this.edition = -1;
    this.resume = null;
    this.link = new Link((header, columns) => this._hear(header, columns), (replaced) => this._lost(replaced));
    this.menu.form.addEventListener("submit", (event) => { event.preventDefault(); this.init(); });
    this.menu.form.addEventListener("input", () => this._changed(true));
    this.menu.field("scene").addEventListener("change", () => this.init()); // a scene that is chosen is shown at once
    this.part("fold").addEventListener("click", () => this._fold(!root.classList.contains("folded")));
    for (const name of ["undo", "full", "help"]) this.part(name).addEventListener("click", () => (name === "help" ? this.keys() : this[name]()));
    this.part("file").addEventListener("change", () => this._read(this.part("file").files[0]));
    window.addEventListener("hashchange", () => { if (location.hash.slice(1) !== this.address) this._openAddress(); });
    window.addEventListener("keydown", (event) => {
      if (event.key === "m" && !this.menu.form.contains(event.target)) this._fold(!root.classList.contains("folded"));
    });
  }

  /* The size of the picture, and so of a box in it, in pixels. */
  size() {
    const box = this.part("canvas").getBoundingClientRect();
    return [box.width, box.height].map((length) => Math.max(Math.floor(length) - 2 * MARGIN, LEAST));
  }

  /* Begin with what the menu says. */
  init(size = null) {
    if (!this.menu.form.reportValidity()) return;
    this._compared(this.menu.field("compare").checked);
    this._open(this.menu.message(size || this.size()));
  }

  /* Back to the start; what was thrown or moved is forgotten. */
  reset() {
    if (this.acts.length && !this.joined) this._again([]);
    else { this.player.pause(); this.player.seek(0); }
  }

  /* Take back the last throw or move: the same start and the other acts give the world that was. */
  undo() {
    const last = this._last();
    if (last >= 0 && !this.joined) this._again(this.acts.filter((_, k) => k !== last));
  }

  /* The place of the last act of a hand; the window's size is none. */
  _last() { return this.acts.findLastIndex(({ type }) => type !== "resize"); }

  _again(acts) {
    const last = acts.length < this.acts.length && acts.length ? acts[acts.length - 1] : null;
    this._open(this.current);
    for (const act of acts) this._act(act);
    this.resume = { time: last && last.type === "throw" ? last.time : 0, playing: false };
  }

  full() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.root.requestFullscreen().catch(() => this._notice("This browser gives no full screen."));
  }

  /* Show or hide the keys. */
  keys(yes = this.part("keys").hidden) {
    this.part("keys").hidden = !yes;
    this.part("help").setAttribute("aria-expanded", String(yes));
  }

  /* What the player tells. */

  report(player) {
    if (this.player !== player || this.edition < 0) return;
    this.link.send({ type: "shown", edition: this.edition, time: player.wanted, events: player.awaited ? player.world.event.time.length : player.world.eventsUntil(player.view.time), speed: player.view.speed });
  }

  tell(player) {
    this.readouts.show(player.world, player.stage, player.gas, player.tally, player.view);
    this.series.take(player.view.time, this.readouts.energy, this.readouts.temperature);
    this.series.draw(player.view.dark ? player.stage.palettes.dark : player.stage.palettes.light, player.view.time,
                     this.readouts.energyName, player.start, player.world, player.tally, this.readouts.steps);
    const done = player.ended !== null && player.view.time >= player.duration;
    if (done !== this.done) { this.done = done; this._notice(done ? player.ended : null); }
    if (!player.comparison) return;
    const { exact, other } = player.comparison.told(player.view.time);
    this.part("exact").innerHTML = exact;
    this.part("differences").innerHTML = other;
  }

  /* The user did something to the time: whoever looks at the same world sees it too. */
  controlled() {
    const { view, direction, playing } = this.player;
    this.link.send({ type: "control", time: view.time, speed: view.speed, direction, playing });
  }

  /* A disk was dragged: thrown so that it would come as far in a second of playing, or put there; or a disk or a wall was drawn. */
  dragged(held) {
    const { tool, disk, dx, dy, from, to, radius } = held, { world, stage, view } = this.player, now = world.state(view.time), time = view.time;
    const acts = {
      throw: () => ({ disk, velocity: this.player.thrown(held) }),
      move: () => ({ disk, position: [now.x[disk] + stage.corner[0] + dx, now.y[disk] + stage.corner[1] + dy] }),
      disk: () => ({ position: from, radius }),
      wall: () => ({ start: from, end: to }),
    };
    this._act({ type: tool, time, ...acts[tool]() });
  }

  /* The window has another size: the box takes it on once the window keeps still. */
  resized() {
    clearTimeout(this.resizing);
    this.resizing = setTimeout(() => {
      const size = this.size();
      if (!this.player || !this.player.resizable || !this.menu.follows || !this.current || this.current.scene !== "menu") return;
      if (this.asked && Math.max(Math.abs(size[0] - this.asked[0]), Math.abs(size[1] - this.asked[1])) < 2) return;
      this.asked = size;
      this._act({ type: "resize", time: this.player.view.time, size });
      this._address({ ...this.current, menu: { ...this.current.menu, width: size[0], height: size[1] } });
    }, RESIZE_MS);
  }

  _open(message) {
    this.current = message;
    this._changed(false);
    this.joined = false;
    this.acts = [];
    this._undoable();
    this.asked = this.size();
    this._address(message);
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this._notice("Preparing; an engine that runs for the first time is compiled."), WAIT_MS);
    this.link.ask(message);
  }

  _act(message) {
    this.acts.push(message);
    this._undoable();
    // Done once there is a connection again; all but a throw begin a new run, whose time begins there.
    if (this.resume && message.type !== "throw") this.resume.time = 0;
    this.link.ask(message);
  }

  /* What the server tells. */

  _hear(header, columns) {
    const heard = {
      hello: () => this._hello(header),
      opened: () => this._opened(header, columns),
      rows: () => this.player.take(header.track, columns, header.horizon, header.ended),
      cut: () => this.player.cut(header.count, header.time),
      control: () => this._follow(header),
      error: () => {
        this._notice(header.text);
        if (!this.joining) { this._refused(); return; }
        this.joining = false;
        this.gone = `The world of this link is gone (${header.text}); this is a new one.`;
        this.init();
      },
      done: () => { clearTimeout(this.waiting); if (this.link.pending === 0 && this.resume) { const { time, playing } = this.resume; this.resume = null; this.player.await(time, playing); } },
    };
    heard[header.type]();
  }

  _hello(header) {
    this.menu.offer(header.gallery, header.given);
    this._notice(null);
    if (!this.current) { this._openAddress(); return; }
    // The server is back, and knows nothing: the same start and the same acts give the same world again.
    this.link.ask(this.current);
    for (const act of this.acts) this.link.ask(act);
  }

  _openAddress() {
    const address = location.hash.slice(1), world = new URLSearchParams(address).get("world");
    if (world !== null) {
      this.joining = this.joined = true;
      this.current = this.menu.message();
      this.link.ask({ type: "join", world });
      return;
    }
    const size = this.menu.read(address);
    this.init(size);
  }

  _opened(header, columns) {
    const { x, y, vx, vy, radius, mass, species, spin } = columns;
    const begin = () => new World({ ...header.scene, disks: { x, y, vx, vy, radius, mass, spin } });
    const stage = { ...header.stage, species }, playing = this.player && this.player.playing && header.why === "resize";
    if (this.current && this.current.scene === "menu") stage.shown = [-MARGIN, -MARGIN, stage.size[0] + MARGIN, stage.size[1] + MARGIN];
    const alike = header.stage.masses[0] === header.stage.masses[1], own = alike || header.stage.own === "species" ? header.stage.own : "mass";
    const description = { ...header, stage, begin, app: this, colour: own, dark: false, trails: false, flash: false, arrows: false, impulse: false };
    clearTimeout(this.waiting);
    this.joining = false;
    this.done = false;
    this.edition = header.edition;
    this._compared(header.tracks > 1 || (header.rate !== null && header.notice === null));
    this.series.forget(); // time begins anew
    if (this.player) this.player.open(begin(), description);
    else this.player = new LivePlayer(this.root, begin(), description);
    this.player.resizable = header.resizable;
    this.player._key_of_colours();
    this.player._label();
    this.player.show();
    this._notice(this.gone || header.notice);
    this.gone = null;
    this.part("settings").hidden = header.settings === null;
    this.part("settings").textContent = header.settings || "";
    this.part("title").textContent = header.title;
    document.title = `${header.title} – eventsim live`;
    this.part("scene-file").href = `worlds/${header.world}/scene.toml`;
    this.part("log-file").href = `worlds/${header.world}/log.csv`;
    this.part("world").href = `#world=${header.world}`;
    if (playing) this.player.play();
  }

  _follow(header) {
    const { player } = this;
    player.setSpeed(header.speed / player.usualSpeed);
    player.direction = header.direction;
    player.await(header.time, header.playing);
  }

  _lost(replaced) {
    if (this.player) {
      if (!this.resume) this.resume = { time: this.player.view.time, playing: this.player.playing };
      this.player.pause();
    }
    this.edition = -1;
    this._notice(replaced
      ? "The server was started anew, and told another address: open that one. This page cannot reach it."
      : "The connection to the server is lost; trying again. (eventsim live starts it.)");
  }

  /* The rest of the page. */

  /* Whether the menu says another scene than the one that is shown: its button says so. */
  _changed(yes) {
    this.menu.form.classList.toggle("changed", yes);
    this.part("init").title = yes ? "Begin with what the menu says now; the picture is of what it said before" : "Begin with this scene";
  }

  _address(message) {
    this.address = Menu.address(message) || "";
    history.replaceState(null, "", this.address ? `#${this.address}` : location.pathname);
  }

  /* The oldest act that waits for its answer was refused: there is nothing of it to take back. */
  _refused() {
    const place = this.acts.length - this.link.pending;
    if (place >= 0) this.acts.splice(place, 1);
    this._undoable();
  }

  _undoable() { this.part("undo").disabled = this.joined || this._last() < 0; }

  _notice(text) {
    this.part("notice").hidden = text === null;
    this.part("notice").textContent = text || "";
  }

  _compared(yes) {
    this.root.classList.toggle("compared", yes);
    this.part("beside").hidden = this.part("exact").hidden = !yes;
  }

  _fold(yes) {
    this.root.classList.toggle("folded", yes);
    this.part("fold").setAttribute("aria-expanded", String(!yes));
  }

  async _read(file) {
    if (!file) return;
    this.part("file").value = "";
    if (file.size > LONGEST_FILE) { this._notice(`${file.name} is longer than ${LONGEST_FILE} bytes: open it with eventsim live ${file.name}`); return; }
    this.menu.take(await file.text());
    this.init();
  }
}

window.live = new LiveView(document.querySelector(".live"));
