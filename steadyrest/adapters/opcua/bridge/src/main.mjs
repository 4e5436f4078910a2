// SPDX-License-Identifier: Apache-2.0
// Bridge between the layer and an OPC UA server: lines of JSON on file descriptor 3, which the layer
// opened. It ends when the layer does.
import net from "node:net";
import { Link } from "./link.mjs";
import { decode, Lines } from "./wire.mjs";
import { textOf, whyOf } from "./words.mjs";

const kMostWaiting = 16;

// node-opcua prints on stdout; the layer may use its own for answers.
for (const name of ["log", "info", "warn", "error", "debug"]) {
  console[name] = process.env.STEADYREST_BRIDGE_TALKS ? (...words) => process.stderr.write(words.join(" ") + "\n") : () => {};
}

const wire = new net.Socket({ fd: 3, readable: true, writable: true });
/** @type {Link | null} */
let link = null;
let waiting = 0;

function say(message) {
  if (!wire.destroyed) wire.write(JSON.stringify(message) + "\n");
}

async function end(code) {
  const closing = link?.stop() ?? Promise.resolve();
  setTimeout(() => process.exit(code), 500).unref();
  await closing;
  process.exit(code);
}

const kActs = {
  async configure(message) {
    // At once: the next line may be here already.
    const before = link;
    link = new Link(message, say);
    await before?.stop();
    link.run().catch((error) => {
      say({ event: "state", state: "lost", why: "failed", detail: textOf(error) });
      end(1);
    });
    return {};
  },
  check: () => link.check(),
  read: () => link.read(),
  write: (message) => link.write(message.values),
  certificate: async () => (await link.certificate()).answer,
  trust: (message) => link.trust(message.fingerprint),
  stop: async () => {
    setImmediate(() => end(0));
    return {};
  },
};

async function take(line) {
  const { message, id, fault } = decode(line);
  if (fault) {
    say({ id: id ?? null, ok: false, why: "bad_request", detail: fault });
    return;
  }
  if (message.do !== "configure" && message.do !== "stop" && link === null) {
    say({ id, ok: false, why: "not_configured", detail: "configure comes first" });
    return;
  }
  if (waiting >= kMostWaiting) {
    say({ id, ok: false, why: "too_many_requests", detail: `${waiting} requests wait` });
    return;
  }
  ++waiting;
  try {
    say({ id, ok: true, ...(await kActs[message.do](message)) });
  } catch (error) {
    say({ id, ok: false, why: whyOf(error), detail: textOf(error) });
  } finally {
    --waiting;
  }
}

const lines = new Lines(
  (line) => void take(line),
  () => say({ id: null, ok: false, why: "bad_request", detail: "a line is too long" }),
);
wire.on("data", (chunk) => lines.push(chunk));
for (const event of ["end", "close", "error"]) wire.on(event, () => void end(0));
for (const signal of ["SIGTERM", "SIGINT"]) process.on(signal, () => void end(0));
process.on("uncaughtException", (error) => {
  say({ event: "state", state: "lost", why: "failed", detail: textOf(error) });
  void end(1);
});
process.on("unhandledRejection", () => {});
say({ event: "hello", protocol: 1, pid: process.pid });
