// SPDX-License-Identifier: Apache-2.0
// Certificates on this side, all in one folder:
//   own/           the layer's certificate, and its key in private/ (mode 600), made once
//   controls/      certificates of trusted controls, one .der file each, named by their fingerprint
//   refused/       what a control showed and nobody trusts yet
//   controls.json  which certificate each endpoint had when it was trusted
import { createHash, createPrivateKey, X509Certificate } from "node:crypto";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { OPCUACertificateManager } from "node-opcua-certificate-manager";
import { Fault, textOf } from "./words.mjs";

const kYears = 10;
const kMostRefused = 32;
export const kApplicationUri = () => `urn:${os.hostname()}:steadyrest`;

export const fingerprintOf = (der) => createHash("sha256").update(der).digest("hex");

/** For people: what the certificate says of itself. */
export function describe(der) {
  const out = { fingerprint: fingerprintOf(der), subject: "", from: "", until: "", names: "" };
  try {
    const certificate = new X509Certificate(der);
    out.subject = certificate.subject.replace(/\n/g, ", ");
    out.from = certificate.validFrom;
    out.until = certificate.validTo;
    out.names = certificate.subjectAltName ?? "";
  } catch {
    out.subject = "unreadable";
  }
  return out;
}

function holds(file, bytes) {
  try {
    return fs.readFileSync(file).equals(bytes);
  } catch {
    return false;
  }
}

function replaceFile(file, bytes) {
  const beside = `${file}.${process.pid}.new`;
  fs.writeFileSync(beside, bytes, { mode: 0o600 });
  try {
    fs.renameSync(beside, file);
  } catch (error) {
    fs.rmSync(beside, { force: true });
    throw error;
  }
}

export class Certificates {
  /** @param {string} folder */
  constructor(folder) {
    this.folder = folder;
    this.file = path.join(folder, "own", "certificate.pem");
    this.keyFile = path.join(folder, "own", "private", "private_key.pem");
  }

  /** Makes key and certificate where there are none; keeps them otherwise. */
  own() {
    this.making ??= this.#own().finally(() => (this.making = null));
    return this.making;
  }

  async #own() {
    try {
      for (const below of ["own", "controls", "refused"]) {
        fs.mkdirSync(path.join(this.folder, below), { recursive: true, mode: 0o700 });
      }
      await this.#make();
    } catch (error) {
      if (error instanceof Fault) throw error;
      throw new Fault("own_certificate_not_made", textOf(error));
    }
    this.#check();
  }

  #check() {
    if ((fs.statSync(this.keyFile).mode & 0o077) !== 0) {
      throw new Fault("own_key_open", this.keyFile);
    }
    let fits = false;
    try {
      const key = createPrivateKey(fs.readFileSync(this.keyFile));
      fits = new X509Certificate(fs.readFileSync(this.file)).checkPrivateKey(key);
    } catch (error) {
      throw new Fault("own_certificate_damaged", `${path.dirname(this.file)}: ${textOf(error)}`);
    }
    if (!fits) throw new Fault("own_certificate_damaged", `${this.keyFile} is not the certificate's key`);
  }

  async #make() {
    const [certificate, key] = [fs.existsSync(this.file), fs.existsSync(this.keyFile)];
    if (certificate && key) return;
    if (certificate || key) {
      // A new one would be strange to the controls that trust the former.
      throw new Fault("own_certificate_damaged", `${certificate ? this.keyFile : this.file} is missing`);
    }
    const manager = new OPCUACertificateManager({ rootFolder: this.folder });
    await manager.initialize();
    await manager.createSelfSignedCertificate({
      applicationUri: kApplicationUri(),
      subject: "/CN=Steadyrest",
      dns: [os.hostname()],
      startDate: new Date(Date.now() - 86400_000),
      validity: 365 * kYears,
      outputFile: this.file,
    });
    fs.chmodSync(this.keyFile, 0o600);
    await manager.dispose();
  }

  #seen() {
    try {
      const seen = JSON.parse(fs.readFileSync(path.join(this.folder, "controls.json"), "utf8"));
      return typeof seen === "object" && seen !== null ? seen : {};
    } catch {
      return {};
    }
  }

  /** The newest ones: a host that shows another certificate each time must not fill the disk. */
  #keepRefused(shown, der) {
    const folder = path.join(this.folder, "refused");
    replaceFile(path.join(folder, `${shown.fingerprint}.der`), der);
    const age = (name) => fs.statSync(path.join(folder, name)).mtimeMs;
    const all = fs.readdirSync(folder).filter((name) => name.endsWith(".der"));
    all.sort((a, b) => age(b) - age(a));
    for (const name of all.slice(kMostRefused)) fs.rmSync(path.join(folder, name), { force: true });
  }

  /** Throws unless this very certificate is trusted for this endpoint and valid today. */
  demand(endpoint, der, now = new Date()) {
    const shown = describe(der);
    const trusted = path.join(this.folder, "controls", `${shown.fingerprint}.der`);
    const before = this.#seen()[endpoint];
    if (before !== shown.fingerprint || !holds(trusted, der)) {
      this.#keepRefused(shown, der);
      if (typeof before === "string" && before !== shown.fingerprint) {
        throw new Fault("certificate_changed",
          `${shown.subject}, SHA-256 ${shown.fingerprint}; trusted was ${before}`);
      }
      throw new Fault("certificate_not_trusted", `${shown.subject}, SHA-256 ${shown.fingerprint}`);
    }
    if (shown.until !== "" && (now > new Date(shown.until) || now < new Date(shown.from))) {
      throw new Fault("certificate_expired", `${shown.subject}, valid from ${shown.from} until ${shown.until}`);
    }
  }

  /** Trusts what the control shows now if it is what the user has compared. */
  trust(endpoint, der, fingerprint) {
    const shown = fingerprintOf(der);
    if (fingerprint.toLowerCase().replace(/[^0-9a-f]/g, "") !== shown) {
      throw new Fault("certificate_other", `the control shows SHA-256 ${shown}`);
    }
    try {
      this.#keep(endpoint, shown, der);
    } catch (error) {
      throw new Fault("certificates_not_written", textOf(error));
    }
  }

  #keep(endpoint, shown, der) {
    replaceFile(path.join(this.folder, "controls", `${shown}.der`), der);
    fs.rmSync(path.join(this.folder, "refused", `${shown}.der`), { force: true });
    const before = this.#seen()[endpoint];
    const seen = { ...this.#seen(), [endpoint]: shown };
    replaceFile(path.join(this.folder, "controls.json"), JSON.stringify(seen, null, 2) + "\n");
    // The former one is trusted no longer.
    if (/^[0-9a-f]{64}$/.test(before ?? "") && !Object.values(seen).includes(before)) {
      fs.rmSync(path.join(this.folder, "controls", `${before}.der`), { force: true });
    }
  }
}

/** The password, from a file that only its owner can read, or from the environment. */
export function passwordOf({ password_file: file, password_variable: variable }) {
  if (variable !== undefined) {
    const password = process.env[variable];
    if (!password) throw new Fault("password_missing", `the environment has no ${variable}`);
    return password;
  }
  let handle;
  try {
    handle = fs.openSync(file, "r");
  } catch (error) {
    throw new Fault("password_missing", `${file}: ${error.code ?? error}`);
  }
  try {
    const state = fs.fstatSync(handle);
    if (!state.isFile() || state.size > 4096) throw new Fault("password_missing", `${file} is no small file`);
    if ((state.mode & 0o077) !== 0) {
      throw new Fault("password_open", `${file} has mode ${(state.mode & 0o777).toString(8)}`);
    }
    const password = fs.readFileSync(handle, "utf8").replace(/^\uFEFF/, "").replace(/\r?\n$/, "");
    if (password === "") throw new Fault("password_missing", `${file} is empty`);
    return password;
  } finally {
    fs.closeSync(handle);
  }
}
