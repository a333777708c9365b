"use strict";
/* The link: messages to the server, packets from it. When it breaks it mends itself, and says so. */

const RETRY_SECONDS = [0.3, 1, 2, 4];

class Link {
  /* hear(header, columns): called with each packet. broken(replaced): called when the connection is lost;
     replaced: another server is there, which was started anew and does not know this address. */
  constructor(hear, broken) {
    this.hear = hear;
    this.broken = broken;
    this.failures = 0;
    this.pending = 0;
    this._connect();
  }

  get open() { return this.socket.readyState === WebSocket.OPEN; }

  /* Tell the server something; it is lost while there is no connection. */
  send(message) {
    if (this.open) this.socket.send(JSON.stringify(message));
  }

  /* Ask for something that the server answers with "done", after all that follows from it. */
  ask(message) {
    if (!this.open) return;
    this.pending++;
    this.send(message);
  }

  _connect() {
    this.socket = new WebSocket(`ws://${location.host}${location.pathname.replace(/[^/]*$/, "")}socket`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => { this.failures = 0; this.pending = 0; };
    this.socket.onmessage = (event) => this._unpack(event.data);
    this.socket.onclose = () => {
      const wait = RETRY_SECONDS[Math.min(this.failures++, RETRY_SECONDS.length - 1)];
      this.broken(false);
      fetch(location.pathname, { cache: "no-store" }).then((answer) => { if (answer.status === 404) this.broken(true); }, () => {});
      setTimeout(() => this._connect(), 1000 * wait);
    };
  }

  _unpack(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    if (header.type === "done") this.pending--;
    this.hear(header, columnsIn(new Uint8Array(buffer, 4 + length), header.columns));
  }
}
