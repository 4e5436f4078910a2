// SPDX-License-Identifier: Apache-2.0
// One file that needs Node alone: node build.mjs OUTPUT
import { build } from "esbuild";

const [, , outfile = "opcua-bridge.cjs"] = process.argv;
await build({
  entryPoints: [new URL("src/main.mjs", import.meta.url).pathname],
  bundle: true,
  platform: "node",
  target: "node18",
  format: "cjs",
  minify: true,
  legalComments: "eof",
  // Only for locks on network folders, where node-opcua goes without.
  external: ["proper-lockfile"],
  logLevel: "warning",
  outfile,
});
