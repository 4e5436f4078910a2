// SPDX-License-Identifier: Apache-2.0
// Lines between the layer and the bridge: one JSON object each, at most kMaxLine bytes. README.md
// has every message. Whatever is not one is answered by a refusal, never by an exception.

export const kMaxLine = 65536;
export const kMaxNodes = 256;

const kSecurity = ["sign_and_encrypt", "none"];

/** Cuts a byte stream into lines. A line that grows beyond the limit is reported once and dropped. */
export class Lines {
  #parts = [];
  #size = 0;
  #dropping = false;

  /** @param {(line: string) => void} onLine @param {() => void} onTooLong */
  constructor(onLine, onTooLong) {
    this.onLine = onLine;
    this.onTooLong = onTooLong;
  }

  /** @param {Buffer} chunk */
  push(chunk) {
    let from = 0;
    for (let at = chunk.indexOf(10); at >= 0; at = chunk.indexOf(10, from)) {
      this.#add(chunk.subarray(from, at));
      from = at + 1;
      this.#end();
    }
    this.#add(chunk.subarray(from));
  }

  #add(part) {
    if (this.#dropping || part.length === 0) return;
    this.#size += part.length;
    if (this.#size > kMaxLine) {
      this.#dropping = true;
      this.#parts = [];
      this.onTooLong();
      return;
    }
    this.#parts.push(part);
  }

  #end() {
    const whole = !this.#dropping && this.#size > 0;
    const line = whole ? Buffer.concat(this.#parts).toString("utf8") : "";
    this.#parts = [];
    this.#size = 0;
    this.#dropping = false;
    if (whole) this.onLine(line);
  }
}

const isText = (value, most = 4096) => typeof value === "string" && value.length > 0 && value.length <= most;

function nodesFault(nodes, what) {
  if (!Array.isArray(nodes) || nodes.length > kMaxNodes) {
    return `${what} is no list of at most ${kMaxNodes} nodes`;
  }
  for (const node of nodes) {
    if (typeof node !== "object" || node === null || !isText(node.ns, 512) || !isText(node.id, 512)) {
      return `${what} has an entry without ns (a URI) and id (such as s=/Channel/Parameter/R[u1,1])`;
    }
  }
  return "";
}

function valuesFault(values) {
  if (!Array.isArray(values) || values.length > kMaxNodes) return "values is no list";
  for (const value of values) {
    const list = Array.isArray(value) ? value : [value];
    if (list.length > kMaxNodes || !list.every((one) => typeof one === "number" && Number.isFinite(one))) {
      return "values has an entry that is neither a number nor a list of numbers";
    }
  }
  return "";
}

const kFaults = {
  configure(message) {
    if (!isText(message.endpoint) || !message.endpoint.startsWith("opc.tcp://")) {
      return "endpoint is not opc.tcp://HOST:PORT";
    }
    if (!kSecurity.includes(message.security)) return `security is not one of ${kSecurity.join(", ")}`;
    if (!isText(message.state)) return "state is no folder";
    if (message.user !== undefined && !isText(message.user, 256)) return "user is no name";
    if (message.password_file !== undefined && !isText(message.password_file)) return "password_file is no path";
    if (message.password_variable !== undefined && !isText(message.password_variable, 256)) {
      return "password_variable is no name";
    }
    const timeout = message.timeout_ms;
    if (!(typeof timeout === "number" && timeout >= 10 && timeout <= 60000)) return "timeout_ms is not 10 to 60000";
    return nodesFault(message.read, "read") || nodesFault(message.write, "write");
  },
  check: () => "",
  read: () => "",
  write: (message) => valuesFault(message.values),
  certificate: () => "",
  trust: (message) => (isText(message.fingerprint, 128) ? "" : "fingerprint is no text"),
  stop: () => "",
};

/**
 * One line as a message, or why it is none. `id` is that of the line where it has one.
 * @param {string} line
 * @returns {{message?: any, id?: number, fault?: string}}
 */
export function decode(line) {
  let message;
  try {
    message = JSON.parse(line);
  } catch {
    return { fault: "not a line of JSON" };
  }
  if (typeof message !== "object" || message === null || Array.isArray(message)) {
    return { fault: "not a JSON object" };
  }
  const id = message.id;
  if (!Number.isSafeInteger(id) || id < 0) return { fault: "id is no whole number" };
  const rule = typeof message.do === "string" && Object.hasOwn(kFaults, message.do) ? kFaults[message.do] : null;
  if (rule === null) return { id, fault: `do is not one of ${Object.keys(kFaults).join(", ")}` };
  const fault = rule(message);
  return fault ? { id, fault } : { id, message };
}

/** What JSON cannot say becomes null: the layer takes it as not known. */
export function plain(value) {
  if (typeof value === "number") return Number.isFinite(value) ? value : null;
  if (typeof value === "boolean") return value ? 1 : 0;
  if (typeof value === "bigint") return Number(value);
  if (typeof value === "string") return value.slice(0, 512);
  if (Array.isArray(value) || ArrayBuffer.isView(value)) {
    if (value.length > 1024) return null;
    return Array.from(value, (one) => {
      const number = plain(one);
      return typeof number === "number" ? number : null;
    });
  }
  return null;
}
