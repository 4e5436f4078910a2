// SPDX-License-Identifier: Apache-2.0
// A control's OPC UA server for tests, by another implementation than ours: a store of variables
// with the names that the harness gives. The harness drives it by lines of JSON on descriptor 3.
// Clients reach it through a relay that can be cut, hung and mended.
import fs from "node:fs";
import net from "node:net";
import path from "node:path";
import {
  DataType, MessageSecurityMode, OPCUACertificateManager, OPCUAServer, SecurityPolicy, StatusCodes, Variant, VariantArrayType,
} from "node-opcua";

for (const name of ["log", "info", "warn", "error", "debug"]) console[name] = () => {};

const wire = new net.Socket({ fd: 3, readable: true, writable: true });
const say = (message) => wire.write(JSON.stringify(message) + "\n");

let server;
let relay;
/** @type {Map<string, {value: any, status: any, type: any, writes: number}>} */
const nodes = new Map();
const sockets = new Set();
let way = "open";

function variantOf(node) {
  const value = node.value;
  return Array.isArray(value)
    ? new Variant({ dataType: node.type, arrayType: VariantArrayType.Array, value })
    : new Variant({ dataType: node.type, value });
}

function addVariable(namespace, folder, { id, type = "Double", value, read_only: readOnly }) {
  const node = { value, status: StatusCodes.Good, type: DataType[type], writes: 0 };
  nodes.set(id, node);
  namespace.addVariable({
    organizedBy: folder,
    browseName: id,
    nodeId: `s=${id}`,
    dataType: type,
    valueRank: Array.isArray(value) ? 1 : -1,
    ...(Array.isArray(value) ? { arrayDimensions: [value.length] } : {}),
    accessLevel: readOnly ? "CurrentRead" : "CurrentRead | CurrentWrite",
    userAccessLevel: readOnly ? "CurrentRead" : "CurrentRead | CurrentWrite",
    minimumSamplingInterval: 100,
    value: {
      get: () => (node.status === StatusCodes.Good ? variantOf(node) : node.status),
      set: (variant) => {
        const value = variant.value;
        node.value = ArrayBuffer.isView(value) || Array.isArray(value) ? Array.from(value) : value;
        ++node.writes;
        return StatusCodes.Good;
      },
    },
  });
}

function startRelay(inner, port) {
  relay = net.createServer((outside) => {
    if (way === "closed") return outside.destroy();
    const inside = net.connect(inner, "127.0.0.1");
    sockets.add(outside);
    const end = () => {
      sockets.delete(outside);
      outside.destroy();
      inside.destroy();
    };
    outside.setNoDelay(true);
    inside.setNoDelay(true);
    outside.on("data", (data) => way === "open" && inside.write(data));
    inside.on("data", (data) => way === "open" && outside.write(data));
    for (const one of [outside, inside]) for (const event of ["error", "close"]) one.on(event, end);
  });
  return new Promise((resolve) => relay.listen(port, "127.0.0.1", () => resolve(relay.address().port)));
}

const kActs = {
  async start({ folder, port = 0, users = {}, anonymous = false, uri = "SinumerikVarProvider", variables, accepts = true }) {
    const manager = new OPCUACertificateManager({
      rootFolder: path.join(folder, "pki"),
      automaticallyAcceptUnknownCertificate: accepts,
    });
    await manager.initialize();
    server = new OPCUAServer({
      port: 0,
      host: "127.0.0.1",
      serverCertificateManager: manager,
      certificateFile: path.join(folder, "server.pem"),
      securityPolicies: [SecurityPolicy.None, SecurityPolicy.Basic256Sha256],
      securityModes: [MessageSecurityMode.None, MessageSecurityMode.SignAndEncrypt],
      allowAnonymous: anonymous,
      maxConnectionsPerEndpoint: 100,
      serverCapabilities: { maxSessions: 200 },
      userManager: { isValidUser: (name, password) => Object.hasOwn(users, name) && users[name] === password },
    });
    await server.initialize();
    const space = server.engine.addressSpace;
    const namespace = space.registerNamespace(uri);
    const sinumerik = namespace.addFolder(space.rootFolder.objects, { browseName: "Sinumerik" });
    for (const variable of variables) addVariable(namespace, sinumerik, variable);
    await server.start();
    return { port: await startRelay(server.endpoints[0].port, port), pid: process.pid };
  },
  set({ values }) {
    for (const [id, value] of Object.entries(values)) nodes.get(id).value = value;
    return {};
  },
  hostile({ values }) {
    const word = { nan: NaN, inf: Infinity, "-inf": -Infinity, huge: 1e308 };
    const real = (one) => (typeof one === "string" && one in word ? word[one] : one);
    for (const [id, value] of Object.entries(values)) nodes.get(id).value = Array.isArray(value) ? value.map(real) : real(value);
    return {};
  },
  type({ node, type, value }) {
    Object.assign(nodes.get(node), { type: DataType[type], value });
    return {};
  },
  status({ node, status }) {
    nodes.get(node).status = StatusCodes[status];
    return {};
  },
  get({ ids }) {
    return { values: ids.map((id) => nodes.get(id).value), writes: ids.map((id) => nodes.get(id).writes) };
  },
  way({ way: next }) {
    way = next;
    if (next !== "hung") for (const one of sockets) one.destroy();
    return {};
  },
};

let rest = "";
wire.on("data", async (data) => {
  rest += data.toString("utf8");
  const lines = rest.split("\n");
  rest = lines.pop();
  for (const line of lines) {
    const message = JSON.parse(line);
    try {
      say({ id: message.id, ok: true, ...(await kActs[message.do](message)) });
    } catch (error) {
      say({ id: message.id, ok: false, detail: String(error?.stack ?? error) });
    }
  }
});
for (const event of ["end", "close", "error"]) wire.on(event, () => process.exit(0));
process.on("uncaughtException", (error) => fs.writeSync(2, `${error.stack}\n`));
