"use strict";
/* From the packed page to a playing player: numbers out of base64, a world, its drawing. */

const KINDS_OF_NUMBERS = { f8: Float64Array, i4: Int32Array, i1: Int8Array };

function unpacked(text, columns) {
  return columnsIn(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)), columns);
}

function columnsIn(bytes, columns) {
  const found = {};
  let place = 0;
  for (const { name, type, length } of columns) {
    const numbers = KINDS_OF_NUMBERS[type], size = length * numbers.BYTES_PER_ELEMENT;
    found[name] = new numbers(bytes.slice(place, place + size).buffer);
    place += size;
  }
  return found;
}

function openPlayer(root, description, text) {
  const columns = unpacked(text.trim(), description.columns);
  const { x, y, vx, vy, radius, mass, species, spin, ...rows } = columns;
  const world = new World({ ...description.scene, disks: { x, y, vx, vy, radius, mass, spin } });
  world.append(rows);
  description.stage.species = species;
  return new Player(root, world, description);
}
