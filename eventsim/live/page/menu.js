"use strict";
/* The menu: a form from which a scene is asked for, and the part of the page's address that says the same. */

const NUMBERS = ["count", "packing", "speed", "gravity", "restitution", "temperature", "shaking", "roughness", "seed"], WORDS = ["masses", "radii"];
const OWN = "", GIVEN = "?";
const OPPONENTS = { frames: "per frame", stepped: "fixed steps", penalty: "springs", pymunk: "Chipmunk (pymunk)" };
const OPPONENT_WORDS = {
  frames: "As in a students' project that came before: it knows boxes and elastic contacts; no restitution, no round walls.",
  stepped: "Disks that overlap and approach are resolved after each step. It knows restitution, gravity, all walls.",
  penalty: "Overlapping disks push each other apart like springs, for some 20 steps: give it many steps a second.",
  pymunk: "A game engine that others wrote. It knows restitution and gravity; no round walls, no periodic boundaries.",
};

class Menu {
  /* form: the element; part: finds elements by name; size(): the size of the picture in pixels. */
  constructor(form, part, size) {
    this.form = form;
    this.part = part;
    this.size = size;
    this.text = null;
    this.field("scene").addEventListener("change", () => { this.text = null; this._choose(); });
    this.field("opponent").append(...Object.entries(OPPONENTS).map(([name, words]) => new Option(words, name)));
    for (const name of ["compare", "opponent"]) this.field(name).addEventListener("change", () => this._choose());
    part("dice").addEventListener("click", () => {
      this.field("seed").value = String(Math.floor(Math.random() * 1e6));
      form.requestSubmit();
    });
  }

  field(name) { return this.form.elements.namedItem(name); }

  /* Offer the built-in scenes, and the one that the server was started with. */
  offer(gallery, given) {
    this.gallery = new Map(gallery.map((entry) => [entry.name, entry]));
    const options = [new Option("disks in a box", OWN)];
    if (given !== null) options.push(new Option(given, GIVEN));
    const list = this.field("scene"), chosen = list.value;
    list.replaceChildren(...options, ...gallery.map(({ name }) => new Option(name, name)));
    list.value = chosen || (given !== null ? GIVEN : OWN);
    this._choose();
  }

  get own() { return this.field("scene").value === OWN && this.text === null; }
  get follows() { return this.own && this.field("follow").checked; }

  /* What to ask the server for. size: of the box of an own scene, pixels. */
  message(size = this.size()) {
    const rate = this.field("compare").checked ? Number(this.field("rate").value) : null, scene = this.field("scene").value;
    const beside = rate === null ? { rate } : { rate, opponent: this.field("opponent").value };
    if (this.text !== null) return { type: "open", scene: "text", text: this.text, ...beside };
    if (scene === GIVEN) return { type: "open", scene: "given", ...beside };
    if (scene !== OWN) return { type: "open", scene: "gallery", name: scene, parameters: this._parameters(), ...beside };
    const menu = { width: size[0], height: size[1] };
    for (const name of NUMBERS) menu[name] = Number(this.field(name).value);
    for (const name of WORDS) menu[name] = this.field(name).value;
    return { type: "open", scene: "menu", menu, ...beside };
  }

  /* The address of a message, after the #; null where it has none. */
  static address(message) {
    const found = new URLSearchParams();
    if (message.scene === "gallery") {
      found.set("gallery", message.name);
      for (const [key, value] of Object.entries(message.parameters)) found.set(key, String(value));
    } else if (message.scene === "menu") {
      for (const [key, value] of Object.entries(message.menu)) found.set(key, String(value));
    } else return null;
    if (message.rate !== null) { found.set("rate", String(message.rate)); found.set("opponent", message.opponent); }
    return found.toString();
  }

  /* Fill the form from an address; return the size that it gives to the box, null where it gives none. */
  read(address) {
    const found = new URLSearchParams(address), scene = found.get("gallery");
    if (found.has("rate")) { this.field("compare").checked = true; this.field("rate").value = found.get("rate"); }
    if (found.get("opponent") in OPPONENTS) this.field("opponent").value = found.get("opponent");
    if (scene !== null && this.gallery.has(scene)) this.field("scene").value = scene;
    else if (found.has("count")) this.field("scene").value = OWN;
    this._choose();
    for (const [key, value] of found) {
      const field = ["gallery", "rate", "opponent"].includes(key) ? null : this.field(scene === null ? key : `parameter.${key}`);
      if (field) field.value = value;
    }
    const size = [Number(found.get("width")), Number(found.get("height"))];
    return size[0] > 0 && size[1] > 0 ? size : null;
  }

  /* Take the text of a scene file instead of what the list says. */
  take(text) {
    this.text = text;
    this._choose();
  }

  /* Show the fields that belong to the chosen scene. */
  _choose() {
    const entry = this.gallery ? this.gallery.get(this.field("scene").value) : undefined;
    this.part("own").hidden = !this.own;
    this.part("own").disabled = !this.own;
    for (const name of ["rate-of-frames", "opponent", "opponent-words"]) this.part(name).hidden = !this.field("compare").checked;
    this.part("opponent-words").textContent = OPPONENT_WORDS[this.field("opponent").value];
    this.part("about").hidden = !entry && this.text === null;
    this.part("about").textContent = this.text !== null ? "A scene file that you opened." : entry ? `${entry.title}. ${entry.about}`.replaceAll("`", "") : "";
    const fields = this.part("parameters"), named = entry ? Object.entries(entry.parameters) : [];
    fields.hidden = named.length === 0 || this.text !== null;
    if (fields.dataset.scene === (entry ? entry.name : "")) return;
    fields.dataset.scene = entry ? entry.name : "";
    fields.replaceChildren(...named.map(([key, value]) => {
      const label = document.createElement("label"), field = document.createElement("input");
      field.name = `parameter.${key}`;
      field.type = typeof value === "number" ? "number" : "text";
      field.step = "any";
      field.value = String(value);
      label.append(key.replaceAll("_", " "), field);
      return label;
    }));
  }

  _parameters() {
    const found = {}, { parameters } = this.gallery.get(this.field("scene").value);
    for (const [key, value] of Object.entries(parameters)) {
      const typed = this.field(`parameter.${key}`).value;
      found[key] = typeof value === "number" ? Number(typed) : typed;
    }
    return found;
  }
}
