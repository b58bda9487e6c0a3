// @ts-check
/** The connection to the server: commands with answers, and what the server says by itself. */

const AGAIN_MS = 1000;
const KEY = "pn2code-seat";

/** @typedef {{ok: boolean, message?: string, rows?: any[], result?: any, state?: any}} Answer */

export class Link {
  /** @param {{onState: (state: any, isWhole: boolean) => void, onSaid: (said: any) => void, onLost: (why: string) => void}} ears */
  constructor(ears) {
    this.ears = ears;
    this.last = 0;
    /** @type {Map<number, (answer: Answer) => void>} */
    this.waiting = new Map();
    this.seat = sessionStorage.getItem(KEY) ?? "";
    this.isOpen = false;
    this.open();
  }

  open() {
    const at = new URL("ws", location.href);
    at.protocol = "ws:";
    at.searchParams.set("seat", this.seat);
    this.socket = new WebSocket(at);
    this.socket.onmessage = (e) => this.hear(JSON.parse(e.data));
    this.socket.onclose = () => this.closed();
  }

  closed() {
    const wasOpen = this.isOpen;
    this.isOpen = false;
    for (const answer of this.waiting.values()) answer({ ok: false, message: "the connection is lost", rows: [] });
    this.waiting.clear();
    if (this.isBroken) return;
    if (wasOpen) this.ears.onLost("The connection to pn2code is lost. The page tries again.");
    setTimeout(() => this.open(), AGAIN_MS);
  }

  /** @param {any} said */
  hear(said) {
    if (said.broken) {
      this.isBroken = true;
      this.ears.onLost(`The net cannot be played: ${said.broken}.`);
      return;
    }
    if (said.seat) {
      this.seat = said.seat;
      this.isOpen = true;
      sessionStorage.setItem(KEY, said.seat);
      this.ears.onState(said.state, true);
      return;
    }
    const answer = this.waiting.get(said.id);
    if (said.state) this.ears.onState(said.state, Boolean(said.isWhole));
    if (answer) {
      this.waiting.delete(said.id);
      answer(said);
    } else this.ears.onSaid(said);
  }

  /**
   * Asks for something.
   * @param {string} what
   * @param {Record<string, any>} [more]
   * @returns {Promise<Answer>}
   */
  ask(what, more = {}) {
    if (!this.isOpen) return Promise.resolve({ ok: false, message: "there is no connection", rows: [] });
    const id = ++this.last;
    this.socket?.send(JSON.stringify({ ...more, do: what, id }));
    return new Promise((done) => this.waiting.set(id, done));
  }

  /**
   * Says something that is not answered.
   * @param {string} what
   */
  say(what) {
    if (this.isOpen) this.socket?.send(JSON.stringify({ do: what }));
  }

  /** The address of the run of this page, as a trace. */
  get trace() {
    return new URL(`trace/${encodeURIComponent(this.seat)}`, location.href).href;
  }
}
