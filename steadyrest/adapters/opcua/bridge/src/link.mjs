// SPDX-License-Identifier: Apache-2.0
// The connection to one OPC UA server: connects, keeps at it, reads and writes a fixed list of
// nodes. It never guesses: a lost connection is closed whole and made anew.
import {
  AttributeIds, DataType, MessageSecurityMode, OPCUAClient, resolveNodeId, SecurityPolicy,
  UserTokenType, VariantArrayType,
} from "node-opcua-client";
import { InMemoryCertificateStore } from "node-opcua-common";
import { Certificates, describe, kApplicationUri, passwordOf } from "./certificates.mjs";
import { plain } from "./wire.mjs";
import { Fault, textOf, whyOf } from "./words.mjs";

const kNoRetry = { maxRetry: 0, initialDelay: 50, maxDelay: 100 };
const kFirstPause_ms = 50;
const kLongestPause_ms = 2000;
const kWritable = 2;
const kNumeric = new Set([
  DataType.Boolean, DataType.SByte, DataType.Byte, DataType.Int16, DataType.UInt16, DataType.Int32, DataType.UInt32,
  DataType.Float, DataType.Double,
]);
/** Faults that no waiting mends: it is tried again, but slowly. */
const kStubborn = /certificate|password|user|key|security|endpoint/;

function within(promise, ms, what) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Fault("link_lost", `${what} took more than ${ms} ms`)), ms);
  });
  promise.catch(() => {});
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

export class Link {
  #tell;
  #config;
  #certificates;
  #client = null;
  #session = null;
  #ends = false;
  #wake = null;
  #read = [];
  #write = [];
  #writeTypes = [];

  /** @param {(event: object) => void} tell */
  constructor(config, tell) {
    this.#config = config;
    this.#tell = tell;
  }

  async run() {
    let pause = kFirstPause_ms;
    while (!this.#ends) {
      this.#tell({ event: "state", state: "connecting" });
      const ended = await this.#once(() => (pause = kFirstPause_ms));
      if (this.#ends) break;
      this.#tell({ event: "state", state: "lost", why: whyOf(ended), detail: textOf(ended) });
      pause = kStubborn.test(whyOf(ended)) ? kLongestPause_ms : pause;
      await new Promise((resolve) => {
        this.#wake = resolve;
        setTimeout(resolve, pause);
      });
      pause = Math.min(2 * pause, kLongestPause_ms);
    }
  }

  /** Connects and stays until the connection ends; returns why. */
  async #once(onConnected) {
    let lost;
    const ended = new Promise((resolve) => (lost = resolve));
    this.lost = lost;
    const attempt = { over: false };
    try {
      await within(this.#connect(lost, attempt), 10 * this.#config.timeout_ms + 2000, "connecting");
      onConnected();
      this.#tell({ event: "state", state: "connected" });
      return await ended;
    } catch (error) {
      return error;
    } finally {
      attempt.over = true;
      await this.#close();
    }
  }

  /** An attempt that is over goes no further: its client would be nobody's, and its session stay. */
  async #connect(lost, attempt) {
    const { endpoint, security, user, timeout_ms: timeout } = this.#config;
    const secure = security !== "none";
    this.#certificates ??= new Certificates(this.#config.state);
    await this.#certificates.own();
    const identity = user === undefined
      ? { type: UserTokenType.Anonymous }
      : { type: UserTokenType.UserName, userName: user, password: passwordOf(this.#config) };
    const shown = secure ? await this.#endpointOf() : undefined;
    if (attempt.over) return;
    const client = this.#make(secure, shown?.serverCertificate);
    this.#client = client;
    for (const event of ["connection_lost", "close", "abort"]) {
      client.on(event, (error) => lost(error ?? new Fault("link_lost", "the control closed the connection")));
    }
    await client.connect(endpoint);
    const session = await client.createSession(identity);
    if (attempt.over) {
      await session.close();
      return;
    }
    this.#session = session;
    this.#session.on("session_closed", () => lost(new Fault("link_lost", "the control closed the session")));
    await this.#resolve(timeout);
  }

  #make(secure, serverCertificate) {
    return OPCUAClient.create({
      applicationName: "Steadyrest",
      applicationUri: kApplicationUri(),
      endpointMustExist: false,
      connectionStrategy: kNoRetry,
      keepSessionAlive: false,
      requestedSessionTimeout: 60000,
      defaultTransactionTimeout: this.#config.timeout_ms,
      // Also closes an idle connection; a layer that has just connected may not have read yet.
      transportTimeout: Math.max(5000, this.#config.timeout_ms),
      certificateFile: this.#certificates.file,
      privateKeyFile: this.#certificates.keyFile,
      // Which certificate is trusted is decided before, by Certificates.demand(), on the bytes.
      clientCertificateManager: new InMemoryCertificateStore({ autoAcceptUnknown: true }),
      ...(secure
        ? {
            securityMode: MessageSecurityMode.SignAndEncrypt,
            securityPolicy: SecurityPolicy.Basic256Sha256,
            serverCertificate,
          }
        : { securityMode: MessageSecurityMode.None, securityPolicy: SecurityPolicy.None }),
    });
  }

  /** What the control shows before any secret is sent. */
  async #endpoints() {
    const client = this.#make(false);
    try {
      await client.connect(this.#config.endpoint);
      return await client.getEndpoints();
    } finally {
      await within(client.disconnect(), 500, "closing").catch(() => {});
    }
  }

  #secureOne(endpoints) {
    const found = endpoints.find((one) =>
      one.securityPolicyUri === SecurityPolicy.Basic256Sha256 &&
      one.securityMode === MessageSecurityMode.SignAndEncrypt);
    if (found === undefined || !found.serverCertificate?.length) {
      const offered = endpoints.map((one) => String(one.securityPolicyUri).split("#").pop());
      throw new Fault("security_not_offered", `the control offers ${[...new Set(offered)].join(", ") || "nothing"}`);
    }
    return found;
  }

  async #endpointOf() {
    const found = this.#secureOne(await this.#endpoints());
    this.#certificates.demand(this.#config.endpoint, found.serverCertificate);
    return found;
  }

  /** The control's certificate, trusted or not. */
  async certificate() {
    this.#certificates ??= new Certificates(this.#config.state);
    await this.#certificates.own();
    const der = this.#secureOne(await within(this.#endpoints(), 5000, "connecting")).serverCertificate;
    let trusted = "";
    try {
      this.#certificates.demand(this.#config.endpoint, der);
    } catch (error) {
      trusted = whyOf(error);
    }
    return { der, answer: { ...describe(der), why: trusted, own: this.#certificates.file } };
  }

  async trust(fingerprint) {
    const { der } = await this.certificate();
    this.#certificates.trust(this.#config.endpoint, der, fingerprint);
    this.#wake?.();
    return describe(der);
  }

  /** Names to node ids: the index of a namespace is only valid in one session. */
  async #resolve() {
    const uris = await this.#session.readNamespaceArray();
    const idOf = ({ ns, id }) => {
      const index = /^\d+$/.test(ns) ? Number(ns) : uris.indexOf(ns);
      if (index < 0) throw new Fault("namespace_unknown", `${ns}; the control has ${uris.join(", ")}`);
      try {
        return resolveNodeId(`ns=${index};${id}`);
      } catch (error) {
        throw new Fault("node_malformed", `${id}: ${textOf(error)}`);
      }
    };
    this.#read = this.#config.read.map((node) => ({ nodeId: idOf(node), attributeId: AttributeIds.Value }));
    this.#write = this.#config.write.map((node) => idOf(node));
    const types = this.#write.length === 0 ? [] : await this.#session.read(
      this.#write.map((nodeId) => ({ nodeId, attributeId: AttributeIds.Value })));
    this.#writeTypes = types.map((data) =>
      kNumeric.has(data.value?.dataType) ? data.value.dataType : DataType.Double);
  }

  #ready() {
    if (this.#session === null || this.#read === null) throw new Fault("not_connected", "there is no session");
    return this.#session;
  }

  /** A request that fails ends the connection: the next one starts from nothing. */
  async #ask(promise, what) {
    try {
      return await within(promise, this.#config.timeout_ms, what);
    } catch (error) {
      this.lost?.(error);
      throw error;
    }
  }

  async read() {
    const session = this.#ready();
    const sent = Date.now();
    const data = await this.#ask(session.read(this.#read), "reading");
    const values = data.map((one) => (one.statusCode.isGood() ? plain(one.value?.value) : null));
    const status = data.map((one) => one.statusCode.value >>> 0);
    // A source's stamp stays while its value does.
    const time = data.map((one) => one.serverTimestamp?.getTime() ?? one.sourceTimestamp?.getTime() ?? 0);
    return { values, status, time_ms: time, sent_ms: sent };
  }

  async write(values) {
    const session = this.#ready();
    if (values.length !== this.#write.length) {
      throw new Fault("bad_request", `${values.length} values for ${this.#write.length} nodes`);
    }
    const status = await this.#ask(session.write(this.#write.map((nodeId, i) => ({
      nodeId,
      attributeId: AttributeIds.Value,
      value: {
        value: {
          dataType: this.#writeTypes[i],
          arrayType: Array.isArray(values[i]) ? VariantArrayType.Array : VariantArrayType.Scalar,
          value: values[i],
        },
      },
    }))), "writing");
    return { status: status.map((one) => one.value >>> 0) };
  }

  /** For each node: whether it is there, its type, and whether this user may write it. */
  async check() {
    const session = this.#ready();
    const nodes = [...this.#read.map((one) => one.nodeId), ...this.#write];
    const attributes = [AttributeIds.Value, AttributeIds.UserAccessLevel];
    const data = nodes.length === 0 ? [] : await this.#ask(session.read(
      nodes.flatMap((nodeId) => attributes.map((attributeId) => ({ nodeId, attributeId })))), "checking");
    return {
      nodes: nodes.map((_, i) => {
        const [value, level] = [data[2 * i], data[2 * i + 1]];
        const known = level.statusCode.isGood() && typeof level.value?.value === "number";
        const shown = value.value?.value;
        return {
          status: value.statusCode.value >>> 0,
          name: value.statusCode.name,
          type: value.statusCode.isGood() && value.value ? DataType[value.value.dataType] ?? "?" : "",
          length: Array.isArray(shown) || ArrayBuffer.isView(shown) ? shown.length : -1,
          writable: known ? (level.value.value & kWritable) !== 0 : null,
        };
      }),
    };
  }

  async #close() {
    const [client, session] = [this.#client, this.#session];
    this.#client = null;
    this.#session = null;
    if (client === null) return;
    client.removeAllListeners();
    const end = async () => {
      if (session !== null) await session.close().catch(() => {});
      await client.disconnect().catch(() => {});
    };
    await within(end(), 300, "closing").catch(() => {});
  }

  async stop() {
    this.#ends = true;
    this.#wake?.();
    this.lost?.(new Fault("stopped", "the layer ended"));
    await this.#close();
  }
}

